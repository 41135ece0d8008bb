//! The judgement as one page of HTML that needs nothing else: no script, no other file, no network.

use std::fmt::Write as _;

use validation::Status;

use super::RecordedOutput;
use super::escape::xml;
use super::judged_scene::Parameter;
use super::row::JudgedRow;
use super::suite::JudgedSuite;

/// Ids listed beside the counts.
const MOST_IDS: usize = 12;

/// Largest difference that the charts show, in tolerances.
const WIDEST: f64 = 2.4;

/// The page.
pub(super) fn html(result: &RecordedOutput, suites: &[JudgedSuite<'_>]) -> String {
    let title = format!("Verdict on {}", xml(&result.program()));
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n<h1>{title}</h1>\n",
        include_str!("page.css")
    );
    verdict(result, &mut page);
    asked(suites, &mut page);
    values(suites, &mut page);
    scores(result, &mut page);
    not_asked(result, &mut page);
    scenes(result, &mut page);
    files(result, &mut page);
    // Writing to a string cannot fail.
    let _ = write!(
        page,
        "<footer>Judged by epicyclic {} with <code>epicyclic validate --recorded</code>: its references, tolerances \
         and their reasons are those that the models of that project are held against.</footer>\n\
         </main>\n</body>\n</html>\n",
        result.about.epicyclic
    );
    page
}

fn class(status: Status) -> &'static str {
    match status {
        Status::Pass => "pass",
        Status::Fail => "fail",
        Status::Miss => "miss",
        Status::NotRun | Status::OtherKind => "other",
    }
}

fn verdict(result: &RecordedOutput, page: &mut String) {
    let verdict = &result.verdict;
    let answer = match (verdict.failed, verdict.passed + verdict.missed) {
        (0, 0) => "other",
        (0, _) => "pass",
        _ => "fail",
    };
    let _ = writeln!(
        page,
        "<p class=\"soft\">Kind of model: {}</p>\n<section class=\"verdict {answer}\">\n<ul class=\"counts\">",
        result.about.kind.name()
    );
    for (count, word, status) in [
        (verdict.passed, "passed", Status::Pass),
        (verdict.missed, "missed", Status::Miss),
        (verdict.failed, "failed", Status::Fail),
        (verdict.of_another_kind, "of another kind", Status::OtherKind),
    ] {
        let class = if count > 0 { class(status) } else { "soft" };
        let _ = writeln!(page, "<li class=\"{class}\"><b>{count}</b>{word}</li>");
    }
    let _ = writeln!(page, "</ul>\n<p>{}</p>", xml(&result.meaning()));
    for (status, word) in [(Status::Fail, "Failed"), (Status::Miss, "Missed")] {
        let mut ids: Vec<String> = result.ids(status).map(link).collect();
        if !ids.is_empty() {
            let more = ids.len().saturating_sub(MOST_IDS);
            ids.truncate(MOST_IDS);
            if more > 0 {
                ids.push(format!("and {more} more below"));
            }
            let _ = writeln!(
                page,
                "<p><span class=\"{}\">{word}:</span> {}</p>",
                class(status),
                ids.join(", ")
            );
        }
    }
    page.push_str("</section>\n");
}

/// A name that leads to its place on the page.
fn link(name: &str) -> String {
    format!("<a href=\"#{}\"><code>{}</code></a>", xml(name), breakable(name))
}

/// An id whose line may break after a dot or an underscore.
fn breakable(id: &str) -> String {
    xml(id).replace('.', ".<wbr>").replace('_', "_<wbr>")
}

fn files(result: &RecordedOutput, page: &mut String) {
    page.push_str("<h2>What was read</h2>\n<div class=\"scroll\"><table>\n");
    page.push_str("<thead><tr><th>file</th><th>SHA-256</th></tr></thead>\n<tbody>\n");
    for file in &result.about.files {
        let name = xml(&file.name);
        let _ = writeln!(
            page,
            "<tr><td>{name}</td><td class=\"hash\"><code>{}</code></td></tr>",
            file.sha256
        );
    }
    page.push_str("</tbody></table></div>\n");
    if !result.about.remarks.is_empty() {
        page.push_str("<p>Remarks on how it was read:</p>\n<ul>\n");
        for remark in &result.about.remarks {
            let _ = writeln!(page, "<li>{}</li>", xml(remark));
        }
        page.push_str("</ul>\n");
    }
}

/// Scenes with their parameters.
fn scenes(result: &RecordedOutput, page: &mut String) {
    page.push_str(
        "<h2>Scenes</h2>\n<p class=\"soft\">Parameters with which the references were computed or published. That of \
         a mesh stands at the sun or the ring.</p>\n<div class=\"scroll\"><table>\n<thead><tr><th>quantity</th>\
         <th class=\"number\">carrier</th><th class=\"number\">ring</th><th class=\"number\">sun</th>\
         <th class=\"number\">planet</th></tr></thead>\n",
    );
    for scene in &result.about.scenes {
        let [id, title] = [&scene.id, &scene.title].map(|text| xml(text));
        let _ = writeln!(
            page,
            "<tbody><tr class=\"why\"><th colspan=\"5\"><code>{id}</code> {title}. {} \
             <span class=\"hash\">SHA-256 <code>{}</code></span></th></tr>",
            xml(&scene.words()),
            scene.sha256
        );
        for Parameter { name, unit, values } in &scene.parameters {
            let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
            let _ = write!(page, "<tr><td>{name}{unit}</td>");
            for value in values {
                let value = value.map_or_else(|| "–".to_owned(), number);
                let _ = write!(page, "<td class=\"number\">{value}</td>");
            }
            page.push_str("</tr>\n");
        }
        page.push_str("</tbody>\n");
    }
    page.push_str("</table></div>\n");
}

/// A parameter with at most five digits.
fn number(value: f64) -> String {
    let rounded: f64 = format!("{value:.4e}").parse().unwrap_or(value);
    match rounded.abs() {
        size if size != 0.0 && !(1e-3..1e5).contains(&size) => format!("{rounded:e}"),
        _ => rounded.to_string(),
    }
}

/// Suites with their counts.
fn asked(suites: &[JudgedSuite<'_>], page: &mut String) {
    page.push_str(
        "<h2>What was asked</h2>\n<div class=\"scroll\"><table>\n<thead><tr><th>suite</th><th>what is compared</th>\
         <th class=\"number\">passed</th><th class=\"number\">missed</th><th class=\"number\">failed</th>\
         <th class=\"number\">another kind</th></tr></thead>\n<tbody>\n",
    );
    for suite in suites.iter().filter(|suite| !suite.rows.is_empty()) {
        let _ = write!(page, "<tr><td>{}</td><td>{}</td>", link(&suite.name), xml(&suite.about));
        for status in [Status::Pass, Status::Miss, Status::Fail, Status::OtherKind] {
            let (class, count) = match suite.count(status) {
                0 => ("soft", "–".to_owned()),
                count => (class(status), count.to_string()),
            };
            let _ = write!(page, "<td class=\"number {class}\">{count}</td>");
        }
        page.push_str("</tr>\n");
    }
    page.push_str("</tbody></table></div>\n");
}

fn not_asked(result: &RecordedOutput, page: &mut String) {
    if result.verdict.not_asked.is_empty() {
        return;
    }
    page.push_str(
        "<h2>What was not asked</h2>\n<div class=\"scroll\"><table>\n\
         <thead><tr><th>suite</th><th>what it needs that is not there</th></tr></thead>\n<tbody>\n",
    );
    for not_asked in &result.verdict.not_asked {
        let (suite, lacks) = (breakable(&not_asked.suite), xml(&not_asked.lacks));
        let _ = writeln!(page, "<tr><td><code>{suite}</code></td><td>{lacks}</td></tr>");
    }
    page.push_str("</tbody></table></div>\n");
}

/// Correct digits beside the data set.
fn scores(result: &RecordedOutput, page: &mut String) {
    if result.scores.is_empty() {
        return;
    }
    page.push_str(
        "<h2>Correct digits beside the data set</h2>\n<div class=\"scroll\"><table>\n<thead><tr><th>scene</th>\
         <th>quantity</th><th>class</th><th class=\"number\">values</th><th class=\"number\">fewest</th>\
         <th class=\"number\">median</th><th>value with the fewest</th></tr></thead>\n<tbody>\n",
    );
    for score in &result.scores {
        let _ = writeln!(
            page,
            "<tr><td><code>{}</code></td><td>{}</td><td>{}</td><td class=\"number\">{}</td>\
             <td class=\"number\">{:.1}</td><td class=\"number\">{:.1}</td><td><code>{}</code></td></tr>",
            breakable(&score.scene),
            breakable(&score.quantity),
            score.class.name(),
            score.values,
            score.fewest_digits,
            score.median_digits,
            breakable(&score.worst)
        );
    }
    page.push_str("</tbody></table></div>\n");
}

/// Tables by suite.
fn values(suites: &[JudgedSuite<'_>], page: &mut String) {
    page.push_str(
        "<h2>Values beside their references</h2>\n<p class=\"soft\">The last column draws (yours − reference)/tolerance \
         about its zero line: the shaded band is what the tolerance allows, a triangle at the edge is further off than \
         the chart is wide. Beside it stands the size of that quotient.</p>\n",
    );
    for suite in suites.iter().filter(|suite| !suite.rows.is_empty()) {
        let [name, about] = [&suite.name, &suite.about].map(|text| xml(text));
        let _ = writeln!(
            page,
            "<h3 id=\"{name}\">{name} <span>{about}</span></h3>\n<div class=\"scroll\"><table class=\"values\">\n<thead><tr>\
             <th>check</th><th class=\"number\">reference</th><th class=\"number\">yours</th><th>unit</th>\
             <th class=\"number\">difference %</th><th class=\"number\">tolerance</th><th class=\"number\">digits</th>\
             <th>verdict</th>\
             <th colspan=\"2\">difference / tolerance</th></tr></thead>"
        );
        for group in suite.groups() {
            page.push_str("<tbody>\n");
            let [reason, source] = [group[0].reason, group[0].source].map(xml);
            let _ = writeln!(
                page,
                "<tr class=\"why\"><th colspan=\"10\">Tolerance: {reason}. Reference: {source}.</th></tr>"
            );
            group.iter().for_each(|row| value(row, page));
            page.push_str("</tbody>\n");
        }
        page.push_str("</table></div>\n");
    }
}

fn value(row: &JudgedRow<'_>, page: &mut String) {
    let [id, title, unit] = [row.id, row.title, row.unit].map(xml);
    let accepted = row.acceptance();
    let accepted =
        accepted.map_or_else(String::new, |text| format!("<small>{}</small>", xml(&text)));
    let JudgedRow { difference, tolerance, digits, word, .. } = row;
    let ([reference, yours], mark) = match row.is_list {
        true => ([String::new(), String::new()], " class=\"long\""),
        false => ([&row.reference, &row.yours].map(|text| xml(text)), ""),
    };
    let _ = writeln!(
        page,
        "<tr id=\"{id}\"{mark}><td>{title}<small><code>{}</code></small>{accepted}</td>\
         <td class=\"number\">{reference}</td><td class=\"number\">{yours}</td><td>{unit}</td>\
         <td class=\"number\">{difference}</td><td class=\"number\">{tolerance}</td>\
         <td class=\"number\">{digits}</td><td class=\"{}\">{word}</td><td class=\"number\">{}</td><td>{}</td></tr>",
        breakable(row.id),
        class(row.status),
        row.part.map_or_else(|| "–".to_owned(), size),
        chart(row)
    );
    if row.is_list {
        let [reference, yours] = [&row.reference, &row.yours].map(|text| xml(text));
        let yours = if yours == reference { "the same" } else { &yours };
        let _ = writeln!(
            page,
            "<tr class=\"list\"><td colspan=\"10\">reference: {reference}<br>yours: {yours}</td></tr>"
        );
    }
}

/// The size of a difference over its tolerance.
fn size(part: f64) -> String {
    match part.abs() {
        size if !size.is_finite() => "–".to_owned(),
        size if size >= 1e5 => format!("{size:.0e}"),
        size if size >= 10.0 => format!("{size:.0}"),
        size => format!("{size:.2}"),
    }
}

/// The difference over its tolerance about a zero line.
fn chart(row: &JudgedRow<'_>) -> String {
    let Some(part) = row.part.filter(|part| part.is_finite()) else { return String::new() };
    let x = |part: f64| 55.0 + 20.0 * part.clamp(-WIDEST, WIDEST);
    let [low, high] = row.allowed.map(x);
    let at = x(part);
    let class = class(row.status);
    let mark = match part {
        part if part > WIDEST => format!("<path class=\"{class}\" d=\"M{at:.0} 3v10l6-5z\"/>"),
        part if part < -WIDEST => format!("<path class=\"{class}\" d=\"M{at:.0} 3v10l-6-5z\"/>"),
        _ => format!("<circle class=\"{class}\" cx=\"{at:.1}\" cy=\"8\" r=\"3.5\"/>"),
    };
    format!(
        "<svg viewBox=\"0 0 110 16\" role=\"img\" aria-label=\"{part:.2} tolerances\"><rect class=\"band\" x=\"{low:.1}\" \
         y=\"1\" width=\"{:.1}\" height=\"14\"/><path class=\"zero\" d=\"M55 1v14\"/>{mark}</svg>",
        high - low
    )
}
