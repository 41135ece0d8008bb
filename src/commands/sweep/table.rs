//! The table of a sweep.

use experiments::sweep::{Attraction, LargestMultiplier, Line, SweepPoint};

use super::result::{ChainPoint, SweepOutput};
use crate::commands::turning;
use crate::output::{Notation, Table};

impl SweepOutput {
    /// One row for each point.
    pub(super) fn points(&self) -> impl Iterator<Item = Row<'_>> {
        self.points.iter().map(|ChainPoint { chain, point }| Row {
            result: self,
            chain,
            point,
            line: None,
        })
    }

    /// One row for each harmonic of each quantity; those of each body's radial, tangential and rotational displacement
    /// are followed by those of its translation.
    pub(super) fn harmonics(&self) -> Vec<Row<'_>> {
        let mut rows = Vec::new();
        for row in self.points() {
            let lines = row.point.state.with_translations().into_iter();
            rows.extend(lines.map(|line| Row { line: Some(line), ..row }));
        }
        rows
    }
}

/// A row of the table: of a point in text, of one of its harmonics in files.
pub(super) struct Row<'r> {
    pub(super) result: &'r SweepOutput,
    pub(super) chain: &'r str,
    pub(super) point: &'r SweepPoint,
    pub(super) line: Option<Line>,
}

/// The table of a sweep.
pub(super) fn table<'r>() -> Table<'r, Row<'r>> {
    use Notation::{Fixed, Plain, Power, Share};
    let case = |r: &Row<'_>| r.point.state.case;
    let largest = |r: &Row<'_>| r.point.largest_multiplier.clone();
    let table = Table::<Row<'_>>::new()
        .column("scene", "title of the scene", |r| &r.result.scene)
        .column("fidelity", "fidelity of the fidelity ladder", |r| &r.result.fidelity)
        .column("sun_torque_nm", "torque on the sun, N m", move |r| case(r).sun_torque_nm)
        .column("speed_rpm", "speed of the input member, rpm", move |r| case(r).speed_rpm)
        .shown("rpm", Fixed(1))
        .key()
        .column("mesh_frequency_hz", "mesh frequency, Hz", move |r| case(r).mesh_frequency_hz)
        .shown("f_m Hz", Fixed(1))
        .column("chain", "chain of the plan: up, down, about a peak, or from a random start", |r| {
            r.chain
        })
        .shown("chain", Plain)
        .key();
    let table = turning::with_harmonic(table, |r| r.line.as_ref());
    turning::with_strongest(table, |r| (&r.point.state, r.result.harmonics))
        .words("lowest N", Fixed(0), |r: &Row<'_>| r.point.lowest_force_n)
        .meaning("lowest force of any mesh during a cycle, N")
        .words("no contact", Share, |r: &Row<'_>| r.point.contact_loss)
        .meaning("largest part of the time in which a mesh carries nothing; – for never")
        .words("backside", Plain, |r: &Row<'_>| {
            r.point.backside_contact.map_or("n/a".into(), |part| Share.number(part))
        })
        .right()
        .meaning(
            "part of the time in which backside flanks of any mesh press; n/a for a model \
             without backside flanks",
        )
        .words("grazing", Fixed(3), |r: &Row<'_>| r.point.grazing_margin)
        .meaning(
            "least of lowest over mean force of the meshes that never part, near 0 of \
             which μ loses its meaning; – where all part",
        )
        .column("cycles", "mesh cycles marched", |r| r.point.cycles)
        .shown("cycles", Plain)
        .column(
            "residual",
            "change of the last two periods, with shooting from the last to the next one, \
             over the largest peak-to-peak vibration",
            |r| r.point.residual,
        )
        .shown("residual", Power(0))
        .column(
            "repeats_after",
            "mesh cycles after which the motion repeats; none up to 8: not periodic, or \
             not settled yet",
            |r| r.point.repeats_after,
        )
        .shown("repeats", Plain)
        .column(
            "attracts",
            "by_multipliers (yes), by_decay (decay, as changes were seen to fall), \
             repels (no), neutral (a multiplier of size 1), not_shown (–)",
            |r| r.point.attracts.name(),
        )
        .shown_as("attracts", |r| attracts(r.point.attracts).into())
        .column(
            "multiplier",
            "size of the largest Floquet multiplier of one period, below 1 if the motion \
             attracts; none without multipliers",
            |r| r.point.largest_multiplier(),
        )
        .shown("μ", Fixed(3))
        .column(
            "multiplier_kind",
            "fold (+1), period_doubling (−1), neimark_sacker (a complex pair): how stability \
             is lost where it becomes 1 in size, and the type of the motion that it multiplies",
            move |r| largest(r).map_or(String::new(), |m| m.kind),
        )
        .shown_as("loses it", move |r| largest(r).map_or("–".into(), |m| loses(&m)))
        .column(
            "mode_type",
            "type of the motion that it multiplies: rotational, translational, planet, \
             mixed",
            move |r| largest(r).and_then(|m| m.mode_type).unwrap_or_default(),
        )
        .column(
            "start",
            "where the search began: rest, the speed before, an unstable motion, pushed, \
             or a random start",
            |r| r.point.start.to_string(),
        )
        .column("sun_turns", "sense in which the sun turns relative to the carrier", move |r| {
            case(r).sun_turns.name()
        })
        .column("frequency_hz", "frequency of the harmonic, l f_m, Hz", move |r| {
            r.line.as_ref().map(|l| l.harmonic as f64 * case(r).mesh_frequency_hz)
        })
}

/// Whether a motion attracts, in a word.
fn attracts(attraction: Attraction) -> &'static str {
    match attraction {
        Attraction::ByMultipliers => "yes",
        Attraction::ByDecay => "decay",
        Attraction::Repels => "no",
        Attraction::Neutral => "neutral",
        Attraction::NotShown => "–",
    }
}

/// How stability is lost where the largest multiplier becomes 1 in size, and in which type of motion.
fn loses(largest: &LargestMultiplier) -> String {
    let kind = match largest.kind.as_str() {
        "period_doubling" => "doubling",
        "neimark_sacker" => "pair",
        other => other,
    };
    match &largest.mode_type {
        Some(mode_type) => format!("{kind}, {mode_type}"),
        None => kind.into(),
    }
}
