//! Machines that are not driven through the sun: a carrier that drives against a held ring, a ring that drives
//! against a held sun. Their tooth pairs run from the end of the path of contact to its start.

use experiments::sweep::{
    Coordinate, Direction, FeModel, Memory, Part, Plan, SteadyState, Sweep, run,
};
use fe_contact::statics::Imperfections;
use gearset::{Geometry, Member};
use scene::{LoadCase, Scene};

use super::sweeps::{marches, order, steady_settings};
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

/// The machines with their names in checks, and speeds of the driven member, rpm.
const MACHINES: [(PublishedScene, &str, [f64; 2]); 2] = [
    (PublishedScene::WindTurbineStage, "machine_wind_turbine", [25.0, 40.0]),
    (PublishedScene::AutomaticTransmissionSet, "machine_transmission", [2000.0, 3500.0]),
];

pub(super) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    for (which, name, speeds) in MACHINES {
        let machine = scene(which)?;
        let found = swept(lab, &machine, &speeds)?;
        checks.extend(marches(lab, name, &found.points())?);
        checks.push(order(lab.reference, &machine, name, &found.states())?);
        let id = format!("sweep.member_torques.{name}");
        let title =
            "mean torques of meshes and pins on sun and ring against those of the numbers of teeth";
        let off = found.states().into_iter();
        let bodies = lab.gears.of(&machine)?;
        let off = off.map(|state| torques_off(&machine, &bodies.geometry, state));
        let off: Vec<f64> = off.collect::<Result<_, _>>()?;
        checks.push(lab.about(&id, title)?.at_most(1e2 * worst(off)));
        // Control: the machine turns the other way under the same torque.
        let mut turned_over = machine.clone();
        if let Some(operation) = &mut turned_over.operation {
            operation.speed_rpm = -operation.speed_rpm;
        }
        let found = swept(lab, &turned_over, &speeds[..1])?;
        let spoilt = [order(lab.reference, &machine, name, &found.states())?];
        let id = format!("sweep.control.{name}_turned_over");
        checks.push(lab.reference.control(&id, &spoilt)?);
    }
    Ok(checks)
}

fn swept(lab: &Lab<'_>, machine: &Scene, speeds: &[f64]) -> Result<Sweep, ValidationError> {
    let bodies = lab.gears.of(machine)?;
    let case = LoadCase::of_scene(machine)?;
    let model = FeModel::new(machine, &bodies, Imperfections::default(), case);
    let plan = Plan::new(speeds, &[Direction::Up], steady_settings())?;
    Ok(run(&model, &plan, &Memory, &|_| ())?.complete()?)
}

/// Largest deviation of r_b Σ F̄ of the meshes of sun and ring from the torques of the operating point, as part of
/// these.
fn torques_off(
    machine: &Scene,
    geometry: &Geometry,
    state: &SteadyState,
) -> Result<f64, ValidationError> {
    let operation = machine.operation.ok_or(ValidationError::Incomplete("operation"))?;
    let torques = machine.kinematics()?.torques_nm(operation.torque_nm);
    let planets = machine.planets.count();
    let off = [
        (Member::Sun, geometry.sun.as_ref(), Part::SunMesh as fn(usize) -> Part),
        (Member::Ring, geometry.ring.as_ref(), Part::RingMesh),
    ]
    .into_iter()
    .map(|(member, gear, mesh)| {
        let radius = gear.ok_or(ValidationError::Incomplete("gear"))?.base_radius;
        let mean = |n: usize| state.amplitude(mesh(n), Coordinate::Force, 0);
        let through: f64 = (0..planets).map(|n| radius * mean(n)).sum();
        Ok((through / torques.of(member).abs() - 1.0).abs())
    });
    let off: Vec<f64> = off.collect::<Result<_, ValidationError>>()?;
    Ok(worst(off))
}
