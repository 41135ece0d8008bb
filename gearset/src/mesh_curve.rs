//! The force of one mesh over its deflection, at one phase and on one flank, as a table.

use serde::{Deserialize, Serialize};

/// Why a table is not a valid mesh curve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// Too few nodes for a cubic.
    #[error("a mesh curve of {0} nodes: at least 2 are needed")]
    TooFew(usize),
    /// Unequal numbers of forces and tangents.
    #[error("a mesh curve with {forces} forces and {tangents} tangents")]
    Lengths {
        /// Number of forces.
        forces: usize,
        /// Number of tangents.
        tangents: usize,
    },
    /// A step that is not positive and finite.
    #[error("the deflections of a mesh curve are {0} m apart: that must be positive and finite")]
    Step(f64),
    /// A deflection of first contact that is not finite.
    #[error("a mesh curve starts at {0} m")]
    Start(f64),
    /// A force or tangent that is not finite, or a force at first contact that is not zero.
    #[error("node {node} of a mesh curve has force {force_n} N and tangent {tangent_n_per_m} N/m")]
    Node {
        /// Index of the node.
        node: usize,
        /// Its force, N.
        force_n: f64,
        /// Its tangent, N/m.
        tangent_n_per_m: f64,
    },
}

/// Mesh force and its derivatives at one deflection.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CurvePoint {
    /// F, N.
    pub force_n: f64,
    /// dF/dδ, N/m.
    pub tangent_n_per_m: f64,
    /// d²F/dδ², N/m²; it jumps at the nodes.
    pub slope_n_per_m2: f64,
}

/// Force of one flank of one mesh over its deflection δ, at one phase: piecewise cubic (Hermite) on
/// equal steps of δ, zero below the deflection of first contact, linear beyond the last node.
///
/// Force and tangent are continuous, except that the tangent jumps at first contact.
///
/// ```
/// use gearset::MeshCurve;
///
/// // F = δ² from 0 to 2, which a cubic represents exactly.
/// let curve = MeshCurve::new(0.0, 1.0, &[0.0, 1.0, 4.0], &[0.0, 2.0, 4.0]).unwrap();
/// assert_eq!(curve.force(1.5), (2.25, 3.0));
/// assert_eq!(curve.force(-1.0), (0.0, 0.0));
/// assert!(!curve.reaches(2.5));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Nodes", into = "Nodes")]
pub struct MeshCurve {
    start: f64,
    step: f64,
    per_step: f64,
    /// (F, h F') of each node, N.
    nodes: Vec<[f64; 2]>,
}

/// A curve as stored in files.
#[derive(Clone, Serialize, Deserialize)]
struct Nodes {
    start_m: f64,
    step_m: f64,
    force_n: Vec<f64>,
    tangent_n_per_m: Vec<f64>,
}

impl TryFrom<Nodes> for MeshCurve {
    type Error = CurveError;

    fn try_from(nodes: Nodes) -> Result<Self, CurveError> {
        Self::new(nodes.start_m, nodes.step_m, &nodes.force_n, &nodes.tangent_n_per_m)
    }
}

impl From<MeshCurve> for Nodes {
    fn from(curve: MeshCurve) -> Self {
        Self {
            start_m: curve.start,
            step_m: curve.step,
            force_n: curve.nodes.iter().map(|n| n[0]).collect(),
            tangent_n_per_m: curve.nodes.iter().map(|n| n[1] / curve.step).collect(),
        }
    }
}

impl MeshCurve {
    /// A curve from first contact at `start_m` on, with forces (N) and tangents (N/m) at steps of
    /// `step_m` in deflection. The first tangent is the one just after contact.
    ///
    /// # Errors
    /// If there are fewer than two nodes, unequal numbers of forces and tangents, a number that is not
    /// finite, a step that is not positive, or a first force that is not zero.
    pub fn new(
        start_m: f64,
        step_m: f64,
        force_n: &[f64],
        tangent_n_per_m: &[f64],
    ) -> Result<Self, CurveError> {
        let (forces, tangents) = (force_n.len(), tangent_n_per_m.len());
        if forces != tangents {
            return Err(CurveError::Lengths { forces, tangents });
        }
        if forces < 2 {
            return Err(CurveError::TooFew(forces));
        }
        if !(step_m > 0.0 && step_m.is_finite()) {
            return Err(CurveError::Step(step_m));
        }
        if !start_m.is_finite() {
            return Err(CurveError::Start(start_m));
        }
        let mut nodes = Vec::with_capacity(forces);
        for (node, (force_n, tangent_n_per_m)) in force_n.iter().zip(tangent_n_per_m).enumerate() {
            let (force_n, tangent_n_per_m) = (*force_n, *tangent_n_per_m);
            let is_sound = force_n.is_finite() && tangent_n_per_m.is_finite();
            if !is_sound || (node == 0 && force_n != 0.0) {
                return Err(CurveError::Node { node, force_n, tangent_n_per_m });
            }
            nodes.push([force_n, tangent_n_per_m * step_m]);
        }
        Ok(Self { start: start_m, step: step_m, per_step: 1.0 / step_m, nodes })
    }

    /// Force (N) and tangent (N/m) at a deflection (m).
    #[inline]
    pub fn force(&self, deflection_m: f64) -> (f64, f64) {
        let at = self.at(deflection_m);
        (at.force_n, at.tangent_n_per_m)
    }

    /// Force, tangent and the tangent's slope at a deflection (m).
    ///
    /// `[eq:mesh-curve]` F = f₀ + s m₀ + s² (3Δ − 2m₀ − m₁) + s³ (m₀ + m₁ − 2Δ) between two nodes, s from 0 to 1,
    /// Δ = f₁ − f₀, m = h F'.
    /// Source: definition (cubic Hermite pieces).
    /// Checked by: `gearset/src/mesh_curve.rs::a_parabola_is_held_exactly_and_the_tangents_are_derivatives`.
    #[inline]
    pub fn at(&self, deflection_m: f64) -> CurvePoint {
        let t = (deflection_m - self.start) * self.per_step;
        // False for NaN, which then gives a NaN force instead of a mesh without contact.
        if t <= 0.0 {
            return CurvePoint::default();
        }
        let i = t as usize;
        let Some([[f0, m0], [f1, m1]]) = self.nodes.get(i..i.saturating_add(2)).and_then(pair)
        else {
            return self.beyond(t);
        };
        let s = t - i as f64;
        let rise = f1 - f0;
        let d = m0 + m1 - 2.0 * rise;
        let c = rise - m0 - d;
        CurvePoint {
            force_n: f0 + s * (m0 + s * (c + s * d)),
            tangent_n_per_m: (m0 + s * (2.0 * c + 3.0 * s * d)) * self.per_step,
            slope_n_per_m2: (2.0 * c + 6.0 * s * d) * self.per_step * self.per_step,
        }
    }

    /// Linear continuation beyond the last node.
    #[cold]
    fn beyond(&self, t: f64) -> CurvePoint {
        let last = self.nodes.len() - 1;
        let [force, rise] = self.nodes[last];
        CurvePoint {
            force_n: force + rise * (t - last as f64),
            tangent_n_per_m: rise * self.per_step,
            slope_n_per_m2: 0.0,
        }
    }

    /// Deflection (m) under a force (N): the least one, where several have this force. `None` unless the force is
    /// positive and finite, or where no deflection has it.
    pub fn deflection(&self, force_n: f64) -> Option<f64> {
        if !(force_n > 0.0 && force_n.is_finite()) {
            return None;
        }
        let Some(above) = self.nodes.iter().position(|node| node[0] >= force_n) else {
            // Linear beyond the last node.
            let [force, rise] = *self.nodes.last()?;
            let further = (force_n - force) / rise;
            let is_reached = further.is_finite() && further >= 0.0;
            return is_reached.then(|| self.end_m() + further * self.step);
        };
        // The force is below at the node before, which may be that of first contact.
        let at = |node: usize| self.start + node as f64 * self.step;
        let (mut low, mut high) = (at(above.checked_sub(1)?), at(above));
        // As often as halves differ in double precision.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.force(middle).0 < force_n { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }

    /// Deflection of first contact, m.
    pub fn start_m(&self) -> f64 {
        self.start
    }

    /// Deflection of the last node, m.
    pub fn end_m(&self) -> f64 {
        self.start + (self.nodes.len() - 1) as f64 * self.step
    }

    /// Spacing of the nodes, m.
    pub fn step_m(&self) -> f64 {
        self.step
    }

    /// Whether this deflection (m) is not beyond the last node; below first contact it always is not.
    pub fn reaches(&self, deflection_m: f64) -> bool {
        deflection_m <= self.end_m()
    }

    /// Force (N) and tangent (N/m) of every node.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = (f64, f64)> + '_ {
        self.nodes.iter().map(|[force, rise]| (*force, rise / self.step))
    }

    /// The same curve for flanks that stand `apart_m` further apart.
    pub fn moved(&self, apart_m: f64) -> Self {
        Self { start: self.start + apart_m, ..self.clone() }
    }
}

#[inline]
fn pair(nodes: &[[f64; 2]]) -> Option<[[f64; 2]; 2]> {
    nodes.first_chunk().copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_deflection_has_the_force_that_was_asked_for() {
        let curve = hertzian(9);
        let last = curve.force(curve.end_m()).0;
        for share in [1e-9, 0.1, 0.5, 1.0, 1.7] {
            let found = curve.deflection(share * last).unwrap();
            assert!((curve.force(found).0 / (share * last) - 1.0).abs() < 1e-9, "{share}");
        }
        // F = δ² with nodes at 0, 1 and 2 in closed form.
        let square = MeshCurve::new(0.0, 1.0, &[0.0, 1.0, 4.0], &[0.0, 2.0, 4.0]).unwrap();
        assert!((square.deflection(2.0).unwrap() - 2f64.sqrt()).abs() < 1e-15);
        // Beyond the last node the curve goes on along its tangent.
        assert!((square.deflection(6.0).unwrap() - 2.5).abs() < 1e-15);
        for refused in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(square.deflection(refused), None);
        }
        let level = MeshCurve::new(0.0, 1.0, &[0.0, 1.0], &[1.0, 0.0]).unwrap();
        assert_eq!(level.deflection(1.5), None);
    }

    /// F = k x (1 + 10⁴ x) with x = δ − s in m, and its exact tangent.
    fn hertzian(nodes: usize) -> MeshCurve {
        let (k, start, end) = (3e8, 2e-6, 40e-6);
        let step = (end - start) / (nodes - 1) as f64;
        let at = |i: usize| i as f64 * step;
        let force: Vec<f64> = (0..nodes).map(|i| k * at(i) * (1.0 + 1e4 * at(i))).collect();
        let tangent: Vec<f64> = (0..nodes).map(|i| k * (1.0 + 2e4 * at(i))).collect();
        MeshCurve::new(start, step, &force, &tangent).unwrap()
    }

    #[test]
    fn a_parabola_is_held_exactly_and_the_tangents_are_derivatives() {
        let curve = hertzian(9);
        for i in 0..400 {
            let d = -5e-6 + 0.15e-6 * f64::from(i);
            let x = (d - 2e-6).clamp(0.0, 38e-6);
            let past = (d - 40e-6).max(0.0);
            let exact = 3e8 * x * (1.0 + 1e4 * x) + past * 3e8 * (1.0 + 2e4 * 38e-6);
            assert!((curve.force(d).0 - exact).abs() < 1e-9 * 3e8 * 38e-6, "{d:e}");
            let e = 1e-10;
            let (low, high, here) = (curve.at(d - e), curve.at(d + e), curve.at(d));
            // Left out: a node or first contact lies between the two deflections.
            if low.slope_n_per_m2 != high.slope_n_per_m2 {
                continue;
            }
            let tangent = (high.force_n - low.force_n) / (2.0 * e);
            let slope = (high.tangent_n_per_m - low.tangent_n_per_m) / (2.0 * e);
            assert!((tangent - here.tangent_n_per_m).abs() < 1e-5 * 3e8, "{d:e}");
            assert!((slope - here.slope_n_per_m2).abs() < 1e-3 * 6e12, "{d:e}");
        }
        assert!(curve.reaches(39e-6) && curve.reaches(-1.0) && !curve.reaches(41e-6));
    }

    #[test]
    fn what_is_no_number_stays_none() {
        assert!(hertzian(5).force(f64::NAN).0.is_nan());
        assert_eq!(hertzian(5).force(f64::INFINITY).0, f64::INFINITY);
    }

    #[test]
    fn nodes_that_make_no_curve_are_refused() {
        let refused =
            |start, step, f: &[f64], t: &[f64]| MeshCurve::new(start, step, f, t).is_err();
        assert!(refused(0.0, 1.0, &[0.0], &[1.0]));
        assert!(refused(0.0, 1.0, &[0.0, 1.0], &[1.0]));
        assert!(refused(0.0, 0.0, &[0.0, 1.0], &[1.0, 1.0]));
        assert!(refused(f64::NAN, 1.0, &[0.0, 1.0], &[1.0, 1.0]));
        assert!(refused(0.0, 1.0, &[0.5, 1.0], &[1.0, 1.0]));
        assert!(refused(0.0, 1.0, &[0.0, f64::NAN], &[1.0, 1.0]));
    }
}
