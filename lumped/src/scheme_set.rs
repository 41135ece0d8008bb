//! The lumped set in time by any scheme of [`dynamics::benchmark_subjects`]: the equations of
//! [`TimeVarying`](crate::TimeVarying), stepped by average acceleration there, without mesh damping.
//!
//! k̄ of [`SchemeSet`] is the mean tangent of each mesh over the cycle at rest, so that the forces on the right,
//! which each step is iterated for, stay small beside those on the left. The law has two steps for each step of the
//! scheme: Bathe's scheme balances forces in the middle, too.

use std::sync::Arc;

use dynamics::Coupling;
use dynamics::benchmark_subjects::{
    Instant, Integrator, Scheme, StepState, VibratingSystem, driven_step,
};
use gearset::{Facing, MeshLaw};
use nalgebra::{DMatrix, DVector};
use scene::Scene;

use crate::error::LumpedError;
use crate::time_varying::{Layout, Parts, TimeVarying};

/// Steps of the law for each step of the scheme.
pub const LAW_STEPS_A_STEP: usize = 2;

/// A lumped set stepped by a scheme, its mesh forces given by a mesh law.
///
/// `[eq:scheme-set]` M q̈ + C q̇ + (K_s + Σ k̄ b bᵀ) q = f − Σ b (P − k̄ δ), P = F(phase, δ), δ = bᵀ q.
/// Source: derived here.
/// Checked by: `lumped/tests/scheme_set.rs::average_acceleration_is_that_of_the_program`,
/// `lumped/tests/scheme_set.rs::every_scheme_converges_to_harmonic_balance_with_its_order`.
#[derive(Debug)]
pub struct SchemeSet {
    layout: Layout,
    integrator: Box<dyn Integrator>,
    meshes: Meshes,
    state: StepState,
    /// Forces beside those of the linear system at the state, n, N.
    force: DVector<f64>,
    /// Step of the law at which the state is.
    at: usize,
    steps: u64,
    solutions: u64,
}

/// What the meshes add to the linear system.
#[derive(Debug)]
struct Meshes {
    law: Arc<MeshLaw>,
    couplings: Vec<Coupling>,
    /// k̄ of each coupling, 0 of backside flanks, N/m.
    mean: Vec<f64>,
    /// By step of the law, N.
    side_loads: Vec<Vec<f64>>,
}

impl Meshes {
    /// Side loads − Σ b (P − k̄ δ) at a step of the law, n, N.
    fn force(&self, step: usize, x: &DVector<f64>) -> DVector<f64> {
        let step = step % self.law.steps();
        let mut force = match self.side_loads.get(step) {
            Some(load) => DVector::from_column_slice(load),
            None => DVector::zeros(x.len()),
        };
        for (k, (coupling, mean)) in self.couplings.iter().zip(&self.mean).enumerate() {
            let deflection = deflection(coupling, x);
            let rest = self.law.force(k, step, deflection).0 - mean * deflection;
            coupling.row.iter().zip(force.iter_mut()).for_each(|(b, f)| *f -= b * rest);
        }
        force
    }
}

/// bᵀ q − o, m.
fn deflection(coupling: &Coupling, x: &DVector<f64>) -> f64 {
    let along: f64 = coupling.row.iter().zip(x.iter()).map(|(b, x)| b * x).sum();
    along - coupling.offset
}

impl SchemeSet {
    /// A set at rest under a torque on the sun (N m, magnitude) of the given sense at step 0 of a mesh cycle; it makes
    /// one step for every two of the law.
    ///
    /// # Errors
    /// As [`TimeVarying::new`]; if the meshes are damped, the law has an odd number of steps, there is no equilibrium,
    /// or the scheme refuses the step.
    pub fn new(
        scene: &Scene,
        sense: Facing,
        law: Arc<MeshLaw>,
        mesh_frequency_hz: f64,
        torque_nm: f64,
        scheme: Scheme,
    ) -> Result<Self, LumpedError> {
        let damped = scene.damping.stiffness_proportional_s;
        if damped != 0.0 {
            return Err(LumpedError::MeshDamping(damped));
        }
        let count = law.steps();
        if !count.is_multiple_of(LAW_STEPS_A_STEP) {
            return Err(LumpedError::LawSteps(count));
        }
        let mut resting = TimeVarying::new(scene, sense, Arc::clone(&law), mesh_frequency_hz)?;
        resting.rest(torque_nm)?;
        let x = DVector::from_column_slice(&resting.motion().x);
        let Parts { layout, linear, front, backside, side_loads } = Parts::new(scene, sense, &law)?;
        let fronts = front.len();
        let couplings = [front, backside].concat();
        let tangent = |k: usize, coupling: &Coupling| {
            let at = deflection(coupling, &x);
            let sum: f64 = (0..count).map(|step| law.force(k, step, at).1).sum();
            if k < fronts { sum / count as f64 } else { 0.0 }
        };
        let mean: Vec<f64> = couplings.iter().enumerate().map(|(k, c)| tangent(k, c)).collect();
        let n = linear.mass.len();
        let mut stiffness = linear.stiffness.clone();
        for (coupling, k) in couplings.iter().zip(&mean) {
            let b = DVector::from_column_slice(&coupling.row);
            stiffness += &b * b.transpose() * *k;
        }
        let mass = DMatrix::from_diagonal(&DVector::from_column_slice(&linear.mass));
        let load = layout.by_torque.iter().map(|f| f * torque_nm).collect();
        let system = VibratingSystem::new(mass, linear.damping, stiffness, load)?;
        let h = LAW_STEPS_A_STEP as f64 / (mesh_frequency_hz * count as f64);
        let integrator = scheme.prepare(&system, h)?;
        let mut state = system.start(x.as_slice(), &vec![0.0; n])?;
        let meshes = Meshes { law, couplings, mean, side_loads };
        let force = meshes.force(0, &x);
        // M a = f − C v − K x and the forces beside.
        for ((a, f), m) in state.a.iter_mut().zip(force.iter()).zip(&linear.mass) {
            *a += f / m;
        }
        Ok(Self { layout, integrator, meshes, state, force, at: 0, steps: 0, solutions: 0 })
    }

    /// One step of the scheme.
    ///
    /// # Errors
    /// If the step and the mesh forces do not settle.
    pub fn step(&mut self) -> Result<(), LumpedError> {
        let (meshes, at) = (&self.meshes, self.at);
        let mut force = |instant: Instant, x: &DVector<f64>| {
            let ahead =
                if instant == Instant::Middle { LAW_STEPS_A_STEP / 2 } else { LAW_STEPS_A_STEP };
            meshes.force(at + ahead, x)
        };
        let integrator = self.integrator.as_ref();
        let solutions = driven_step(integrator, &mut self.state, &mut self.force, &mut force)?;
        self.at = (self.at + LAW_STEPS_A_STEP) % self.meshes.law.steps();
        self.steps += 1;
        self.solutions += solutions as u64;
        Ok(())
    }

    /// Displacements of carrier, ring, sun and of the planets, as [`TimeVarying::displacements`].
    pub fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.layout.by_body(|i| self.state.x[i])
    }

    /// Force of each mesh, as [`TimeVarying::mesh_forces`], N.
    pub fn mesh_forces(&self, out: &mut Vec<f64>) {
        out.clear();
        let each = self.meshes.couplings.iter().enumerate();
        let force = |(k, c)| self.meshes.law.force(k, self.at, deflection(c, &self.state.x)).0;
        out.extend(each.map(force));
    }

    /// Number of coordinates, and mean number of solutions a step.
    pub fn effort(&self) -> (usize, f64) {
        (self.state.x.len(), self.solutions as f64 / (self.steps.max(1)) as f64)
    }

    /// Displacements, velocities, accelerations and forces: what the next step continues from, after a whole number of
    /// mesh cycles.
    pub fn continuous(&self) -> Vec<f64> {
        let StepState { x, v, a, .. } = &self.state;
        [x, v, a, &self.force].into_iter().flat_map(|list| list.iter().copied()).collect()
    }

    /// Continues from such numbers at the start of a mesh cycle.
    ///
    /// # Errors
    /// If they are not as many.
    pub fn set_continuous(&mut self, values: &[f64]) -> Result<(), LumpedError> {
        let n = self.state.x.len();
        if values.len() != 4 * n {
            return Err(LumpedError::State { got: values.len(), wanted: 4 * n });
        }
        let part = |k: usize| DVector::from_column_slice(&values[k * n..(k + 1) * n]);
        let state = &mut self.state;
        (state.x, state.v, state.a) = (part(0), part(1), part(2));
        (self.force, self.at) = (part(3), 0);
        Ok(())
    }
}
