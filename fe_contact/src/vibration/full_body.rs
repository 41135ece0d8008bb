//! A body with every finite-element degree of freedom.

use std::sync::Arc;

use dynamics::{AverageAcceleration, Motion};
use rayon::prelude::*;

use super::body::{Port, RaceMotion, VibratingBody, into_frame, out_of_frame};
use super::damping::Proportional;
use super::fixed_race_mode::FixedRaceMode;
use crate::body::{BodyMatrices, Factor};
use crate::error::FeError;

/// Factors that all bodies of one kind share.
///
/// `[eq:full-body-step]` A u = …, A = (4/h² + 2α/h) M + (1 + 2β/h) K.
/// Source: derived here from Newmark's method.
/// Checked by: `fe_contact/tests/fidelity.rs::full_bodies_turn_as_quasi_static_ones`.
#[derive(Debug, Clone)]
pub struct SharedFactors {
    matrices: Arc<BodyMatrices>,
    /// K.
    stiff: Arc<Factor>,
    /// A.
    dynamic: Arc<Factor>,
    /// (4/h² + 2α/h) · dynamic⁻¹ M_fr, by columns.
    carried: Arc<[Vec<f64>; 3]>,
    rule: AverageAcceleration,
    damping: Proportional,
    /// r in u = rθ.
    radius: f64,
}

impl SharedFactors {
    /// Factorises a body for steps of a given length.
    ///
    /// # Errors
    /// If a matrix is not positive definite.
    pub fn new(
        matrices: Arc<BodyMatrices>,
        name: &'static str,
        radius: f64,
        damping: Proportional,
        rule: AverageAcceleration,
    ) -> Result<Self, FeError> {
        let stiff = Arc::new(matrices.stiffness.factorise(name)?);
        let inertia = rule.inertia() + damping.alpha * rule.damping();
        let stiffening = 1.0 + damping.beta * rule.damping();
        let sum = matrices.mass.combined(inertia, &matrices.stiffness, stiffening)?;
        let dynamic = Arc::new(sum.factorise(name)?);
        let carried = [0, 1, 2].map(|k| {
            let scale = inertia / if k == 2 { radius } else { 1.0 };
            let mut column: Vec<f64> = matrices.coupling[k].iter().map(|m| scale * m).collect();
            dynamic.solve_one(&mut column);
            column
        });
        Ok(Self { matrices, stiff, dynamic, carried: Arc::new(carried), rule, damping, radius })
    }

    /// 4/h² + 2α/h.
    fn inertia(&self) -> f64 {
        self.rule.inertia() + self.damping.alpha * self.rule.damping()
    }

    /// M_rf u on x, y, u.
    fn race_part(&self, u: &[f64]) -> [f64; 3] {
        let along = |k: usize| self.matrices.coupling[k].iter().zip(u).map(|(m, u)| m * u).sum();
        let [x, y, moment]: [f64; 3] = [along(0), along(1), along(2)];
        [x, y, moment / self.radius]
    }
}

/// A body whose elastic displacement u is stepped in full:
///
/// `[eq:full-body]` Every degree of freedom of the body:
/// ```text
/// M_ff ü + (αM_ff + βK) u̇ + K u + M_fr (q̈ + α q̇) = −Σ_a ℓ_aᵀ P_a
/// ```
/// Source: definition.
/// Checked by: `fe_contact/tests/vibration.rs::modes_and_full_bodies_answer_alike`,
/// `fe_contact/tests/vibration.rs::equilibrium_is_that_of_full_bodies_with_any_number_of_modes`.
#[derive(Debug, Clone)]
pub struct FullBody {
    shared: SharedFactors,
    /// Mass, mass, polar inertia over r², kg.
    mass: [f64; 3],
    state: Motion,
    free: Vec<f64>,
    work: Vec<f64>,
    other: Vec<f64>,
}

impl FullBody {
    /// A body at rest; `mass` is mass, mass and polar inertia over r² (kg).
    pub fn new(mass: [f64; 3], shared: SharedFactors) -> Self {
        let n = shared.matrices.size;
        Self {
            shared,
            mass,
            state: Motion::at_rest(n),
            free: vec![0.0; n],
            work: vec![0.0; n],
            other: vec![0.0; n],
        }
    }

    /// ℓ_a A⁻¹ ℓ_bᵀ.
    fn between(&self, factor: &Factor, ports: &[Port]) -> Vec<f64> {
        let n = ports.len();
        let column = |port: &Port| -> Vec<f64> {
            let mut column = vec![0.0; self.shared.matrices.size];
            port.add_to(1.0, &mut column);
            factor.solve_one(&mut column);
            ports.iter().map(|port| port.read(&column)).collect()
        };
        // One solution of the system per port, in parallel.
        let columns: Vec<Vec<f64>> = ports.par_iter().map(column).collect();
        (0..n * n).map(|at| columns[at % n][at / n]).collect()
    }
}

impl VibratingBody for FullBody {
    fn race_stiffness(&self) -> [[f64; 3]; 3] {
        let c = self.shared.inertia();
        let mut a = [[0.0; 3]; 3];
        let parts = self.shared.carried.each_ref().map(|column| self.shared.race_part(column));
        for (i, row) in a.iter_mut().enumerate() {
            row[i] = c * self.mass[i];
            row.iter_mut().zip(&parts).for_each(|(a, part)| *a -= c * part[i]);
        }
        a
    }

    fn predict(&mut self, race: &RaceMotion, angle: f64) -> [f64; 3] {
        let s = &self.shared;
        let history = s.damping.race_history(&s.rule, race);
        let turned = into_frame(history, angle);
        // M (a* + α v*) + β K v* + M_fr (a* + α v*)_race
        for (i, w) in self.work.iter_mut().enumerate() {
            let (x, v, a) = (self.state.x[i], self.state.v[i], self.state.a[i]);
            let velocity = s.rule.velocity_history(x, v);
            *w = s.rule.acceleration_history(x, v, a) + s.damping.alpha * velocity;
            self.other[i] = velocity;
        }
        self.free.fill(0.0);
        s.matrices.mass.multiply_add(1.0, &self.work, &mut self.free);
        s.matrices.stiffness.multiply_add(s.damping.beta, &self.other, &mut self.free);
        for (k, t) in turned.iter().enumerate() {
            let t = if k == 2 { t / s.radius } else { *t };
            self.free.iter_mut().zip(&s.matrices.coupling[k]).for_each(|(f, m)| *f += t * m);
        }
        s.dynamic.solve_one(&mut self.free);
        // M_rf (a* + α v* − (4/h² + 2α/h) û)
        let c = s.inertia();
        self.work.iter_mut().zip(&self.free).for_each(|(w, u)| *w -= c * u);
        let load = out_of_frame(s.race_part(&self.work), angle);
        [0, 1, 2].map(|i| self.mass[i] * history[i] + load[i])
    }

    fn free(&self, port: &Port) -> f64 {
        port.read(&self.free)
    }

    fn coupling(&self, port: &Port, angle: f64) -> [f64; 3] {
        out_of_frame([0, 1, 2].map(|k| -port.read(&self.shared.carried[k])), angle)
    }

    fn receptance(&self, ports: &[Port]) -> Vec<f64> {
        self.between(&self.shared.dynamic, ports)
    }

    fn carried_flexibility(&self, ports: &[Port]) -> Vec<f64> {
        self.between(&self.shared.stiff, ports)
    }

    fn finish(&mut self, race: [f64; 3], angle: f64, ports: &[Port], forces: &[f64]) {
        let turned = into_frame(race, angle);
        self.work.fill(0.0);
        ports.iter().zip(forces).for_each(|(port, p)| port.add_to(*p, &mut self.work));
        self.shared.dynamic.solve_one(&mut self.work);
        let carried = &self.shared.carried;
        for (i, w) in self.work.iter_mut().enumerate() {
            let pulled: f64 = (0..3).map(|k| carried[k][i] * turned[k]).sum();
            *w = self.free[i] - pulled - *w;
        }
        self.state.advance(&self.shared.rule, &self.work);
    }

    fn rest_under(&mut self, ports: &[Port], forces: &[f64]) {
        let n = self.shared.matrices.size;
        self.state = Motion::at_rest(n);
        ports.iter().zip(forces).for_each(|(port, p)| port.add_to(-p, &mut self.state.x));
        self.shared.stiff.solve_one(&mut self.state.x);
    }

    fn elastic_mut(&mut self) -> &mut Motion {
        &mut self.state
    }

    fn modes(&self) -> Option<&[FixedRaceMode]> {
        None
    }

    fn unknowns(&self) -> usize {
        self.shared.matrices.size
    }
}
