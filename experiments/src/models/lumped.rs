//! The Lin–Parker lumped-parameter model.

use std::sync::Arc;

use lumped::{LumpedModel, NaturalModes};
use scene::{LoadCase, Scene};

use crate::bodies_cache::BodiesCache;
use crate::model::{
    ModalModel, ModelError, NextSpeeds, SpeedRequest, SteadyStateModel, one_request,
};
use crate::natural_mode::NaturalMode;
use crate::sweep::{MeshLawModel, SteadyState};

use super::fe_contact::{FeContact, march};

/// The lumped model of a scene's `[lumped]` table. In time its meshes follow forces tabulated by FE/contact.
#[derive(Debug, Default)]
pub struct Lumped {
    fe: FeContact,
}

impl Lumped {
    /// With gears shared with others.
    pub fn sharing(bodies: Arc<BodiesCache>) -> Self {
        Self { fe: FeContact::sharing(bodies) }
    }
}

impl ModalModel for Lumped {
    fn natural_modes(&self, scene: &Scene, _: &LoadCase) -> Result<Vec<NaturalMode>, ModelError> {
        let modes = NaturalModes::of(&LumpedModel::from_scene(scene)?)?;
        let of = |group: &lumped::ModeGroup| {
            let (frequency_hz, mode_type) = (group.frequency_hz, group.mode_type);
            std::iter::repeat_n(NaturalMode { frequency_hz, mode_type }, group.multiplicity)
        };
        Ok(modes.groups.iter().flat_map(of).collect())
    }
}

impl SteadyStateModel for Lumped {
    fn steady_states(
        &self,
        scene: &Scene,
        case: &LoadCase,
        request: &SpeedRequest<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        one_request(self, scene, case, request)
    }

    fn explore(
        &self,
        scene: &Scene,
        case: &LoadCase,
        accuracy: (usize, f64),
        next: NextSpeeds<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        let bodies = self.fe.bodies(scene)?;
        let model = MeshLawModel::new(scene, &bodies, *case)?.lumped();
        Ok(march(&model, accuracy, next)?)
    }
}
