//! The lumped model fed from FE: against the linearised FE/contact set, mode by mode, and as the
//! middle of the way from the published lumped frequencies to FE/contact.

use super::Lab;
use crate::Profile;
use crate::catalogue::scene;
use crate::check::{Check, ReferenceKind, Subject};
use crate::effects::{Base, EffectStudy, Effects, Variant, effects};
use crate::error::ValidationError;
use crate::suites::tables::Table;
use experiments::modal::{Agreement, Preload, agreement, agreement_after};
use gearset::LoadCase;

/// Preload of the tables, N m.
const TORQUE: f64 = 1130.0;

/// Positions judged one by one, percent of a mesh cycle.
const POSITIONS: [u32; 4] = [0, 25, 50, 75];

/// Positions of the scan in a mesh cycle.
const SCANNED: u32 = 140;

/// Largest difference over the scan, percent, three and four planets: beyond the limit of
/// `fe.fed.rigid_carrier` where corner pairs press in all meshes of three planets at once.
const KEPT_WORST: [f64; 2] = [0.96, 0.26];

/// Differences below this are rounding, percent.
const ROUNDING: f64 = 1e-6;

fn preload(position: f64) -> Preload {
    Preload { load: LoadCase::standing(TORQUE), position, step_s: 5e-6 }
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    for (which, table) in Table::ALL.into_iter().enumerate() {
        checks.extend(positions(lab, table)?);
        checks.push(scan(lab, table, KEPT_WORST[which])?);
    }
    checks.push(control(lab)?);
    let own = match lab.profile {
        Profile::Full => Variant::own_bodies(&lab.four)?,
        Profile::Quick => Vec::new(),
    };
    for table in Table::ALL {
        let cheap = |v: &Variant| v.base() == Base::FedLumped || *v == Variant::RigidCarrier;
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
        checks.push(every_mode(lab, &found));
    }
    Ok(checks)
}

/// FE/contact with a rigid carrier against the lumped model fed at the same position.
fn positions(lab: &Lab<'_>, table: Table) -> Result<Vec<Check>, ValidationError> {
    let (set, name) = (scene(table.consistent())?, table.planets());
    let mut checks = Vec::new();
    let (mut straight, mut on_path) = (0.0f64, None);
    for percent in POSITIONS {
        let found = agreement(&set, &lab.bodies, &preload(0.01 * f64::from(percent)))?;
        straight = straight.max(found.along_the_line_percent);
        if found.pairs_off_the_line == 0 {
            on_path = Some(found.worst_percent.abs().max(on_path.unwrap_or(0.0)));
        }
        let id = format!("fe.fed.rigid_carrier.{name}.{percent}");
        let title = format!(
            "{name} planets, {percent} % of a mesh cycle: FE/contact with a rigid carrier against the lumped model fed from it, all {} modes{}",
            found.modes,
            where_worst(&found),
        );
        checks.push(lab.at_most(&id, &title, "%", found.worst_percent.abs())?);
    }
    let id = format!("fe.fed.line_of_action.{name}");
    let title = format!(
        "{name} planets: the same at all these positions, corner pairs made to press along the line of action"
    );
    checks.push(lab.at_most(&id, &title, "%", straight)?);
    if let Some(on_path) = on_path {
        let id = format!("fe.fed.on_path.{name}");
        let title = format!("{name} planets: the same as it is, where no corner pair presses");
        checks.push(lab.at_most(&id, &title, "%", on_path)?);
    }
    Ok(checks)
}

fn where_worst(found: &Agreement) -> String {
    match found.pairs_off_the_line {
        _ if found.worst_percent.abs() < ROUNDING => " (no corner pair presses)".into(),
        1 => format!(" (worst at {:.0} Hz; 1 corner pair presses)", found.at_hz),
        n => format!(" (worst at {:.0} Hz; {n} corner pairs press)", found.at_hz),
    }
}

/// The largest difference over the mesh cycle, and how often it is beyond the limit.
fn scan(lab: &Lab<'_>, table: Table, kept: f64) -> Result<Check, ValidationError> {
    let name = table.planets();
    let id = format!("fe.fed.corners.{name}");
    let tolerance = lab.reference.tolerance(&id, kept)?;
    let subject = |title| Subject {
        id: &id,
        title,
        kind: ReferenceKind::OwnRegression,
        source: "docs/fe_dynamics_fed.md",
        unit: "%",
    };
    if lab.profile == Profile::Quick {
        let title = format!("{name} planets: largest difference over {SCANNED} positions");
        return Ok(Check::not_run(subject(&title), kept, tolerance));
    }
    let limit_id = format!("fe.fed.rigid_carrier.{name}.0");
    let limit = lab.reference.tolerance(&limit_id, 0.0)?.absolute;
    let set = scene(table.consistent())?;
    let (mut worst, mut beyond) = (0.0f64, 0);
    // Half a cycle on, opposed planets of four have changed places.
    let repeats = if table == Table::Three { 2 } else { 1 };
    for k in 0..SCANNED / repeats {
        let position = f64::from(k) / f64::from(SCANNED);
        let found = agreement(&set, &lab.bodies, &preload(position))?;
        worst = worst.max(found.worst_percent.abs());
        beyond += repeats * u32::from(found.worst_percent.abs() > limit);
    }
    let title = format!(
        "{name} planets: largest difference over {SCANNED} positions, beyond {limit} % at {beyond} of them, where corner pairs press"
    );
    Ok(Check::number(subject(&title), kept, worst, tolerance))
}

/// Tangents in the wrong meshes must be noticed.
fn control(lab: &Lab<'_>) -> Result<Check, ValidationError> {
    let id = "fe.fed.rigid_carrier.three.0";
    let limit = lab.reference.tolerance(id, 0.0)?.absolute;
    let found = agreement_after(&lab.three, &lab.bodies, &preload(0.0), |fed| {
        for own in &mut fed.overrides {
            std::mem::swap(&mut own.sun_mesh, &mut own.ring_mesh);
        }
    })?;
    let subject = Subject {
        id: "fe.fed.control.exchanged",
        title: "tangents of sun and ring meshes exchanged break fe.fed.rigid_carrier.three.0",
        kind: ReferenceKind::Analytic,
        source: "a check that cannot fail is none",
        unit: "",
    };
    let is_broken = found.worst_percent.abs() > limit;
    Ok(Check::equal(subject, "breaks", if is_broken { "breaks" } else { "stands" }))
}

/// The printed FE/contact rows against the fed lumped model: the independent estimate.
fn rows(lab: &Lab<'_>, found: &Effects) -> Result<Vec<Check>, ValidationError> {
    let number = found.table.number();
    let source = &lab.reference.parker.source;
    let list = found.mode_type.iter().zip(&found.printed_fe_contact_hz).zip(&found.fed_hz);
    list.enumerate()
        .map(|(row, ((name, printed), fed))| {
            let id = format!("fe.fed.table{number}.{}", row + 1);
            let title = format!(
                "Table {number}, printed FE/contact against the lumped model fed from FE: {name} mode ({:.0} Hz by our FE/contact)",
                found.fe_contact_hz[row],
            );
            lab.number(&id, &title, ReferenceKind::Published, source, "Hz", *printed, *fed)
        })
        .collect()
}

/// Parameters add up from the published to the fed lumped model; beyond it there is the carrier.
fn parts(lab: &Lab<'_>, found: &Effects) -> Result<[Check; 2], ValidationError> {
    let name = found.table.planets();
    // NaN must not hide behind a maximum.
    let largest = |list: Vec<f64>| {
        list.into_iter().fold(0.0f64, |a, x| if a >= x.abs() { a } else { x.abs() })
    };
    let id = format!("fe.fed.additive.{name}");
    let title = format!(
        "{name} planets: pressure angles, spacing, masses and mesh stiffnesses, effects one by one against all together, from lumped fed to lumped as published"
    );
    let additive = lab.at_most(&id, &title, "%", largest(found.remainders_percent()))?;
    let id = format!("fe.fed.beyond_carrier.{name}");
    let title = format!(
        "{name} planets, tabled modes: FE/contact against lumped fed, less the effect of the carrier's giving way"
    );
    let beyond = lab.at_most(&id, &title, "%", largest(found.beyond_carrier_percent()))?;
    Ok([additive, beyond])
}

/// Every tabled mode is there under every change.
fn every_mode(lab: &Lab<'_>, found: &Effects) -> Check {
    let id = format!("fe.fed.effects.{}", found.table.planets());
    let title = format!(
        "{} planets: tabled modes lost under any of {} single changes",
        found.table.planets(),
        Variant::ALL.len()
    );
    let subject = Subject {
        id: &id,
        title: &title,
        kind: ReferenceKind::Analytic,
        source: "small changes keep the kinds of modes",
        unit: "",
    };
    if lab.profile == Profile::Quick {
        return Check::not_run(subject, 0.0, crate::check::Tolerance::exact());
    }
    let of = |effects: &Option<Vec<crate::effects::Effect>>| match effects {
        Some(list) => list.iter().filter(|e| !e.percent.is_finite()).count(),
        None => found.mode_type.len(),
    };
    let lost: usize = found.variants.iter().map(|(_, effects)| of(effects)).sum();
    Check::equal(subject, 0.0, lost as f64)
}
