//! `scene check` as text.

use std::io::Write;

use super::motion::write_motion;
use super::summary::{GearSummary, MeshSummary, SceneSummary, VerbSummary};
use crate::error::Result;
use crate::output::{Notation, Report, Table};

impl Report for SceneSummary {
    /// One row for each verb.
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let keys = |v: &&VerbSummary| {
            v.lacks.iter().map(|lack| lack.key.as_str()).collect::<Vec<_>>().join(" ")
        };
        let table = Table::<&VerbSummary>::new()
            .column("verb", "", |v| &v.verb)
            .column("runs", "", |v| v.runs)
            .column("lacks", "", keys);
        table.csv(&self.verbs, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{} ({}): a valid scene", self.title, self.kind)?;
        if let Some(source) = &self.source {
            writeln!(out, "source: {source}")?;
        }
        let degrees: Vec<_> =
            self.planet_positions_deg.iter().map(|d| format!("{d:.4}°")).collect();
        writeln!(out, "planets: {} at {}", degrees.len(), degrees.join(", "))?;
        if let Some(steps) = &self.planet_position_steps {
            writeln!(out, "in assembly steps: {steps:?}")?;
        }
        if let (Some(a), Some(p)) = (self.center_distance_mm, self.base_pitch_mm) {
            writeln!(out, "centre distance {a:.4} mm, transverse base pitch {p:.5} mm")?;
        }
        if !self.gears.is_empty() {
            let mm = Notation::Fixed(4);
            Table::<&GearSummary>::new()
                .words("gear", Notation::Plain, |g| &g.gear)
                .words("Z", Notation::Plain, |g| g.teeth)
                .words("base mm", mm, |g| g.base_diameter_mm)
                .words("tip mm", mm, |g| g.tip_diameter_mm)
                .words("root mm", mm, |g| g.root_diameter_mm)
                .words("form mm", mm, |g| g.form_diameter_mm)
                .words("tip land mm", mm, |g| g.tooth_thickness_at_tip_mm)
                .text(&self.gears, out)?;
            Table::<&MeshSummary>::new()
                .words("mesh", Notation::Plain, |m| &m.mesh)
                .words("angle °", mm, |m| m.pressure_angle_deg)
                .words("module mm", mm, |m| m.operating_module_mm)
                .words("contact ratio", mm, |m| m.contact_ratio)
                .words("backlash mm", mm, |m| m.backlash_mm)
                .text(&self.meshes, out)?;
        }
        if let (Some(gamma), Some(sun), Some(ring)) =
            (self.gamma, &self.sun_mesh_phases, &self.ring_mesh_phases)
        {
            let list =
                |p: &[f64]| p.iter().map(|x| format!("{x:.5}")).collect::<Vec<_>>().join(", ");
            writeln!(out, "γ = {gamma:.5} cycles")?;
            writeln!(out, "sun mesh phases:  {}", list(sun))?;
            writeln!(out, "ring mesh phases: {}", list(ring))?;
        }
        if let (Some(f), Some(n)) = (self.mesh_frequency_hz, self.carrier_speed_rpm) {
            writeln!(out, "mesh frequency {f:.2} Hz, carrier at {n:.2} rpm")?;
        }
        if let Some(motion) = &self.motion {
            write_motion(motion, out)?;
        }
        for g in &self.gears {
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
        if let Some(fe) = &self.fe_bodies {
            writeln!(
                out,
                "finite-element bodies: {} degrees of freedom, about {:.0} MB",
                fe.degrees_of_freedom, fe.memory_mb
            )?;
        }
        for c in &self.chosen {
            writeln!(out, "chosen: `{}` = {}: {}", c.key, c.value, c.why)?;
        }
        for note in &self.rounding {
            writeln!(out, "note: {note}")?;
        }
        for limit in &self.limits {
            writeln!(out, "note: {limit}")?;
        }
        if !self.idle.is_empty() {
            let keys: Vec<_> = self.idle.iter().map(|key| format!("`{key}`")).collect();
            writeln!(out, "note: no verb that runs uses {}", keys.join(", "))?;
        }
        for w in &self.warnings {
            writeln!(out, "warning: `{}` is {}: {}; {}", w.key, w.value, w.what, w.likely)?;
        }
        Ok(verbs(&self.verbs, out)?)
    }
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
