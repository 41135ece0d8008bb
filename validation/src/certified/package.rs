//! The data set as a folder: tables, scenes, a Frictionless data package, hashes, a page.

use std::fmt::Write;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use super::DATA_SET_VERSION;
use super::class::Class;
use super::quantity::QUANTITIES;
use super::table::{CertifiedValues, TABLES};

/// Name of the list of hashes, as `sha256sum --check` reads it.
pub(super) const HASHES: &str = "SHA256SUMS";

/// What the tables hold.
const ABOUT: [(&str, &str); TABLES.len()] = [
    ("geometry", "geometry and kinematics of gears and meshes, mesh phases, Hertz pressures"),
    (
        "modes",
        "natural frequencies of lumped, torsional and, under the torque of the scene, finite-element/contact models",
    ),
    ("matrices", "mass and stiffness matrices of lumped models, upper triangles"),
    ("rules", "kinds of modes that harmonics of the mesh frequency can excite"),
    ("pairs", "forces and pressures of one mesh at a prescribed approach"),
    ("mesh_cycle", "sets at rest under load over a mesh cycle, finite-element/contact model"),
    ("steady_states", "amplitudes of steady states over speed, finite-element/contact model"),
    ("torque_growth", "resonant peaks over torque, finite-element/contact model"),
    ("stability", "Floquet multipliers of these steady states; borders of instability"),
];

/// Columns of every table: name, type of Frictionless, unit and meaning.
const COLUMNS: [(&str, &str, &str); 19] = [
    ("id", "string", "name of the value, the same in every version"),
    ("quantity", "string", "name of the quantity, explained in quantities.csv"),
    ("scene", "string", "gear set: the file of that name in the folder scenes"),
    ("kind", "string", "geometry (true of every model), lumped, torsional or fe_contact"),
    (
        "subject",
        "string",
        "body, mesh, kind of modes, or the two coordinates of an entry of a matrix",
    ),
    ("coordinate", "string", "x, y, rotation or force of the subject, or the tooth pair"),
    ("number", "integer", "number of a mode within its type, from 1 upwards in frequency"),
    ("harmonic", "integer", "harmonic of the mesh frequency"),
    ("sun_torque_nm", "number", "torque on the sun, N m, counter-clockwise positive"),
    ("speed_rpm", "number", "speed of the driven member, rpm"),
    ("position", "number", "phase of planet 0's sun mesh, or of the mesh of a pair, cycles"),
    ("approach_um", "number", "approach of a pair's gears along the line of action, µm"),
    ("value", "number", "the value, in the unit of the row"),
    ("unit", "string", "unit of value and uncertainty; empty of numbers"),
    ("uncertainty", "number", "expanded uncertainty: the value is within ± this"),
    ("class", "string", "A certified by independent codes, B two numerical routes, C one route"),
    ("routes", "string", "routes to the value, joined by `; `"),
    ("source", "string", "where the numbers of the scene come from"),
    ("version", "string", "version of the data set"),
];

/// Every file of the folder: path and text. The same from the same version; `further` are files that a program adds, of
/// which only the hash is here.
pub fn package(further: &[(String, Vec<u8>)]) -> Vec<(String, String)> {
    let text = |path: String| {
        let found = epicyclic_data::FILES.iter().find(|(name, _)| *name == path);
        found.map(|(_, text)| (*text).to_owned()).unwrap_or_default()
    };
    let mut files: Vec<(String, String)> = TABLES
        .iter()
        .map(|name| (format!("{name}.csv"), text(format!("dataset/{name}.csv"))))
        .collect();
    files.push(("quantities.csv".to_owned(), quantities()));
    let scenes: Vec<&(&str, &str)> =
        epicyclic_data::FILES.iter().filter(|(path, _)| path.starts_with("scenes/")).collect();
    files.push(("scenes.csv".to_owned(), scene_list(&scenes)));
    files.extend(scenes.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())));
    files.push(("LICENSE".to_owned(), LICENCE.to_owned()));
    files.push(("CITATION.cff".to_owned(), citation()));
    files.push(("README.md".to_owned(), readme()));
    files.push(("datapackage.json".to_owned(), descriptor(&files)));
    let mut hashes = String::new();
    let texts = files.iter().map(|(path, text)| (path, text.as_bytes()));
    for (path, bytes) in texts.chain(further.iter().map(|(path, bytes)| (path, bytes.as_slice()))) {
        // Writing to a string cannot fail.
        let _ = writeln!(hashes, "{}  {path}", sha256(bytes));
    }
    files.push((HASHES.to_owned(), hashes));
    files
}

const LICENCE: &str = "Creative Commons Attribution 4.0 International (CC BY 4.0)\n\
                       https://creativecommons.org/licenses/by/4.0/\n";

/// SHA-256, hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

fn quantities() -> String {
    let mut text = "quantity,unit,meaning\n".to_owned();
    for quantity in QUANTITIES {
        let _ = writeln!(text, "{},{},\"{}\"", quantity.name, quantity.unit, quantity.meaning);
    }
    text
}

fn scene_list(scenes: &[&(&str, &str)]) -> String {
    let mut text = "scene,sha256\n".to_owned();
    for (path, scene) in scenes {
        let id = path.trim_start_matches("scenes/").trim_end_matches(".toml");
        let _ = writeln!(text, "{id},{}", sha256(scene.as_bytes()));
    }
    text
}

fn citation() -> String {
    format!(
        "cff-version: 1.2.0\nmessage: \"If you use these values, please cite them by version.\"\n\
         title: \"epicyclic: certified values of planetary gear dynamics\"\ntype: dataset\n\
         version: \"{DATA_SET_VERSION}\"\nlicense: CC-BY-4.0\nauthors:\n  - name: \"The epicyclic developers\"\n"
    )
}

fn descriptor(files: &[(String, String)]) -> String {
    let field = |(name, kind, about): &(&str, &str, &str)| {
        let constraints = match *name {
            "id" => json!({ "required": true, "unique": true }),
            "class" => json!({ "required": true, "enum": Class::ALL.map(Class::name) }),
            "position" | "uncertainty" => json!({ "minimum": 0 }),
            "number" => json!({ "minimum": 1 }),
            "quantity" | "scene" | "kind" | "value" => json!({ "required": true }),
            _ => json!({}),
        };
        json!({ "name": name, "type": kind, "description": about, "constraints": constraints })
    };
    let fields: Vec<Value> = COLUMNS.iter().map(field).collect();
    let key = |field: &str, resource: &str| json!({ "fields": [field], "reference": { "resource": resource, "fields": [field] } });
    let resource = |name: &str, about: &str, schema: Value| {
        let path = format!("{name}.csv");
        let bytes =
            files.iter().find(|(file, _)| *file == path).map_or("", |(_, text)| text.as_str());
        json!({
            "name": name, "type": "table", "path": path, "description": about, "format": "csv", "mediatype": "text/csv",
            "encoding": "utf-8", "bytes": bytes.len(), "hash": format!("sha256:{}", sha256(bytes.as_bytes())),
            "schema": schema,
        })
    };
    let schema = json!({
        "fields": fields, "primaryKey": ["id"],
        "foreignKeys": [key("quantity", "quantities"), key("scene", "scenes")],
    });
    let mut resources: Vec<Value> =
        ABOUT.iter().map(|(name, about)| resource(name, about, schema.clone())).collect();
    let list = |names: [&str; 3], key: &str| {
        let fields: Vec<Value> = names
            .iter()
            .filter(|n| !n.is_empty())
            .map(|n| json!({ "name": n, "type": "string" }))
            .collect();
        json!({ "fields": fields, "primaryKey": [key] })
    };
    resources.push(resource(
        "quantities",
        "quantities and their units",
        list(["quantity", "unit", "meaning"], "quantity"),
    ));
    resources.push(resource(
        "scenes",
        "gear sets, by file",
        list(["scene", "sha256", ""], "scene"),
    ));
    let package = json!({
        "$schema": "https://datapackage.org/profiles/2.0/datapackage.json",
        "name": "epicyclic", "title": "Certified values of planetary gear dynamics", "version": DATA_SET_VERSION,
        "licenses": [{ "name": "CC-BY-4.0", "path": "https://creativecommons.org/licenses/by/4.0/" }],
        "resources": resources,
    });
    // A value made here has a text.
    serde_json::to_string_pretty(&package).unwrap_or_default() + "\n"
}

fn readme() -> String {
    let values = CertifiedValues::shipped();
    let mut text = README.replace("VERSION", DATA_SET_VERSION);
    text.push_str("\n| table | holds | A | B | C |\n|---|---|---|---|---|\n");
    for ((name, rows), (_, about)) in values.tables.iter().zip(ABOUT) {
        let [a, b, c] =
            Class::ALL.map(|class| rows.iter().filter(|row| row.class == class).count());
        let _ = writeln!(text, "| `{name}.csv` | {about} | {a} | {b} | {c} |");
    }
    text
}

const README: &str = include_str!("readme.md");
