//! The tables of `docs/auto.md` that report the tests of `auto`, from `kept/auto.csv` and `kept/auto_responses.csv`.

use std::fmt::Write;

/// A row of either file.
struct Row<'t> {
    seed: &'t str,
    quantity: &'t str,
    tolerance: f64,
    /// Settings, or "refused".
    chosen: &'t str,
    estimated: Option<f64>,
    error: Option<f64>,
    cheapest: &'t str,
    ratio: Option<f64>,
    /// Beside the cheapest FE/contact candidate; natural frequencies only.
    fe_ratio: Option<f64>,
    miss: &'t str,
}

/// Rows of a file in the order of its lines; `None` if a line is not of its form.
fn rows(text: &str) -> Option<Vec<Row<'_>>> {
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let one = |line| -> Option<Row<'_>> {
        let cells: Vec<&str> = str::split(line, ',').collect();
        let number = |k: usize| cells.get(k)?.parse().ok();
        let has_fe_ratio = cells.len() == 13;
        Some(Row {
            seed: cells.first()?,
            quantity: cells.get(2)?,
            tolerance: number(3)?,
            chosen: cells.get(4)?,
            estimated: number(5),
            error: number(8),
            cheapest: cells.get(9)?,
            ratio: number(10),
            fe_ratio: if has_fe_ratio { number(11) } else { None },
            miss: cells.last()?,
        })
    };
    lines.map(one).collect()
}

/// Counts of some rows as the cells of a line of a table.
fn counts(name: &str, rows: &[&Row<'_>]) -> String {
    let answered: Vec<&&Row<'_>> = rows.iter().filter(|row| row.chosen != "refused").collect();
    let count = |of: &dyn Fn(&Row<'_>) -> bool| answered.iter().filter(|row| of(row)).count();
    let above = count(&|row| row.error.is_some_and(|error| error > row.tolerance));
    let below = count(&|row| row.error.zip(row.estimated).is_some_and(|(e, own)| e > own));
    let twice = count(&|row| row.ratio.is_some_and(|ratio| ratio <= 2.0));
    let fe_twice = count(&|row| row.fe_ratio.or(row.ratio).is_some_and(|ratio| ratio <= 2.0));
    let estimates = median(answered.iter().filter_map(|r| Some(r.estimated? / r.error?)).collect());
    let ratio = median(answered.iter().filter_map(|row| row.ratio).collect());
    let needless = rows.iter().filter(|row| row.miss == "refused").count();
    format!(
        "| {name} | {} | {} | {above} | {below} | {estimates:.1} | {twice} | {fe_twice} | {ratio:.1} | {needless} |",
        rows.len(),
        answered.len()
    )
}

fn median(mut list: Vec<f64>) -> f64 {
    list.sort_by(f64::total_cmp);
    list.get(list.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Settings in few words.
fn short(settings: &str) -> String {
    let words = [
        (" flank elements divided in three", " divided"),
        (" flank elements", ""),
        (" graded contact cells", " graded"),
        (" contact cells", ""),
        (" steps per mesh cycle", " steps"),
        (" inertia of elastic displacements to first order", ", inertia"),
        ("modal with ", ""),
        (" about the extremes as close as ", ", extremes "),
        ("quasi_static", "quasi-static"),
        ("lumped with parameters in closed form", "lumped"),
    ];
    words.into_iter().fold(settings.to_owned(), |text, (long, own)| text.replace(long, own))
}

/// Counts of both files, then every answer above its tolerance or dearer than twice the cheapest candidate, then every
/// refusal for which a candidate would have been enough; `None` if a file is not of its form.
pub fn auto_tables(frequencies: &str, responses: &str) -> Option<String> {
    let (frequencies, responses) = (rows(frequencies)?, rows(responses)?);
    let is_at_rest = |row: &&Row<'_>| row.quantity.ends_with("at rest");
    let mut text = String::from(
        "| | sets | answered | errors above the tolerance | estimates below the error | median estimate over error | cost \
         within 2 times | the same beside FE/contact candidates | median cost ratio | refused although a candidate would do |\n\
         |---|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n",
    );
    let all: Vec<&Row<'_>> = frequencies.iter().collect();
    let (at_rest, moving): (Vec<&Row<'_>>, Vec<&Row<'_>>) = responses.iter().partition(is_at_rest);
    for (name, list) in [("frequencies", &all), ("at rest", &at_rest), ("in motion", &moving)] {
        writeln!(text, "{}", counts(name, list)).ok()?;
    }
    text.push_str(
        "\n| set | quantity | tolerance, % | chosen (elements, cells) | estimated, % | error, % | would have been enough | cost \
         ratio | miss |\n|---|---|---:|---|---:|---:|---|---:|---|\n",
    );
    let both = || frequencies.iter().chain(&responses);
    for row in both().filter(|row| !row.miss.is_empty() && row.miss != "refused") {
        let [estimated, error] = [row.estimated, row.error].map(Option::unwrap_or_default);
        let ratio = row.ratio.map_or(String::new(), |ratio| format!("{ratio:.1}"));
        writeln!(
            text,
            "| {} | {} | {} | {} | {estimated:.2} | {error:.3} | {} | {ratio} | {} |",
            row.seed,
            row.quantity,
            row.tolerance,
            short(row.chosen),
            short(row.cheapest),
            row.miss
        )
        .ok()?;
    }
    text.push_str("\n| refused set | quantity | tolerance, % | would have been enough (elements, cells) |\n|---|---|---:|---|\n");
    for row in both().filter(|row| row.miss == "refused") {
        let Row { seed, quantity, tolerance, cheapest, .. } = row;
        writeln!(text, "| {seed} | {quantity} | {tolerance} | {} |", short(cheapest)).ok()?;
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One set of each outcome is counted and listed where it belongs.
    #[test]
    fn every_outcome_is_counted_and_listed() {
        let frequencies = "# made\nhead\n\
            1,4,natural frequency of planet mode 1,1,lumped,0.5,100,100,0.0000,lumped,1.00,0.01,\n\
            2,4,natural frequency of planet mode 2,1,quasi_static 6 flank elements 20 contact cells,0.5,102,100,2.0000,none,,,error\n\
            3,4,natural frequency of planet mode 3,1,refused,,,100,,quasi_static 6 flank elements 20 contact cells,3.00,3.00,refused\n\
            # without a truth\n";
        let responses = "head\n\
            7,3,mean transmission error of the sun at rest,2,quasi_static 6 flank elements 20 contact cells 60 positions,1.0,9,9,0.5000,quasi_static 6 flank elements 20 contact cells 60 positions,4.00,cost\n";
        let text = auto_tables(frequencies, responses).unwrap();
        assert!(text.contains("| frequencies | 3 | 2 | 1 | 1 |"), "{text}");
        assert!(text.contains("| at rest | 1 | 1 | 0 | 0 | 2.0 | 0 | 0 | 4.0 | 0 |"), "{text}");
        assert!(text.contains("| in motion | 0 | 0 |"), "{text}");
        assert!(text.contains("| 2 | natural frequency of planet mode 2 | 1 | quasi-static 6 20 | 0.50 | 2.000 | none |  | error |"));
        assert!(text.contains("| 7 | mean transmission error of the sun at rest | 2 |"), "{text}");
        assert!(
            text.contains("| 3 | natural frequency of planet mode 3 | 1 | quasi-static 6 20 |")
        );
        assert!(auto_tables("head\n1,2\n", responses).is_none());
    }
}
