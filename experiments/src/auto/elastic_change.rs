//! Change of a natural frequency by what quasi-static bodies lack.

use fe_contact::vibration::{ElasticInertia, LinearSet, VibratingSet};

use super::elastic_response::SLOW;
use super::energy::ModeEnergy;
use crate::error::ExperimentError;

/// What the inertia of elastic displacements and flexibility between meshes, which quasi-static bodies lack, change of a
/// frequency, to first order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ElasticChange {
    /// Relative change of the frequency.
    pub(super) relative: f64,
    /// λ over the first eigenvalue λ_1 of a body with its race held.
    of_first: f64,
}

impl ElasticChange {
    /// The change of a mode of quasi-static bodies; `None` where nothing bounds it.
    ///
    /// ```text
    /// (f'/f)² = (1 + δλ/λ of the flexibility)/(1 + δm)
    /// ```
    ///
    /// # Errors
    /// If a gear cannot be solved, or the set has no pairs.
    pub(super) fn new(
        set: &VibratingSet<'_>,
        linear: &LinearSet,
        mode: &ModeEnergy,
    ) -> Result<Option<Self>, ExperimentError> {
        let Some(inertia) = ElasticInertia::new(set)? else { return Ok(None) };
        let lambda = (std::f64::consts::TAU * mode.frequency_hz).powi(2);
        let shift = inertia.of_mode(set, linear, &mode.shape, lambda)?;
        let ratio = (1.0 + shift.coupling) / (1.0 + shift.remainder - shift.inertia);
        let has_bound = shift.remainder.is_finite() && ratio > 0.0;
        let (relative, of_first) = (ratio.sqrt() - 1.0, lambda / inertia.first());
        Ok(has_bound.then_some(Self { relative, of_first }))
    }

    /// Whether it may be added to the frequency: nearer to the first mode of a body, modes of the bodies come among those that are counted.
    pub(super) fn is_slow(&self) -> bool {
        self.of_first <= SLOW
    }
}
