//! Text and CSV of `impulse`.

use std::io::Write;

use super::result::{
    BandMode, BandOutput, DampedMode, ImpulseOutput, LinearisedMode, ModeEntry, OutsideMode,
    PulseEntry,
};
use crate::commands::modes::KindShares;
use crate::error::Result;
use crate::output::{Notation, Report, Table};

/// Modes outside the band that the text names.
const MOST_OUTSIDE: usize = 12;

/// A mode in the band, or a linearised one outside it.
type Row<'r> = Result<&'r ModeEntry, &'r OutsideMode>;

impl Report for ImpulseOutput {
    /// One row for each mode in the band, then those of the modes outside it.
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(self.modes.iter().map(Ok).chain(self.outside_band.iter().map(Err)), out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}", self.title)?;
        writeln!(
            out,
            "{} N·m on the sun at position {} of the mesh cycle; decays of {} ms in steps \
             of {} µs",
            plain(self.sun_torque_nm),
            plain(self.position),
            plain(self.duration_ms),
            plain(self.step_us)
        )?;
        let bodies = match (self.fidelity.as_str(), self.body_modes) {
            ("modal", Some(n)) => format!("modal, {n} modes of each body"),
            (fidelity, _) => fidelity.to_owned(),
        };
        writeln!(out, "fidelity: {bodies}; {} steps taken in all", self.steps)?;
        if !self.has_linearisation {
            writeln!(out, "no small linearisation on this fidelity: its columns are empty")?;
        }
        table().text(self.modes.iter().map(Ok), out)?;
        pulses().text(&self.pulses, out)?;
        let (order, [low, high]) = (self.identification.order, self.band_limits_hz);
        writeln!(out, "identified at order {order} between {low:.0} and {high:.0} Hz")?;
        if !self.outside_band.is_empty() {
            let one = |m: &OutsideMode| format!("{:.1} ({})", m.frequency_hz, m.mode_type);
            let list: Vec<String> = self.outside_band.iter().map(one).collect();
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
        table().legend(out)?;
        pulses().legend(out)?;
        match &self.band {
            Some(found) => Ok(band(found, out)?),
            None => Ok(()),
        }
    }
}

/// A number without the digits that a conversion of units adds by rounding.
fn plain(x: f64) -> String {
    let text = format!("{x:.6}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn table<'r>() -> Table<'r, Row<'r>> {
    use Notation::{Fixed, Plain, Share, Signed};
    fn identified<'m>(row: &Row<'m>) -> Option<&'m DampedMode> {
        row.ok()?.identified.as_ref()
    }
    fn linearised<'m>(row: &Row<'m>) -> Option<&'m LinearisedMode> {
        row.ok()?.linearised.as_ref()
    }
    let found = |value: fn(&DampedMode) -> f64| move |row: &Row<'r>| identified(row).map(value);
    let linear =
        |value: fn(&LinearisedMode) -> f64| move |row: &Row<'r>| linearised(row).map(value);
    // Text shows the shares of a linearised mode where none was found.
    let share = |value: fn(&KindShares) -> f64| {
        move |row: &Row<'r>| {
            let mode = identified(row).or(linearised(row).map(|linear| &linear.mode));
            mode.map_or("–".into(), |mode| Share.number(value(&mode.shares)))
        }
    };
    Table::<Row<'r>>::new()
        .column("mode_type", "", |row| match row {
            Ok(mode) => &mode.mode_type,
            Err(outside) => &outside.mode_type,
        })
        .shown("type", Plain)
        .key()
        .column("frequency_hz", "natural frequency found in the decays", found(|m| m.frequency_hz))
        .shown("Hz", Fixed(2))
        .column("damping_ratio", "its damping ratio", found(|m| m.damping_ratio))
        .scaled("ζ %", 100.0, Fixed(3))
        .column(
            "rotational",
            "share of the kinetic energy, as the next two, by kind of motion; – below \
             0.0005",
            found(|m| m.shares.rotational),
        )
        .shown_as("rot.", share(|s| s.rotational))
        .column("translational", "", found(|m| m.shares.translational))
        .shown_as("transl.", share(|s| s.translational))
        .column("planet", "", found(|m| m.shares.planet))
        .shown_as("planet", share(|s| s.planet))
        .column("linearised_hz", "natural frequency of the linearised set", |row| match row {
            Ok(mode) => mode.linearised.as_ref().map(|m| m.mode.frequency_hz),
            Err(outside) => Some(outside.frequency_hz),
        })
        .shown("linear Hz", Fixed(2))
        .column("linearised_damping_ratio", "its damping ratio", linear(|m| m.mode.damping_ratio))
        .scaled("ζ %", 100.0, Fixed(3))
        .column(
            "difference_percent",
            "of the frequency found from the linearised one, over that",
            |row| row.ok().and_then(|m| m.difference_percent),
        )
        .shown("difference %", Signed(3))
        .column(
            "mesh_sensitivity",
            "relative change of the frequency over that of all mesh stiffnesses",
            linear(|m| m.mesh_sensitivity),
        )
        .shown("∂ln f/∂ln k", Fixed(4))
        .column("is_in_band", "", |row| row.is_ok())
}

fn pulses<'r>() -> Table<'r, &'r PulseEntry> {
    use Notation::{Fixed, Plain, Power};
    Table::<&PulseEntry>::new()
        .words("pulse", Plain, |p| &p.pulse)
        .key()
        .words("force N", Fixed(3), |p| p.force_n)
        .meaning("acts for one time step; of a torque, over the base radius")
        .words("force change", Power(1), |p| p.force_change)
        .meaning("of a mesh, over the largest mesh force")
        .words("nonlinearity", Power(1), |p| p.nonlinearity)
        .meaning(
            "of half the pulse, the response less half the response to the whole, over \
             its largest value",
        )
        .words("the sun's other motion", Plain, |p| {
            // With planets in phase a force excites no rotation and a torque no translation.
            let (t, r) = p.sun_translation_um.zip(p.sun_rotation_um)?;
            Some(match p.pulse.ends_with("torque") {
                true => format!("translation {:.1e} of rotation", t / r),
                false => format!("rotation {:.1e} of translation", r / t),
            })
        })
        .meaning(
            "the one that the pulse on it would not excite with planets in phase \
             (rotation as r_b θ)",
        )
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
    use Notation::{Fixed, Plain};
    let mut table = Table::<&BandMode>::new()
        .words("type", Plain, |m| &m.mode_type)
        .key()
        .words("place", Plain, |m| m.place)
        .key()
        .words("lowest Hz", Fixed(1), |m| m.lowest_hz)
        .words("mean Hz", Fixed(1), |m| m.mean_hz)
        .words("highest Hz", Fixed(1), |m| m.highest_hz)
        .words("width %", Fixed(2), |m| 100.0 * (m.highest_hz - m.lowest_hz) / m.mean_hz);
    for (i, torque) in torques.iter().enumerate() {
        table = table.words(format!("mean at {torque}"), Fixed(1), move |m| m.torques[i].mean_hz);
    }
    table = table.words("states", Plain, move |m| format!("{} of {states}", m.states)).right();
    table.text(&band.modes, out)?;
    let is_changing = |m: &&BandMode| m.states < states || m.mode_type == "mixed";
    match band.modes.iter().find(is_changing) {
        Some(first) => writeln!(
            out,
            "types change from state to state above {:.0} Hz: places there are not one \
             mode throughout",
            first.lowest_hz
        ),
        None => Ok(()),
    }
}
