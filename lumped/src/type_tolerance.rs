//! How unequal planets may be before the types of modes stop meaning anything.
//!
//! If planet n is heavier by a part δ (mass and inertia), mode i with eigenvalue λ_i takes on part of mode j, with
//! e_ij = φ_iᵀ ∂M/∂δ φ_j and φ M-orthonormal,
//!
//! ```text
//! φ_i → φ_i − δ Σ_j λ_i e_ij/(λ_i − λ_j) φ_j
//! ```
//!
//! to leading order in the mixing of kinds; within its kind, where near frequencies mix most, the mode is that of the
//! changed set. λ is λ_i, but λ_j where j is of a kind before that of i in the order rotational, translational,
//! planet: shares are projections in the changed M on the first kinds, and the last kinds are what they leave.
//! Modes of different kinds that coincide have no tolerance at all.

use dynamics::IMPURE;
use gearset::Body;
use nalgebra::{DMatrix, SymmetricEigen};
use serde::Serialize;

use crate::error::LumpedError;
use crate::kinds::ModeType;
use crate::model::LumpedModel;
use crate::modes::{ModeGroup, NaturalModes};
use crate::type_name::type_name;

/// Part of a planet's mass that scenes leave open: half a unit in the third digit.
const OPEN_MASS: f64 = 5e-4;

/// How much heavier one planet may be before a mode's type is lost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TypeTolerance {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Type in the set as it is.
    pub mode_type: ModeType,
    /// Part by which a planet may be heavier with at most 1e-6 of the mode outside its kind: beyond, it is listed as
    /// mixed.
    pub pure_up_to: f64,
    /// Part at which half of the mode would be outside its kind, by the same formula: beyond, the type means nothing.
    pub half_up_to: f64,
    /// Frequency of the mode of another kind that it mixes with most, Hz.
    pub nearest_hz: f64,
    /// Type of that mode.
    pub nearest_type: ModeType,
}

impl LumpedModel {
    /// The same model with one planet heavier by a part δ in mass and inertia.
    ///
    /// # Errors
    /// If there is no such planet, or its mass would not be positive and finite.
    pub fn with_heavier_planet(&self, planet: usize, part: f64) -> Result<Self, LumpedError> {
        let count = self.psi.len();
        if planet >= count {
            return Err(LumpedError::NoSuchPlanet { planet, count });
        }
        if !(part > -1.0 && part.is_finite()) {
            return Err(LumpedError::Heavier { part });
        }
        let mut changed = self.clone();
        for (m, (body, _)) in changed.mass.iter_mut().zip(self.coordinates.free()) {
            if *body == Body::Planet(planet) {
                *m *= 1.0 + part;
            }
        }
        Ok(changed)
    }
}

/// The tolerance of each group of modes whose type is pure, over the planets the smallest; modes of a group split,
/// and the smallest counts. Rigid-body modes and mixed ones are left out.
fn type_tolerances(model: &LumpedModel, modes: &NaturalModes) -> Vec<TypeTolerance> {
    let lesser = |(all, own): (TypeTolerance, TypeTolerance)| {
        if own.pure_up_to < all.pure_up_to { own } else { all }
    };
    (0..model.psi.len())
        .map(|planet| tolerances_to(model, modes, planet))
        .reduce(|all, own| all.into_iter().zip(own).map(lesser).collect())
        .unwrap_or_default()
}

/// The same for one planet.
pub fn tolerances_to(
    model: &LumpedModel,
    modes: &NaturalModes,
    planet: usize,
) -> Vec<TypeTolerance> {
    let pure = |g: &&ModeGroup| g.mode_type != ModeType::Mixed && g.lambda > 0.0;
    modes.groups.iter().filter(pure).map(|g| tolerance(model, modes, planet, g)).collect()
}

/// Corrections of δ: modes of the own kind change with δ, and δ with them.
const CORRECTIONS: usize = 12;

fn tolerance(
    model: &LumpedModel,
    modes: &NaturalModes,
    planet: usize,
    group: &ModeGroup,
) -> TypeTolerance {
    // Small enough to be leading order, large enough to split a group.
    let mut part = 1e-6;
    let mut found = (0.0, 0.0, group);
    for _ in 0..CORRECTIONS {
        found = lost_rate(model, modes, planet, group, part);
        let next = (IMPURE / found.0).sqrt();
        // δ itself is within 0.3 % of where a mode turns mixed: more digits of it say nothing.
        if !next.is_finite() || next > 0.5 || (next / part - 1.0).abs() < 1e-6 {
            break;
        }
        part = next;
    }
    let (most, _, nearest) = found;
    TypeTolerance {
        frequency_hz: group.frequency_hz,
        mode_type: group.mode_type,
        pure_up_to: (IMPURE / most).sqrt(),
        half_up_to: (0.5 / most).sqrt(),
        nearest_hz: nearest.frequency_hz,
        nearest_type: nearest.mode_type,
    }
}

/// Lost share over δ² of the worst mode of a group at δ, the part of it due to one other group, and that group.
///
/// `[eq:heavier-planet]` Share of a mode that a planet heavier by a part δ takes out of its kind: δ² Σ_j (λ
/// e_ij/(λ_i − λ_j))² over modes j of other kinds.
/// Source: perturbation theory, derived here.
/// Checked by: `lumped/tests/type_tolerance.rs::modes_turn_mixed_where_perturbation_theory_says`.
fn lost_rate<'m>(
    model: &LumpedModel,
    modes: &'m NaturalModes,
    planet: usize,
    group: &'m ModeGroup,
    part: f64,
) -> (f64, f64, &'m ModeGroup) {
    let own = own_kind(model, modes, planet, group, part);
    let mut lost = vec![0.0; own.len()];
    let mut nearest = (0.0, group);
    for other in modes.groups.iter().filter(|o| o.mode_type != group.mode_type) {
        for (lost, (lambda, vector)) in lost.iter_mut().zip(&own) {
            let e = coupling(model, planet, vector, &other.vectors).norm_squared();
            let first = if other.mode_type < group.mode_type { other.lambda } else { *lambda };
            let factor = first / (lambda - other.lambda);
            // Uncoupled modes of one frequency do not mix.
            let rate = if e > 0.0 { factor * factor * e } else { 0.0 };
            *lost += rate;
            if rate > nearest.0 {
                nearest = (rate, other);
            }
        }
    }
    (lost.iter().fold(0.0f64, |a, b| a.max(*b)), nearest.0, nearest.1)
}

/// Eigenvalues and vectors (n×1) that a group's modes have become by mixing with those of their own kind, without
/// the other kinds: Λ c = λ (I + δ E) c over the modes of the kind.
fn own_kind(
    model: &LumpedModel,
    modes: &NaturalModes,
    planet: usize,
    group: &ModeGroup,
    part: f64,
) -> Vec<(f64, DMatrix<f64>)> {
    let kind: Vec<&ModeGroup> = modes.of_type(group.mode_type).collect();
    let columns: Vec<_> =
        kind.iter().flat_map(|g| g.vectors.column_iter().map(|c| (g.lambda, c))).collect();
    let of_group: Vec<bool> = kind
        .iter()
        .flat_map(|g| std::iter::repeat_n(std::ptr::eq(*g, group), g.multiplicity))
        .collect();
    let basis = DMatrix::from_fn(model.mass.len(), columns.len(), |i, j| columns[j].1[i]);
    let e = coupling(model, planet, &basis, &basis);
    let shifted = DMatrix::identity(columns.len(), columns.len()) + e * part;
    // I + δE is positive definite for every δ above −1; without a factor the modes stay as they are.
    let unchanged = || {
        group
            .vectors
            .column_iter()
            .map(|c| (group.lambda, c.into_owned()))
            .map(|(l, c)| (l, DMatrix::from_column_slice(c.len(), 1, c.as_slice())))
    };
    let Some(l) = shifted.cholesky().map(|c| c.l()) else { return unchanged().collect() };
    let Some(inverse) = l.solve_lower_triangular(&DMatrix::identity(l.nrows(), l.nrows())) else {
        return unchanged().collect();
    };
    let lambda =
        DMatrix::from_fn(
            columns.len(),
            columns.len(),
            |i, j| {
                if i == j { columns[i].0 } else { 0.0 }
            },
        );
    let solved = SymmetricEigen::new(&inverse * lambda * inverse.transpose());
    let mixed = inverse.transpose() * solved.eigenvectors;
    // Those with most of the group in them.
    let share = |j: usize| -> f64 {
        (0..of_group.len()).filter(|&i| of_group[i]).map(|i| mixed[(i, j)].powi(2)).sum()
    };
    let mut order: Vec<usize> = (0..columns.len()).collect();
    order.sort_by(|a, b| share(*b).total_cmp(&share(*a)));
    order
        .into_iter()
        .take(group.multiplicity)
        .map(|j| (solved.eigenvalues[j], &basis * mixed.columns(j, 1)))
        .collect()
}

/// Aᵀ ∂M/∂δ B over the coordinates of a planet.
fn coupling(
    model: &LumpedModel,
    planet: usize,
    a: &DMatrix<f64>,
    b: &DMatrix<f64>,
) -> DMatrix<f64> {
    let own: Vec<usize> = (0..model.mass.len())
        .filter(|&i| model.coordinates.free()[i].0 == Body::Planet(planet))
        .collect();
    DMatrix::from_fn(a.ncols(), b.ncols(), |i, j| {
        own.iter().map(|&k| a[(k, i)] * model.mass[k] * b[(k, j)]).sum()
    })
}

/// What a reader of types must know, in two sentences at most: modes whose type an unequal planet within the open
/// digits of its mass would take away, and mixed modes that have most of their motion in one kind. Empty where
/// types can be relied on, and of one planet, beside which none can be unequal.
pub fn type_warnings(model: &LumpedModel, modes: &NaturalModes) -> Vec<String> {
    if model.psi.len() == 1 {
        return Vec::new();
    }
    [close_modes(model, modes), nearly_pure(modes)].into_iter().flatten().collect()
}

/// Modes that a planet heavier by less than [`OPEN_MASS`] mixes.
fn close_modes(model: &LumpedModel, modes: &NaturalModes) -> Option<String> {
    let mut pairs: Vec<[(f64, &str); 2]> = Vec::new();
    let mut least = OPEN_MASS;
    let name = |hz: f64, mode_type: ModeType| {
        let group = modes.of_type(mode_type).find(|g| g.frequency_hz == hz);
        group.map_or(mode_type.name(), |group| type_name(model, group))
    };
    for t in type_tolerances(model, modes).iter().filter(|t| t.half_up_to < OPEN_MASS) {
        let one = (t.frequency_hz, name(t.frequency_hz, t.mode_type));
        let other = (t.nearest_hz, name(t.nearest_hz, t.nearest_type));
        // Modes of one name are one group to the reader; each of two modes has the other as its nearest.
        if one.1 != other.1 && !pairs.contains(&[other, one]) {
            pairs.push([one, other]);
            least = least.min(t.half_up_to);
        }
    }
    let each: Vec<String> = pairs
        .iter()
        .map(|[(f, one), (g, other)]| format!("{one} at {f:.2} Hz and {other} at {g:.2} Hz"))
        .collect();
    // Below the rounding of frequencies they coincide.
    let how_much = match least < 1e-9 {
        true => "however little heavier".to_owned(),
        false => format!("heavier by {least:.1e} of its mass"),
    };
    (!each.is_empty()).then(|| {
        format!(
            "modes lie so close that a planet {how_much} mixes their types: {}; read each two as one group, or separate them by \
             another stiffness",
            each.join(", ")
        )
    })
}

/// Mixed modes that would be of one type if the planets were equal.
fn nearly_pure(modes: &NaturalModes) -> Option<String> {
    let mut least = 1.0f64;
    let mut each = Vec::new();
    for g in modes.of_type(ModeType::Mixed).filter(|g| g.lambda > 0.0) {
        let p = g.participation;
        let shares = [
            (p.rotational, ModeType::Rotational),
            (p.translational, ModeType::Translational),
            (p.planet, ModeType::Planet),
        ];
        if let Some((share, kind)) = shares.into_iter().find(|(share, _)| *share >= 0.99) {
            least = least.min(share);
            each.push(format!("{} at {:.2} Hz", kind.name(), g.frequency_hz));
        }
    }
    (!each.is_empty()).then(|| {
        format!(
            "planets are not quite equal or not quite symmetric: modes listed as mixed are to {least:.5} or more of one type, \
             which they have with equal planets: {}",
            each.join(", ")
        )
    })
}
