//! `impulse SCENE`: the virtual modal test of a standing set under torque.

use std::io::Write;

use experiments::ExperimentError;
use experiments::modal::{
    FeMode, FrequencyBand, ImpulseSettings, ImpulseTest, Preload, SettingsError, frequency_band,
    impulse_test, linear_modes, mesh_influence, preloaded,
};
use fe_contact::FeError;
use fe_contact::statics::{Bodies, Races};
use gearset::{Fidelity, LoadCase, Scene, SceneKind};
#[cfg(feature = "charts")]
use validation::ValidationError;

use crate::arguments::{Impulse, TableFormat};
use crate::error::CommandError;
use crate::output;

use super::impulse_output::ImpulseOutput;
use super::statics::{operating_torque, refused};
use super::{fe_refused, impulse_text, read_scene, unfit};

/// Parts of the torque for which `--band` linearises.
const BAND_TORQUES: [f64; 3] = [0.5, 1.0, 1.5];

/// Positions of the mesh cycle at which it does.
const BAND_POSITIONS: usize = 28;

/// Highest frequency it lists, Hz.
const BAND_HIGHEST_HZ: f64 = 16e3;

/// All that was found.
pub(super) struct Found {
    pub(super) scene: Scene,
    #[cfg_attr(not(feature = "charts"), expect(dead_code, reason = "figures show its gears"))]
    pub(super) bodies: Bodies,
    pub(super) races: Races,
    pub(super) test: ImpulseTest,
    /// Linearised modes in the band of the test with their ∂ln f/∂ln k_mesh; none for bodies with
    /// every degree of freedom.
    pub(super) linear: Option<Vec<(FeMode, f64)>>,
    pub(super) band: Option<FrequencyBand>,
}

pub(super) fn run(arguments: &Impulse, out: &mut dyn Write) -> Result<(), CommandError> {
    let scene = read_scene(&arguments.scene)?;
    let settings = settings(arguments, &scene)?;
    let found = find(arguments, scene, &settings)?;
    #[cfg(feature = "charts")]
    if let Some(folder) = &arguments.figures {
        draw(&found, folder)?;
    }
    let result = ImpulseOutput::new(&found);
    match arguments.format {
        TableFormat::Json => output::json(out, &result),
        TableFormat::Csv => impulse_text::csv(&result, out),
        TableFormat::Text => Ok(impulse_text::text(&found.scene.title, &result, out)?),
    }
}

#[cfg(feature = "charts")]
fn draw(found: &Found, folder: &std::path::Path) -> Result<(), CommandError> {
    use crate::figures::{ModalTest, of_impulse_test, save};
    let Found { scene, bodies, races, test, band, .. } = found;
    let geometry = &bodies.geometry;
    let figures = of_impulse_test(&ModalTest { scene, geometry, races, test, band: band.as_ref() });
    Ok(save(&figures.map_err(ValidationError::from)?, folder)?)
}

/// What is asked for, if it makes sense.
fn settings(arguments: &Impulse, scene: &Scene) -> Result<ImpulseSettings, CommandError> {
    let path = &arguments.scene;
    if scene.kind != SceneKind::Planetary {
        return Err(unfit(path, "`kind` is \"gear_pair\": a modal test needs \"planetary\""));
    }
    if scene.geometry.is_none() {
        return Err(unfit(path, "[geometry] is absent: teeth are needed to touch"));
    }
    if scene.dynamics.fidelity == Fidelity::MeshLaw {
        let reason = "`dynamics.fidelity` = \"mesh_law\" solves no contact, which a modal test stands on: \
                      take \"quasi_static\", \"modal\" or \"full\"";
        return Err(unfit(path, reason));
    }
    let torque_nm = match arguments.torque_nm {
        Some(torque) => torque,
        None => operating_torque(path, scene)?,
    };
    let mut settings = ImpulseSettings::at(LoadCase::standing(torque_nm), arguments.position);
    settings.preload.step_s = 1e-6 * arguments.step_us;
    settings.duration_s = 1e-3 * arguments.duration_ms;
    settings.check().map_err(|e| refused(argument(&e), e.to_string()))?;
    if arguments.band && scene.dynamics.fidelity == Fidelity::Full {
        let reason = "`dynamics.fidelity` = \"full\" has no small linearisation: take \"modal\"";
        return Err(refused("--band", reason));
    }
    #[cfg(feature = "charts")]
    let is_drawn = arguments.figures.is_some();
    #[cfg(not(feature = "charts"))]
    let is_drawn = false;
    if arguments.band && arguments.format == TableFormat::Csv && !is_drawn {
        let reason = "CSV has one row a mode and no place for it: take text, json or --figures";
        return Err(refused("--band", reason));
    }
    Ok(settings)
}

/// The argument a setting comes from.
fn argument(error: &SettingsError) -> &'static str {
    match error {
        SettingsError::NoTorque | SettingsError::Torque(_) => "--torque-nm",
        SettingsError::Position(_) => "--position",
        SettingsError::Step { .. } => "--step-us",
        SettingsError::Duration { .. } | SettingsError::Steps { .. } => "--duration-ms",
    }
}

fn find(
    arguments: &Impulse,
    scene: Scene,
    settings: &ImpulseSettings,
) -> Result<Found, CommandError> {
    let path = &arguments.scene;
    let torque = settings.preload.load.sun_torque_nm;
    let failed = |e: ExperimentError| match e {
        ExperimentError::Unsteady { .. } => refused("--torque-nm", e.to_string()),
        ExperimentError::Fe(FeError::NotConverged { .. } | FeError::NoEquilibrium(_)) => {
            refused("--torque-nm", format!("{torque:e} N·m: {e}"))
        }
        _ => unfit(path, e.to_string()),
    };
    let bodies = Bodies::new(&scene).map_err(fe_refused(path))?;
    let set = preloaded(&scene, &bodies, &settings.preload).map_err(|e| failed(e.into()))?;
    let races = set.races().clone();
    let linear = if scene.dynamics.fidelity == Fidelity::Full {
        None
    } else {
        let linear = set.linearised().map_err(fe_refused(path))?;
        let modes = linear_modes(&set, &linear).map_err(failed)?;
        let influence = mesh_influence(&linear).map_err(failed)?;
        let (low, high) = settings.band_hz;
        let all = modes.into_iter().zip(influence.iter().map(|i| i.all_meshes));
        Some(all.filter(|(m, _)| (low..=high).contains(&m.frequency_hz)).collect())
    };
    drop(set);
    let test = impulse_test(&scene, &bodies, settings).map_err(failed)?;
    let band = arguments.band.then(|| {
        let preload: &Preload = &settings.preload;
        let (factors, count) = (&BAND_TORQUES, BAND_POSITIONS);
        frequency_band(&scene, &bodies, preload, factors, count, BAND_HIGHEST_HZ)
    });
    let band = band.transpose().map_err(failed)?;
    Ok(Found { scene, bodies, races, test, linear, band })
}
