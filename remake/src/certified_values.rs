//! Prints `docs/certified_values.md` from the data set: `cargo run --release -p remake -- certified_values`.

use std::fmt::Write;

use validation::certified::{CertifiedValues, Class, DATA_SET_VERSION, Row};

/// What stands above the tables.
const HEAD: &str = "# Certified values

On this page you look up one official number for a gear set, and cite it by its id. Test your own model against it:

```sh
epicyclic dataset values                   # every value as CSV, the scenes, and a page that says how to read them
epicyclic dataset check values             # whether a copy is whole
epicyclic snapshot my_results              # correct digits of your results (results.md), stored as a baseline
epicyclic snapshot my_results --check      # what moved since, by how many digits, towards these values or away
```

An id names the same value in every version: kind of model, scene, quantity, subject, number. A value has an expanded
uncertainty and a class. **A** is certified: two independent codes, or a code and a theorem, agree within the uncertainty.
**B**: two numerical routes of this program agree. **C**: one route. Here are the natural frequencies, contact ratios,
pressure angles and phases of every scene, and all meshes that are held by another program. Digits that are not certain
are left out; twelve are shown at most. Terms are in [glossary.md](glossary.md), tables for your own results in
[results.md](results.md).
";

/// Quantities and kinds of model that people look up.
const SHOWN: [(&str, &str); 8] = [
    ("geometry", "contact_ratio"),
    ("geometry", "operating_pressure_angle"),
    ("geometry", "gamma"),
    ("lumped", "frequency"),
    ("fe_contact", "frequency"),
    ("lumped", "longest_step"),
    ("lumped", "lower_border"),
    ("lumped", "upper_border"),
];

/// Most digits of a value.
const MOST_DIGITS: f64 = 12.0;

pub(crate) fn remake() -> crate::Outcome {
    print!("{}", page(CertifiedValues::shipped()));
    Ok(())
}

// Writing to a string cannot fail.
fn page(values: &CertifiedValues) -> String {
    let mut text = format!("{HEAD}\nVersion {DATA_SET_VERSION} of the data set holds:\n\n");
    text.push_str("| table | A | B | C |\n|---|---:|---:|---:|\n");
    for (name, rows) in &values.tables {
        let [a, b, c] =
            Class::ALL.map(|class| rows.iter().filter(|row| row.class == class).count());
        let _ = writeln!(text, "| {name} | {a} | {b} | {c} |");
    }
    let is_shown = |row: &&Row| {
        let is = |(kind, quantity): &(&str, &str)| row.kind == *kind && row.quantity == *quantity;
        SHOWN.iter().any(is) || row.approach_um.is_some()
    };
    let mut rows: Vec<&Row> = values.rows().filter(is_shown).collect();
    rows.sort_by(|a, b| a.scene.cmp(&b.scene));
    for of_scene in rows.chunk_by(|a, b| a.scene == b.scene) {
        let scene = &of_scene[0].scene;
        let _ = writeln!(text, "\n## [{scene}](../scenes/{scene}.toml)\n");
        text.push_str("| id | value | ± | class |\n|---|---:|---:|---|\n");
        for row in of_scene {
            let (value, off, class) = (digits(row), row.uncertainty, row.class.name());
            let _ = writeln!(text, "| {} | {value} {} | {off:.0e} | {class} |", row.id, row.unit);
        }
    }
    text
}

/// The value to the digit in which its uncertainty begins.
fn digits(row: &Row) -> String {
    let size = row.value.abs().log10().floor();
    if row.value == 0.0 {
        return "0".to_owned();
    }
    let certain = (size - row.uncertainty.max(f64::MIN_POSITIVE).log10().floor() + 1.0)
        .clamp(1.0, MOST_DIGITS);
    let rounded: f64 =
        format!("{:.*e}", certain as usize - 1, row.value).parse().unwrap_or(row.value);
    match (-4.0..7.0).contains(&size) {
        true => format!("{rounded:.*}", (certain - 1.0 - size).max(0.0) as usize),
        false => format!("{:.*e}", certain as usize - 1, row.value),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_that_of_the_data_set() {
        let kept = std::fs::read_to_string(
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/certified_values.md"),
        )
        .unwrap();
        let page = page(CertifiedValues::shipped());
        assert!(
            page == kept,
            "docs/certified_values.md is stale: cargo run --release -p remake -- certified_values"
        );
        assert!(page.len() < 30_000, "{} bytes", page.len());
    }

    #[test]
    fn digits_end_where_the_uncertainty_begins() {
        let row = |value: f64, uncertainty: f64| {
            digits(&Row { uncertainty, ..Row::new("s", "lumped", "frequency", "", value) })
        };
        assert_eq!(row(681.0402679921206, 6.8e-13), "681.040267992");
        assert_eq!(row(1234.567, 0.3), "1234.6");
        assert_eq!(row(1234.567, 30.0), "1230");
        assert_eq!(row(1.5e-5, 1e-7), "1.50e-5");
        assert_eq!(row(0.0, 0.0), "0");
    }
}
