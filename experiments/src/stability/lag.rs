//! The lag of flexibility without inertia behind its load, by rule of integration.
//!
//! Damped flexibility without mass follows `eq:lag`. Under a sine of ω the lagged force is 1/(1 + iωβ) of it.

use std::f64::consts::TAU;

use dynamics::c64;
use fe_contact::vibration::lagged;

use super::bisection::bisected;
use super::map::{Drawn, Map, MapError, MapOf, StabilityMap, logarithms};

pub(super) const MAP: Map = Map {
    name: "lag",
    about: "The lag of damped flexibility without inertia, over the step, by rule of integration",
    meaning: "flexibility without inertia follows its load within microseconds: with steps longer than that the \
         trapezoidal rule makes it ring",
    of: MapOf::Nothing(map),
};

/// Steps in a period of the sine: the tenth harmonic of a mesh cycle of 140 steps.
const PERIOD: u32 = 14;

/// Steps in a jump's record.
const STEPS: usize = 60;

/// Shortest and longest step over β: each from the one before by √2.
const SHORTEST: f64 = 1.0 / 64.0;
const COUNT: i32 = 33;

#[derive(Clone, Copy, PartialEq)]
enum Rule {
    /// That of the program.
    Parabola,
    Trapezoidal,
}

impl Rule {
    fn name(self) -> &'static str {
        match self {
            Self::Parabola => {
                "parabola through three steps, flattened in steps below 2β (the program's)"
            }
            Self::Trapezoidal => "trapezoidal rule",
        }
    }

    /// P̃ under forces at the ends of steps of z β.
    fn lagged(self, z: f64, forces: &[f64]) -> Result<Vec<f64>, MapError> {
        if self == Self::Parabola {
            return Ok(lagged(1.0, z, forces)?);
        }
        let (mut state, mut before) = (forces.first().copied().unwrap_or(0.0), None);
        let one = |p: &f64| {
            let start = before.unwrap_or(*p);
            state = ((1.0 - 0.5 * z) * state + 0.5 * z * (start + p)) / (1.0 + 0.5 * z);
            before = Some(*p);
            state
        };
        Ok(forces.iter().map(one).collect())
    }

    /// What is left of a jump in the step that ends `k` after it, of the jump.
    ///
    /// `[eq:ringing-lag]` One step of length h = zβ multiplies what is left of a deviation exactly by e^(−z), by the
    /// trapezoidal rule (1 − z/2)/(1 + z/2), which is below 0 for z > 2 and tends to −1: forces ring from step to
    /// step for as long as there are steps.
    /// Source: derived here.
    /// Checked by: `tests/all/stability_command.rs::the_lag_of_the_program_does_not_ring`.
    fn left_of_jump(self, z: f64) -> Result<Vec<f64>, MapError> {
        let forces: Vec<f64> = (0..STEPS).map(|k| if k < 3 { 1.0 } else { 0.0 }).collect();
        Ok(self.lagged(z, &forces)?.split_off(3))
    }

    /// Error of the lagged sine, of the exact one.
    fn error_of_sine(self, z: f64) -> Result<f64, MapError> {
        let turn = TAU / f64::from(PERIOD);
        // Periods in which the start is forgotten, then one that is read.
        let forgotten = ((40.0 / z.min(4.0 / z)) / f64::from(PERIOD)).ceil() as u32 + 1;
        let forces: Vec<f64> =
            (0..(forgotten + 1) * PERIOD).map(|k| (turn * f64::from(k)).cos()).collect();
        let all = self.lagged(z, &forces)?;
        let last = all.iter().enumerate().skip((forgotten * PERIOD) as usize);
        let sum: c64 = last.map(|(k, p)| c64::from_polar(*p, -turn * k as f64)).sum();
        let exact = 1.0 / c64::new(1.0, turn / z);
        Ok((2.0 * sum / f64::from(PERIOD) - exact).norm() / exact.norm())
    }
}

fn map() -> Result<StabilityMap, MapError> {
    let mut map = StabilityMap::of(&MAP, "lag of one tooth pair", "log₁₀ of the step over β");
    let panel = "log₁₀ of what is left of a jump after ten steps";
    let steps = || (0..COUNT).map(|k| SHORTEST * 2f64.powf(0.5 * f64::from(k)));
    for rule in [Rule::Trapezoidal, Rule::Parabola] {
        let of = rule.name();
        let rings = |z: f64| -> Result<bool, MapError> {
            let left = rule.left_of_jump(z)?;
            // The parabola passes the jump for two steps; after these, changes of sign are ringing.
            Ok(left[2..].windows(2).any(|pair| pair[0] * pair[1] < -1e-24))
        };
        // 1/(1 + z/2) in the step of the jump, then nine times (1 − z/2)/(1 + z/2)
        let ten = (2.0f64 / 3.0).powi(9) / 6.0;
        let theory = |value: f64| (rule == Rule::Trapezoidal).then_some(value);
        let middle = |low: f64, high: f64| (low * high).sqrt();
        let is_found = |low: f64, high: f64| high / low <= 1.0 + 1e-9;
        let border = bisected([SHORTEST, 1000.0], middle, is_found, rings)?;
        let border = border.map(|[low, high]| middle(low, high));
        map.compare(of, "step over β above which a jump rings", border, theory(2.0));
        let left = |z: f64| -> Result<f64, MapError> {
            Ok(rule.left_of_jump(z)?.get(9).map_or(f64::NAN, |p| p.abs()))
        };
        map.compare(of, "left of a jump after ten steps of 10 β", left(10.0)?, theory(ten));
        for (panel, of_step) in [
            (panel, &left as &dyn Fn(f64) -> _),
            ("log₁₀ of the error of a sine of 14 steps", &|z| rule.error_of_sine(z)),
        ] {
            let points = steps().map(|z| Ok((z, of_step(z)?)));
            let points = points.collect::<Result<Vec<_>, MapError>>()?;
            map.draw(Drawn::Measured, panel, of, logarithms(points, 1e-16));
        }
    }
    // (1 − e^(−z))/z at the end of the step in which the force falls, then e^(−z) in each of nine
    let left = |z: f64| (-(-z).exp_m1() / z).log10() - 9.0 * z * std::f64::consts::LOG10_E;
    let points = steps().map(|z| (z.log10(), left(z).max(-16.0)));
    let name = "exact, for a force that falls evenly over one step";
    map.draw(Drawn::Theory, panel, name, points);
    Ok(map)
}
