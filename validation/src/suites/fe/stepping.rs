//! The time step: energy, drift, ringing.

use dynamics::{Window, spectrum};
use fe_contact::statics::{Bodies, Imperfections};
use fe_contact::vibration::{Loading, NominalRotation, Prepared, VibratingSet};
use gearset::{Facing, PathDirection};
use scene::{LoadCase, Scene};

use crate::check::Check;
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

/// The nominal operating point of the OH-58: torque on the sun (N·m) and sun speed.
const TORQUE: f64 = 1413.0;
const SPEED_RPM: f64 = 1600.0;

/// Steps in a mesh cycle, and those at which the order of the scheme is seen.
const USUAL: usize = 140;
const FINER: [usize; 3] = [280, 560, 1120];

/// What sets that take so many steps in a mesh cycle share, however they are damped.
struct Turning<'b> {
    prepared: Prepared<'b>,
    rotation: NominalRotation,
}

impl<'b> Turning<'b> {
    fn new(
        scene: &Scene,
        bodies: &'b Bodies,
        steps_per_cycle: usize,
    ) -> Result<Self, ValidationError> {
        let mesh_frequency = LoadCase::of_scene(scene)?.at_speed(SPEED_RPM).mesh_frequency_hz;
        let sun = bodies.geometry.sun.as_ref().ok_or(ValidationError::Incomplete("sun"))?;
        let force = TORQUE / sun.base_radius / scene.planets.psi_rad.len() as f64;
        let rotation = NominalRotation::Turning {
            mesh_frequency,
            steps_per_cycle,
            direction: PathDirection::Forward,
        };
        let loading = Loading { torque_nm: TORQUE, mesh_force: force };
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let prepared = Prepared::new(scene, bodies, sense, none, rotation, loading)?;
        Ok(Self { prepared, rotation })
    }

    /// A set at rest under the torque, damped as the scene says.
    fn at_rest(&self, scene: &Scene) -> Result<VibratingSet<'b>, ValidationError> {
        let mut set = VibratingSet::on(scene, &self.prepared, self.rotation)?;
        set.rest(TORQUE)?;
        Ok(set)
    }
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let usual = Turning::new(&lab.four, &lab.bodies, USUAL)?;
    let mut checks = energy(lab, &usual)?;
    checks.extend(ringing(lab, &usual)?);
    Ok(checks)
}

/// Energy identity of every step, energy closure over a cycle, drift over 1000 cycles.
fn energy(lab: &Lab<'_>, usual: &Turning<'_>) -> Checks {
    // The contact energy of the closure does not include the lag, so β of the bodies is 0; all else damps.
    let mut scene = lab.four.clone();
    scene.damping.stiffness_proportional_s = 0.0;
    let (mut identity, mut undamped) = (Vec::new(), Vec::new());
    let (mut closures, mut missed) = (Vec::new(), Vec::new());
    for steps in [USUAL].into_iter().chain(FINER) {
        let finer;
        let turning = if steps == USUAL {
            usual
        } else {
            finer = Turning::new(&scene, &lab.bodies, steps)?;
            &finer
        };
        let mut set = turning.at_rest(&scene)?;
        // `turning_work` needs positions that were visited before, and the start-up transient, which contains
        // modes that 140 steps do not resolve, must have decayed.
        for _ in 0..20 * steps {
            set.step()?;
        }
        let (mut open, mut turned, mut size, mut each) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
        for _ in 0..steps {
            let (before, start) = (set.energies(), set.step_start());
            set.step()?;
            let (after, work) = (set.energies(), set.work_since(&start));
            let moved = after.kinetic - before.kinetic + after.bearings - before.bearings;
            let done = work.external - work.damped;
            size = size.max(after.kinetic + after.bearings);
            identity.push((moved - done + work.against_contact) / size);
            undamped.push((moved - work.external + work.against_contact) / size);
            let turning = set.turning_work(&start)?.unwrap_or(f64::NAN);
            let of_step = moved + after.contact - before.contact - done - turning;
            each += of_step.abs();
            open += of_step;
            turned += turning.abs();
        }
        closures.push((open / turned).abs());
        missed.push(each / turned);
    }
    let title = "energy of races and bearings against the forces' work, every step at 1600 rpm and 1413 N·m";
    let judged = |off: Vec<f64>| {
        Ok::<Check, ValidationError>(
            lab.about("fe.stepping.energy.identity", title)?.at_most(worst(off)),
        )
    };
    let mut checks = vec![judged(identity)?];
    let spoilt = [judged(undamped)?];
    checks.push(lab.reference.control("fe.stepping.control.dashpots", &spoilt)?);
    let title = "energy, contact's ½pᵀCp and the turning meshes' work included: what is open after a cycle over that work, 140 steps";
    let note = format!("{:.1e} with 280 steps", closures[1]);
    let about = lab.about("fe.stepping.energy.closure", title)?.note(note);
    checks.push(about.at_most(closures[0]));
    let title =
        "order at which that closes, what every step misses taken positive, from 140 to 1120 steps";
    // Over three halvings: how many steps there are in which cells begin to touch, and where in them, differs from one
    // number of steps to the next.
    let each: Vec<f64> = missed.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect();
    let order = each.iter().sum::<f64>() / each.len() as f64;
    let note = format!("{each:.2?} in its three halvings");
    let about = lab.about("fe.stepping.energy.closure_order", title)?.note(note);
    checks.push(about.number(2.0, order));
    // A thousand cycles: no secular drift.
    let mut set = usual.at_rest(&lab.four)?;
    let mut ends = Vec::new();
    for _ in 0..1000 {
        for _ in 0..USUAL {
            set.step()?;
        }
        let e = set.energies();
        ends.push(e.kinetic + e.bearings + e.contact);
    }
    let drift = (ends[999] / ends[499] - 1.0).abs();
    let title = "energy after 1000 mesh cycles against that after 500, 1600 rpm and 1413 N·m";
    checks.push(lab.about("fe.stepping.energy.drift", title)?.at_most(drift));
    Ok(checks)
}

/// The oscillation at half the sampling rate must not stand out in the spectrum of the mesh forces.
fn ringing(lab: &Lab<'_>, usual: &Turning<'_>) -> Checks {
    let mut checks = Vec::new();
    for (name, beta) in [("with_lag", None), ("without_lag", Some(0.0))] {
        let mut scene = lab.four.clone();
        if let Some(beta) = beta {
            scene.damping.stiffness_proportional_s = beta;
        }
        let mut set = usual.at_rest(&scene)?;
        for _ in 0..100 * USUAL {
            set.step()?;
        }
        let (mut forces, mut record) = (Vec::new(), Vec::new());
        for _ in 0..USUAL {
            set.step()?;
            set.mesh_forces(&mut forces);
            record.push(forces.clone());
        }
        let mut stands_out = Vec::new();
        for mesh in 0..record[0].len() {
            let of_mesh: Vec<f64> = record.iter().map(|f| f[mesh]).collect();
            let lines = spectrum(&of_mesh, 1.0, Window::Rectangular, 1)?.lines;
            let size = |k: usize| lines[k].re.hypot(lines[k].im);
            let around = (50..70).map(size).fold(0.0f64, f64::max);
            stands_out.push(size(70) / around);
        }
        let id = format!("fe.stepping.ringing.{name}");
        let words = name.replace('_', " ");
        let title = format!(
            "amplitude at half the sampling rate over the largest between harmonics 50 and 69, mesh forces {words}"
        );
        checks.push(lab.about(&id, &title)?.at_most(worst(stands_out)));
    }
    Ok(checks)
}
