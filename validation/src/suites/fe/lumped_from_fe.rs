//! The lumped model with parameters from FE: against the linearised FE/contact set, mode by mode, and as the
//! middle of the way from the published lumped frequencies to FE/contact.

use experiments::modal::{Agreement, Preload, agreement, agreement_after};
use scene::LoadCase;

use crate::Profile;
use crate::catalogue::scene;
use crate::check::Check;
use crate::effects::{Base, Effect, EffectStudy, Effects, Variant, effects};
use crate::error::ValidationError;
use crate::published_table::Table;
use crate::suites::{Checks, Lab};
use crate::worst::worst;

/// Preload of the tables, N m.
const TORQUE: f64 = 1130.0;

/// Positions judged one by one, percent of a mesh cycle.
const POSITIONS: [u32; 4] = [0, 25, 50, 75];

/// Positions of the scan in a mesh cycle.
const SCANNED: u32 = 140;

/// Largest difference over the scan, percent, three and four planets: beyond the limit of
/// `lumped_from_fe.rigid_carrier` where corner contacts press in all meshes of three planets at once.
const KEPT_WORST: [f64; 2] = [0.93, 0.24];

/// Differences below this are rounding, percent.
const ROUNDING: f64 = 1e-6;

fn preload(position: f64) -> Preload {
    Preload { load: LoadCase::standing(TORQUE), position, step_s: 5e-6 }
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    for (which, table) in Table::ALL.into_iter().enumerate() {
        checks.extend(positions(lab, table)?);
        checks.extend(cycle(lab, table, KEPT_WORST[which])?);
    }
    checks.push(control(lab)?);
    let own = match lab.profile {
        Profile::Full => Variant::own_bodies(&lab.four)?,
        Profile::Quick => Vec::new(),
    };
    for table in Table::ALL {
        let cheap = |v: &Variant| v.base() == Base::LumpedFromFe || *v == Variant::RigidCarrier;
        let is_full = lab.profile == Profile::Full;
        let variants: Vec<Variant> =
            Variant::ALL.into_iter().filter(|v| is_full || cheap(v)).collect();
        let study = EffectStudy {
            bodies: &lab.bodies,
            own: &own,
            preload: preload(0.0),
            variants: &variants,
        };
        let found = effects(lab.reference, table, &study)?;
        checks.extend(rows(lab, &found)?);
        checks.extend(parts(lab, &found)?);
        checks.push(every_mode(lab, &found)?);
    }
    Ok(checks)
}

/// One position, in percent of a mesh cycle: FE/contact with a rigid carrier against the lumped model with
/// parameters from FE at that position.
fn rigid_carrier(
    lab: &Lab<'_>,
    name: &str,
    percent: u32,
    found: &Agreement,
) -> Result<Check, ValidationError> {
    let id = format!("lumped_from_fe.rigid_carrier.{name}.{percent}");
    let title = format!(
        "{name} planets, {percent} % of a mesh cycle: FE/contact with a rigid carrier against the lumped model with parameters from it, all modes"
    );
    Ok(lab.about(&id, &title)?.note(where_worst(found)).at_most(found.worst_percent))
}

fn positions(lab: &Lab<'_>, table: Table) -> Checks {
    let (set, name) = (scene(table.consistent())?, table.planets());
    let mut checks = Vec::new();
    let (mut straight, mut on_path) = (Vec::new(), Vec::new());
    for percent in POSITIONS {
        let found = agreement(&set, &lab.bodies, &preload(0.01 * f64::from(percent)))?;
        straight.push(found.along_the_line_percent);
        if found.pairs_off_the_line == 0 {
            on_path.push(found.worst_percent);
        }
        checks.push(rigid_carrier(lab, name, percent, &found)?);
    }
    let id = format!("lumped_from_fe.line_of_action.{name}");
    let title = format!(
        "{name} planets: the same at all these positions, corner contacts made to press along the line of action"
    );
    checks.push(lab.about(&id, &title)?.at_most(worst(straight)));
    if !on_path.is_empty() {
        let id = format!("lumped_from_fe.on_path.{name}");
        let title = format!("{name} planets: the same as it is, where no corner contact presses");
        checks.push(lab.about(&id, &title)?.at_most(worst(on_path)));
    }
    Ok(checks)
}

fn where_worst(found: &Agreement) -> String {
    let Agreement { modes, at_hz, .. } = found;
    match found.pairs_off_the_line {
        _ if found.worst_percent.abs() < ROUNDING => {
            format!("{modes} modes; no corner contact presses")
        }
        1 => format!("{modes} modes, worst at {at_hz:.0} Hz; 1 corner contact presses"),
        n => format!("{modes} modes, worst at {at_hz:.0} Hz; {n} corner contacts press"),
    }
}

/// The whole mesh cycle: the largest difference, the number of positions at which it exceeds the limit of a
/// single position, and the largest difference with every pair pressing along the line of action.
fn cycle(lab: &Lab<'_>, table: Table, kept: f64) -> Checks {
    let name = table.planets();
    let corners = format!("lumped_from_fe.corners.{name}");
    let worst_title = format!("{name} planets: largest difference over {SCANNED} positions");
    let beyond_id = format!("lumped_from_fe.rigid_carrier_cycle.{name}");
    let beyond_title = format!(
        "{name} planets: positions, of {SCANNED} of the mesh cycle, at which FE/contact with a rigid carrier and the lumped model with parameters from it differ by more than a single position may"
    );
    let line_id = format!("lumped_from_fe.line_of_action_cycle.{name}");
    let line_title = format!(
        "{name} planets: largest difference over {SCANNED} positions, corner contacts made to press along the line of action"
    );
    let mut found = None;
    if lab.runs(&corners)? {
        let limit =
            lab.reference.tolerance(&format!("lumped_from_fe.rigid_carrier.{name}.0"), 0.0)?;
        let set = scene(table.consistent())?;
        let (mut all, mut straight, mut beyond) = (Vec::new(), Vec::new(), 0);
        // Half a cycle later, opposed planets of four have exchanged their mesh phases.
        let repeats = if table == Table::Three { 2 } else { 1 };
        for k in 0..SCANNED / repeats {
            let position = f64::from(k) / f64::from(SCANNED);
            let found = agreement(&set, &lab.bodies, &preload(position))?;
            all.push(found.worst_percent);
            straight.push(found.along_the_line_percent);
            beyond += repeats * u32::from(!limit.allows(found.worst_percent));
        }
        found = Some((worst(all), f64::from(beyond), worst(straight)));
    }
    Ok(vec![
        lab.about(&corners, &worst_title)?.number_if_run(kept, found.map(|f| f.0)),
        lab.about(&beyond_id, &beyond_title)?.number_if_run(0.0, found.map(|f| f.1)),
        lab.about(&line_id, &line_title)?.at_most_if_run(found.map(|f| f.2)),
    ])
}

/// Control: the tangent stiffnesses of sun and ring meshes exchanged.
fn control(lab: &Lab<'_>) -> Result<Check, ValidationError> {
    let found = agreement_after(&lab.three, &lab.bodies, &preload(0.0), |from_fe| {
        for own in &mut from_fe.overrides {
            std::mem::swap(&mut own.sun_mesh_n_per_m, &mut own.ring_mesh_n_per_m);
        }
    })?;
    let spoilt = [rigid_carrier(lab, "three", 0, &found)?];
    Ok(lab.reference.control("lumped_from_fe.control.exchanged", &spoilt)?)
}

/// The printed FE/contact rows against the lumped model with parameters from FE.
fn rows(lab: &Lab<'_>, found: &Effects) -> Checks {
    let number = found.table.number();
    let source = &lab.reference.parker.source;
    let printed = found.table.printed(lab.reference);
    let mut checks = Vec::new();
    for (row, (name, hz)) in printed.fe_contact_rows().enumerate() {
        let id = format!("lumped_from_fe.table{number}.{}", row + 1);
        let title = format!(
            "Table {number}, printed FE/contact against the lumped model with parameters from FE: {name} mode"
        );
        let at = |list: &[f64]| list.get(row).copied().unwrap_or(f64::NAN);
        let note = format!("{:.0} Hz by our FE/contact", at(&found.fe_contact_hz));
        let about = lab.about(&id, &title)?.source(source).note(note);
        checks.push(about.number(*hz, at(&found.lumped_from_fe_hz)));
    }
    Ok(checks)
}

/// The single effects of the parameters add up to the difference between the two lumped models; FE/contact
/// differs from the one with parameters from FE by the flexible carrier, within a limit.
fn parts(lab: &Lab<'_>, found: &Effects) -> Checks {
    let name = found.table.planets();
    let id = format!("lumped_from_fe.additive.{name}");
    let title = format!(
        "{name} planets: pressure angles, spacing, masses and mesh stiffnesses, effects one by one against all together, from lumped with parameters from FE to lumped as published"
    );
    let additive = lab.about(&id, &title)?.at_most(worst(found.remainders_percent()));
    let id = format!("lumped_from_fe.beyond_carrier.{name}");
    let title = format!(
        "{name} planets, tabled modes: FE/contact against lumped with parameters from FE, less the effect of the carrier's giving way"
    );
    let beyond = lab.about(&id, &title)?.at_most(worst(found.beyond_carrier_percent()));
    Ok(vec![additive, beyond])
}

/// Every tabled mode exists under every change.
fn every_mode(lab: &Lab<'_>, found: &Effects) -> Result<Check, ValidationError> {
    let id = format!("lumped_from_fe.effects.{}", found.table.planets());
    let title = format!(
        "{} planets: tabled modes lost under any single change of a parameter",
        found.table.planets()
    );
    let of = |effects: &Option<Vec<Effect>>| match effects {
        Some(list) => list.iter().filter(|e| !e.percent.is_finite()).count(),
        None => found.mode_type.len(),
    };
    let lost: usize = found.variants.iter().map(|(_, effects)| of(effects)).sum();
    let lost = lab.runs(&id)?.then_some(lost as f64);
    Ok(lab.about(&id, &title)?.equal_if_run(0.0, lost))
}
