//! Candidates as they are tried: chosen, or passed over with the reason.

use super::choice::{AutoError, Choice, ErrorPart, PassedOver, Together};
use super::settings::AutoSettings;

/// The candidates tried for one quantity and tolerance.
#[derive(Debug)]
pub(super) struct Trial {
    /// The quantity, in words.
    quantity: String,
    /// Unit of its value.
    unit: &'static str,
    tolerance_percent: f64,
    passed_over: Vec<PassedOver>,
    /// Whether any candidate has the quantity.
    has_answer: bool,
}

impl Trial {
    /// None tried yet.
    ///
    /// # Errors
    /// If the tolerance is none.
    pub(super) fn new(
        quantity: String,
        unit: &'static str,
        tolerance_percent: f64,
    ) -> Result<Self, AutoError> {
        match tolerance_percent > 0.0 && tolerance_percent <= 100.0 {
            true => Ok(Self {
                quantity,
                unit,
                tolerance_percent,
                passed_over: Vec::new(),
                has_answer: false,
            }),
            false => Err(AutoError::Tolerance(tolerance_percent)),
        }
    }

    /// Whether settings are worth a run by the error that is expected of them, percent.
    pub(super) fn is_expected(&mut self, settings: AutoSettings, expected: f64) -> bool {
        let is = expected <= self.tolerance_percent;
        if !is && expected.is_finite() {
            // An estimate comes from an answer on other settings.
            self.has_answer = true;
            let why = format!("not run: {} % or more expected", shown(expected));
            self.pass(settings, Some(expected), why);
        } else if !is {
            self.pass(settings, None, "not run: no bound of its error, as above".into());
        }
        is
    }

    /// The choice, if the parts of its error, taken together, are within the tolerance; `no_bound` says why where one of them is infinite.
    pub(super) fn judged(
        &mut self,
        settings: AutoSettings,
        value: f64,
        parts: Vec<ErrorPart>,
        together: Together,
        no_bound: impl Fn() -> String,
    ) -> Option<Choice> {
        self.has_answer = true;
        let error = together.of(&parts);
        if error.is_infinite() {
            self.pass(settings, None, format!("no bound of its error: {}", no_bound()));
            return None;
        }
        // NaN is within nothing.
        let is_within = error <= self.tolerance_percent;
        if !is_within {
            let largest = parts.iter().max_by(|a, b| a.percent.total_cmp(&b.percent));
            let of = largest.map_or(String::new(), |p| {
                format!(", {} % of it from {}", shown(p.percent), p.source)
            });
            self.pass(settings, Some(error), format!("estimated error {} %{of}", shown(error)));
            return None;
        }
        Some(Choice {
            quantity: self.quantity.clone(),
            value,
            unit: self.unit.into(),
            tolerance_percent: self.tolerance_percent,
            estimated_error_percent: error,
            error_parts: parts,
            corrections: Vec::new(),
            settings,
            passed_over: Vec::new(),
        })
    }

    /// Settings that gave no answer.
    pub(super) fn refused(&mut self, settings: AutoSettings, why: impl ToString) {
        self.pass(settings, None, why.to_string());
    }

    fn pass(&mut self, settings: AutoSettings, estimated_error_percent: Option<f64>, why: String) {
        self.passed_over.push(PassedOver { settings, estimated_error_percent, why });
    }

    /// A choice with all that was passed over before it.
    pub(super) fn with(self, choice: Choice) -> Choice {
        Choice { passed_over: self.passed_over, ..choice }
    }

    /// Why nothing was chosen: no candidate has the quantity, or none is within the tolerance.
    pub(super) fn refusal(self) -> AutoError {
        let Self { quantity, tolerance_percent, passed_over, has_answer, .. } = self;
        match has_answer {
            true => AutoError::NothingMeets { quantity, tolerance_percent, passed_over },
            false => AutoError::NoAnswer { quantity, passed_over },
        }
    }

    /// One or the other.
    ///
    /// # Errors
    /// As [`refusal`](Self::refusal), if nothing was found.
    pub(super) fn ended(self, found: Option<Choice>) -> Result<Choice, AutoError> {
        match found {
            Some(choice) => Ok(self.with(choice)),
            None => Err(self.refusal()),
        }
    }
}

/// Percent with two significant digits.
fn shown(percent: f64) -> String {
    let decimals = (1 - percent.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    format!("{percent:.decimals$}")
}
