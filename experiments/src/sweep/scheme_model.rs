//! The lumped model in time, stepped by a scheme of one's choice.

use std::sync::Arc;

use dynamics::integrators::Scheme;
use fe_contact::statics::Bodies;
use fe_contact::vibration::{MeshLawSettings, mesh_law};
use gearset::{Fidelity, LoadCase, MeshLaw, Scene};
use lumped::{LAW_STEPS_A_STEP, SchemeSet};

use super::marching::{Effort, Marching};
use super::set_shape::SetShape;
use super::sweep_model::{SweepModel, check_sense, damped};
use crate::error::ExperimentError;

/// The lumped model with the mesh law that FE/contact gives under the torque of a load case, stepped by a scheme. Its
/// steady states are marched.
#[derive(Debug)]
pub struct SchemeModel {
    scene: Scene,
    case: LoadCase,
    law: Arc<MeshLaw>,
    scheme: Scheme,
}

impl SchemeModel {
    /// With as many steps in a mesh cycle as the scene has.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub fn new(
        scene: &Scene,
        bodies: &Bodies,
        case: LoadCase,
        scheme: Scheme,
    ) -> Result<Self, ExperimentError> {
        let mut scene = scene.clone();
        scene.dynamics.fidelity = Fidelity::MeshLaw;
        let steps = LAW_STEPS_A_STEP * scene.dynamics.steps_per_cycle as usize;
        let settings = MeshLawSettings::at(case.sun_load_nm());
        let law = mesh_law(&scene, bodies, case.sense(), steps, &settings)?.into();
        Ok(Self { scene, case, law, scheme })
    }
}

impl SweepModel for SchemeModel {
    fn name(&self) -> String {
        format!("lumped, {}", self.scheme.label())
    }

    fn case(&self) -> LoadCase {
        self.case
    }

    fn shape(&self) -> SetShape {
        SetShape::of(&self.scene)
    }

    fn first_planet_rad(&self) -> f64 {
        self.scene.planets.psi_rad.first().copied().unwrap_or(0.0)
    }

    fn steps_per_cycle(&self) -> usize {
        self.law.steps() / LAW_STEPS_A_STEP
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        _: usize,
    ) -> Result<Box<dyn Marching + '_>, ExperimentError> {
        check_sense(&self.case, case)?;
        let scene = damped(&self.scene, damping_factor);
        let (law, torque) = (Arc::clone(&self.law), case.sun_load_nm());
        let has_backside = law.has_backside();
        let (sense, frequency) = (self.case.sense(), case.mesh_frequency_hz);
        let set = SchemeSet::new(&scene, sense, law, frequency, torque, self.scheme)?;
        let rest = set.continuous();
        Ok(Box::new(SchemeMarching { set, rest, has_backside, steps: 0.0 }))
    }
}

struct SchemeMarching {
    set: SchemeSet,
    /// The state of rest.
    rest: Vec<f64>,
    has_backside: bool,
    steps: f64,
}

impl Marching for SchemeMarching {
    fn rest(&mut self) -> Result<(), ExperimentError> {
        self.steps = 0.0;
        Ok(self.set.set_continuous(&self.rest)?)
    }

    fn step(&mut self) -> Result<(), ExperimentError> {
        self.steps += 1.0;
        Ok(self.set.step()?)
    }

    fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements()
    }

    fn mesh_forces(&self, out: &mut Vec<f64>) {
        self.set.mesh_forces(out);
    }

    fn has_backside(&self) -> bool {
        self.has_backside
    }

    fn effort(&self) -> Effort {
        let (coordinates, solutions) = self.set.effort();
        Effort { coordinates, solutions }
    }

    fn state(&mut self) -> Vec<f64> {
        std::iter::once(self.steps).chain(self.set.continuous()).collect()
    }

    fn counters(&self) -> usize {
        1
    }

    fn restore(&mut self, state: &[f64]) -> Result<(), ExperimentError> {
        let foreign = || ExperimentError::Incomplete("state that fits this model");
        let (steps, continuous) = state.split_first().ok_or_else(foreign)?;
        self.steps = *steps;
        Ok(self.set.set_continuous(continuous)?)
    }
}
