//! What text shows of a check.

use anstyle::{AnsiColor, Style};
use validation::{Check, Status, Value};

/// Expected, actual, difference and tolerance for people.
pub(super) fn cells(check: &Check) -> [String; 4] {
    let digits = if check.tolerance.absolute > 0.0 {
        (1.0 - check.tolerance.absolute.log10()).ceil().clamp(0.0, 4.0) as usize
    } else {
        0
    };
    let is_tiny = check.tolerance.absolute > 0.0 && check.tolerance.absolute < 1e-4;
    let number = |x: f64| match is_tiny && x != 0.0 {
        _ if x.is_nan() => "none".to_owned(),
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
    let [expected, actual] = match (&check.expected, &check.actual) {
        (Value::List(expected), Some(Value::List(actual))) if expected != actual => {
            first_difference(expected, actual)
        }
        (expected, actual) => [shown(expected), actual.as_ref().map_or("–".into(), shown)],
    };
    [
        expected,
        actual,
        check.difference_percent.map_or("–".into(), |d| format!("{d:+.3}")),
        tolerance,
    ]
}

/// The first entries of two lists that differ, each with its number.
fn first_difference(expected: &[Value], actual: &[Value]) -> [String; 2] {
    let most = expected.len().max(actual.len());
    let k = (0..most).find(|k| expected.get(*k) != actual.get(*k)).unwrap_or_default();
    [expected, actual].map(|list| match list.get(k) {
        Some(entry) => format!("entry {}: {}", k + 1, summary(std::slice::from_ref(entry))),
        None => format!("{} entries", list.len()),
    })
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

/// (actual − expected)/tolerance, `None` of what is no number, has no tolerance or has not run; NaN of NaN.
pub(super) fn signed_part(check: &Check) -> Option<f64> {
    let tolerance = check.tolerance.absolute;
    match (&check.expected, check.actual.as_ref()?) {
        (Value::Number(expected), Value::Number(actual)) if tolerance > 0.0 => {
            Some((actual - expected) / tolerance)
        }
        _ => None,
    }
}

/// Word shown for a status.
pub(super) fn status_word(status: Status) -> &'static str {
    match status {
        Status::Pass => "pass",
        Status::Fail => "FAIL",
        Status::Miss => "miss",
        Status::NotRun => "not run",
        Status::OtherKind => "other kind",
    }
}

/// A word in the colour of a status, except `–`; anstream removes the colour where there is no terminal.
pub(super) fn coloured(word: &str, status: Status) -> String {
    let colour = match status {
        Status::Pass => AnsiColor::Green,
        Status::Miss => AnsiColor::Yellow,
        Status::Fail => AnsiColor::Red,
        Status::NotRun | Status::OtherKind => return word.to_owned(),
    };
    if word.trim() == "–" {
        return word.to_owned();
    }
    let style = Style::new().fg_color(Some(colour.into()));
    format!("{style}{word}{style:#}")
}
