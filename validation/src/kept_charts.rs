//! Results behind charts that take minutes to compute, as kept in `kept/` with the commands that remake them.

use experiments::stability::StabilityMap;
use experiments::study::StudyResult;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::reference_file::{ReferenceError, embedded};

/// A study as it was run, that of models for instance by
/// `epicyclic study studies/models.toml --rounds 3 --format json > kept/studies/models.json`.
#[derive(Debug, Clone)]
pub struct KeptStudy {
    /// Name of its file.
    pub name: &'static str,
    /// Version of the program that ran it.
    pub version: String,
    /// What it gave.
    pub result: StudyResult,
}

/// What the program writes with `--format json`.
#[derive(Debug, Deserialize)]
struct Written<T> {
    version: String,
    #[serde(flatten)]
    result: T,
}

fn read<T: DeserializeOwned>(file: &'static str, text: &str) -> Result<Written<T>, ReferenceError> {
    serde_json::from_str(text)
        .map_err(|cause| ReferenceError::UnreadableJson { file, cause: Box::new(cause) })
}

/// The shipped studies, that of the main question first.
///
/// # Errors
/// If a file is not what the program writes.
pub fn kept_studies() -> Result<Vec<KeptStudy>, ReferenceError> {
    macro_rules! kept {
        ($($name:literal),*) => {
            vec![$({
                let text = embedded!(concat!("kept/studies/", $name, ".json"));
                let Written { version, result } = read(concat!("kept/studies/", $name, ".json"), text)?;
                KeptStudy { name: $name, version, result }
            }),*]
        };
    }
    Ok(kept![
        "models",
        "torque_growth",
        "fidelity",
        "steps_per_cycle",
        "contact_cells",
        "elements",
        "matching",
        "contact_solver",
        "steady_state_method",
        "integrator"
    ])
}

/// The stability maps that take minutes: contact loss over torque and damping of OH-58 with four planets, by
/// `epicyclic stability contact-loss --scene scenes/oh58_4p.toml --format json > kept/stability/contact-loss.json`,
/// linear kinematics, by `epicyclic stability linear-kinematics --format json >
/// kept/stability/linear-kinematics.json`, and hammering, by `epicyclic stability hammering --format json >
/// kept/stability/hammering.json`.
///
/// # Errors
/// If a file is not what the program writes.
pub fn kept_maps() -> Result<Vec<StabilityMap>, ReferenceError> {
    macro_rules! kept {
        ($name:literal) => {{
            let text = embedded!(concat!("kept/stability/", $name, ".json"));
            read(concat!("kept/stability/", $name, ".json"), text)?.result
        }};
    }
    Ok(vec![kept!("contact-loss"), kept!("linear-kinematics"), kept!("hammering")])
}
