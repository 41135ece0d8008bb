//! What a setting answers: experiments carried out, timed in two parts, their work counted.

use std::f64::consts::TAU;

use dynamics::benchmark_subjects::Scheme;
use dynamics::harmonic_balance::BalanceOptions;
use fe_contact::contact::Location;
use fe_contact::statics::{Bodies, Imperfections, SetCycle, StaticSet, at_phase, estimate};
use fe_contact::vibration::{MeshLawSettings, mesh_law};
use gearset::{Axis, MeshKind};
use lumped::BalancedSet;
use scene::{Fidelity, LoadCase};

use super::cost::Stopwatch;
use super::experiment::{Action, Experiment, Work};
use super::quantity::{HARMONICS, Reading};
use super::setting::{Setting, StudyModel};
use crate::modal::{Preload, linear_modes, preloaded};
use crate::model::ModelError;
use crate::models::Lumped;
use crate::natural_mode::{NaturalMode, frequencies_of};
use crate::sweep::{
    FeModel, MeshLawModel, Part, Response, SchemeModel, SteadySettings, SteadyState, SweepError,
    SweepModel, SweepPoint, steady, top_of_three,
};
use crate::table_growth::large_enough;
use crate::{DistinctMode, ModalModel};

/// What an experiment gave.
#[derive(Debug)]
pub(super) enum Outcome {
    Modes(Vec<NaturalMode>),
    /// With the sun's base radius, m.
    Cycle(SetCycle, f64),
    Pressure(f64),
    /// Speed (rpm) and height.
    Peak(f64, f64),
    /// Of the heights of two peaks.
    Ratio(f64),
    Motion(Box<SweepPoint>),
}

/// An experiment carried out on a setting.
#[derive(Debug)]
pub(super) struct Answer {
    /// The outcome, or why there is none.
    pub(super) outcome: Result<Outcome, String>,
    pub(super) work: Work,
    /// Time of gears and contact tables, and of the experiment, s.
    pub(super) times: [f64; 2],
}

/// Carries out experiments on a setting under a torque on the sun; the gears are made once, and their time is part of
/// every experiment's set-up.
pub(super) fn answers(
    setting: &Setting,
    torque: Option<f64>,
    experiments: &[Experiment],
    stopwatch: &mut dyn Stopwatch,
) -> Vec<Answer> {
    let start = stopwatch.seconds();
    let bodies = Bodies::new(&setting.scene);
    let made_s = stopwatch.seconds() - start;
    let mut work = Work {
        contact_cells: f64::from(setting.scene.fe_contact.contact_cells),
        ..Work::default()
    };
    if let Ok(size) = estimate(&setting.scene) {
        work.fe_unknowns = size.bodies.iter().map(|b| b.unknowns as f64).sum();
        work.bytes = size.held_bytes as f64;
    }
    let case = LoadCase::of_scene(&setting.scene);
    let one = |experiment: &Experiment| {
        let (bodies, case) = match (&bodies, &case) {
            (Ok(bodies), Ok(case)) => (bodies, case),
            (Err(e), _) => {
                return Answer { outcome: Err(e.to_string()), work, times: [made_s, 0.0] };
            }
            (_, Err(e)) => {
                return Answer { outcome: Err(e.to_string()), work, times: [made_s, 0.0] };
            }
        };
        let torque = experiment.sun_torque_nm.or(torque);
        let case = torque.map_or(*case, |torque| case.with_sun_torque(torque));
        // Modes of a lumped model take no gears.
        let takes_gears =
            !(setting.choices.model.is_lumped() && experiment.action == Action::Modes);
        let (work, made_s) = if takes_gears { (work, made_s) } else { (Work::default(), 0.0) };
        let mut bench = Bench { setting, bodies, case, work, prepared_s: 0.0, stopwatch };
        let start = bench.stopwatch.seconds();
        let outcome = bench.outcome(&experiment.action).map_err(|e| e.to_string());
        let whole = bench.stopwatch.seconds() - start;
        let times = [made_s + bench.prepared_s, whole - bench.prepared_s];
        Answer { outcome, work: bench.work, times }
    };
    experiments.iter().map(one).collect()
}

/// A setting on which an experiment is carried out.
struct Bench<'b> {
    setting: &'b Setting,
    bodies: &'b Bodies,
    case: LoadCase,
    work: Work,
    /// Time of contact tables or of the law of the meshes, s.
    prepared_s: f64,
    stopwatch: &'b mut dyn Stopwatch,
}

impl Bench<'_> {
    fn outcome(&mut self, action: &Action) -> Result<Outcome, ModelError> {
        let is_lumped = self.setting.choices.model.is_lumped();
        let is_balanced = self.setting.choices.model == StudyModel::HarmonicBalance;
        match action {
            Action::Peak { speeds_rpm, response, harmonic, is_refined } if is_balanced => {
                self.balanced_peak(speeds_rpm, *is_refined, (*response, *harmonic))
            }
            Action::PeakRatio { peak, reference_nm } => self.peak_ratio(peak, *reference_nm),
            _ if is_balanced => Err("harmonic balance answers for resonant peaks only".into()),
            Action::Modes if is_lumped => Ok(Outcome::Modes(
                Lumped::default().natural_modes(&self.setting.scene, &self.case)?,
            )),
            Action::MeshCycle { .. } | Action::Pressure { .. } if is_lumped => {
                Err("the lumped model has no contact at rest".into())
            }
            Action::Modes => self.modes(),
            Action::MeshCycle { positions } => self.cycle(*positions),
            Action::Pressure { mesh, phase } => self.pressure(*mesh, *phase),
            Action::Peak { speeds_rpm, response, harmonic, is_refined } => {
                let amplitude = |p: &SteadyState| response.amplitude(p, *harmonic);
                self.peak(speeds_rpm, *is_refined, &amplitude)
            }
            Action::Motion { speed_rpm } => {
                let bodies = self.bodies;
                let model = self.model(bodies)?;
                let (point, _) = self.point(model.as_ref(), *speed_rpm, None)?;
                Ok(Outcome::Motion(Box::new(point)))
            }
        }
    }

    /// The height of a peak over that of the same peak under another torque on the sun, with contact tables and laws of
    /// its own.
    fn peak_ratio(&mut self, peak: &Action, reference_nm: f64) -> Result<Outcome, ModelError> {
        let case = self.case;
        let height = |of: Outcome| match of {
            Outcome::Peak(_, height) => Ok(height),
            _ => Err("a ratio of peaks needs peaks"),
        };
        let own = height(self.outcome(peak)?)?;
        self.case = case.with_sun_torque(reference_nm);
        let reference = self.outcome(peak);
        self.case = case;
        Ok(Outcome::Ratio(own / height(reference?)?))
    }

    fn modes(&mut self) -> Result<Outcome, ModelError> {
        let preload = Preload { load: self.case, position: 0.0, step_s: 5e-6 };
        let set = preloaded(&self.setting.scene, self.bodies, &preload)?;
        self.work.coordinates = (set.races().count + set.elastic_unknowns()) as f64;
        self.work.bytes += set.bytes().iter().sum::<usize>() as f64;
        let modes = linear_modes(&set, &set.linearised()?)?;
        Ok(Outcome::Modes(modes.iter().map(NaturalMode::from).collect()))
    }

    fn cycle(&mut self, positions: usize) -> Result<Outcome, ModelError> {
        let own = Imperfections::default();
        let set = StaticSet::new(&self.setting.scene, self.bodies, self.case.sense(), own)?;
        let solver = self.setting.choices.contact_solver.solver();
        let cycle = set.cycle(self.case.sun_load_nm(), positions, solver)?;
        let (equilibrium, contact) = cycle.iterations();
        self.work.iterations = (equilibrium + contact) as f64;
        Ok(Outcome::Cycle(cycle, self.sun_radius()?))
    }

    fn pressure(&mut self, mesh: MeshKind, phase: f64) -> Result<Outcome, ModelError> {
        let planets = self.setting.scene.planets.psi_rad.len().max(1) as f64;
        let force = self.case.sun_load_nm() / self.sun_radius()? / planets;
        let solver = self.setting.choices.contact_solver.solver();
        let at = at_phase(self.bodies, mesh, force, phase, solver)?;
        self.work.iterations = at.iterations as f64;
        let on_path =
            at.table.pairs.iter().enumerate().filter(|(_, p)| p.location == Location::Path);
        let pressures = on_path.map(|(k, _)| at.table.peak_pressure(k, &at.answer.cell_forces));
        let largest = pressures.fold(0.0f64, f64::max);
        match largest > 0.0 {
            true => Ok(Outcome::Pressure(largest)),
            false => Err("no pair on the path of contact carries a force at this phase".into()),
        }
    }

    fn peak(
        &mut self,
        speeds_rpm: &[f64],
        is_refined: bool,
        amplitude: &dyn Fn(&SteadyState) -> f64,
    ) -> Result<Outcome, ModelError> {
        let bodies = self.bodies;
        let model = self.model(bodies)?;
        let mut last: Option<Vec<f64>> = None;
        peak(speeds_rpm, is_refined, &mut |speed| {
            let (point, state) = self.point(model.as_ref(), speed, last.as_deref())?;
            last = Some(state);
            Ok(amplitude(&point.state))
        })
    }

    /// The same by harmonic balance of the lumped model.
    fn balanced_peak(
        &mut self,
        speeds_rpm: &[f64],
        is_refined: bool,
        (response, harmonic): (Response, usize),
    ) -> Result<Outcome, ModelError> {
        let Response::Rotation(part) = response else {
            return Err("harmonic balance answers for rotations only".into());
        };
        let start = self.stopwatch.seconds();
        let mut scene = self.setting.scene.clone();
        scene.dynamics.fidelity = Fidelity::MeshLaw;
        let (scene, case) = (&scene, self.case);
        let (law_settings, steps) =
            (MeshLawSettings::at(case.sun_load_nm()), scene.dynamics.steps_per_cycle as usize);
        let law = mesh_law(scene, self.bodies, case.sense(), steps, &law_settings)?;
        let law = law.in_direction(case.direction());
        let set = BalancedSet::new(scene, case.sense(), law, case.sun_load_nm())?;
        self.prepared_s += self.stopwatch.seconds() - start;
        let lumped = scene.lumped.as_ref().ok_or("the scene has no lumped parameters")?;
        let Part::Body(body) = part else {
            return Err("meshes have no rotation".into());
        };
        let held = "this body does not rotate";
        let coordinate = set.coordinates().of(body, Axis::Rotation).ok_or(held)?;
        let radius =
            lumped.radius_m.of(body).ok_or("the lumped parameters have no radius of this body")?;
        let options = BalanceOptions { tail: TAIL, ..BalanceOptions::default() };
        let mut last: Option<Vec<f64>> = None;
        self.work.coordinates = set.coordinates().count() as f64;
        peak(speeds_rpm, is_refined, &mut |speed| {
            let frequency = case.at_speed(speed).mesh_frequency_hz;
            let found = set.solve(frequency, last.as_deref(), &options)?;
            self.work.iterations += found.iterations as f64;
            let line = found.coordinates[coordinate].lines.get(harmonic).copied();
            last = Some(found.unknowns);
            Ok(line.map_or(0.0, |x| x.norm()) / radius)
        })
    }
}

/// Place and height of the highest of amplitudes over speeds, three more about it if it is refined.
fn peak(
    speeds_rpm: &[f64],
    is_refined: bool,
    amplitude: &mut dyn FnMut(f64) -> Result<f64, ModelError>,
) -> Result<Outcome, ModelError> {
    let mut found: Vec<(f64, f64)> = Vec::new();
    for speed in speeds_rpm {
        found.push((*speed, amplitude(*speed)?));
    }
    let no_peak = "the highest amplitude is at an end of `speeds_rpm`: there is no peak among them";
    let (top, height) = top_of_three(found.iter().copied()).ok_or(no_peak)?;
    if !is_refined {
        return Ok(Outcome::Peak(top, height));
    }
    // The parabola of the amplitude's inverse square is of third order in the distance of its points.
    let spacing = found.windows(2).map(|w| w[1].0 - w[0].0).fold(f64::INFINITY, f64::min);
    for speed in [-NEARER, 0.0, NEARER].map(|share| top + share * spacing) {
        found.push((speed, amplitude(speed)?));
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (top, height) = top_of_three(found.into_iter()).ok_or(no_peak)?;
    Ok(Outcome::Peak(top, height))
}

impl Bench<'_> {
    /// The model in time; its tables are part of the set-up.
    fn model<'s>(&mut self, bodies: &'s Bodies) -> Result<Box<dyn SweepModel + 's>, ModelError> {
        let start = self.stopwatch.seconds();
        let (scene, choices) = (&self.setting.scene, &self.setting.choices);
        let model: Box<dyn SweepModel + 's> = match (choices.model, scene.dynamics.fidelity) {
            (StudyModel::Lumped, _) if choices.integrator.is_some() => {
                let own = choices.integrator.map_or(Scheme::AverageAcceleration, |i| i.scheme());
                Box::new(SchemeModel::new(scene, bodies, self.case, own)?)
            }
            (StudyModel::Lumped, _) => {
                Box::new(MeshLawModel::new(scene, bodies, self.case)?.lumped())
            }
            (StudyModel::LumpedPrescribed | StudyModel::LumpedPrescribedSideLoads, _) => {
                let has_side_loads = choices.model == StudyModel::LumpedPrescribedSideLoads;
                let law = MeshLawModel::new(scene, bodies, self.case)?;
                Box::new(law.lumped_prescribed(has_side_loads)?)
            }
            (_, Fidelity::MeshLaw) => Box::new(MeshLawModel::new(scene, bodies, self.case)?),
            _ => {
                let own = Imperfections::default();
                Box::new(FeModel::new(scene, bodies, own, self.case).with_tables(choices.size()))
            }
        };
        model.prepare()?;
        self.prepared_s += self.stopwatch.seconds() - start;
        Ok(model)
    }

    /// A steady state from rest or from the state of the speed before, and the state after it.
    fn point(
        &mut self,
        model: &dyn SweepModel,
        speed_rpm: f64,
        state: Option<&[f64]>,
    ) -> Result<(SweepPoint, Vec<f64>), ModelError> {
        let choices = &self.setting.choices;
        let (method, tolerance) = (choices.steady_method, choices.tolerance());
        let harmonics = HARMONICS;
        let settings = SteadySettings {
            method,
            tolerance,
            harmonics,
            between_cycles: 0,
            ..SteadySettings::default()
        };
        let (case, steps) = (self.case.at_speed(speed_rpm), model.steps_per_cycle());
        settings.check(steps)?;
        let (point, state, effort, bytes) = large_enough(|size| {
            let mut set = model.turning(&case, size)?;
            match state {
                Some(state) => set.restore(state)?,
                None => set.rest()?,
            }
            let (shape, first) = (model.shape(), model.first_planet_rad());
            let found = steady(set.as_mut(), shape, first, steps, &settings)?;
            if let Some(rest) = found.rest {
                rest.check()?;
            }
            let point = SweepPoint::new(case, &found, &settings, size)?;
            Ok::<_, SweepError>((point, set.state(), set.effort(), set.bytes()))
        })?;
        if !point.is_steady {
            let cycles = point.cycles;
            return Err(format!(
                "the model: at {speed_rpm} rpm the motion has not become steady to {tolerance:e} after {cycles} cycles"
            )
            .into());
        }
        let marched = (point.cycles * steps) as f64;
        self.work.steps += marched;
        self.work.contact_solutions += (marched * effort.solutions).round();
        self.work.derivatives += point.derivatives as f64;
        self.work.marched_instead += f64::from(u8::from(point.why_marched.is_some()));
        self.work.coordinates = effort.coordinates as f64;
        let held = estimate(&self.setting.scene).map_or(0.0, |size| size.held_bytes as f64);
        self.work.bytes = self.work.bytes.max(held + bytes as f64);
        Ok((point, state))
    }

    fn sun_radius(&self) -> Result<f64, ModelError> {
        let sun = self.bodies.geometry.sun.as_ref();
        Ok(sun.ok_or("the scene has no sun")?.base_radius)
    }
}

/// Share of the highest harmonics in a balanced motion.
const TAIL: f64 = 1e-4;

/// Distance of the speeds of a refined peak from its first estimate, in spacings of the first speeds.
const NEARER: f64 = 0.125;

impl Reading {
    /// The quantity, or why there is none.
    pub(super) fn of(self, outcome: &Outcome) -> Result<f64, String> {
        let value = match (self, outcome) {
            (Self::Frequency { mode_type, number }, Outcome::Modes(modes)) => {
                let own = frequencies_of(modes, mode_type);
                let found = own.get(number - 1).copied();
                found.ok_or_else(|| {
                    let listed: Vec<String> = crate::distinct(modes)
                        .iter()
                        .map(|d: &DistinctMode| {
                            format!("{:.1} {}", d.frequency_hz, d.mode_type.name())
                        })
                        .take(12)
                        .collect();
                    format!(
                        "there are {} frequencies of type {}: {}",
                        own.len(),
                        mode_type.name(),
                        listed.join(", ")
                    )
                })?
            }
            (Self::ErrorMean, Outcome::Cycle(cycle, r)) => cycle.transmission_error(*r).mean,
            (Self::ErrorPeakToPeak, Outcome::Cycle(cycle, r)) => {
                cycle.transmission_error(*r).peak_to_peak()
            }
            (Self::ErrorHarmonic(l), Outcome::Cycle(cycle, r)) => {
                let list: Vec<f64> =
                    cycle.states.iter().map(|s| s.transmission_error(*r)).collect();
                amplitude(&list, l)?
            }
            (Self::LoadShare(kind), Outcome::Cycle(cycle, _)) => largest_share(cycle, kind),
            (Self::Stiffness(kind), Outcome::Cycle(cycle, _)) => cycle.mean_secant_stiffness(kind),
            (Self::Pressure, Outcome::Pressure(p)) => *p,
            (Self::PeakHeight, Outcome::Peak(_, height)) => *height,
            (Self::PeakSpeed, Outcome::Peak(speed, _)) => *speed,
            (Self::PeakRatio, Outcome::Ratio(ratio)) => *ratio,
            (Self::Amplitude { response, harmonic }, Outcome::Motion(point)) => {
                Response::amplitude(response, &point.state, harmonic)
            }
            (Self::Multiplier, Outcome::Motion(point)) => {
                let why = "the motion was marched, which gives no multipliers";
                point.largest_multiplier().ok_or(why)?
            }
            _ => return Err("the experiment does not give this quantity".into()),
        };
        match value.is_finite() {
            true => Ok(value),
            false => Err("the value is not finite".into()),
        }
    }
}

/// Largest share of one mesh in the force of all meshes of its kind.
fn largest_share(cycle: &SetCycle, kind: MeshKind) -> f64 {
    let of = |state: &fe_contact::statics::SetState| {
        let forces: Vec<f64> =
            state.meshes.iter().filter(|m| m.kind == kind).map(|m| m.force).collect();
        forces.iter().copied().fold(f64::NAN, f64::max) / forces.iter().sum::<f64>()
    };
    cycle.states.iter().map(of).fold(f64::NAN, f64::max)
}

/// Amplitude of harmonic l of evenly spaced samples of one period.
fn amplitude(samples: &[f64], l: usize) -> Result<f64, String> {
    let n = samples.len();
    if 2 * l >= n {
        return Err(format!("harmonic {l} needs more than {} positions", 2 * l));
    }
    let sum = |of: fn(f64) -> f64| -> f64 {
        let one = |(k, x): (usize, &f64)| x * of(TAU * (l * k % n) as f64 / n as f64);
        samples.iter().enumerate().map(one).sum()
    };
    Ok(2.0 / n as f64 * sum(f64::cos).hypot(sum(f64::sin)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_of_samples() {
        let at = |k: usize| {
            let t = TAU * k as f64 / 12.0;
            7.0 + 3.0 * (t - 0.4).cos() + 0.5 * (2.0 * t + 1.0).sin()
        };
        let samples: Vec<f64> = (0..12).map(at).collect();
        for (l, expected) in [(1, 3.0), (2, 0.5), (3, 0.0)] {
            assert!((amplitude(&samples, l).unwrap() - expected).abs() < 1e-12, "{l}");
        }
        assert!(amplitude(&samples, 6).is_err());
    }
}
