//! Newton's method for a fixed point of a map of one period.
//!
//! The map is affine as long as the contact pattern is the same, so that one derivative serves several
//! corrections; it is renewed, from the period just marched, where they do not contract. A correction that makes
//! the error larger is taken in part; where no part helps, the motion is marched on
//! from where it was for some periods: near a stable solution marching brings the pattern closer.

use super::derivative::{Correction, MapDerivative};
use super::map::PeriodMap;
use crate::error::EigenError;

/// A derivative is renewed unless the last correction has left less than this share of the error.
const KEPT: f64 = 0.1;

/// A correction is taken back if the error afterwards exceeds the error before by this factor.
const WORSE: f64 = 1.5;

/// A correction that was taken back is divided by this; the next one after it may be longer by this factor.
const LONGER: f64 = 4.0;

/// Least part of a correction that is taken before it is given up.
const LEAST: f64 = 1.0 / 64.0;

/// Corrections given up, after each of which twice as many periods are marched, until shooting is given up.
const PATIENCE: usize = 4;

/// Error to the periodic solution, as a share of the tolerance on the change from period to period, that needs no
/// further correction: between two ends of a period as close as this is a change of at most twice of it.
const CLOSE: f64 = 0.15;

/// Largest error to the periodic solution in the last period, in tolerances on the change from period to period. Where
/// perturbations hardly decay, a small change does not mean a small error. At a change of 1e-9 of the vibration it is a
/// hundredth of the 1e-6 to which shooting and marching are compared.
const MOST_ERROR: f64 = 10.0;

/// When shooting ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShootingSettings {
    /// Largest change from one period to the next, relative to the peak-to-peak vibration.
    pub tolerance: f64,
    /// Periods marched before the first derivative, in which fast transients decay and the contact pattern settles.
    /// They are spared where a correction from the end of the first of them contracts.
    pub settling: usize,
    /// Periods marched in all after which shooting is given up.
    pub most_periods: usize,
}

/// A periodic solution; the motion stands at the start of a period.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicSolution {
    /// Change from the last period to the one that follows it, to first order, relative to the peak-to-peak vibration.
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
/// `[eq:rough-derivatives]` Corrections by a derivative D' near D leave (I − D)⁻¹ (D' − D) of an error: single
/// precision suffices for them.
/// Source: Kelley, SIAM Review 64 (2022).
/// Checked by: `experiments/tests/shooting/derivative.rs::the_rough_derivative_leaves_little_of_an_error`,
/// `dynamics/tests/periodic.rs::corrections_by_rough_derivatives_lead_to_the_solution`.
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
    let mut last: Option<Taken> = None;
    let mut march_on = 0;
    // Whether no correction was judged yet, so that the first period may turn out to be one of those that settle.
    let mut may_settle = settings.settling > 0;
    // Corrections may use rough derivatives until the first correction of one does not contract, or shows an end that
    // the exact one does not confirm.
    let (mut may_be_rough, mut is_new) = (true, false);
    // Whether the last period ended close to the solution.
    let mut is_close = false;
    while errors.len() < settings.most_periods {
        let start = map.coordinates();
        if let Err(cause) = map.advance() {
            // A correction led to where no step can be taken.
            errors.push(f64::INFINITY);
            let Some(taken) = last.take() else { return Err(ShootingError::Map(cause)) };
            if std::mem::take(&mut may_settle) {
                // It was made too early.
                map.set_coordinates(&taken.end).map_err(ShootingError::Map)?;
                (correction, is_new, march_on) = (None, false, settings.settling - 1);
                continue;
            }
            last = retry(map, taken, &mut failures, &mut march_on)
                .map_err(|other| ShootingError::Map(other.unwrap_or(cause)))?;
            (correction, may_be_rough) = (None, false);
            continue;
        }
        if march_on > 0 {
            march_on -= 1;
            errors.push(f64::NAN);
            continue;
        }
        let end = map.coordinates();
        let residual: Vec<f64> = end.iter().zip(&start).map(|(e, s)| e - s).collect();
        let step = correction.as_ref().map(|own| Step::new(map, own, &residual));
        let close = CLOSE * settings.tolerance;
        let returns = map.relative(&residual) <= 2.0 * close;
        let may_be_last = |step: &Step| {
            let error = step.error.max(step.error_at_start);
            returns && error <= MOST_ERROR * settings.tolerance
        };
        // NaN is not contracted.
        let before = last.as_ref().map_or(f64::INFINITY, |taken| taken.error_by(map));
        let is_whole = last.as_ref().is_none_or(|taken| taken.fraction == 1.0);
        let contracts = |step: &Step| {
            (is_whole && step.error <= KEPT * before) || step.error <= close || may_be_last(step)
        };
        if let Some(taken) = last.take_if(|_| std::mem::take(&mut may_settle)) {
            if step.as_ref().is_some_and(contracts) {
                last = Some(taken);
            } else {
                errors.push(step.map_or(f64::NAN, |step| step.error));
                map.set_coordinates(&taken.end).map_err(ShootingError::Map)?;
                (correction, is_new, march_on) = (None, false, settings.settling - 1);
                continue;
            }
        }
        let mut step = match step.filter(contracts) {
            Some(step) => {
                is_new = false;
                step
            }
            None => {
                derivatives += 1;
                may_be_rough &= !is_new;
                is_new = true;
                let own = if may_be_rough { map.rough_derivative() } else { map.derivative() };
                let own = own.map_err(ShootingError::Map)?.correction()?;
                let step = Step::new(map, &own, &residual);
                correction = Some(own);
                step
            }
        };
        let was_close = std::mem::replace(&mut is_close, step.error <= close);
        if may_be_last(&step) {
            derivatives += 1;
            let (derivative, change) =
                map.derivative_and_change(&residual).map_err(ShootingError::Map)?;
            if change <= settings.tolerance {
                errors.push(step.error);
                let periods = errors.len();
                let residual = change;
                return Ok(PeriodicSolution { residual, periods, derivatives, errors, derivative });
            }
            let own = derivative.correction()?;
            step = Step::new(map, &own, &residual);
            (correction, is_new, may_be_rough) = (Some(own), true, false);
        } else if is_close && was_close && may_be_rough {
            // The period before ended as close, and yet this one did not begin there.
            derivatives += 1;
            let own = map.derivative().map_err(ShootingError::Map)?.correction()?;
            step = Step::new(map, &own, &residual);
            (correction, is_new, may_be_rough) = (Some(own), true, false);
        }
        errors.push(step.error);
        if step.error <= close {
            // The next period begins close to the solution.
            (last, may_settle) = (None, false);
            continue;
        }
        let is_worse = step.error.is_nan() || step.error > WORSE * before;
        let fraction = match last.take() {
            Some(taken) if is_worse => {
                let error = step.error;
                last = retry(map, taken, &mut failures, &mut march_on).map_err(
                    |cause| match cause {
                        Some(cause) => ShootingError::Map(cause),
                        None => ShootingError::Stalled { periods: errors.len(), error },
                    },
                )?;
                (correction, may_be_rough) = (None, false);
                continue;
            }
            Some(taken) => (LONGER * taken.fraction).min(1.0),
            None => 1.0,
        };
        let Step { change, left, .. } = step;
        let taken = Taken { start, end, change, left, fraction };
        map.set_coordinates(&taken.next()).map_err(ShootingError::Map)?;
        last = Some(taken);
    }
    let (periods, error) = (errors.len(), errors.last().copied().unwrap_or(f64::NAN));
    Err(ShootingError::Stalled { periods, error })
}

/// After a correction that did not help: a smaller part of it, if that is not too small; otherwise the state before
/// it, from which some periods are marched.
///
/// # Errors
/// If the map refuses the coordinates; `None` if patience is at its end.
fn retry<M: PeriodMap + ?Sized>(
    map: &mut M,
    taken: Taken,
    failures: &mut usize,
    march_on: &mut usize,
) -> Result<Option<Taken>, Option<M::Error>> {
    let shorter = Taken { fraction: taken.fraction / LONGER, ..taken };
    if shorter.fraction >= LEAST {
        map.set_coordinates(&shorter.next()).map_err(Some)?;
        return Ok(Some(shorter));
    }
    *failures += 1;
    if *failures > PATIENCE {
        return Err(None);
    }
    map.set_coordinates(&shorter.end).map_err(Some)?;
    *march_on = 1 << *failures;
    Ok(None)
}

/// A correction from the start of a period.
struct Step {
    /// y* − y(0).
    change: Vec<f64>,
    /// y* − y(T).
    left: Vec<f64>,
    /// Sizes of y* − y(T) and of y* − y(0), relative to the peak-to-peak vibration.
    error: f64,
    error_at_start: f64,
}

impl Step {
    fn new<M: PeriodMap + ?Sized>(map: &M, own: &Correction, residual: &[f64]) -> Self {
        let change = own.of(residual);
        let left: Vec<f64> = change.iter().zip(residual).map(|(c, r)| c - r).collect();
        let (error, error_at_start) = (map.relative(&left), map.relative(&change));
        Self { error, error_at_start, change, left }
    }
}

/// A correction, or a part of it, that was taken.
struct Taken {
    /// Start and end of the period from which it was made.
    start: Vec<f64>,
    end: Vec<f64>,
    /// The whole correction y* − y(0).
    change: Vec<f64>,
    /// y* − y(T).
    left: Vec<f64>,
    /// The part of it that was taken.
    fraction: f64,
}

impl Taken {
    /// Coordinates after it.
    fn next(&self) -> Vec<f64> {
        self.start.iter().zip(&self.change).map(|(s, c)| s + self.fraction * c).collect()
    }

    /// The error before it, relative to the vibration over the period marched since.
    fn error_by<M: PeriodMap + ?Sized>(&self, map: &M) -> f64 {
        map.relative(&self.left)
    }
}
