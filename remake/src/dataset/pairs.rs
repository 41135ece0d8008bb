//! Class A: one mesh at a prescribed approach, by this program and by CalculiX.

use std::collections::HashMap;

use experiments::BodiesCache;
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::at_approach;
use gearset::MeshKind;
use scene::Scene;
use validation::Reference;
use validation::certified::{Class, Row};

use super::meshes::Found;

/// Both routes. The uncertainty of a row is twice the largest relative difference that its quantity has in any case: an
/// accidental agreement is no certainty.
pub(super) fn rows() -> Found<Vec<Row>> {
    let reference = Reference::load()?;
    let cache = BodiesCache::default();
    let mut rows: Vec<Row> = Vec::new();
    for case in &reference.calculix.case {
        let id = case.scene.trim_start_matches("scenes/").trim_end_matches(".toml");
        let text = epicyclic_data::text(&format!("scenes/{id}.toml")).ok_or("no such scene")?;
        let scene = Scene::from_toml(text)?;
        let (kind, mesh) = match scene.pair {
            Some(MeshKind::RingPlanet) => (MeshKind::RingPlanet, "ring_mesh"),
            _ => (MeshKind::SunPlanet, "sun_mesh"),
        };
        let bodies = cache.of(&scene)?;
        let found = at_approach(&bodies, kind, case.phase, 1e-6 * case.approach_um, &ActiveSet)?;
        let mut add = |quantity: &str, coordinate: &str, value: f64, ours: f64| {
            let row = Row::new(id, "fe_contact", quantity, mesh, value);
            rows.push(Row {
                coordinate: coordinate.to_owned(),
                position: Some(case.phase),
                approach_um: Some(case.approach_um),
                // Of one row; the largest of all follows.
                uncertainty: (ours / value - 1.0).abs(),
                class: Class::A,
                routes: "CalculiX 2.20; epicyclic".to_owned(),
                source: scene.source.clone().unwrap_or_default(),
                ..row
            });
        };
        add("mesh_force", "force", case.force_n, found.force);
        for pair in &case.pair {
            // Contacts of a corner have no peak pressure.
            let Some(expected) = pair.peak_pressure_mpa else { continue };
            let ours = found.pairs.iter().find(|own| own.index == pair.index);
            let Some(ours) = ours.and_then(|own| own.peak_pressure) else { continue };
            add("peak_pressure", &format!("pair_{}", pair.index), 1e6 * expected, ours);
        }
    }
    let mut largest = HashMap::<String, f64>::new();
    for row in &rows {
        let most = largest.entry(row.quantity.clone()).or_default();
        *most = most.max(row.uncertainty);
    }
    for row in &mut rows {
        row.uncertainty = 2.0 * largest[&row.quantity] * row.value;
    }
    Ok(rows)
}
