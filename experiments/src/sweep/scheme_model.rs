//! The lumped model in time, stepped by a scheme of one's choice.

use dynamics::benchmark_subjects::Scheme;
use fe_contact::statics::Bodies;
use lumped::{LAW_STEPS_A_STEP, SchemeSet};
use scene::{Fidelity, LoadCase, Scene};

use super::error::SweepError;
use super::growing_law::{GrowingLaw, Range};
use super::marching::{Effort, Marching};
use super::set_shape::SetShape;
use super::sweep_model::{SweepModel, check_sense, damped};

/// The lumped model with the mesh law that FE/contact gives under the torque of a load case, stepped by a scheme. Its
/// steady states are marched.
#[derive(Debug)]
pub struct SchemeModel<'s> {
    scene: Scene,
    case: LoadCase,
    laws: GrowingLaw<'s>,
    scheme: Scheme,
}

impl<'s> SchemeModel<'s> {
    /// With as many steps in a mesh cycle as the scene has.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        case: LoadCase,
        scheme: Scheme,
    ) -> Result<Self, SweepError> {
        let mut scene = scene.clone();
        scene.dynamics.fidelity = Fidelity::MeshLaw;
        let steps = LAW_STEPS_A_STEP * scene.dynamics.steps_per_cycle as usize;
        let laws = GrowingLaw::new(&scene, bodies, case, steps)?;
        Ok(Self { scene, case, laws, scheme })
    }
}

impl SweepModel for SchemeModel<'_> {
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
        self.laws.first().steps() / LAW_STEPS_A_STEP
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        check_sense(&self.case, case)?;
        let scene = damped(&self.scene, damping_factor);
        let ((law, range), torque) = (self.laws.of_size(size)?, case.sun_load_nm());
        let has_backside = law.has_backside();
        let (sense, frequency) = (self.case.sense(), case.mesh_frequency_hz);
        let set = SchemeSet::new(&scene, sense, law, frequency, torque, self.scheme)?;
        let rest = set.continuous();
        let forces = Vec::new();
        Ok(Box::new(SchemeMarching { set, range, forces, rest, has_backside, steps: 0.0 }))
    }
}

struct SchemeMarching {
    set: SchemeSet,
    /// Forces that its tables contain.
    range: Range,
    /// Those of the last step, N.
    forces: Vec<f64>,
    /// The state of rest.
    rest: Vec<f64>,
    has_backside: bool,
    steps: f64,
}

impl Marching for SchemeMarching {
    fn rest(&mut self) -> Result<(), SweepError> {
        self.steps = 0.0;
        Ok(self.set.set_continuous(&self.rest)?)
    }

    fn step(&mut self) -> Result<(), SweepError> {
        self.steps += 1.0;
        self.set.step()?;
        self.set.mesh_forces(&mut self.forces);
        Ok(self.range.check(&self.forces)?)
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

    fn restore(&mut self, state: &[f64]) -> Result<(), SweepError> {
        let foreign = || SweepError::Incomplete("state that fits this model");
        let (steps, continuous) = state.split_first().ok_or_else(foreign)?;
        self.steps = *steps;
        Ok(self.set.set_continuous(continuous)?)
    }
}
