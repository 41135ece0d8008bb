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

#[cfg(test)]
pub(super) mod tests {
    use gearset::{Facing, Scene};

    use super::super::prepared::Loading;
    use super::super::rotation::NominalRotation;
    use super::*;
    use crate::statics::{Bodies, Imperfections};

    /// What `work` gives for OH-58 with four planets at rest under its torque, with so many elements along a flank.
    pub(in super::super) fn oh58_at_rest<T>(
        flank_elements: u32,
        work: impl FnOnce(&mut VibratingSet<'_>) -> T,
    ) -> T {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = flank_elements;
        let bodies = Bodies::new(&scene).unwrap();
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let rotation = NominalRotation::Standing { position: 0.0, step: 5e-6 };
        let loading = Loading { torque_nm: 1130.0, mesh_force: 8000.0 };
        let mut set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        set.rest(1130.0).unwrap();
        work(&mut set)
    }
}
