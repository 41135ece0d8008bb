//! Class B: mesh cycles at rest of the FE/contact model, on two meshes of elements.

use std::collections::HashMap;
use std::f64::consts::TAU;

use experiments::BodiesCache;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Imperfections, MeshState, SetCycle, SetState, StaticSet, ToothPairLoad};
use gearset::{Body, Geometry, MeshKind};
use rayon::prelude::*;
use scene::{LoadCase, Scene};
use validation::certified::{Class, Row};

use super::meshes::{Found, MESHES, Mesh};
use super::scenes;

/// Scenes, and the torque on the sun where it is not that of the scene, N m.
const SETS: [(&str, Option<f64>); 5] = [
    ("automatic_transmission_set", None),
    ("five_planets", None),
    ("oh58_3p", Some(1413.0)),
    ("oh58_4p", Some(1413.0)),
    ("wind_turbine_stage", None),
];

/// Positions in a mesh cycle.
const POSITIONS: usize = 28;

/// Harmonics of the transmission error, after its mean.
const HARMONICS: usize = 5;

/// Distance from the ends of the path of contact where pressures count, base pitches.
const MARGIN: f64 = 0.1;

/// Least uncertainty in parts of the largest value of a quantity: where contact iterations end.
const ITERATIONS: f64 = 1e-9;

pub(super) fn rows() -> Found<Vec<Row>> {
    let known = scenes();
    let sets = SETS.iter().filter_map(|(id, torque)| {
        known.iter().find(|known| known.id == *id).map(|known| (*id, &known.scene, *torque))
    });
    let mut rows = Vec::new();
    for (id, scene, torque_nm) in sets {
        let mut case = LoadCase::of_scene(scene)?;
        if let Some(torque_nm) = torque_nm {
            case = case.with_sun_torque(torque_nm);
        }
        let found: Vec<Found<Vec<Row>>> =
            MESHES.par_iter().map(|mesh| one_mesh(id, scene, &case, mesh)).collect();
        let [fine, coarse] = found.try_into().map_err(|_| "two meshes")?;
        rows.extend(compared(fine?, &coarse?));
        eprintln!("mesh cycle of {id}");
    }
    Ok(rows)
}

/// The rows of the finer mesh with their uncertainties: twice the largest difference that any position of the quantity
/// has.
fn compared(fine: Vec<Row>, coarse: &[Row]) -> Vec<Row> {
    let group = |row: &Row| {
        let harmonic = row.harmonic.map_or(-1, i64::from);
        (row.quantity.clone(), row.subject.clone(), row.coordinate.clone(), harmonic)
    };
    let mut largest = HashMap::new();
    let mut values = HashMap::<String, f64>::new();
    for (a, b) in fine.iter().zip(coarse) {
        let most: &mut f64 = largest.entry(group(a)).or_default();
        *most = most.max((a.value - b.value).abs());
        let value = values.entry(a.quantity.clone()).or_default();
        *value = value.max(a.value.abs());
    }
    let with = |row: Row| {
        let least = ITERATIONS * values[&row.quantity];
        let uncertainty = (2.0 * largest[&group(&row)]).max(least);
        let routes = Mesh::routes();
        Row { uncertainty, class: Class::B, routes, ..row }
    };
    // A member that is held does not move.
    let moves = |row: &Row| values[&row.quantity] > 0.0;
    fine.into_iter().filter(moves).map(with).collect()
}

fn one_mesh(id: &str, scene: &Scene, case: &LoadCase, mesh: &Mesh) -> Found<Vec<Row>> {
    let scene = mesh.given_to(scene);
    let bodies = BodiesCache::default().of(&scene)?;
    let set = StaticSet::new(&scene, &bodies, case.sense(), Imperfections::default())?;
    let cycle = set.cycle(case.sun_load_nm(), POSITIONS, &ActiveSet)?;
    let sun = bodies.geometry.sun.as_ref().ok_or("no sun")?;
    let mut rows = Rows { id, scene: &scene, torque_nm: case.sun_torque_nm, rows: Vec::new() };
    for state in &cycle.states {
        rows.state(state);
    }
    rows.whole(&cycle, &bodies.geometry, sun.base_radius);
    Ok(rows.rows)
}

struct Rows<'s> {
    id: &'s str,
    scene: &'s Scene,
    torque_nm: f64,
    rows: Vec<Row>,
}

impl Rows<'_> {
    fn add(&mut self, quantity: &str, subject: &str, coordinate: &str, value: f64) -> &mut Row {
        let row = Row::new(self.id, "fe_contact", quantity, subject, value);
        let source = self.scene.source.clone().unwrap_or_default();
        self.rows.push(Row {
            coordinate: coordinate.to_owned(),
            sun_torque_nm: Some(self.torque_nm),
            source,
            ..row
        });
        let last = self.rows.len() - 1;
        &mut self.rows[last]
    }

    fn state(&mut self, state: &SetState) {
        let sun = state.central[Body::Sun.index()];
        let position = Some(state.position);
        for (quantity, coordinate, value) in [
            ("displacement", "x", sun[0]),
            ("displacement", "y", sun[1]),
            ("rotation", "rotation", sun[2]),
        ] {
            self.add(quantity, "sun", coordinate, value).position = position;
        }
        for mesh in &state.meshes {
            let name = format!("{}_{}", mesh_name(mesh.kind), mesh.planet);
            self.add("mesh_force", &name, "force", mesh.force).position = position;
            if mesh.planet == 0 {
                self.add("mesh_stiffness", &name, "", mesh.secant_stiffness()).position = position;
            }
        }
    }

    /// What is said of the whole cycle.
    fn whole(&mut self, cycle: &SetCycle, geometry: &Geometry, sun_base_radius: f64) {
        let contact_ratio = |kind| geometry.mesh(kind).map_or(0.0, |mesh| mesh.contact_ratio);
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            let meshes = cycle.states.iter().flat_map(|state| &state.meshes);
            let of_kind = meshes.filter(|mesh| mesh.kind == kind);
            // At the ends of the path a tip's corner presses: its pressure grows with every finer mesh.
            let on_path = |mesh: &MeshState, pair: &ToothPairLoad| {
                let place = mesh.phase + pair.index as f64;
                (MARGIN..=contact_ratio(kind) - MARGIN).contains(&place)
            };
            let pressures = of_kind.flat_map(|mesh| {
                let pairs = mesh.pairs.iter().filter(|pair| on_path(mesh, pair));
                pairs.map(|pair| pair.peak_pressure)
            });
            let peak = pressures.fold(0.0, f64::max);
            self.add("peak_pressure", mesh_name(kind), "", peak);
            self.add("mesh_stiffness", mesh_name(kind), "", cycle.mean_secant_stiffness(kind));
        }
        let count = self.scene.planets.count();
        for n in 0..count {
            let share = |state: &SetState| {
                let forces = state.meshes.iter().filter(|mesh| mesh.kind == MeshKind::SunPlanet);
                let (mut sum, mut mine) = (0.0, 0.0);
                for mesh in forces {
                    sum += mesh.force;
                    mine += if mesh.planet == n { mesh.force } else { 0.0 };
                }
                mine * count as f64 / sum
            };
            let largest = cycle.states.iter().map(share).fold(0.0, f64::max);
            self.add("load_share", &format!("planet_{n}"), "", largest);
        }
        // Amplitudes 2|Σ e^{−2πi l k/n} x_k|/n of the harmonics l, and the mean.
        let errors: Vec<f64> =
            cycle.states.iter().map(|state| state.transmission_error(sun_base_radius)).collect();
        for harmonic in 0..=HARMONICS {
            let part = |of: fn(f64) -> f64| {
                let angle = |state: &SetState| TAU * harmonic as f64 * state.position;
                let terms = cycle.states.iter().zip(&errors).map(|(state, x)| x * of(angle(state)));
                terms.sum::<f64>() / errors.len() as f64
            };
            let (cosine, sine) = (part(f64::cos), part(f64::sin));
            let value = if harmonic == 0 { cosine } else { 2.0 * cosine.hypot(sine) };
            self.add("transmission_error", "sun", "", value).harmonic = Some(harmonic as u32);
        }
    }
}

fn mesh_name(kind: MeshKind) -> &'static str {
    match kind {
        MeshKind::SunPlanet => "sun_mesh",
        MeshKind::RingPlanet => "ring_mesh",
    }
}
