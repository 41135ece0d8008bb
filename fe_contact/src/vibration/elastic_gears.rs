//! The gears of a set as accelerations of their races move them elastically.

use super::set::VibratingSet;
use crate::body::Accelerated;
use crate::error::FeError;
use crate::statics::PLANETS;

/// Static displacements of the gears of a set under accelerations of their races.
#[derive(Debug)]
pub struct ElasticGears {
    /// Ring, sun, planet: planets are alike in what is elastic.
    kinds: Vec<Accelerated>,
}

impl ElasticGears {
    /// Of the gears of a set; `None` if the teeth of one are not meshed alike.
    ///
    /// # Errors
    /// If a gear cannot be solved.
    pub fn new(set: &VibratingSet<'_>) -> Result<Option<Self>, FeError> {
        let kinds = set.bodies.gears.iter().take(PLANETS);
        let kinds = kinds.map(|gear| Accelerated::new(gear.body)).collect::<Result<Vec<_>, _>>()?;
        Ok(kinds.into_iter().collect::<Option<_>>().map(|kinds| Self { kinds }))
    }

    /// Number of the kind of gear k.
    pub(super) fn kind(&self, k: usize) -> usize {
        k.min(self.kinds.len() - 1)
    }

    /// That of gear k.
    pub(super) fn of(&self, k: usize) -> &Accelerated {
        &self.kinds[self.kind(k)]
    }

    /// Least Rayleigh quotient of the displacements, close to the first eigenvalue of a gear with its race held, (rad/s)².
    pub fn first(&self) -> f64 {
        self.kinds.iter().map(Accelerated::first).fold(f64::INFINITY, f64::min)
    }
}
