//! The kinds of modes as invariant subspaces (Lin & Parker 1999; 2000 for unequal spacing).
//!
//! For equal planets that stand so that Σ e^{iψ_n} = 0, the space of all motions falls apart into
//! three subspaces that do not exchange energy: rotations of the central members with all planets
//! alike; translations of the central members with planets following cos ψ_n and sin ψ_n; and
//! planet motions that neither push nor turn anything. Held coordinates only drop out of them.

use faer::Mat;
use serde::Serialize;

use dynamics::orthonormal_basis;

use crate::coordinates::{Axis, Body};
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

/// Orthonormal bases (in M^½-scaled coordinates) of the rotational and the translational kind; the
/// rest of the space is the planet kind.
pub(crate) fn kinds(model: &LumpedModel) -> [Mat<f64>; 2] {
    let n = model.coordinates.count();
    let root: Vec<f64> = model.mass.iter().map(|m| m.sqrt()).collect();
    let single = |body, axis| {
        model.coordinates.of(body, axis).map(|i| {
            let mut v = vec![0.0; n];
            v[i] = 1.0;
            v
        })
    };
    let pattern = |axis, weight: &dyn Fn(f64) -> f64| {
        let mut v = vec![0.0; n];
        for (p, &psi) in model.psi.iter().enumerate() {
            if let Some(i) = model.coordinates.of(Body::Planet(p), axis) {
                v[i] = root[i] * weight(psi);
            }
        }
        v
    };
    let central = [Body::Carrier, Body::Ring, Body::Sun];
    let mut rotational: Vec<Vec<f64>> =
        central.iter().filter_map(|&b| single(b, Axis::Rotation)).collect();
    rotational.extend(Axis::ALL.map(|axis| pattern(axis, &|_| 1.0)));
    let rotational = orthonormal_basis(&rotational, None);
    let mut translational: Vec<Vec<f64>> = central
        .iter()
        .flat_map(|&b| [single(b, Axis::First), single(b, Axis::Second)])
        .flatten()
        .collect();
    for axis in Axis::ALL {
        translational.push(pattern(axis, &f64::cos));
        translational.push(pattern(axis, &f64::sin));
    }
    let translational = orthonormal_basis(&translational, Some(&rotational));
    [rotational, translational]
}
