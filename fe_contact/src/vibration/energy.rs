//! Energies of a set with quasi-static bodies, and the work done in a step.

use nalgebra::DVector;

use super::set::VibratingSet;
use crate::complementarity::ActiveSet;
use crate::contact::Held;
use crate::error::FeError;
use crate::statics::larger;

/// Energies of the present state, J.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Energies {
    /// Kinetic energy of the vibration.
    pub kinetic: f64,
    /// Bearings and supports, the carrier's flexibility among them, and the turning of the meshes' forces.
    pub bearings: f64,
    /// ½ pᵀ C p of all meshes, FE flexibility and half-planes, without the lag; the change of the
    /// compliance as pairs move is included to first order.
    pub contact: f64,
}

/// Work and dissipation of one step, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StepWork {
    /// Work of the external forces, their mean over the step times the displacement.
    pub external: f64,
    /// Energy dissipated by αM and the dashpots.
    pub damped: f64,
    /// Work of the races against the pairs' forces, their mean over the step.
    pub against_contact: f64,
}

/// What the kinematic rest of a step is computed from.
#[derive(Debug, Clone)]
pub struct LoadedStep {
    step_in_cycle: usize,
    /// Displacements of the races, m.
    x: DVector<f64>,
    /// Forces of the tooth pairs, N.
    forces: Vec<f64>,
}

/// State of the races at the start of a step.
#[derive(Debug, Clone)]
pub struct StepStart {
    x: DVector<f64>,
    v: DVector<f64>,
    external: DVector<f64>,
    pressed: DVector<f64>,
}

impl VibratingSet<'_> {
    /// The step that ended last.
    pub fn loaded_step(&self) -> LoadedStep {
        LoadedStep {
            step_in_cycle: self.clock.step_in_cycle,
            x: DVector::from_column_slice(&self.motion().x),
            forces: self.pairs.forces.as_slice().to_vec(),
        }
    }

    /// Kinematic rest of a step: largest difference of a loaded pair's approach, by exact kinematics at the
    /// displacements, from its linear form about the reference, m; 0 where kinematics are exact at every step. The set
    /// must not have passed the step's position in the cycle since.
    pub fn kinematic_rest(&self, at: &LoadedStep) -> f64 {
        let (Some(frame), None) = (self.frames.current(at.step_in_cycle), &self.contact.grid)
        else {
            return 0.0;
        };
        let position = self.clock.position(at.step_in_cycle);
        let fronts = frame.meshes.iter().take(self.pairs.memory.len());
        let linear = frame.pattern.linear(|| {
            let each = fronts.clone().enumerate().map(|(which, mesh)| {
                let table = &self.contact.tables.list[mesh.table];
                self.statics.linear_mesh(which, table, position)
            });
            each.collect()
        });
        let Ok(linear) = linear else { return f64::NAN };
        larger(fronts.zip(linear).map(|(mesh, linear)| {
            let forces = at.forces.get(mesh.first..mesh.first + mesh.count);
            forces.map_or(f64::NAN, |forces| self.statics.rest_of_mesh(linear, &at.x, forces))
        }))
    }

    /// Energies at fidelity `quasi_static`; those of elastic states at other fidelities are not
    /// included.
    pub fn energies(&self) -> Energies {
        let m = self.motion();
        let x = DVector::from_column_slice(&m.x);
        let kinetic = self.race_dynamics.kinetic_energy();
        let supports: f64 =
            x.iter().zip(self.race_dynamics.supports.iter()).map(|(x, k)| 0.5 * k * x * x).sum();
        let reference = self.statics.reference();
        let moved = &x - &reference.q;
        let turning = 0.5 * moved.dot(&(&reference.stiffness * &moved));
        Energies {
            kinetic,
            bearings: supports + self.race_dynamics.bearings.energy() + turning,
            contact: self.contact_energy(),
        }
    }

    /// ½ pᵀ C p of the present forces, J; NaN if a map was replaced since the step.
    fn contact_energy(&self) -> f64 {
        let Some(frame) = self.frames.current(self.clock.step_in_cycle) else { return 0.0 };
        let of = |mesh: &super::frame::FrameMesh| {
            let delta = &self.pairs.approaches.as_slice()[mesh.first..mesh.first + mesh.count];
            mesh.map(&self.contact.maps).map_or(f64::NAN, |map| map.energy(delta))
        };
        let energy: f64 = frame.meshes.iter().map(of).sum();
        let moved = DVector::from_column_slice(&self.motion().x) - &self.statics.reference().q;
        let left = self.contact.leaning[self.clock.step_in_cycle].rest_of(&self.statics);
        energy - left.dot(&moved)
    }

    /// Generalised forces of the meshes on the races, positive if to be subtracted in their
    /// equations, n, N.
    fn pressed(&self) -> DVector<f64> {
        match self.frames.current(self.clock.step_in_cycle) {
            Some(frame) => {
                let pairs =
                    frame.pattern.rigid.tr_mul(&self.pairs.forces.rows(0, frame.offsets.len()));
                pairs
                    - self.contact.leaning[self.clock.step_in_cycle].rest_of(&self.statics)
                    - &self.pairs.bent
            }
            None => DVector::zeros(self.race_dynamics.mass.len()),
        }
    }

    /// State to be stored before a step, for [`VibratingSet::work_since`] after it.
    pub fn step_start(&self) -> StepStart {
        let m = self.motion();
        let x = DVector::from_column_slice(&m.x);
        let pressed = self.pressed();
        StepStart {
            v: DVector::from_column_slice(&m.v),
            external: self.external.clone(),
            pressed,
            x,
        }
    }

    /// Work and dissipation of the step since `start`.
    ///
    /// `[eq:energy-of-a-step]` T₁ − T₀ + V₁ − V₀ = `external` − `damped` − `against_contact` to rounding for the
    /// average-acceleration method, V the bearings' energy.
    /// Source: derived here.
    /// Checked by: `fe.stepping.energy`, `fe_contact/tests/vibration.rs::the_discrete_energy_identity_holds`.
    pub fn work_since(&self, start: &StepStart) -> StepWork {
        let m = self.motion();
        let x = DVector::from_column_slice(&m.x);
        let pressed = self.pressed();
        let moved = &x - &start.x;
        let damped = self.race_dynamics.damped_since(&self.clock.rule, &moved, &start.v);
        StepWork {
            external: 0.5 * (&self.external + &start.external).dot(&moved),
            damped,
            against_contact: 0.5 * (pressed + &start.pressed).dot(&moved),
        }
    }

    /// Contact energy Ψ without lag at the frame of one step in the cycle, with the races at x (m),
    /// J; `None` if that frame was never visited.
    fn potential(
        &mut self,
        step_in_cycle: usize,
        x: &DVector<f64>,
    ) -> Result<Option<f64>, FeError> {
        let Some(frame) = self.frames.at(step_in_cycle) else { return Ok(None) };
        let approaches = &frame.pattern.rigid * x - frame.opened_at(x.as_slice());
        let meshes: Vec<_> = frame.meshes.iter().map(|m| (m.table, m.first, m.count)).collect();
        let mut held: Vec<Held> = frame.meshes.iter().map(|m| m.held).collect();
        let mut energy = 0.0;
        for ((table, first, count), held) in meshes.into_iter().zip(&mut held) {
            let (delta, maps) =
                (&approaches.as_slice()[first..first + count], &mut self.contact.maps[table]);
            maps.find(&self.contact.tables.list[table], delta, held, &ActiveSet)?;
            energy += maps.held(held).map_or(f64::NAN, |map| map.energy(delta));
        }
        // The load that the slopes leave does not depend on the displacements.
        let left = self.contact.leaning[step_in_cycle].rest_of(&self.statics);
        Ok(Some(energy - left.dot(&(x - &self.statics.reference().q))))
    }

    /// Change of the contact energy by the nominal rotation over the step since `start`, J, by the
    /// trapezoidal rule from the displacements at both ends. It is to be called after every step,
    /// holds without lag (β = 0) only, and is `None` unless the set has visited the positions at
    /// both ends before.
    ///
    /// # Errors
    /// If a contact problem fails.
    pub fn turning_work(&mut self, start: &StepStart) -> Result<Option<f64>, FeError> {
        let now = self.clock.step_in_cycle;
        let before = self.clock.before(now);
        let x = DVector::from_column_slice(&self.motion().x);
        let mut sum = 0.0;
        for x in [&start.x, &x] {
            match (self.potential(now, x)?, self.potential(before, x)?) {
                (Some(after), Some(earlier)) => sum += 0.5 * (after - earlier),
                _ => return Ok(None),
            }
        }
        Ok(Some(sum))
    }
}
