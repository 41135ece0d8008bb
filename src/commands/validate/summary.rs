//! Summary of a verdict: one line per suite, then every miss and failure in full.

use std::io::Write;

use validation::{Check, Miss, Status, Value, Verdict};

use super::check_cells::{cells, coloured, signed_part};
use crate::output::{WIDTH, paragraph};

/// Longest name of a suite that is not cut.
const LONGEST_NAME: usize = 33;

/// Columns of the counts between a suite's name and its check furthest off.
const COUNTS: usize = 33;

/// The suite an id belongs to: its first two parts (`fe.hertz` of `fe.hertz.width.sun`), the first alone
/// if there are but two (`table1` of `table1.gamma`).
pub(super) fn suite_of(id: &str) -> &str {
    let mut dots = id.match_indices('.').map(|(at, _)| at);
    match (dots.next(), dots.next()) {
        (Some(_), Some(second)) => &id[..second],
        (Some(first), None) => &id[..first],
        _ => id,
    }
}

/// Checks of one suite.
struct Suite<'v> {
    name: &'v str,
    checks: Vec<&'v Check>,
}

impl Suite<'_> {
    fn count(&self, status: Status) -> usize {
        self.checks.iter().filter(|check| check.status == status).count()
    }

    /// The check with the largest deviation relative to its tolerance, and that ratio.
    fn worst(&self) -> Option<(&Check, f64)> {
        let parts =
            self.checks.iter().filter_map(|check| Some((*check, part_of_tolerance(check)?)));
        parts.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// |actual − expected| over the tolerance; infinite for a statement that does not hold and for a value that
/// is not a number, `None` for a statement that holds and for a check that has not run.
fn part_of_tolerance(check: &Check) -> Option<f64> {
    check.actual.as_ref()?;
    match signed_part(check) {
        Some(part) if part.is_nan() => Some(f64::INFINITY),
        Some(part) => Some(part.abs()),
        None => (check.status != Status::Pass).then_some(f64::INFINITY),
    }
}

/// Suites in the order of their first checks.
fn suites(verdict: &Verdict) -> Vec<Suite<'_>> {
    let mut list: Vec<Suite<'_>> = Vec::new();
    for check in &verdict.checks {
        let name = suite_of(&check.id);
        match list.iter_mut().find(|suite| suite.name == name) {
            Some(suite) => suite.checks.push(check),
            None => list.push(Suite { name, checks: vec![check] }),
        }
    }
    list
}

/// Writes suites, misses with their analysis, failures and the totals.
pub(super) fn write(
    verdict: &Verdict,
    misses: &[Miss],
    out: &mut dyn Write,
) -> std::io::Result<()> {
    let suites = suites(verdict);
    let names = suites.iter().map(|suite| suite.name.chars().count()).max().unwrap_or(0);
    let names = names.clamp(5, LONGEST_NAME);
    let header = ["suite", "pass", "miss", "fail", "not run", "of tol.", "furthest off"];
    let [suite, pass, miss, fail, not_run, part, furthest] = header;
    writeln!(
        out,
        "{suite:names$} {pass:>4} {miss:>4} {fail:>4} {not_run:>7} {part:>7}  {furthest}"
    )?;
    writeln!(out, "{}", "─".repeat(WIDTH))?;
    for suite in &suites {
        let count = |status| match suite.count(status) {
            0 => String::from("–"),
            n => n.to_string(),
        };
        let front = format!(
            "{:names$} {:>4} {} {} {:>7}",
            cut(suite.name, names),
            count(Status::Pass),
            coloured(&format!("{:>4}", count(Status::Miss)), Status::Miss),
            coloured(&format!("{:>4}", count(Status::Fail)), Status::Fail),
            count(Status::NotRun),
        );
        let Some((check, part)) = suite.worst() else {
            writeln!(out, "{front}")?;
            continue;
        };
        let row = named(check, suite.name, WIDTH - (names + COUNTS));
        writeln!(out, "{front} {:>7}  {row}", shown(part))?;
    }
    writeln!(out, "{}", "─".repeat(WIDTH))?;
    writeln!(out, "of tol.: |actual − expected| of the check furthest off over its tolerance\n")?;
    for (status, word) in [(Status::Miss, "missed"), (Status::Fail, "FAILED")] {
        for check in verdict.checks.iter().filter(|check| check.status == status) {
            let miss = misses.iter().find(|miss| miss.id == check.id);
            in_full(check, coloured(word, status), miss.filter(|_| status == Status::Miss), out)?;
        }
    }
    let Verdict { passed, missed, failed, .. } = verdict;
    writeln!(out, "{passed} passed, {missed} missed, {failed} failed")
}

/// Id and value of a check; without the suite's name, which stands at the left, where room is short.
fn named(check: &Check, suite: &str, room: usize) -> String {
    let [_, actual, ..] = cells(check);
    let value = format!("{actual} {}", check.unit);
    let whole = format!("{}: {}", check.id, value.trim_end());
    if whole.chars().count() <= room {
        return whole;
    }
    cut(whole.strip_prefix(suite).unwrap_or(&whole).trim_start_matches('.'), room)
}

/// A missed or failed check: title, values, tolerance, source and, for a miss, its analysis.
fn in_full(
    check: &Check,
    word: String,
    miss: Option<&Miss>,
    out: &mut dyn Write,
) -> std::io::Result<()> {
    writeln!(out, "{word} {}", cut(&check.id, WIDTH - 7))?;
    let mut paragraphs = vec![check.title.clone()];
    let [expected, actual, _, tolerance] = cells(check);
    let whole = |value: &Value, short: String| match value {
        Value::Number(_) => format!("{short} {}", check.unit).trim_end().to_owned(),
        value => words(value),
    };
    let expected = whole(&check.expected, expected);
    let actual = check.actual.as_ref().map_or("nothing".into(), |value| whole(value, actual));
    let unit = if check.tolerance.absolute > 0.0 { check.unit.as_str() } else { "" };
    let tolerance = format!("{tolerance} {unit}");
    paragraphs.push(format!(
        "expected {expected}, actual {actual}, tolerance {} ({})",
        tolerance.trim_end(),
        check.tolerance.reason
    ));
    paragraphs.push(format!("source: {}", check.source));
    let analysis = miss.map(|miss| miss.analysis.split_whitespace().collect::<Vec<_>>().join(" "));
    paragraphs.extend(analysis);
    for text in paragraphs {
        writeln!(out, "{}", paragraph(&text, "  ", "  "))?;
    }
    writeln!(out)
}

/// A value written out in full.
pub(super) fn words(value: &Value) -> String {
    match value {
        Value::Number(x) => x.to_string(),
        Value::Text(text) => format!("“{text}”"),
        Value::List(list) => list.iter().map(words).collect::<Vec<_>>().join("; "),
    }
}

/// A deviation over its tolerance as text; `–` for a statement that does not hold.
fn shown(part: f64) -> String {
    match part {
        p if !p.is_finite() => "–".into(),
        p if p >= 1000.0 => format!("{p:.0e}"),
        p if p > 0.0 && p < 0.005 => format!("{p:.0e}"),
        p => format!("{p:.2}"),
    }
}

/// At most so many characters, the last a `…` if something is left out.
fn cut(text: &str, room: usize) -> String {
    if text.chars().count() <= room {
        return text.to_owned();
    }
    let front: String = text.chars().take(room.saturating_sub(1)).collect();
    front + "…"
}

/// The verdict of the quick profile as kept.
#[cfg(test)]
pub(super) fn kept() -> Verdict {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/snapshots/verdict.snap");
    let text = std::fs::read_to_string(path).unwrap();
    // The header that insta writes precedes the JSON.
    serde_json::from_str(&text[text.find("\n{").unwrap()..]).unwrap()
}

#[cfg(test)]
mod tests {
    use super::*;
    use validation::Reference;

    fn plain(text: &[u8]) -> String {
        anstream::adapter::strip_bytes(text).into_vec().try_into().unwrap()
    }

    fn written(verdict: &Verdict) -> String {
        let misses = Reference::load().unwrap().misses;
        let mut out = Vec::new();
        write(verdict, &misses, &mut out).unwrap();
        plain(&out)
    }

    #[test]
    fn suites_are_the_front_of_ids() {
        for (id, suite) in [
            ("fe.hertz.width.sun", "fe.hertz"),
            ("table2.lumped.3", "table2.lumped"),
            ("table1.gamma", "table1"),
            ("alone", "alone"),
        ] {
            assert_eq!(suite_of(id), suite);
        }
    }

    #[test]
    fn the_quick_verdict_fits_a_hundred_columns_and_says_all_that_is_off() {
        let verdict = kept();
        let text = written(&verdict);
        for line in text.lines() {
            assert!(line.chars().count() <= WIDTH, "{line}");
        }
        assert!(verdict.missed > 0);
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        let (all, misses) = (words(&text), Reference::load().unwrap().misses);
        for check in verdict.checks.iter().filter(|c| c.status == Status::Miss) {
            let miss = misses.iter().find(|miss| miss.id == check.id).unwrap();
            for part in [&check.id, &words(&check.title), &words(&miss.analysis)] {
                assert!(all.contains(part.as_str()), "{part}");
            }
        }
        let last = text.lines().last().unwrap();
        let Verdict { passed, missed, failed, .. } = verdict;
        assert_eq!(last, format!("{passed} passed, {missed} missed, {failed} failed"));
        // One line per suite, so far fewer lines than checks.
        let rule = "─".repeat(WIDTH);
        let lines = text.lines().skip(2).take_while(|line| *line != rule);
        assert!(lines.count() < verdict.checks.len() / 4);
    }

    #[test]
    fn what_fails_is_said_in_full_and_its_suite_names_it() {
        let mut verdict = kept();
        let check = verdict.checks.iter_mut().find(|c| c.id == "table2.lumped.1").unwrap();
        check.title = "a title that is far too long for one line ".repeat(5);
        (check.actual, check.status) = (Some(Value::Number(f64::NAN)), Status::Fail);
        let text = written(&verdict);
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH));
        assert!(text.contains("FAILED table2.lumped.1\n"), "{text}");
        let own = text.lines().find(|line| line.starts_with("table2.lumped ")).unwrap();
        assert!(own.ends_with("table2.lumped.1: none Hz"), "{own}");
    }

    #[test]
    fn long_names_are_cut() {
        assert_eq!((cut("abcd", 4), cut("abcde", 4)), ("abcd".into(), "abc…".into()));
    }
}
