//! Class B: steady states of the FE/contact model over speed, on two meshes of elements with unlike steps in a mesh
//! cycle; at the speeds of `kept/full_sweep.toml` also with every degree of freedom.
//!
//! The table holds what planet phasing forbids too: these harmonics are zero within their uncertainty.

use experiments::BodiesCache;
use experiments::sweep::{
    Coordinate, Direction, FeModel, Memory, Part, Plan, Response, SteadySettings, SteadyState,
    SweepPoint, run,
};
use fe_contact::statics::Imperfections;
use gearset::Body;
use scene::{LoadCase, Scene};
use validation::certified::{Class, Row};
use validation::{FullSweepPoint, Reference};

use super::meshes::{Found, MESHES, Mesh};
use super::scene_named;

/// Scenes of the sweeps; their torque on the sun, N m; first and last speed, rpm, and ratio of neighbours less 1: what
/// the suite `sweep` asks a model for.
const SWEPT: [&str; 2] = ["oh58_3p", "oh58_4p"];
const TORQUE_NM: f64 = 1130.0;
const SPEEDS_RPM: [f64; 2] = [450.0, 2500.0];
const STEP: f64 = 0.02;

/// Scene of `kept/full_sweep.toml`.
const FULL: &str = "oh58_4p";

/// What is in the table.
const SERIES: [(Part, Coordinate); 5] = [
    (Part::SUN, Coordinate::Rotation),
    (Part::SUN, Coordinate::Translation),
    (Part::Body(Body::Planet(0)), Coordinate::Rotation),
    (Part::SunMesh(0), Coordinate::Force),
    (Part::RingMesh(0), Coordinate::Force),
];

/// Harmonics of the mesh frequency.
const HARMONICS: usize = 5;

/// Least uncertainty in parts of the largest amplitude of a quantity at any speed: ten times the change from cycle to
/// cycle at which a steady state ends.
const CYCLES: f64 = 1e-8;

/// Amplitudes, and sizes of the largest Floquet multipliers.
pub(super) fn rows() -> Found<Vec<Row>> {
    let mut rows = Vec::new();
    for id in SWEPT {
        let scene = scene_named(id)?;
        let count = ((SPEEDS_RPM[1] / SPEEDS_RPM[0]).ln() / STEP.ln_1p()).floor() as i32;
        let speeds: Vec<f64> =
            (0..=count).map(|k| six_digits(SPEEDS_RPM[0] * (1.0 + STEP).powi(k))).collect();
        rows.extend(compared(id, &scene, TORQUE_NM, &speeds, &[])?);
        eprintln!("steady states of {id}");
    }
    let kept = Reference::load()?.full_sweep;
    let speeds: Vec<f64> = kept.point.iter().map(|point| point.speed_rpm).collect();
    let others: Vec<&FullSweepPoint> = kept.point.iter().chain(&kept.quasi_static).collect();
    rows.extend(compared(FULL, &scene_named(FULL)?, kept.torque_nm, &speeds, &others)?);
    Ok(rows)
}

/// The number that six significant digits write: a speed in a table is the speed of the computation.
fn six_digits(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// Steady states at some speeds, rpm, by ascending speed.
pub(super) fn swept(
    scene: &Scene,
    mesh: &Mesh,
    torque_nm: f64,
    speeds_rpm: &[f64],
) -> Found<Vec<SweepPoint>> {
    let scene = mesh.given_to(scene);
    let bodies = BodiesCache::default().of(&scene)?;
    let case = LoadCase::of_scene(&scene)?.with_sun_torque(torque_nm);
    let model = FeModel::new(&scene, &bodies, Imperfections::default(), case);
    // Over whole cycles: what planet phasing forbids is a result, not a premise.
    let settings =
        SteadySettings { whole_cycles: true, between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan::new(speeds_rpm, &[Direction::Up], settings)?;
    let found = run(&model, &plan, &Memory, &|_| ())?.complete()?.steady()?;
    Ok(found.points().into_iter().cloned().collect())
}

/// Amplitude of a harmonic.
fn amplitude(state: &SteadyState, part: Part, coordinate: Coordinate, harmonic: usize) -> f64 {
    match coordinate {
        Coordinate::Translation => Response::Translation(part).amplitude(state, harmonic),
        _ => state.amplitude(part, coordinate, harmonic),
    }
}

/// The same of a kept point.
fn kept_amplitude(point: &FullSweepPoint, part: Part, coordinate: Coordinate, l: usize) -> f64 {
    let list = match (part, coordinate) {
        (Part::SUN, Coordinate::Rotation) => point.sun_rotation_rad,
        (Part::SUN, _) => point.sun_translation_m,
        (Part::SunMesh(_), _) => point.sun_mesh_0_force_n,
        (Part::RingMesh(_), _) => point.ring_mesh_0_force_n,
        _ => point.planet_0_rotation_rad,
    };
    list[l - 1]
}

/// Rows of the finer mesh. Their uncertainty is twice the largest difference from it that the coarser mesh has at this
/// speed or its neighbours, or a kept point of `others` at this speed.
fn compared(
    id: &str,
    scene: &Scene,
    torque_nm: f64,
    speeds_rpm: &[f64],
    others: &[&FullSweepPoint],
) -> Found<Vec<Row>> {
    let [fine, coarse] = MESHES.map(|mesh| swept(scene, &mesh, torque_nm, speeds_rpm));
    let (fine, coarse) = (fine?, coarse?);
    if fine.iter().zip(&coarse).any(|(a, b)| a.steps_per_cycle == b.steps_per_cycle) {
        return Err(format!("{id}: the same steps in a cycle on both meshes").into());
    }
    let mut routes = Mesh::routes_in_time(scene);
    if !others.is_empty() {
        routes.push_str("; epicyclic: every degree of freedom");
    }
    let row = |quantity: &str, subject: &str, speed_rpm: f64, value: f64| Row {
        sun_torque_nm: Some(torque_nm),
        speed_rpm: Some(speed_rpm),
        class: Class::B,
        routes: routes.clone(),
        source: scene.source.clone().unwrap_or_default(),
        ..Row::new(id, "fe_contact", quantity, subject, value)
    };
    // Neighbours count only in a sweep.
    let reach = usize::from(others.is_empty());
    let about = |k: usize, off: &[f64]| {
        let end = (k + reach + 1).min(off.len());
        off[k.saturating_sub(reach)..end].iter().copied().fold(0.0, f64::max)
    };
    let geometry = scene.tooth_geometry()?;
    let radius_m = geometry.sun.as_ref().map_or(0.0, |sun| sun.base_radius);
    let mut rows = Vec::new();
    for (part, coordinate) in SERIES {
        let of = |point: &SweepPoint, l: usize| amplitude(&point.state, part, coordinate, l);
        let all = fine.iter().flat_map(|point| (1..=HARMONICS).map(move |l| of(point, l)));
        let mut largest = all.fold(0.0, f64::max);
        if coordinate == Coordinate::Translation {
            // All of it may be forbidden: then it is small beside the rotation on the base circle.
            let turned = fine.iter().map(|point| {
                let state = &point.state;
                (1..=HARMONICS)
                    .map(|l| state.amplitude(part, Coordinate::Rotation, l))
                    .fold(0.0, f64::max)
            });
            largest = largest.max(radius_m * turned.fold(0.0, f64::max));
        }
        let least = CYCLES * largest;
        for l in 1..=HARMONICS {
            let off: Vec<f64> =
                fine.iter().zip(&coarse).map(|(a, b)| (of(a, l) - of(b, l)).abs()).collect();
            for (k, point) in fine.iter().enumerate() {
                let (speed_rpm, value) = (point.state.case.speed_rpm, of(point, l));
                let kept = others.iter().filter(|other| other.speed_rpm == speed_rpm);
                let kept = kept.map(|other| kept_amplitude(other, part, coordinate, l) - value);
                let largest = kept.map(f64::abs).fold(about(k, &off), f64::max);
                rows.push(Row {
                    coordinate: coordinate.name().to_owned(),
                    harmonic: Some(l as u32),
                    unit: coordinate.unit().to_owned(),
                    uncertainty: (2.0 * largest).max(least),
                    ..row("amplitude", &part.name(), speed_rpm, value)
                });
            }
        }
    }
    if others.is_empty() {
        let size = |point: &SweepPoint| point.largest_multiplier().ok_or("no multiplier");
        let sizes = |points: &[SweepPoint]| points.iter().map(size).collect::<Result<Vec<_>, _>>();
        let (sizes, coarser) = (sizes(&fine)?, sizes(&coarse)?);
        let off: Vec<f64> = sizes.iter().zip(&coarser).map(|(a, b)| (a - b).abs()).collect();
        for (k, (point, size)) in fine.iter().zip(&sizes).enumerate() {
            let uncertainty = (2.0 * about(k, &off)).max(CYCLES);
            let row = row("multiplier", "", point.state.case.speed_rpm, *size);
            rows.push(Row { uncertainty, ..row });
        }
    }
    Ok(rows)
}
