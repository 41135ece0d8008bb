//! Two cylinders as half-planes with circular gaps, against Hertz's closed forms.

use fe_contact::Elastic;
use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::cylinders::Cylinders;
use fe_contact::contact::hertz::{Hertz, fit};
use scene::PlaneState;

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
