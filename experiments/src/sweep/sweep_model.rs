//! Models that sweeps can be run on: whatever gives a turning set at a mesh frequency.

use std::sync::OnceLock;

use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{Loading, NominalRotation, Prepared, VibratingSet};
use scene::{Fidelity, LoadCase, Scene};

use super::error::SweepError;
use super::marching::{FeMarching, Marching};
use super::set_shape::SetShape;
use super::shifted_vibrations::ShiftedVibrations;
use super::varied_key::VariedKey;
use crate::table_growth::SIZES;

/// A model of one gear set under one torque.
pub trait SweepModel: Sync {
    /// Name of the fidelity or model, as tables print it.
    fn name(&self) -> String;

    /// What it is loaded with and driven by.
    fn case(&self) -> LoadCase;

    /// Number of planets, and whether there are ring meshes.
    fn shape(&self) -> SetShape;

    /// Number of planets.
    fn planets(&self) -> usize {
        self.shape().planets
    }

    /// ψ₀: central members' radial direction is towards planet 0, rad.
    fn first_planet_rad(&self) -> f64;

    /// Steps in a mesh cycle.
    fn steps_per_cycle(&self) -> usize;

    /// Computes what sets share at all speeds, on all threads; without it the first sets on every thread would each
    /// compute it.
    ///
    /// # Errors
    /// If a set cannot be built.
    fn prepare(&self) -> Result<(), SweepError> {
        Ok(())
    }

    /// The same model with `times` as many steps in a mesh cycle, on what it has found where it can; `None` of a
    /// model with a fixed number of steps.
    ///
    /// # Errors
    /// If its tables cannot be made.
    fn with_times_the_steps(&self, times: usize) -> Result<Option<&dyn SweepModel>, SweepError> {
        let _ = times;
        Ok(None)
    }

    /// The set turning at the speed and under the torque of a load case. `size`: how often its tables were found too
    /// small and are to be laid out for twice the load.
    ///
    /// What a model computes once it computes under the torque of its own [`case`](Self::case): the loaded
    /// configuration that the set is linearised about, contact tables or the law of the meshes. It stays the same under
    /// another torque.
    ///
    /// # Errors
    /// If the set cannot be built, or the torque presses the other flanks than the model's own.
    fn turning(&self, case: &LoadCase, size: usize) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.turning_damped(case, 1.0, size)
    }

    /// The set of a cycle so short that it hardly moves, whose multipliers are those of its vibrations: as
    /// [`turning_damped`](Self::turning_damped), but without the terms of the carrier's turning, which would be
    /// those of a carrier that turns as fast.
    ///
    /// # Errors
    /// As [`turning_damped`](Self::turning_damped).
    fn in_short_cycles(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.turning_damped(case, damping_factor, size)
    }

    /// What the inertia of the bodies behind the teeth changes of the vibrations; `None` of a model that has it, or
    /// of which nothing is known of it.
    fn body_inertia(&self) -> Option<ShiftedVibrations> {
        None
    }

    /// The set with every damping of the scene multiplied by `damping_factor`.
    ///
    /// # Errors
    /// As [`turning`](Self::turning), or if the factor is negative or not finite.
    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError>;

    /// The set at the speed and under the torque of the model's own case, of a scene with another value of a key; only
    /// of a model that is made for this key ([`KeyedModel`](super::KeyedModel)).
    ///
    /// # Errors
    /// As [`turning`](Self::turning), if the scene does not allow the value, or of any other model.
    fn turning_with(
        &self,
        key: VariedKey,
        value: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        let _ = (key, value, size);
        Err(SweepError::Incomplete("varied key: the model is of one scene"))
    }
}

/// A scene without the terms of the carrier's turning.
pub(super) fn without_gyroscopic(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.dynamics.gyroscopic = false;
    scene
}

/// Refuses a torque that presses other flanks than those a model was made for.
pub(super) fn check_sense(own: &LoadCase, other: &LoadCase) -> Result<(), SweepError> {
    if own.sense() == other.sense() && own.direction() == other.direction() {
        return Ok(());
    }
    let (torque_nm, own_nm) = (other.sun_torque_nm, own.sun_torque_nm);
    Err(SweepError::OtherFlanks { torque_nm, own_nm })
}

/// A scene with every damping multiplied by a factor.
pub(super) fn damped(scene: &Scene, factor: f64) -> Scene {
    let mut scene = scene.clone();
    scene.damping = scene.damping.times(factor);
    scene
}

/// Name of a fidelity of the FE/contact model, as tables print it.
pub fn fidelity_name(fidelity: Fidelity) -> String {
    match fidelity {
        Fidelity::QuasiStatic => "quasi-static".into(),
        Fidelity::Modal(n) => format!("modal({n})"),
        Fidelity::Full => "full".into(),
        Fidelity::MeshLaw => "mesh-law".into(),
    }
}

/// Tables are made for this many times the even share of the load: resonance must fit.
pub const HEADROOM: f64 = 2.0;

/// Frequency (rad/s) to which velocities are related where states are scaled: resonances are excited by the
/// first harmonics of the mesh frequency (Hz).
pub(super) fn scaling_rate(mesh_frequency: f64) -> f64 {
    3.0 * std::f64::consts::TAU * mesh_frequency
}

/// The FE/contact model on the fidelity of its scene, tables shared by all speeds.
#[derive(Debug)]
pub struct FeModel<'s> {
    scene: Scene,
    bodies: &'s Bodies,
    imperfections: Imperfections,
    case: LoadCase,
    table_size: usize,
    prepared: [OnceLock<Prepared<'s>>; SIZES],
    /// The same with 2, 3 … times the steps.
    finer: [OnceLock<Box<Self>>; MOST_TIMES - 1],
}

/// Most times the steps of a scene that a model takes at low speeds.
pub(super) const MOST_TIMES: usize = 8;

impl<'s> FeModel<'s> {
    /// Under the torque of a load case.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        imperfections: Imperfections,
        case: LoadCase,
    ) -> Self {
        let prepared = [const { OnceLock::new() }; SIZES];
        let finer = [const { OnceLock::new() }; MOST_TIMES - 1];
        let (scene, table_size) = (scene.clone(), 0);
        Self { scene, bodies, imperfections, case, table_size, prepared, finer }
    }

    /// The same with tables laid out for twice the load, as often as `size` says, before any is found too
    /// small: cells of a pair are as many, so larger tables are coarser ones, and models are compared on
    /// the same.
    pub fn with_tables(self, size: usize) -> Self {
        Self { table_size: size, ..self }
    }

    /// The same model with the steps of `scene`, on what this one has found: the mean configuration, and tables at
    /// positions that both have.
    ///
    /// # Errors
    /// If tables cannot be laid out.
    pub(crate) fn with_steps(&self, scene: &Scene) -> Result<Self, SweepError> {
        let own = Self::new(scene, self.bodies, self.imperfections.clone(), self.case)
            .with_tables(self.table_size);
        let made = self.shared(0)?.with_steps(scene, own.force(self.table_size)?)?;
        own.prepared[0].get_or_init(|| made);
        Ok(own)
    }

    /// What sets share whose tables were found too small `size` times.
    fn shared(&self, size: usize) -> Result<&Prepared<'s>, SweepError> {
        let slot = &self.prepared[size.min(SIZES - 1)];
        if let Some(prepared) = slot.get() {
            return Ok(prepared);
        }
        let (steps_per_cycle, mesh_frequency) = (self.steps_per_cycle(), 1.0);
        let direction = self.case.direction();
        let rotation = NominalRotation::Turning { mesh_frequency, steps_per_cycle, direction };
        let mesh_force = self.force(self.table_size + size)?;
        let loading = Loading { torque_nm: self.case.sun_load_nm(), mesh_force };
        let (sense, own) = (self.case.sense(), self.imperfections.clone());
        let made = Prepared::new(&self.scene, self.bodies, sense, own, rotation, loading)?;
        Ok(slot.get_or_init(|| made))
    }

    /// A set of a scene that differs from the model's own in nothing that [`Prepared`] depends on: damping, masses.
    pub(super) fn set_of(
        &self,
        scene: &Scene,
        case: &LoadCase,
        size: usize,
    ) -> Result<Box<dyn Marching + 's>, SweepError> {
        check_sense(&self.case, case)?;
        let (steps_per_cycle, mesh_frequency) = (self.steps_per_cycle(), case.mesh_frequency_hz);
        let direction = self.case.direction();
        let rotation = NominalRotation::Turning { mesh_frequency, steps_per_cycle, direction };
        let torque_nm = case.sun_load_nm();
        let set = VibratingSet::on(scene, self.shared(size)?, rotation)?;
        let rate = scaling_rate(mesh_frequency);
        Ok(Box::new(FeMarching { set, torque_nm, rate }))
    }

    /// Mesh force that tables of a size are made for, N.
    fn force(&self, size: usize) -> Result<f64, SweepError> {
        let sun = self.bodies.geometry.sun.as_ref();
        let radius = sun.ok_or(SweepError::Incomplete("sun"))?.base_radius;
        let share = self.case.sun_load_nm() / radius / self.planets() as f64;
        Ok(HEADROOM * share.max(1.0) * f64::powi(2.0, size as i32))
    }
}

impl SweepModel for FeModel<'_> {
    fn name(&self) -> String {
        fidelity_name(self.scene.dynamics.fidelity)
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
        self.scene.dynamics.steps_per_cycle as usize
    }

    fn prepare(&self) -> Result<(), SweepError> {
        self.shared(0).map(|_| ())
    }

    fn with_times_the_steps(&self, times: usize) -> Result<Option<&dyn SweepModel>, SweepError> {
        let Some(slot) = times.checked_sub(2).and_then(|k| self.finer.get(k)) else {
            return Ok(None);
        };
        if slot.get().is_none() {
            let mut scene = self.scene.clone();
            scene.dynamics.steps_per_cycle *= times as u32;
            let made = Box::new(self.with_steps(&scene)?);
            slot.get_or_init(|| made);
        }
        Ok(slot.get().map(|own| own.as_ref() as &dyn SweepModel))
    }

    fn in_short_cycles(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.set_of(&damped(&without_gyroscopic(&self.scene), damping_factor), case, size)
    }

    fn body_inertia(&self) -> Option<ShiftedVibrations> {
        let is_quasi_static = self.scene.dynamics.fidelity == Fidelity::QuasiStatic;
        is_quasi_static.then(|| ShiftedVibrations::of(&self.scene, &self.case)).flatten()
    }

    fn turning_damped(
        &self,
        case: &LoadCase,
        damping_factor: f64,
        size: usize,
    ) -> Result<Box<dyn Marching + '_>, SweepError> {
        self.set_of(&damped(&self.scene, damping_factor), case, size)
    }
}
