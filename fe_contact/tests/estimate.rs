//! Memory that bodies need, estimated before they are made.

use fe_contact::FeError;
use fe_contact::fe_mesh::Side;
use fe_contact::statics::{Bodies, MOST_BYTES, estimate};
use scene::{ElementFamily, Fidelity, Scene};

fn scene(name: &str, flank_elements: u32) -> Scene {
    let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut scene = Scene::from_file(path.as_ref()).unwrap();
    scene.fe_contact.flank_elements = flank_elements;
    scene
}

/// Nodes, elements and unknowns of the estimate are those of the bodies.
#[test]
fn sizes_are_those_of_the_bodies() {
    for family in [ElementFamily::Quadratic, ElementFamily::Linear] {
        let mut scene = scene("oh58_3p", 8);
        scene.fe_contact.element = family;
        let bodies = Bodies::new(&scene).unwrap();
        let found = estimate(&scene).unwrap();
        let made = [bodies.ring.as_ref().unwrap(), bodies.sun.as_ref().unwrap(), &bodies.planet];
        for (own, body) in found.bodies.iter().zip(made) {
            assert_eq!(own.name, body.mesh.name);
            assert_eq!(own.nodes, body.mesh.points.len() as u64);
            assert_eq!(own.elements, body.mesh.elements.len() as u64);
            assert_eq!(own.unknowns, body.unknowns as u64);
        }
        assert_eq!(found.bodies.len(), 3);
        assert!(found.peak_bytes > found.held_bytes);
    }
    let of_pair = estimate(&scene("oh58_sun_planet_pair", 8)).unwrap();
    assert_eq!(of_pair.bodies.iter().map(|b| b.name).collect::<Vec<_>>(), ["sun", "planet"]);
}

/// The refusal names the key, the estimate and the largest allowed value, which is allowed; the next is not.
#[test]
fn what_does_not_fit_is_refused_before_it_is_made() {
    for elements in [56, 64, 500, u32::MAX] {
        let started = std::time::Instant::now();
        let refused = Bodies::new(&scene("oh58_4p", elements)).unwrap_err();
        assert!(started.elapsed().as_secs() < 60);
        let FeError::Unfit { key, value, allowed, why } = refused else { panic!("{refused}") };
        assert_eq!((key.as_str(), value), ("fe_contact.flank_elements", elements.to_string()));
        assert!(why.contains("GiB"), "{why}");
        let most: u32 = allowed.split(' ').find_map(|word| word.parse().ok()).unwrap();
        assert!(most >= 28, "the default and twice the default must fit: {allowed}");
        let bytes = |n| estimate(&scene("oh58_4p", n)).unwrap().peak_bytes;
        assert!(bytes(most) <= MOST_BYTES && bytes(most + 1) > MOST_BYTES, "{most}");
    }
}

/// At fidelities that need the matrices of whole gears these are included.
#[test]
fn whole_matrices_are_included_where_they_are_made() {
    let mut scene = scene("oh58_4p", 14);
    let quasi_static = estimate(&scene).unwrap();
    for fidelity in [Fidelity::Modal(2), Fidelity::Full] {
        scene.dynamics.fidelity = fidelity;
        let whole = estimate(&scene).unwrap();
        assert_eq!(whole.held_bytes, quasi_static.held_bytes);
        assert!(whole.peak_bytes > 2 * quasi_static.peak_bytes);
    }
}

/// Settings that give no body give the same error as an estimate.
#[test]
fn settings_without_a_body_have_no_estimate() {
    let coarse = scene("oh58_4p", 4);
    let (found, made) = (estimate(&coarse).unwrap_err(), Bodies::new(&coarse).unwrap_err());
    assert_eq!(found, made);
    assert!(found.to_string().contains("fe_contact.flank_elements"), "{found}");
    let mut boreless = scene("oh58_sun_planet_pair", 8);
    boreless.geometry.as_mut().unwrap().planet.body_radius_m = None;
    let found = estimate(&boreless).unwrap_err();
    assert!(found.to_string().contains("geometry.planet.bore_diameter_mm"), "{found}");
}

/// Largest resident memory of this process so far, bytes.
fn peak() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with("VmHWM")).unwrap();
    1024.0 * line.split_whitespace().nth(1).unwrap().parse::<f64>().unwrap()
}

/// Peak memory against its estimate. Each number of elements needs a process of its own:
/// `ELEMENTS=14 SCENE=oh58_4p cargo test --release -p fe_contact --test all estimate -- --ignored --nocapture`
#[test]
#[ignore = "measures the memory of its own process: run alone, one number of elements at a time"]
fn peak_memory_is_as_estimated() {
    let of = |name: &str| std::env::var(name).ok();
    let elements = of("ELEMENTS").and_then(|n| n.parse().ok()).unwrap_or(14);
    let scene = scene(&of("SCENE").unwrap_or("oh58_4p".into()), elements);
    let before = peak();
    let bodies = Bodies::new(&scene).unwrap();
    // All that can be asked for.
    for body in [bodies.ring.as_ref(), bodies.sun.as_ref(), Some(&bodies.planet)] {
        let Some(body) = body else { continue };
        let teeth = i64::from(body.mesh.outline.gear().teeth);
        let load = body.flank_load(Side::Ccw, 0.0, 1e-4);
        let along = ([1.0, 0.0], [0.0, 1.0]);
        for offset in -teeth / 2..=teeth / 2 {
            let of_tooth = body.response(offset).map_or(0.0, |response| response.amax());
            let between = body.surface_flexibility((&load, along.0), offset, (&load, along.1));
            assert!(of_tooth.is_finite() && between.is_finite());
        }
    }
    let (taken, found) = (peak() - before, estimate(&scene).unwrap());
    for body in &found.bodies {
        println!("{body:?}");
    }
    let share = found.peak_bytes as f64 / taken;
    println!("{elements}: {:.3} MB, estimate over it {share:.3}", taken / 1e6);
    assert!(share > 0.75 && share < 1.05, "{share}");
    drop(bodies);
}

/// A rim of a kilometre would be laid out row by row before anything counted its elements.
#[test]
fn a_rim_without_bounds_is_refused_by_its_key() {
    let mut wide = scene("oh58_4p", 8);
    wide.geometry.as_mut().unwrap().ring.as_mut().unwrap().body_radius_m = Some(1e6);
    let found = estimate(&wide).unwrap_err();
    assert!(found.to_string().contains("geometry.ring.rim_diameter_mm"), "{found}");
    assert_eq!(found, Bodies::new(&wide).unwrap_err());
}
