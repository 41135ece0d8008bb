//! Three planets in phase on soft bearings: at any windup of the set a mesh deflects as the isolated gear
//! pair does at the same centre distance and phase.

use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::MeshTable;
use fe_contact::statics::{StaticSet, press};
use gearset::{MeshKind, PairLocation};

use super::{POSITIONS, control, unloaded};
use crate::error::ValidationError;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

const TORQUE: f64 = 1130.0;

/// Stiffness of the planet bearings over that of the scene.
const BEARINGS: [(&str, &str, f64); 3] = [
    ("stiff", "ten times as stiff", 10.0),
    ("own", "as they are", 1.0),
    ("soft", "a tenth as stiff", 0.1),
];

/// Largest differences of planet 0's sun mesh from the pair alone over a mesh cycle, µm.
struct Differences {
    /// Where all loaded pairs are on the theoretical path.
    on_path: f64,
    /// At all positions.
    anywhere: f64,
    /// Displacement of the planet's centre from its unloaded position.
    windup: f64,
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    let mut softest = lab.three.clone();
    for (id, words, times) in BEARINGS {
        let mut scene = lab.three.clone();
        scene.supports.planet_bearing_n_per_m *= times;
        let set = unloaded(&scene, &lab.bodies)?.under(TORQUE)?;
        let found = differences(lab, &set)?;
        for (place, words_of_place, off) in [
            ("on_path", "where pairs press on the path alone", found.on_path),
            ("anywhere", "corners too", found.anywhere),
        ] {
            let id = format!("fe.kinematics.bearings.{place}.{id}");
            let title = format!(
                "three planets, {TORQUE} N·m, planet bearings {words}: approach of a sun mesh against the pair alone under its share of the torque at that centre distance and phase, {words_of_place}"
            );
            let note = format!("planets off by up to {:.0} µm", found.windup);
            checks.push(lab.about(&id, &title)?.note(note).at_most(off));
        }
        softest = scene;
    }
    let found = differences(lab, &unloaded(&softest, &lab.bodies)?)?;
    let id = "fe.kinematics.bearings.control.unloaded";
    let judged_by = "fe.kinematics.bearings.anywhere.soft";
    checks.push(control(lab, id, judged_by, found.anywhere)?);
    Ok(checks)
}

fn differences(lab: &Lab<'_>, set: &StaticSet<'_>) -> Result<Differences, ValidationError> {
    let missing = || ValidationError::Incomplete("sun mesh");
    let cycle = set.cycle_here(TORQUE, POSITIONS, &ActiveSet)?;
    let kind = MeshKind::SunPlanet;
    let nominal = lab.bodies.geometry.mesh(kind).ok_or_else(missing)?;
    let pair = lab.bodies.pair(kind).ok_or_else(missing)?;
    let sun = lab.bodies.geometry.sun.as_ref().ok_or_else(missing)?;
    let force = TORQUE / 3.0 / sun.base_radius;
    let (mut on_path, mut anywhere) = (Vec::new(), Vec::new());
    for state in &cycle.states {
        let own = state.meshes.first().ok_or_else(missing)?;
        // Planet 0 stands on the x axis: its frame is that of the scene.
        let ([x, y, turned], [zeta, eta, rolled]) = (state.central[2], state.planets[0]);
        let places = [x, y, turned, zeta, eta, rolled];
        let found = nominal.displaced(state.position - cycle.lead, &places);
        let found = found.map_err(|_| missing())?;
        // Pair numbers refer to the phase reduced to one cycle.
        let found = found.turned_by(-(found.phase() - own.phase).round());
        let mesh = nominal.at_center_distance(found.center_distance).map_err(|_| missing())?;
        let phase = found.phase().rem_euclid(1.0);
        let table = MeshTable::new(&mesh, pair, phase, &lab.bodies.cells(force))?;
        let (alone, _) = press(&table, &mesh, force, &ActiveSet)?;
        let off = 1e6 * (found.approach - alone).abs();
        anywhere.push(off);
        if own.pairs.iter().all(|p| found.location(p.index) == PairLocation::Path) {
            on_path.push(off);
        }
    }
    let windup = cycle.states.iter().map(|s| 1e6 * s.planets[0][0].hypot(s.planets[0][1]));
    Ok(Differences { on_path: worst(on_path), anywhere: worst(anywhere), windup: worst(windup) })
}
