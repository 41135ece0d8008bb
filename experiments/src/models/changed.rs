//! A model evaluated on changed scenes, for negative controls and parameter studies.

use scene::{LoadCase, Scene};

use crate::mesh_cycle::MeshCycle;
use crate::model::{
    ModalModel, ModelError, NextSpeeds, SpeedRequest, StaticModel, SteadyStateModel,
};
use crate::natural_mode::NaturalMode;
use crate::sweep::SteadyState;

/// A model that receives every scene after a change.
#[derive(Debug, Clone)]
pub struct Changed<'m, M: ?Sized, F> {
    model: &'m M,
    change: F,
}

impl<'m, M: ?Sized, F: Fn(&mut Scene)> Changed<'m, M, F> {
    /// `model`, evaluated on scenes after `change`.
    pub fn new(model: &'m M, change: F) -> Self {
        Self { model, change }
    }

    fn changed(&self, scene: &Scene) -> Scene {
        let mut scene = scene.variant("changed");
        (self.change)(&mut scene);
        scene
    }
}

impl<M: ModalModel + ?Sized, F: Fn(&mut Scene)> ModalModel for Changed<'_, M, F> {
    fn natural_modes(
        &self,
        scene: &Scene,
        case: &LoadCase,
    ) -> Result<Vec<NaturalMode>, ModelError> {
        self.model.natural_modes(&self.changed(scene), case)
    }
}

impl<M: StaticModel + ?Sized, F: Fn(&mut Scene)> StaticModel for Changed<'_, M, F> {
    fn mesh_cycle(
        &self,
        scene: &Scene,
        case: &LoadCase,
        positions: usize,
    ) -> Result<MeshCycle, ModelError> {
        self.model.mesh_cycle(&self.changed(scene), case, positions)
    }
}

impl<M: SteadyStateModel + ?Sized, F: Fn(&mut Scene)> SteadyStateModel for Changed<'_, M, F> {
    fn steady_states(
        &self,
        scene: &Scene,
        case: &LoadCase,
        request: &SpeedRequest<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        self.model.steady_states(&self.changed(scene), case, request)
    }

    fn explore(
        &self,
        scene: &Scene,
        case: &LoadCase,
        accuracy: (usize, f64),
        next: NextSpeeds<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        self.model.explore(&self.changed(scene), case, accuracy, next)
    }
}
