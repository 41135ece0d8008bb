//! Class B: natural frequencies of the FE/contact model under the torque of its scene, at position 0 of the mesh cycle.
//!
//! Linearised on two meshes of elements, and by impulse tests on the coarser one. The uncertainty is twice the largest
//! relative difference that any frequency of the set has: an accidental agreement is no certainty.

use std::collections::HashMap;

use experiments::models::{FeContact, ModalRoute};
use experiments::{DistinctMode, ModalModel, distinct};
use lumped::ModeType;
use scene::LoadCase;
use validation::certified::{Class, Row};

use super::meshes::{Found, MESHES, Mesh};
use super::scene_named;

const SETS: [&str; 2] = ["oh58_3p", "oh58_4p"];

/// Modes below this are rigid-body motion, Hz.
const RIGID_HZ: f64 = 1.0;

/// Two routes that differ by more than this, in parts, have found different modes.
const SAME: f64 = 0.02;

pub(super) fn rows() -> Found<Vec<Row>> {
    let mut rows = Vec::new();
    for id in SETS {
        let scene = scene_named(id)?;
        let case = LoadCase::of_scene(&scene)?;
        let by = |route: ModalRoute, mesh: &Mesh| -> Found<Vec<DistinctMode>> {
            let model = FeContact::default().by(route);
            Ok(distinct(&model.natural_modes(&mesh.given_to(&scene), &case)?))
        };
        let [fine, coarse] = MESHES.map(|mesh| by(ModalRoute::Linearised, &mesh));
        let (fine, coarse) = (numbered(&fine?), numbered(&coarse?));
        let impulses = numbered(&by(ModalRoute::ImpulseTest, &MESHES[1])?);
        let mut found = Vec::new();
        let mut largest = 0.0f64;
        for ((mode_type, number), hz) in &fine {
            // Tests see a band of frequencies, so that a mode is found by its place.
            let nearest = |modes: &[(Mode, f64)]| {
                let of_type = modes.iter().filter(|((other, _), _)| other == mode_type);
                let off = of_type.map(|(_, other)| (other / hz - 1.0).abs());
                off.fold(f64::INFINITY, f64::min)
            };
            let off = nearest(&coarse).max(nearest(&impulses));
            if off < SAME {
                largest = largest.max(off);
                found.push((mode_type.name(), *number, *hz));
            }
        }
        for (mode_type, number, hz) in found {
            rows.push(Row {
                number: Some(number),
                uncertainty: 2.0 * largest * hz,
                class: Class::B,
                routes: format!("{}; epicyclic: impulse tests", Mesh::routes()),
                source: scene.source.clone().unwrap_or_default(),
                ..Row::new(id, "fe_contact", "frequency", mode_type, hz)
            });
        }
        eprintln!("modes of {id}");
    }
    Ok(rows)
}

/// Type of a mode and its number within the type, from 1.
type Mode = (ModeType, u32);

/// Frequencies above zero with their numbers, which count rigid-body motion too.
fn numbered(modes: &[DistinctMode]) -> Vec<(Mode, f64)> {
    let mut numbers: HashMap<&str, u32> = HashMap::new();
    let mut named = Vec::new();
    for DistinctMode { frequency_hz, mode_type, .. } in modes {
        let number = numbers.entry(mode_type.name()).or_default();
        *number += 1;
        if *frequency_hz > RIGID_HZ {
            named.push(((*mode_type, *number), *frequency_hz));
        }
    }
    named
}
