//! Steps in a mesh cycle that the vibrations of a set need at a speed.
//!
//! Average acceleration in S steps h of a mesh cycle T gives a vibration s = −δ + iω the multiplier
//!
//! ```text
//! |μ| = |(1 + sh/2)/(1 − sh/2)|^S   for   e^{−δT}
//! ```
//!
//! so that vibrations of short period decay the less, the longer the step is. With fewer than about one step in a
//! period of the fastest, the stiffness that varies from step to step feeds it besides: motions that attract seem
//! unstable.

use std::f64::consts::TAU;

use dynamics::{Multiplier, PeriodMap, c64, multipliers};
use fe_contact::vibration::Along;

use super::critical_motion::CriticalMotion;
use super::error::SweepError;
use super::point::StepError;
use super::shooting::RecordedCycles;
use super::state::{Coordinate, SteadyState};
use super::sweep_model::{MOST_TIMES, SweepModel};
use crate::table_growth::large_enough;

/// Mesh frequency of a cycle in which the set hardly moves, Hz. Vibrations up to half of it are told apart, and
/// the lag of the teeth, some microseconds, is over within it.
const SHORT_CYCLE_HZ: f64 = 5e4;

/// Multipliers of that cycle below this are those of the lag.
const LAG: f64 = 0.3;

/// Largest error of the largest multiplier.
const MOST_ERROR: f64 = 0.01;

/// Fewest steps in a period of the fastest vibration.
const FEWEST: f64 = 0.9;

/// Most steps in a mesh cycle, unless the scene has more.
const MOST_STEPS: usize = 1120;

/// Largest part of a vibration that may outlast a cycle where steps are longer than the vibrations need.
const LEFT: f64 = 0.5;

/// Largest part of an amplitude that steps may change without a word.
const MOST_STEP_ERROR: f64 = 0.01;

/// Steps up to which a number that would do is looked for: without damping none does at a resonance.
const MOST_NAMED: usize = 100_000;

/// Harmonics of less than this share of the strongest are not asked about.
const STRONG: f64 = 0.5;

/// A multiplier that is gone after a cycle.
const GONE: f64 = 1e-3;

/// Largest share of the slowest vibration's frequency that the highest harmonic kept may have where the motion of
/// a faster set is taken: its square is the part of inertia in that harmonic.
const QUASI_STATIC: f64 = 0.1;

/// A vibration of a set about its mean mesh stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Vibration {
    /// ω, rad/s.
    omega: f64,
    /// δ, 1/s.
    decay: f64,
}

/// The vibrations of a set.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Vibrations {
    all: Vec<Vibration>,
    /// Type of the motion of the one that decays slowest; `None` of a set without such types.
    slowest_type: Option<String>,
}

/// How a speed is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Resolved {
    /// With so many times the steps.
    Times(usize),
    /// As the motion at a higher mesh frequency, Hz, with the most steps: no vibration outlasts a cycle there, and
    /// inertia has no part.
    Faster { times: usize, mesh_hz: f64 },
    /// Not at all: so many steps in a cycle would be needed, more than the most that are taken.
    Needs { steps: usize, most: usize },
}

/// Steps in a mesh cycle that the vibrations of a model need at a speed, rpm, where these are more than it has;
/// `None` otherwise, and of a model without derivative.
///
/// # Errors
/// If a set cannot be built or its vibrations are not found.
pub fn steps_needed(model: &dyn SweepModel, speed_rpm: f64) -> Result<Option<usize>, SweepError> {
    let mesh_hz = model.case().at_speed(speed_rpm).mesh_frequency_hz;
    let usual = model.steps_per_cycle();
    let enough = Vibrations::of(model)?.map(|all| all.steps_enough(mesh_hz, usual));
    Ok(enough.filter(|steps| *steps > usual))
}

/// Harmonics, ascending and up to `highest`, in which the sun, or the member that turns where it is held, moves along
/// a coordinate by at least [`STRONG`] of its largest amplitude.
pub(super) fn strong_harmonics(
    state: &SteadyState,
    coordinate: Coordinate,
    highest: usize,
) -> Vec<usize> {
    let (member, all) = (state.turning_member(), state.with_translations());
    let lines = all
        .iter()
        .filter(|line| line.part == member && line.coordinate == coordinate && line.harmonic > 0);
    let largest = lines.clone().map(|line| line.amplitude).fold(0.0, f64::max);
    let strong = lines.filter(|line| line.amplitude > STRONG * largest).map(|line| line.harmonic);
    let mut strong: Vec<usize> = strong.filter(|harmonic| *harmonic <= highest).collect();
    strong.sort_unstable();
    strong
}

impl Vibrations {
    /// Of a model: from the multipliers of a cycle so short that the set hardly moves, μ = e^{(−δ ± iω)T}. `None`
    /// without derivative.
    ///
    /// # Errors
    /// If the set cannot be built, stepped or its multipliers are not found.
    pub(super) fn of(model: &dyn SweepModel) -> Result<Option<Self>, SweepError> {
        large_enough(|size| Self::of_size(model, size))
    }

    fn of_size(model: &dyn SweepModel, size: usize) -> Result<Option<Self>, SweepError> {
        // The set stands still while the stiffness of its meshes varies, and forces with it: half of its torque
        // leaves room in the tables.
        let case = model.case();
        let case = case.with_sun_torque(0.5 * case.sun_torque_nm);
        let per_rpm = case.mesh_frequency_per_rpm_hz();
        let mut set = model.in_short_cycles(&case.at_speed(SHORT_CYCLE_HZ / per_rpm), 1.0, size)?;
        if set.derivative().is_none() {
            return Ok(None);
        }
        set.rest()?;
        let steps = model.steps_per_cycle();
        let (shape, psi) = (model.shape(), model.first_planet_rad());
        let mut cycle = RecordedCycles::new(set.as_mut(), shape, psi, steps);
        cycle.advance()?;
        let derivative = cycle.of_cycle(Along::Every)?;
        let mut found = multipliers(&derivative)?;
        found.retain(|m| m.im > 0.0 && m.size() > LAG);
        let all = found.iter().map(|m| Vibration {
            omega: SHORT_CYCLE_HZ * m.im.atan2(m.re),
            decay: -SHORT_CYCLE_HZ * m.size().ln(),
        });
        let all = all.collect();
        let slowest = found.get(..1).unwrap_or_default();
        let slowest = CriticalMotion::of(&*cycle.into_set(), &derivative, slowest, 1)?;
        Ok(Some(Self { all, slowest_type: slowest.map(|own| own.mode_type) }))
    }

    /// Decay rate δ of the vibration whose ω is nearest, 1/s; 0 without any.
    pub(super) fn decay_near(&self, omega: f64) -> f64 {
        let off = |v: &&Vibration| (v.omega - omega).abs();
        self.all.iter().min_by(|a, b| off(a).total_cmp(&off(b))).map_or(0.0, |v| v.decay)
    }

    /// Multipliers e^{(−δ ± iω)T} of a mesh cycle at a mesh frequency, Hz, the largest first, with the type of its
    /// motion; `None` if more than [`LEFT`] of a vibration outlasts the cycle. Then the stiffness that varies over
    /// the cycle matters, and how long the steps are; otherwise a motion that attracts in any steps is that of
    /// shorter ones.
    pub(super) fn multipliers(&self, mesh_hz: f64) -> Option<(Vec<Multiplier>, Option<String>)> {
        let mut all: Vec<Multiplier> = Vec::new();
        for Vibration { omega, decay } in &self.all {
            let (size, angle) = ((-decay / mesh_hz).exp(), omega / mesh_hz);
            let of =
                |sign: f64| Multiplier { re: size * angle.cos(), im: sign * size * angle.sin() };
            all.extend([of(1.0), of(-1.0)]);
        }
        all.sort_by(|a, b| b.size().total_cmp(&a.size()));
        let is_over = all.first().is_none_or(|m| m.size() <= LEFT);
        is_over.then(|| (all, self.slowest_type.clone()))
    }

    /// How a mesh frequency is computed with `steps` in a cycle or a multiple of them, where harmonics up to
    /// `highest` are kept.
    pub(super) fn resolved(&self, mesh_hz: f64, steps: usize, highest: usize) -> Resolved {
        let most = (MOST_STEPS / steps.max(1)).clamp(1, MOST_TIMES);
        let is_enough = |hz: f64, times: usize| self.are_resolved(hz, steps * times);
        if let Some(times) = (1..=most).find(|times| is_enough(mesh_hz, *times)) {
            return Resolved::Times(times);
        }
        // The least frequency that the most steps resolve.
        let (mut low, mut high) = (0.0, 1.0);
        while !is_enough(high, most) {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            if is_enough(middle, most) { high = middle } else { low = middle }
        }
        let slowest = self.all.iter().map(|v| v.omega).fold(f64::INFINITY, f64::min);
        let is_quasi_static = TAU * high * highest as f64 <= QUASI_STATIC * slowest;
        let is_gone = self.all.iter().all(|v| (-v.decay / high).exp() <= GONE);
        if is_quasi_static && is_gone {
            return Resolved::Faster { times: most, mesh_hz: high };
        }
        Resolved::Needs { steps: self.steps_enough(mesh_hz, 2 * most * steps), most: most * steps }
    }

    /// The least of `steps` times a power of 2 that is enough at a mesh frequency, Hz.
    fn steps_enough(&self, mesh_hz: f64, mut steps: usize) -> usize {
        while !self.are_resolved(mesh_hz, steps) {
            steps *= 2;
        }
        steps
    }

    /// What the steps may change of the strongest motions of the sun at a mesh frequency, Hz, where that is more
    /// than 1 %.
    ///
    /// Average acceleration answers a force at Ω = 2π l f_m as the set itself does at Ω̃ = (2/h) tan(Ωh/2). A vibration
    /// s = −δ ± iω that alone moved the sun would have
    ///
    /// ```text
    /// |(iΩ − s)(iΩ − s*)| / |(iΩ̃ − s)(iΩ̃ − s*)|
    /// ```
    ///
    /// of its amplitude; which vibrations do move it is not asked, so that this is the most that it may be.
    pub(super) fn step_error(
        &self,
        state: &SteadyState,
        steps: usize,
        highest: usize,
    ) -> Option<StepError> {
        let mut harmonics = strong_harmonics(state, Coordinate::Rotation, highest);
        harmonics.extend(strong_harmonics(state, Coordinate::Translation, highest));
        harmonics.sort_unstable();
        harmonics.dedup();
        let mesh_hz = state.case.mesh_frequency_hz;
        let mut largest = self.largest_error(&harmonics, mesh_hz, steps)?;
        let mut needed = largest;
        while needed.share > MOST_STEP_ERROR && needed.steps < MOST_NAMED {
            // The error falls with the square of the steps.
            let more = (needed.share / MOST_STEP_ERROR).sqrt().max(1.02);
            let more = (needed.steps as f64 * more).ceil() as usize;
            needed = self.largest_error(&harmonics, mesh_hz, more)?;
        }
        largest.steps = needed.steps;
        (largest.share > MOST_STEP_ERROR).then_some(largest)
    }

    /// The largest change that so many steps make of any of the harmonics by any vibration; `None` without.
    fn largest_error(&self, harmonics: &[usize], mesh_hz: f64, steps: usize) -> Option<StepError> {
        let step_s = 1.0 / (mesh_hz * steps as f64);
        let errors = harmonics.iter().flat_map(|harmonic| {
            let exact = TAU * mesh_hz * *harmonic as f64;
            let of_steps = 2.0 / step_s * (0.5 * exact * step_s).tan();
            self.all.iter().map(move |Vibration { omega, decay }| {
                let stiffness = |at: f64| {
                    c64::new(omega * omega + decay * decay - at * at, 2.0 * decay * at).norm()
                };
                let share = (stiffness(exact) / stiffness(of_steps) - 1.0).abs();
                StepError { harmonic: *harmonic, natural_hz: omega / TAU, share, steps }
            })
        });
        errors.max_by(|a, b| a.share.total_cmp(&b.share))
    }

    /// Whether so many steps in a cycle are enough at a mesh frequency, Hz.
    fn are_resolved(&self, mesh_hz: f64, steps: usize) -> bool {
        let step_s = 1.0 / (mesh_hz * steps as f64);
        let (mut of_steps, mut exact, mut is_fine) = (0.0f64, 0.0f64, true);
        for Vibration { omega, decay } in &self.all {
            let half = c64::new(-decay, *omega) * (0.5 * step_s);
            let one = c64::new(1.0, 0.0);
            of_steps = of_steps.max(((one + half) / (one - half)).norm().powf(steps as f64));
            exact = exact.max((-decay / mesh_hz).exp());
            is_fine &= FEWEST * omega * step_s <= TAU;
        }
        is_fine && of_steps - exact <= MOST_ERROR
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A vibration of 100 Hz with 2 % and a stiff one of 5 kHz with 20 %.
    fn vibrations() -> Vibrations {
        let of = |hz: f64, zeta: f64| {
            let omega = TAU * hz;
            Vibration { omega, decay: zeta * omega }
        };
        Vibrations { all: vec![of(100.0, 0.02), of(5000.0, 0.2)], slowest_type: None }
    }

    #[test]
    fn slower_sets_have_more_steps_and_the_slowest_those_of_a_faster_one() {
        let all = vibrations();
        assert_eq!(all.resolved(60.0, 140, 5), Resolved::Times(1));
        let Resolved::Times(times) = all.resolved(20.0, 140, 5) else { panic!() };
        // 5 kHz: 0.9 · 5000/20 = 225 steps.
        assert_eq!(times, 2);
        // It needs 1120 steps at 4 Hz; 100 Hz still rings there: e^{−12.6/4} = 0.04.
        assert_eq!(all.resolved(2.1, 140, 5), Resolved::Needs { steps: 2240, most: 1120 });
        let all = vec![Vibration { omega: 1e4, decay: 400.0 }];
        let fast = Vibrations { all, slowest_type: None };
        let Resolved::Faster { times: 8, mesh_hz } = fast.resolved(0.1, 140, 5) else { panic!() };
        assert!(fast.are_resolved(mesh_hz, 1120) && !fast.are_resolved(0.99 * mesh_hz, 1120));
    }
}
