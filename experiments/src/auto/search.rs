//! The search along both axes: discretisation, and inertia of the bodies behind the teeth.

use dynamics::error_by_distances;

use super::choice::{AutoError, Choice, ErrorPart, PassedOver, total};
use super::question::Question;
use super::settings::{AutoSettings, BodyInertia, FLANK_ELEMENTS, LEVELS};

/// Order of convergence that is believed at most: that of positions and steps at the corners of a curve, where tooth
/// pairs begin and end to touch, the lowest of all that are refined together.
const FORMAL_ORDER: f64 = 1.0;

/// Refinements of two ways to take inertia into account, which have no order of convergence: their difference is
/// taken three times.
const WITHOUT_ORDER: [f64; 2] = [1.0, 2.0];

const DISCRETISATION: &str = "finite elements, contact cells and steps";
const INERTIA: &str = "inertia of the bodies behind the teeth";

/// The cheapest settings whose estimated error is within the tolerance, percent, with the answer; no answer of
/// FE/contact where closed forms are enough.
///
/// # Errors
/// If no settings give the quantity, or none is estimated to be within the tolerance.
pub(super) fn choose<Q: Question>(
    question: &Q,
    tolerance_percent: f64,
) -> Result<(Choice, Option<Q::Answer>), AutoError> {
    // NaN is within nothing.
    if !(tolerance_percent > 0.0 && tolerance_percent <= 100.0) {
        return Err(AutoError::Tolerance(tolerance_percent));
    }
    let mut search = Search { question, tolerance_percent, passed_over: Vec::new() };
    match search.in_closed_form() {
        Some(choice) => Ok((choice, None)),
        None => search.by_fe_contact().map(|(choice, answer)| (choice, Some(answer))),
    }
}

struct Search<'q, Q: Question> {
    question: &'q Q,
    tolerance_percent: f64,
    passed_over: Vec<PassedOver>,
}

impl<Q: Question> Search<'_, Q> {
    fn pass(&mut self, settings: AutoSettings, error: Option<f64>, why: String) {
        self.passed_over.push(PassedOver { settings, estimated_error_percent: error, why });
    }

    fn in_closed_form(&mut self) -> Option<Choice> {
        match self.question.in_closed_form() {
            Ok(Some((value, parts))) => self.judged(AutoSettings::LUMPED, value, parts),
            Ok(None) => None,
            Err(e) => {
                self.pass(AutoSettings::LUMPED, None, e.to_string());
                None
            }
        }
    }

    fn by_fe_contact(mut self) -> Result<(Choice, Q::Answer), AutoError> {
        // Answers without inertia by level, coarse to fine, each with the next finer one.
        let mut answers: Vec<(usize, Q::Answer)> = Vec::new();
        let mut inertia = InertiaAxis { answers: Vec::new(), level: 0 };
        for level in 0..LEVELS {
            let settings = self.question.settings(level, BodyInertia::None);
            match self.question.answer(&settings) {
                Ok(answer) => answers.push((level, answer)),
                Err(e) => {
                    self.pass(settings, None, e.to_string());
                    answers.clear();
                    continue;
                }
            }
            if answers.len() < 2 {
                self.pass(settings, None, "the first answer, to compare finer ones with".into());
                continue;
            }
            let discretised = self.of_discretisation(&answers);
            let part = ErrorPart::new(DISCRETISATION, discretised);
            inertia.level = answers[0].0;
            for way in 0..self.question.inertias().len() {
                // Bodies with modes cost much: not where elements and steps alone are too coarse.
                let is_fine = part.percent <= self.tolerance_percent;
                let left = if is_fine {
                    inertia.error(self.question, &answers[0].1, way)
                } else {
                    Ok(0.0)
                };
                let settings = self.question.settings(level, self.question.inertias()[way]);
                let parts = match left {
                    Ok(left) => vec![part.clone(), ErrorPart::new(INERTIA, left)],
                    Err(why) => {
                        self.pass(settings, None, why);
                        continue;
                    }
                };
                let finest = answers.last().map(|(_, answer)| self.question.value(answer));
                let value = finest.unwrap_or(f64::NAN);
                let Some(mut choice) = self.judged(settings, value, parts) else {
                    if is_fine { continue } else { break }
                };
                if way == 0
                    && let Some((_, answer)) = answers.pop()
                {
                    return Ok((choice, answer));
                }
                match self.question.answer(&settings) {
                    Ok(answer) => {
                        choice.value = self.question.value(&answer);
                        return Ok((choice, answer));
                    }
                    Err(e) => {
                        self.passed_over = choice.passed_over;
                        self.pass(settings, None, e.to_string());
                    }
                }
            }
        }
        Err(self.refusal())
    }

    /// Estimated error of the finest of some answers by their distances, of its value.
    fn of_discretisation(&self, answers: &[(usize, Q::Answer)]) -> f64 {
        let between = |pair: &[(usize, Q::Answer)]| self.question.distance(&pair[0].1, &pair[1].1);
        let distances: Vec<f64> = answers.windows(2).map(between).collect();
        let refinements = answers.iter().map(|(level, _)| f64::from(FLANK_ELEMENTS[*level]));
        error_by_distances(&distances, &refinements.collect::<Vec<_>>(), Some(FORMAL_ORDER))
    }

    /// The choice, if the sum of the parts of its error is within the tolerance.
    fn judged(
        &mut self,
        settings: AutoSettings,
        value: f64,
        error_parts: Vec<ErrorPart>,
    ) -> Option<Choice> {
        let error = total(&error_parts);
        if error <= self.tolerance_percent {
            return Some(Choice {
                quantity: self.question.words(),
                value,
                unit: self.question.unit().into(),
                tolerance_percent: self.tolerance_percent,
                estimated_error_percent: error,
                error_parts,
                settings,
                passed_over: std::mem::take(&mut self.passed_over),
            });
        }
        let largest = error_parts.iter().max_by(|a, b| a.percent.total_cmp(&b.percent));
        let source = largest.map_or("", |part| part.source.as_str());
        let (estimate, why) = match (error.is_finite(), largest) {
            (true, Some(part)) => {
                let [all, most] = [error, part.percent].map(shown);
                (Some(error), format!("estimated error {all} %, {most} % of it from {source}"))
            }
            _ => (None, format!("no bound of its error, from {source}")),
        };
        self.pass(settings, estimate, why);
        None
    }

    /// Why nothing was chosen: no candidate has the quantity, or none is within the tolerance.
    fn refusal(self) -> AutoError {
        let Self { question, tolerance_percent, passed_over } = self;
        let quantity = question.words();
        match passed_over.iter().any(|own| own.estimated_error_percent.is_some()) {
            true => AutoError::NothingMeets { quantity, tolerance_percent, passed_over },
            false => AutoError::NoAnswer { quantity, passed_over },
        }
    }
}

/// Answers with each way to take the inertia of the bodies into account, on the coarsest discretisation that has an
/// answer.
struct InertiaAxis<A> {
    /// By way from the second on, as far as it was asked for: the first is on the axis of discretisations.
    answers: Vec<Result<A, String>>,
    level: usize,
}

impl<A> InertiaAxis<A> {
    /// Estimated error of a way: three times its distance to the next dearer one that gives an answer.
    fn error<Q: Question<Answer = A>>(
        &mut self,
        question: &Q,
        first: &A,
        way: usize,
    ) -> Result<f64, String> {
        let ways = question.inertias();
        if ways.len() == 1 {
            return Ok(0.0);
        }
        for next in way + 1..ways.len() {
            while self.answers.len() < next {
                let settings = question.settings(self.level, ways[self.answers.len() + 1]);
                let found = question.answer_beside(&settings, first);
                self.answers.push(found.map_err(|e| e.to_string()));
            }
            let own = match way {
                0 => first,
                _ => self.answers[way - 1].as_ref().map_err(Clone::clone)?,
            };
            if let Ok(dearer) = &self.answers[next - 1] {
                let distance = question.distance(own, dearer);
                return Ok(error_by_distances(&[distance], &WITHOUT_ORDER, None));
            }
        }
        let last = self.answers.last().and_then(|own| own.as_ref().err()).cloned();
        Err(last.unwrap_or_else(|| "no dearer inertia to compare it with".into()))
    }
}

/// Percent with two significant digits.
fn shown(percent: f64) -> String {
    let decimals = (1 - percent.abs().max(1e-9).log10().floor() as i32).clamp(0, 6) as usize;
    format!("{percent:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::super::question::ClosedForm;
    use super::*;

    /// 1 + ε/n² on n elements, times 1 + c of the inertia that quasi-static bodies lack, of which first order leaves
    /// a tenth.
    struct Known {
        discretised: f64,
        inertia: f64,
        /// Stated error of a closed form.
        stated: Option<f64>,
        /// Levels that are refused.
        refused: usize,
    }

    impl Question for Known {
        type Answer = f64;
        fn words(&self) -> String {
            "a known value".into()
        }
        fn unit(&self) -> &'static str {
            "1"
        }
        fn settings(&self, level: usize, inertia: BodyInertia) -> AutoSettings {
            AutoSettings::fe_contact(level, inertia)
        }
        fn inertias(&self) -> &'static [BodyInertia] {
            &[BodyInertia::None, BodyInertia::FirstOrder, BodyInertia::Modes(12)]
        }
        fn in_closed_form(&self) -> Result<Option<ClosedForm>, AutoError> {
            Ok(self.stated.map(|share| (1.0, vec![ErrorPart::new("closed form", share)])))
        }
        fn answer(&self, settings: &AutoSettings) -> Result<f64, AutoError> {
            let n = settings.flank_elements.unwrap();
            if n < FLANK_ELEMENTS[self.refused] {
                return Err(AutoError::Incomplete("cells"));
            }
            let lacking = match (settings.modes, settings.elastic_inertia) {
                (Some(_), _) => 0.0,
                (None, true) => 0.1 * self.inertia,
                (None, false) => self.inertia,
            };
            Ok((1.0 + self.discretised / f64::from(n * n)) * (1.0 + lacking))
        }
        fn value(&self, answer: &f64) -> f64 {
            *answer
        }
        fn distance(&self, coarse: &f64, fine: &f64) -> f64 {
            (coarse / fine - 1.0).abs()
        }
    }

    const PLAIN: Known = Known { discretised: 0.5, inertia: 0.0, stated: None, refused: 0 };

    #[test]
    fn the_estimate_holds_and_finer_settings_are_chosen_for_smaller_tolerances() {
        let mut last = 0;
        for tolerance in [10.0, 3.0, 1.0] {
            let (choice, answer) = choose(&PLAIN, tolerance).unwrap();
            let error = 100.0 * (choice.value - 1.0).abs();
            assert!(error <= choice.estimated_error_percent, "{tolerance}: {error}");
            assert!(choice.estimated_error_percent <= tolerance);
            assert_eq!(answer, Some(choice.value));
            assert!(choice.settings.flank_elements.unwrap() >= last);
            last = choice.settings.flank_elements.unwrap();
        }
        assert_eq!(last, FLANK_ELEMENTS[LEVELS - 1]);
        assert!(matches!(choose(&PLAIN, 0.01), Err(AutoError::NothingMeets { .. })));
        for bad in [0.0, -1.0, f64::NAN, 101.0] {
            assert!(matches!(choose(&PLAIN, bad), Err(AutoError::Tolerance(_))));
        }
    }

    /// What inertia changes is added where leaving it out is too much, by the cheapest way that is known well enough.
    #[test]
    fn inertia_is_added_where_the_tolerance_needs_it() {
        let heavy = Known { inertia: 0.02, ..PLAIN };
        let chosen = |tolerance| choose(&heavy, tolerance).map(|(choice, _)| choice);
        let loose = chosen(10.0).unwrap();
        assert!(!loose.settings.elastic_inertia && loose.settings.modes.is_none());
        let tight = chosen(3.0).unwrap();
        assert!(tight.settings.elastic_inertia, "{}", tight.settings);
        for choice in [loose, tight] {
            let error = 100.0 * (choice.value - 1.0).abs();
            assert!(error <= choice.estimated_error_percent, "{}: {error}", choice.settings);
        }
        // First order leaves 0.2 %, and three times that is told; of twelve modes nothing is known.
        assert!(chosen(0.5).is_err());
    }

    #[test]
    fn closed_forms_answer_within_their_stated_error_and_refused_meshes_are_passed_over() {
        let stated = Known { stated: Some(0.04), refused: 1, ..PLAIN };
        let (choice, answer) = choose(&stated, 5.0).unwrap();
        assert_eq!((choice.settings, answer), (AutoSettings::LUMPED, None));
        let (choice, _) = choose(&stated, 3.0).unwrap();
        assert_eq!(choice.settings.flank_elements, Some(FLANK_ELEMENTS[2]));
        let why: Vec<&str> = choice.passed_over.iter().map(|own| own.why.as_str()).collect();
        assert_eq!(
            why,
            [
                "estimated error 4.0 %, 4.0 % of it from closed form",
                "the scene has no cells",
                "the first answer, to compare finer ones with"
            ]
        );
        let none = Known { refused: 2, ..PLAIN };
        let refusal = choose(&none, 5.0).unwrap_err();
        assert!(matches!(refusal, AutoError::NoAnswer { .. }), "{refusal}");
    }
}
