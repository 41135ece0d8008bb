//! The simplest law of a mesh with a changing number of pairs: springs with tip gaps.

use crate::mesh_curve::{CurveError, MeshCurve};

/// A mesh of tooth pairs that are springs each: constant stiffness on the path of contact, a gap that
/// opens with the square of the distance beyond its ends.
///
/// A closed form to test and to time solvers with; real teeth come as tables.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairSprings {
    /// Stiffness of one pair, N/m.
    pub stiffness: f64,
    /// Contact ratio ε: a pair is on the path for so many cycles.
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

    /// The same as a table of so many steps, rounded where a pair begins to touch.
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
        // Two pairs for 0.6 of a cycle, one for the rest; a third and a second by their gaps.
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
