//! Frequencies of sets whose stiffnesses and masses spread over twelve decades, against 60-digit arithmetic.

use std::path::Path;

use lumped::{LumpedModel, NaturalModes};
use scene::Scene;

/// Digits of the kept frequencies.
const KEPT: f64 = 1e-14;

/// Digits below which a frequency would be worth a warning, as a part of it.
const SOUND: f64 = 1e-6;

fn scene(names: &csv::StringRecord, row: &csv::StringRecord) -> Scene {
    let of = |name: &str| row.get(names.iter().position(|n| n == name).unwrap()).unwrap();
    let support = |body: &str| {
        let torsion = of(&format!("{body}_torsion"));
        let bearing = of(&format!("{body}_bearing"));
        format!("[{body}]\nbearing_n_per_m = {bearing}\ntorsional_n_per_m = {torsion}\n")
    };
    let each = |what: &str| {
        let one = |body: &str| format!("{body} = {}", of(&format!("{body}_{what}")));
        ["sun", "ring", "carrier", "planet"].map(one).join(", ")
    };
    let positions: Vec<&str> = of("positions").split(' ').collect();
    let text = format!(
        "format = 1\nkind = \"planetary\"\ntitle = \"spread\"\n\
         [planets]\ncount = {}\npositions_deg = [{}]\n{}{}{}\
         [planet]\nbearing_n_per_m = {}\n[lumped]\nmass_kg = {{ {} }}\n\
         inertia_over_r2_kg = {{ {} }}\n\
         mesh_n_per_m = {{ sun_planet = {}, ring_planet = {} }}\n\
         pressure_angle_deg = {{ sun_planet = {}, ring_planet = {} }}\n",
        positions.len(),
        positions.join(", "),
        support("sun"),
        support("ring"),
        support("carrier"),
        of("planet_bearing"),
        each("mass"),
        each("inertia"),
        of("sun_mesh"),
        of("ring_mesh"),
        of("sun_angle"),
        of("ring_angle"),
    );
    Scene::from_toml(&text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn every_frequency_is_as_sure_as_it_says() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../kept/spread_frequencies.csv");
    let mut table = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(path).unwrap();
    let names = table.headers().unwrap().clone();
    let (mut scenes, mut frequencies, mut unsure, mut worst) = (0, 0, 0, 0.0f64);
    for row in table.records() {
        let row = row.unwrap();
        let known: Vec<f64> =
            row.iter().next_back().unwrap().split(' ').map(|f| f.parse().unwrap()).collect();
        let model = LumpedModel::from_scene(&scene(&names, &row)).unwrap();
        let found = NaturalModes::of(&model).unwrap();
        let mut list: Vec<(f64, f64)> = Vec::new();
        for group in &found.groups {
            list.extend(std::iter::repeat_n(
                (group.frequency_hz, group.uncertainty),
                group.multiplicity,
            ));
        }
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert_eq!(list.len(), known.len());
        scenes += 1;
        for ((found, uncertainty), known) in list.into_iter().zip(known) {
            frequencies += 1;
            if known == 0.0 {
                assert_eq!(found, 0.0, "scene {scenes}: rigid-body motion");
                continue;
            }
            let off = (found / known - 1.0).abs();
            let allowed = uncertainty + KEPT;
            worst = worst.max(off / allowed);
            assert!(
                off <= allowed,
                "scene {scenes}: {found} Hz is {off:e} off, {uncertainty:e} said"
            );
            unsure += usize::from(uncertainty > SOUND);
        }
    }
    println!("{scenes} scenes, {frequencies} frequencies, {unsure} unsure by more than {SOUND:e}");
    println!("largest error {worst:.2} of what is said");
    assert_eq!(scenes, 1000);
    // What is said must be worth something: of twelve decades each, few frequencies may be lost.
    assert!(unsure * 100 < frequencies, "{unsure} of {frequencies}");
}
