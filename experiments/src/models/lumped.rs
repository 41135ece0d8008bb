//! The Lin–Parker lumped-parameter model.

use gearset::{LoadCase, Scene};
use lumped::{LumpedModel, NaturalModes};

use crate::model::{ModalModel, ModelError, SpeedRequest, SteadyStateModel};
use crate::natural_mode::NaturalMode;
use crate::sweep::{LawModel, SteadyState};

use super::fe_contact::{FeContact, march};

/// The lumped model of a scene's `[lumped]` table. In time its meshes follow forces tabulated by FE/contact.
#[derive(Debug, Default)]
pub struct Lumped {
    fe: FeContact,
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
        let bodies = self.fe.bodies(scene)?;
        Ok(march(&LawModel::new(scene, &bodies, *case)?.lumped(), request)?)
    }
}
