//! `impulse SCENE`: the virtual modal test of a standing set under torque.

mod found;
mod result;
mod text;

pub(crate) use result::ImpulseOutput;

use std::io::Write;

use experiments::modal::{
    FeMode, ImpulseSettings, ModalError, Preload, SettingsError, band_of, frequency_band,
    impulse_test, linear_modes, mesh_influence, preloaded, pulses,
};
use fe_contact::FeError;
use scene::{Fidelity, LoadCase, Scene, Verb};
#[cfg(feature = "charts")]
use validation::ValidationError;

use crate::arguments::{Format, Impulse};
use crate::error::{Result, fe_refused, refused, unfit};
use crate::inputs::{Run, Working, bodies, loads, needs, read_scene};
use crate::output;
use found::Found;

/// Parts of the torque for which `--band` linearises.
const BAND_TORQUES: [f64; 3] = [0.5, 1.0, 1.5];

/// Positions of the mesh cycle at which it does.
const BAND_POSITIONS: usize = 28;

/// Highest frequency it lists, Hz.
const BAND_HIGHEST_HZ: f64 = 16e3;

pub(super) fn run(arguments: &Impulse, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    let scene = read_scene(&arguments.scene, err)?;
    let preload = preload(arguments, &scene, err)?;
    let is_given = |a: &str| a == "--sun-torque-nm" && arguments.sun_torque_nm.is_some();
    needs::require(&arguments.scene, &scene, Verb::Impulse, is_given)?;
    needs::warn(&scene, Some(Verb::Impulse), arguments.figures.as_deref(), err)?;
    let found = find(arguments, scene, preload, err)?;
    let saved: Result<()> = Ok(());
    #[cfg(feature = "charts")]
    let saved = arguments.figures.as_ref().map_or(saved, |folder| draw(&found, folder));
    let result = ImpulseOutput::new(&found);
    // What was computed is shown also where its figures cannot be saved.
    saved.and(output::show(arguments.format, &result, out))
}

#[cfg(feature = "charts")]
fn draw(found: &Found, folder: &std::path::Path) -> Result<()> {
    use crate::figures::{ModalTest, of_impulse_test, save};
    let Found { scene, bodies, races, test, band, .. } = found;
    let geometry = &bodies.geometry;
    let figures = of_impulse_test(&ModalTest { scene, geometry, races, test, band: band.as_ref() });
    Ok(save(&figures.map_err(ValidationError::from)?, folder)?)
}

/// The preload that is asked for; every argument that can be judged without the set's modes is judged here.
fn preload(arguments: &Impulse, scene: &Scene, err: &mut dyn Write) -> Result<Preload> {
    let path = &arguments.scene;
    needs::not_ring_pair(path, scene)?;
    if scene.geometry.is_none() {
        return Err(unfit(path, "[geometry] is absent: teeth are needed to touch"));
    }
    if scene.dynamics.fidelity == Fidelity::MeshLaw {
        let reason = "`dynamics.fidelity` = \"mesh_law\" solves no contact, which a modal test stands on: \
                      take \"quasi_static\", \"modal\" or \"full\"";
        return Err(unfit(path, reason));
    }
    let torque_nm = loads::sun_torque(arguments.sun_torque_nm, path, scene, err)?;
    let usual = ImpulseSettings::at(LoadCase::standing(torque_nm), arguments.position);
    let band_hz = arguments.band_hz.map_or(usual.band_hz, |[low, high]| (low, high));
    // A band of one's own is judged with step and decay; without one, these wait for the band.
    let judged = match arguments.band_hz {
        Some(_) => asked(arguments, usual.preload, band_hz),
        None => usual,
    };
    judged.check().map_err(|e| refused(argument(&e), e))?;
    if arguments.band && scene.dynamics.fidelity == Fidelity::Full {
        let reason = "`dynamics.fidelity` = \"full\" has no small linearisation: take \"modal\"";
        return Err(refused("--band", reason));
    }
    if arguments.band && arguments.format == Format::Csv && arguments.figures.is_none() {
        let reason = "CSV has one row a mode and no place for it: take text, json or --figures";
        return Err(refused("--band", reason));
    }
    Ok(usual.preload)
}

/// Settings for a band, step and decay as asked for.
fn asked(arguments: &Impulse, preload: Preload, band_hz: (f64, f64)) -> ImpulseSettings {
    let mut settings = ImpulseSettings::in_band(preload.load, preload.position, band_hz);
    if let Some(step_us) = arguments.step_us {
        settings.preload.step_s = 1e-6 * step_us;
    }
    if let Some(duration_ms) = arguments.duration_ms {
        settings.duration_s = 1e-3 * duration_ms;
    }
    settings
}

/// The argument a setting comes from.
fn argument(error: &SettingsError) -> &'static str {
    match error {
        SettingsError::NoTorque | SettingsError::Torque(_) => "--sun-torque-nm",
        SettingsError::Position(_) => "--position",
        SettingsError::Band { .. } => "--band-hz",
        SettingsError::Step { .. } => "--step-us",
        SettingsError::Duration { .. } | SettingsError::Steps { .. } => "--duration-ms",
    }
}

fn find(arguments: &Impulse, scene: Scene, preload: Preload, err: &mut dyn Write) -> Result<Found> {
    let path = &arguments.scene;
    let torque = preload.load.sun_torque_nm;
    // The torque is that of the argument, or of the scene.
    let of_torque = |reason: String| match arguments.sun_torque_nm {
        Some(_) => refused("--sun-torque-nm", reason),
        None => unfit(path, format!("`operation.torque_nm` gives {reason}")),
    };
    let failed = |e: ModalError| match e {
        ModalError::Unsteady { .. } => of_torque(e.to_string()),
        ModalError::Fe(FeError::NotConverged { .. } | FeError::NoEquilibrium(_)) => {
            of_torque(format!("{torque:e} N·m on the sun: {e}"))
        }
        _ => unfit(path, e),
    };
    let working = Working::new("meshing and factorising the bodies");
    let bodies = bodies(path, &scene, arguments.large)?;
    working.now("linearising the set");
    let is_full = scene.dynamics.fidelity == Fidelity::Full;
    let mut linear_scene = scene.clone();
    if is_full {
        // Full bodies have no small linearisation: the quasi-static one says where modes are.
        linear_scene.dynamics.fidelity = Fidelity::QuasiStatic;
    }
    let set = preloaded(&linear_scene, &bodies, &preload).map_err(|e| failed(e.into()))?;
    let races = set.races().clone();
    let linear = set.linearised().map_err(fe_refused(path))?;
    let modes = linear_modes(&set, &linear).map_err(failed)?;
    let influence = mesh_influence(&linear).map_err(failed)?;
    drop(set);
    let frequencies: Vec<f64> = modes.iter().map(|m| m.frequency_hz).collect();
    let band_hz = match arguments.band_hz {
        Some([low, high]) => (low, high),
        None => band_of(&frequencies)
            .ok_or_else(|| unfit(path, "no body can move: every `motion` is \"held\""))?,
    };
    let settings = asked(arguments, preload, band_hz);
    settings.check().map_err(|e| refused(argument(&e), e))?;
    let run = Run::decays(&scene, pulses(&races).len(), settings.steps());
    run.admit(path, arguments.large, err)?;
    let (low, high) = band_hz;
    let is_inside = |m: &FeMode| (low..=high).contains(&m.frequency_hz);
    let (inside, outside): (Vec<_>, Vec<_>) = modes
        .into_iter()
        .zip(influence.iter().map(|i| i.all_meshes))
        .partition(|(mode, _)| is_inside(mode));
    let outside = outside.into_iter().map(|(mode, _)| mode).collect();
    let linear = (!is_full).then_some(inside);
    working.now("marching the free decays");
    let test = impulse_test(&scene, &bodies, &settings).map_err(failed)?;
    if arguments.band {
        working.now("linearising over the mesh cycle");
    }
    let band = arguments.band.then(|| {
        let preload: &Preload = &settings.preload;
        let (factors, count) = (&BAND_TORQUES, BAND_POSITIONS);
        frequency_band(&scene, &bodies, preload, factors, count, BAND_HIGHEST_HZ)
    });
    let band = band.transpose().map_err(failed)?;
    Ok(Found { scene, bodies, races, test, linear, outside, band })
}
