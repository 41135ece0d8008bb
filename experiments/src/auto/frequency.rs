//! The cheapest settings for a natural frequency.

use fe_contact::statics::Bodies;
use lumped::{AnalyticSet, ModeType};
use scene::{AutoModeType, LoadCase, Scene};

use super::choice::{AutoError, Choice, ErrorPart};
use super::question::{ClosedForm, Question};
use super::search::choose;
use super::settings::{AutoSettings, BodyInertia};
use crate::modal::{
    FeMode, Preload, first_order_inertia, linear_modes, majority, of_type, preloaded,
};

/// Ways to take the inertia of the bodies into account.
const INERTIAS: [BodyInertia; 4] =
    [BodyInertia::None, BodyInertia::FirstOrder, BodyInertia::Modes(12), BodyInertia::Modes(40)];

/// A mode with a share of the asked type between these may be counted among them or not: shares change with the model
/// by as much as a coupling of its type does.
const MIXED: std::ops::RangeInclusive<f64> = 0.35..=0.65;

/// Modes up to this ratio above the asked one may change places with it.
const CLOSE: f64 = 1.05;

/// A natural frequency about the load at position 0 of the mesh cycle.
#[derive(Debug, Clone, Copy)]
pub struct FrequencyQuestion<'s> {
    /// The set.
    pub scene: &'s Scene,
    /// Its torque.
    pub case: &'s LoadCase,
    /// Type by the larger part of the kinetic energy.
    pub mode_type: ModeType,
    /// Number among the modes of that type by ascending frequency, from 1; a frequency that occurs twice counts twice.
    pub number: usize,
}

impl<'s> FrequencyQuestion<'s> {
    /// The mode of a type and number that a scene names.
    pub fn new(scene: &'s Scene, case: &'s LoadCase, mode_type: AutoModeType, number: u32) -> Self {
        let mode_type = match mode_type {
            AutoModeType::Rotational => ModeType::Rotational,
            AutoModeType::Translational => ModeType::Translational,
            AutoModeType::Planet => ModeType::Planet,
        };
        Self { scene, case, mode_type, number: number as usize }
    }

    /// Why there is no such mode.
    fn missing(&self, count: usize) -> AutoError {
        let name = self.mode_type.name();
        AutoError::Model(format!("it has {count} modes of type {name}"))
    }

    /// Refuses a mode at `own_hz` that cannot be told by type and number: one up to it, or close above it, is of the
    /// asked type about as much as of others. `modes`: frequency (Hz) and share in motion of that type.
    fn check_types(
        &self,
        own_hz: f64,
        modes: impl Iterator<Item = (f64, f64)>,
    ) -> Result<(), AutoError> {
        let mut mixed = modes.filter(|(hz, share)| *hz <= CLOSE * own_hz && MIXED.contains(share));
        let Some((hz, _)) = mixed.next() else { return Ok(()) };
        let why = format!(
            "its mode at {hz:.0} Hz is about as much of another type: with other settings the number {} may belong to another mode",
            self.number
        );
        Err(AutoError::Model(why))
    }

    /// Place of the asked type among shares in rotational, translational and planet motion.
    fn place(&self) -> usize {
        match self.mode_type {
            ModeType::Rotational => 0,
            ModeType::Translational => 1,
            _ => 2,
        }
    }
}

impl Question for FrequencyQuestion<'_> {
    /// Hz
    type Answer = f64;

    fn words(&self) -> String {
        format!("natural frequency of {} mode {}", self.mode_type.name(), self.number)
    }

    fn unit(&self) -> &'static str {
        "Hz"
    }

    fn settings(&self, level: usize, inertia: BodyInertia) -> AutoSettings {
        AutoSettings::fe_contact(level, inertia)
    }

    fn inertias(&self) -> &'static [BodyInertia] {
        &INERTIAS
    }

    fn in_closed_form(&self) -> Result<Option<ClosedForm>, AutoError> {
        let set = AnalyticSet::new(self.scene, self.case, 0.0)?;
        let groups = set.modes()?.groups;
        let own = groups.iter().filter(|g| majority(&g.participation) == self.mode_type);
        let mut each = own.clone().flat_map(|g| std::iter::repeat_n(g, g.multiplicity));
        let missing = || self.missing(own.map(|g| g.multiplicity).sum());
        let group = each.nth(self.number.wrapping_sub(1)).ok_or_else(missing)?;
        let shares = groups.iter().map(|g| {
            let p = &g.participation;
            (g.frequency_hz, [p.rotational, p.translational, p.planet][self.place()])
        });
        self.check_types(group.frequency_hz, shares)?;
        let hz = group.frequency_hz * (1.0 + set.inertia_change(group));
        let parts = set.frequency_errors(group);
        let parts = parts.iter().map(|part| ErrorPart::new(part.source, part.share));
        Ok(Some((hz, parts.collect())))
    }

    fn answer(&self, settings: &AutoSettings) -> Result<f64, AutoError> {
        let scene = settings.applied_to(self.scene);
        let bodies = Bodies::new(&scene)?;
        let preload = Preload { load: *self.case, position: 0.0, step_s: 5e-6 };
        let set = preloaded(&scene, &bodies, &preload)?;
        let linear = set.linearised()?;
        let modes = linear_modes(&set, &linear)?;
        let own = of_type(&modes, self.mode_type);
        let mode: &FeMode =
            own.get(self.number.wrapping_sub(1)).ok_or_else(|| self.missing(own.len()))?;
        let hz = mode.frequency_hz;
        self.check_types(hz, modes.iter().map(|m| (m.frequency_hz, m.shares[self.place()])))?;
        if !settings.elastic_inertia {
            return Ok(hz);
        }
        let change = first_order_inertia(&set, &linear, std::slice::from_ref(mode))?;
        let unknown = || {
            let why = format!(
                "inertia is not known to first order: {hz:.0} Hz is above 0.7 of the first mode of a body with its race held, or the teeth of a gear are not meshed alike"
            );
            AutoError::Model(why)
        };
        Ok(hz * (1.0 + change[0].ok_or_else(unknown)?))
    }

    fn value(&self, answer: &f64) -> f64 {
        *answer
    }

    fn distance(&self, coarse: &f64, fine: &f64) -> f64 {
        (coarse / fine - 1.0).abs()
    }
}

/// The cheapest settings whose estimated error is within the tolerance, percent.
///
/// # Errors
/// If no settings have the mode, or none is estimated to be within the tolerance.
pub fn choose_frequency(
    question: &FrequencyQuestion<'_>,
    tolerance_percent: f64,
) -> Result<Choice, AutoError> {
    choose(question, tolerance_percent).map(|(choice, _)| choice)
}
