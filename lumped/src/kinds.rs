//! The kinds of modes as invariant subspaces (Lin & Parker 1999; 2000 for unequal spacing).
//!
//! For equal planets at positions with Σ e^{iψ_n} = 0, the space of all motions splits into three uncoupled
//! subspaces: rotations of the central members with equal motion of all planets; translations of the central
//! members with planet motions proportional to cos ψ_n and sin ψ_n; and planet motions without net force or
//! torque on the central members. Held coordinates are left out of them.

use gearset::{Axis, Body};
use nalgebra::DMatrix;
use serde::Serialize;

use dynamics::orthonormal_basis;

use crate::model::LumpedModel;

/// Kind of a mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ModeType {
    /// Central members only rotate, planets all move alike.
    Rotational,
    /// Central members only translate.
    Translational,
    /// Only planets move.
    Planet,
    /// None of the three: the set lacks the symmetry.
    Mixed,
}

impl ModeType {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Rotational, Self::Translational, Self::Planet, Self::Mixed];

    /// Name as in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::Rotational => "rotational",
            Self::Translational => "translational",
            Self::Planet => "planet",
            Self::Mixed => "mixed",
        }
    }

    pub(crate) fn of_kind(kind: Option<usize>) -> Self {
        match kind {
            Some(0) => Self::Rotational,
            Some(1) => Self::Translational,
            Some(_) => Self::Planet,
            None => Self::Mixed,
        }
    }
}

/// A vector given by its non-zero entries.
type Sparse = Vec<(usize, f64)>;

/// Orthonormal bases, in M^½-scaled coordinates, of the rotational and the translational kind; the
/// rest of the space is the planet kind.
pub(crate) struct Kinds([Vec<Sparse>; 2]);

impl Kinds {
    /// The kinds of a model.
    ///
    /// `[eq:mode-kinds]` Rotational: rotations of the central members, all planets alike. Translational: translations
    /// of the central members, planets as cos ψ_n and sin ψ_n. Planet: what is M-orthogonal to both.
    /// Source: Lin & Parker (1999; 2000 for unequal spacing).
    /// Checked by: `structure.spectrum`, `structure.diametrical`, `structure.mirror`.
    pub(crate) fn of(model: &LumpedModel) -> Self {
        let index = |body, axis| model.coordinates.of(body, axis);
        let central = Body::CENTRAL.into_iter();
        let single = |axis| central.clone().filter_map(move |b| Some(vec![(index(b, axis)?, 1.0)]));
        let mut rotational: Vec<Sparse> = single(Axis::Rotation).collect();
        let mut translational: Vec<Sparse> =
            single(Axis::First).chain(single(Axis::Second)).collect();
        for axis in Axis::ALL {
            let planets: Vec<usize> =
                (0..model.psi.len()).filter_map(|n| index(Body::Planet(n), axis)).collect();
            let pattern = |weight: &dyn Fn(f64) -> f64| -> Vec<f64> {
                let each = planets.iter().zip(&model.psi);
                each.map(|(&i, &psi)| model.mass[i].sqrt() * weight(psi)).collect()
            };
            let alike = orthonormal_basis(&[pattern(&|_| 1.0)], &[]);
            let around = orthonormal_basis(&[pattern(&f64::cos), pattern(&f64::sin)], &alike);
            let sparse = |v: Vec<f64>| planets.iter().copied().zip(v).collect::<Sparse>();
            rotational.extend(alike.into_iter().map(sparse));
            translational.extend(around.into_iter().map(sparse));
        }
        Self([rotational, translational])
    }

    /// The bases as matrices (n×m), in M^½-scaled coordinates.
    pub(crate) fn bases(&self, n: usize) -> [DMatrix<f64>; 2] {
        self.0.each_ref().map(|basis| {
            let mut matrix = DMatrix::zeros(n, basis.len());
            for (column, vector) in basis.iter().enumerate() {
                vector.iter().for_each(|&(i, b)| matrix[(i, column)] = b);
            }
            matrix
        })
    }

    /// Rows of B_kᵀ Q of both kinds for a Q (n×m) given by its entries.
    pub(crate) fn projections(
        &self,
        m: usize,
        q: impl Fn(usize, usize) -> f64,
    ) -> [Vec<Vec<f64>>; 2] {
        let row = |b: &Sparse| -> Vec<f64> {
            (0..m).map(|column| b.iter().map(|&(i, b)| b * q(i, column)).sum()).collect()
        };
        let project = |basis: &Vec<Sparse>| basis.iter().map(row).collect();
        [project(&self.0[0]), project(&self.0[1])]
    }
}
