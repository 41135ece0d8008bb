//! Models whose meshes follow a tabulated law: the FE/contact fidelity `mesh_law`, and the lumped model in
//! time.

use std::sync::{Arc, OnceLock};

use dynamics::{CarriedChange, CoupledState, CyclePart, MapDerivative, PassedSteps};
use fe_contact::FeError;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use fe_contact::vibration::{Along, MeshLawSet};
use gearset::{MeshLaw, Symmetry};
use lumped::TimeVarying;
use scene::{Fidelity, LoadCase, Scene};

use super::error::SweepError;
use super::growing_law::{GrowingLaw, Range};
use super::marching::{Effort, Marching, motion_kinds};
use super::set_shape::SetShape;
use super::shooting::CycleDerivative;
use super::sweep_model::{
    MOST_TIMES, SweepModel, check_sense, damped, fidelity_name, scaling_rate, without_gyroscopic,
};
use crate::modal::MotionKinds;

/// Name of the lumped model, as tables print it.
pub const LUMPED: &str = "lumped";

/// A set whose meshes follow a law made under the torque of the sweep.
#[derive(Debug)]
pub struct MeshLawModel<'s> {
    scene: Scene,
    /// The loaded FE/contact set; `None` for the lumped model.
    loaded: Option<StaticSet<'s>>,
    case: LoadCase,
    laws: Arc<GrowingLaw<'s>>,
    /// The lumped set of the model's own scene at the first speed asked for, and its symmetry: sets at other speeds
    /// differ in their time steps only.
    known: OnceLock<(TimeVarying, Part)>,
    /// The same with 2, 3 … times the steps.
    finer: [OnceLock<Box<Self>>; MOST_TIMES - 1],
}

/// Symmetry after a part of the cycle, if a set has one.
type Part = Option<(Symmetry, CyclePart)>;

impl<'s> MeshLawModel<'s> {
    /// The FE/contact set under the torque of a load case.
    ///
    /// # Errors
    /// If the law cannot be made.
    pub fn new(scene: &Scene, bodies: &'s Bodies, case: LoadCase) -> Result<Self, SweepError> {
        let mut scene = scene.clone();
        scene.dynamics.fidelity = Fidelity::MeshLaw;
        let steps = scene.dynamics.steps_per_cycle as usize;
        let laws = GrowingLaw::new(&scene, bodies, case, steps)?.into();
        let loaded = StaticSet::new(&scene, bodies, case.sense(), Imperfections::default())?;
        let loaded = loaded.under(case.sun_load_nm())?;
        Ok(Self {
            scene,
            loaded: Some(loaded),
            case,
            laws,
            known: OnceLock::new(),
            finer: Default::default(),
        })
    }

    /// The lumped model with the same law in its meshes.
    pub fn lumped(&self) -> Self {
        let (scene, laws) = (self.scene.clone(), Arc::clone(&self.laws));
        Self {
            scene,
            loaded: None,
            case: self.case,
            laws,
            known: OnceLock::new(),
            finer: Default::default(),
        }
    }

    /// The lumped model with prescribed mesh stiffness: at each phase the secant of the law under the even share of the
    /// torque ([`MeshLaw::with_prescribed_stiffness`]), with the side loads of corner contacts and deformed flanks or
    /// without.
    ///
    /// # Errors
    /// If this is a lumped model, or a mesh has no deflection under its share.
    pub fn lumped_prescribed(
        &self,
        has_side_loads: bool,
    ) -> Result<MeshLawModel<'static>, SweepError> {
        let torque = self.case.sun_load_nm();
        let loaded = self.loaded.as_ref();
        let loaded = loaded.ok_or(SweepError::Incomplete("loaded FE/contact set"))?;
        let law = self.laws.first().with_prescribed_stiffness(loaded.share(torque));
        let law = law.map_err(FeError::from)?;
        let law = if has_side_loads { law } else { law.without_side_loads() };
        Ok(MeshLawModel::lumped_with(&self.scene, self.case, law))
    }

    /// A set of a scene that differs from the model's own in nothing that the law or the loaded set depends on:
    /// damping, masses; `size`: how often the tables of the law were found too small.
    pub(super) fn set_of(
        &self,
        scene: &Scene,
        case: &LoadCase,
        size: usize,
    ) -> Result<Box<dyn Marching + 's>, SweepError> {
        check_sense(&self.case, case)?;
        let (law, range) = self.laws.of_size(size)?;
        let torque = case.sun_load_nm();
        let has_backside = law.has_backside();
        let (sense, mesh_frequency) = (self.case.sense(), case.mesh_frequency_hz);
        let rate = scaling_rate(mesh_frequency);
        let Some(loaded) = &self.loaded else {
            let set = TimeVarying::new(scene, sense, law, mesh_frequency)?;
            return Ok(Box::new(self.lumped_marching(set, range, None, case)));
        };
        let set = MeshLawSet::on(scene, loaded, mesh_frequency, law)?;
        let passed = PassedSteps::default();
        Ok(Box::new(LawMarching { set, range, torque, has_backside, rate, passed, part: None }))
    }

    /// The lumped set of the model's own scene.
    fn own_lumped(&self, case: &LoadCase) -> Result<LumpedMarching, SweepError> {
        check_sense(&self.case, case)?;
        let mesh_frequency = case.mesh_frequency_hz;
        let (law, range) = self.laws.of_size(0)?;
        if let Some((known, part)) = self.known.get() {
            let set = known.at_frequency(mesh_frequency)?;
            return Ok(self.lumped_marching(set, range, Some(part.clone()), case));
        }
        let set = TimeVarying::new(&self.scene, self.case.sense(), law, mesh_frequency)?;
        let (_, part) = self.known.get_or_init(|| (set.clone(), set.symmetry()));
        Ok(self.lumped_marching(set, range, Some(part.clone()), case))
    }

    fn lumped_marching(
        &self,
        set: TimeVarying,
        range: Range,
        part: Option<Part>,
        case: &LoadCase,
    ) -> LumpedMarching {
        LumpedMarching {
            set,
            range,
            torque: case.sun_load_nm(),
            has_backside: self.laws.first().has_backside(),
            rate: scaling_rate(case.mesh_frequency_hz),
            passed: PassedSteps::default(),
            part,
        }
    }
}

impl MeshLawModel<'static> {
    /// The lumped model of a scene with any law in its meshes, under the torque of a load case.
    pub fn lumped_with(scene: &Scene, case: LoadCase, law: impl Into<Arc<MeshLaw>>) -> Self {
        let (scene, laws) = (scene.clone(), GrowingLaw::given(law.into()).into());
        Self { scene, loaded: None, case, laws, known: OnceLock::new(), finer: Default::default() }
    }
}

impl SweepModel for MeshLawModel<'_> {
    fn name(&self) -> String {
        if self.loaded.is_none() { LUMPED.into() } else { fidelity_name(Fidelity::MeshLaw) }
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
        self.laws.first().steps()
    }

    fn with_times_the_steps(&self, times: usize) -> Result<Option<&dyn SweepModel>, SweepError> {
        let Some(slot) = times.checked_sub(2).and_then(|k| self.finer.get(k)) else {
            return Ok(None);
        };
        if slot.get().is_none() {
            let Some(laws) = self.laws.with_steps(times * self.laws.first().steps())? else {
                return Ok(None);
            };
            let (scene, loaded) = (self.scene.clone(), self.loaded.clone());
            let finer = Default::default();
            let known = OnceLock::new();
            let made = Self { scene, loaded, case: self.case, laws: laws.into(), known, finer };
            slot.get_or_init(|| Box::new(made));
        }
        Ok(slot.get().map(|own| own.as_ref() as &dyn SweepModel))
    }

    fn in_short_cycles(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        match &self.loaded {
            Some(_) => {
                let scene = damped(&without_gyroscopic(&self.scene), damping_factor);
                self.set_of(&scene, case, size)
            }
            None => self.turning_damped(case, damping_factor, size),
        }
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        if self.loaded.is_none() && damping_factor == 1.0 && size == 0 {
            return Ok(Box::new(self.own_lumped(case)?));
        }
        self.set_of(&damped(&self.scene, damping_factor), case, size)
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
const FOREIGN: SweepError = SweepError::Incomplete("state that fits this model");

/// A set in time that follows a law.
struct LawMarching<'s> {
    set: MeshLawSet<'s>,
    /// Forces that its tables contain.
    range: Range,
    /// Torque on the sun under which it rests, N·m.
    torque: f64,
    /// Whether the law tabulates backside flanks.
    has_backside: bool,
    /// Frequency to which velocities are related, rad/s.
    rate: f64,
    /// States of the cycle marched last, or of the part of it after which the set is itself.
    passed: PassedSteps,
    /// Symmetry after a part of the cycle; `None` until it is asked for.
    part: Option<Part>,
}

/// The same for the lumped set.
struct LumpedMarching {
    set: TimeVarying,
    range: Range,
    torque: f64,
    has_backside: bool,
    rate: f64,
    passed: PassedSteps,
    part: Option<Part>,
}

macro_rules! marching {
    ($which:ty, $coordinates:ident, $kinds:expr) => {
        impl Marching for $which {
            fn rest(&mut self) -> Result<(), SweepError> {
                Ok(self.set.rest(self.torque)?)
            }

            fn step(&mut self) -> Result<(), SweepError> {
                self.set.step()?;
                Ok(self.range.check(self.set.forces())?)
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
                let coordinates = self.set.motion().x.len();
                Effort { coordinates, solutions: self.set.counts().0 }
            }

            fn state(&mut self) -> Vec<f64> {
                flat(self.set.state())
            }

            fn counters(&self) -> usize {
                2
            }

            fn restore(&mut self, state: &[f64]) -> Result<(), SweepError> {
                // The load belongs to the set, not to its state.
                self.set.load(self.torque)?;
                let state = shaped(state, self.set.state()).ok_or(FOREIGN)?;
                Ok(self.set.set_state(&state)?)
            }

            fn derivative(&mut self) -> Option<&mut dyn CycleDerivative> {
                Some(self)
            }

            fn kinds(&self) -> Option<MotionKinds> {
                $kinds(&self.set)
            }

            fn displacements_of(&self, coordinates: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
                self.set.displacements_of(coordinates)
            }
        }

        impl CycleDerivative for $which {
            fn coordinates(&mut self) -> Vec<f64> {
                self.set.$coordinates()
            }

            fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError> {
                Ok(self.set.set_coordinates(y)?)
            }

            fn symmetry(&mut self) -> Result<Option<Symmetry>, SweepError> {
                let part = self.part.get_or_insert_with(|| self.set.symmetry());
                Ok(part.as_ref().map(|(own, _)| *own))
            }

            fn start(&mut self) {
                self.passed.clear();
                self.set.keep_step(&mut self.passed);
            }

            fn keep_step(&mut self) {
                self.set.keep_step(&mut self.passed);
            }

            fn end(&mut self) -> Result<(), SweepError> {
                if let Some((_, part)) = self.part.iter().flatten().next() {
                    if self.set.state().step_in_cycle > 0 {
                        self.set.take_part_back(part);
                    }
                }
                Ok(())
            }

            /// Displacements and velocities are all coordinates.
            fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, SweepError> {
                let found = match along {
                    Along::MotionRoughly => self.set.derivative_of::<f32>(&self.passed, self.rate),
                    Along::Motion | Along::Every => {
                        self.set.derivative_of::<f64>(&self.passed, self.rate)
                    }
                };
                of_part(found, &self.part, &self.passed)
            }

            fn of_cycle_with(
                &mut self,
                change: CarriedChange<'_>,
            ) -> Result<MapDerivative, SweepError> {
                let found = self.set.derivative_with(&self.passed, self.rate, change);
                of_part(found, &self.part, &self.passed)
            }
        }
    };
}

/// The derivative of the steps passed, renumbered where they make a part of the cycle only.
fn of_part(
    found: Option<MapDerivative>,
    part: &Option<Part>,
    passed: &PassedSteps,
) -> Result<MapDerivative, SweepError> {
    let found = found.ok_or(SweepError::Incomplete("cycle to differentiate"))?;
    Ok(match part.iter().flatten().next() {
        Some((_, part)) if passed.ends_within_cycle() => part.renumbered(found),
        _ => found,
    })
}

marching!(LawMarching<'_>, coordinates, |set: &MeshLawSet<'_>| {
    let races = set.races();
    motion_kinds(&races.inertias(set.masses()), &races.psi)
});
marching!(LumpedMarching, coordinates_of_motion, |set: &TimeVarying| {
    motion_kinds(set.inertias(), set.planet_angles_rad())
});
