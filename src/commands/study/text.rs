//! A study as text and as CSV.

use std::io::Write;

use experiments::study::{QuantityResult, Quartiles, Row, StudyResult, Work};

use crate::error::Result;
use crate::output::{Notation, Table, word};

/// A setting's result for a quantity.
pub(super) type Entry<'r> = (&'r QuantityResult, &'r Row, &'r str);

/// One row for each quantity and setting.
pub(super) fn rows(study: &StudyResult) -> impl Iterator<Item = Entry<'_>> {
    study.quantities.iter().flat_map(|quantity| {
        let rows = quantity.rows.iter().zip(&study.settings);
        rows.map(move |(row, setting)| (quantity, row, setting.group.as_str()))
    })
}

/// The table of a study; the cycles and `is_efficient` depend on times.
pub(super) fn table<'r>() -> Table<'r, Entry<'r>> {
    // Counts are added up as numbers.
    let work = |count: fn(&Work) -> f64| move |(_, row, _): &Entry<'r>| count(&row.work) as i64;
    let cycles = |quartiles: fn(&Row) -> Option<Quartiles>, part: fn(Quartiles) -> f64| {
        move |(_, row, _): &Entry<'r>| quartiles(row).map(part)
    };
    Table::<Entry<'r>>::new()
        .column("quantity", "", |(quantity, ..)| &quantity.name)
        .column("setting", "", |(_, row, _)| &row.setting)
        .column("group", "", |(.., group)| *group)
        .column("unit", "", |(quantity, ..)| &quantity.unit)
        .column("value", "", |(_, row, _)| row.value)
        .column("truth", "", |(quantity, ..)| quantity.truth.value)
        .column("uncertainty_percent", "", |(q, ..)| q.truth.uncertainty_percent)
        .column("error_percent", "", |(_, row, _)| row.error_percent)
        .column("guarded_percent", "", |(_, row, _)| row.guarded_percent)
        .column("doubt", "", |(_, row, _)| row.doubt.as_ref().map(word))
        .column("rank", "", |(_, row, _)| row.rank)
        .column("least_rank", "", |(_, row, _)| row.ranks.map(|ranks| ranks[0]))
        .column("greatest_rank", "", |(_, row, _)| row.ranks.map(|ranks| ranks[1]))
        .column("is_within_uncertainty", "", |(_, row, _)| row.is_within_uncertainty)
        .column("steps", "", work(|w| w.steps))
        .column("contact_solutions", "", work(|w| w.contact_solutions))
        .column("iterations", "", work(|w| w.iterations))
        .column("derivatives", "", work(|w| w.derivatives))
        .column("marched_instead", "", work(|w| w.marched_instead))
        .column("coordinates", "", work(|w| w.coordinates))
        .column("fe_unknowns", "", work(|w| w.fe_unknowns))
        .column("contact_cells", "", work(|w| w.contact_cells))
        .column("bytes", "", work(|w| w.bytes))
        .column("is_efficient_by_work", "", |(_, row, _)| row.is_efficient_by_work)
        .column("set_up_cycles", "", cycles(|row| row.time.set_up_cycles, |q| q.median))
        .column("solution_cycles", "", cycles(|row| row.time.solution_cycles, |q| q.median))
        .column("cost_cycles_low", "", cycles(|row| row.time.cost_cycles, |q| q.low))
        .column("cost_cycles", "", cycles(|row| row.time.cost_cycles, |q| q.median))
        .column("cost_cycles_high", "", cycles(|row| row.time.cost_cycles, |q| q.high))
        .column("is_efficient", "", |(_, row, _)| row.time.is_efficient)
        .column("refusal", "", |(_, row, _)| row.refusal.clone())
}

/// A table for each quantity, with its truth above and what follows from it below.
pub(crate) fn write_text(study: &StudyResult, out: &mut dyn Write) -> Result<()> {
    writeln!(out, "{}", study.title)?;
    writeln!(out, "{}, {} N·m on the sun", study.scene, study.sun_torque_nm)?;
    if !study.keys.is_empty() {
        writeln!(out, "throughout: {}", study.keys.join(", "))?;
    }
    let q = &study.time.yardstick_s;
    writeln!(
        out,
        "cost 1: a mesh cycle of the lumped model, 140 steps, {:.0} µs [{:.0}, {:.0}] on this machine; {} rounds",
        1e6 * q.median,
        1e6 * q.low,
        1e6 * q.high,
        study.rounds
    )?;
    for quantity in &study.quantities {
        writeln!(out)?;
        write_quantity(study, quantity, out)?;
    }
    writeln!(
        out,
        "\nmarks: * efficient (no setting is both cheaper and more accurate), ? efficiency open within U or the quartiles, \
         w efficient by counted work; ~ rank open within U, ! small error that a finer setting does not bear out, \
         = error below U"
    )?;
    Ok(())
}

fn write_quantity(
    study: &StudyResult,
    quantity: &QuantityResult,
    out: &mut dyn Write,
) -> Result<()> {
    let truth = &quantity.truth;
    let unit = if quantity.unit == "1" { String::new() } else { format!(" {}", quantity.unit) };
    writeln!(
        out,
        "{}: truth {}{unit}, U = {} %",
        quantity.name,
        Notation::Digits.number(truth.value),
        Notation::Digits.number(truth.uncertainty_percent)
    )?;
    for route in &truth.routes {
        let order = route.order.map_or(String::new(), |p| format!(", order {p:.2}"));
        writeln!(
            out,
            "  {}: {} ± {} %{order}",
            route.name,
            Notation::Digits.number(route.value),
            Notation::Digits.number(100.0 * route.uncertainty / route.value.abs())
        )?;
    }
    shown_table(quantity).text(&quantity.rows, out)?;
    for note in &quantity.notes {
        writeln!(out, "  {note}")?;
    }
    writeln!(out, "  {}", sentence(study, quantity))?;
    Ok(())
}

/// What text shows of a quantity's settings.
fn shown_table<'r>(quantity: &'r QuantityResult) -> Table<'r, &'r Row> {
    use Notation::{Digits, Plain};
    let percent = |x: Option<f64>| x.map_or("–".to_owned(), shown_percent);
    let cost = |r: &&Row, words: fn(&Quartiles) -> String| {
        r.time.cost_cycles.as_ref().map_or("–".to_owned(), words)
    };
    let rank = |r: &&Row| match (r.rank, r.ranks) {
        (Some(rank), Some([low, high])) if low != high => format!("{rank} ({low}–{high})"),
        (Some(rank), _) => rank.to_string(),
        _ => "–".into(),
    };
    Table::<&Row>::new()
        .words("setting", Plain, |r| &r.setting)
        .key()
        .words("value", Digits, |r| r.value)
        .words("error %", Plain, move |r| percent(r.error_percent))
        .right()
        .words("ranked by %", Plain, move |r| percent(r.guarded_percent))
        .right()
        .words("rank", Plain, rank)
        .right()
        .words("cost", Plain, move |r| cost(r, |q| shown_cost(q.median)))
        .right()
        .words("quartiles", Plain, move |r| {
            cost(r, |q| format!("[{}, {}]", shown_cost(q.low), shown_cost(q.high)))
        })
        .right()
        .words("set-up", Plain, |r| r.time.set_up_cycles.map(|q| shown_cost(q.median)))
        .right()
        .words(quantity.work.words(), Digits, |r| r.work.of(quantity.work))
        .words("", Plain, marks)
}

/// Marks of a row, explained below the tables.
fn marks(row: &&Row) -> String {
    let is_open = row.ranks.is_some_and(|[low, high]| low != high);
    let marks = [
        (row.time.is_efficient, '*'),
        (row.time.is_efficiency_uncertain, '?'),
        (row.is_efficient_by_work, 'w'),
        (is_open, '~'),
        (row.doubt.is_some(), '!'),
        (row.is_within_uncertainty, '='),
    ];
    marks.iter().filter(|(is, _)| *is).map(|(_, mark)| mark).collect()
}

/// The answer of a study in one sentence.
pub(crate) fn sentence(study: &StudyResult, quantity: &QuantityResult) -> String {
    let within = format!("{} within {} %", quantity.name, study.tolerance_percent);
    match (&quantity.time.answer, quantity.time.answer_cycles) {
        (Some(setting), Some(cost)) => {
            let others = match quantity.time.equally_cheap.as_slice() {
                [] => String::new(),
                list => format!("; no dearer within the quartiles: {}", list.join(", ")),
            };
            format!(
                "For {within}, use {setting}: {} lumped mesh cycles{others}.",
                shown_cost(cost.median)
            )
        }
        _ => format!("For {within}: none of these settings can be shown to be."),
    }
}

/// Three decimals; a power of ten where they would show nothing.
fn shown_percent(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if a < 1e-3 => format!("{x:.0e}"),
        _ => format!("{x:.3}"),
    }
}

/// Three digits.
fn shown_cost(x: f64) -> String {
    match x.abs() {
        a if a >= 99.5 => format!("{x:.0}"),
        a if a >= 9.95 => format!("{x:.1}"),
        _ => format!("{x:.2}"),
    }
}
