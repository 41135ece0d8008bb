//! One mesh whose driving race is turned by a given angle: the problem of the CalculiX deck, solved
//! by this program.

use gearset::{MeshKind, MeshMember};

use super::bodies::Bodies;
use crate::complementarity::ComplementaritySolver;
use crate::contact::{Location, MeshTable, hertz};
use crate::error::FeError;

/// One pair of a mesh at a prescribed approach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PairAtApproach {
    /// Pair k stands k base pitches on from pair 0.
    pub index: i64,
    /// Path or corner.
    pub location: Location,
    /// Force along the pair's normal, N.
    pub force: f64,
    /// Peak of the ellipse fitted to the pressures, Pa; `None` at a corner, where pressure is
    /// singular, and without load.
    pub peak_pressure: Option<f64>,
}

/// Forces and peak pressures of a mesh at a prescribed approach.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshAtApproach {
    /// Which mesh.
    pub kind: MeshKind,
    /// Phase, cycles.
    pub phase: f64,
    /// δ = r_b · rotation of the driving gear's race, m.
    pub approach: f64,
    /// Normal force F: torque on the driving gear over its base radius, N.
    pub force: f64,
    /// All pairs whose gap is at most δ.
    pub pairs: Vec<PairAtApproach>,
}

/// Fewest loaded cells a patch may have.
const LEAST_CELLS: usize = 6;

/// Solves a mesh whose driving race is turned by δ/r_b, the driven one held.
///
/// # Errors
/// If the scene lacks the mesh, nothing touches, contact cannot be solved, or cells do not suffice.
pub fn at_approach(
    bodies: &Bodies,
    kind: MeshKind,
    phase: f64,
    approach: f64,
    solver: &dyn ComplementaritySolver,
) -> Result<MeshAtApproach, FeError> {
    let (mesh, pair) = bodies.joined(kind)?;
    let r_b = mesh.gear(MeshMember::Driver).base_radius;
    // Grids are sized by a force: first that of one pair of teeth of usual stiffness E b/13, then
    // the force found.
    let mut force = approach * bodies.material.young * bodies.geometry.face_width / 13.0;
    for is_last in [false, true] {
        let mut settings = bodies.cells(force);
        settings.window = approach;
        let table = MeshTable::new(mesh, pair, phase, &settings)?;
        let arms: Vec<f64> = table.pairs.iter().map(|p| p.row[2].abs() / r_b).collect();
        let approaches: Vec<f64> = arms.iter().map(|a| a * approach).collect();
        let answer = table.answer(&approaches, &vec![0.0; arms.len()], solver, None)?;
        force = answer.pair_forces.iter().zip(&arms).map(|(p, a)| p * a).sum();
        if force <= 0.0 {
            break;
        }
        if !is_last {
            continue;
        }
        table.check_patches(&answer, LEAST_CELLS, 0.0)?;
        let list = table.pairs.iter().zip(&answer.pair_forces).enumerate();
        let pairs = list.map(|(k, (cells, force))| {
            let pressures = table.pressures(k, &answer.cell_forces);
            let fit = hertz::fit(&cells.x, &pressures).filter(|_| cells.location == Location::Path);
            PairAtApproach {
                index: cells.index,
                location: cells.location,
                force: *force,
                peak_pressure: fit.map(|f| f.peak_pressure),
            }
        });
        return Ok(MeshAtApproach { kind, phase, approach, force, pairs: pairs.collect() });
    }
    Err(FeError::NoEquilibrium(format!(
        "no teeth touch at phase {phase:.4} and an approach of {:.3} µm",
        approach * 1e6
    )))
}
