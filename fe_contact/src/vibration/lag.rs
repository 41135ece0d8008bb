//! The lag of flexibility without inertia behind its load, caused by stiffness-proportional
//! damping.
//!
//! β is some microseconds, mostly shorter than a step, so that the trapezoidal rule would oscillate.
//! Instead the forces are interpolated by a parabola through the end of the step, its start and the
//! start of the step before, for which the equation is solved exactly. In steps below 2β a whole
//! parabola would let the forces of stiff contact ring up, and its bow is flattened. This is of second
//! order for any ratio of step and β, and damps motion faster than the step. The state belongs to tooth
//! pairs, whose numbers grow by one whenever the phase of their mesh starts again at 0, and fall by one where
//! meshes run backward.

use dynamics::AverageAcceleration;
use gearset::PathDirection;

use crate::error::FeError;

/// Pairs −LEAST … WIDTH − 1 − LEAST are kept.
const LEAST: i64 = 4;
pub(super) const WIDTH: usize = 12;

/// Weights of the forces at the end and at the start of a step and one step earlier, and of the
/// state P̃.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LagRule {
    pub(super) end: f64,
    start: f64,
    before: f64,
    state: f64,
}

impl LagRule {
    /// Weights of the forces at the end and at the start of a step and one step earlier, and of P̃.
    pub(super) fn weights(&self) -> [f64; 4] {
        [self.end, self.start, self.before, self.state]
    }

    /// Steps after which nothing is left of P̃ (1e-18 of it, a hundredth of rounding) once a force has ended: it enters
    /// for two more steps, and then P̃ falls as a power of its weight.
    pub(super) fn forgotten(&self) -> usize {
        let falling = 1e-18f64.ln() / self.state.ln();
        2 + if falling.is_finite() { falling.ceil() as usize } else { 0 }
    }

    /// Share of a change of the forces of the last two steps that is left in the force after one more, for the same
    /// approaches: these determine P̃, so that e P₁ + s P₀ + b P₋₁ does not change, and P falls as the larger root r of
    /// e r² + s r + b = 0.
    pub(super) fn left_after_step(&self) -> f64 {
        let (half, product) = (0.5 * self.start / self.end, self.before / self.end);
        let square = half * half - product;
        if square < 0.0 { product.sqrt() } else { half.abs() + square.sqrt() }
    }

    /// `[eq:lag]` β u̇ + u = −F P where FE flexibility F follows forces P without inertia of its own, so u = −F P̃
    /// with β P̃' + P̃ = P: exact for a parabolic P through s = −1, 0, 1 by I_n = ∫₀¹ z e^{−z(1−s)} sⁿ ds, z = h/β;
    /// where z < 2, only z/2 of its bow. Approaches of stiff pairs determine P̃, so that e P₁ + s P₀ + b P₋₁ is known,
    /// and P alternates and grows where e − s + b < 0: with a share c of the bow, where c > z/2.
    ///
    /// Source: derived here.
    /// Checked by: `fe_contact/src/vibration/lag.rs::a_parabola_is_followed_exactly`,
    /// `fe_contact/src/vibration/lag.rs::forces_at_given_approaches_do_not_ring_up`, `fe.stepping.ringing`.
    pub(super) fn new(beta: f64, rule: &AverageAcceleration) -> Self {
        if beta <= 0.0 {
            return Self { end: 1.0, start: 0.0, before: 0.0, state: 0.0 };
        }
        let z = rule.step() / beta;
        let i0 = -(-z).exp_m1();
        let (i1, i2) = if z > 0.1 {
            let i1 = 1.0 - i0 / z;
            (i1, 1.0 - 2.0 * i1 / z)
        } else {
            // The recursion loses digits; the series I_n = Σ_k (−1)^k n! z^{k+1}/(n+1+k)! does not.
            let series = |n: usize| {
                let (mut term, mut sum) = (z / (n as f64 + 1.0), 0.0);
                for k in 0..24 {
                    sum += term;
                    term *= -z / (n as f64 + 2.0 + k as f64);
                }
                sum
            };
            (series(1), series(2))
        };
        let bow = 0.5 * (0.5 * z).min(1.0) * (i1 - i2);
        Self { end: i1 - bow, start: i0 - i1 + 2.0 * bow, before: -bow, state: (-z).exp() }
    }
}

/// P̃ at the end of each step under forces P (N) at the ends of equal steps (s), at rest under the first before;
/// β in s.
///
/// # Errors
/// If the step is not positive and finite.
pub fn lagged(beta_s: f64, step_s: f64, forces: &[f64]) -> Result<Vec<f64>, FeError> {
    let why = || FeError::NoEquilibrium(format!("{step_s} s is no step"));
    let rule = LagRule::new(beta_s, &AverageAcceleration::new(step_s).map_err(|_| why())?);
    let (mut memory, slot) = (PairMemory::default(), PairSlot::of(0));
    memory.rest(forces.first().map(|p| (slot, *p)).into_iter());
    let one = |p: &f64| {
        memory.advance(&rule, std::iter::once((slot, *p)));
        memory.filtered[LEAST as usize]
    };
    Ok(forces.iter().map(one).collect())
}

/// State of the lag of one mesh, for each pair: P̃, and the forces at the end of the last step and
/// of the one before, N.
#[derive(Debug, Clone, Default)]
pub(super) struct PairMemory {
    filtered: [f64; WIDTH],
    now: [f64; WIDTH],
    before: [f64; WIDTH],
}

/// Index of a pair in a [`PairMemory`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PairSlot(u8);

impl PairSlot {
    /// Index of a pair; pairs outside the stored range share one that stays empty.
    pub(super) fn of(pair: i64) -> Self {
        let place = u8::try_from(pair + LEAST).ok().filter(|i| usize::from(*i) < WIDTH);
        Self(place.unwrap_or(WIDTH as u8))
    }

    pub(super) fn place(self) -> Option<usize> {
        Some(usize::from(self.0)).filter(|i| *i < WIDTH)
    }
}

impl PairMemory {
    /// Steady state under constant forces (N).
    pub(super) fn rest(&mut self, forces: impl Iterator<Item = (PairSlot, f64)>) {
        *self = Self::default();
        for (slot, force) in forces {
            if let Some(i) = slot.place() {
                (self.filtered[i], self.now[i], self.before[i]) = (force, force, force);
            }
        }
    }

    /// All values of the state.
    pub(super) fn lists(&mut self) -> [&mut [f64; WIDTH]; 3] {
        [&mut self.filtered, &mut self.now, &mut self.before]
    }

    /// Part of P̃ at the end of the step that is known at its start.
    pub(super) fn known(&self, rule: &LagRule, slot: PairSlot) -> f64 {
        slot.place().map_or(0.0, |i| {
            rule.state * self.filtered[i] + rule.start * self.now[i] + rule.before * self.before[i]
        })
    }

    /// Force of a pair at the end of the next step, extrapolated linearly from the last two and not
    /// below 0, N.
    pub(super) fn expected(&self, slot: PairSlot) -> f64 {
        slot.place().map_or(0.0, |i| (2.0 * self.now[i] - self.before[i]).max(0.0))
    }

    /// Force of a pair at the end of the last step, N.
    pub(super) fn now(&self, slot: PairSlot) -> f64 {
        slot.place().map_or(0.0, |i| self.now[i])
    }

    /// Force of the mesh at the end of the last step, N.
    pub(super) fn total(&self) -> f64 {
        self.now.iter().sum()
    }

    #[cfg(test)]
    fn filtered(&self, pair: i64) -> f64 {
        PairSlot::of(pair).place().map_or(0.0, |i| self.filtered[i])
    }

    /// Advances the state by a step with the forces (N) at its end; pairs that are not listed carry
    /// none.
    pub(super) fn advance(
        &mut self,
        rule: &LagRule,
        forces: impl Iterator<Item = (PairSlot, f64)>,
    ) {
        let mut end = [0.0; WIDTH];
        for (slot, force) in forces {
            if let Some(i) = slot.place() {
                end[i] = force;
            }
        }
        for (i, end) in end.iter().enumerate() {
            self.filtered[i] = rule.state * self.filtered[i]
                + rule.start * self.now[i]
                + rule.before * self.before[i]
                + rule.end * end;
        }
        self.before = self.now;
        self.now = end;
    }

    /// The phase of the mesh passes 0: what was pair k is pair k + 1, or k − 1 in backward direction.
    pub(super) fn move_on(&mut self, direction: PathDirection) {
        for list in [&mut self.filtered, &mut self.now, &mut self.before] {
            match direction {
                PathDirection::Forward => {
                    list.copy_within(0..WIDTH - 1, 1);
                    list[0] = 0.0;
                }
                PathDirection::Backward => {
                    list.copy_within(1..WIDTH, 0);
                    list[WIDTH - 1] = 0.0;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule(z: f64) -> LagRule {
        let beta = 2.21e-6;
        LagRule::new(beta, &AverageAcceleration::new(z * beta).unwrap())
    }

    #[test]
    fn a_steady_force_is_kept_and_weights_meet_where_the_formulas_change() {
        for z in [1e-3, 0.05, 0.0999, 0.1001, 1.0, 6.0, 1e4] {
            let r = rule(z);
            assert!((r.end + r.start + r.before + r.state - 1.0).abs() < 1e-12, "{z}");
        }
        let (a, b) = (rule(0.0999999), rule(0.1000001));
        assert!((a.end - b.end).abs() < 1e-6 && (a.before - b.before).abs() < 1e-6);
    }

    /// Solutions for a line and, in steps of 2β and more, a parabola are exact: P = t gives P̃ = t − β + β e^{−t/β},
    /// and P = t² gives t² − 2βt + 2β² − 2β² e^{−t/β}.
    #[test]
    fn a_parabola_is_followed_exactly() {
        let beta = 2.21e-6;
        for (z, power) in [(0.03, 1), (0.7, 1), (1.99, 1), (2.0, 1), (2.0, 2), (5.0, 1), (5.0, 2)] {
            let (h, r) = (z * beta, rule(z));
            let mut memory = PairMemory::default();
            memory.before[LEAST as usize] = (-h).powi(power);
            for step in 1..=20 {
                let t = f64::from(step) * h;
                memory.advance(&r, [(PairSlot::of(0), t.powi(power))].into_iter());
                let gone = -(-t / beta).exp_m1();
                let exact = match power {
                    1 => t - beta * gone,
                    _ => t * t - 2.0 * beta * t + 2.0 * beta * beta * gone,
                };
                let found = memory.filtered(0);
                let bound = 1e-9 * t.powi(power);
                assert!((found - exact).abs() < bound, "{z} {step}: {found} {exact}");
            }
        }
    }

    /// At given approaches P = −κ P̃, with κ the ratio of the lagging flexibility to the rest of a pair's: errors of
    /// the forces fall in steps of any length. The ring meshes of five planets at 8 kN m and 1.1 µs have κ = 30.
    #[test]
    fn forces_at_given_approaches_do_not_ring_up() {
        for z in [1e-3, 0.05, 0.3, 0.498, 1.0, 1.99, 2.0, 2.3, 5.0, 50.0] {
            for kappa in [0.1, 1.0, 5.0, 30.0, 300.0, 1e4] {
                let (rule, slot) = (rule(z), PairSlot::of(0));
                let mut memory = PairMemory::default();
                memory.rest([(slot, 1.0)].into_iter());
                let mut most = [0.0f64; 2];
                for step in 0..400 {
                    let force = -kappa * memory.known(&rule, slot) / (1.0 + kappa * rule.end);
                    memory.advance(&rule, [(slot, force)].into_iter());
                    most[step / 200] = most[step / 200].max(force.abs());
                }
                let [first, second] = most;
                assert!(second <= first, "{z}, {kappa}: {first:e}, then {second:e}");
            }
        }
    }

    /// Of a force that ended, and of which the parabola still knows for two steps, less than 1e-18 is left.
    #[test]
    fn what_is_forgotten_is_far_below_rounding() {
        for z in [0.03, 0.7, 5.0, 1e4] {
            let r = rule(z);
            let slot = PairSlot::of(0);
            let mut memory = PairMemory::default();
            memory.rest([(slot, 1.0)].into_iter());
            (0..=r.forgotten()).for_each(|_| memory.advance(&r, std::iter::empty()));
            let left = memory.filtered(0).abs();
            assert!(left < 2e-18 && memory.now(slot) == 0.0, "{z}: {left:e}");
        }
        assert_eq!(LagRule::new(0.0, &AverageAcceleration::new(1e-5).unwrap()).forgotten(), 2);
    }

    /// Where the same approaches keep asking for the force 1 (P̃ = 1 at the end of every step), errors 1 and −r of the
    /// last two forces leave r² in the next: −r is the larger root.
    #[test]
    fn forces_follow_from_approaches_as_said() {
        for z in [3.0, 8.0, 14.0, 50.0, 140.0] {
            let (rule, slot) = (rule(z), PairSlot::of(0));
            let r = rule.left_after_step();
            let mut memory = PairMemory::default();
            memory.rest([(slot, 1.0)].into_iter());
            (memory.before[LEAST as usize], memory.now[LEAST as usize]) = (2.0, 1.0 - r);
            let force = (1.0 - memory.known(&rule, slot)) / rule.end;
            assert!((force - 1.0 - r * r).abs() < 1e-12, "{z}: {r}, {force}");
        }
        let none = LagRule::new(0.0, &AverageAcceleration::new(1e-5).unwrap());
        assert_eq!(none.left_after_step(), 0.0);
    }

    #[test]
    fn pairs_move_on() {
        let mut memory = PairMemory::default();
        memory.rest([(0, 5.0), (-1, 3.0)].into_iter().map(|(k, p)| (PairSlot::of(k), p)));
        memory.move_on(PathDirection::Forward);
        assert_eq!((memory.filtered(1), memory.filtered(0)), (5.0, 3.0));
        memory.move_on(PathDirection::Backward);
        assert_eq!((memory.filtered(0), memory.filtered(-1)), (5.0, 3.0));
    }
}
