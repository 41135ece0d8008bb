//! Newton's method for a fixed point of a map of one period.
//!
//! The map is affine as long as the contact pattern is the same, so that one derivative serves several
//! corrections; it is renewed, from the period just marched, where they do not contract. After a correction that does not help, the motion is
//! marched on from where it was for some periods: near a stable solution marching brings the pattern closer.

use super::derivative::{Correction, MapDerivative};
use super::map::PeriodMap;
use crate::error::EigenError;

/// A derivative is renewed unless the last correction has left less than this share of the error.
const KEPT: f64 = 0.1;

/// A correction is taken back if the error afterwards exceeds the error before by this factor.
const WORSE: f64 = 1.5;

/// Corrections taken back, after each of which twice as many periods are marched, until shooting is given up.
const PATIENCE: usize = 4;

/// The error to the periodic solution that is asked for, beside the tolerance on the change from period to
/// period.
const CLOSE: f64 = 0.3;

/// When shooting ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShootingSettings {
    /// Largest change from one period to the next, relative to the peak-to-peak vibration.
    pub tolerance: f64,
    /// Periods marched before the first derivative, in which fast transients decay and the contact pattern settles.
    pub settling: usize,
    /// Periods marched in all after which shooting is given up.
    pub most_periods: usize,
}

/// A periodic solution; the motion stands at the start of a period.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicSolution {
    /// Change of the last period from the one before it, relative to the peak-to-peak vibration.
    pub residual: f64,
    /// Periods marched.
    pub periods: usize,
    /// Derivatives of the map computed.
    pub derivatives: usize,
    /// Errors to the periodic solution as the corrections estimate them, one for each period marched, relative
    /// to the peak-to-peak vibration.
    pub errors: Vec<f64>,
    /// Derivative of the map at the solution.
    pub derivative: MapDerivative,
}

/// Why no periodic solution was found.
#[derive(Debug, thiserror::Error)]
pub enum ShootingError<E> {
    /// A period could not be marched.
    #[error("shooting came to a period that cannot be computed: {0}")]
    Map(#[source] E),
    /// The derivative has entries that are not finite.
    #[error(transparent)]
    Derivative(#[from] EigenError),
    /// Corrections do not approach a solution.
    #[error(
        "shooting does not approach a periodic motion: error {error:.1e} of the vibration after {periods} periods"
    )]
    Stalled {
        /// Periods marched.
        periods: usize,
        /// Last error relative to the peak-to-peak vibration.
        error: f64,
    },
}

/// Finds the periodic solution near the present state of a motion.
///
/// # Errors
/// If the map fails, its derivative is not finite, or the corrections do not approach a solution. The motion
/// then stands at the start of some period.
pub fn shoot<M: PeriodMap + ?Sized>(
    map: &mut M,
    settings: &ShootingSettings,
) -> Result<PeriodicSolution, ShootingError<M::Error>> {
    let mut correction: Option<Correction> = None;
    let mut errors: Vec<f64> = Vec::new();
    let (mut derivatives, mut failures) = (0, 0);
    let mut last = Last { error: f64::INFINITY, before: None };
    let (mut is_closing, mut march_on) = (false, settings.settling);
    while errors.len() < settings.most_periods {
        let start = map.coordinates();
        if let Err(cause) = map.advance() {
            // A correction led to where no step can be taken.
            let Some(before) = last.before.take() else {
                return Err(ShootingError::Map(cause));
            };
            failures += 1;
            errors.push(f64::INFINITY);
            if failures > PATIENCE {
                return Err(ShootingError::Map(cause));
            }
            map.set_coordinates(&before).map_err(ShootingError::Map)?;
            (march_on, correction, is_closing) = (1 << failures, None, false);
            last.error = f64::INFINITY;
            continue;
        }
        if march_on > 0 {
            march_on -= 1;
            errors.push(f64::NAN);
            continue;
        }
        let end = map.coordinates();
        let residual: Vec<f64> = end.iter().zip(&start).map(|(e, s)| e - s).collect();
        let mut step = correction.as_ref().map(|own| Step::new(map, own, &residual));
        if is_closing && map.change() <= settings.tolerance {
            derivatives += 1;
            return Ok(PeriodicSolution {
                residual: map.change(),
                periods: errors.len() + 1,
                derivatives,
                errors: errors.into_iter().chain(step.map(|step| step.error)).collect(),
                derivative: map.derivative().map_err(ShootingError::Map)?,
            });
        }
        // NaN is not contracted.
        let contracts = |step: &Step| {
            step.error <= KEPT * last.error || step.error <= CLOSE * settings.tolerance
        };
        if !step.as_ref().is_some_and(contracts) {
            derivatives += 1;
            let own = map.derivative().map_err(ShootingError::Map)?.correction()?;
            step = Some(Step::new(map, &own, &residual));
            correction = Some(own);
        }
        let Some(Step { change, error }) = step else { continue };
        errors.push(error);
        if error <= CLOSE * settings.tolerance {
            // One more period shows the change from period to period and the derivative there.
            is_closing = true;
            last = Last { error, before: None };
            continue;
        }
        is_closing = false;
        let is_worse = error.is_nan() || error > WORSE * last.error;
        if let Some(before) = last.before.take().filter(|_| is_worse) {
            failures += 1;
            if failures > PATIENCE {
                return Err(ShootingError::Stalled { periods: errors.len(), error });
            }
            map.set_coordinates(&before).map_err(ShootingError::Map)?;
            (march_on, correction) = (1 << failures, None);
            last.error = f64::INFINITY;
            continue;
        }
        let next: Vec<f64> = start.iter().zip(&change).map(|(s, c)| s + c).collect();
        last = Last { error, before: Some(end) };
        map.set_coordinates(&next).map_err(ShootingError::Map)?;
    }
    let (periods, error) = (errors.len(), errors.last().copied().unwrap_or(f64::NAN));
    Err(ShootingError::Stalled { periods, error })
}

/// A correction from the start of a period.
struct Step {
    /// y* − y(0).
    change: Vec<f64>,
    /// Size of y* − y(T), relative to the peak-to-peak vibration.
    error: f64,
}

impl Step {
    fn new<M: PeriodMap + ?Sized>(map: &M, own: &Correction, residual: &[f64]) -> Self {
        let change = own.of(residual);
        let left: Vec<f64> = change.iter().zip(residual).map(|(c, r)| c - r).collect();
        Self { error: map.relative(&left), change }
    }
}

/// The last correction.
struct Last {
    /// Error before it.
    error: f64,
    /// Coordinates at the end of the period before it, if they were replaced.
    before: Option<Vec<f64>>,
}
