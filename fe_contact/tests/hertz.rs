//! Two cylinders as half-planes with circular gaps, and two gears at their pitch point, against Hertz's closed forms.

use fe_contact::Elastic;
use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::cylinders::Cylinders;
use fe_contact::contact::hertz::{Hertz, fit};
use fe_contact::statics::{Bodies, at_phase};
use gearset::MeshKind;
use scene::{PlaneState, Scene};

#[test]
fn profile_half_width_and_approach() {
    let (radius, line_load) = (8.3e-3, 4.2e5);
    for plane in [PlaneState::Strain, PlaneState::Stress] {
        let m = Elastic { young: 207e9, poisson: 0.3, density: 7595.0, plane };
        let hertz = Hertz::new(line_load, radius, &m);
        // 16 cells across the patch: reach 1.5 a with 24 cells.
        let mut errors = Vec::new();
        for across in [16usize, 32, 64] {
            let grid = (1.5 * hertz.half_width, across * 3 / 2);
            let patch = Cylinders::press(&m, radius, line_load, grid, &ActiveSet).unwrap();
            let pressures = patch.pressures();
            let found = fit(&patch.x, &pressures).unwrap();
            let off = |a: f64, b: f64| (a / b - 1.0).abs();
            let peak = off(found.peak_pressure, hertz.peak_pressure);
            let width = off(found.half_width, hertz.half_width);
            println!("{plane:?} {across}: peak {peak:.2e} half-width {width:.2e}");
            assert!(peak < 0.01 && width < 0.01);
            for (x, p) in patch.x.iter().zip(&pressures) {
                // Away from the edges, where a cell averages a vertical tangent.
                if x.abs() < 0.85 * hertz.half_width {
                    assert!((p - hertz.pressure(*x)).abs() < 0.02 * hertz.peak_pressure);
                }
            }
            errors.push(peak);
        }
        assert!(errors[2] < 0.5 * errors[0]);
    }
}

/// Approach between points at any depth, in closed form.
#[test]
fn approach_between_matched_points() {
    let m = Elastic { young: 207e9, poisson: 0.3, density: 7595.0, plane: PlaneState::Strain };
    let (radius, line_load) = (10e-3, 2e5);
    let hertz = Hertz::new(line_load, radius, &m);
    let grid = (1.5 * hertz.half_width, 96);
    let patch = Cylinders::press(&m, radius, line_load, grid, &ActiveSet).unwrap();
    for times in [1.0, 3.0, 10.0, 40.0] {
        let depth = times * hertz.half_width;
        let (found, expected) = (patch.approach(&m, depth), 2.0 * hertz.compression(depth, &m));
        println!("{times}: {:.2e}", found / expected - 1.0);
        assert!((found / expected - 1.0).abs() < 2e-3, "{times}: {found:e} {expected:e}");
    }
}

/// The FZG C pair (16/24, module 4.5) under 200 N·m at its pitch point, where one pair carries all of it: a report
/// prints the 1347 MPa of Hertz, cylinders of radii r sin α pressed in plane strain. The 1 % are those of cylinders
/// above.
#[test]
fn the_pressure_at_the_pitch_point_is_that_of_hertz() {
    let scene = Scene::from_toml(
        "format = 1\nkind = \"gear_pair\"\nmesh = \"sun_planet\"\nteeth = { sun = 16, planet = 24 }\n\
         [geometry]\ncenter_distance_mm = 91.5\nface_width_mm = 14.0\nrack = { module_mm = 4.5 }\n\
         [geometry.sun]\ntip_diameter_mm = 82.636\nroot_diameter_mm = 62.386\n\
         bore_diameter_mm = 30\nfillet_radius_mm = 1.35\n\
         [geometry.planet]\ntip_diameter_mm = 118.544\nroot_diameter_mm = 98.294\n\
         bore_diameter_mm = 30\nfillet_radius_mm = 1.35\n\
         [geometry.thickness]\nprofile_shift = { sun = 0.1817, planet = 0.1715 }\n\
         [material]\nyoung_modulus_pa = 206e9\npoisson_ratio = 0.3\n",
    );
    let bodies = Bodies::new(&scene.unwrap()).unwrap();
    let mesh = bodies.geometry.mesh(MeshKind::SunPlanet).unwrap();
    let radius = bodies.geometry.sun.as_ref().unwrap().base_radius;
    let pitch_point = radius * mesh.pressure_angle.tan();
    let phase = (pitch_point - mesh.path_start) / mesh.base_pitch;
    let at = at_phase(&bodies, MeshKind::SunPlanet, 200.0 / radius, phase, &ActiveSet).unwrap();
    let [pair] = &at.pairs[..] else { panic!("{:?}", at.pairs) };
    let pressure = pair.peak_pressure / 1e6;
    println!("{pressure} MPa");
    assert!((pressure / 1347.0 - 1.0).abs() < 0.01, "{pressure} MPa");
}

/// A ring's tip that touches a planet of 18 teeth just where its involute starts, at the base circle: the flank's
/// radius of curvature vanishes there, and the mesh gives way as with tips a little lower.
#[test]
fn contact_reaches_down_to_the_base_circle() {
    let deflections = |roll_angle: f64| {
        let (base, reach) = (9e-3 * COS_20, 24e-3 * 20f64.to_radians().sin());
        let tip = 2e3 * (33e-3 * COS_20).hypot(reach + roll_angle * base);
        let scene = Scene::from_toml(&format!(
            "format = 1\nkind = \"gear_pair\"\nmesh = \"ring_planet\"\nteeth = {{ planet = 18, ring = 66 }}\n\
             [geometry]\nface_width_mm = 20\nrack = {{ module_mm = 1 }}\nring = {{ tip_diameter_mm = {tip} }}\n"
        ));
        let bodies = Bodies::new(&scene.unwrap()).unwrap();
        [0.0, 0.02, 0.5, 0.98].map(|phase| {
            at_phase(&bodies, MeshKind::RingPlanet, 300.0, phase, &ActiveSet).unwrap().deflection
        })
    };
    let lower = deflections(5e-4);
    for (found, lower) in deflections(1e-7).into_iter().zip(lower) {
        println!("{:.2e}", found / lower - 1.0);
        assert!((found / lower - 1.0).abs() < 0.01, "{found:e} {lower:e}");
    }
}

/// cos 20°.
const COS_20: f64 = 0.939_692_620_785_908_4;
