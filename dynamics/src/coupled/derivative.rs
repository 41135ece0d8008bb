//! The derivative of the steps of a coupled system with respect to displacements and velocities of its modes at
//! the start of a period.

use nalgebra::{DMatrix, DVector};

use super::condensed::Condensed;
use super::coupling::CouplingForce;
use super::error::CoupledError;
use super::gradients::{Gradients, StepGradient};
use super::system::Coupled;
use crate::newmark::Motion;
use crate::number::Number;
use crate::periodic::{CarriedChange, MapDerivative};

/// Gradients of displacements, velocities and accelerations of the modes with respect to the 2n coordinates
/// (displacements, velocities) at the start of a period.
#[derive(Debug, Clone)]
pub struct CoupledDerivative<T = f64>(Gradients<T>);

/// States that a system passed through, from which the derivative between the first and the last follows.
#[derive(Debug, Clone, Default)]
pub struct PassedSteps {
    /// Displacements, then velocities of the modes, one state after another.
    states: Vec<f64>,
    /// Step in the cycle of each, and whether rare couplings took part in the step that led to it.
    steps: Vec<(usize, bool)>,
}

impl PassedSteps {
    /// Whether the last state is at another step of the cycle than the first: only a part of a cycle was passed.
    pub fn ends_within_cycle(&self) -> bool {
        self.steps.first().map(|(step, _)| step) != self.steps.last().map(|(step, _)| step)
    }

    /// Forgets all states.
    pub fn clear(&mut self) {
        self.states.clear();
        self.steps.clear();
    }
}

/// One state that a system passed through.
#[derive(Clone, Copy)]
struct Passed<'p> {
    x: &'p [f64],
    v: &'p [f64],
    step: usize,
    is_rare: bool,
}

impl<L: CouplingForce> Coupled<L> {
    /// Adds the present state.
    pub fn keep_step(&self, passed: &mut PassedSteps) {
        let n = self.modes.count;
        let Motion { x, v, .. } = &self.state.modal;
        passed.states.extend_from_slice(&x[..n]);
        passed.states.extend_from_slice(&v[..n]);
        passed.steps.push((self.state.step_in_cycle, self.took_rare));
    }

    /// The derivative of the last of the states passed with respect to the first, between which every step was
    /// kept, computed in the precision of T; frequencies are of the order of `rate` (rad/s). `None` without a state.
    pub fn derivative_of<T: Number>(
        &self,
        passed: &PassedSteps,
        rate: f64,
    ) -> Option<MapDerivative> {
        let mut derivative = self.start_at::<T>(self.passed(passed, 0)?, None);
        let mut tangents = Vec::new();
        for k in 1..passed.steps.len() {
            self.carry_to(&mut derivative, self.passed(passed, k)?, &mut tangents);
        }
        Some(self.map_derivative(&derivative, rate))
    }

    /// The same in double precision, with a change of the 2n coordinates at the start carried along. `None` also for a
    /// change of another size.
    pub fn derivative_with(
        &self,
        passed: &PassedSteps,
        rate: f64,
        change: CarriedChange<'_>,
    ) -> Option<MapDerivative> {
        let n = self.modes.count;
        let CarriedChange { start, hear } = change;
        if start.len() != 2 * n {
            return None;
        }
        let mut derivative = self.start_at::<f64>(self.passed(passed, 0)?, Some(start));
        let (mut tangents, mut x) = (Vec::new(), vec![0.0; n]);
        for k in 1..passed.steps.len() {
            derivative.0.write_displacements(2 * n, &mut x);
            hear(&x);
            self.carry_to(&mut derivative, self.passed(passed, k)?, &mut tangents);
        }
        Some(self.map_derivative(&derivative, rate))
    }

    /// One of the states that were passed.
    fn passed<'p>(&self, passed: &'p PassedSteps, k: usize) -> Option<Passed<'p>> {
        let n = self.modes.count;
        let (step, is_rare) = *passed.steps.get(k)?;
        let (x, v) = passed.states.get(2 * n * k..2 * n * (k + 1))?.split_at(n);
        Some(Passed { x, v, step, is_rare })
    }

    fn present(&self) -> Passed<'_> {
        let n = self.modes.count;
        let Motion { x, v, .. } = &self.state.modal;
        let (step, is_rare) = (self.state.step_in_cycle, self.took_rare);
        Passed { x: &x[..n], v: &v[..n], step, is_rare }
    }

    /// Displacements and velocities of the modes, 2n: they determine the motion that follows.
    pub fn coordinates(&self) -> Vec<f64> {
        let n = self.modes.count;
        [&self.state.modal.x[..n], &self.state.modal.v[..n]].concat()
    }

    /// Continues from displacements and velocities of the modes at the start of a cycle; accelerations follow from the
    /// balance of forces.
    ///
    /// # Errors
    /// If there are not 2n finite numbers.
    pub fn set_coordinates(&mut self, y: &[f64]) -> Result<(), CoupledError> {
        let n = self.modes.count;
        if y.len() != 2 * n {
            return Err(CoupledError::Size { what: "the state", got: y.len(), wanted: 2 * n });
        }
        if let Some(value) = y.iter().copied().find(|value| !value.is_finite()) {
            let (time_s, coordinate) = (self.time(), 0);
            return Err(CoupledError::Diverged { time_s, coordinate, value });
        }
        self.state.step_in_cycle = 0;
        self.state.modal.x[..n].copy_from_slice(&y[..n]);
        self.state.modal.v[..n].copy_from_slice(&y[n..]);
        self.balance();
        Ok(())
    }

    /// Coordinates of the system that the displacements in `y` (2n, as [`Coupled::coordinates`]) amount to, n, m.
    pub fn displacements_of(&self, y: &[f64]) -> Vec<f64> {
        (0..self.modes.count).map(|i| self.modes.coordinate(i, y)).collect()
    }

    /// The derivative at the start of a period: one in the coordinates themselves.
    pub fn start_derivative(&self) -> CoupledDerivative {
        self.start_at(self.present(), None)
    }

    /// The derivative at a state, and a change of the coordinates there as one row more.
    fn start_at<T: Number>(&self, at: Passed<'_>, change: Option<&[f64]>) -> CoupledDerivative<T> {
        let n = self.modes.count;
        let gradient = |first: usize| {
            DMatrix::from_fn(2 * n + usize::from(change.is_some()), n, |row, j| match change {
                Some(change) if row == 2 * n => change[first + j],
                _ => f64::from(u8::from(row == first + j)),
            })
        };
        let (x, v) = (gradient(0), gradient(n));
        let all = self.all();
        // a' = −Λ x' − C v' − Rᵀ D (R x' + τ R v')
        let mut a = -self.damped(&v);
        for (j, lambda) in self.modes.lambda.iter().enumerate().take(n) {
            a.column_mut(j).axpy(-lambda, &x.column(j), 1.0);
        }
        let mut tangents = Vec::new();
        self.tangents(all, at, &mut tangents);
        for (k, tangent) in tangents.into_iter().enumerate() {
            if tangent != 0.0 {
                let z = all.along(k, &x) + all.along(k, &v) * all.lags[k];
                for j in 0..n {
                    a.column_mut(j).axpy(-tangent * all.rows[j * all.width + k], &z, 1.0);
                }
            }
        }
        CoupledDerivative(Gradients::new([&x, &v, &a], &self.modes, &self.rule))
    }

    /// Carries the derivative over the last step.
    pub fn carry_derivative(&self, d: &mut CoupledDerivative) {
        self.carry_to(d, self.present(), &mut Vec::new());
    }

    /// `[eq:coupled-step-derivative]` With the tangents D of the couplings that act in the step, at the displacements
    /// found for its end:
    /// ```text
    /// x₁' = A⁻¹ (a*' + C v*') − A⁻¹ Rᵀ D z',   (I + g Y D) z' = g R A⁻¹ (a*' + C v*') − τ R v*',   g = 1 + 2τ/h.
    /// ```
    ///
    /// Source: derived here.
    /// Checked by: `dynamics/tests/periodic.rs::the_derivative_is_that_of_the_map`,
    /// `dynamics/tests/periodic.rs::multipliers_of_a_linear_system_are_those_of_the_rule`.
    fn carry_to<T: Number>(
        &self,
        d: &mut CoupledDerivative<T>,
        at: Passed<'_>,
        tangents: &mut Vec<f64>,
    ) {
        let group = if at.is_rare { self.all() } else { &self.usual };
        self.tangents(group, at, tangents);
        d.0.carry(&StepGradient {
            modes: &self.modes,
            rule: &self.rule,
            group,
            is_rare: at.is_rare,
            tangents,
        });
    }

    /// The derivative of the map from the start to now; frequencies are of the order of `rate` (rad/s).
    pub fn map_derivative<T: Number>(&self, d: &CoupledDerivative<T>, rate: f64) -> MapDerivative {
        let n = self.modes.count;
        MapDerivative {
            active: (0..2 * n).collect(),
            columns: d.0.end_by_start(),
            scales: (0..2 * n).map(|i| if i < n { 1.0 } else { rate }).collect(),
        }
    }

    /// (C v)' by columns.
    fn damped(&self, v: &DMatrix<f64>) -> DMatrix<f64> {
        let n = self.modes.count;
        match &self.modes.own_damping {
            Some(own) => {
                let mut out = v.clone();
                for (j, c) in own.iter().enumerate().take(n) {
                    out.column_mut(j).scale_mut(*c);
                }
                out
            }
            None => v * DMatrix::from_fn(n, n, |i, j| self.modes.damping[(j, i)]),
        }
    }

    /// Writes the tangents of a group's couplings at a state, N/m.
    fn tangents(&self, group: &Condensed, at: Passed<'_>, reach: &mut Vec<f64>) {
        reach.clear();
        reach.resize(group.count, 0.0);
        group.deflections(at.x, reach);
        for (k, reach) in reach.iter_mut().enumerate().filter(|(k, _)| group.lags[*k] != 0.0) {
            let own = at.v.iter().enumerate().map(|(j, v)| group.rows[j * group.width + k] * v);
            *reach += group.lags[k] * own.sum::<f64>();
        }
        for (k, z) in reach.iter_mut().enumerate() {
            *z = self.law.answer(k, at.step, *z).1;
        }
    }
}

impl Condensed {
    /// Gradient of R x of one coupling, for gradients of the modes by columns.
    fn along(&self, coupling: usize, x: &DMatrix<f64>) -> DVector<f64> {
        let mut out = DVector::zeros(x.nrows());
        for (j, column) in x.column_iter().enumerate() {
            out.axpy(self.rows[j * self.width + coupling], &column, 1.0);
        }
        out
    }
}
