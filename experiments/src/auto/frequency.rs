//! The cheapest settings for a natural frequency.

use fe_contact::statics::Bodies;
use gearset::{AutoModeType, LoadCase, Scene};
use lumped::ModeType;

use super::analytic_mode::AnalyticMode;
use super::choice::{AutoError, Choice, Correction, ErrorPart, Together, total};
use super::elastic_change::ElasticChange;
use super::energy::{ModeEnergy, mixed, of_linear};
use super::error_parts::SetSize;
use super::settings::{AutoModel, AutoSettings};
use super::trial::Trial;
use crate::error::ExperimentError;
use crate::modal::{Preload, preloaded};

/// A natural frequency about the load at position 0 of the mesh cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrequencyRequest {
    /// Type by the larger part of the kinetic energy.
    pub mode_type: ModeType,
    /// Number among the modes of that type by ascending frequency, from 1; a frequency that occurs twice counts twice.
    pub number: usize,
    /// Wanted accuracy, percent.
    pub tolerance_percent: f64,
}

impl FrequencyRequest {
    /// The mode of a type and number that a scene names.
    pub fn new(mode_type: AutoModeType, number: u32, tolerance_percent: f64) -> Self {
        let mode_type = match mode_type {
            AutoModeType::Rotational => ModeType::Rotational,
            AutoModeType::Translational => ModeType::Translational,
            AutoModeType::Planet => ModeType::Planet,
        };
        Self { mode_type, number: number as usize, tolerance_percent }
    }
}

impl std::fmt::Display for FrequencyRequest {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "natural frequency of {} mode {}", self.mode_type.name(), self.number)
    }
}

/// FE/contact with quasi-static bodies, from cheap to dear; each without and with the inertia of elastic displacements to first order.
const QUASI_STATIC: [AutoSettings; 3] = [
    AutoSettings::quasi_static(6, 20),
    AutoSettings::quasi_static(10, 30),
    AutoSettings::quasi_static(16, 40),
];

/// Factor on a difference of two meshes whose order of convergence is not observed (Roache 1994).
const NO_ORDER: f64 = 3.0;

/// Least share of the estimates of elements and cells that a second mesh may show: frequencies on two meshes may agree by
/// chance.
const LEAST_SHARE: f64 = 1.0 / 3.0;

/// FE/contact with modes of each body, from cheap to dear.
const MODAL: [AutoSettings; 2] = [AutoSettings::modal(4, 6, 20), AutoSettings::modal(4, 10, 30)];

impl FrequencyRequest {
    /// All candidates, from cheap to dear.
    pub fn candidates() -> Vec<AutoSettings> {
        let quasi_static =
            QUASI_STATIC.into_iter().flat_map(|own| [own, own.with_elastic_inertia()]);
        std::iter::once(AutoSettings::LUMPED).chain(quasi_static).chain(MODAL).collect()
    }

    /// Why there is no such mode.
    pub(super) fn missing(&self, count: usize) -> ExperimentError {
        ExperimentError::Model(
            format!("it has {count} modes of type {}", self.mode_type.name()).into(),
        )
    }

    fn mixed(&self, frequency_hz: f64) -> ExperimentError {
        let why = format!(
            "its mode at {frequency_hz:.0} Hz is about as much of another type: on another mesh or with inertia of the bodies \
             the number {} may belong to another mode",
            self.number
        );
        ExperimentError::Model(why.into())
    }

    fn found(&self, modes: Vec<ModeEnergy>) -> Result<ModeEnergy, ExperimentError> {
        let of_type = modes.into_iter().filter(|m| m.mode_type == self.mode_type);
        let mut own: Vec<ModeEnergy> = of_type.collect();
        match (1..=own.len()).contains(&self.number) {
            true => Ok(own.swap_remove(self.number - 1)),
            false => Err(self.missing(own.len())),
        }
    }
}

/// The frequency with given settings, Hz.
///
/// # Errors
/// If the model refuses the scene or has no such mode, or nothing is known of the inertia that the settings ask for.
pub fn frequency_with(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &FrequencyRequest,
) -> Result<f64, ExperimentError> {
    if settings.model == AutoModel::Lumped {
        return AnalyticMode::of(scene, case, request).map(|mode| mode.frequency_hz());
    }
    let (mode, change) = fe_mode(scene, case, settings, request)?;
    Ok((1.0 + change.unwrap_or(0.0)) * mode.frequency_hz)
}

/// The mode with given settings, and the change of its frequency by the inertia of elastic displacements where they have it.
fn fe_mode(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &FrequencyRequest,
) -> Result<(ModeEnergy, Option<f64>), ExperimentError> {
    let own = settings.applied_to(scene);
    let bodies = Bodies::new(&own)?;
    let set = preloaded(&own, &bodies, &standing(case))?;
    let linear = set.linearised()?;
    let mode = request.found(of_linear(&set, &linear)?)?;
    let change = match settings.elastic_inertia {
        true => {
            let unknown = || no_first_order(mode.frequency_hz);
            let change = ElasticChange::new(&set, &linear, &mode)?.filter(ElasticChange::is_slow);
            Some(change.ok_or_else(unknown)?.relative)
        }
        false => None,
    };
    Ok((mode, change))
}

fn no_first_order(frequency_hz: f64) -> ExperimentError {
    let why = format!(
        "inertia is not added to first order: {frequency_hz:.0} Hz is above 0.7 of the first mode of a body with its race held, or the \
         teeth of a gear are not meshed alike"
    );
    ExperimentError::Model(why.into())
}

fn standing(case: &LoadCase) -> Preload {
    Preload { load: *case, position: 0.0, step_s: 5e-6 }
}

/// The cheapest candidate whose estimated error is within the tolerance, with its answer.
///
/// Quasi-static candidates that the first of them shows to be too coarse are not run: the energy of its mode gives the
/// errors of all.
///
/// # Errors
/// If no candidate has the mode, or none is estimated to be within the tolerance.
pub fn choose_frequency(
    scene: &Scene,
    case: &LoadCase,
    request: &FrequencyRequest,
) -> Result<Choice, AutoError> {
    let trial = Trial::new(request.to_string(), "Hz", request.tolerance_percent)?;
    let size = SetSize::new(scene, case)?;
    let mut search = Search { scene, case, request, size, trial, change: None, seen: None };
    let found = match search.lumped() {
        Some(choice) => Some(choice),
        None => search.fe_contact(),
    };
    search.trial.ended(found)
}

struct Search<'s> {
    scene: &'s Scene,
    case: &'s LoadCase,
    request: &'s FrequencyRequest,
    size: SetSize,
    trial: Trial,
    /// Change of the frequency by what quasi-static bodies lack, once it was computed.
    change: Option<ElasticChange>,
    /// Relative difference of the frequencies on the two coarsest meshes, once both were run.
    seen: Option<f64>,
}

impl Search<'_> {
    fn lumped(&mut self) -> Option<Choice> {
        let found = AnalyticMode::of(self.scene, self.case, self.request);
        let mode = found.and_then(|mode| match &mode.mixed_hz {
            Some(mixed) => Err(self.request.mixed(*mixed)),
            None => Ok(mode),
        });
        match mode {
            Ok(mode) => {
                let parts = mode.error_parts(&self.size);
                self.judged(AutoSettings::LUMPED, mode.frequency_hz(), parts)
            }
            Err(e) => self.refused(AutoSettings::LUMPED, &e),
        }
    }

    fn fe_contact(&mut self) -> Option<Choice> {
        let first = QUASI_STATIC[0];
        let probe = match self.probe() {
            Ok(mode) => mode,
            Err(e) => return self.refused(first, &e),
        };
        let mut found = self.judged_without(first, &probe);
        if found.is_none() {
            let with = first.with_elastic_inertia();
            found = match self.added() {
                Some(change) => self.judged_with(with, &probe, change),
                None => self.refused(with, &no_first_order(probe.frequency_hz)),
            };
        }
        if found.is_some() {
            return found;
        }
        for settings in &QUASI_STATIC[1..] {
            let found = self.finer(*settings, &probe);
            if found.is_some() {
                return found;
            }
        }
        // Share that the inertia left out by modes is known to have, from modes on a coarser mesh.
        let mut left_out = self.change.map_or(0.0, |change| change.relative.powi(2));
        MODAL.iter().find_map(|settings| self.modal(*settings, &probe, &mut left_out))
    }

    /// The relative change, where it may be added to the frequency.
    fn added(&self) -> Option<f64> {
        self.change.filter(ElasticChange::is_slow).map(|change| change.relative)
    }

    /// A finer quasi-static mesh, without and with inertia to first order, if one of both may be enough.
    fn finer(&mut self, settings: AutoSettings, probe: &ModeEnergy) -> Option<Choice> {
        let expected = self.least(probe, settings, self.body_inertia(probe));
        if self.trial.is_expected(settings, expected) {
            let found = self.ran(settings, probe);
            if found.is_some() {
                return found;
            }
        }
        // The change on this mesh is computed where the mode alone is not enough.
        let with = settings.with_elastic_inertia();
        let Some(change) = self.added() else {
            return self.refused(with, &no_first_order(probe.frequency_hz));
        };
        let expected = self.least(probe, settings, SetSize::left_by_first_order(change));
        if !self.trial.is_expected(with, expected) {
            return None;
        }
        self.ran(with, probe)
    }

    /// The answer with other settings of quasi-static bodies.
    fn ran(&mut self, settings: AutoSettings, probe: &ModeEnergy) -> Option<Choice> {
        match self.run(settings, probe) {
            Ok((mode, Some(change))) => self.judged_with(settings, &mode, change),
            Ok((mode, None)) => self.judged_without(settings, &mode),
            Err(e) => self.refused(settings, &e),
        }
    }

    /// A mode of quasi-static bodies as it is.
    fn judged_without(&mut self, settings: AutoSettings, mode: &ModeEnergy) -> Option<Choice> {
        let parts = self.quasi_static_parts(mode, settings);
        self.judged(settings, mode.frequency_hz, parts)
    }

    /// The same with its relative change by inertia to first order.
    fn judged_with(
        &mut self,
        settings: AutoSettings,
        mode: &ModeEnergy,
        change: f64,
    ) -> Option<Choice> {
        let mut parts = self.mesh_parts(mode, settings);
        parts.push(ErrorPart::new(BODY_INERTIA, SetSize::left_by_first_order(change)));
        let choice = self.judged(settings, (1.0 + change) * mode.frequency_hz, parts)?;
        let correction = Correction { of: BODY_INERTIA.into(), percent: 100.0 * change };
        Some(Choice { corrections: vec![correction], ..choice })
    }

    /// The mode with the first quasi-static candidate; where the bound of the inertia that is left out is more than the tolerance
    /// leaves, with the change of its frequency by this inertia.
    fn probe(&mut self) -> Result<ModeEnergy, ExperimentError> {
        let settings = QUASI_STATIC[0];
        let own = settings.applied_to(self.scene);
        let bodies = Bodies::new(&own)?;
        let set = preloaded(&own, &bodies, &standing(self.case))?;
        let linear = set.linearised()?;
        let modes = of_linear(&set, &linear)?;
        let mode = self.request.found(modes.clone())?;
        let shares = modes.iter().map(|m| (m.frequency_hz, m.of_types));
        if let Some(mixed) = mixed(shares, mode.frequency_hz, self.request.mode_type) {
            return Err(self.request.mixed(mixed));
        }
        let is_enough =
            total(&self.quasi_static_parts(&mode, settings)) <= self.request.tolerance_percent;
        if !is_enough {
            self.change = ElasticChange::new(&set, &linear, &mode)?;
        }
        Ok(mode)
    }

    /// The mode with other settings; the second mesh shows how far elements and cells of the first have converged.
    fn run(
        &mut self,
        settings: AutoSettings,
        probe: &ModeEnergy,
    ) -> Result<(ModeEnergy, Option<f64>), ExperimentError> {
        let (mode, change) = fe_mode(self.scene, self.case, settings, self.request)?;
        if settings.flank_elements == QUASI_STATIC[1].flank_elements {
            self.seen = Some((mode.frequency_hz / probe.frequency_hz - 1.0).abs());
        }
        Ok((mode, change))
    }

    /// Least error that can be expected of settings: the parts of elements and cells as small as a second mesh may show
    /// them to be, and the inertia that is left out.
    fn least(&self, probe: &ModeEnergy, settings: AutoSettings, inertia: f64) -> f64 {
        let share = if self.seen.is_some() { 1.0 } else { LEAST_SHARE };
        share * total(&self.mesh_parts(probe, settings)) + 100.0 * inertia
    }

    /// What is left after modes of the bodies change the frequency from that of quasi-static bodies on the same mesh: of the
    /// change by all of the inertia to first order, where it is known. Elsewhere, if they leave a third of the error of
    /// quasi-static bodies (saturation assumption), half of their change.
    fn modal(
        &mut self,
        settings: AutoSettings,
        probe: &ModeEnergy,
        left_out: &mut f64,
    ) -> Option<Choice> {
        if !self.trial.is_expected(settings, self.least(probe, settings, *left_out)) {
            return None;
        }
        let (tolerance, coarse) = (self.request.tolerance_percent, QUASI_STATIC[0]);
        let found = (|| {
            let without = settings.without_modes();
            let is_needed = without == QUASI_STATIC[1]
                || total(&self.mesh_parts(probe, settings)) + 100.0 * *left_out > tolerance;
            // A second mesh costs a tenth of the modes, and may show that they are of no use.
            let second = match is_needed {
                true => Some(self.run(QUASI_STATIC[1], probe)?.0),
                false => None,
            };
            let rigid = match second {
                Some(second) if without != coarse => second,
                _ => probe.clone(),
            };
            let expected = total(&self.mesh_parts(&rigid, settings)) + 100.0 * *left_out;
            let mode = match expected <= tolerance {
                true => Some(fe_mode(self.scene, self.case, settings, self.request)?.0),
                false => None,
            };
            Ok::<_, ExperimentError>((expected, mode, rigid))
        })();
        match found {
            Ok((_, Some(mode), rigid)) => {
                let seen = mode.frequency_hz / rigid.frequency_hz - 1.0;
                *left_out = match self.change {
                    Some(change) => SetSize::left_by_modes(change.relative, seen),
                    None => 0.5 * seen.abs(),
                };
                let mut parts = self.mesh_parts(&rigid, settings);
                parts.push(ErrorPart::new(BODY_INERTIA, *left_out));
                self.judged(settings, mode.frequency_hz, parts)
            }
            Ok((expected, None, _)) => {
                self.trial.is_expected(settings, expected);
                None
            }
            Err(e) => self.refused(settings, &e),
        }
    }

    /// Parts of elements and cells, and as small as a second mesh shows them to be: three times the difference (no order of
    /// convergence is observed), at least a third of what is known without it.
    fn mesh_parts(&self, mode: &ModeEnergy, settings: AutoSettings) -> Vec<ErrorPart> {
        let (n, cells) =
            (settings.flank_elements.unwrap_or(1), settings.contact_cells.unwrap_or(1));
        let mut parts: Vec<ErrorPart> = self.size.discretisation(mode, n, cells).into();
        if let Some(seen) = self.seen {
            let coarse = QUASI_STATIC[0].flank_elements.unwrap_or(n);
            let shown = 100.0 * NO_ORDER * seen * f64::from(coarse) / f64::from(n);
            let share = (shown / total(&parts)).clamp(LEAST_SHARE, 1.0);
            parts.iter_mut().for_each(|part| part.percent *= share);
        }
        parts
    }

    /// Part of the inertia that quasi-static bodies leave out: its bound, or from its change of the frequency.
    fn body_inertia(&self, mode: &ModeEnergy) -> f64 {
        let bound = self.size.body_inertia(mode);
        self.change.map_or(bound, |change| bound.min(SetSize::of_change(change.relative)))
    }

    fn quasi_static_parts(&self, mode: &ModeEnergy, settings: AutoSettings) -> Vec<ErrorPart> {
        let mut parts = self.mesh_parts(mode, settings);
        parts.push(ErrorPart::new(BODY_INERTIA, self.body_inertia(mode)));
        parts
    }

    fn judged(&mut self, settings: AutoSettings, hz: f64, parts: Vec<ErrorPart>) -> Option<Choice> {
        // Parts of the closed forms have causes of their own.
        let together = match settings.model {
            AutoModel::Lumped => Together::Squares,
            _ => Together::Sum,
        };
        let first = self.size.first_mode_hz();
        let no_bound = || {
            format!(
                "{hz:.0} Hz is above the first mode of a body that is left out, about {first:.0} Hz"
            )
        };
        self.trial.judged(settings, hz, parts, together, no_bound)
    }

    fn refused(&mut self, settings: AutoSettings, error: &ExperimentError) -> Option<Choice> {
        self.trial.refused(settings, error);
        None
    }
}

pub(super) const BODY_INERTIA: &str = "inertia of the bodies behind the teeth";

#[cfg(test)]
mod tests {
    use super::*;
    use gearset::{AutoInput, AutoQuantity, Freedom, SceneKind, template};

    fn set(has_lumped: bool) -> (Scene, LoadCase) {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        if !has_lumped {
            scene.lumped = None;
        }
        let case = LoadCase::of_scene(&scene).unwrap();
        (scene, case)
    }

    fn request(mode_type: ModeType, number: usize, tolerance_percent: f64) -> FrequencyRequest {
        FrequencyRequest { mode_type, number, tolerance_percent }
    }

    /// Choice among FE/contact candidates alone.
    fn among_fe(
        scene: &Scene,
        case: &LoadCase,
        asked: &FrequencyRequest,
    ) -> Result<Choice, AutoError> {
        let trial = Trial::new(asked.to_string(), "Hz", asked.tolerance_percent)?;
        let size = SetSize::new(scene, case)?;
        let mut search =
            Search { scene, case, request: asked, size, trial, change: None, seen: None };
        let found = search.fe_contact();
        search.trial.ended(found)
    }

    /// Modes governed by bearings (0.8 to 2.2 kHz) and by meshes (7 to 12 kHz), against twelve modes of each body: every
    /// estimate holds, of quasi-static bodies and of the lumped model in closed form, and that of the former is not idle where
    /// parts of the error cannot cancel, in modes that meshes govern.
    #[test]
    fn estimates_hold_beside_modes_of_the_bodies() {
        let (scene, case) = set(false);
        let own = AutoSettings::modal(12, 6, 20).applied_to(&scene);
        let bodies = Bodies::new(&own).unwrap();
        let preload = Preload { load: case, position: 0.0, step_s: 5e-6 };
        let set = preloaded(&own, &bodies, &preload).unwrap();
        let finer = of_linear(&set, &set.linearised().unwrap()).unwrap();
        let mut errors = Vec::new();
        for (mode_type, number) in [
            (ModeType::Rotational, 1),
            (ModeType::Translational, 1),
            (ModeType::Planet, 1),
            (ModeType::Translational, 5),
            (ModeType::Planet, 2),
        ] {
            let asked = request(mode_type, number, 100.0);
            let choice = among_fe(&scene, &case, &asked).unwrap();
            assert_eq!(choice.settings, QUASI_STATIC[0]);
            let truth = asked.found(finer.clone()).unwrap().frequency_hz;
            let error = 100.0 * (choice.value / truth - 1.0).abs();
            let estimate = choice.estimated_error_percent;
            assert!(error <= estimate, "{asked}: {error} {estimate}");
            if error > 1.0 {
                assert!(estimate < 5.0 * error, "{asked}: {error} {estimate}");
            }
            errors.push(error);
            let lumped = choose_frequency(&scene, &case, &asked).unwrap();
            assert_eq!(lumped.settings, AutoSettings::LUMPED);
            let error = 100.0 * (lumped.value / truth - 1.0).abs();
            let estimate = lumped.estimated_error_percent;
            assert!(error <= estimate && estimate < 5.0, "{asked}: {error} {estimate}");
        }
        // A mode of two types by nearly halves, at 8.2 kHz, has no answer.
        let mixed = choose_frequency(&scene, &case, &request(ModeType::Translational, 7, 100.0));
        assert!(matches!(mixed, Err(AutoError::NoAnswer { .. })), "{mixed:?}");
        // Both kinds of modes were among them.
        assert!(errors.iter().any(|e| *e < 0.1) && errors.iter().any(|e| *e > 1.0), "{errors:?}");
    }

    /// Modes that meshes govern, of which the inertia of the bodies is most of the error, are answered with it to first order. A hundred modes of each body change
    /// λ by 3.04 and 3.88 % (`cargo test --release -p experiments --test elastic_inertia -- --ignored --nocapture`).
    #[test]
    fn inertia_to_first_order_is_that_of_a_hundred_modes() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::from_file(path.as_ref()).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        for (mode_type, number, by_modes) in
            [(ModeType::Planet, 2, 0.0304), (ModeType::Rotational, 3, 0.0388)]
        {
            let asked = request(mode_type, number, 1.0);
            let choice = among_fe(&scene, &case, &asked).unwrap();
            let settings = choice.settings;
            assert!(settings.elastic_inertia, "{settings}");
            let without = AutoSettings { elastic_inertia: false, ..settings };
            let of = |own| frequency_with(&scene, &case, own, &asked).unwrap();
            let (with, without) = (of(settings), of(without));
            assert_eq!(choice.value, with);
            let (changed, expected) = (with / without - 1.0, f64::sqrt(1.0 + by_modes) - 1.0);
            println!(
                "{asked}: {without:.1} Hz {:+.3} %, {:+.3} %",
                100.0 * changed,
                100.0 * expected
            );
            assert!((changed - expected).abs() < 0.05 * expected, "{asked}: {changed} {expected}");
            let [correction] = &choice.corrections[..] else { panic!("{:?}", choice.corrections) };
            assert!((correction.percent - 100.0 * changed).abs() < 1e-9);
        }
    }

    /// A smaller tolerance never has a cheaper choice, and the smallest has none.
    #[test]
    fn choices_follow_the_tolerance_until_none_is_left() {
        let (scene, case) = set(true);
        let chosen = |tolerance| {
            let asked = request(ModeType::Rotational, 1, tolerance);
            choose_frequency(&scene, &case, &asked).map(|choice| {
                assert!(choice.estimated_error_percent <= tolerance);
                let together = match choice.settings.model {
                    AutoModel::Lumped => Together::Squares,
                    _ => Together::Sum,
                };
                let error = together.of(&choice.error_parts);
                assert!((error - choice.estimated_error_percent).abs() < 1e-12);
                choice.settings
            })
        };
        assert_eq!(chosen(10.0).unwrap(), AutoSettings::LUMPED);
        assert_eq!(chosen(0.2).unwrap(), QUASI_STATIC[0]);
        let refusal = chosen(0.001).unwrap_err();
        let AutoError::NothingMeets { passed_over, .. } = &refusal else { panic!("{refusal}") };
        let tried: Vec<AutoSettings> = passed_over.iter().map(|p| p.settings).collect();
        assert_eq!(tried, FrequencyRequest::candidates(), "{refusal}");
        for bad in [0.0, -1.0, f64::NAN, 101.0] {
            assert!(matches!(chosen(bad), Err(AutoError::Tolerance(_))));
        }
    }

    /// A scene that asks for a choice has no fidelity of its own, which quasi-static bodies would quietly stand for.
    #[test]
    fn a_scene_without_a_choice_is_not_computed() {
        let (mut scene, case) = set(false);
        let mode_type = AutoModeType::Rotational;
        let quantity = AutoQuantity::NaturalFrequency { mode_type, number: 1 };
        scene.dynamics.auto = Some(AutoInput { quantity, tolerance_percent: 1.0 });
        let bodies = Bodies::new(&scene).unwrap();
        let preload = Preload { load: case, position: 0.0, step_s: 5e-6 };
        let refusal = preloaded(&scene, &bodies, &preload).unwrap_err().to_string();
        assert!(refusal.contains("`dynamics.fidelity` is \"auto\""), "{refusal}");
        let asked = FrequencyRequest::new(mode_type, 1, 1.0);
        assert!(choose_frequency(&scene, &case, &asked).is_ok());
    }

    /// A mode that the set does not have, and one above the first mode of the carrier, which quasi-static bodies lack.
    #[test]
    fn modes_that_are_missing_or_beyond_the_bodies_are_not_answered() {
        let (mut scene, case) = set(false);
        let found = choose_frequency(&scene, &case, &request(ModeType::Planet, 99, 10.0));
        assert!(matches!(found, Err(AutoError::NoAnswer { .. })), "{found:?}");
        // Three rotational modes with the carrier's rotation held, the highest near 15 kHz; the carrier's first is at 12.
        scene.supports.carrier.motion = Freedom::RotationHeld;
        let size = SetSize::new(&scene, &case).unwrap();
        let mode = fe_mode(&scene, &case, QUASI_STATIC[0], &request(ModeType::Rotational, 4, 10.0));
        let (mode, _) = mode.unwrap();
        assert!(mode.frequency_hz > size.first_mode_hz(), "{}", mode.frequency_hz);
        assert!(size.body_inertia(&mode).is_infinite());
        let lower = ModeEnergy { frequency_hz: 0.9 * size.first_mode_hz(), ..mode };
        assert!(size.body_inertia(&lower).is_finite());
    }
}
