//! Change of a natural frequency by what quasi-static bodies lack.

use fe_contact::vibration::{ElasticInertia, LinearSet, VibratingSet};

use super::energy::ModeEnergy;
use crate::error::ExperimentError;

/// Relative change of a frequency by the inertia of elastic displacements and by flexibility between meshes, which
/// quasi-static bodies lack, to first order; `None` where nothing bounds it.
///
/// ```text
/// (f'/f)² = (1 + δλ/λ of the flexibility)/(1 + δm)
/// ```
pub(super) fn elastic_change(
    set: &VibratingSet<'_>,
    linear: &LinearSet,
    inertia: &ElasticInertia,
    mode: &ModeEnergy,
) -> Result<Option<f64>, ExperimentError> {
    let lambda = (std::f64::consts::TAU * mode.frequency_hz).powi(2);
    let shift = inertia.of_mode(set, linear, &mode.shape, lambda)?;
    let ratio = (1.0 + shift.coupling) / (1.0 + shift.remainder - shift.inertia);
    let has_bound = shift.remainder.is_finite() && ratio > 0.0;
    Ok(has_bound.then(|| ratio.sqrt() - 1.0))
}
