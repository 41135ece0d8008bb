//! Every check of a verdict in one table, and the cells of its rows.

use std::io::Write;

use comfy_table::Cell;
use validation::{Check, Status, Value, Verdict};

use crate::output;

use super::verdict_text::coloured;

/// Writes all checks.
pub(super) fn write(verdict: &Verdict, out: &mut dyn Write) -> std::io::Result<()> {
    let header = ["check", "expected", "actual", "unit", "difference %", "tolerance", "verdict"];
    let mut table = output::table(&header, &[1, 2, 4, 5]);
    for check in &verdict.checks {
        let [expected, actual, difference, tolerance] = cells(check);
        table.add_row(vec![
            Cell::new(&check.id),
            Cell::new(expected),
            Cell::new(actual),
            Cell::new(&check.unit),
            Cell::new(difference),
            Cell::new(tolerance),
            Cell::new(status_word(check.status)),
        ]);
    }
    for line in table.lines() {
        let line = line.trim_end();
        let word = [Status::Pass, Status::Miss, Status::Fail].into_iter();
        let word = word.filter_map(|s| Some((line.strip_suffix(status_word(s))?, s))).next();
        match word {
            Some((front, status)) => {
                writeln!(out, "{front}{}", coloured(status_word(status), status))?
            }
            None => writeln!(out, "{line}")?,
        }
    }
    for check in verdict.checks.iter().filter(|c| c.status == Status::Fail) {
        writeln!(out, "FAILED {}: {} (source: {})", check.id, check.title, check.source)?;
        let (expected, actual) = (&check.expected, &check.actual);
        writeln!(out, "  expected {expected:?}, actual {actual:?}")?;
    }
    if verdict.missed > 0 {
        writeln!(out, "misses are analysed in checks/misses.toml")?;
    }
    let Verdict { passed, missed, failed, .. } = verdict;
    writeln!(out, "{passed} passed, {missed} missed, {failed} failed")
}

/// Expected, actual, difference and tolerance for people.
pub(crate) fn cells(check: &Check) -> [String; 4] {
    let digits = if check.tolerance.absolute > 0.0 {
        (1.0 - check.tolerance.absolute.log10()).ceil().clamp(0.0, 4.0) as usize
    } else {
        0
    };
    let is_tiny = check.tolerance.absolute > 0.0 && check.tolerance.absolute < 1e-4;
    let number = |x: f64| match is_tiny && x != 0.0 {
        true => format!("{x:.1e}"),
        false => format!("{x:.digits$}"),
    };
    let shown = |value: &Value| match value {
        Value::Number(x) => number(*x),
        Value::Text(text) => text.clone(),
        Value::List(list) => summary(list),
    };
    let tolerance = match check.tolerance.absolute {
        0.0 => "exact".to_owned(),
        t if t < 1e-4 => format!("{t:.0e}"),
        t => format!("{t:.4}").trim_end_matches('0').trim_end_matches('.').to_owned(),
    };
    [
        shown(&check.expected),
        check.actual.as_ref().map_or("–".into(), shown),
        check.difference_percent.map_or("–".into(), |d| format!("{d:+.3}")),
        tolerance,
    ]
}

/// A list for a table cell: equal neighbours counted, long lists cut.
fn summary(list: &[Value]) -> String {
    let words: Vec<String> = list
        .iter()
        .map(|v| match v {
            Value::Number(x) => format!("{x}"),
            Value::Text(t) => t.clone(),
            Value::List(l) => summary(l),
        })
        .collect();
    if words.len() > 1 && words.iter().all(|w| *w == words[0]) {
        return format!("{} × ({})", words.len(), words[0]);
    }
    if words.len() > 2 {
        return format!("{} entries", words.len());
    }
    words.join("; ")
}

/// Word shown for a status.
pub(crate) fn status_word(status: Status) -> &'static str {
    match status {
        Status::Pass => "pass",
        Status::Fail => "FAIL",
        Status::Miss => "miss",
        Status::NotRun => "not run",
    }
}
