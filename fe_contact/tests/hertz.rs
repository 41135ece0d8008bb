//! Two cylinders as half-planes with circular gaps, against Hertz's closed forms.

use fe_contact::Elastic;
use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, Problem};
use fe_contact::contact::half_plane::HalfPlane;
use fe_contact::contact::hertz::{Hertz, fit};
use gearset::PlaneState;
use nalgebra::DMatrix;

/// A patch in equilibrium with a line load.
struct Patch {
    x: Vec<f64>,
    forces: Vec<f64>,
    width: f64,
    /// Approach of the surfaces in the half-plane's own datum, m.
    datum: f64,
}

/// Cells between two equal bodies under `line_load` (N/m).
fn press(m: &Elastic, radius: f64, line_load: f64, reach: f64, cells: usize) -> Patch {
    let width = 2.0 * reach / cells as f64;
    let x: Vec<f64> = (0..cells).map(|i| -reach + (i as f64 + 0.5) * width).collect();
    let half = HalfPlane::new(m);
    // A half-plane is known up to a constant: one that makes the matrix positive definite.
    let far = -2.0 * half.strip(0.0, 1.0, 0.5 * width) / width;
    let compliance = DMatrix::from_fn(cells, cells, |i, j| {
        2.0 * half.strip(x[i] - x[j], 0.0, 0.5 * width) / width + far
    });
    // Bisection on the approach, the total force growing with it.
    let (mut low, mut high) = (0.0, 1e-2);
    let mut forces = Vec::new();
    for _ in 0..200 {
        let approach = 0.5 * (low + high);
        let gaps: Vec<f64> = x.iter().map(|x| x * x / (2.0 * radius) - approach).collect();
        let problem = Problem { compliance: &compliance, gaps: &gaps };
        forces = ActiveSet.solve(&problem, None).unwrap().forces;
        if forces.iter().sum::<f64>() < line_load { low = approach } else { high = approach }
    }
    Patch { x, forces, width, datum: low - far * line_load }
}

impl Patch {
    /// Approach between the points at `depth` below the centre in both bodies, m.
    fn approach(&self, m: &Elastic, depth: f64) -> f64 {
        let half = HalfPlane::new(m);
        let deep = self
            .x
            .iter()
            .zip(&self.forces)
            .map(|(x, f)| 2.0 * f * half.strip(*x, depth, 0.5 * self.width) / self.width);
        self.datum - deep.sum::<f64>()
    }
}

#[test]
fn profile_half_width_and_approach() {
    let (radius, line_load) = (8.3e-3, 4.2e5);
    for plane in [PlaneState::Strain, PlaneState::Stress] {
        let m = Elastic { young: 207e9, poisson: 0.3, density: 7595.0, plane };
        let hertz = Hertz::new(line_load, radius, &m);
        // 16 cells across the patch: reach 1.5 a with 24 cells.
        let mut errors = Vec::new();
        for across in [16usize, 32, 64] {
            let patch = press(&m, radius, line_load, 1.5 * hertz.half_width, across * 3 / 2);
            let Patch { x, forces, width, .. } = &patch;
            let pressures: Vec<f64> = forces.iter().map(|f| f / width).collect();
            let found = fit(x, &pressures).unwrap();
            let off = |a: f64, b: f64| (a / b - 1.0).abs();
            let (peak, width_off) = (
                off(found.peak_pressure, hertz.peak_pressure),
                off(found.half_width, hertz.half_width),
            );
            println!("{plane:?} {across}: peak {peak:.2e} half-width {width_off:.2e}");
            assert!(peak < 0.01 && width_off < 0.01);
            for (x, p) in x.iter().zip(&pressures) {
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
    let patch = press(&m, radius, line_load, 1.5 * hertz.half_width, 96);
    for times in [1.0, 3.0, 10.0, 40.0] {
        let depth = times * hertz.half_width;
        let (found, expected) = (patch.approach(&m, depth), 2.0 * hertz.compression(depth, &m));
        println!("{times}: {:.2e}", found / expected - 1.0);
        assert!((found / expected - 1.0).abs() < 2e-3, "{times}: {found:e} {expected:e}");
    }
}
