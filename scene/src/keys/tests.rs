//! The list of keys is held against what the reader asks for.

use std::collections::BTreeSet;

use super::*;
use crate::read::document::Document;
use crate::read::read_document;
use crate::scene::SceneKind;
use crate::templates::template;

/// Sets in which every table is given, so that the reader asks for every key.
const MAXIMAL: [&str; 3] = [
    "format = 1\nkind = \"planetary\"\n[planets]\ncount = 3\n[teeth]\n[geometry]\nrack = {}\n\
     sun = { tip_relief = {} }\nplanet = { tip_relief = {} }\nring = { tip_relief = {} }\ncarrier = {}\n\
     thickness = { profile_shift = {} }\n[material]\n[sun]\n[ring]\n[carrier]\n[planet]\n[lumped]\n\
     mass_kg = {}\ninertia_kg_m2 = {}\ninertia_over_r2_kg = {}\nradius_mm = {}\nmesh_n_per_m = {}\n\
     pressure_angle_deg = {}\n[[planet_override]]\n[damping]\n[operation]\n[fe_contact]\n\
     flexibility_factor = {}\n[dynamics]\n",
    "format = 1\nkind = \"planetary\"\n[geometry]\nthickness = {}\n",
    "format = 1\nkind = \"gear_pair\"\nmesh = \"sun_planet\"\n[geometry]\n[sun]\n[planet]\n[lumped]\n\
     mesh_n_per_m = {}\npressure_angle_deg = {}\n[operation]\n",
];

/// Every key the reader asks for in these scenes.
fn asked() -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");
    let mut texts: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| std::fs::read_to_string(entry.unwrap().path()).unwrap())
        .collect();
    texts.extend([SceneKind::Planetary, SceneKind::GearPair].map(|k| template(k).to_owned()));
    texts.extend(MAXIMAL.map(str::to_owned));
    for text in texts {
        let document = Document::new(&text);
        read_document(&document);
        all.extend(document.asked.take());
    }
    all
}

#[test]
fn the_list_holds_exactly_the_keys_the_reader_asks_for() {
    let listed: BTreeSet<String> = KEYS.iter().map(|k| k.path.clone()).collect();
    assert_eq!(listed.len(), KEYS.len(), "a key is listed twice");
    assert_eq!(asked(), listed);
}

#[test]
fn defaults_of_the_list_are_those_of_the_reader() {
    for key in KEYS.iter().filter(|key| key.path != "title") {
        let Some(value) = key.default_as_written() else { continue };
        // The template with the default written out is the scene without the key.
        let text = template(SceneKind::Planetary);
        let bare: String = text
            .lines()
            .filter(|line| !line.starts_with('#'))
            .map(|line| format!("{line}\n"))
            .collect();
        let mut table: toml::Table = bare.parse().unwrap();
        for (name, kind) in [("carrier", "free"), ("ring", "free"), ("sun", "free")] {
            let mut support = toml::Table::new();
            support.insert("motion".into(), kind.into());
            table.insert(name.into(), support.into());
        }
        let lumped = "mesh_n_per_m = { sun_planet = 1e8, ring_planet = 1e8 }\n\
            mass_kg = { sun = 1, planet = 1, carrier = 1, ring = 1 }\n\
            inertia_kg_m2 = { sun = 1, planet = 1, carrier = 1, ring = 1 }\n";
        table.insert("lumped".into(), lumped.parse::<toml::Table>().unwrap().into());
        let of_shifts =
            ["geometry.thickness.profile_shift", "geometry.thickness.thinning_mm", "geometry.rack"];
        if of_shifts.iter().any(|table| key.path.starts_with(table)) {
            let geometry = table["geometry"].as_table_mut().unwrap();
            geometry.remove("planet_base_diameter_mm");
            let rack = "module_mm = 2.8222\npressure_angle_deg = 22.5".parse::<toml::Table>();
            geometry.insert("rack".into(), rack.unwrap().into());
            let shift = "profile_shift = { sun = 0, planet = 0, ring = 0 }".parse::<toml::Table>();
            geometry.insert("thickness".into(), shift.unwrap().into());
        }
        if key.path.contains("tip_relief") {
            let gear = key.path.split('.').nth(1).unwrap();
            let start = if gear == "ring" {
                275.0
            } else if gear == "sun" {
                82.0
            } else {
                103.0
            };
            let relief = format!("start_diameter_mm = {start}\namount_um = 10");
            let relief = relief.parse::<toml::Table>().unwrap();
            table["geometry"][gear]
                .as_table_mut()
                .unwrap()
                .insert("tip_relief".into(), relief.into());
        }
        let with = |value: Option<&str>| {
            let mut table = table.clone();
            let (parents, name) = key.path.rsplit_once('.').unwrap();
            let mut at = &mut table;
            for step in parents.split('.') {
                at = at
                    .entry(step)
                    .or_insert_with(|| toml::Table::new().into())
                    .as_table_mut()
                    .unwrap();
            }
            at.remove(name);
            if let Some(value) = value {
                at.extend(format!("{name} = {value}").parse::<toml::Table>().unwrap());
            }
            let text = toml::to_string(&table).unwrap();
            crate::Scene::from_toml(&text).map(|scene| format!("{scene:?}"))
        };
        let (given, absent) = (with(Some(&value)), with(None));
        match (given, absent) {
            (Ok(given), Ok(absent)) => assert_eq!(given, absent, "{}", key.path),
            (given, absent) => panic!("{}: {given:?} {absent:?}", key.path),
        }
    }
}

#[test]
fn keys_that_must_be_there_are_those_the_reader_misses() {
    for key in KEYS.iter().filter(|k| k.presence == Presence::Required && !k.is_table()) {
        let faults = MAXIMAL.map(|text| {
            let text = if key.path == "format" || key.path == "kind" {
                let line = text.lines().find(|l| l.starts_with(&key.path)).unwrap();
                text.replace(line, "")
            } else {
                text.replace("count = 3\n", "")
            };
            let error = crate::Scene::from_toml(&text).unwrap_err();
            error.faults().iter().map(|f| f.key.replace(".0.", ".")).collect::<Vec<_>>()
        });
        assert!(faults.concat().contains(&key.path), "{}: {faults:?}", key.path);
    }
}
