//! One mesh at a deflection: forces of its pairs, and the deflection at which it carries a given
//! force.

use nalgebra::DMatrix;

use crate::complementarity::ActiveSet;
use crate::contact::{MeshAnswer, MeshTable, PairCells};
use crate::error::FeError;

/// Approaches of a mesh's pairs over its deflection δ: a δ + o each.
#[derive(Debug, Clone)]
pub(super) struct Approaches {
    /// a.
    pub(super) arms: Vec<f64>,
    /// o, m.
    pub(super) extra: Vec<f64>,
}

impl Approaches {
    fn at(&self, deflection: f64) -> Vec<f64> {
        self.arms.iter().zip(&self.extra).map(|(a, o)| a * deflection + o).collect()
    }
}

/// A mesh at a deflection.
pub(super) struct DeflectedMesh {
    /// F = Σ a P, the derivative of the contact potential Ψ with respect to δ, N.
    pub(super) force: f64,
    /// dF/dδ, N/m.
    pub(super) stiffness: f64,
    /// P, N.
    pub(super) pair_forces: Vec<f64>,
    /// Tangent between the pairs, N/m.
    pub(super) tangent: DMatrix<f64>,
}

/// A mesh at a deflection (m); `warm` is the guess of the cells in contact, and receives those
/// found.
pub(super) fn at(
    table: &MeshTable,
    along: &Approaches,
    deflection: f64,
    warm: &mut Option<Vec<bool>>,
) -> Result<DeflectedMesh, FeError> {
    let (approaches, arms) = (along.at(deflection), &along.arms);
    let none = vec![0.0; arms.len()];
    let answer = table.answer(&approaches, &none, &ActiveSet, warm.as_deref())?;
    let force = answer.pair_forces.iter().zip(arms).map(|(p, a)| p * a).sum();
    let mut stiffness = 0.0;
    for (k, a) in arms.iter().enumerate() {
        for (l, b) in arms.iter().enumerate() {
            stiffness += a * answer.tangent[(k, l)] * b;
        }
    }
    *warm = Some(answer.active.clone());
    let MeshAnswer { pair_forces, tangent, .. } = answer;
    Ok(DeflectedMesh { force, stiffness, pair_forces, tangent })
}

/// Deflection at which a mesh carries at least a force (N), and at most 2 % more, m.
pub(super) fn deflection_for(
    table: &MeshTable,
    along: &Approaches,
    force: f64,
) -> Result<f64, FeError> {
    let start = first_contact(table, along);
    let mut warm = None;
    // The first stiffness is about that of one pair of steel teeth.
    let mut delta = start + force / (2.0e9 * table.face_width * 10.0);
    for _ in 0..60 {
        let found = at(table, along, delta, &mut warm)?;
        if found.force >= force && found.force <= 1.02 * force {
            return Ok(delta);
        }
        let (reach, k) = (delta - start, found.stiffness);
        let change = if k > 0.0 { (1.005 * force - found.force) / k } else { reach };
        delta += change.clamp(-0.5 * reach, 2.0 * reach);
    }
    Err(FeError::NoEquilibrium(format!(
        "no deflection gives {force:.0} N at mesh phase {:.4}",
        table.phase
    )))
}

/// Deflection at which the first cell touches, m.
pub(super) fn first_contact(table: &MeshTable, along: &Approaches) -> f64 {
    let of = |(k, pair): (usize, &PairCells)| {
        let own = &table.gaps[pair.first..pair.first + pair.x.len()];
        (own.iter().fold(f64::INFINITY, |a, g| a.min(*g)) - along.extra[k]) / along.arms[k]
    };
    table.pairs.iter().enumerate().map(of).fold(f64::INFINITY, f64::min)
}
