//! Loads given on the command line: finite, of a size that the linear theory can bear, and warned of where they are
//! large.

use std::io::Write;
use std::path::Path;

use scene::{LoadCase, LoadSize, Scene};

use crate::error::{Result, refused, unfit};

/// Torque on the sun, N·m: that of `--sun-torque-nm`, or the operating point's; neither 0.
pub(crate) fn sun_torque(
    asked: Option<f64>,
    path: &Path,
    scene: &Scene,
    err: &mut dyn Write,
) -> Result<f64> {
    let Some(torque) = asked else {
        let torque = operating_torque(path, scene)?;
        // A scene with more than the linear theory can bear is refused when it is read, and one that comes near it
        // warned of.
        let size = scene.size_of_sun_torque(torque);
        return match size.and_then(|size| size.refusal(torque, "N·m on the sun")) {
            Some(reason) => Err(unfit(path, format!("`operation.torque_nm` gives {reason}"))),
            None => Ok(torque),
        };
    };
    if !torque.is_finite() || torque == 0.0 {
        let reason = format!(
            "{torque} N·m: allowed is a finite torque other than 0 N·m, at which nothing touches"
        );
        return Err(refused("--sun-torque-nm", reason));
    }
    sized("--sun-torque-nm", torque, "N·m", scene.size_of_sun_torque(torque), err)?;
    Ok(torque)
}

/// Refuses a range of torques on the sun, N·m, whose ends are of no size that a model can bear.
pub(crate) fn torque_range(
    argument: &'static str,
    ends: [f64; 2],
    scene: &Scene,
    err: &mut dyn Write,
) -> Result<()> {
    ends.into_iter()
        .try_for_each(|end| sized(argument, end, "N·m", scene.size_of_sun_torque(end), err))
}

/// Normal force of a gear pair, N: that of `--normal-force-n`, or |T|/r_b of the operating point.
pub(crate) fn normal_force(asked: Option<f64>, scene: &Scene, err: &mut dyn Write) -> Result<f64> {
    let Some(force) = asked.or_else(|| scene.pair_force_n()) else {
        let name = &scene.title;
        let reason = format!(
            "is absent: `{name}` is a gear pair, loaded by a normal force in N, or, of a sun and a planet, by `operation.torque_nm`"
        );
        return Err(refused("--normal-force-n", reason));
    };
    if asked.is_none() {
        // A torque that is too large was refused when the scene was read.
        let size = scene.size_of_normal_force(force);
        return match size.and_then(|size| size.refusal(force, "N along the line of action")) {
            Some(reason) => Err(refused(
                "--normal-force-n",
                format!("is absent, and `operation.torque_nm` gives {reason}"),
            )),
            None => Ok(force),
        };
    }
    if !(force.is_finite() && force > 0.0) {
        let reason = format!("{force}: allowed is a finite force above 0 N; flanks only press");
        return Err(refused("--normal-force-n", reason));
    }
    sized("--normal-force-n", force, "N", scene.size_of_normal_force(force), err)?;
    Ok(force)
}

/// Approach of a gear pair, µm.
pub(crate) fn approach(asked_um: f64, scene: &Scene, err: &mut dyn Write) -> Result<f64> {
    if !(asked_um.is_finite() && asked_um > 0.0) {
        let reason = format!("{asked_um}: allowed is a finite approach above 0 µm");
        return Err(refused("--approach-um", reason));
    }
    sized("--approach-um", asked_um, "µm", scene.size_of_approach(1e-6 * asked_um), err)?;
    Ok(asked_um)
}

/// Refuses a load under which teeth give way by more than a module or less than a millionth of one, and warns from a
/// quarter of a module on, as the scene's own `operation.torque_nm` is refused and warned of.
fn sized(
    argument: &'static str,
    load: f64,
    unit: &str,
    size: Option<LoadSize>,
    err: &mut dyn Write,
) -> Result<()> {
    let Some(size) = size else { return Ok(()) };
    if let Some(reason) = size.refusal(load, unit) {
        return Err(refused(argument, reason));
    }
    if size.is_worth_a_warning() {
        let way = size.words();
        writeln!(err, "warning: {argument} is {load} {unit}: {way}; likely a slip of unit")?;
    }
    Ok(())
}

/// Torque on the sun at the operating point, other than 0.
fn operating_torque(path: &Path, scene: &Scene) -> Result<f64> {
    let torque = LoadCase::of_scene(scene).ok().map(|case| case.sun_torque_nm);
    torque.filter(|t| *t != 0.0).ok_or_else(|| {
        let reason =
            "`operation.torque_nm` is absent or 0: give it, or the argument --sun-torque-nm";
        unfit(path, reason)
    })
}
