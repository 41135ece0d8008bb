//! A study as text and as CSV.

use std::io::Write;

use experiments::study::{Doubt, QuantityResult, Quartiles, Row, StudyResult};

use crate::error::CommandError;
use crate::output;

/// Columns of the CSV; the cycles and `is_efficient` depend on times.
const HEADER: [&str; 31] = [
    "quantity",
    "setting",
    "group",
    "unit",
    "value",
    "truth",
    "uncertainty_percent",
    "error_percent",
    "guarded_percent",
    "doubt",
    "rank",
    "least_rank",
    "greatest_rank",
    "is_within_uncertainty",
    "steps",
    "contact_solutions",
    "iterations",
    "derivatives",
    "marched_instead",
    "coordinates",
    "fe_unknowns",
    "contact_cells",
    "bytes",
    "is_efficient_by_work",
    "set_up_cycles",
    "solution_cycles",
    "cost_cycles_low",
    "cost_cycles",
    "cost_cycles_high",
    "is_efficient",
    "refusal",
];

/// One row for each quantity and setting.
pub(super) fn write_csv(study: &StudyResult, out: &mut dyn Write) -> Result<(), CommandError> {
    let mut rows = Vec::new();
    for quantity in &study.quantities {
        for (row, setting) in quantity.rows.iter().zip(&study.settings) {
            rows.push(cells(quantity, row, &setting.group));
        }
    }
    output::csv(out, &HEADER, rows)
}

fn cells(quantity: &QuantityResult, row: &Row, group: &str) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let count = |x: Option<usize>| x.map_or(String::new(), |x| x.to_string());
    let (time, work) = (&row.time, &row.work);
    let median = |q: Option<Quartiles>| number(q.map(|q| q.median));
    let mut cells = vec![
        quantity.name.clone(),
        row.setting.clone(),
        group.to_owned(),
        quantity.unit.clone(),
        number(row.value),
        quantity.truth.value.to_string(),
        quantity.truth.uncertainty_percent.to_string(),
        number(row.error_percent),
        number(row.guarded_percent),
        row.doubt.map_or("", doubt_word).to_owned(),
        count(row.rank),
        count(row.ranks.map(|r| r[0])),
        count(row.ranks.map(|r| r[1])),
        row.is_within_uncertainty.to_string(),
    ];
    let counts = [
        work.steps,
        work.contact_solutions,
        work.iterations,
        work.derivatives,
        work.marched_instead,
        work.coordinates,
        work.fe_unknowns,
        work.contact_cells,
        work.bytes,
    ];
    cells.extend(counts.map(|x| x.to_string()));
    cells.extend([
        row.is_efficient_by_work.to_string(),
        median(time.set_up_cycles),
        median(time.solution_cycles),
        number(time.cost_cycles.map(|q| q.low)),
        median(time.cost_cycles),
        number(time.cost_cycles.map(|q| q.high)),
        time.is_efficient.to_string(),
        row.refusal.clone().unwrap_or_default(),
    ]);
    cells
}

fn doubt_word(doubt: Doubt) -> &'static str {
    match doubt {
        Doubt::Crossing => "crossing",
        Doubt::GrowsWithRefinement => "grows_with_refinement",
    }
}

/// A table for each quantity, with its truth above and what follows from it below.
pub(super) fn write_text(study: &StudyResult, out: &mut dyn Write) -> Result<(), CommandError> {
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
) -> Result<(), CommandError> {
    let truth = &quantity.truth;
    let unit = if quantity.unit == "1" { String::new() } else { format!(" {}", quantity.unit) };
    writeln!(
        out,
        "{}: truth {}{unit}, U = {} %",
        quantity.name,
        shown(truth.value),
        shown(truth.uncertainty_percent)
    )?;
    for route in &truth.routes {
        let order = route.order.map_or(String::new(), |p| format!(", order {p:.2}"));
        writeln!(
            out,
            "  {}: {} ± {} %{order}",
            route.name,
            shown(route.value),
            shown(100.0 * route.uncertainty / route.value.abs())
        )?;
    }
    let header = [
        "setting",
        "value",
        "error %",
        "ranked by %",
        "rank",
        "cost",
        "quartiles",
        "set-up",
        "",
        "",
    ];
    let mut header = header.to_vec();
    header[8] = quantity.work.words();
    let mut table = output::table(&header, &[1, 2, 3, 4, 5, 6, 7, 8]);
    for row in &quantity.rows {
        table.add_row(text_row(quantity, row));
    }
    writeln!(out, "{table}")?;
    for note in &quantity.notes {
        writeln!(out, "  {note}")?;
    }
    writeln!(out, "  {}", sentence(study, quantity))?;
    Ok(())
}

fn text_row(quantity: &QuantityResult, row: &Row) -> Vec<String> {
    let time = &row.time;
    let cost = |f: fn(&Quartiles) -> String| time.cost_cycles.as_ref().map_or("–".into(), f);
    let rank = match (row.rank, row.ranks) {
        (Some(rank), Some([low, high])) if low != high => format!("{rank} ({low}–{high})"),
        (Some(rank), _) => rank.to_string(),
        _ => "–".into(),
    };
    let mut marks = String::new();
    let mut mark = |is: bool, c: char| {
        if is {
            marks.push(c);
        }
    };
    mark(time.is_efficient, '*');
    mark(time.is_efficiency_uncertain, '?');
    mark(row.is_efficient_by_work, 'w');
    mark(row.ranks.is_some_and(|[low, high]| low != high), '~');
    mark(row.doubt.is_some(), '!');
    mark(row.is_within_uncertainty, '=');
    let percent = |x: Option<f64>| x.map_or("–".into(), shown_percent);
    vec![
        row.setting.clone(),
        row.value.map_or("–".into(), shown),
        percent(row.error_percent),
        percent(row.guarded_percent),
        rank,
        cost(|q| shown_cost(q.median)),
        cost(|q| format!("[{}, {}]", shown_cost(q.low), shown_cost(q.high))),
        time.set_up_cycles.map_or("–".into(), |q| shown_cost(q.median)),
        shown(row.work.of(quantity.work)),
        marks,
    ]
}

/// The answer of a study in one sentence.
pub(super) fn sentence(study: &StudyResult, quantity: &QuantityResult) -> String {
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

/// Six digits; powers of ten where a number is very small or large.
fn shown(x: f64) -> String {
    match x.abs() {
        0.0 => "0".into(),
        a if !(1e-3..1e6).contains(&a) => format!("{x:.4e}"),
        a => format!("{x:.*}", 5usize.saturating_sub(a.log10().floor().max(0.0) as usize)),
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
