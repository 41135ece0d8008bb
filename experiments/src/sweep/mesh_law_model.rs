//! Models whose meshes follow a tabulated law: the FE/contact fidelity `mesh_law`, and the lumped model in
//! time.

use dynamics::CoupledState;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use fe_contact::vibration::{MeshLawSet, MeshLawSettings, mesh_law};
use gearset::{Fidelity, LoadCase, MeshLaw, Scene};
use lumped::TimeVarying;

use super::marching::{Effort, Marching};
use super::sweep_model::{SweepModel, fidelity_name};
use crate::error::ExperimentError;

/// Name of the lumped model, as tables print it.
pub const LUMPED: &str = "lumped";

/// A set whose meshes follow a law made under the torque of the sweep.
#[derive(Debug)]
pub struct MeshLawModel<'s> {
    scene: Scene,
    loaded: StaticSet<'s>,
    case: LoadCase,
    law: MeshLaw,
    is_lumped: bool,
}

impl<'s> MeshLawModel<'s> {
    /// The FE/contact set under the torque of a load case.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub fn new(scene: &Scene, bodies: &'s Bodies, case: LoadCase) -> Result<Self, ExperimentError> {
        let mut scene = scene.clone();
        scene.dynamics.fidelity = Fidelity::MeshLaw;
        let steps = scene.dynamics.steps_per_cycle as usize;
        let settings = MeshLawSettings::at(case.sun_load_nm());
        let law = mesh_law(&scene, bodies, case.sense(), steps, &settings)?;
        let loaded = StaticSet::new(&scene, bodies, case.sense(), Imperfections::default())?;
        let loaded = loaded.under(case.sun_load_nm())?;
        Ok(Self { scene, loaded, case, law, is_lumped: false })
    }

    /// The lumped model with the same law in its meshes.
    pub fn lumped(&self) -> Self {
        Self {
            scene: self.scene.clone(),
            loaded: self.loaded.clone(),
            case: self.case,
            law: self.law.clone(),
            is_lumped: true,
        }
    }
}

impl SweepModel for MeshLawModel<'_> {
    fn name(&self) -> String {
        if self.is_lumped { LUMPED.into() } else { fidelity_name(Fidelity::MeshLaw) }
    }

    fn case(&self) -> LoadCase {
        self.case
    }

    fn planets(&self) -> usize {
        self.scene.planets.psi_rad.len()
    }

    fn first_planet_rad(&self) -> f64 {
        self.scene.planets.psi_rad.first().copied().unwrap_or(0.0)
    }

    fn steps_per_cycle(&self) -> usize {
        self.law.steps()
    }

    fn turning(
        &self,
        case: &LoadCase,
        _: usize,
    ) -> Result<Box<dyn Marching + '_>, ExperimentError> {
        let (law, torque) = (self.law.clone(), self.case.sun_load_nm());
        let has_backside = law.has_backside();
        let (sense, mesh_frequency) = (self.case.sense(), case.mesh_frequency_hz);
        if self.is_lumped {
            let set = TimeVarying::new(&self.scene, sense, law, mesh_frequency)?;
            return Ok(Box::new(LumpedMarching(set, torque, has_backside)));
        }
        let set = MeshLawSet::on(&self.scene, &self.loaded, mesh_frequency, law)?;
        Ok(Box::new(LawMarching(set, torque, has_backside)))
    }
}

/// Everything in a state as plain numbers.
fn flat(state: &CoupledState) -> Vec<f64> {
    let mut out = vec![state.step_in_cycle as f64, state.steps as f64];
    let CoupledState { modal, forces, .. } = state;
    for list in [&modal.x, &modal.v, &modal.a, &forces[0], &forces[1]] {
        out.extend(list);
    }
    out
}

/// A state like `pattern` from plain numbers; `None` if they are too few or too many.
fn shaped(flat: &[f64], pattern: &CoupledState) -> Option<CoupledState> {
    let mut state = pattern.clone();
    let (head, mut rest) = flat.split_at_checked(2)?;
    (state.step_in_cycle, state.steps) = (head[0] as usize, head[1] as u64);
    let CoupledState { modal, forces, .. } = &mut state;
    let [first, second] = forces;
    for list in [&mut modal.x, &mut modal.v, &mut modal.a, first, second] {
        let (own, others) = rest.split_at_checked(list.len())?;
        list.copy_from_slice(own);
        rest = others;
    }
    rest.is_empty().then_some(state)
}

/// A state of another kind of set.
const FOREIGN: ExperimentError = ExperimentError::Incomplete("state that fits this model");

/// A set with the torque it rests under (N m), and whether its law tabulates backside flanks.
struct LawMarching<'s>(MeshLawSet<'s>, f64, bool);

struct LumpedMarching(TimeVarying, f64, bool);

macro_rules! marching {
    ($which:ty) => {
        impl Marching for $which {
            fn rest(&mut self) -> Result<(), ExperimentError> {
                Ok(self.0.rest(self.1)?)
            }

            fn step(&mut self) -> Result<(), ExperimentError> {
                Ok(self.0.step()?)
            }

            fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
                self.0.displacements()
            }

            fn mesh_forces(&self, out: &mut Vec<f64>) {
                self.0.mesh_forces(out);
            }

            fn has_backside(&self) -> bool {
                self.2
            }

            fn effort(&self) -> Effort {
                let coordinates = self.0.motion().x.len();
                Effort { coordinates, solutions: self.0.counts().0 }
            }

            fn state(&mut self) -> Vec<f64> {
                flat(self.0.state())
            }

            fn counters(&self) -> usize {
                2
            }

            fn restore(&mut self, state: &[f64]) -> Result<(), ExperimentError> {
                // The load belongs to the set, not to its state.
                self.rest()?;
                let state = shaped(state, self.0.state()).ok_or(FOREIGN)?;
                Ok(self.0.set_state(&state)?)
            }
        }
    };
}

marching!(LawMarching<'_>);
marching!(LumpedMarching);
