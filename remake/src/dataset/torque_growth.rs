//! Class B: resonant peaks over torque, on a fine mesh of elements with many steps in a mesh cycle and, of
//! `kept/torque_peaks.toml`, on those of the scene. Where `kept/exact_peaks.toml` has exact kinematics at every
//! step, it is a third route.

use experiments::models::FeContact;
use experiments::sweep::{Part, naturals};
use experiments::torque::{Followed, follow, lowest_series, static_growth};
use gearset::Body;
use lumped::ModeType;
use scene::{LoadCase, Scene};
use validation::Reference;
use validation::certified::{Class, Row};

use super::meshes::{Found, MESHES, route_in_time};
use super::scene_named;

/// Scenes and what `kept/torque_peaks.toml` calls them.
const SYSTEMS: [(&str, &str); 3] = [
    ("oh58_4p", "default scene"),
    ("oh58_4p_published_stiffness", "meshes as soft as published"),
    ("oh58_4p_second_system", "second system"),
];

/// Torque of the modes about whose frequencies peaks are looked for, N m.
const MODES_NM: f64 = 1130.0;

/// Change from cycle to cycle of a steady state, in parts of the vibration.
const TOLERANCE: f64 = 1e-6;

/// Least uncertainty of growth: the kept one has four decimals.
const DECIMALS: f64 = 1e-4;

pub(super) fn rows() -> Found<Vec<Row>> {
    let reference = Reference::load()?;
    let kept = &reference.torque_peaks;
    let torques = &kept.torques_nm;
    let mut rows = Vec::new();
    for (id, system) in SYSTEMS {
        let shipped = scene_named(id)?;
        let scene = MESHES[0].given_to(&shipped);
        let model = FeContact::default();
        let bodies = model.bodies(&scene)?;
        let modes = naturals(&scene, &bodies, LoadCase::standing(MODES_NM))?;
        let series = lowest_series(&modes).ok_or("no such modes")?;
        let parts = [Part::SUN, Part::Body(Body::Planet(0))];
        let found = follow(&model, &scene, torques, &series, &parts, TOLERANCE)?;
        let at_rest = static_growth(&scene, &bodies, torques)?;
        let routes = [&scene, &shipped].map(route_in_time);
        let mut of_system = Rows { id, scene: &scene, torques, routes, rows: &mut rows };
        for followed in &found {
            let (mode, l) = (followed.series.mode(), followed.series.harmonic);
            let is_same = |m: &str, harmonic: usize| m == mode && harmonic == l;
            let mut peaks = kept.peak.iter().filter(|peak| peak.system == system);
            let peak = peaks.find(|peak| is_same(&peak.mode, peak.harmonic as usize));
            let peak = peak.ok_or_else(|| format!("{system}: no kept peak of {mode}, l = {l}"))?;
            let exact = reference.exact_peaks.peak.iter();
            let exact = exact.filter(|peak| is_same(&peak.mode, peak.harmonic));
            // The second of three speeds is that of the peak.
            let heights: Vec<f64> = exact.map(|peak| peak.sun[1]).collect();
            let is_there = id == SYSTEMS[0].0 && heights.len() == torques.len();
            let exact = is_there.then_some(heights.as_slice());
            of_system.peak(followed, peak, exact);
            let kind = usize::from(followed.series.mode_type != ModeType::Rotational);
            let rest: Vec<f64> =
                at_rest.iter().map(|of| of[kind][l] / at_rest[0][kind][l]).collect();
            of_system.at_rest(followed, &rest, &peak.at_rest);
        }
        eprintln!("peaks over torque of {id}");
    }
    // Harmonics at rest stand for several modes.
    let mut names = std::collections::HashSet::new();
    rows.retain(|row: &Row| names.insert(row.name()));
    Ok(rows)
}

struct Rows<'s> {
    id: &'s str,
    scene: &'s Scene,
    torques: &'s [f64],
    /// Both routes that all values have.
    routes: [String; 2],
    rows: &'s mut Vec<Row>,
}

impl Rows<'_> {
    /// Values at every torque with those of the other routes; the uncertainty is twice the largest relative difference
    /// at any torque.
    fn add(&mut self, row: &Row, values: &[f64], others: &[&[f64]], routes: &str) {
        let mut largest = 0.0f64;
        for other in others {
            for (value, other) in values.iter().zip(*other) {
                largest = largest.max((other / value - 1.0).abs());
            }
        }
        for (torque_nm, value) in self.torques.iter().zip(values) {
            // Growth is 1 at the first torque, by definition.
            if row.quantity.ends_with("growth") && *torque_nm == self.torques[0] {
                continue;
            }
            self.rows.push(Row {
                sun_torque_nm: Some(*torque_nm),
                value: *value,
                uncertainty: (2.0 * largest * value).max(DECIMALS * value),
                class: Class::B,
                routes: routes.to_owned(),
                source: self.scene.source.clone().unwrap_or_default(),
                ..row.clone()
            });
        }
    }

    fn row(&self, followed: &Followed, quantity: &str, subject: &str) -> Row {
        let is_rotation = followed.series.mode_type == ModeType::Rotational;
        Row {
            coordinate: if is_rotation { "rotation" } else { "translation" }.to_owned(),
            number: Some(if followed.series.is_lowest { 1 } else { 3 }),
            harmonic: Some(followed.series.harmonic as u32),
            ..Row::new(self.id, "fe_contact", quantity, subject, 0.0)
        }
    }

    fn peak(&mut self, followed: &Followed, kept: &validation::TorquePeak, exact: Option<&[f64]>) {
        let two = self.routes.join("; ");
        let speed = self.row(followed, "peak_speed", "sun");
        self.add(&speed, &followed.speeds_rpm, &[&kept.speeds_rpm], &two);
        let planet = self.row(followed, "peak_growth", "planet_0");
        self.add(&planet, &Followed::growth(&followed.planet), &[&kept.planet], &two);
        let sun = self.row(followed, "peak_growth", "sun");
        let growth = Followed::growth(&followed.sun);
        let Some(exact) = exact else { return self.add(&sun, &growth, &[&kept.sun], &two) };
        let third = "epicyclic: exact kinematics at every step";
        let routes = format!("{two}; {third}");
        self.add(&sun, &growth, &[&kept.sun, &Followed::growth(exact)], &routes);
        let unit = if sun.coordinate == "rotation" { "rad" } else { "m" };
        let height = Row { unit: unit.to_owned(), ..self.row(followed, "peak_amplitude", "sun") };
        let finer = self.routes[0].clone();
        self.add(&height, &followed.sun, &[exact], &format!("{finer}; {third}"));
    }

    fn at_rest(&mut self, followed: &Followed, values: &[f64], kept: &[f64]) {
        let row = Row { number: None, ..self.row(followed, "static_growth", "sun") };
        self.add(&row, values, &[kept], &self.routes.join("; "));
    }
}
