//! Stability of lumped sets and of motions: classes A and B.
//!
//! Class A: the longest step of central difference, by the theorem ω Δt = 2 on the frequency of the independent routes
//! and by the spectral radius of the program's steps; borders of tongues by Floquet multipliers of this program and of
//! `benches/independent_borders.py`. Class B: the damping below which teeth part, by branches and by scaling
//! (`kept/stability/contact-loss.json`). Class C: what has no theory.

use std::f64::consts::PI;

use dynamics::stability::explicit_limit;
use experiments::stability::StabilityMap;
use lumped::{ModeType, NaturalModes, ParametricSet, Tongue, tongues};
use validation::certified::{Class, Row};

use super::meshes::Found;
use super::{scene_named, scenes};

/// Least uncertainty of the longest step, in parts: the width at which its bisection ends.
const BISECTION: f64 = 2e-9;

/// ε at which borders of tongues are given, harmonics of the mesh frequency, and number of tongues of a set, the widest
/// first.
const VARIATION: f64 = 0.02;
const HARMONICS: u32 = 3;
const MOST_TONGUES: usize = 8;

/// Least uncertainty of a border, in parts: both programs call a motion growing whose multiplier is above 1 by 1e-6.
const THRESHOLD: f64 = 1e-9;

/// Largest difference with which a border is certified, in parts.
const AGREEMENT: f64 = 1e-8;

/// Sets whose tongues are in the table.
const PARAMETRIC: [&str; 2] = ["five_planets", "oh58_3p"];

/// Tongues nearer than this many half-widths change each other's borders.
const APART: f64 = 6.0;

/// Scene of `contact-loss.json`, and the part by which its factors are known: they are steps of a ladder.
const CONTACT_LOSS: &str = "oh58_4p";
const LADDER: f64 = 0.09;

/// Name of a curve of `contact-loss.json` and the quantity it is here.
const FACTORS: [(&str, &str); 3] = [
    ("contact is lost below", "contact_loss_damping_factor"),
    ("more than one motion is stable below", "several_motions_damping_factor"),
    ("backside flanks touch below", "backside_contact_damping_factor"),
];

/// All rows; `closed` are those of the closed forms, with the frequencies of the independent routes.
pub(super) fn rows(closed: &[Row]) -> Found<Vec<Row>> {
    let mut rows = longest_steps(closed)?;
    let mut found = Vec::new();
    for id in PARAMETRIC {
        found.extend(borders(id)?);
    }
    rows.extend(certified(found)?);
    rows.extend(damping_factors()?);
    Ok(rows)
}

/// `2/ω_max` of every lumped set.
fn longest_steps(closed: &[Row]) -> Found<Vec<Row>> {
    let mut rows = Vec::new();
    let limit = explicit_limit(0.0)?;
    for known in scenes() {
        let of_set = |row: &&Row| {
            row.scene == known.id && row.kind == "lumped" && row.quantity == "frequency"
        };
        let highest_hz = closed.iter().filter(of_set).map(|row| row.value).fold(0.0, f64::max);
        if highest_hz == 0.0 {
            continue;
        }
        let model = lumped::LumpedModel::from_scene(&known.scene)?;
        let groups = NaturalModes::of(&model)?.groups;
        let ours_hz = groups.iter().map(|group| group.frequency_hz).fold(0.0, f64::max);
        let value = 2.0 / (2.0 * PI * highest_hz);
        let ours = limit / (2.0 * PI * ours_hz);
        rows.push(Row {
            uncertainty: (2.0 * (value - ours).abs()).max(BISECTION * value),
            class: Class::A,
            routes: "theorem ω Δt = 2 and independent_routes.py; epicyclic: spectral radius".into(),
            source: known.scene.source.clone().unwrap_or_default(),
            ..Row::new(&known.id, "lumped", "longest_step", "", value)
        });
    }
    Ok(rows)
}

/// Borders of the widest tongues that stand alone.
fn borders(id: &str) -> Found<Vec<Row>> {
    let scene = scene_named(id)?;
    let set = ParametricSet::from_scene(&scene, VARIATION)?;
    let groups = NaturalModes::of(set.model())?.groups;
    let name = |mode_type: ModeType, hz: f64| {
        let alike = groups.iter().filter(|group| group.mode_type == mode_type);
        let number = alike.filter(|group| group.frequency_hz <= hz).count();
        format!("{}_{number}", mode_type.name())
    };
    let mut all = tongues(&set, HARMONICS)?;
    all.retain(|tongue| tongue.strength() > 1e-9);
    all.sort_by(|a, b| b.half_width_hz.total_cmp(&a.half_width_hz));
    let is_alone = |tongue: &&Tongue| {
        let near = |other: &&Tongue| {
            let wide = APART * VARIATION * tongue.half_width_hz.max(other.half_width_hz);
            (other.mesh_frequency_hz - tongue.mesh_frequency_hz).abs() < wide
        };
        all.iter().filter(near).count() == 1
    };
    let mut rows = Vec::new();
    for tongue in all.iter().filter(is_alone).take(MOST_TONGUES) {
        let Some(found) = set.edges(tongue)? else { continue };
        let [first, second] = [0, 1].map(|k| name(tongue.mode_type[k], tongue.frequency_hz[k]));
        let subject = format!("{first} {second}");
        for (quantity, value) in [("lower_border", found.low_hz), ("upper_border", found.high_hz)] {
            rows.push(Row {
                harmonic: Some(tongue.harmonic),
                source: scene.source.clone().unwrap_or_default(),
                ..Row::new(id, "lumped", quantity, &subject, value)
            });
        }
    }
    Ok(rows)
}

/// A row of `reference/independent_borders.csv`.
#[derive(serde::Deserialize)]
struct Independent {
    scene: String,
    subject: String,
    harmonic: u32,
    lower_border: f64,
    upper_border: f64,
}

/// Borders with the values of the other program; the uncertainty is twice the largest relative difference of any of
/// them. What it does not have is of class C.
fn certified(mut rows: Vec<Row>) -> Found<Vec<Row>> {
    let text = std::fs::read_to_string("reference/independent_borders.csv")?;
    let others: Vec<Independent> =
        csv::Reader::from_reader(text.as_bytes()).deserialize().collect::<Result<_, _>>()?;
    let mut largest = THRESHOLD;
    for row in &mut rows {
        let other = others.iter().find(|other| {
            let conditions = (&other.scene, &other.subject, Some(other.harmonic));
            conditions == (&row.scene, &row.subject, row.harmonic)
        });
        (row.class, row.routes) = (Class::C, "epicyclic: Floquet multipliers".to_owned());
        let Some(other) = other else {
            eprintln!("{}: no other route: run benches/independent_borders.py", row.name());
            continue;
        };
        let is_lower = row.quantity == "lower_border";
        let value = if is_lower { other.lower_border } else { other.upper_border };
        largest = largest.max(2.0 * (row.value / value - 1.0).abs());
        (row.value, row.class) = (value, Class::A);
        row.routes = format!("independent_borders.py; {}", row.routes);
    }
    for row in &mut rows {
        row.uncertainty = largest * row.value;
    }
    if largest > AGREEMENT {
        return Err(format!("borders differ by {largest:e} of their frequency").into());
    }
    Ok(rows)
}

/// Factors on the damping at which contact is lost.
fn damping_factors() -> Found<Vec<Row>> {
    let text = epicyclic_data::text("kept/stability/contact-loss.json").ok_or("no such map")?;
    let map: StabilityMap = serde_json::from_str(text)?;
    let source = scene_named(CONTACT_LOSS)?.source.unwrap_or_default();
    let mut rows = Vec::new();
    for (name, quantity) in FACTORS {
        let curve = |is_theory: bool| {
            let mut curves = map.curves.iter().filter(move |curve| curve.is_theory == is_theory);
            let curve = curves.find(|curve| curve.name == name);
            curve.map(|curve| curve.points.clone()).unwrap_or_default()
        };
        let theory = curve(true);
        for (torque_nm, power) in curve(false) {
            let value = 10f64.powf(power);
            let of_torque = theory.iter().find(|(other_nm, _)| *other_nm == torque_nm);
            let off = of_torque.map_or(0.0, |(_, other)| (10f64.powf(*other) - value).abs());
            let (class, routes) = match of_torque {
                Some(_) => (Class::B, "epicyclic: branches; epicyclic: scaling of the response"),
                None => (Class::C, "epicyclic: branches"),
            };
            rows.push(Row {
                sun_torque_nm: Some(torque_nm),
                uncertainty: (2.0 * off).max(LADDER * value),
                class,
                routes: routes.into(),
                source: source.clone(),
                ..Row::new(CONTACT_LOSS, "fe_contact", quantity, "", value)
            });
        }
    }
    Ok(rows)
}
