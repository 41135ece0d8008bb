//! The judgement as Markdown, for a folder of reports and for the step summary of a CI.

use std::fmt::Write as _;

use validation::Status;
use validation::certified::Score;

use super::RecordedOutput;
use super::escape::markdown as escaped;
use super::row::JudgedRow;
use super::suite::JudgedSuite;

/// Headings of tables by status, and whether the table is folded away.
const TABLES: [(Status, &str, bool); 5] = [
    (Status::Fail, "Failed", false),
    (Status::Miss, "Missed, as listed", false),
    (Status::OtherKind, "Another kind of model: shown, not judged", true),
    (Status::NotRun, "Not run", true),
    (Status::Pass, "Passed", true),
];

/// The page.
pub(super) fn markdown(result: &RecordedOutput, suites: &[JudgedSuite<'_>]) -> String {
    let about = &result.about;
    let mut text = format!("# Verdict on {}\n\n", escaped(&result.program()));
    // Writing to a string cannot fail.
    let _ = writeln!(text, "**{}.** {}\n", result.counts(), escaped(&result.meaning()));
    for (status, heading, is_folded) in TABLES {
        let rows = suites.iter().flat_map(|s| &s.rows).filter(|row| row.status == status);
        table(heading, is_folded, &rows.collect::<Vec<_>>(), &mut text);
    }
    scores(&result.scores, &mut text);
    reasons(suites, &mut text);
    let _ = writeln!(text, "## What was read\n\nKind of model: {}.\n", about.kind.name());
    text.push_str("| file | SHA-256 |\n|---|---|\n");
    for file in &about.files {
        let _ = writeln!(text, "| {} | `{}` |", escaped(&file.name), file.sha256);
    }
    text.push_str("\n| scene | title | about it | SHA-256 |\n|---|---|---|---|\n");
    for scene in &about.scenes {
        let [title, words] = [&scene.title, &scene.words()].map(|text| escaped(text));
        let _ = writeln!(text, "| `{}` | {title} | {words} | `{}` |", scene.id, scene.sha256);
    }
    if !about.remarks.is_empty() {
        text.push_str("\nRemarks on how it was read:\n\n");
    }
    for remark in &about.remarks {
        let _ = writeln!(text, "- {}", escaped(remark));
    }
    if !result.verdict.not_asked.is_empty() {
        text.push_str("\n## What was not asked\n\n| suite | needs |\n|---|---|\n");
        for not_asked in &result.verdict.not_asked {
            let lacks = escaped(&not_asked.lacks);
            let _ = writeln!(text, "| `{}` | {lacks} |", not_asked.suite);
        }
    }
    let _ = writeln!(text, "\nJudged by epicyclic {}.", about.epicyclic);
    text
}

fn table(heading: &str, is_folded: bool, rows: &[&JudgedRow<'_>], text: &mut String) {
    if rows.is_empty() {
        return;
    }
    let count = rows.len();
    let _ = match is_folded {
        true => writeln!(text, "<details><summary>{heading} ({count})</summary>\n"),
        false => writeln!(text, "## {heading} ({count})\n"),
    };
    text.push_str(
        "| check | title | reference | yours | unit | difference % | tolerance | correct digits |\n",
    );
    text.push_str("|---|---|---:|---:|---|---:|---:|---:|\n");
    for row in rows {
        let yours = if row.is_list && row.yours == row.reference { "the same" } else { &row.yours };
        let [title, reference, yours] = [row.title, &row.reference, yours].map(escaped);
        let JudgedRow { id, unit, difference, tolerance, digits, .. } = row;
        let _ = writeln!(
            text,
            "| `{id}` | {title} | {reference} | {yours} | {unit} | {difference} | {tolerance} | {digits} |"
        );
    }
    text.push('\n');
    for row in rows {
        if let Some(acceptance) = row.acceptance() {
            let _ = writeln!(text, "`{}` is {}\n", row.id, escaped(&acceptance));
        }
    }
    if is_folded {
        text.push_str("</details>\n\n");
    }
}

/// Correct digits beside the data set.
fn scores(scores: &[Score], text: &mut String) {
    if scores.is_empty() {
        return;
    }
    text.push_str("## Correct digits beside the data set\n\n");
    text.push_str(
        "| scene | quantity | class | values | fewest | median | value with the fewest |\n",
    );
    text.push_str("|---|---|---|---:|---:|---:|---|\n");
    for score in scores {
        let Score { scene, quantity, class, values, fewest_digits, median_digits, worst } = score;
        let class = class.name();
        let _ = writeln!(
            text,
            "| `{scene}` | {quantity} | {class} | {values} | {fewest_digits:.1} | {median_digits:.1} | `{worst}` |"
        );
    }
    text.push('\n');
}

/// The reason of every tolerance, once for the checks that share it.
fn reasons(suites: &[JudgedSuite<'_>], text: &mut String) {
    text.push_str("## Tolerances and sources\n\n| checks | reason of the tolerance | source |\n|---|---|---|\n");
    for group in suites.iter().flat_map(JudgedSuite::groups) {
        let (first, last) = (&group[0], &group[group.len() - 1]);
        let ids = match group.len() {
            1 => format!("`{}`", first.id),
            n => format!("`{}` to `{}` ({n})", first.id, last.id),
        };
        let [reason, source] = [first.reason, first.source].map(escaped);
        let _ = writeln!(text, "| {ids} | {reason} | {source} |");
    }
    text.push('\n');
}
