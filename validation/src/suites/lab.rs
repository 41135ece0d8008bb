//! What suites about our own models share: scenes, gears meshed once, both models.

use std::sync::Arc;

use experiments::models::{FeContact, Lumped};
use experiments::{BodiesCache, ModelError};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, PairCycle, SetCycle, StaticSet, pair_cycle};
use gearset::MeshKind;
use scene::{LoadCase, Scene};

use crate::Profile;
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::judged::Judged;
use crate::reference::Reference;
use crate::reference_file::ReferenceError;

/// What the suites share.
pub(crate) struct Lab<'r> {
    pub(crate) reference: &'r Reference,
    pub(crate) profile: Profile,
    /// Four planets; the set with three planets has the same gears.
    pub(crate) four: Scene,
    pub(crate) three: Scene,
    pub(crate) bodies: Arc<Bodies>,
    /// Normal force of one mesh of three planets under 1130 N·m, N.
    pub(crate) force: f64,
    /// Gears of all scenes asked for so far.
    pub(crate) gears: Arc<BodiesCache>,
    /// The FE/contact model on those gears.
    pub(crate) fe: FeContact,
    /// The lumped model.
    pub(crate) lumped: Lumped,
}

pub(crate) const MESHES: [MeshKind; 2] = [MeshKind::SunPlanet, MeshKind::RingPlanet];

impl<'r> Lab<'r> {
    /// Meshes the gears of the default scene.
    ///
    /// # Errors
    /// If a scene of the catalogue cannot be used.
    pub(crate) fn new(reference: &'r Reference, profile: Profile) -> Result<Self, ValidationError> {
        let four = scene(PublishedScene::Oh58FourPlanets)?;
        let three = scene(PublishedScene::Oh58ThreePlanets)?;
        let gears = Arc::new(BodiesCache::default());
        let bodies = gears.of(&four)?;
        let sun = bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
        let force = 1130.0 / 3.0 / sun.base_radius;
        let fe = FeContact::sharing(Arc::clone(&gears));
        let lumped = Lumped::sharing(Arc::clone(&gears));
        Ok(Self { reference, profile, four, three, bodies, force, gears, fe, lumped })
    }

    /// One mesh alone over its cycle.
    pub(crate) fn pair(
        &self,
        bodies: &Bodies,
        kind: MeshKind,
        positions: usize,
    ) -> Result<PairCycle, ValidationError> {
        Ok(pair_cycle(bodies, kind, self.force, positions, &ActiveSet)?)
    }

    /// A set over its cycle; clockwise for negative torques.
    pub(crate) fn set(
        &self,
        scene: &Scene,
        bodies: &Bodies,
        torque_nm: f64,
        positions: usize,
        imperfections: Imperfections,
    ) -> Result<SetCycle, ValidationError> {
        let load = LoadCase::standing(torque_nm);
        let set = StaticSet::new(scene, bodies, load.sense(), imperfections)?;
        Ok(set.cycle(load.sun_load_nm(), positions, &ActiveSet)?)
    }

    /// A declared check, to be compared with a result.
    pub(crate) fn about<'a>(
        &'a self,
        id: &'a str,
        title: &'a str,
    ) -> Result<Judged<'a>, ReferenceError> {
        self.reference.about(id, title)
    }

    /// Whether the profile runs a check.
    pub(crate) fn runs(&self, id: &str) -> Result<bool, ReferenceError> {
        self.reference.registry.runs(id, self.profile)
    }
}

/// The unchanged error of a model.
pub(crate) fn of_model(source: ModelError) -> ValidationError {
    ValidationError::Model(source)
}
