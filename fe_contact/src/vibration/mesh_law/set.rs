//! A set in time whose mesh forces follow a mesh law: races, masses, bearings and carrier of the
//! quasi-static fidelity, with table look-up in place of contact.

use std::sync::Arc;

use dynamics::{
    AverageAcceleration, CarriedChange, Coupled, CoupledState, Coupling, CyclePart, LinearPart,
    MapDerivative, Motion, Number, PassedSteps, Renumbering,
};
use gearset::{Body, Facing, MeshLaw, Symmetry};
use nalgebra::{DMatrix, DVector};
use scene::Scene;

use super::super::build::body_mass;
use super::super::gyroscopic::{GyroscopicTerms, carrier_speed};
use super::super::prepared::fit;
use super::super::rotation::NominalRotation;
use super::law::MeshLawCouplings;
use crate::error::FeError;
use crate::statics::{Bodies, Imperfections, Races, StaticSet};

/// A set in time with tabulated mesh forces.
#[derive(Debug)]
pub struct MeshLawSet<'s> {
    statics: StaticSet<'s>,
    system: Coupled<MeshLawCouplings>,
    mass: Vec<f64>,
}

impl<'s> MeshLawSet<'s> {
    /// A turning set for a torque on the sun of the given sense, at first without motion and load
    /// at step 0 of a mesh cycle, with as many steps per cycle as the law. `torque_nm` is that of
    /// the law (N·m, magnitude); deflections are linear about the mean configuration under it.
    ///
    /// # Errors
    /// If the scene lacks what the set needs, or the law is for another one.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        sense: Facing,
        mesh_frequency: f64,
        torque_nm: f64,
        law: impl Into<Arc<MeshLaw>>,
    ) -> Result<Self, FeError> {
        let statics = StaticSet::new(scene, bodies, sense, Imperfections::default())?;
        Self::on(scene, &statics.under(torque_nm)?, mesh_frequency, law)
    }

    /// The same on a set that is linearised about its mean configuration under the law's torque.
    ///
    /// # Errors
    /// As [`MeshLawSet::new`].
    pub fn on(
        scene: &Scene,
        loaded: &StaticSet<'s>,
        mesh_frequency: f64,
        law: impl Into<Arc<MeshLaw>>,
    ) -> Result<Self, FeError> {
        let law = law.into();
        let steps = law.steps();
        let direction = law.direction();
        let rotation =
            NominalRotation::Turning { mesh_frequency, steps_per_cycle: steps, direction };
        fit(scene, &rotation)?;
        let statics = loaded.clone();
        let bodies = statics.bodies;
        let reference = statics.reference();
        let races = &statics.races;
        let planets = races.planets();
        if law.meshes() != statics.meshes() {
            return Err(FeError::Unfit {
                key: "planets.count".into(),
                value: format!("{} meshes", statics.meshes()),
                allowed: format!("{} meshes", law.meshes()),
                why: "the mesh law was made for them".into(),
            });
        }
        let n = races.count;
        let mut mass = vec![0.0; n];
        for body in Body::all(planets) {
            races.add(body, body_mass(&statics, scene, body)?, &mut mass);
        }
        let d = &scene.damping;
        // C = αM + τ K: dashpots at supports and bearings, through the carrier's flexibility.
        let mut damping = DMatrix::from_fn(n, n, |i, j| {
            let own = if i == j { d.mass_proportional_per_s * mass[i] } else { 0.0 };
            own + d.bearing_s * races.stiffness[(i, j)]
        });
        let turning = &reference.stiffness;
        let mut stiffness =
            DMatrix::from_fn(n, n, |i, j| races.stiffness[(i, j)] + turning[(i, j)]);
        if scene.dynamics.gyroscopic {
            let speed = direction.sign() * carrier_speed(scene, mesh_frequency);
            let terms = GyroscopicTerms::new(races, &mass, speed);
            let (g, k) = (&terms.gyroscopic, &terms.centripetal);
            damping += g;
            stiffness += k;
        }
        let (mut front, mut backside) = (Vec::new(), Vec::new());
        for (pose, behind) in reference.meshes.iter().zip(&reference.backside) {
            let lag = d.stiffness_proportional_s * law.damping_share(front.len());
            let coupling = |row: &DVector<f64>, at: f64| {
                let offset = row.dot(&reference.q) - at;
                Coupling { row: row.as_slice().to_vec(), offset, lag }
            };
            front.push(coupling(&pose.gradients[0], pose.at[0]));
            let backlash = bodies.geometry.normal_backlash(pose.kind).unwrap_or(0.0);
            backside.push(coupling(&behind.row.full(n), behind.approach + backlash));
        }
        if !law.has_backside() {
            backside.clear();
        }
        let step = 1.0 / (mesh_frequency * steps as f64);
        let rule = AverageAcceleration::new(step).map_err(|e| FeError::Unfit {
            key: "operation.speed_rpm".into(),
            value: format!("{} s a step", e.0),
            allowed: "a speed above 0".into(),
            why: "speed and steps a cycle give no step".into(),
        })?;
        let part = LinearPart { mass: mass.clone(), damping, stiffness };
        let turning = turning * &reference.q;
        let mut side_loads = side_loads(races, &law);
        for load in &mut side_loads {
            load.iter_mut().zip(turning.iter()).for_each(|(load, f)| *load += f);
        }
        let system = Coupled::new(&part, &front, &backside, MeshLawCouplings(law), rule, steps);
        let system = system.map_err(|cause| failed(&statics, cause))?;
        let mut system = system.bounded_by(bodies.geometry.largest_displacement());
        for (step, load) in side_loads.iter().enumerate() {
            system.add_in_cycle(step, load).map_err(|cause| failed(&statics, cause))?;
        }
        Ok(Self { statics, system, mass })
    }

    /// Puts the set to rest under a torque on the sun (N m, magnitude) at its current step.
    ///
    /// # Errors
    /// If there is no equilibrium.
    pub fn rest(&mut self, torque_nm: f64) -> Result<(), FeError> {
        self.load(torque_nm)?;
        self.system.rest().map_err(|cause| failed(&self.statics, cause))
    }

    /// Loads the set by a torque on the sun (N m, magnitude) from now on, its state left as it is.
    ///
    /// # Errors
    /// None with a set that was made.
    pub fn load(&mut self, torque_nm: f64) -> Result<(), FeError> {
        self.set_external(self.statics.load(torque_nm).as_slice())
    }

    /// Sets the external forces on the races' coordinates (N) from now on.
    ///
    /// # Errors
    /// If there is not one for each coordinate.
    pub fn set_external(&mut self, force: &[f64]) -> Result<(), FeError> {
        self.system.set_external(force).map_err(|cause| failed(&self.statics, cause))
    }

    /// One step.
    ///
    /// # Errors
    /// If the step is not solved or the motion diverges.
    #[inline]
    pub fn step(&mut self) -> Result<(), FeError> {
        self.system.step().map_err(|cause| failed(&self.statics, cause))
    }

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad; carrier frame) and of the planets
    /// (ζ, η, θ), counter-clockwise.
    pub fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.statics.displacements(&DVector::from_vec(self.system.displacements()))
    }

    /// Force of each mesh: sun meshes, ring meshes, then their backside flanks if the law has them, N.
    pub fn mesh_forces(&self, out: &mut Vec<f64>) {
        out.clear();
        out.extend_from_slice(self.forces());
    }

    /// The same as they are kept, N.
    pub fn forces(&self) -> &[f64] {
        self.system.forces()
    }

    /// Whether all deflections of the present step are within the law's tables; beyond them forces
    /// are extrapolated linearly.
    pub fn is_within_tables(&self) -> bool {
        let (tables, step) = (self.system.law(), self.state().step_in_cycle);
        let deflections = self.system.deflections();
        let mut each = deflections.iter().enumerate();
        each.all(|(k, d)| tables.0.curve(k, step).is_none_or(|curve| curve.reaches(*d)))
    }

    /// Displacements, velocities and accelerations of the races' free coordinates, m and s.
    pub fn motion(&self) -> Motion {
        self.system.motion()
    }

    /// Gives the races' free coordinates displacements `x` (m) and velocities `v` (m/s) at a step
    /// of the cycle.
    ///
    /// # Errors
    /// If there is not one number for each coordinate.
    pub fn set_motion(
        &mut self,
        step_in_cycle: usize,
        x: &[f64],
        v: &[f64],
    ) -> Result<(), FeError> {
        let set = self.system.set_motion(step_in_cycle, x, v);
        set.map_err(|cause| failed(&self.statics, cause))
    }

    /// The complete state, from which the set continues exactly.
    pub fn state(&self) -> &CoupledState {
        self.system.state()
    }

    /// Continues from a state of this set, with bitwise the same results as before.
    ///
    /// # Errors
    /// If the state is of another set.
    pub fn set_state(&mut self, state: &CoupledState) -> Result<(), FeError> {
        self.system.set_state(state).map_err(|cause| failed(&self.statics, cause))
    }

    /// Displacements and velocities of the modes of the races on their supports: they determine the motion that
    /// follows.
    pub fn coordinates(&self) -> Vec<f64> {
        self.system.coordinates()
    }

    /// Continues from other coordinates at the present step of the cycle.
    ///
    /// # Errors
    /// If they are too few or too many, or not finite.
    pub fn set_coordinates(&mut self, y: &[f64]) -> Result<(), FeError> {
        self.system.set_coordinates(y).map_err(|cause| failed(&self.statics, cause))
    }

    /// Displacements as [`MeshLawSet::displacements`] in coordinates `y`.
    pub fn displacements_of(&self, y: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.statics.displacements(&DVector::from_vec(self.system.displacements_of(y)))
    }

    /// The symmetry after a part of the mesh cycle that the set has, with the most parts.
    pub fn symmetry(&self) -> Option<(Symmetry, CyclePart)> {
        let (sign, races) = (self.statics.sign(), &self.statics.races);
        let couplings = self.system.forces().len();
        let place = |body, axis| races.of(body, axis);
        let steps = self.system.law().0.steps();
        let all = Symmetry::renumberings(&races.psi, steps, couplings, place);
        all.into_iter().find_map(|(own, coordinates, couplings)| {
            let renumbering = Renumbering { parts: own.parts, coordinates, couplings };
            Some((own.seen_with(sign), self.system.part_of_cycle(&renumbering)?))
        })
    }

    /// Ends such a part that began at step 0: the set stands at step 0 again, its planets renumbered.
    pub fn take_part_back(&mut self, part: &CyclePart) {
        self.system.take_part_back(part);
    }

    /// Adds the present state to those passed.
    pub fn keep_step(&self, passed: &mut PassedSteps) {
        self.system.keep_step(passed);
    }

    /// The derivative of the last of the states passed with respect to the first, between which every step was
    /// kept, computed in the precision of T; frequencies of the motion are of the order of `rate` (rad/s). `None`
    /// without a state.
    pub fn derivative_of<T: Number>(
        &self,
        passed: &PassedSteps,
        rate: f64,
    ) -> Option<MapDerivative> {
        self.system.derivative_of::<T>(passed, rate)
    }

    /// The same in double precision, with a change of the coordinates at the start carried along. `None` also for a
    /// change of another size.
    pub fn derivative_with(
        &self,
        passed: &PassedSteps,
        rate: f64,
        change: CarriedChange<'_>,
    ) -> Option<MapDerivative> {
        self.system.derivative_with(passed, rate, change)
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.system.time()
    }

    /// The races' coordinates.
    pub fn races(&self) -> &Races {
        &self.statics.races
    }

    /// Masses of the races' coordinates, kg.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// Mean iterations of a step so far, and steps in which backside flanks took part.
    pub fn counts(&self) -> (f64, u64) {
        let steps = self.state().steps.max(1) as f64;
        (self.system.iterations as f64 / steps, self.system.with_rare)
    }
}

/// Side loads on the races' coordinates, by step of the cycle, N.
fn side_loads(races: &Races, law: &MeshLaw) -> Vec<Vec<f64>> {
    let planets = races.planets();
    let of_step = |step: usize| {
        let mut load = vec![0.0; races.count];
        for mesh in 0..law.meshes() {
            let (central, planet) =
                if mesh < planets { (Body::Sun, mesh) } else { (Body::Ring, mesh - planets) };
            let (sin, cos) = races.psi[planet].sin_cos();
            let [x, y, u, zeta, eta, spin] = law.side_load(mesh, step);
            // The mesh frame is turned by ψ_n from the carrier frame.
            let turned = [cos * x - sin * y, sin * x + cos * y, u];
            for (body, own) in [(central, turned), (Body::Planet(planet), [zeta, eta, spin])] {
                // The law's u is r θ with the base radius.
                let share = races.base_radii[body.kind()] / races.radii[body.kind()];
                races.add(body, [own[0], own[1], share * own[2]], &mut load);
            }
        }
        load
    };
    (0..law.steps()).map(of_step).collect()
}

/// The error with body and quantity in place of a coordinate's number.
#[cold]
fn failed(statics: &StaticSet<'_>, cause: dynamics::CoupledError) -> FeError {
    match cause {
        dynamics::CoupledError::Diverged { time_s, coordinate, value } => {
            statics.races.diverged(time_s, coordinate, value)
        }
        other => FeError::Coupled(other),
    }
}
