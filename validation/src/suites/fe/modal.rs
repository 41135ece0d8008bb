//! The virtual modal test: Tables 2 and 3, identified against linearised modes, what pulses excite.

use experiments::modal::{
    FeMode, ImpulseSettings, ImpulseTest, impulse_test, linear_modes, mesh_influence, preloaded,
};
use experiments::models::{Changed, FeContact, ModalRoute};
use experiments::{ModalModel, NaturalMode};
use fe_contact::statics::Races;
use lumped::ModeType;
use scene::{LoadCase, Scene};

use crate::check::Check;
use crate::error::ValidationError;
use crate::mode_type::type_named;
use crate::published_table::Table;
use crate::reference::Reference;
use crate::suites::lab::of_model;
use crate::suites::{Checks, Lab};
use crate::worst::{paired, worst};

/// Preload of the paper's speed sweeps, N m; the paper does not give that of its impulse tests.
const TORQUE: f64 = 1130.0;

/// Position of the standing set, cycles. The paper gives none; other positions are in
/// docs/fe_dynamics_effects.md.
const POSITION: f64 = 0.0;

fn settings(position: f64) -> ImpulseSettings {
    ImpulseSettings::at(LoadCase::standing(TORQUE), position)
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    for scene in [&lab.three, &lab.four] {
        let name = Table::of_planets(scene.planets.count()).planets();
        let test = impulse_test(scene, &lab.bodies, &settings(POSITION))?;
        let set = preloaded(scene, &lab.bodies, &settings(POSITION).preload)?;
        let typed = linear_modes(&set, &set.linearised()?)?;
        checks.extend(routes(lab, name, &typed, &test)?);
        let own = leaks(set.races(), &test)?;
        // Three planets are in phase: rotation and translation are uncoupled at every position.
        let half = match name {
            "three" => None,
            _ => {
                let test = impulse_test(scene, &lab.bodies, &settings(POSITION + 0.5))?;
                Some(leaks(set.races(), &test)?)
            }
        };
        checks.extend(pulses(lab, name, own, half)?);
        if name == "four" {
            let mut stiffer = scene.clone();
            stiffer.supports.planet_bearing_n_per_m *= 1.05;
            let set = preloaded(&stiffer, &lab.bodies, &settings(POSITION).preload)?;
            let others = linear_modes(&set, &set.linearised()?)?;
            let spoilt = routes(lab, name, &others, &test)?;
            let id = "fe.modal.control.planet_bearings";
            checks.push(lab.reference.control(id, &spoilt)?);
        }
    }
    Ok(checks)
}

/// Our own rows of Tables 2 and 3, by impulse tests, with the sensitivity of each to mesh stiffness.
pub(crate) fn tables(lab: &Lab<'_>) -> Checks {
    let model = FeContact::sharing(lab.gears.clone()).by(ModalRoute::ImpulseTest);
    let mut checks = Vec::new();
    for scene in [&lab.three, &lab.four] {
        let number = Table::of_planets(scene.planets.count()).number();
        let mut own = printed(&model, std::slice::from_ref(scene), lab.reference)?;
        remark(lab, scene, &mut own)?;
        checks.extend(own);
        // By linearisation, which is much cheaper and deviates by as much.
        let spoilt = Changed::new(&lab.fe, stiffer_bearings);
        let spoilt = printed(&spoilt, std::slice::from_ref(scene), lab.reference)?;
        let id = format!("table{number}.fe_contact.control.bearings");
        checks.push(lab.reference.control(&id, &spoilt)?);
    }
    lab.gears.drop_unused();
    Ok(checks)
}

/// Every bearing 1.5 times as stiff.
fn stiffer_bearings(scene: &mut Scene) {
    let supports = &mut scene.supports;
    supports.planet_bearing_n_per_m *= 1.5;
    for member in [&mut supports.carrier, &mut supports.ring, &mut supports.sun] {
        member.bearing_n_per_m *= 1.5;
    }
}

/// Natural modes against the FE/contact columns of Tables 2 and 3: the k-th frequency of each row's type,
/// translational ones by the mean of their pair. `scenes`: the sets of Table 1.
pub(crate) fn printed(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let mut checks = Vec::new();
    for scene in scenes {
        let table = Table::of_planets(scene.planets.count());
        let found = model.natural_modes(scene, &LoadCase::standing(TORQUE)).map_err(of_model)?;
        checks.extend(rows(table, &found, reference)?);
        checks.push(types(table, &found, reference)?);
    }
    Ok(checks)
}

/// Highest frequency whose type is compared: a little above the last row.
const HIGHEST_HZ: f64 = 3000.0;

/// Distinct frequencies of one type: the members of a pair that the printed table does not tell apart
/// by their mean, with both.
fn pairs(modes: &[NaturalMode], mode_type: ModeType) -> Vec<(f64, Vec<f64>)> {
    // Rigid-body motion is in no table.
    let own = modes.iter().filter(|m| m.mode_type == mode_type && m.frequency_hz > 1.0);
    let mut list: Vec<f64> = own.map(|m| m.frequency_hz).collect();
    list.sort_by(f64::total_cmp);
    let width = if mode_type == ModeType::Translational { 2 } else { 1 };
    list.chunks(width).map(|c| (c.iter().sum::<f64>() / c.len() as f64, c.to_vec())).collect()
}

fn rows(table: Table, modes: &[NaturalMode], reference: &Reference) -> Checks {
    let mut seen: Vec<&str> = Vec::new();
    let mut checks = Vec::new();
    for (row, (name, &hz)) in table.printed(reference).fe_contact_rows().enumerate() {
        let earlier = seen.iter().filter(|s| **s == name).count();
        seen.push(name);
        let found = pairs(modes, type_named(name)).get(earlier).cloned();
        let (mean, both) = found.unwrap_or((f64::NAN, Vec::new()));
        let number = table.number();
        let id = format!("table{number}.fe_contact.{}", row + 1);
        let each: Vec<String> = both.iter().map(|f| format!("{f:.0}")).collect();
        let title = format!("Table {number}, FE/contact: {name} mode {}", earlier + 1);
        let about = reference.about(&id, &title)?.source(&reference.parker.source);
        checks.push(about.note(format!("{} Hz", each.join(" and "))).number(hz, mean));
    }
    Ok(checks)
}

/// Adds to the note of each row the sensitivity of its frequency to mesh stiffness.
fn remark(lab: &Lab<'_>, scene: &Scene, checks: &mut [Check]) -> Result<(), ValidationError> {
    let set = preloaded(scene, &lab.bodies, &settings(POSITION).preload)?;
    let linear = set.linearised()?;
    let (typed, influence) = (linear_modes(&set, &linear)?, mesh_influence(&linear)?);
    for check in checks.iter_mut().filter(|c| c.unit == "Hz") {
        let Some(crate::Value::Number(hz)) = check.actual else { continue };
        let off = |m: &FeMode| (m.frequency_hz - hz).abs();
        let nearest = typed.iter().zip(&influence).min_by(|a, b| off(a.0).total_cmp(&off(b.0)));
        if let (Some((_, influence)), Some(note)) = (nearest, &mut check.note) {
            note.push_str(&format!("; ∂ln f/∂ln k of all meshes {:.3}", influence.all_meshes));
        }
    }
    Ok(())
}

/// Types, pairs counted once. The order of modes of different types, which may differ from the paper's, is
/// not compared here; within a type the modes are in ascending order.
fn types(
    table: Table,
    modes: &[NaturalMode],
    reference: &Reference,
) -> Result<Check, ValidationError> {
    let low: Vec<NaturalMode> =
        modes.iter().filter(|m| m.frequency_hz < HIGHEST_HZ).copied().collect();
    let mut expected: Vec<&str> = table.printed(reference).fe_contact_rows().map(|r| r.0).collect();
    expected.sort_unstable();
    let mut actual: Vec<&str> = Vec::new();
    for mode_type in
        [ModeType::Mixed, ModeType::Planet, ModeType::Rotational, ModeType::Translational]
    {
        actual.extend(pairs(&low, mode_type).iter().map(|_| mode_type.name()));
    }
    actual.sort_unstable();
    let number = table.number();
    let id = format!("table{number}.fe_contact.types");
    let title = format!("Table {number}, FE/contact: types of the modes below 3 kHz");
    let about = reference.about(&id, &title)?.source(&reference.parker.source);
    Ok(about.equal(expected, actual))
}

/// Identified against linearised frequencies and damping.
fn routes(lab: &Lab<'_>, name: &str, typed: &[FeMode], test: &ImpulseTest) -> Checks {
    let (low, high) = test.settings.band_hz;
    let in_band: Vec<&FeMode> =
        typed.iter().filter(|m| (low..=high).contains(&m.frequency_hz)).collect();
    let column = |of: fn(&FeMode) -> f64| {
        let found: Vec<f64> = test.modes.iter().map(of).collect();
        let expected: Vec<f64> = in_band.iter().map(|m| of(m)).collect();
        worst(paired(&found, &expected).map(|(a, b)| 100.0 * (a / b - 1.0)))
    };
    let (frequency, damping) = (column(|m| m.frequency_hz), column(|m| m.damping_ratio));
    let id = format!("fe.modal.routes.frequency.{name}");
    let title = format!("{name} planets: impulse identification against linearised eigenvalues");
    let mut checks = vec![lab.about(&id, &title)?.at_most(frequency)];
    let id = format!("fe.modal.routes.damping.{name}");
    let title = format!("{name} planets: damping identified against that of the linearised set");
    checks.push(lab.about(&id, &title)?.at_most(damping));
    let id = format!("fe.modal.routes.linear.{name}");
    let title = format!("{name} planets: response to half a pulse against half the response");
    let off = worst(test.decays.iter().map(|d| d.nonlinearity));
    checks.push(lab.about(&id, &title)?.at_most(off));
    Ok(checks)
}

/// Largest rotation of the sun over its translation under a force, and the reverse under a torque.
fn leaks(races: &Races, test: &ImpulseTest) -> Result<[f64; 2], ValidationError> {
    let of = |pulse: &str| {
        test.sun_contents(races, pulse).ok_or(ValidationError::Incomplete("free sun"))
    };
    let (force, torque) = (of("sun x force")?, of("sun torque")?);
    Ok([force.rotation / force.translation, torque.translation / torque.rotation])
}

/// With planets in phase a force on the sun excites its translation alone and a torque its rotation alone.
/// Where phases differ, the meshes differ at any one position and the two motions are coupled. Half a cycle
/// later opposed planets have exchanged their mesh phases; the set is then itself rotated by 180°, and the
/// coupling must be the same.
fn pulses(lab: &Lab<'_>, name: &str, own: [f64; 2], half: Option<[f64; 2]>) -> Checks {
    let what = [("force", "rotation over translation"), ("torque", "translation over rotation")];
    let mut checks = Vec::new();
    let Some(half) = half else {
        for ((pulse, what), leak) in what.into_iter().zip(own) {
            let id = format!("fe.modal.pulse.{pulse}.{name}");
            let title = format!("{name} planets, sun {pulse} pulse: the sun's {what}");
            checks.push(lab.about(&id, &title)?.at_most(leak));
        }
        return Ok(checks);
    };
    for (((pulse, what), leak), other) in what.into_iter().zip(own).zip(half) {
        let id = format!("fe.modal.pulse.{pulse}.{name}");
        let title = format!(
            "{name} planets, sun {pulse} pulse: the sun's {what}, half a mesh cycle on against that at one position"
        );
        let note = format!("{leak:.3} at that position");
        checks.push(lab.about(&id, &title)?.note(note).at_most(other / leak - 1.0));
    }
    Ok(checks)
}
