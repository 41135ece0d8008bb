//! A rigid race with n modes of the elastic body; with n = 0 the quasi-static body.

use dynamics::{AverageAcceleration, Motion};

use super::body::{Port, RaceMotion, VibratingBody, into_frame, out_of_frame};
use super::damping::Proportional;
use super::fixed_race_mode::FixedRaceMode;

/// A rigid race and n modes of the body with its race held.
///
/// `[eq:modal-body]` Equations of race and modes:
/// ```text
/// M_rr (q̈ + α q̇) + Σ_j Γ_j (η̈_j + α η̇_j) = race loads,
/// Γ_jᵀ (q̈ + α q̇) + η̈_j + (α + β ω_j²) η̇_j + ω_j² η_j = −Σ_a (ℓ_a φ_j) P_a
/// ```
/// Source: derived here; no publication cited.
/// Checked by: `fe_contact/tests/vibration.rs::modes_and_full_bodies_answer_alike`, `fe.fidelity`, `truth.height`.
#[derive(Debug, Clone)]
pub struct ModalBody {
    /// Mass, mass, polar inertia over r², kg.
    mass: [f64; 3],
    pub(super) damping: Proportional,
    pub(super) modes: std::sync::Arc<[FixedRaceMode]>,
    rule: AverageAcceleration,
    /// 4/h² + (α + βω²) 2/h + ω² of each mode, 1/s².
    pub(super) dynamic: Vec<f64>,
    state: Motion,
    /// η at the end of the step with the race at its origin and no loads.
    free: Vec<f64>,
    next: Vec<f64>,
}

impl ModalBody {
    /// A body at rest; `mass` is mass, mass and polar inertia over r² (kg).
    pub fn new(
        mass: [f64; 3],
        damping: Proportional,
        modes: std::sync::Arc<[FixedRaceMode]>,
        rule: AverageAcceleration,
    ) -> Self {
        let n = modes.len();
        let Proportional { alpha, beta } = damping;
        let of = |m: &FixedRaceMode| {
            rule.inertia() + (alpha + beta * m.lambda) * rule.damping() + m.lambda
        };
        Self {
            mass,
            damping,
            dynamic: modes.iter().map(of).collect(),
            modes,
            rule,
            state: Motion::at_rest(n),
            free: vec![0.0; n],
            next: vec![0.0; n],
        }
    }

    /// 4/h² + 2α/h.
    pub(super) fn inertia(&self) -> f64 {
        self.rule.inertia() + self.damping.alpha * self.rule.damping()
    }
}

impl VibratingBody for ModalBody {
    fn race_stiffness(&self) -> [[f64; 3]; 3] {
        let c = self.inertia();
        let mut a = [[0.0; 3]; 3];
        for (i, row) in a.iter_mut().enumerate() {
            row[i] = c * self.mass[i];
            // − c² Σ Γ Γᵀ / s
            for (mode, s) in self.modes.iter().zip(&self.dynamic) {
                for (k, entry) in row.iter_mut().enumerate() {
                    *entry -= c * c * mode.participation[i] * mode.participation[k] / s;
                }
            }
        }
        a
    }

    fn predict(&mut self, race: &RaceMotion, angle: f64) -> [f64; 3] {
        let Proportional { alpha, beta } = self.damping;
        let history = self.damping.race_history(&self.rule, race);
        if self.modes.is_empty() {
            return [0, 1, 2].map(|i| self.mass[i] * history[i]);
        }
        let turned = into_frame(history, angle);
        let c = self.inertia();
        let mut load = [0.0; 3];
        for (j, mode) in self.modes.iter().enumerate() {
            let (x, v, a) = (self.state.x[j], self.state.v[j], self.state.a[j]);
            let (a, v) =
                (self.rule.acceleration_history(x, v, a), self.rule.velocity_history(x, v));
            let gamma = mode.participation;
            let pushed: f64 = gamma.iter().zip(turned).map(|(g, t)| g * t).sum();
            self.free[j] = (a + (alpha + beta * mode.lambda) * v + pushed) / self.dynamic[j];
            let pull = a + alpha * v - c * self.free[j];
            load.iter_mut().zip(gamma).for_each(|(l, g)| *l += g * pull);
        }
        let load = out_of_frame(load, angle);
        [0, 1, 2].map(|i| self.mass[i] * history[i] + load[i])
    }

    fn free(&self, port: &Port) -> f64 {
        self.modes.iter().zip(&self.free).map(|(m, eta)| port.read(&m.shape) * eta).sum()
    }

    fn coupling(&self, port: &Port, angle: f64) -> [f64; 3] {
        let c = self.inertia();
        let mut sum = [0.0; 3];
        for (mode, s) in self.modes.iter().zip(&self.dynamic) {
            let along = c * port.read(&mode.shape) / s;
            sum.iter_mut().zip(mode.participation).for_each(|(x, g)| *x -= g * along);
        }
        out_of_frame(sum, angle)
    }

    fn receptance(&self, ports: &[Port]) -> Vec<f64> {
        self.weighted(ports, |_, s| 1.0 / s)
    }

    fn carried_flexibility(&self, ports: &[Port]) -> Vec<f64> {
        self.weighted(ports, |mode, _| 1.0 / mode.lambda)
    }

    fn finish(&mut self, race: [f64; 3], angle: f64, ports: &[Port], forces: &[f64]) {
        if self.modes.is_empty() {
            return;
        }
        let turned = into_frame(race, angle);
        let c = self.inertia();
        for (j, mode) in self.modes.iter().enumerate() {
            let pulled: f64 = mode.participation.iter().zip(turned).map(|(g, q)| c * g * q).sum();
            let pressed: f64 =
                ports.iter().zip(forces).map(|(port, p)| port.read(&mode.shape) * p).sum();
            self.next[j] = self.free[j] - (pulled + pressed) / self.dynamic[j];
        }
        self.state.advance(&self.rule, &self.next);
    }

    fn rest_under(&mut self, ports: &[Port], forces: &[f64]) {
        self.state = Motion::at_rest(self.modes.len());
        for (x, mode) in self.state.x.iter_mut().zip(self.modes.iter()) {
            *x = -ports.iter().zip(forces).map(|(port, p)| port.read(&mode.shape) * p).sum::<f64>()
                / mode.lambda;
        }
    }

    fn elastic_mut(&mut self) -> &mut Motion {
        &mut self.state
    }

    fn modes(&self) -> Option<&[FixedRaceMode]> {
        Some(&self.modes)
    }

    fn unknowns(&self) -> usize {
        self.modes.len()
    }

    fn modal(&self) -> Option<&ModalBody> {
        Some(self)
    }
}

impl ModalBody {
    /// Σ_j (ℓ_a φ_j)(ℓ_b φ_j) w_j.
    fn weighted(&self, ports: &[Port], weight: impl Fn(&FixedRaceMode, f64) -> f64) -> Vec<f64> {
        let n = ports.len();
        let mut matrix = vec![0.0; n * n];
        let mut along = vec![0.0; n];
        for (mode, s) in self.modes.iter().zip(&self.dynamic) {
            along.iter_mut().zip(ports).for_each(|(x, port)| *x = port.read(&mode.shape));
            let w = weight(mode, *s);
            for i in 0..n {
                for j in 0..n {
                    matrix[i * n + j] += w * along[i] * along[j];
                }
            }
        }
        matrix
    }
}
