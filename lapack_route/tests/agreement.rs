//! LAPACK against the project's own route (nalgebra) on lumped models, and against published frequencies.
//!
//! Reference kind: other code for the comparison, published for Lin & Parker (1999).

mod common;

use std::f64::consts::TAU;

use common::{Random, project_file, scene};
use lapack_route::{Driver, lapack_generalized};
use lumped::{LumpedModel, NaturalModes};
use nalgebra::DMatrix;
use scene::Scene;

/// Allowed |Δω²|/ω²_max. Backward stable solvers differ by a few n·ε (1e-14 at 45 coordinates);
/// a difference of more than a hundred times that is an error.
const TOLERANCE: f64 = 1e-12;

/// K and M for LAPACK.
fn matrices(model: &LumpedModel) -> (DMatrix<f64>, DMatrix<f64>) {
    (model.stiffness(), DMatrix::from_diagonal(&model.mass.clone().into()))
}

/// max |Δω²|/ω²_max between two ascending lists; infinite if they differ in length.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    if a.len() != b.len() {
        return f64::INFINITY;
    }
    let largest = b.last().copied().unwrap_or(0.0);
    a.iter().zip(b).map(|(x, y)| (x - y).abs() / largest).fold(0.0, f64::max)
}

/// Worst difference between our own route and each LAPACK driver for one scene.
fn compare(scene: &Scene) -> [f64; 2] {
    let model = LumpedModel::from_scene(scene).unwrap();
    let ours = NaturalModes::of(&model).unwrap().lambda;
    let (k, m) = matrices(&model);
    Driver::ALL.map(|driver| difference(&ours, &lapack_generalized(&k, &m, driver).unwrap()))
}

/// Natural frequencies of a scene by a LAPACK driver, ascending, Hz.
fn frequencies_hz(scene: &Scene, driver: Driver) -> Vec<f64> {
    let (k, m) = matrices(&LumpedModel::from_scene(scene).unwrap());
    let lambda = lapack_generalized(&k, &m, driver).unwrap();
    // f = √λ / 2π; rigid-body modes may come out just below zero.
    lambda.iter().map(|l| l.max(0.0).sqrt() / TAU).collect()
}

fn data(path: &str) -> toml::Table {
    std::fs::read_to_string(project_file(path)).unwrap().parse().unwrap()
}

fn list(table: &toml::Value, key: &str) -> Vec<f64> {
    let entries = table[key].as_array().unwrap();
    let number = |v: &toml::Value| v.as_float().or(v.as_integer().map(|i| i as f64));
    entries.iter().map(|v| number(v).unwrap()).collect()
}

/// The absolute tolerance that `checks/registry.toml` gives to checks of this name.
fn tolerance_hz(checks: &str) -> f64 {
    let table = data("checks/registry.toml");
    let suites = table["suite"].as_array().unwrap().iter();
    let mut all = suites.flat_map(|s| s["check"].as_array().unwrap());
    let found = all.find(|t| t["ids"].as_str() == Some(checks)).unwrap();
    found["absolute"].as_float().unwrap()
}

/// Printed values of one kind; for listed misses (`checks/misses.toml`) the project's own value instead.
fn printed_or_missed(table: &toml::Value, set: &str, kind: &str) -> Vec<f64> {
    let misses = data("checks/misses.toml");
    let misses = misses["miss"].as_array().unwrap();
    let value = |(i, printed): (usize, f64)| {
        let id = format!("lin_parker_1999.{set}.{kind}.{}", i + 1);
        let miss = misses.iter().find(|m| m["id"].as_str() == Some(&id));
        miss.map_or(printed, |m| m["value"].as_float().unwrap())
    };
    list(table, &format!("{kind}_hz")).into_iter().enumerate().map(value).collect()
}

/// Every value repeated by its multiplicity, ascending.
fn with_multiplicity(values: impl IntoIterator<Item = (f64, usize)>) -> Vec<f64> {
    let repeated = values.into_iter().flat_map(|(f, times)| std::iter::repeat_n(f, times));
    let mut all: Vec<f64> = repeated.collect();
    all.sort_by(f64::total_cmp);
    all
}

#[track_caller]
fn assert_printed(scene: &Scene, printed: &[f64], tolerance_hz: f64) {
    for driver in Driver::ALL {
        let found = frequencies_hz(scene, driver);
        assert_eq!(found.len(), printed.len());
        for (f, p) in found.iter().zip(printed) {
            assert!((f - p).abs() <= tolerance_hz, "{driver:?}: {f} Hz, printed {p} Hz");
        }
    }
}

#[test]
fn lin_and_parker_1999_as_printed() {
    let printed = data("reference/lin_parker_1999.toml");
    let tolerance = tolerance_hz("lin_parker_1999.*");
    for (set, name, planets) in
        [("three_planets", "lin_parker_1999_3p", 3), ("four_planets", "lin_parker_1999_4p", 4)]
    {
        let table = &printed[set];
        let of = |kind, times: usize| {
            printed_or_missed(table, set, kind).into_iter().map(move |f| (f, times))
        };
        let (once, twice) = (of("rotational", 1), of("translational", 2));
        let planet = if planets > 3 { of("planet", planets - 3).collect() } else { Vec::new() };
        let all = with_multiplicity(once.chain(twice).chain(planet));
        assert_printed(&scene(name), &all, tolerance);
    }
}

#[test]
fn published_sets_agree_with_ours() {
    let names = [
        "lin_parker_1999_3p",
        "lin_parker_1999_4p",
        "oh58_3p",
        "oh58_4p",
        "oh58_3p_as_published",
        "oh58_4p_as_published",
    ];
    for name in names {
        let worst = compare(&scene(name));
        println!("{name}: |Δω²|/ω²_max = {:.1e} (dsygv), {:.1e} (dsyev)", worst[0], worst[1]);
        assert!(worst.iter().all(|&w| w <= TOLERANCE), "{name}: {worst:?}");
    }
}

#[test]
fn a_thousand_random_sets_agree_with_ours() {
    let base = scene("lin_parker_1999_4p");
    let mut random = Random::new(1999);
    let mut worst = [0.0_f64; 2];
    let mut planets = [0; 13];
    for number in 0..1000 {
        let scene = random.scene(&base);
        planets[scene.planets.count()] += 1;
        let found = compare(&scene);
        assert!(found.iter().all(|&w| w <= TOLERANCE), "set {number}: {found:?}\n{scene:?}");
        worst = [worst[0].max(found[0]), worst[1].max(found[1])];
    }
    println!("1000 random sets, 1 to 12 planets: {:?} of each", &planets[1..]);
    println!("worst |Δω²|/ω²_max = {:.1e} (dsygv), {:.1e} (dsyev)", worst[0], worst[1]);
    assert!(planets[1..].iter().all(|&n| n > 40), "{planets:?}");
}

#[test]
fn one_spring_a_billionth_off_is_noticed() {
    // Negative control: the tolerance would see a relative error of 1e-9 in any single mesh.
    for name in ["oh58_4p", "lin_parker_1999_3p"] {
        let model = LumpedModel::from_scene(&scene(name)).unwrap();
        let ours = NaturalModes::of(&model).unwrap().lambda;
        for (number, spring) in model.springs.iter().enumerate() {
            let mut altered = model.clone();
            altered.springs[number].stiffness *= 1.0 + 1e-9;
            let (k, m) = matrices(&altered);
            for driver in Driver::ALL {
                let found = difference(&ours, &lapack_generalized(&k, &m, driver).unwrap());
                assert!(found > TOLERANCE, "{name} {:?} {driver:?}: {found:e}", spring.id);
            }
        }
    }
}
