//! Recomputes one kept file or table of the pages and writes it to standard output:
//! `cargo run --release -p remake -- NAME`; without a name it lists them.

mod assumptions;
mod attraction;
mod auto;
mod certified_values;
mod dataset;
mod effects;
mod equations;
mod exact_peaks;
mod ladder;
mod loaded_te;
mod parameter_bands;
mod published_stiffness;
mod second_system;
mod sensitivity;
mod torque;
mod torque_map;
mod truth;

use std::error::Error;
use std::process::ExitCode;

/// Result of remaking one file or table.
type Outcome = Result<(), Box<dyn Error + Send + Sync>>;

type Remake = fn() -> Outcome;

/// Name, what it makes, how.
const ALL: [(&str, &str, Remake); 17] = [
    (
        "assumptions",
        "docs/assumptions.md from the ledger and the kept verdict",
        assumptions::remake,
    ),
    (
        "attraction",
        "kept/attraction.csv: motions at drawn operating points, pushed",
        attraction::remake,
    ),
    ("auto", "kept/auto.csv: choices of auto on drawn sets and their errors", auto::remake),
    (
        "certified_values",
        "docs/certified_values.md from the tables of the data set",
        certified_values::remake,
    ),
    ("dataset", "data/dataset/: tables of certified values", dataset::remake),
    (
        "effects",
        "tables of docs/fe_dynamics_effects.md: what changes the tabled frequencies",
        effects::remake,
    ),
    ("equations", "docs/equations.md from the tags in the code's comments", equations::remake),
    (
        "exact_peaks",
        "kept/exact_peaks.toml: peaks with exact kinematics at every step",
        exact_peaks::remake,
    ),
    ("ladder", "kept/ladder.toml: error against cost of the fidelities", ladder::remake),
    (
        "loaded_te",
        "table of docs/torque.md: harmonics of the loaded transmission error",
        loaded_te::remake,
    ),
    (
        "parameter_bands",
        "kept/parameter_bands.toml: what open parameters do to rows held against the paper",
        parameter_bands::remake,
    ),
    (
        "published_stiffness",
        "factors of scenes/oh58_*_published_stiffness.toml",
        published_stiffness::remake,
    ),
    ("second_system", "parameters of scenes/oh58_4p_second_system.toml", second_system::remake),
    (
        "sensitivity",
        "figures of docs/torque.md: what damping and mesh do to growth with torque",
        sensitivity::remake,
    ),
    ("torque", "kept/torque_peaks.toml: resonant peaks over torque", torque::remake),
    (
        "torque_map",
        "kept/torque_map.toml: growth with torque over mesh compliance and phase",
        torque_map::remake,
    ),
    ("truth", "kept/full_sweep.toml: steady states with every degree of freedom", truth::remake),
];

fn main() -> Result<ExitCode, Box<dyn Error + Send + Sync>> {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    match ALL.iter().find(|(name, ..)| *name == wanted) {
        Some((.., remake)) => remake().map(|()| ExitCode::SUCCESS),
        None => {
            eprintln!("what to remake:");
            for (name, what, _) in ALL {
                eprintln!("  {name:20} {what}");
            }
            Ok(ExitCode::from(2))
        }
    }
}
