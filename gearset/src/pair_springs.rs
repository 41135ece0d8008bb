//! The simplest law of a mesh with a changing number of pairs: linear springs with gaps beyond the path of
//! contact.

use crate::mesh_curve::{CurveError, MeshCurve};

/// A mesh whose tooth pairs are springs of constant stiffness: without gap on the path of contact, with a gap
/// that grows with the square of the distance beyond its ends.
///
/// A closed form for tests and timing of solvers; forces of real teeth are tabulated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSprings {
    /// Stiffness of one pair, N/m.
    pub stiffness: f64,
    /// Contact ratio ε: the number of cycles for which a pair is on the path.
    pub contact_ratio: f64,
    /// Gap one tenth of a cycle beyond the path, m.
    pub gap_at_tenth: f64,
}

impl PairSprings {
    /// Gaps of all pairs near the path at a phase (cycles), m.
    fn gaps(&self, phase: f64) -> impl Iterator<Item = f64> {
        let (ratio, open) = (self.contact_ratio, self.gap_at_tenth);
        (-2..2 + ratio.ceil() as i32).map(move |pair| {
            let along = phase + f64::from(pair);
            let beyond = (-along).max(along - ratio).max(0.0);
            open * (10.0 * beyond).powi(2)
        })
    }

    /// Force (N) and tangent (N/m) at a phase and a deflection (m).
    pub fn force(&self, phase: f64, deflection: f64) -> (f64, f64) {
        let touching = self.gaps(phase).map(|gap| deflection - gap).filter(|d| *d >= 0.0);
        touching.fold((0.0, 0.0), |(force, tangent), d| {
            (force + self.stiffness * d, tangent + self.stiffness)
        })
    }

    /// The same as a table of `steps` equal steps from first contact to `reach_m`; the table smooths the kink
    /// where a further pair begins to touch.
    ///
    /// # Errors
    /// As [`MeshCurve::new`].
    pub fn curve(&self, phase: f64, reach_m: f64, steps: usize) -> Result<MeshCurve, CurveError> {
        let start = self.gaps(phase).fold(f64::INFINITY, f64::min);
        let step = (reach_m - start) / steps as f64;
        let at = |i: usize| self.force(phase, start + i as f64 * step);
        let (force, tangent): (Vec<f64>, Vec<f64>) = (0..=steps).map(at).unzip();
        MeshCurve::new(start, step, &force, &tangent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_come_and_go() {
        let mesh = PairSprings { stiffness: 2e8, contact_ratio: 1.6, gap_at_tenth: 5e-6 };
        // On the path are two pairs for 0.6 of a cycle and one for the rest; at phase 0.7 a second pair,
        // 0.1 cycle beyond the end of the path, touches from a deflection of 5 µm on.
        assert_eq!(mesh.force(0.3, 1e-6).1, 4e8);
        assert_eq!(mesh.force(0.8, 1e-6).1, 2e8);
        assert_eq!(mesh.force(0.7, 4e-6).1, 2e8);
        assert_eq!(mesh.force(0.7, 6e-6).1, 4e8);
        let curve = mesh.curve(0.7, 40e-6, 80).unwrap();
        for i in 0..40 {
            let d = f64::from(i) * 1e-6;
            assert!((curve.force(d).0 - mesh.force(0.7, d).0).abs() < 0.15 * 2e8 * curve.step_m());
        }
    }
}
