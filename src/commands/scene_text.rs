//! `scene check` as text.

use std::io::Write;

use gearset::{Member, PathDirection};

use crate::output;

use super::scene_summary::{MotionSummary, SceneSummary, VerbSummary};

/// Writes the summary of a scene.
pub(super) fn text(summary: &SceneSummary, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(out, "{} ({}): a valid scene", summary.title, summary.kind)?;
    if let Some(source) = &summary.source {
        writeln!(out, "source: {source}")?;
    }
    let degrees: Vec<_> = summary.planet_positions_deg.iter().map(|d| format!("{d:.4}°")).collect();
    writeln!(out, "planets: {} at {}", degrees.len(), degrees.join(", "))?;
    if let Some(steps) = &summary.planet_position_steps {
        writeln!(out, "in assembly steps: {steps:?}")?;
    }
    if let (Some(a), Some(p)) = (summary.center_distance_mm, summary.base_pitch_mm) {
        writeln!(out, "centre distance {a:.4} mm, base pitch {p:.5} mm")?;
    }
    if !summary.gears.is_empty() {
        let header = ["gear", "Z", "base mm", "tip mm", "root mm", "form mm", "tip land mm"];
        let mut table = output::table(&header, &[1, 2, 3, 4, 5, 6]);
        for g in &summary.gears {
            let mm = |x: f64| format!("{x:.4}");
            table.add_row(vec![
                g.gear.clone(),
                g.teeth.to_string(),
                mm(g.base_diameter_mm),
                mm(g.tip_diameter_mm),
                mm(g.root_diameter_mm),
                mm(g.form_diameter_mm),
                mm(g.tooth_thickness_at_tip_mm),
            ]);
        }
        writeln!(out, "{table}")?;
        let header = ["mesh", "angle °", "module mm", "contact ratio", "backlash mm"];
        let mut table = output::table(&header, &[1, 2, 3, 4]);
        for m in &summary.meshes {
            table.add_row(vec![
                m.mesh.clone(),
                format!("{:.4}", m.pressure_angle_deg),
                format!("{:.4}", m.operating_module_mm),
                format!("{:.4}", m.contact_ratio),
                format!("{:.4}", m.backlash_mm),
            ]);
        }
        writeln!(out, "{table}")?;
    }
    if let (Some(gamma), Some(sun), Some(ring)) =
        (summary.gamma, &summary.sun_mesh_phases, &summary.ring_mesh_phases)
    {
        let list = |p: &[f64]| p.iter().map(|x| format!("{x:.5}")).collect::<Vec<_>>().join(", ");
        writeln!(out, "γ = {gamma:.5} cycles")?;
        writeln!(out, "sun mesh phases:  {}", list(sun))?;
        writeln!(out, "ring mesh phases: {}", list(ring))?;
    }
    if let (Some(f), Some(n)) = (summary.mesh_frequency_hz, summary.carrier_speed_rpm) {
        writeln!(out, "mesh frequency {f:.2} Hz, carrier at {n:.2} rpm")?;
    }
    if let Some(motion) = &summary.motion {
        write_motion(motion, out)?;
    }
    for g in &summary.gears {
        if let Some(r) = &g.tip_relief {
            writeln!(
                out,
                "{}: {} tip relief of {:.3} µm from diameter {:.4} mm, over {:.1} % of the flank's roll length",
                g.gear,
                r.shape,
                r.amount_um,
                r.start_diameter_mm,
                100.0 * r.relieved_share
            )?;
        }
    }
    if let Some(fe) = &summary.fe_bodies {
        writeln!(
            out,
            "finite-element bodies: {} degrees of freedom, about {:.0} MB",
            fe.degrees_of_freedom, fe.memory_mb
        )?;
    }
    for limit in &summary.limits {
        writeln!(out, "note: {limit}")?;
    }
    for w in &summary.warnings {
        writeln!(out, "warning: `{}` is {}: {}; {}", w.key, w.value, w.what, w.likely)?;
    }
    verbs(&summary.verbs, out)
}

/// Which verbs run, and what the others lack.
fn verbs(verbs: &[VerbSummary], out: &mut dyn Write) -> std::io::Result<()> {
    let ready = verbs.iter().filter(|v| v.lacks.is_empty()).map(|v| v.verb.as_str());
    let ready: Vec<_> = ready.collect();
    let list = if ready.is_empty() { "none".into() } else { ready.join(", ") };
    writeln!(out, "verbs that run: {list}")?;
    let lacking: Vec<&VerbSummary> = verbs.iter().filter(|v| !v.lacks.is_empty()).collect();
    let mut told: Vec<&VerbSummary> = Vec::new();
    for verb in &lacking {
        if told.iter().any(|t| t.runs == verb.runs && t.lacks == verb.lacks) {
            continue;
        }
        let alike = lacking.iter().filter(|v| v.runs == verb.runs && v.lacks == verb.lacks);
        let names: Vec<&str> = alike.map(|v| v.verb.as_str()).collect();
        let does = match (verb.runs, names.len()) {
            (true, 1) => "runs with",
            (true, _) => "run with",
            (false, _) => "cannot run",
        };
        writeln!(out, "{} {does}:", names.join(", "))?;
        for lack in &verb.lacks {
            let instead =
                lack.argument.as_ref().map_or(String::new(), |a| format!(", or argument {a}"));
            writeln!(out, "  `{}`{instead}: {}", lack.key, lack.why)?;
        }
        told.push(verb);
    }
    Ok(())
}
/// Speeds and torques of all members.
fn write_motion(motion: &MotionSummary, out: &mut dyn Write) -> std::io::Result<()> {
    let MotionSummary { speeds_rpm: speeds, torques_nm: torques, .. } = motion;
    writeln!(
        out,
        "the {} {}, the {} stands still; ratio of the {}'s speed to it {:.5}",
        motion.input.name(),
        if motion.drives { "drives" } else { "is braked" },
        motion.fixed.name(),
        motion.output.name(),
        motion.speed_ratio
    )?;
    let mut table = output::table(&["member", "rpm", "torque N·m"], &[1, 2]);
    for member in [Member::Sun, Member::Ring, Member::Carrier] {
        let (speed, torque) = (speeds.of(member), torques.of(member));
        table.add_row([member.name().into(), format!("{speed:.4}"), format!("{torque:.1}")]);
    }
    table.add_row(["planet".into(), format!("{:.4}", speeds.planet), String::new()]);
    let on_pin = format!("{:.4}", speeds.planet_relative_to_carrier);
    table.add_row(["planet on its pin".into(), on_pin, String::new()]);
    writeln!(out, "{table}")?;
    let (from, to, sign) = match motion.pairs_run {
        PathDirection::Forward => ("start", "end", "positive"),
        PathDirection::Backward => ("end", "start", "negative"),
    };
    write!(
        out,
        "tooth pairs run from the {from} of the path of contact to its {to}: the sun's power relative to the carrier is {sign}"
    )?;
    match motion.torque_acts_on {
        Some(member) => writeln!(out, "; in experiments the torque acts on the {}", member.name()),
        None => writeln!(out),
    }
}
