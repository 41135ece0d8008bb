//! Steady states of one candidate for an amplitude.

use std::cell::OnceCell;
use std::sync::Mutex;

use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::VibratingSet;
use gearset::{AutoResponse, Fidelity, LoadCase, MeshKinematics, Scene};

use super::amplitude::AmplitudeRequest;
use super::linear_motion::{LinearMotion, StepOfCycle};
use super::response::Harmonics;
use super::set_modes::SetModes;
use super::settings::AutoSettings;
use crate::error::ExperimentError;
use crate::modal::{Preload, preloaded};
use crate::sweep::{
    Direction, FeModel, Kept, Memory, Plan, SteadySettings, Sweep, SweepModel, SweepPoint, run,
};

/// A candidate with its gears and contact tables, which its runs share.
pub(super) struct Turning<'b> {
    pub(super) bodies: &'b Bodies,
    pub(super) scene: Scene,
    model: FeModel<'b>,
    case: &'b LoadCase,
    request: &'b AmplitudeRequest,
    /// Base radius of the sun, m.
    radius: f64,
    /// The set at rest, once asked for.
    at_rest: &'b OnceCell<SetModes>,
}

/// What `work` gives on a candidate.
///
/// # Errors
/// If the settings are refused, and as `work`.
pub(super) fn on<T>(
    (scene, case): (&Scene, &LoadCase),
    settings: AutoSettings,
    request: &AmplitudeRequest,
    work: impl FnOnce(&Turning<'_>) -> Result<T, ExperimentError>,
) -> Result<T, ExperimentError> {
    let scene = settings.applied_to(scene);
    let bodies = Bodies::new(&scene)?;
    let sun = bodies.geometry.sun.as_ref().ok_or(ExperimentError::Incomplete("sun"))?;
    let radius = sun.base_radius;
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), *case);
    let at_rest = &OnceCell::new();
    work(&Turning { bodies: &bodies, scene, model, case, request, radius, at_rest })
}

/// Steady states at some speeds.
pub(super) struct Motions {
    pub(super) sweep: Sweep,
    /// Speed (rpm) and response, by speed; of quasi-static bodies without the change of frequency by the time steps.
    at: Vec<(f64, Harmonics)>,
    /// The same with it, as the sweep has it.
    stepped: Vec<(f64, Harmonics)>,
    states: Vec<StateAt>,
}

/// State of the set at the start of a cycle of its steady state at one speed.
struct StateAt {
    rpm: f64,
    state: Vec<f64>,
    /// How often tables were found too small on the way to it.
    size: usize,
}

impl Turning<'_> {
    /// What `work` gives with one in `every` of the steps, on the same tables.
    ///
    /// # Errors
    /// If the steps are not a multiple of `every`, and as `work`.
    pub(super) fn thinned<T>(
        &self,
        every: u32,
        work: impl FnOnce(&Turning<'_>) -> Result<T, ExperimentError>,
    ) -> Result<T, ExperimentError> {
        self.model.prepare()?;
        let model = self.model.thinned(every as usize)?;
        work(&Turning { scene: self.scene.clone(), model, ..*self })
    }

    /// What `work` gives with the steps of `settings`, whose mesh is this one's: on the same gears, about the same mean
    /// configuration, with the tables of positions that both have.
    ///
    /// # Errors
    /// If the settings are refused, and as `work`.
    pub(super) fn with_steps<T>(
        &self,
        settings: AutoSettings,
        work: impl FnOnce(&Turning<'_>) -> Result<T, ExperimentError>,
    ) -> Result<T, ExperimentError> {
        let scene = settings.applied_to(&self.scene);
        let model = self.model.with_steps(&scene)?;
        work(&Turning { scene, model, ..*self })
    }

    /// What `each` gives at every step of a cycle of the steady state of `motions` at one of their speeds, rpm.
    ///
    /// # Errors
    /// If the motions have no such speed, a step fails, and as `each`.
    pub(super) fn over_cycle<T>(
        &self,
        motions: &Motions,
        rpm: f64,
        each: impl Fn(&VibratingSet<'_>) -> Result<T, ExperimentError>,
    ) -> Result<Vec<T>, ExperimentError> {
        let lost = ExperimentError::Incomplete("steady state");
        let own = motions.states.iter().find(|own| own.rpm == rpm).ok_or(lost)?;
        self.model.over_cycle(&self.case.at_speed(rpm), (&own.state, own.size), each)
    }

    /// Mesh frequency at a speed, rpm, Hz.
    pub(super) fn mesh_hz(&self, rpm: f64) -> f64 {
        self.case.at_speed(rpm).mesh_frequency_hz
    }

    /// The response that is asked for.
    pub(super) fn response(&self) -> AutoResponse {
        self.request.response
    }

    /// The set at rest at position 0 of the mesh cycle: on the model's tables, or where kinematics are exact at every step on
    /// its own.
    ///
    /// # Errors
    /// If there is no equilibrium.
    pub(super) fn standing(&self) -> Result<VibratingSet<'_>, ExperimentError> {
        match self.scene.dynamics.kinematics {
            MeshKinematics::AboutMean => self.model.standing(),
            MeshKinematics::Exact => {
                let preload = Preload { load: *self.case, position: 0.0, step_s: 5e-6 };
                Ok(preloaded(&self.scene, self.bodies, &preload)?)
            }
        }
    }

    /// The set at rest.
    ///
    /// # Errors
    /// If there is no equilibrium, or the modes are not found.
    pub(super) fn at_rest(&self) -> Result<&SetModes, ExperimentError> {
        if let Some(known) = self.at_rest.get() {
            return Ok(known);
        }
        let set = self.standing()?;
        let along = (self.model.first_planet_rad(), self.radius);
        let found = SetModes::new(&set, self.request.response, along)?;
        Ok(self.at_rest.get_or_init(|| found))
    }

    /// The steady states at some speeds, rpm; of quasi-static bodies without the frequency of the time steps.
    ///
    /// # Errors
    /// If one is not found, or is not steady.
    pub(super) fn motions(&self, speeds_rpm: &[f64]) -> Result<Motions, ExperimentError> {
        let mut motions = self.motions_in_steps(speeds_rpm)?;
        if self.scene.dynamics.fidelity == Fidelity::QuasiStatic {
            let one = |(rpm, own): &(f64, Harmonics)| {
                let cycle = self.over_cycle(&motions, *rpm, StepOfCycle::of)?;
                let linear = LinearMotion::new(&cycle, self.mesh_hz(*rpm))?;
                let change = linear.changed_by(&linear.step_forces())?;
                let rest = self.at_rest()?;
                let of = |l: usize| change.get(l).map_or_else(Vec::new, |x| rest.response(x));
                Ok((*rpm, own.changed(of)))
            };
            motions.at = motions.stepped.iter().map(one).collect::<Result<_, ExperimentError>>()?;
        }
        Ok(motions)
    }

    /// The steady states at some speeds, rpm, as the time steps have them.
    ///
    /// # Errors
    /// If one is not found, or is not steady.
    pub(super) fn motions_in_steps(&self, speeds_rpm: &[f64]) -> Result<Motions, ExperimentError> {
        let refused = |e: crate::sweep::PlanError| ExperimentError::Model(e.to_string().into());
        let steady = SteadySettings { keeps_steps: true, ..self.request.steady.clone() };
        let highest = steady.harmonics;
        let plan = Plan::new(speeds_rpm, &[Direction::Up], steady).map_err(refused)?;
        self.model.prepare()?;
        let states = Mutex::new(Vec::new());
        let keep = |kept: &Kept| {
            if let (Kept::Found { point, state }, Ok(mut states)) = (kept, states.lock()) {
                let (rpm, size) = (point.state.case.speed_rpm, point.size);
                states.push(StateAt { rpm, state: state.clone(), size });
            }
        };
        let sweep = run(&self.model, &plan, &Memory, &keep)?.complete()?.steady()?;
        let of = |p: &SweepPoint| {
            let own = Harmonics::of(p, self.request.response, self.radius, highest);
            (p.state.case.speed_rpm, own)
        };
        let stepped: Vec<_> = sweep.points().into_iter().map(of).collect();
        let states = states.into_inner().unwrap_or_default();
        Ok(Motions { sweep, at: stepped.clone(), stepped, states })
    }
}

impl Motions {
    /// Largest root mean square over the speeds, m.
    pub(super) fn largest(&self) -> f64 {
        largest(&self.at)
    }

    /// The response at the speed where it is largest.
    pub(super) fn top(&self) -> Option<&(f64, Harmonics)> {
        self.at.iter().max_by(|a, b| a.1.rms().total_cmp(&b.1.rms()))
    }

    /// The response at one of the speeds, rpm, with the change of frequency by the time steps.
    pub(super) fn in_steps(&self, rpm: f64) -> Option<&Harmonics> {
        self.stepped.iter().find(|(speed, _)| *speed == rpm).map(|(_, own)| own)
    }

    /// All responses by speed, with the change of frequency by the time steps.
    pub(super) fn stepped(&self) -> impl Iterator<Item = &Harmonics> {
        self.stepped.iter().map(|(_, own)| own)
    }

    /// Change of the amplitude from this motion to another one over the speeds that both have, and at least half of their
    /// distance, over the largest amplitude of this one: a change of phase alone leaves the amplitude as it is, but
    /// may come out otherwise on other settings.
    pub(super) fn moved(&self, other: &Self) -> f64 {
        moved(&self.at, &other.at)
    }

    /// Largest distance between the motion with and without the change of frequency by the time steps, over the largest amplitude.
    pub(super) fn apart_by_correction(&self) -> f64 {
        apart(&self.at, &self.stepped)
    }

    /// What the largest amplitude was changed by when the change of frequency by the time steps was taken out, of itself.
    pub(super) fn corrected_by(&self) -> f64 {
        self.largest() / largest(&self.stepped) - 1.0
    }

    /// Largest change of a steady state from one cycle to the next, over its peak-to-peak vibration.
    pub(super) fn residual(&self) -> f64 {
        self.sweep.points().into_iter().fold(0.0, |a, p| a.max(p.residual))
    }

    /// Largest root mean square of the whole motion of the sun, rotation at its base circle and translation, m.
    pub(super) fn of_sun(&self, turning: &Turning<'_>) -> f64 {
        let both = [AutoResponse::TransmissionError, AutoResponse::SunTranslation];
        let highest = turning.request.steady.harmonics;
        let of = |p| both.map(|r| Harmonics::of(p, r, turning.radius, highest).rms());
        self.sweep.points().into_iter().map(|p| of(p)[0].hypot(of(p)[1])).fold(0.0, f64::max)
    }
}

/// Responses by speed, rpm.
type BySpeed = [(f64, Harmonics)];

fn largest(at: &BySpeed) -> f64 {
    at.iter().map(|(_, own)| own.rms()).fold(0.0, f64::max)
}

/// Largest of what `of` gives for two motions at a speed that both have, over the largest amplitude of the first.
fn between(one: &BySpeed, other: &BySpeed, of: impl Fn(&Harmonics, &Harmonics) -> f64) -> f64 {
    let at = |(rpm, own): &(f64, Harmonics)| {
        let same = other.iter().find(|(speed, _)| speed == rpm);
        same.map_or(0.0, |(_, theirs)| of(own, theirs))
    };
    one.iter().map(at).fold(0.0, f64::max) / largest(one)
}

fn apart(one: &BySpeed, other: &BySpeed) -> f64 {
    between(one, other, Harmonics::distance)
}

fn moved(one: &BySpeed, other: &BySpeed) -> f64 {
    between(one, other, |a, b| (a.rms() - b.rms()).abs()).max(0.5 * apart(one, other))
}

#[cfg(test)]
mod tests {
    use gearset::{SceneKind, template};

    use super::super::amplitude::tests::oh58;
    use super::*;

    /// A motion with twice the steps on the tables of fewer is that of a candidate by itself.
    #[test]
    fn more_steps_on_known_tables_give_the_motion_of_their_own() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let request = AmplitudeRequest {
            response: AutoResponse::TransmissionError,
            speeds_rpm: vec![1100.0],
            steady: SteadySettings { between_cycles: 0, ..SteadySettings::default() },
            tolerance_percent: 5.0,
        };
        let few = AutoSettings::quasi_static(6, 20).with_steps(60);
        let more = few.with_steps(120);
        let alone = on((&scene, &case), more, &request, |own| own.motions(&request.speeds_rpm));
        let shared = on((&scene, &case), few, &request, |own| {
            own.motions(&request.speeds_rpm)?;
            own.with_steps(more, |own| own.motions(&request.speeds_rpm))
        });
        let off = apart(&alone.unwrap().stepped, &shared.unwrap().stepped);
        assert!(off < 1e-7, "{off:e}");
    }

    /// OH-58 with four planets at 60 steps a cycle: the lines of the linearised motion give the computed motion of the sun again, and without the frequency of the steps
    /// both responses are nearer to those of 480 steps at every speed, three times and more taken together.
    #[test]
    fn motions_in_few_steps_are_corrected_towards_those_in_many() {
        for response in [AutoResponse::TransmissionError, AutoResponse::SunTranslation] {
            let (scene, case, request) = oh58(response, &[1100.0, 1500.0, 2500.0]);
            let of = |case: &LoadCase, steps| {
                let own = AutoSettings::quasi_static(6, 20).with_steps(steps);
                let made = on((&scene, case), own, &request, |turning| {
                    let found = turning.motions(&request.speeds_rpm)?;
                    let rest = turning.at_rest()?;
                    for (rpm, own) in &found.stepped {
                        let cycle = turning.over_cycle(&found, *rpm, StepOfCycle::of)?;
                        let linear = LinearMotion::new(&cycle, turning.mesh_hz(*rpm))?;
                        let again = |l: usize| rest.response(&-linear.lines()[l].clone());
                        let left = own.changed(again).rms();
                        // Steady states repeat to 1e-9 of their peak to peak.
                        assert!(left < 1e-8 * own.rms(), "{response:?}: {left:e} of {}", own.rms());
                    }
                    Ok(found)
                });
                made.unwrap()
            };
            let (few, many) = (of(&case, 60), of(&case, 480));
            let (mut before, mut after) = (0.0, 0.0);
            for k in 0..3 {
                let exact = &many.at[k].1;
                let [a, b] =
                    [&few.stepped, &few.at].map(|own| own[k].1.distance(exact) / exact.rms());
                println!("{response:?}: {a:.4} off in steps, {b:.4} corrected");
                assert!(b < a, "{response:?}, speed {k}: {a} {b}");
                (before, after) = (before + a, after + b);
            }
            assert!(after < before / 3.0, "{response:?}: {before} {after}");
        }
    }
}
