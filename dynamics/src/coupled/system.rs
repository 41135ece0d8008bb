//! A coupled system in time.

use super::condensed::{Condensed, WIDTHS, at_width};
use super::coupling::{Coupling, CouplingForce};
use super::error::CoupledError;
use super::linear::{LANES, LinearPart, Modes};
use super::newton::{self, Left, Start};
use crate::newmark::{AverageAcceleration, Motion};

/// Displacements above this (m) count as divergence, unless a system has a bound of its own.
const USUAL_BOUND: f64 = 1e-2;

/// Deflections below this part of the bound are rounding.
const ROUNDING: f64 = 1e-11;

/// A linear system with couplings, stepped by Newmark's average acceleration.
///
/// `[eq:coupled-system]` M ẍ + C ẋ + K x + Σ_m r_m P_m = f, δ_m = r_mᵀ x − o_m, P_m = F_m(step, δ_m + τ_m δ̇_m).
/// Source: derived here.
/// Checked by: `dynamics/tests/coupled.rs::the_linear_limit_is_the_closed_form_at_second_order`,
/// `dynamics/tests/coupled.rs::a_bouncing_mass_follows_the_piecewise_solution`,
/// `dynamics/tests/coupled.rs::energy_is_kept_to_second_order_and_a_lag_takes_it`.
///
/// Couplings come in two groups: those that usually act, and those that rarely do (backside flanks, stops).
/// Of the latter only deflections are computed until one touches. The law numbers all couplings
/// consecutively, the usual ones first.
#[derive(Debug, Clone)]
pub struct Coupled<L> {
    pub(super) law: L,
    pub(super) rule: AverageAcceleration,
    pub(super) modes: Modes,
    /// Displacements above this count as divergence, m.
    bound: f64,
    /// Least mass, kg.
    least_mass: f64,
    /// Those that usually act.
    pub(super) usual: Condensed,
    /// The rare couplings, and all couplings; `None` without rare ones.
    pub(super) rare: Option<(Condensed, Condensed)>,
    /// Deflections up to which the rare couplings have no force, m.
    silent: Vec<f64>,
    pub(super) steps_per_cycle: usize,
    /// External forces on the modes, padded: the steady ones; and step by step of the cycle, the sum of the
    /// steady ones and those of the step.
    pub(super) steady: Vec<f64>,
    pub(super) cycle: Vec<f64>,
    pub(super) state: CoupledState,
    work: Work,
    /// Whether rare couplings took part in the last step.
    pub(super) took_rare: bool,
    /// Iterations of all steps so far.
    pub iterations: u64,
    /// Steps in which rare couplings took part.
    pub with_rare: u64,
}

/// The state from which a coupled system continues bit by bit; valid only for the system it was taken from.
#[derive(Debug, Clone, PartialEq)]
pub struct CoupledState {
    /// Step in the cycle.
    pub step_in_cycle: usize,
    /// Steps since the start.
    pub steps: u64,
    /// Displacements, velocities and accelerations of the modes, padded with zeros.
    pub modal: Motion,
    /// Forces of all couplings at the last two steps, the later first, N.
    pub forces: [Vec<f64>; 2],
}

impl CoupledState {
    /// At rest at step 0, of some modes (padded) and couplings.
    fn at_rest(padded: usize, couplings: usize) -> Self {
        Self {
            step_in_cycle: 0,
            steps: 0,
            modal: Motion::at_rest(padded),
            forces: [vec![0.0; couplings], vec![0.0; couplings]],
        }
    }
}

#[derive(Debug, Clone)]
struct Work {
    acceleration_history: Vec<f64>,
    velocity_history: Vec<f64>,
    load: Vec<f64>,
    free: Vec<f64>,
    /// Forces, padded.
    forces: Vec<f64>,
    next: Vec<f64>,
}

impl<L: CouplingForce> Coupled<L> {
    /// A system at rest at the origin, at step 0 of a cycle.
    ///
    /// # Errors
    /// If sizes do not match, a number is not finite, a lag is negative, there are too many couplings, or the
    /// modes of the linear part cannot be computed.
    pub fn new(
        linear: &LinearPart,
        usual: &[Coupling],
        rare: &[Coupling],
        law: L,
        rule: AverageAcceleration,
        steps_per_cycle: usize,
    ) -> Result<Self, CoupledError> {
        let n = linear.mass.len();
        let count = usual.len() + rare.len();
        for (coupling, c) in usual.iter().chain(rare).enumerate() {
            if c.row.len() != n {
                let (what, got) = ("a coupling's row", c.row.len());
                return Err(CoupledError::Size { what, got, wanted: n });
            }
            if let Some(value) = c.row.iter().copied().find(|r| !r.is_finite()) {
                return Err(CoupledError::Coupling { what: "an entry", coupling, value });
            }
            if !c.offset.is_finite() {
                let value = c.offset;
                return Err(CoupledError::Coupling { what: "the offset", coupling, value });
            }
            if !(c.lag >= 0.0 && c.lag.is_finite()) {
                let value = c.lag;
                return Err(CoupledError::Coupling { what: "the lag", coupling, value });
            }
        }
        if steps_per_cycle == 0 {
            return Err(CoupledError::NoSteps);
        }
        let modes = Modes::new(linear, &rule)?;
        let most = WIDTHS[WIDTHS.len() - 1];
        let group = |list: &[&Coupling]| {
            Condensed::new(&modes, &rule, list).ok_or(CoupledError::TooMany { got: count, most })
        };
        let [first, second]: [Vec<&Coupling>; 2] = [usual.iter().collect(), rare.iter().collect()];
        let all: Vec<&Coupling> = usual.iter().chain(rare).collect();
        let all = group(&all)?;
        let padded = n.next_multiple_of(LANES);
        let nil = vec![0.0; padded];
        let silent = (usual.len()..count).map(|k| law.silent_up_to(k)).collect();
        Ok(Self {
            usual: group(&first)?,
            work: Work {
                acceleration_history: nil.clone(),
                velocity_history: nil.clone(),
                load: nil.clone(),
                free: nil.clone(),
                forces: vec![0.0; all.width.max(WIDTHS[0])],
                next: nil.clone(),
            },
            rare: if rare.is_empty() { None } else { Some((group(&second)?, all)) },
            silent,
            law,
            rule,
            bound: USUAL_BOUND,
            least_mass: linear.mass.iter().copied().fold(f64::INFINITY, f64::min),
            modes,
            steps_per_cycle,
            cycle: nil.repeat(steps_per_cycle),
            steady: nil.clone(),
            state: CoupledState::at_rest(padded, count),
            took_rare: false,
            iterations: 0,
            with_rare: 0,
        })
    }

    /// The same system with the same external forces, at rest at the origin at step 0 of a cycle, at other time steps.
    ///
    /// # Errors
    /// If the equations of a step are singular.
    pub fn at(&self, rule: AverageAcceleration) -> Result<Self, CoupledError>
    where
        L: Clone,
    {
        let modes = self.modes.clone().at(&rule)?;
        let group = |own: &Condensed| own.clone().at(&modes, &rule);
        let usual = group(&self.usual);
        let rare = self.rare.as_ref().map(|(rare, all)| (group(rare), group(all)));
        let (padded, count) = (self.steady.len(), self.state.forces[0].len());
        Ok(Self {
            law: self.law.clone(),
            rule,
            modes,
            bound: self.bound,
            least_mass: self.least_mass,
            usual,
            rare,
            silent: self.silent.clone(),
            steps_per_cycle: self.steps_per_cycle,
            steady: self.steady.clone(),
            cycle: self.cycle.clone(),
            state: CoupledState::at_rest(padded, count),
            work: self.work.clone(),
            took_rare: false,
            iterations: 0,
            with_rare: 0,
        })
    }

    /// Sets the external forces on the coordinates (N) from now on.
    ///
    /// # Errors
    /// If there is not one for each coordinate.
    pub fn set_external(&mut self, force: &[f64]) -> Result<(), CoupledError> {
        self.fits("the external force", force)?;
        let mut modal = vec![0.0; self.steady.len()];
        self.modes.project(force, &mut modal);
        for own in self.cycle.chunks_exact_mut(self.steady.len()) {
            for (own, (new, old)) in own.iter_mut().zip(modal.iter().zip(&self.steady)) {
                *own += new - old;
            }
        }
        self.steady = modal;
        Ok(())
    }

    /// Adds forces on the coordinates (N) that act at one step of every cycle.
    ///
    /// # Errors
    /// If there is not one for each coordinate.
    pub fn add_in_cycle(
        &mut self,
        step_in_cycle: usize,
        force: &[f64],
    ) -> Result<(), CoupledError> {
        self.fits("the external force", force)?;
        let padded = self.steady.len();
        let mut modal = vec![0.0; padded];
        self.modes.project(force, &mut modal);
        let own = self.cycle.chunks_exact_mut(padded).nth(step_in_cycle % self.steps_per_cycle);
        for (own, new) in own.into_iter().flatten().zip(modal) {
            *own += new;
        }
        Ok(())
    }

    /// External forces on the modes at a step, padded.
    #[inline]
    pub(super) fn external(&self, step_in_cycle: usize) -> &[f64] {
        let padded = self.steady.len();
        &self.cycle[step_in_cycle * padded..(step_in_cycle + 1) * padded]
    }

    /// One step.
    ///
    /// # Errors
    /// If the couplings' equations are not solved, or a displacement passes the largest of a motion that does not
    /// diverge.
    pub fn step(&mut self) -> Result<(), CoupledError> {
        let after = self.state.step_in_cycle + 1;
        let step_in_cycle = if after == self.steps_per_cycle { 0 } else { after };
        self.predict(step_in_cycle);
        self.guess(self.usual.count);
        let (law, group) = (&self.law, &self.usual);
        let at = (step_in_cycle, ROUNDING * self.bound);
        let done = solve(group, law, at, &self.rule, &mut self.work);
        self.iterations += done.map_err(|left| self.not_converged(left))? as u64;
        self.apply(false);
        let mut taking_part = self.usual.count;
        if let Some((_, all)) = self.rare.as_ref().filter(|(rare, _)| self.rare_touch(rare)) {
            taking_part = all.count;
            self.guess(taking_part);
            if let Some((_, all)) = &self.rare {
                let done = solve(all, &self.law, at, &self.rule, &mut self.work);
                self.iterations += done.map_err(|left| self.not_converged(left))? as u64;
            }
            self.apply(true);
            self.with_rare += 1;
        }
        self.took_rare = taking_part > self.usual.count;
        self.finish(taking_part);
        self.state.step_in_cycle = step_in_cycle;
        self.state.steps += 1;
        self.check()
    }

    /// Computes a*, v* and the displacements without coupling forces.
    #[inline]
    fn predict(&mut self, step_in_cycle: usize) {
        let n = self.steady.len();
        let external = &self.cycle[step_in_cycle * n..(step_in_cycle + 1) * n];
        let Motion { x, v, a } = &self.state.modal;
        let (x, v, a) = (&x[..n], &v[..n], &a[..n]);
        let work = &mut self.work;
        let acceleration = &mut work.acceleration_history[..n];
        let velocity = &mut work.velocity_history[..n];
        let (inertia, rate) = (self.rule.inertia(), self.rule.damping());
        for i in 0..n {
            // a* = (4/h²) x + (4/h) ẋ + ẍ,  v* = (2/h) x + ẋ
            acceleration[i] = inertia * x[i] + 2.0 * rate * v[i] + a[i];
            velocity[i] = rate * x[i] + v[i];
        }
        match &self.modes.own_damping {
            Some(damping) => {
                let (c, inverse) = (&damping[..n], &self.modes.own_inverse[..n]);
                let free = &mut work.free[..n];
                for i in 0..n {
                    // A x = f + a* + c v*
                    free[i] = inverse[i] * (external[i] + acceleration[i] + c[i] * velocity[i]);
                }
            }
            None => {
                for (load, (f, a)) in work.load.iter_mut().zip(external.iter().zip(acceleration)) {
                    *load = f + *a;
                }
                self.modes.add_damping(velocity, &mut work.load);
                self.modes.solve_full(&work.load, &mut work.free);
            }
        }
    }

    /// First estimate of the coupling forces: extrapolated linearly from the last two steps.
    #[inline]
    fn guess(&mut self, count: usize) {
        let [now, before] = &self.state.forces;
        let guessed = &mut self.work.forces;
        for (out, (now, before)) in guessed.iter_mut().zip(now.iter().zip(before)).take(count) {
            *out = 2.0 * now - before;
        }
        guessed[count..].fill(0.0);
    }

    /// x = free − A⁻¹ Rᵀ P with the usual couplings, or with all.
    #[inline]
    fn apply(&mut self, with_rare: bool) {
        let group = match &self.rare {
            Some((_, all)) if with_rare => all,
            _ => &self.usual,
        };
        let work = &mut self.work;
        let (free, _) = work.free.as_chunks::<LANES>();
        let (next, _) = work.next.as_chunks_mut::<LANES>();
        let stride = free.len();
        let (answers, _) = group.answers.as_chunks::<LANES>();
        let forces = &work.forces[..group.count];
        for (chunk, next) in next.iter_mut().enumerate() {
            let mut sum = free[chunk];
            for (answer, force) in answers[chunk..].iter().step_by(stride).zip(forces) {
                for lane in 0..LANES {
                    sum[lane] -= answer[lane] * force;
                }
            }
            *next = sum;
        }
    }

    /// Whether rare couplings touch at the displacements found.
    #[inline]
    fn rare_touch(&self, rare: &Condensed) -> bool {
        at_width!(rare.width, W => self.touch::<W>(rare))
    }

    #[inline]
    fn touch<const W: usize>(&self, rare: &Condensed) -> bool {
        let (rows, _) = rare.rows.as_chunks::<W>();
        let (mut along, mut rate) = ([0.0; W], [0.0; W]);
        let histories = self.work.next.iter().zip(&self.work.velocity_history);
        for (row, (q, history)) in rows.iter().zip(histories) {
            let v = self.rule.damping() * q - history;
            newton::add(&mut along, row, *q);
            newton::add(&mut rate, row, v);
        }
        let reach = |k: usize| along[k] - rare.offsets[k] + rare.lags[k] * rate[k];
        self.silent.iter().enumerate().any(|(k, silent)| reach(k) > *silent)
    }

    #[inline]
    fn finish(&mut self, taking_part: usize) {
        let n = self.steady.len();
        let Motion { x, v, a } = &mut self.state.modal;
        let (x, v, a) = (&mut x[..n], &mut v[..n], &mut a[..n]);
        let work = &self.work;
        let (next, acceleration) = (&work.next[..n], &work.acceleration_history[..n]);
        let velocity = &work.velocity_history[..n];
        let (inertia, rate) = (self.rule.inertia(), self.rule.damping());
        for i in 0..n {
            x[i] = next[i];
            v[i] = rate * next[i] - velocity[i];
            a[i] = inertia * next[i] - acceleration[i];
        }
        let [now, before] = &mut self.state.forces;
        std::mem::swap(now, before);
        now[..taking_part].copy_from_slice(&work.forces[..taking_part]);
        now[taking_part..].fill(0.0);
    }

    /// Refuses displacements above the bound: Σ m x² = Σ q² bounds every coordinate.
    /// The same with another largest displacement (m) of a motion that does not diverge.
    pub fn bounded_by(self, bound: f64) -> Self {
        Self { bound, ..self }
    }

    #[inline]
    fn check(&self) -> Result<(), CoupledError> {
        let size: f64 = self.state.modal.x.iter().map(|q| q * q).sum();
        if size <= self.least_mass * self.bound * self.bound {
            return Ok(());
        }
        let time_s = self.time();
        for coordinate in 0..self.modes.count {
            let value = self.displacement(coordinate);
            if value.is_nan() || value.abs() > self.bound {
                return Err(CoupledError::Diverged { time_s, coordinate, value });
            }
        }
        Ok(())
    }

    #[cold]
    fn not_converged(&self, (iterations, coupling, residual_m): Left) -> CoupledError {
        let time_s = self.time() + self.rule.step();
        CoupledError::NotConverged { time_s, iterations, coupling, residual_m }
    }

    pub(super) fn fits(&self, what: &'static str, list: &[f64]) -> Result<(), CoupledError> {
        match list.len() == self.modes.count {
            true => Ok(()),
            false => Err(CoupledError::Size { what, got: list.len(), wanted: self.modes.count }),
        }
    }

    /// All couplings in one group.
    pub(super) fn all(&self) -> &Condensed {
        self.rare.as_ref().map_or(&self.usual, |(_, all)| all)
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.state.steps as f64 * self.rule.step()
    }
}

/// Solves a group of couplings at its width.
#[inline]
fn solve<L: CouplingForce>(
    group: &Condensed,
    law: &L,
    (step_in_cycle, nothing): (usize, f64),
    rule: &AverageAcceleration,
    work: &mut Work,
) -> Result<usize, Left> {
    let Work { free, velocity_history, forces, .. } = work;
    let start = Start { step_in_cycle, nothing, rate: rule.damping(), free, velocity_history };
    at_width!(group.width, W => newton::solve::<W, L>(group, law, &start, forces))
}
