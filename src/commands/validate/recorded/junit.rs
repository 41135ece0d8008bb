//! The judgement as JUnit XML: a test suite for each suite, a test case for each check.

use std::fmt::Write as _;

use validation::Status;

use super::RecordedOutput;
use super::escape::xml;
use super::row::JudgedRow;
use super::suite::JudgedSuite;

/// What a test suite counts.
#[derive(Default, Clone, Copy)]
struct Counts {
    tests: usize,
    failures: usize,
    skipped: usize,
}

impl Counts {
    fn new(suite: &JudgedSuite<'_>) -> Self {
        let tests = suite.rows.len() + suite.not_asked.len();
        let failures = suite.count(Status::Fail);
        Self { tests, failures, skipped: tests - failures - suite.count(Status::Pass) }
    }

    /// Attributes of `testsuite`; readers want the time, which a judgement has none of.
    fn attributes(self) -> String {
        let Self { tests, failures, skipped } = self;
        format!(r#"tests="{tests}" failures="{failures}" errors="0" skipped="{skipped}" time="0""#)
    }
}

/// The file, with one element a line.
pub(super) fn junit(result: &RecordedOutput, suites: &[JudgedSuite<'_>]) -> String {
    let mut all = Counts::default();
    for counts in suites.iter().map(Counts::new) {
        all.tests += counts.tests;
        all.failures += counts.failures;
        all.skipped += counts.skipped;
    }
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let name = xml(&result.program());
    // Writing to a string cannot fail.
    let _ = writeln!(text, r#"<testsuites name="{name}" {}>"#, all.attributes());
    for suite in suites {
        let name = xml(&suite.name);
        let attributes = Counts::new(suite).attributes();
        let _ = writeln!(text, r#"<testsuite name="{name}" {attributes}>"#);
        properties(result, &mut text);
        suite.rows.iter().for_each(|row| test_case(&name, row, &mut text));
        for not_asked in &suite.not_asked {
            let lacks = xml(&not_asked.lacks);
            let _ = writeln!(
                text,
                r#"<testcase classname="{name}" name="not asked: {lacks}" time="0"><skipped message="not asked: needs {lacks}"/></testcase>"#
            );
        }
        text.push_str("</testsuite>\n");
    }
    text.push_str("</testsuites>\n");
    text
}

fn properties(result: &RecordedOutput, text: &mut String) {
    let about = &result.about;
    text.push_str("<properties>");
    for (name, value) in [
        ("program", about.program.as_deref().unwrap_or_default()),
        ("version", about.version.as_deref().unwrap_or_default()),
        ("kind", about.kind.name()),
        ("epicyclic", about.epicyclic),
    ] {
        let _ = write!(text, r#"<property name="{name}" value="{}"/>"#, xml(value));
    }
    text.push_str("</properties>\n");
}

fn test_case(suite: &str, row: &JudgedRow<'_>, text: &mut String) {
    let name = xml(&format!("{}: {}", row.id, row.title));
    let _ = write!(text, r#"<testcase classname="{suite}" name="{name}" time="0""#);
    let comparison = xml(&row.comparison());
    let _ = match row.status {
        Status::Pass => writeln!(text, "/>"),
        Status::Fail => writeln!(
            text,
            r#"><failure type="tolerance" message="{comparison}">{comparison}&#10;source: {}</failure></testcase>"#,
            xml(row.source)
        ),
        Status::Miss | Status::NotRun | Status::OtherKind => {
            let acceptance =
                row.acceptance().map_or_else(String::new, |text| format!(" {}", xml(&text)));
            writeln!(
                text,
                r#"><skipped message="{}: {comparison}{acceptance}"/></testcase>"#,
                row.word
            )
        }
    };
}
