//! What is asked: a quantity that settings are chosen for.

use super::choice::{AutoError, ErrorPart};
use super::settings::{AutoSettings, BodyInertia};

/// An answer in closed form: the value in the unit of the question, and its stated errors.
pub type ClosedForm = (f64, Vec<ErrorPart>);

/// A quantity of a scene under its load.
pub trait Question {
    /// What settings give: the value and all that two settings are compared by.
    type Answer;

    /// The quantity, in words.
    fn words(&self) -> String;

    /// Unit of its value.
    fn unit(&self) -> &'static str;

    /// Settings with the discretisation of a level (0 is the coarsest) and a way to take the inertia of the bodies
    /// into account.
    fn settings(&self, level: usize, inertia: BodyInertia) -> AutoSettings;

    /// Ways to take the inertia of the bodies into account, from cheap to dear; one alone where it has no part.
    fn inertias(&self) -> &'static [BodyInertia];

    /// The answer of the lumped model with parameters in closed form; `None` where these give the quantity without a
    /// stated error.
    ///
    /// # Errors
    /// If the closed forms do not hold for the scene.
    fn in_closed_form(&self) -> Result<Option<ClosedForm>, AutoError>;

    /// The answer with some settings.
    ///
    /// # Errors
    /// If the settings are refused, or the set has no such quantity.
    fn answer(&self, settings: &AutoSettings) -> Result<Self::Answer, AutoError>;

    /// The same, for a comparison of two ways to take the inertia of the bodies into account: `known` is the answer
    /// of another way on the same discretisation.
    ///
    /// # Errors
    /// As [`answer`](Self::answer).
    fn answer_beside(
        &self,
        settings: &AutoSettings,
        known: &Self::Answer,
    ) -> Result<Self::Answer, AutoError> {
        let _ = known;
        self.answer(settings)
    }

    /// Value of an answer.
    fn value(&self, answer: &Self::Answer) -> f64;

    /// Distance between two answers, of the value of the second: at least the difference of their values.
    fn distance(&self, coarse: &Self::Answer, fine: &Self::Answer) -> f64;
}
