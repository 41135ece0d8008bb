//! The cheapest settings for the amplitude of a steady state, the largest over the speeds of a sweep.

use std::cell::{Cell, RefCell};

use fe_contact::statics::{Bodies, Imperfections};
use scene::{AutoResponse, LoadCase, Scene};

use super::choice::{AutoError, Choice};
use super::question::{ClosedForm, Question};
use super::search::choose;
use super::settings::{AutoSettings, BodyInertia};
use crate::sweep::{
    Coordinate, Direction, FeModel, Memory, Part, Plan, SteadySettings, Sweep, SweepError,
    SweepModel, SweepPoint, run,
};

/// Ways to take the inertia of the bodies into account.
const INERTIAS: [BodyInertia; 3] =
    [BodyInertia::None, BodyInertia::Modes(10), BodyInertia::Modes(30)];

/// Random starts from which each speed is searched besides, for other motions that attract.
const RANDOM_STARTS: u32 = 2;

/// The amplitude of a steady state.
#[derive(Debug, Clone)]
pub struct AmplitudeQuestion<'s> {
    /// The set.
    pub scene: &'s Scene,
    /// Torque and driven member.
    pub case: &'s LoadCase,
    /// Which motion: its root mean square in the harmonics that are kept.
    pub response: AutoResponse,
    /// Speeds of the driven member, ascending, rpm: the largest root mean square over them is asked for.
    pub speeds_rpm: Vec<f64>,
    /// How steady states are found, and the highest harmonic.
    pub steady: SteadySettings,
    /// Whether other motions that attract were looked for.
    is_searched: Cell<bool>,
    /// Why no settings are chosen for it, once a motion showed that: for whatever settings.
    refusal: RefCell<Option<String>>,
}

/// Harmonics of the response at some speeds, and the sweep that gave them.
#[derive(Debug)]
pub struct Motions {
    /// Speed (rpm), and complex amplitudes of each coordinate in each harmonic, µm.
    at: Vec<(f64, Vec<[f64; 2]>)>,
    sweep: Sweep,
}

/// A choice, and the sweep that gave it.
#[derive(Debug)]
pub struct ChosenSweep {
    /// Settings, value and estimated error.
    pub choice: Choice,
    /// Steady states at all speeds.
    pub sweep: Sweep,
}

fn rms(lines: impl Iterator<Item = [f64; 2]>) -> f64 {
    lines.map(|[re, im]| 0.5 * (re * re + im * im)).sum::<f64>().sqrt()
}

impl Motions {
    fn largest(&self) -> f64 {
        self.at.iter().map(|(_, lines)| rms(lines.iter().copied())).fold(0.0, f64::max)
    }

    /// Speed of the largest amplitude, rpm.
    fn top_rpm(&self) -> Option<f64> {
        let size = |own: &&(f64, Vec<[f64; 2]>)| rms(own.1.iter().copied());
        self.at.iter().max_by(|a, b| size(a).total_cmp(&size(b))).map(|(rpm, _)| *rpm)
    }
}

impl<'s> AmplitudeQuestion<'s> {
    /// The response of a set at some speeds, rpm.
    pub fn new(
        (scene, case): (&'s Scene, &'s LoadCase),
        response: AutoResponse,
        speeds_rpm: Vec<f64>,
        steady: SteadySettings,
    ) -> Self {
        Self {
            scene,
            case,
            response,
            speeds_rpm,
            steady,
            is_searched: Cell::new(false),
            refusal: RefCell::default(),
        }
    }

    fn name(&self) -> &'static str {
        match self.response {
            AutoResponse::TransmissionError => "dynamic transmission error of the sun",
            AutoResponse::SunTranslation => "translation of the sun",
        }
    }

    /// Complex amplitudes of the response in a steady state, µm; `radius`: base radius of the sun, m.
    fn lines(&self, point: &SweepPoint, radius: f64) -> Vec<[f64; 2]> {
        let coordinates: &[(Coordinate, f64)] = match self.response {
            AutoResponse::TransmissionError => &[(Coordinate::Rotation, radius)],
            AutoResponse::SunTranslation => {
                &[(Coordinate::Radial, 1.0), (Coordinate::Tangential, 1.0)]
            }
        };
        let one = |(coordinate, factor): &(Coordinate, f64), l: usize| {
            point.state.line(Part::SUN, *coordinate, l).map_or([0.0; 2], |line| {
                let (sin, cos) = line.phase_rad.sin_cos();
                [cos, sin].map(|part| 1e6 * factor * line.amplitude * part)
            })
        };
        let harmonics = 1..=self.steady.harmonics;
        coordinates.iter().flat_map(|c| harmonics.clone().map(move |l| one(c, l))).collect()
    }

    /// Steady states at some speeds, rpm.
    fn motions(&self, settings: &AutoSettings, speeds_rpm: &[f64]) -> Result<Motions, AutoError> {
        if let Some(why) = &*self.refusal.borrow() {
            return Err(AutoError::Model(why.clone()));
        }
        let scene = settings.applied_to(self.scene);
        let bodies = Bodies::new(&scene)?;
        let sun = bodies.geometry.sun.as_ref().ok_or(AutoError::Incomplete("sun"))?;
        let model = FeModel::new(&scene, &bodies, Imperfections::default(), *self.case);
        model.prepare()?;
        let plan = Plan::new(speeds_rpm, &[Direction::Up], self.steady.clone());
        let plan = plan.map_err(SweepError::from)?;
        let sweep = run(&model, &plan, &Memory, &|_| ())?.complete()?.steady()?;
        if let Some(why) = self.ambiguous(&model, &plan, &sweep)? {
            *self.refusal.borrow_mut() = Some(why.clone());
            return Err(AutoError::Model(why));
        }
        let of = |p: &SweepPoint| (p.state.case.speed_rpm, self.lines(p, sun.base_radius));
        Ok(Motions { at: sweep.points().into_iter().map(of).collect(), sweep })
    }

    /// Why two settings may show different motions, if they may: teeth part, or several motions attract, which is
    /// asked once.
    ///
    /// # Errors
    /// If the search from random starts cannot be begun.
    fn ambiguous(
        &self,
        model: &FeModel<'_>,
        plan: &Plan,
        sweep: &Sweep,
    ) -> Result<Option<String>, AutoError> {
        let found =
            "which of the motions that attract there is found depends on the settings; name them";
        if let Some(rpm) = parting_rpm(sweep) {
            return Ok(Some(format!("at {rpm} rpm teeth part: {found}")));
        }
        if self.is_searched.replace(true) {
            return Ok(None);
        }
        let mut random = plan.clone().with_random_starts(RANDOM_STARTS);
        random.chains.retain(|chain| chain.random_start.is_some());
        let mut all = sweep.clone();
        all.extend(run(model, &random, &Memory, &|_| ())?);
        let several = all.coexisting_rpm().first().copied();
        Ok(several.map(|rpm| format!("at {rpm} rpm several motions attract: {found}")))
    }
}

/// Lowest speed at which teeth part, rpm.
fn parting_rpm(sweep: &Sweep) -> Option<f64> {
    let parted = sweep.points().into_iter().filter(|p| p.contact_loss > 0.0);
    parted.map(|p| p.state.case.speed_rpm).reduce(f64::min)
}

impl Question for AmplitudeQuestion<'_> {
    type Answer = Motions;

    fn words(&self) -> String {
        let (name, highest) = (self.name(), self.steady.harmonics);
        let of = format!("root mean square of harmonics 1 to {highest} of the {name}");
        match self.speeds_rpm.as_slice() {
            [speed] => format!("{of} at {speed} rpm"),
            [first, .., last] => format!("{of}, the largest from {first} to {last} rpm"),
            [] => of,
        }
    }

    fn unit(&self) -> &'static str {
        "µm"
    }

    fn settings(&self, level: usize, inertia: BodyInertia) -> AutoSettings {
        AutoSettings::fe_contact(level, inertia).with_steps(self.scene, level)
    }

    fn inertias(&self) -> &'static [BodyInertia] {
        &INERTIAS
    }

    fn in_closed_form(&self) -> Result<Option<ClosedForm>, AutoError> {
        Ok(None)
    }

    fn answer(&self, settings: &AutoSettings) -> Result<Motions, AutoError> {
        self.motions(settings, &self.speeds_rpm)
    }

    /// At the speed of the largest amplitude alone: modes of the bodies cost tens of times as much.
    fn answer_beside(
        &self,
        settings: &AutoSettings,
        known: &Motions,
    ) -> Result<Motions, AutoError> {
        let top = known.top_rpm().ok_or(AutoError::Incomplete("steady state"))?;
        self.motions(settings, &[top])
    }

    fn value(&self, answer: &Motions) -> f64 {
        answer.largest()
    }

    /// Over the speeds that both have: the difference of the amplitudes, at least 1/√2 of the root mean square of the
    /// difference of the complex harmonics, which is what a difference of random phase changes of an amplitude (root
    /// mean square), so that amplitudes do not agree by chance.
    fn distance(&self, coarse: &Motions, fine: &Motions) -> f64 {
        let at = |(rpm, own): &(f64, Vec<[f64; 2]>)| {
            let (_, other) = coarse.at.iter().find(|(speed, _)| speed == rpm)?;
            let difference = own.iter().zip(other).map(|([a, b], [c, d])| [a - c, b - d]);
            let sizes = [own, other].map(|lines| rms(lines.iter().copied()));
            let turned = std::f64::consts::FRAC_1_SQRT_2 * rms(difference);
            Some((sizes[0] - sizes[1]).abs().max(turned))
        };
        fine.at.iter().filter_map(at).fold(0.0, f64::max) / fine.largest()
    }
}

/// The cheapest settings whose estimated error is within the tolerance, percent, with their sweep.
///
/// # Errors
/// If no settings give the amplitude, or none is estimated to be within the tolerance.
pub fn choose_amplitude(
    question: &AmplitudeQuestion<'_>,
    tolerance_percent: f64,
) -> Result<ChosenSweep, AutoError> {
    let (choice, motions) = choose(question, tolerance_percent)?;
    let motions = motions.ok_or(AutoError::Incomplete("steady state"))?;
    Ok(ChosenSweep { choice, sweep: motions.sweep })
}
