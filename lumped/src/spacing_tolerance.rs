//! How unequal the spacing of planets may be before modes of equal frequency split and the types of modes stop meaning
//! anything.
//!
//! The planets are displaced in angle by ε a_n. Their coordinates are in frames of their own, so that M does not
//! change; only the rows b of meshes and planet bearings turn, and of these only the entries on translations of central
//! members. With J the turn by a right angle of these entries, b(ε) = b + ε a_n J b − ….
//!
//! φ are the M-orthonormal modes of a group that diagonalise the first of the matrices of first and second order in ε
//! ([`change`]) that is not a multiple of the identity; j runs over the other groups. With equal spacing φ_jᵀ K' φ_i
//! has the factor Σ_n a_n e^(imψ_n) with m = 1 between rotational and translational modes, 2 within and between
//! translational ones: a pattern a_n without that component changes them to second order only.
//!
//! A kind of modes is a space that follows the planets: patterns cos ψ_n and sin ψ_n turn by ε a_n, too.

use dynamics::IMPURE;
use gearset::{Axis, Body};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use serde::Serialize;

use crate::error::LumpedError;
use crate::kinds::{Kinds, ModeType};
use crate::model::LumpedModel;
use crate::modes::{ModeGroup, NaturalModes};
use crate::springs::{Spring, SpringId};

/// Eigenvalues of a matrix that differ by less than this part of its size differ by rounding.
const EQUAL: f64 = 1e-9;

/// What a small change of spacing does to a group of modes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SpacingChange {
    /// Frequency at the spacing as it is, Hz.
    pub frequency_hz: f64,
    /// Type there.
    pub mode_type: ModeType,
    /// Number of modes.
    pub multiplicity: usize,
    /// (λ_max − λ_min)/λ of the group is `split` ε^`split_order`; 0 for a single mode, and where it is of higher order.
    pub split: f64,
    /// 1 or 2.
    pub split_order: i32,
    /// Largest part of a mode outside its kind is (`lost` ε)²; 0 where it is of higher order.
    pub lost: f64,
    /// ε from which on a mode is listed as mixed: 1e-6 outside its kind.
    pub pure_up_to: f64,
    /// ε at which half of a mode would be outside its kind, by the same formula.
    pub half_up_to: f64,
}

impl LumpedModel {
    /// The same model with planets displaced in angle, rad each.
    ///
    /// # Errors
    /// If there is not one finite angle for each planet.
    pub fn with_displaced_planets(&self, angles: &[f64]) -> Result<Self, LumpedError> {
        let (count, given) = (self.psi.len(), angles.len());
        if given != count || angles.iter().any(|angle| !angle.is_finite()) {
            return Err(LumpedError::Displaced { count, given });
        }
        let mut changed = self.clone();
        for (psi, angle) in changed.psi.iter_mut().zip(angles) {
            *psi += angle;
        }
        for spring in &mut changed.springs {
            let Some(planet) = planet_of(spring) else { continue };
            let (sin, cos) = angles[planet].sin_cos();
            for row in &mut spring.rows {
                let still = row.clone();
                let turned = self.quarter_turned(&still);
                for (entry, (i, b)) in row.iter_mut().zip(still) {
                    if self.is_central_translation(i) {
                        let across = turned.iter().find(|t| t.0 == i).map_or(0.0, |t| t.1);
                        *entry = (i, b * cos + across * sin);
                    }
                }
            }
        }
        Ok(changed)
    }

    /// What displacing planets by ε `pattern` rad does to each group of modes whose type is pure, to leading order in
    /// ε. Rigid-body modes and mixed ones are left out.
    ///
    /// # Errors
    /// If there is not one finite number for each planet.
    pub fn spacing_changes(
        &self,
        modes: &NaturalModes,
        pattern: &[f64],
    ) -> Result<Vec<SpacingChange>, LumpedError> {
        let (count, given) = (self.psi.len(), pattern.len());
        if given != count || pattern.iter().any(|a| !a.is_finite()) {
            return Err(LumpedError::Displaced { count, given });
        }
        let first = self.stiffness_by_spacing(pattern);
        let kinds = KindsBySpacing::new(self, pattern);
        let pure = |g: &&ModeGroup| g.mode_type != ModeType::Mixed && g.lambda > 0.0;
        let of = |group: &ModeGroup| change(modes, group, &first, &kinds);
        Ok(modes.groups.iter().filter(pure).map(of).collect())
    }

    /// `[eq:displaced-planets-stiffness]` Derivatives of K by ε, n×n: K' = Σ k a_n (J b bᵀ + b (J b)ᵀ), K'' = Σ k
    /// a_n² (J²b bᵀ + 2 J b (J b)ᵀ + b (J²b)ᵀ).
    ///
    /// Source: perturbation theory, derived here.
    /// Checked by: `lumped/tests/spacing.rs::displaced_planets_are_those_of_a_scene_with_the_planets_there`,
    /// `lumped/tests/spacing.rs::splits_have_the_order_of_symmetry_and_the_size_of_theory`.
    fn stiffness_by_spacing(&self, pattern: &[f64]) -> [DMatrix<f64>; 2] {
        let n = self.mass.len();
        let (mut first, mut second) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        let full = |row: &[(usize, f64)]| -> DVector<f64> {
            let mut all = DVector::zeros(n);
            row.iter().for_each(|&(i, b)| all[i] += b);
            all
        };
        for spring in &self.springs {
            let Some(planet) = planet_of(spring) else { continue };
            let (k, a) = (spring.stiffness, pattern[planet]);
            for row in &spring.rows {
                let turned = self.quarter_turned(row);
                let (b, once, twice) =
                    (full(row), full(&turned), full(&self.quarter_turned(&turned)));
                let across: DMatrix<f64> = &once * b.transpose();
                first += (&across + across.transpose()) * (k * a);
                let back: DMatrix<f64> = &twice * b.transpose();
                let turning: DMatrix<f64> = &once * once.transpose();
                second += (&back + back.transpose() + turning * 2.0) * (k * a * a);
            }
        }
        [first, second]
    }

    /// J b: the entries of a row on translations of central members, turned by a right angle.
    fn quarter_turned(&self, row: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let entry = |body: Body, axis: Axis| {
            let at = self.coordinates.of(body, axis);
            row.iter().find(|(i, _)| Some(*i) == at).map_or(0.0, |(_, b)| *b)
        };
        let turned = |&(i, _): &(usize, f64)| {
            let (body, axis) = self.coordinates.free()[i];
            // d/dψ (cos, sin) = (−sin, cos)
            match (self.is_central_translation(i), axis) {
                (true, Axis::First) => (i, -entry(body, Axis::Second)),
                (true, Axis::Second) => (i, entry(body, Axis::First)),
                _ => (i, 0.0),
            }
        };
        row.iter().map(turned).collect()
    }

    fn is_central_translation(&self, i: usize) -> bool {
        let (body, axis) = self.coordinates.free()[i];
        !matches!(body, Body::Planet(_)) && axis != Axis::Rotation
    }
}

/// The planet that a spring belongs to.
fn planet_of(spring: &Spring) -> Option<usize> {
    match spring.id {
        SpringId::SunMesh(n) | SpringId::RingMesh(n) | SpringId::PlanetBearing(n) => Some(n),
        SpringId::CentralBearing(_) | SpringId::Torsional(_) => None,
    }
}

/// Bases of rotational and translational kind, M-orthonormal, and the change of the latter by ε.
struct KindsBySpacing {
    rotational: DMatrix<f64>,
    translational: DMatrix<f64>,
    /// T', its part within the rotational kind and within T taken out.
    change: DMatrix<f64>,
    mass: DVector<f64>,
}

impl KindsBySpacing {
    fn new(model: &LumpedModel, pattern: &[f64]) -> Self {
        let mass = DVector::from_column_slice(&model.mass);
        let [rotational, translational] = Kinds::of(model).bases(model.mass.len());
        // From M^½-scaled coordinates.
        let plain = |mut basis: DMatrix<f64>| {
            for (mut row, m) in basis.row_iter_mut().zip(&model.mass) {
                row /= m.sqrt();
            }
            basis
        };
        let (rotational, translational) = (plain(rotational), plain(translational));
        // A column of T moves planet n along an axis by c cos ψ_n + s sin ψ_n, with ψ_n + ε a_n for ψ_n once it is
        // displaced.
        let mut change = DMatrix::zeros(model.mass.len(), translational.ncols());
        for (i, (body, axis)) in model.coordinates.free().iter().enumerate() {
            let Body::Planet(n) = body else { continue };
            // t = c cos ψ + s sin ψ becomes a (−c sin ψ + s cos ψ); c and s are found over all planets of the axis.
            for j in 0..translational.ncols() {
                let (c, s) = pattern_of(model, *axis, |k| translational[(k, j)]);
                let (sin, cos) = model.psi[*n].sin_cos();
                change[(i, j)] = pattern[*n] * (s * cos - c * sin);
            }
        }
        let mut out = Self { rotational, translational, change, mass };
        let change = out.change.clone();
        out.change =
            &change - out.onto(&out.rotational, &change) - out.onto(&out.translational, &change);
        out
    }

    /// M x
    fn weighted(&self, x: &DMatrix<f64>) -> DMatrix<f64> {
        let mut weighted = x.clone();
        for (mut row, m) in weighted.row_iter_mut().zip(self.mass.iter()) {
            row *= *m;
        }
        weighted
    }

    /// B Bᵀ M x
    fn onto(&self, basis: &DMatrix<f64>, x: &DMatrix<f64>) -> DMatrix<f64> {
        basis * (basis.transpose() * self.weighted(x))
    }

    /// `[eq:displaced-planets-kinds]` The part of modes φ with changes φ' that leaves their kind, to first order in
    /// ε: rotational ε φ'_⊥, translational ε (φ'_⊥ − T'_⊥ Tᵀφ), planet ε (φ'_⊥ + T T'ᵀφ), with ⊥ outside the kind and
    /// the basis T of the translational kind, which changes by T'.
    ///
    /// Source: perturbation theory, derived here.
    /// Checked by: `lumped/tests/spacing.rs::modes_turn_mixed_at_the_displacement_of_theory`.
    fn left(&self, mode_type: ModeType, phi: &DMatrix<f64>, change: &DMatrix<f64>) -> DMatrix<f64> {
        let (r, t) = (&self.rotational, &self.translational);
        match mode_type {
            ModeType::Rotational => change - self.onto(r, change),
            ModeType::Translational => {
                let follows = &self.change * (t.transpose() * self.weighted(phi));
                change - self.onto(t, change) - follows
            }
            _ => {
                let follows = t * (self.change.transpose() * self.weighted(phi));
                self.onto(r, change) + self.onto(t, change) + follows
            }
        }
    }

    /// Squared M-norm of each column.
    fn squares(&self, x: &DMatrix<f64>) -> Vec<f64> {
        let square = |c: nalgebra::DVectorView<'_, f64>| {
            c.iter().zip(self.mass.iter()).map(|(x, m)| m * x * x).sum()
        };
        x.column_iter().map(square).collect()
    }
}

/// c and s of c cos ψ_n + s sin ψ_n that is nearest the values of an axis of the planets.
fn pattern_of(model: &LumpedModel, axis: Axis, value: impl Fn(usize) -> f64) -> (f64, f64) {
    let (mut normal, mut right) = (nalgebra::Matrix2::zeros(), nalgebra::Vector2::zeros());
    for (n, psi) in model.psi.iter().enumerate() {
        let Some(i) = model.coordinates.of(Body::Planet(n), axis) else { continue };
        let row = nalgebra::Vector2::new(psi.cos(), psi.sin());
        normal += row * row.transpose();
        right += row * value(i);
    }
    let found = normal.try_inverse().map_or(nalgebra::Vector2::zeros(), |inverse| inverse * right);
    (found[0], found[1])
}

/// `[eq:displaced-planets]` What displacing planets by ε a_n changes of the modes of one group:
/// ```text
/// λ_i(ε) = λ_i + ε φ_iᵀ K' φ_i + ε² (½ φ_iᵀ K'' φ_i + Σ_j (φ_jᵀ K' φ_i)²/(λ_i − λ_j)),
/// φ_i(ε) = φ_i + ε Σ_j (φ_jᵀ K' φ_i)/(λ_i − λ_j) φ_j.
/// ```
///
/// Source: perturbation theory, derived here.
/// Checked by: `lumped/tests/spacing.rs::splits_have_the_order_of_symmetry_and_the_size_of_theory`,
/// `lumped/tests/spacing.rs::symmetry_says_what_does_not_change`.
fn change(
    modes: &NaturalModes,
    group: &ModeGroup,
    [first, second]: &[DMatrix<f64>; 2],
    kinds: &KindsBySpacing,
) -> SpacingChange {
    let others = || modes.groups.iter().filter(|o| !std::ptr::eq(*o, group));
    let meets = |o: &ModeGroup| (o.lambda - group.lambda).abs() <= EQUAL * group.lambda;
    let once = group.vectors.transpose() * first * &group.vectors;
    let size = group.lambda;
    let mut twice = 0.5 * group.vectors.transpose() * second * &group.vectors;
    for other in others().filter(|o| !meets(o)) {
        let to = other.vectors.transpose() * first * &group.vectors;
        twice += to.transpose() * &to / (group.lambda - other.lambda);
    }
    let spread = |m: &DMatrix<f64>| {
        let found = SymmetricEigen::new(0.5 * (m + m.transpose()));
        let (low, high) = (found.eigenvalues.min(), found.eigenvalues.max());
        ((high - low) / size, found.eigenvectors)
    };
    let ((by_first, of_first), (by_second, of_second)) = (spread(&once), spread(&twice));
    let is_first = by_first > EQUAL;
    let directions = if is_first { of_first } else { of_second };
    let phi = &group.vectors * directions;
    let mut changed = DMatrix::zeros(phi.nrows(), phi.ncols());
    let mut mixes_at_once = false;
    for other in others() {
        let to = other.vectors.transpose() * first * &phi;
        if meets(other) {
            // Modes of one frequency that are coupled have no type at any displacement; uncoupled ones do not mix.
            mixes_at_once |= to.amax() > EQUAL * size;
            continue;
        }
        changed += &other.vectors * to / (group.lambda - other.lambda);
    }
    let left = kinds.left(group.mode_type, &phi, &changed);
    let most = kinds.squares(&left).into_iter().fold(0.0, f64::max);
    let lost = match most.sqrt() {
        _ if mixes_at_once => f64::INFINITY,
        lost if lost > EQUAL => lost,
        _ => 0.0,
    };
    SpacingChange {
        frequency_hz: group.frequency_hz,
        mode_type: group.mode_type,
        multiplicity: group.multiplicity,
        split: match group.multiplicity {
            1 => 0.0,
            _ if is_first => by_first,
            _ if by_second > EQUAL => by_second,
            _ => 0.0,
        },
        split_order: if is_first { 1 } else { 2 },
        lost,
        pure_up_to: IMPURE.sqrt() / lost,
        half_up_to: 0.5f64.sqrt() / lost,
    }
}
