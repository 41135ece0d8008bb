//! Circles that follow from the rack.

use gearset::{
    GearInput, Geometry, GeometryInput, MeshKind, MeshMember, OpenCircles, Rack, RackProfile,
    Teeth, ThicknessInput, Thinning, fill_circles,
};

const PROFILE: RackProfile = RackProfile { addendum: 1.0, dedendum: 1.25 };
const ALL: OpenCircles = OpenCircles { tip: true, root: true, fillet: true, body: true };
const OPEN: GearInput = GearInput {
    tip_radius_m: f64::NAN,
    root_radius_m: f64::NAN,
    body_radius_m: None,
    fillet_radius_m: f64::NAN,
    tip_relief: None,
};

/// A set whose circles are all open; lengths in mm.
fn filled(
    teeth: [u32; 3],
    module: f64,
    a: f64,
    thickness: ThicknessInput,
) -> (GeometryInput, Teeth) {
    let rack = Rack { module_m: 1e-3 * module, pressure_angle_rad: 20f64.to_radians() };
    let mut input = GeometryInput {
        center_distance_m: 1e-3 * a,
        base_pitch_m: std::f64::consts::PI * rack.module_m * rack.pressure_angle_rad.cos(),
        rack: Some(rack),
        face_width_m: 0.01,
        sun: Some(OPEN),
        planet: OPEN,
        ring: Some(OPEN),
        carrier: None,
        thickness,
    };
    for circles in [input.sun.as_mut(), Some(&mut input.planet), input.ring.as_mut()] {
        circles.unwrap().fillet_radius_m = 0.38e-3 * module;
    }
    let teeth = Teeth { sun: Some(teeth[0]), planet: teeth[1], ring: Some(teeth[2]) };
    fill_circles(&mut input, &teeth, rack.module_m, &PROFILE, &[ALL; 3]).unwrap();
    (input, teeth)
}

fn with_backlash(module: f64) -> ThicknessInput {
    let j = 0.04e-3 * module;
    ThicknessInput::Backlash { sun_planet_m: j, ring_planet_m: j, planet_share: 0.5 }
}

fn assert_mm(found: f64, mm: f64, within: f64) {
    assert!((1e3 * found - mm).abs() < within, "{} for {mm}", 1e3 * found);
}

/// Stage 1 of a 5 MW wind turbine's gearbox, whose report prints tips and roots.
#[test]
fn circles_are_those_of_a_printed_report() {
    let shifts = ThicknessInput::ProfileShift {
        sun: 0.6170,
        planet: 0.8021,
        ring: 0.5013,
        thinning: Thinning::default(),
    };
    let (input, _) = filled([19, 17, 56], 45.0, 863.0, shifts);
    let (sun, ring) = (input.sun.unwrap(), input.ring.unwrap());
    // The report's tips of sun and planet are lowered by Σx − y = 0.241 modules, as bottom clearance demands.
    for (circles, tip, root) in
        [(&sun, 978.808, 798.030), (&input.planet, 905.470, 724.692), (&ring, 2475.118, 2677.618)]
    {
        assert_mm(2.0 * circles.tip_radius_m, tip, 0.01);
        assert_mm(2.0 * circles.root_radius_m, root, 0.01);
    }
}

#[test]
fn unshifted_gears_are_those_of_the_table() {
    let (input, _) = filled([21, 39, 99], 10.0, 300.0, with_backlash(10.0));
    let (sun, ring) = (input.sun.unwrap(), input.ring.unwrap());
    assert_mm(2.0 * sun.tip_radius_m, 230.0, 1e-9);
    assert_mm(2.0 * sun.root_radius_m, 185.0, 1e-9);
    assert_mm(2.0 * sun.body_radius_m.unwrap(), 115.0, 1e-9);
    assert_mm(2.0 * input.planet.root_radius_m, 365.0, 1e-9);
    assert_mm(2.0 * ring.root_radius_m, 1015.0, 1e-9);
    assert_mm(2.0 * ring.body_radius_m.unwrap(), 1085.0, 1e-9);
}

/// Few teeth, where tips of the plain rack touch fillets: what is chosen fits, over all ratios.
#[test]
fn chosen_circles_never_contradict_each_other() {
    for sun in 12..40 {
        for planet in 12..60 {
            let teeth = [sun, planet, sun + 2 * planet];
            let a = f64::from(sun + planet);
            let (input, teeth) = filled(teeth, 2.0, a, with_backlash(2.0));
            let set = Geometry::new(&input, &teeth).unwrap();
            for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
                let mesh = set.mesh(kind).unwrap();
                for member in [MeshMember::Driver, MeshMember::Driven] {
                    let gear = mesh.gear(member);
                    assert!(mesh.interference(member) <= 0.0, "{teeth:?} {kind:?} {member:?}");
                    assert!(mesh.root_clearance(member) >= 0.499e-3, "{teeth:?} {kind:?}");
                    assert!(gear.root_land_angle() >= 0.0, "{teeth:?} {kind:?} {member:?}");
                    assert!(gear.tooth_thickness(gear.tip_radius) > 0.39e-3, "{teeth:?}");
                    assert!(gear.fillet_radius >= 0.2e-3);
                }
                assert!(mesh.contact_ratio > 1.0, "{teeth:?} {kind:?} {}", mesh.contact_ratio);
            }
        }
    }
}

/// 12/18/48 of module 2: the tips that just stay on the mate's involute, by hand from reach less form.
#[test]
fn a_tip_is_lowered_to_the_involute_of_its_mate() {
    let (input, _) = filled([12, 18, 48], 2.0, 30.0, with_backlash(2.0));
    // The sun is touched 0.05 rad above its base circle: s_p = a sin 20° − 0.05 r_b,sun, d = 2 √(r_b² + s_p²).
    let [reach, cos] = [
        30.0 * 20f64.to_radians().sin() - 0.6 * 20f64.to_radians().cos(),
        20f64.to_radians().cos(),
    ];
    let base = 18.0 * cos;
    assert_mm(2.0 * input.planet.tip_radius_m, 2.0 * base.hypot(reach), 1e-4);
}
