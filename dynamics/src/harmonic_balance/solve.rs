//! Periodic motions with as many harmonics as their spectrum needs.

use super::equations::BalanceEquations;
use super::error::BalanceError;
use super::motion::{BalancedMotion, tail};
use super::newton::{Solved, solve};
use super::options::BalanceOptions;
use super::problem::HarmonicBalance;
use crate::coupled::CouplingForce;

/// Added damping over frequency at which continuation starts, and below which it is taken away.
const DAMPED: [f64; 2] = [10.0, 1e-4];

/// Share to which one stage reduces the added damping, at first and at most.
const REDUCED: [f64; 2] = [0.3, 0.95];

/// Relative correction at which a stage with added damping ends.
const ON_THE_WAY: f64 = 1e-6;

impl<L: CouplingForce> HarmonicBalance<L> {
    /// A periodic motion at a fundamental frequency, rad/s.
    ///
    /// `start`: unknowns of a motion nearby, with any number of harmonics, at least the means of the coordinates;
    /// without it the iteration starts from equilibrium under the mean load. If Newton's method fails from there,
    /// damping in proportion to mass is added until vibration almost vanishes, and then taken away step by step: of
    /// several motions this finds the one that is connected to equilibrium, usually the least.
    ///
    /// # Errors
    /// If the input is out of range, there is no equilibrium, the linear part is at an undamped resonance, the
    /// iteration does not converge, or the spectrum does not decay within the harmonics allowed.
    pub fn solve(
        &self,
        frequency: f64,
        start: Option<&[f64]>,
        options: &BalanceOptions,
    ) -> Result<BalancedMotion, BalanceError> {
        for (what, value) in [("the tail", options.tail), ("the correction", options.correction)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(BalanceError::Value { what, value });
            }
        }
        let most = options.most_harmonics.min(self.most_harmonics());
        let mut harmonics = options.first_harmonics.max(1);
        if harmonics > most {
            return Err(BalanceError::Samples { harmonics, samples: self.steps_per_cycle() });
        }
        let mut y = match start {
            Some(y) if y.len() >= self.count() => y.to_vec(),
            Some(y) => {
                let (what, got) = ("the start", y.len());
                return Err(BalanceError::Size { what, got, wanted: self.count() });
            }
            None => self.mean_equilibrium()?,
        };
        let mut iterations = 0;
        loop {
            let equations = self.equations(frequency, harmonics)?;
            y.resize(equations.dimension(), 0.0);
            let solved = self.globalised(&equations, &y, options)?;
            iterations += solved.iterations;
            let [coordinates, deflections, forces] = equations.series(&solved.unknowns)?;
            let tail = tail(&deflections, harmonics);
            if tail <= options.tail {
                return Ok(BalancedMotion {
                    frequency,
                    harmonics,
                    coordinates,
                    deflections,
                    forces,
                    unknowns: solved.unknowns,
                    iterations,
                    corrections: solved.corrections,
                    residual: solved.residual,
                    tail,
                });
            }
            if harmonics == most {
                let tolerance = options.tail;
                return Err(BalanceError::Tail { harmonics, tail, tolerance });
            }
            harmonics = (harmonics + harmonics / 2 + 1).min(most);
            y = solved.unknowns;
        }
    }

    /// Newton's method from y; if it fails, with damping added and taken away again.
    fn globalised(
        &self,
        equations: &BalanceEquations<'_, L>,
        y: &[f64],
        options: &BalanceOptions,
    ) -> Result<Solved, BalanceError> {
        let (limit, most) = (options.correction, options.most_iterations);
        let mut spent = match solve(equations, y, limit, most, 0.0) {
            Err(BalanceError::NotConverged { iterations, .. }) => iterations,
            other => return other,
        };
        let (frequency, harmonics) = (equations.frequency(), equations.harmonics());
        let [mut added, least] = DAMPED.map(|d| d * frequency);
        let [mut share, most_share] = REDUCED;
        // The means of the start, without vibration.
        let mut from = y[..self.count()].to_vec();
        from.resize(equations.dimension(), 0.0);
        let mut reached = f64::INFINITY;
        loop {
            let stage = if added == 0.0 {
                solve(equations, &from, limit, most, added)
            } else {
                let damped = BalanceEquations::new(self, frequency, harmonics, added)?;
                solve(&damped, &from, limit.max(ON_THE_WAY), most, added)
            };
            match stage {
                Ok(mut solved) => {
                    spent += solved.iterations;
                    if added == 0.0 {
                        solved.iterations = spent;
                        return Ok(solved);
                    }
                    (from, reached) = (solved.unknowns, added);
                }
                Err(BalanceError::NotConverged { iterations, correction, .. }) => {
                    spent += iterations;
                    share = share.sqrt();
                    if reached.is_infinite() || share > most_share {
                        let (iterations, added_damping) = (spent, reached.min(added));
                        return Err(BalanceError::NotConverged {
                            harmonics,
                            frequency,
                            iterations,
                            correction,
                            added_damping,
                        });
                    }
                }
                Err(other) => return Err(other),
            }
            added = if reached * share < least { 0.0 } else { reached * share };
        }
    }
}
