//! The mesh law of one gear pair from a stiffness and a displacement excitation over the mesh cycle, with backlash.
//! ([`pair_law`]).
//!
//! With a rounding length s the corner of (x)₊ is the parabola (x + s/2)²/2s for |x| < s/2, so that the force has a
//! continuous tangent: the derivative of a time step then does not jump when flanks meet, which following a branch of
//! motions with contact loss needs.
//!
//! δ: approach along the line of action, m; k: mesh stiffness, N/m; e: displacement excitation (flank deviations;
//! positive where material is missing), m; j: normal backlash between front and backside flanks, m. The second term
//! is the force of the backside flanks, at the same k and e.

use crate::mesh_curve::{CurveError, MeshCurve};
use crate::mesh_kind::MeshKind;
use crate::mesh_law::{FlankSide, MeshLaw, MeshLawError, MeshLawPlan, MeshStart};

/// Why a pair has no such law.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PairLawError {
    /// Lists of different length, or empty.
    #[error(
        "{stiffnesses} stiffnesses and {excitations} excitations: one of each for every step is needed"
    )]
    Lengths {
        /// Number of stiffnesses.
        stiffnesses: usize,
        /// Number of excitations.
        excitations: usize,
    },
    /// A stiffness that is not positive.
    #[error("the mesh stiffness of step {step} is {value} N/m: it must be positive and finite")]
    Stiffness {
        /// Step of the mesh cycle.
        step: usize,
        /// Its stiffness, N/m.
        value: f64,
    },
    /// A backlash or rounding length that is negative or not finite.
    #[error("a {what} of {value} m: it must be finite and not negative")]
    Length {
        /// Which.
        what: &'static str,
        /// Its value, m.
        value: f64,
    },
    /// An excitation that is not finite.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// The curves do not make a law.
    #[error(transparent)]
    Law(#[from] MeshLawError),
}

/// What flanks do beside pressing in proportion to their approach. By default they have no backside, and sharp corners.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PairFlanks {
    /// j, along the line of action, m; `None` leaves the backside flanks out.
    pub backlash_m: Option<f64>,
    /// s, m; 0 for none.
    pub rounding_m: f64,
}

/// Deflection step of the curves, which are straight, m.
const STEP_M: f64 = 1e-6;

/// The law of one mesh with mesh stiffness (N/m) and displacement excitation (m) at each of the evenly spaced steps
/// of a mesh cycle.
///
/// `[eq:pair-law]` F(φ, δ) = k(φ) (δ − e(φ))₊ − k(φ) (−(δ − e(φ)) − j)₊, (x)₊ = max(x, 0).
/// Source: Blankenship & Kahraman, J. Sound Vib. 185 (1995) 743–765, with k and e of one to three harmonics.
/// Checked by: `gearset/src/pair_law.rs::forces_are_those_of_the_equation_on_both_flanks_at_every_step`.
///
/// # Errors
/// [`PairLawError`] if the lists differ in length or are empty, or a number is out of range.
pub fn pair_law(
    stiffness: &[f64],
    excitation: &[f64],
    flanks: PairFlanks,
) -> Result<MeshLaw, PairLawError> {
    let steps = stiffness.len();
    if steps == 0 || steps != excitation.len() {
        let excitations = excitation.len();
        return Err(PairLawError::Lengths { stiffnesses: steps, excitations });
    }
    if let Some(step) = stiffness.iter().position(|k| !(*k > 0.0 && k.is_finite())) {
        return Err(PairLawError::Stiffness { step, value: stiffness[step] });
    }
    let PairFlanks { backlash_m: backlash, rounding_m: rounding } = flanks;
    for (what, length) in [("backlash", backlash.unwrap_or(0.0)), ("rounding length", rounding)] {
        if !(length >= 0.0 && length.is_finite()) {
            return Err(PairLawError::Length { what, value: length });
        }
    }
    let start = MeshStart {
        kind: MeshKind::SunPlanet,
        class: 0,
        front: 0.0,
        backside: backlash.map(|_| 0.0),
    };
    let plan = MeshLawPlan::new(&[start], steps)?;
    let mut curves = Vec::with_capacity(plan.curves.len());
    for key in &plan.curves {
        let at = (key.phase * steps as f64).round() as usize;
        // Approach of the backside flanks is −δ, and their phase runs backwards.
        let (step, first) = match key.side {
            FlankSide::Front => (at % steps, excitation[at % steps]),
            FlankSide::Backside => {
                let step = (steps - at) % steps;
                (step, backlash.unwrap_or(0.0) - excitation[step])
            }
        };
        let k = stiffness[step];
        // The cubic between (0, 0) and (k s/2, k) at s is the parabola k x²/2s.
        curves.push(match rounding {
            0.0 => MeshCurve::new(first, STEP_M, &[0.0, k * STEP_M], &[k, k])?,
            s => MeshCurve::new(first - 0.5 * s, s, &[0.0, 0.5 * k * s], &[0.0, k])?,
        });
    }
    Ok(plan.law(curves)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forces_are_those_of_the_equation_on_both_flanks_at_every_step() {
        let (k, e, j) = ([1e8, 2e8, 3e8, 4e8], [1e-6, -2e-6, 0.0, 3e-6], 20e-6);
        let of = |rounding_m| PairFlanks { backlash_m: Some(j), rounding_m };
        let rounded = pair_law(&k, &e, of(0.4e-6)).unwrap();
        let law = pair_law(&k, &e, of(0.0)).unwrap();
        for (step, law) in (0..4).flat_map(|step| [(step, &law), (step, &rounded)]) {
            for delta in [-40e-6, -21e-6, -10e-6, 0.5e-6, 7e-6] {
                let x: f64 = delta - e[step];
                let front = law.force(0, step, delta).0;
                let backside = law.force(1, step, -delta).0;
                let expected = [k[step] * x.max(0.0), k[step] * (-x - j).max(0.0)];
                assert!((front - expected[0]).abs() < 1e-6, "{step} {delta}: {front}");
                assert!((backside - expected[1]).abs() < 1e-6, "{step} {delta}: {backside}");
            }
        }
        let x = 0.1e-6;
        let (force, tangent) = rounded.force(0, 2, e[2] + x);
        assert!((force / (k[2] * (x + 0.2e-6).powi(2) / 0.8e-6) - 1.0).abs() < 1e-9);
        assert!((tangent / (k[2] * (x + 0.2e-6) / 0.4e-6) - 1.0).abs() < 1e-9);
        assert!(!pair_law(&k, &e, PairFlanks::default()).unwrap().has_backside());
    }

    #[test]
    fn what_makes_no_law_is_refused() {
        let refused = |k: &[f64], e: &[f64], own| pair_law(k, e, own).unwrap_err().to_string();
        let none = PairFlanks::default();
        assert!(refused(&[], &[], none).contains("0 stiffnesses"));
        assert!(refused(&[1e8, 0.0], &[0.0; 2], none).contains("step 1"));
        let negative = PairFlanks { backlash_m: Some(-1e-6), ..none };
        assert!(refused(&[1e8], &[0.0], negative).contains("backlash"));
        let endless = PairFlanks { rounding_m: f64::INFINITY, ..none };
        assert!(refused(&[1e8], &[0.0], endless).contains("rounding"));
        assert!(refused(&[1e8], &[f64::NAN], none).contains("NaN"));
    }
}
