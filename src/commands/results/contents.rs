//! What the tables of a results folder hold, scene by scene.

use schemars::JsonSchema;
use serde::Serialize;
use validation::results::ResultsFolder;

/// Rows of one table or matrix about one scene.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct Contents {
    /// Name of the file.
    pub(super) table: String,
    /// Id of the scene.
    pub(super) scene: String,
    pub(super) rows: usize,
    /// Number of natural modes, each as often as its multiplicity says.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) modes: Option<usize>,
    /// Torques on the sun, ascending, N m.
    pub(super) sun_torques_nm: Vec<f64>,
    /// Speeds, ascending, rpm.
    pub(super) speeds_rpm: Vec<f64>,
    /// Positions in the mesh cycle, ascending.
    pub(super) positions: Vec<f64>,
}

impl Contents {
    fn new(table: &str, scene: &str) -> Self {
        let (sun_torques_nm, speeds_rpm, positions) = (Vec::new(), Vec::new(), Vec::new());
        let (table, scene) = (table.to_owned(), scene.to_owned());
        Self { table, scene, rows: 0, modes: None, sun_torques_nm, speeds_rpm, positions }
    }

    /// Of all tables and matrices, in the order in which the folder has scenes.
    pub(super) fn of_folder(folder: &ResultsFolder) -> Vec<Self> {
        let mut all = Vec::new();
        for row in &folder.modes {
            let entry = entry(&mut all, "modes.csv", &row.scene.id);
            entry.modes = Some(entry.modes.unwrap_or(0) + row.times());
        }
        for row in &folder.mesh_cycle {
            let entry = entry(&mut all, "mesh_cycle.csv", &row.scene.id);
            insert(&mut entry.sun_torques_nm, row.sun_torque_nm);
            insert(&mut entry.positions, row.position);
        }
        for row in &folder.mesh_stiffness {
            let entry = entry(&mut all, "mesh_stiffness.csv", &row.scene.id);
            insert(&mut entry.sun_torques_nm, row.sun_torque_nm);
            insert(&mut entry.positions, row.position);
        }
        for row in &folder.steady_states {
            let entry = entry(&mut all, "steady_states.csv", &row.scene.id);
            insert(&mut entry.sun_torques_nm, row.sun_torque_nm);
            insert(&mut entry.speeds_rpm, row.speed_rpm);
        }
        for row in &folder.torque_peaks {
            let entry = entry(&mut all, "torque_peaks.csv", &row.scene.id);
            insert(&mut entry.sun_torques_nm, row.peak.sun_torque_nm);
        }
        for row in &folder.rules {
            entry(&mut all, "rules.csv", &row.scene.id);
        }
        for set in &folder.matrices {
            for (_, matrix) in set.each() {
                let name = matrix.path.strip_prefix(&folder.path).unwrap_or(&matrix.path);
                let name = name.display().to_string();
                all.push(Self { rows: matrix.rows(), ..Self::new(&name, &set.scene.id) });
            }
        }
        all
    }
}

/// The entry of a table and scene, with one more row.
fn entry<'a>(all: &'a mut Vec<Contents>, table: &str, scene: &str) -> &'a mut Contents {
    let is_same = |entry: &Contents| entry.table == table && entry.scene == scene;
    let index = all.iter().position(is_same).unwrap_or_else(|| {
        all.push(Contents::new(table, scene));
        all.len() - 1
    });
    let entry = &mut all[index];
    entry.rows += 1;
    entry
}

/// Puts a number into an ascending list, once.
fn insert(list: &mut Vec<f64>, number: f64) {
    if let Err(place) = list.binary_search_by(|known| known.total_cmp(&number)) {
        list.insert(place, number);
    }
}
