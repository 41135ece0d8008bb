//! Class A: closed forms and the lumped model, by this program and by `benches/independent_routes.py`.

use std::collections::HashMap;

use validation::certified::{Class, Row, closed_forms};

use super::{ROUNDING, scenes};

/// Both routes.
const ROUTES: &str = "epicyclic; independent_routes.py";

/// Largest difference of the routes, in parts of the largest value of the quantity, with which a row is certified.
const AGREEMENT: f64 = 1e-12;

/// Rounding of a length that is the small difference of others, m.
const LENGTHS_M: f64 = 1e-15;

/// A row of `reference/independent_routes.csv`.
#[derive(serde::Deserialize)]
struct Independent {
    scene: String,
    kind: String,
    quantity: String,
    body: String,
    number: Option<u32>,
    value: String,
}

/// Rows on which both routes agree.
pub(super) fn rows() -> Result<Vec<Row>, Box<dyn std::error::Error + Send + Sync>> {
    let text = std::fs::read_to_string("reference/independent_routes.csv")?;
    let mut others: HashMap<String, f64> = HashMap::new();
    for row in csv::Reader::from_reader(text.as_bytes()).deserialize() {
        let row: Independent = row?;
        others.extend(named(&row)?);
    }
    let mut rows = Vec::new();
    for known in scenes() {
        rows.extend(closed_forms(&known.id, &known.scene)?);
    }
    let mut largest: HashMap<[String; 3], f64> = HashMap::new();
    for row in &rows {
        let most = largest.entry(group(row)).or_default();
        *most = most.max(row.value.abs());
    }
    let mut certified = Vec::new();
    for row in rows {
        let name = row.name();
        let Some(value) = others.remove(&name) else {
            // Only entries of matrices that are not zero stand in the other table.
            if row.value.abs() > AGREEMENT * largest[&group(&row)] {
                eprintln!("{name}: no other route");
            }
            continue;
        };
        let difference = (row.value - value).abs();
        let scale = largest[&group(&row)];
        if difference > AGREEMENT * scale && difference > LENGTHS_M {
            return Err(format!("{name}: {} and {value}", row.value).into());
        }
        let is_count = ["multiplicity", "excites", "direction"].contains(&row.quantity.as_str());
        let rounding = if is_count { 0.0 } else { ROUNDING * value.abs() };
        let uncertainty = (2.0 * difference).max(rounding);
        let routes = ROUTES.to_owned();
        certified.push(Row { value, uncertainty, class: Class::A, routes, ..row });
    }
    match others.keys().min() {
        None => Ok(certified),
        Some(name) => Err(format!("{name}: not computed by this program").into()),
    }
}

fn group(row: &Row) -> [String; 3] {
    [&row.kind, &row.scene, &row.quantity].map(String::clone)
}

/// A row of the other route by the id of the data set; kinds of modes that a harmonic excites are a row each.
fn named(row: &Independent) -> Result<Vec<(String, f64)>, std::num::ParseFloatError> {
    let kind = if row.kind == "any" { "geometry" } else { &row.kind };
    if row.quantity != "excites" {
        let mut named = Row::new(&row.scene, kind, &row.quantity, &row.body, 0.0);
        named.number = row.number;
        return Ok(vec![(named.name(), row.value.parse()?)]);
    }
    let kinds = ["rotational", "translational", "planet"].map(|excited| {
        let mut named = Row::new(&row.scene, kind, &row.quantity, excited, 0.0);
        named.harmonic = row.number;
        let is_excited = row.value.split('+').any(|word| word == excited);
        (named.name(), f64::from(u8::from(is_excited)))
    });
    Ok(kinds.to_vec())
}
