//! Which kinds of modes a mesh-force harmonic can excite, for any planet spacing.
//!
//! Assumption: all planets carry the same mesh force, each at its own place in the mesh cycle. The
//! l-th harmonic at planet n is then the common amplitude times a phasor of phase −l Z_s ψ_n, in
//! the sun mesh and, for positions that can be assembled (l Z_r ψ_n = −l Z_s ψ_n mod 2π), in the
//! ring mesh alike; γ only turns all ring phasors together. Magnitudes do not depend on the sense
//! of the phase, so the conjugate a_n = e^{i l Z_s ψ_n} is used throughout. A planet whose mesh,
//! bearing or load differs from the others' breaks the assumption, and with it every rule here.
//!
//! The central members feel the sums of the phasors ([`excitation`]), and what is left of (a_n) once 1, cos ψ_n and
//! sin ψ_n are projected out drives the planets against one another: planet modes only, none for N ≤ 3. That modes
//! have these pure kinds is a property of equal planets that stand so that Σ e^{iψ_n} = 0 ([`Spacing::is_balanced`]):
//! equally spaced, in diametrical pairs, or several such sets on one carrier (Lin & Parker 1999, 2000). With other
//! spacings the strengths still say what the net forces are, but modes are mixed and nothing is forbidden.
//!
//! Printed rules: Parker, Agashe & Vijayakar (2000), Table 4 (equal spacing) and its counterpart for
//! diametrical pairs. Both follow from the sums; neither says how strong an allowed excitation is.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::num::NonZeroU32;

use serde::Serialize;

use crate::planet_positions::PlanetPositions;
use crate::teeth::Teeth;

/// A strength at or below this counts as zero: rounding leaves less than 1e-12 where phasors cancel.
pub const FORBIDDEN_UP_TO: f64 = 1e-9;

/// Angles that differ by less than this count as one position, rad; also the tolerance on the angle π between
/// the two planets of a diametrical pair.
const SAME_ANGLE_RAD: f64 = 1e-9;

/// A vector counts as linearly independent of others if more than this part of its length remains after
/// projection onto them.
const INDEPENDENT: f64 = 1e-7;

/// Why planet positions are not valid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SpacingError {
    /// No planet at all.
    #[error("a spacing needs at least one planet")]
    NoPlanets,
    /// An angle that is not a number.
    #[error("planet {planet} stands at {psi_rad} rad, which is not finite")]
    NotFinite {
        /// Index n.
        planet: usize,
        /// ψ_n as given.
        psi_rad: f64,
    },
}

/// Planet positions, kept in whole numbers wherever they are multiples of a fraction of a turn, so
/// that phases can be reduced to one turn before any rounding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Spacing(Positions);

#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Positions {
    /// ψ_n = 2π steps_n / per_turn.
    Steps { steps: Vec<i64>, per_turn: NonZeroU32 },
    /// ψ_n, rad.
    Angles { psi_rad: Vec<f64> },
}

impl Spacing {
    /// N planets at ψ_n = 2πn/N.
    pub fn equal(planets: NonZeroU32) -> Self {
        let steps = (0..i64::from(planets.get())).collect();
        Self(Positions::Steps { steps, per_turn: planets })
    }

    /// ψ_n = 2π `steps[n]` / `per_turn`; for positions in assembly steps `per_turn` = Z_s + Z_r.
    ///
    /// # Errors
    /// [`SpacingError::NoPlanets`].
    pub fn from_steps(steps: Vec<i64>, per_turn: NonZeroU32) -> Result<Self, SpacingError> {
        if steps.is_empty() {
            return Err(SpacingError::NoPlanets);
        }
        Ok(Self(Positions::Steps { steps, per_turn }))
    }

    /// ψ_n in rad; ψ_n = 2πn/N is recognised and then kept exactly.
    ///
    /// # Errors
    /// [`SpacingError`] without planets or with an angle that is not finite.
    pub fn from_angles(psi_rad: Vec<f64>) -> Result<Self, SpacingError> {
        if let Some(planet) = psi_rad.iter().position(|psi| !psi.is_finite()) {
            return Err(SpacingError::NotFinite { planet, psi_rad: psi_rad[planet] });
        }
        let count = u32::try_from(psi_rad.len()).ok().and_then(NonZeroU32::new);
        let planets = count.ok_or(SpacingError::NoPlanets)?;
        let at_place = |(n, psi): (usize, &f64)| {
            let off = psi / TAU - n as f64 / f64::from(planets.get());
            (off - off.round()).abs() <= 4.0 * f64::EPSILON
        };
        if psi_rad.iter().enumerate().all(at_place) {
            return Ok(Self::equal(planets));
        }
        Ok(Self(Positions::Angles { psi_rad }))
    }

    /// Positions of a scene: in assembly steps when both they and the teeth are known.
    ///
    /// # Errors
    /// As [`Spacing::from_angles`].
    pub fn of(positions: &PlanetPositions, teeth: Option<Teeth>) -> Result<Self, SpacingError> {
        let total = teeth.and_then(|t| t.sun_ring()).and_then(|(s, r)| s.checked_add(r));
        match (&positions.steps, total.and_then(NonZeroU32::new)) {
            (Some(steps), Some(per_turn)) => Self::from_steps(steps.clone(), per_turn),
            _ => Self::from_angles(positions.psi_rad.clone()),
        }
    }

    /// N.
    pub fn planets(&self) -> usize {
        match &self.0 {
            Positions::Steps { steps, .. } => steps.len(),
            Positions::Angles { psi_rad } => psi_rad.len(),
        }
    }

    /// Whether the planets are equally spaced, in whatever order they are numbered.
    pub fn is_equal(&self) -> bool {
        let count = self.planets();
        let mut turns = self.turns();
        turns.sort_by(f64::total_cmp);
        // Sorted, each stands 1/N of a turn after the one before; the first is the reference.
        turns.iter().enumerate().all(|(n, turn)| {
            let off = turn - turns[0] - n as f64 / count as f64;
            TAU * off.abs() <= SAME_ANGLE_RAD
        })
    }

    /// Whether every planet has its own partner across the carrier, at ψ_n + π.
    pub fn is_diametrical(&self) -> bool {
        let turns = self.turns();
        // Number of planets at `from` + `ahead`, both in turns; distances are taken modulo one turn.
        let standing = |from: f64, ahead: f64| {
            let off = |turn: f64| turn - from - ahead;
            let near = |turn: &&f64| TAU * (off(**turn) - off(**turn).round()).abs();
            turns.iter().filter(|t| near(t) <= SAME_ANGLE_RAD).count()
        };
        turns.iter().all(|&from| standing(from, 0.5) == standing(from, 0.0))
    }

    /// Whether Σ e^{iψ_n} = 0, which uncouples rotations, translations and planet motions of a set of equal
    /// planets; otherwise modes are mixed.
    pub fn is_balanced(&self) -> bool {
        mean_magnitude(&self.phasors(1)) <= FORBIDDEN_UP_TO
    }

    /// ψ_n/2π in [0, 1).
    fn turns(&self) -> Vec<f64> {
        match &self.0 {
            Positions::Steps { steps, per_turn } => {
                let total = i64::from(per_turn.get());
                steps.iter().map(|step| step.rem_euclid(total) as f64 / total as f64).collect()
            }
            Positions::Angles { psi_rad } => {
                psi_rad.iter().map(|psi| (psi / TAU).rem_euclid(1.0)).collect()
            }
        }
    }

    /// e^{i q ψ_n} of every planet.
    fn phasors(&self, order: i128) -> Vec<[f64; 2]> {
        match &self.0 {
            Positions::Steps { steps, per_turn } => {
                let total = i128::from(per_turn.get());
                // q ψ_n = 2π (q·step mod total) / total
                let reduced = |step: &i64| {
                    let step = i128::from(*step).rem_euclid(total);
                    (order.rem_euclid(total) * step).rem_euclid(total) as u64
                };
                steps.iter().map(|s| unit_phasor(reduced(s), u64::from(per_turn.get()))).collect()
            }
            Positions::Angles { psi_rad } => psi_rad
                .iter()
                .map(|psi| {
                    let (sin, cos) = (order as f64 * psi).sin_cos();
                    [cos, sin]
                })
                .collect(),
        }
    }
}

/// e^{2πi r/T} for r < T, the quarter turn split off in whole numbers: opposite phasors are exactly
/// opposite.
fn unit_phasor(r: u64, total: u64) -> [f64; 2] {
    let quarter = 4 * r / total;
    let within = 4 * r - quarter * total;
    let (sin, cos) = (FRAC_PI_2 * within as f64 / total as f64).sin_cos();
    match quarter {
        0 => [cos, sin],
        1 => [-sin, cos],
        2 => [-cos, -sin],
        _ => [sin, -cos],
    }
}

/// How strongly one harmonic of the mesh forces acts, each between 0 (cancels) and 1 (all planets
/// in step).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExcitationStrengths {
    /// l.
    pub harmonic: u32,
    /// |Σ e^{i l Z_s ψ_n}|/N: net torque on the central members; drives rotational modes.
    pub net_torque: f64,
    /// |Σ e^{i (l Z_s + 1) ψ_n}|/N: the part of the net force that rotates in one sense; drives translational
    /// modes.
    pub net_force_plus: f64,
    /// |Σ e^{i (l Z_s − 1) ψ_n}|/N: the part that rotates in the other sense; drives translational modes.
    pub net_force_minus: f64,
    /// ‖a − proj a‖/‖a‖, a_n = e^{i l Z_s ψ_n} projected on span{1, cos ψ_n, sin ψ_n}: what moves
    /// planets without any net force or torque; drives planet modes.
    pub planet: f64,
}

impl ExcitationStrengths {
    /// Which kinds of modes this harmonic can excite: strength above [`FORBIDDEN_UP_TO`].
    pub fn allowed(&self) -> AllowedKinds {
        let acts = |strength: f64| strength > FORBIDDEN_UP_TO;
        AllowedKinds {
            rotational: acts(self.net_torque),
            translational: acts(self.net_force_plus) || acts(self.net_force_minus),
            planet: acts(self.planet),
        }
    }
}

/// Verdict on one harmonic. Allowed does not mean strong: see [`ExcitationStrengths`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct AllowedKinds {
    /// Rotational modes can be excited.
    pub rotational: bool,
    /// Translational modes can be excited.
    pub translational: bool,
    /// Planet modes can be excited.
    pub planet: bool,
}

/// Strengths of harmonic l = `harmonic` of the mesh forces.
///
/// `[eq:phasor-sums]` Net torque |Σ e^{i l Z_s ψ_n}|/N, which drives rotational modes; net forces |Σ e^{i (l Z_s ± 1)
/// ψ_n}|/N, either of which drives translational modes; planet part ‖a − proj a‖/‖a‖ of a_n = e^{i l Z_s ψ_n},
/// projected on span{1, cos ψ_n, sin ψ_n}.
/// Source: derived here; kinds of modes from Lin & Parker (1999, 2000).
/// Checked by: `gearset/tests/rules.rs`, `rules.table4.all`, `rules.strength`, `sweep.forbidden`.
///
/// `teeth` is Z_s. With Z_r instead and positions that can be assembled, the two net forces change
/// places and everything else is the same.
pub fn excitation(spacing: &Spacing, teeth: u32, harmonic: u32) -> ExcitationStrengths {
    let order = order(teeth, harmonic);
    ExcitationStrengths {
        harmonic,
        net_torque: mean_magnitude(&spacing.phasors(order)),
        net_force_plus: mean_magnitude(&spacing.phasors(order + 1)),
        net_force_minus: mean_magnitude(&spacing.phasors(order - 1)),
        planet: planet_part(spacing, order),
    }
}

/// l Z_s.
fn order(teeth: u32, harmonic: u32) -> i128 {
    i128::from(teeth) * i128::from(harmonic)
}

/// |Σ a_n| / N.
fn mean_magnitude(phasors: &[[f64; 2]]) -> f64 {
    let sum = phasors.iter().fold([0.0, 0.0], |[x, y], [c, s]| [x + c, y + s]);
    sum[0].hypot(sum[1]) / phasors.len() as f64
}

/// ‖a − proj a‖/‖a‖ on span{1, cos ψ_n, sin ψ_n}.
fn planet_part(spacing: &Spacing, order: i128) -> f64 {
    let count = spacing.planets();
    let places = spacing.phasors(1);
    let candidates = [
        vec![1.0; count],
        places.iter().map(|p| p[0]).collect::<Vec<f64>>(),
        places.iter().map(|p| p[1]).collect::<Vec<f64>>(),
    ];
    // Gram–Schmidt with a second pass; linearly dependent vectors are dropped.
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(3);
    for mut v in candidates {
        let before = norm(&v);
        remove(&mut v, &basis);
        let length = norm(&v);
        if length > INDEPENDENT * before {
            v.iter_mut().for_each(|x| *x /= length);
            basis.push(v);
        }
    }
    let phasors = spacing.phasors(order);
    let squared: f64 = (0..2)
        .map(|part| {
            let mut v: Vec<f64> = phasors.iter().map(|a| a[part]).collect();
            remove(&mut v, &basis);
            dot(&v, &v)
        })
        .sum();
    // ‖a‖² = N
    (squared / count as f64).sqrt()
}

/// Subtracts from `v` its components along orthonormal directions.
fn remove(v: &mut [f64], basis: &[Vec<f64>]) {
    for _ in 0..2 {
        for direction in basis {
            let along = dot(v, direction);
            v.iter_mut().zip(direction).for_each(|(x, d)| *x -= along * d);
        }
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn norm(v: &[f64]) -> f64 {
    dot(v, v).sqrt()
}

/// Table 4: what a harmonic excites in a set of equally spaced planets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Table4 {
    /// k = 0: rotational modes only.
    RotationalOnly,
    /// k = 1 or N − 1: translational modes only.
    TranslationalOnly,
    /// Any other k: neither; planet modes remain.
    Neither,
}

impl Table4 {
    /// The rule as allowed kinds of modes.
    pub fn allowed(self) -> AllowedKinds {
        AllowedKinds {
            rotational: self == Self::RotationalOnly,
            translational: self == Self::TranslationalOnly,
            planet: self == Self::Neither,
        }
    }
}

/// `[eq:table-4]` k = l Z_s mod N for N equally spaced planets (the table prints mod(l Z_s / N)): 0 rotational only,
/// 1 or N − 1 translational only, else neither.
///
/// Source: the paper, Table 4.
/// Checked by: `gearset/tests/rules.rs::equally_spaced_planets_give_table_4_exactly`, `rules.table4`,
/// `rules.forbidden`.
///
/// Table 4 of Parker, Agashe & Vijayakar (2000). `None` for N < 2: a single planet always gives both a net torque and
/// a net force.
pub fn table4(planets: u32, sun_teeth: u32, harmonic: u32) -> Option<Table4> {
    if planets < 2 {
        return None;
    }
    let k = (u64::from(sun_teeth) * u64::from(harmonic)) % u64::from(planets);
    Some(match k {
        0 => Table4::RotationalOnly,
        k if k == 1 || k == u64::from(planets) - 1 => Table4::TranslationalOnly,
        _ => Table4::Neither,
    })
}

/// What a harmonic cannot excite in a set of diametrical pairs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DiametricalRule {
    /// l Z_s even: the mesh forces of a pair are in phase, the net force cancels.
    TranslationalForbidden,
    /// l Z_s odd: the mesh forces of a pair are in antiphase, the net torque cancels.
    RotationalForbidden,
}

/// The rule for sets of diametrical pairs ([`Spacing::is_diametrical`]), equally spaced or not.
///
/// `[eq:diametrical-rule]` e^{i l Z_s (ψ + π)} = (−1)^{l Z_s} e^{i l Z_s ψ}: an even l Z_s forbids the net force, an
/// odd one the net torque.
/// Source: the paper, counterpart of Table 4 for diametrical pairs.
/// Checked by: `gearset/tests/rules.rs::diametrical_pairs_obey_the_odd_even_rule`, `rules.diametrical`.
///
/// The rule only forbids: whether and how strongly the other kind is excited is given by [`excitation`]. Examples
/// with l Z_s even: the net torque of OH-58 is 0.62 at l = 2 and 0.22 at l = 4; that of four equally spaced planets
/// with l Z_s = 30 is zero.
pub fn diametrical_rule(sun_teeth: u32, harmonic: u32) -> DiametricalRule {
    if sun_teeth.is_multiple_of(2) || harmonic.is_multiple_of(2) {
        DiametricalRule::TranslationalForbidden
    } else {
        DiametricalRule::RotationalForbidden
    }
}
