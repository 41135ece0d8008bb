//! The data set of certified values against what computes it.

use std::collections::HashSet;

use experiments::StaticModel;
use experiments::models::FeContact;
use scene::LoadCase;
use validation::certified::{
    CertifiedValues, Class, Row, TABLES, closed_forms, correct_digits, scores,
};
use validation::results::KnownScenes;
use validation::{PublishedScene, scene};

#[test]
fn closed_forms_of_every_scene_are_within_their_uncertainty() {
    let values = CertifiedValues::shipped();
    let mut compared = 0;
    for known in KnownScenes::shipped().iter() {
        if epicyclic_data::text(&format!("scenes/{}.toml", known.id)).is_none() {
            continue;
        }
        for row in closed_forms(&known.id, &known.scene).unwrap() {
            // Entries of matrices that are zero are not in the tables.
            let Some(kept) = values.row(&row.name()) else {
                assert_eq!(row.kind, "lumped", "{}", row.name());
                assert!(row.value.abs() < 1e-12 * values.largest(&row), "{}", row.name());
                continue;
            };
            let off = (row.value - kept.value).abs();
            assert!(off <= kept.uncertainty, "{}: {} and {}", row.name(), row.value, kept.value);
            assert_eq!(kept.class, Class::A);
            compared += 1;
        }
    }
    assert!(compared > 2000, "{compared}");
}

/// On the coarser of the two meshes of elements that the table is made of.
#[test]
fn a_mesh_cycle_of_four_planets_is_within_its_uncertainty() {
    let mut set = scene(PublishedScene::Oh58FourPlanets).unwrap();
    set.fe_contact.flank_elements = 20;
    let case = LoadCase::of_scene(&set).unwrap().with_sun_torque(1413.0);
    let cycle = FeContact::default().mesh_cycle(&set, &case, 28).unwrap();
    let values = CertifiedValues::shipped();
    let mut compared = 0;
    for state in &cycle.states {
        let named = |quantity: &str, subject: &str, coordinate: &str, value: f64| {
            let row = Row::new("oh58_4p", "fe_contact", quantity, subject, value);
            Row {
                coordinate: coordinate.to_owned(),
                sun_torque_nm: Some(1413.0),
                position: Some(state.position),
                ..row
            }
        };
        let mut rows = vec![named("rotation", "sun", "rotation", state.sun[2])];
        for (mesh, forces) in [("sun_mesh", &state.sun_mesh_n), ("ring_mesh", &state.ring_mesh_n)] {
            let of_mesh = forces.iter().enumerate();
            rows.extend(
                of_mesh
                    .map(|(n, force)| named("mesh_force", &format!("{mesh}_{n}"), "force", *force)),
            );
        }
        for row in rows {
            let kept = values.row(&row.name()).unwrap_or_else(|| panic!("no {}", row.name()));
            let off = (row.value - kept.value).abs();
            assert!(off <= kept.uncertainty, "{}: {} and {}", row.name(), row.value, kept.value);
            assert!(kept.uncertainty < 0.05 * values.largest(kept), "{}", row.name());
            compared += 1;
        }
    }
    assert_eq!(compared, 28 * 9);
}

#[test]
fn every_row_has_its_routes_and_an_id_of_its_own() {
    let values = CertifiedValues::shipped();
    let mut ids = HashSet::new();
    for (name, rows) in &values.tables {
        assert!(!rows.is_empty(), "{name}");
        for row in rows {
            assert_eq!(row.id, row.name());
            assert!(ids.insert(&row.id), "{} twice", row.id);
            assert!(row.uncertainty >= 0.0 && row.value.is_finite(), "{}", row.id);
            let routes: HashSet<&str> = row.routes.split("; ").collect();
            match row.class {
                // Another code or a theorem beside the program's.
                Class::A => {
                    assert!(routes.len() >= 2, "{}: {}", row.id, row.routes);
                    let others = routes.iter().filter(|route| !route.starts_with("epicyclic"));
                    assert!(others.count() >= 1, "{}: {}", row.id, row.routes);
                }
                Class::B => assert!(
                    routes.len() >= 2 && row.uncertainty > 0.0,
                    "{}: {}",
                    row.id,
                    row.routes
                ),
                Class::C => assert!(!row.routes.is_empty(), "{}", row.id),
            }
        }
    }
    assert_eq!(values.tables.len(), TABLES.len());
}

/// The score of a value that is shifted by twice its uncertainty, or that has lost two digits, is lower than that of
/// the value, of every row that has a relative uncertainty.
#[test]
fn scores_see_shifts_beyond_the_uncertainty() {
    let values = CertifiedValues::shipped();
    let mut seen = 0;
    for row in values.rows() {
        let largest = values.largest(row);
        let part = row.uncertainty / row.value.abs().max(1e-3 * largest);
        // Nothing can be seen above an uncertainty of a half or below the rounding of binary numbers.
        if !(1e-14..0.4).contains(&part) {
            continue;
        }
        let digits = |value: f64| correct_digits(value, row.value, row.uncertainty, largest);
        assert!(digits(row.value + 2.0 * row.uncertainty) < digits(row.value) - 0.2, "{}", row.id);
        seen += 1;
    }
    assert!(seen > 4000, "{seen}");
    let row = values.row("lumped.oh58_4p.frequency.rotational.2").unwrap();
    let rounded: f64 = format!("{:.3e}", row.value).parse().unwrap();
    let coarser: f64 = format!("{:.1e}", row.value).parse().unwrap();
    let score = |value: f64| scores([Row { value, ..row.clone() }].into_iter())[0].fewest_digits;
    assert!(score(rounded) > 3.0 && score(coarser) < score(rounded) - 1.0);
}
