//! The cheapest settings for the loaded transmission error at rest.

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use lumped::AnalyticCycle;
use scene::{LoadCase, Scene};

use super::choice::{AutoError, Choice, ErrorPart};
use super::question::{ClosedForm, Question};
use super::search::choose;
use super::settings::{AutoSettings, BodyInertia};

/// Positions of the closed forms: their mean hardly depends on them.
const POSITIONS: u32 = 24;

/// What is read from the transmission error r_b θ of the sun over a mesh cycle at rest.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleValue {
    /// Its largest less its smallest value.
    PeakToPeak,
    /// Its mean.
    Mean,
}

/// The transmission error of a set under its torque.
#[derive(Debug, Clone, Copy)]
pub struct CycleQuestion<'s> {
    /// The set.
    pub scene: &'s Scene,
    /// Its torque.
    pub case: &'s LoadCase,
    /// What is read from its transmission error.
    pub value: CycleValue,
}

/// The transmission error over a mesh cycle, µm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleCurve {
    /// Mean over the positions.
    pub mean: f64,
    /// Highest value less the mean.
    pub above: f64,
    /// Mean less the lowest value.
    pub below: f64,
}

impl CycleCurve {
    fn new(values: &[f64]) -> Self {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let reach = |sign: f64| values.iter().map(|y| sign * (y - mean)).fold(0.0, f64::max);
        Self { mean, above: reach(1.0), below: reach(-1.0) }
    }
}

impl Question for CycleQuestion<'_> {
    type Answer = CycleCurve;

    fn words(&self) -> String {
        let of = match self.value {
            CycleValue::PeakToPeak => "peak-to-peak",
            CycleValue::Mean => "mean",
        };
        format!("{of} transmission error of the sun at rest")
    }

    fn unit(&self) -> &'static str {
        "µm"
    }

    fn settings(&self, level: usize, inertia: BodyInertia) -> AutoSettings {
        AutoSettings::fe_contact(level, inertia).at_positions(self.scene, level)
    }

    fn inertias(&self) -> &'static [BodyInertia] {
        &[BodyInertia::None]
    }

    /// The mean alone: a peak to peak is the small difference of large deflections, and has no stated error.
    fn in_closed_form(&self) -> Result<Option<ClosedForm>, AutoError> {
        if self.value == CycleValue::PeakToPeak {
            return Ok(None);
        }
        let cycle = AnalyticCycle::new(self.scene, self.case)?;
        let positions: Vec<f64> =
            (0..POSITIONS).map(|i| f64::from(i) / f64::from(POSITIONS)).collect();
        let found = cycle.at_rest(&positions)?;
        let parts = cycle.mean_errors(&found);
        let parts = parts.iter().map(|part| ErrorPart::new(part.source, part.share)).collect();
        let values: Vec<f64> = found.iter().map(|own| 1e6 * own.transmission_error).collect();
        Ok(Some((CycleCurve::new(&values).mean, parts)))
    }

    fn answer(&self, settings: &AutoSettings) -> Result<CycleCurve, AutoError> {
        let scene = settings.applied_to(self.scene);
        let bodies = Bodies::new(&scene)?;
        let sun = bodies.geometry.sun.as_ref().ok_or(AutoError::Incomplete("sun"))?;
        let positions = settings.positions.ok_or(AutoError::Incomplete("number of positions"))?;
        let set = StaticSet::new(&scene, &bodies, self.case.sense(), Imperfections::default())?;
        let cycle = set.cycle(self.case.sun_load_nm(), positions as usize, &ActiveSet)?;
        let of = |s: &fe_contact::statics::SetState| 1e6 * s.transmission_error(sun.base_radius);
        Ok(CycleCurve::new(&cycle.states.iter().map(of).collect::<Vec<_>>()))
    }

    fn value(&self, answer: &CycleCurve) -> f64 {
        match self.value {
            CycleValue::PeakToPeak => answer.above + answer.below,
            CycleValue::Mean => answer.mean,
        }
    }

    /// Of a peak to peak what either extreme is another above or below the mean, so that they do not cancel.
    fn distance(&self, coarse: &CycleCurve, fine: &CycleCurve) -> f64 {
        let apart = match self.value {
            CycleValue::PeakToPeak => {
                (coarse.above - fine.above).abs() + (coarse.below - fine.below).abs()
            }
            CycleValue::Mean => (coarse.mean - fine.mean).abs(),
        };
        apart / self.value(fine)
    }
}

/// The cheapest settings whose estimated error is within the tolerance, percent.
///
/// # Errors
/// If FE/contact refuses the scene, or no settings are estimated to be within the tolerance.
pub fn choose_transmission_error(
    question: &CycleQuestion<'_>,
    tolerance_percent: f64,
) -> Result<Choice, AutoError> {
    choose(question, tolerance_percent).map(|(choice, _)| choice)
}
