//! Table 1 of the OH-58 set: consistency of its values, also with a description of the same teeth by a rack.

use std::path::Path;

use gearset::{Geometry, MeshKind, MeshMember};
use scene::Scene;

fn oh58() -> (Scene, Geometry) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/oh58_4p.toml");
    let scene = Scene::from_file(&path).unwrap();
    let geometry = scene.tooth_geometry().unwrap();
    (scene, geometry)
}

#[test]
fn operating_angles_and_contact_ratios_of_table_1() {
    let (_, g) = oh58();
    let (sp, rp) = (g.sun_planet.as_ref().unwrap(), g.ring_planet.as_ref().unwrap());
    assert!((sp.pressure_angle.to_degrees() - 24.60).abs() < 0.005);
    assert!((rp.pressure_angle.to_degrees() - 20.19).abs() < 0.005);
    assert!((sp.operating_module - 2.868e-3).abs() < 0.5e-6);
    assert!((rp.operating_module - 2.778e-3).abs() < 0.5e-6);
    assert!((sp.contact_ratio - 1.457).abs() < 5e-4, "{}", sp.contact_ratio);
    assert!((rp.contact_ratio - 1.721).abs() < 5e-4, "{}", rp.contact_ratio);
    assert!((2e3 * g.sun.as_ref().unwrap().base_radius - 70.4006).abs() < 5e-5);
    assert!((2e3 * g.ring.as_ref().unwrap().base_radius - 258.1354).abs() < 5e-5);
}

#[test]
fn backlash_given_is_backlash_found() {
    let (_, g) = oh58();
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        assert!((g.backlash(kind).unwrap() - 1e-4).abs() < 1e-15);
    }
    let sp = g.sun_planet.as_ref().unwrap();
    let t_sun = sp.gear(MeshMember::Driver).tooth_thickness(sp.pitch_radius(MeshMember::Driver));
    let t_planet = sp.gear(MeshMember::Driven).tooth_thickness(sp.pitch_radius(MeshMember::Driven));
    assert!((t_sun - t_planet).abs() < 1e-15);
}

#[test]
fn a_9_dp_rack_of_22_5_degrees_describes_the_same_set() {
    // Profile-shift sums at zero backlash from an independent reading of Table 1, for that rack.
    let (mut scene, _) = oh58();
    let input = scene.geometry.as_mut().unwrap();
    let (module, angle) = (25.4e-3 / 9.0, 22.5f64.to_radians());
    input.base_pitch_m = std::f64::consts::PI * module * angle.cos();
    input.rack = Some(gearset::Rack { module_m: module, pressure_angle_rad: angle });
    let g = scene.tooth_geometry().unwrap();
    assert!((g.sun_planet.as_ref().unwrap().pressure_angle.to_degrees() - 24.60).abs() < 0.005);
    assert!((g.ring_planet.as_ref().unwrap().pressure_angle.to_degrees() - 20.19).abs() < 0.005);
    let sums = g.zero_backlash_shift_sums(angle).unwrap();
    assert!((sums.sun_plus_planet - 0.5225).abs() < 1e-4, "{sums:?}");
    assert!((sums.ring_minus_planet + 0.4761).abs() < 1e-4, "{sums:?}");
    // The same sums as profile shifts leave no backlash, wherever they are split.
    for x_p in [0.0, 0.2, 0.4] {
        let shift = gearset::ThicknessInput::ProfileShift {
            sun: sums.sun_plus_planet - x_p,
            planet: x_p,
            ring: sums.ring_minus_planet + x_p,
            thinning: gearset::Thinning::default(),
        };
        scene.geometry.as_mut().unwrap().thickness = shift;
        let g = scene.tooth_geometry().unwrap();
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            assert!(g.backlash(kind).unwrap().abs() < 1e-12);
        }
    }
}

#[test]
fn tip_gaps_are_nil_on_the_path_and_a_few_micrometres_just_outside() {
    let (_, g) = oh58();
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let mesh = g.mesh(kind).unwrap();
        for tip in [MeshMember::Driver, MeshMember::Driven] {
            assert!(mesh.tip_gap(tip, 0.0).unwrap().abs() < 1e-15);
            let near = mesh.tip_gap(tip, 0.1 * mesh.base_pitch).unwrap();
            let nearer = mesh.tip_gap(tip, 0.05 * mesh.base_pitch).unwrap();
            println!("{kind:?} {tip:?}: {:.3} um, {:.3} um", near * 1e6, nearer * 1e6);
            assert!(near > 0.5e-6 && near < 20e-6, "{near}");
            // Quadratic in the distance outside the path.
            assert!((near / nearer - 4.0).abs() < 1.0, "{}", near / nearer);
        }
    }
}

#[test]
fn fillets_land_where_a_drawn_circle_touches() {
    let (_, g) = oh58();
    // The sun's by hand: s = √((35.275 + 0.8)² − 35.2003²) − 0.8 = 7.096 mm.
    let sun = g.sun.as_ref().unwrap();
    assert!((sun.form_roll_length().unwrap() - 7.0963e-3).abs() < 2e-6);
    for gear in [g.sun.as_ref().unwrap(), &g.planet, g.ring.as_ref().unwrap()] {
        assert!(gear.root_land_angle() > 0.0);
        let form = gear.form_radius();
        let (low, high) =
            (gear.root_radius.min(gear.tip_radius), gear.root_radius.max(gear.tip_radius));
        assert!(form > low && form < high);
    }
}
