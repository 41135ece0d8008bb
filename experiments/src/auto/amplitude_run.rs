//! Steady states of one candidate for an amplitude.

use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::VibratingSet;
use gearset::{AutoResponse, LoadCase, MeshKinematics, Scene};

use super::amplitude::AmplitudeRequest;
use super::response::Harmonics;
use super::settings::AutoSettings;
use crate::error::ExperimentError;
use crate::modal::{Preload, preloaded};
use crate::sweep::{Direction, FeModel, Memory, Plan, Sweep, SweepModel, run};

/// A candidate with its gears and contact tables, which its runs share.
pub(super) struct Turning<'b> {
    pub(super) bodies: &'b Bodies,
    pub(super) scene: Scene,
    model: FeModel<'b>,
    case: &'b LoadCase,
    request: &'b AmplitudeRequest,
    /// Base radius of the sun, m.
    radius: f64,
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
    work(&Turning { bodies: &bodies, scene, model, case, request, radius })
}

/// Steady states at some speeds.
pub(super) struct Motions {
    pub(super) sweep: Sweep,
    /// Speed (rpm) and response, by speed.
    at: Vec<(f64, Harmonics)>,
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

    /// What `each` gives at every step of a cycle of the steady state at a speed, rpm.
    ///
    /// # Errors
    /// If the motion does not become steady, and as `each`.
    pub(super) fn over_cycle<T>(
        &self,
        rpm: f64,
        each: impl Fn(&VibratingSet<'_>) -> Result<T, ExperimentError>,
    ) -> Result<Vec<T>, ExperimentError> {
        self.model.over_cycle(&self.case.at_speed(rpm), &self.request.steady, each)
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

    /// The steady states at some speeds, rpm.
    ///
    /// # Errors
    /// If one is not found, or is not steady.
    pub(super) fn motions(&self, speeds_rpm: &[f64]) -> Result<Motions, ExperimentError> {
        let refused = |e: crate::sweep::PlanError| ExperimentError::Model(e.to_string().into());
        let steady = self.request.steady.clone();
        let highest = steady.harmonics;
        let plan = Plan::new(speeds_rpm, &[Direction::Up], steady).map_err(refused)?;
        self.model.prepare()?;
        let sweep = run(&self.model, &plan, &Memory, &|_| ())?.complete()?;
        if let Some(point) = sweep.points().into_iter().find(|p| !p.is_steady) {
            let rpm = point.state.case.speed_rpm;
            let why = format!("at {rpm} rpm the motion has not become steady");
            return Err(ExperimentError::Model(why.into()));
        }
        let points = sweep.points().into_iter();
        let of = |p| Harmonics::of(p, self.request.response, self.radius, highest);
        let at = points.map(|p| (p.state.case.speed_rpm, of(p))).collect();
        Ok(Motions { sweep, at })
    }
}

impl Motions {
    /// Largest root mean square over the speeds, m.
    pub(super) fn largest(&self) -> f64 {
        self.at.iter().map(|(_, own)| own.rms()).fold(0.0, f64::max)
    }

    /// The response at the speed where it is largest.
    pub(super) fn top(&self) -> Option<&(f64, Harmonics)> {
        self.at.iter().max_by(|a, b| a.1.rms().total_cmp(&b.1.rms()))
    }

    /// All responses by speed.
    pub(super) fn responses(&self) -> impl Iterator<Item = &Harmonics> {
        self.at.iter().map(|(_, own)| own)
    }

    /// Largest distance between this motion and another one over the speeds that both have, over the largest amplitude
    /// of this one.
    pub(super) fn apart(&self, other: &Self) -> f64 {
        let of = |(rpm, own): &(f64, Harmonics)| {
            let same = other.at.iter().find(|(speed, _)| speed == rpm);
            same.map_or(0.0, |(_, theirs)| own.distance(theirs))
        };
        self.at.iter().map(of).fold(0.0, f64::max) / self.largest()
    }

    /// Change of the amplitude from this motion to another one over the speeds that both have, and at least half of their
    /// distance, over the largest amplitude of this one: a change of phase alone leaves the amplitude as it is, but
    /// may come out otherwise on other settings.
    pub(super) fn moved(&self, other: &Self) -> f64 {
        let of = |(rpm, own): &(f64, Harmonics)| {
            let same = other.at.iter().find(|(speed, _)| speed == rpm);
            same.map_or(0.0, |(_, theirs)| (own.rms() - theirs.rms()).abs())
        };
        let change = self.at.iter().map(of).fold(0.0, f64::max) / self.largest();
        change.max(0.5 * self.apart(other))
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

#[cfg(test)]
mod tests {
    use gearset::{SceneKind, template};

    use super::*;
    use crate::sweep::SteadySettings;

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
        let off = alone.unwrap().apart(&shared.unwrap());
        assert!(off < 1e-7, "{off:e}");
    }
}
