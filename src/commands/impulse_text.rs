//! Text and CSV of `impulse`.

use std::io::Write;

use crate::error::CommandError;
use crate::output::{self, share};

use super::impulse_output::{
    BandMode, BandOutput, ImpulseOutput, ModeEntry, OutsideMode, PulseEntry,
};

/// Modes outside the band that the text names.
const MOST_OUTSIDE: usize = 12;

/// Text of a cell without a value.
const NOTHING: &str = "–";

pub(super) fn text(
    title: &str,
    result: &ImpulseOutput,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    writeln!(out, "{title}")?;
    writeln!(
        out,
        "{} N·m on the sun at position {} of the mesh cycle; decays of {} ms in steps of {} µs",
        plain(result.sun_torque_nm),
        plain(result.position),
        plain(result.duration_ms),
        plain(result.step_us)
    )?;
    let bodies = match (result.fidelity.as_str(), result.body_modes) {
        ("modal", Some(n)) => format!("modal, {n} modes of each body"),
        (fidelity, _) => fidelity.to_owned(),
    };
    writeln!(out, "fidelity: {bodies}; {} steps taken in all", result.steps)?;
    if !result.has_linearisation {
        writeln!(out, "no small linearisation on this fidelity: its columns are empty")?;
    }
    modes(result, out)?;
    pulses(&result.pulses, out)?;
    let (order, [low, high]) = (result.identification.order, result.band_limits_hz);
    writeln!(out, "identified at order {order} between {low:.0} and {high:.0} Hz")?;
    if !result.outside_band.is_empty() {
        let one = |m: &OutsideMode| format!("{:.1} ({})", m.frequency_hz, m.mode_type);
        let list: Vec<String> = result.outside_band.iter().map(one).collect();
        let shown = list.len().min(MOST_OUTSIDE);
        let more = match list.len() - shown {
            0 => String::new(),
            n => format!(" and {n} more (--format json lists all)"),
        };
        writeln!(
            out,
            "outside this band, which --band-hz sets, linearised modes at {} Hz{more}",
            list[..shown].join(", ")
        )?;
    }
    writeln!(out, "{LEGEND}")?;
    match &result.band {
        Some(found) => band(found, out),
        None => Ok(()),
    }
}

/// Below the tables: what each column is.
const LEGEND: &str = "\
Hz, ζ: natural frequency and damping ratio found in the decays; linear Hz, ζ: of the linearised set
difference: of the frequency found from the linearised one, over that
rot., transl., planet: shares of the kinetic energy by kind of motion, – below 0.0005
∂ln f/∂ln k: relative change of the frequency over that of all mesh stiffnesses
force: acts for one time step; of a torque, over the base radius; force change: of a mesh, over the largest mesh force
nonlinearity: of half the pulse, the response less half the response to the whole, over its largest value
the sun's other motion: the one that the pulse on it would not excite with planets in phase (rotation as r_b θ)";

/// A number without the digits that a conversion of units adds by rounding.
fn plain(x: f64) -> String {
    let text = format!("{x:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn given(x: Option<f64>, shown: impl Fn(f64) -> String) -> String {
    x.map_or_else(|| NOTHING.into(), shown)
}

fn modes(result: &ImpulseOutput, out: &mut dyn Write) -> std::io::Result<()> {
    let header = [
        "Hz",
        "ζ %",
        "linear Hz",
        "ζ %",
        "difference %",
        "type",
        "rot.",
        "transl.",
        "planet",
        "∂ln f/∂ln k",
    ];
    let mut table = output::table(&header, &[0, 1, 2, 3, 4, 6, 7, 8, 9]);
    for m in &result.modes {
        let (ours, theirs) = (m.identified.as_ref(), m.linearised.as_ref());
        let hertz = |f: f64| format!("{f:.2}");
        let percent = |z: f64| format!("{:.3}", 100.0 * z);
        let shares = ours.map(|i| &i.shares).or(theirs.map(|l| &l.shares));
        let mut row = vec![
            given(ours.map(|i| i.frequency_hz), hertz),
            given(ours.map(|i| i.damping_ratio), percent),
            given(theirs.map(|l| l.frequency_hz), hertz),
            given(theirs.map(|l| l.damping_ratio), percent),
            given(m.difference_percent, |d| format!("{d:+.3}")),
            m.mode_type.clone(),
        ];
        row.extend([
            given(shares.map(|s| s.rotational), share),
            given(shares.map(|s| s.translational), share),
            given(shares.map(|s| s.planet), share),
            given(theirs.map(|l| l.mesh_sensitivity), |s| format!("{s:.4}")),
        ]);
        table.add_row(row);
    }
    writeln!(out, "{table}")
}

fn pulses(pulses: &[PulseEntry], out: &mut dyn Write) -> std::io::Result<()> {
    let header = ["pulse", "force N", "force change", "nonlinearity", "the sun's other motion"];
    let mut table = output::table(&header, &[1, 2, 3]);
    for p in pulses {
        // With planets in phase a force excites no rotation and a torque no translation.
        let other = match p.sun_translation_um.zip(p.sun_rotation_um) {
            Some((t, r)) if p.pulse.ends_with("torque") => {
                format!("translation {:.1e} of rotation", t / r)
            }
            Some((t, r)) => format!("rotation {:.1e} of translation", r / t),
            None => NOTHING.into(),
        };
        table.add_row(vec![
            p.pulse.clone(),
            format!("{:.3}", p.force_n),
            format!("{:.1e}", p.force_change),
            format!("{:.1e}", p.nonlinearity),
            other,
        ]);
    }
    writeln!(out, "{table}")
}

fn band(band: &BandOutput, out: &mut dyn Write) -> std::io::Result<()> {
    let states = band.positions.len() * band.torques_nm.len();
    let torques: Vec<String> = band.torques_nm.iter().map(|t| plain(*t)).collect();
    writeln!(
        out,
        "linearised at {} positions of the mesh cycle under {} N·m",
        band.positions.len(),
        torques.join(", ")
    )?;
    let mut header: Vec<String> =
        ["type", "place", "lowest Hz", "mean Hz", "highest Hz", "width %"]
            .map(str::to_owned)
            .into();
    header.extend(torques.iter().map(|t| format!("mean at {t}")));
    header.push("states".into());
    let names: Vec<&str> = header.iter().map(String::as_str).collect();
    let mut table = output::table(&names, &(1..names.len()).collect::<Vec<_>>());
    for m in &band.modes {
        let mut row = vec![
            m.mode_type.clone(),
            m.place.to_string(),
            format!("{:.1}", m.lowest_hz),
            format!("{:.1}", m.mean_hz),
            format!("{:.1}", m.highest_hz),
            format!("{:.2}", 100.0 * (m.highest_hz - m.lowest_hz) / m.mean_hz),
        ];
        row.extend(m.torques.iter().map(|t| given(t.mean_hz, |f| format!("{f:.1}"))));
        row.push(format!("{} of {states}", m.states));
        table.add_row(row);
    }
    writeln!(out, "{table}")?;
    let is_changing = |m: &&BandMode| m.states < states || m.mode_type == "mixed";
    match band.modes.iter().find(is_changing) {
        Some(first) => writeln!(
            out,
            "types change from state to state above {:.0} Hz: places there are not one mode throughout",
            first.lowest_hz
        ),
        None => Ok(()),
    }
}

pub(super) fn csv(result: &ImpulseOutput, out: &mut dyn Write) -> Result<(), CommandError> {
    let row = |m: &ModeEntry| {
        let (ours, theirs) = (m.identified.as_ref(), m.linearised.as_ref());
        let cells = [
            ours.map(|i| i.frequency_hz),
            ours.map(|i| i.damping_ratio),
            ours.map(|i| i.shares.rotational),
            ours.map(|i| i.shares.translational),
            ours.map(|i| i.shares.planet),
            theirs.map(|l| l.frequency_hz),
            theirs.map(|l| l.damping_ratio),
            m.difference_percent,
            theirs.map(|l| l.mesh_sensitivity),
        ];
        let cells = cells.map(|x| x.map_or_else(String::new, |x| x.to_string()));
        std::iter::once(m.mode_type.clone()).chain(cells).chain(["true".to_owned()]).collect()
    };
    let outside = |m: &OutsideMode| -> Vec<String> {
        let mut row = vec![String::new(); 11];
        row[0].clone_from(&m.mode_type);
        row[6] = m.frequency_hz.to_string();
        row[10] = "false".into();
        row
    };
    let header = [
        "mode_type",
        "frequency_hz",
        "damping_ratio",
        "rotational",
        "translational",
        "planet",
        "linearised_hz",
        "linearised_damping_ratio",
        "difference_percent",
        "mesh_sensitivity",
        "is_in_band",
    ];
    let rows = result.modes.iter().map(row).chain(result.outside_band.iter().map(outside));
    output::csv(out, &header, rows)
}
