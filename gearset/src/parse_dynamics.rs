//! The `[dynamics]` table.

use crate::choices::{DynamicsInput, Fidelity, MeshKinematics};
use crate::reader::Section;

/// Fidelities by name; the number of modes has a key of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Name {
    MeshLaw,
    QuasiStatic,
    Modal,
    Full,
}

pub(crate) fn dynamics(s: Section<'_, '_>) -> DynamicsInput {
    let default = DynamicsInput::default();
    let names = [
        ("mesh_law", Name::MeshLaw),
        ("quasi_static", Name::QuasiStatic),
        ("modal", Name::Modal),
        ("full", Name::Full),
    ];
    let name = s.choice("fidelity", &names, "what stands behind the teeth");
    let modes = s.integer("modes", (1, 400), "modes of each body with its race held");
    let is_known = !s.is_doubtful("fidelity");
    if modes.is_some() && name != Some(Name::Modal) && is_known {
        s.fault("modes", "with fidelity = \"modal\"", "no other fidelity takes a number of modes");
    }
    if name == Some(Name::Modal) && !s.may_hold("modes") {
        s.fault("modes", "a whole number from 1 to 400", "fidelity = \"modal\" needs it");
    }
    // Fewer than 16 steps do not resolve the changing number of pairs in a mesh cycle.
    let steps = s.integer("steps_per_cycle", (16, 100_000), "time steps in a mesh cycle");
    let switch = [("off", false), ("on", true)];
    let gyroscopic = s.choice("gyroscopic", &switch, "terms of the turning carrier frame");
    let ways = [("about_mean", MeshKinematics::AboutMean), ("exact", MeshKinematics::Exact)];
    let kinematics = s.choice("kinematics", &ways, "how meshes follow the displaced gears");
    if kinematics == Some(MeshKinematics::Exact) && !matches!(name, None | Some(Name::QuasiStatic))
    {
        s.fault(
            "kinematics",
            "\"about_mean\" on this fidelity",
            "only quasi-static bodies follow exactly",
        );
    }
    s.finish();
    let fidelity = match (name, modes) {
        (Some(Name::MeshLaw), _) => Fidelity::MeshLaw,
        (Some(Name::Full), _) => Fidelity::Full,
        (Some(Name::Modal), Some(n)) => Fidelity::Modal(n as u32),
        _ => Fidelity::QuasiStatic,
    };
    DynamicsInput {
        fidelity,
        steps_per_cycle: steps.map_or(default.steps_per_cycle, |n| n as u32),
        gyroscopic: gyroscopic.unwrap_or(default.gyroscopic),
        kinematics: kinematics.unwrap_or(default.kinematics),
    }
}
