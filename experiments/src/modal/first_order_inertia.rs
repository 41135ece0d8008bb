//! Change of a natural frequency by what quasi-static bodies lack.

use fe_contact::vibration::{ElasticInertia, LinearSet, VibratingSet};

use super::error::ModalError;
use super::mode::FeMode;

/// Largest λ/λ_1 at which the change is known to first order: there the next term of the series is half as large, and
/// beyond it modes of the bodies come among those of the set.
pub(crate) const SLOW: f64 = 0.5;

/// What the inertia of elastic displacements and the flexibility between meshes, which quasi-static bodies lack,
/// change of the frequencies of a set to first order, relative; by mode, in the order of `modes`.
///
/// `[eq:first-order-inertia]` Changed frequency of a mode:
/// ```text
/// (f'/f)² = (1 + δλ/λ of the flexibility)/(1 + δm)
/// ```
/// Source: derived in `docs/fe_dynamics.md`.
/// Checked by:
/// `experiments/tests/elastic_inertia.rs::first_order_changes_have_sign_and_size_of_those_by_twelve_modes`.
///
/// `None` for a mode near or above the first eigenvalue λ_1 of a body with its race held, and for all modes if the
/// teeth of a gear are not meshed alike. Derived in `docs/fe_dynamics.md`.
///
/// # Errors
/// If a gear cannot be solved, or the set has no pairs.
pub fn first_order_inertia(
    set: &VibratingSet<'_>,
    linear: &LinearSet,
    modes: &[FeMode],
) -> Result<Vec<Option<f64>>, ModalError> {
    let Some(inertia) = ElasticInertia::new(set)? else { return Ok(vec![None; modes.len()]) };
    let change = |mode: &FeMode| {
        let lambda = (std::f64::consts::TAU * mode.frequency_hz).powi(2);
        if lambda > SLOW * inertia.first() {
            return Ok(None);
        }
        let shift = inertia.of_mode(set, linear, &mode.shape, lambda)?;
        let ratio = (1.0 + shift.coupling) / (1.0 + shift.remainder - shift.inertia);
        Ok((shift.remainder.is_finite() && ratio > 0.0).then(|| ratio.sqrt() - 1.0))
    };
    modes.iter().map(change).collect()
}
