//! Points at which tooth pairs load the bodies of a set, at one position of the mesh cycle.

use super::body::Port;
use crate::body::GearBody;
use crate::error::FeError;
use crate::fe_mesh::FeGearMesh;
use crate::statics::{PairEnd, PlacedMesh, StaticSet, mesh_bodies, pair_ends};
use gearset::Body;

/// One end of a tooth pair on a body of the set. Only the part of the elastic displacement due to
/// inertia and damping passes through it; the static part is in the compliance of the cells.
#[derive(Debug, Clone)]
pub(super) struct ToothPoint {
    /// Body.
    pub(super) body: Body,
    /// Angle of the tooth's axis in the race's frame, rad.
    pub(super) axis: f64,
    /// Load and direction on the tooth.
    pub(super) end: PairEnd,
}

/// Both ends of every pair of a front mesh (sun meshes, then ring meshes), driver first.
///
/// # Errors
/// If a pair of the table has no contact point, which would be a fault of the table.
pub(super) fn tooth_points(
    statics: &StaticSet<'_>,
    which: usize,
    placed: &PlacedMesh<'_>,
) -> Result<Vec<[ToothPoint; 2]>, FeError> {
    let (mesh, direction) = statics.loaded_mesh(which);
    let numbers = mesh_bodies(placed.kind, placed.planet);
    let one = |cells: &crate::contact::PairCells| {
        let [driver, driven] = pair_ends(statics.bodies, mesh, placed.phase, cells)?;
        let [first, second] = numbers;
        let point = |body: Body, end: PairEnd| {
            // The mesh frame is turned by ψ_n from the carrier frame and is the frame of the
            // planet's coordinates; under load it is turned further with the line of centres.
            let is_planet = matches!(body, Body::Planet(_));
            let psi = if is_planet { 0.0 } else { statics.races.psi[placed.planet] };
            ToothPoint { body, axis: end.axis + psi + direction, end }
        };
        Some([point(first, driver), point(second, driven)])
    };
    let lost = || FeError::NoEquilibrium(format!("a pair at phase {} is lost", placed.phase));
    placed.table.pairs.iter().map(|cells| one(cells).ok_or_else(lost)).collect()
}

/// Writes the degrees of freedom behind a flank point of a tooth into a port.
pub(super) fn fill_port(
    port: &mut Port,
    (gear, unknown_of): (&GearBody, &[usize]),
    end: &ToothPoint,
    tooth: usize,
) {
    let mesh: &FeGearMesh = &gear.mesh;
    let direction = crate::fe_mesh::rotated(end.end.direction, mesh.tooth_angle(tooth));
    port.terms.clear();
    for (column, weight) in &end.end.load {
        let unknown = unknown_of[mesh.nodes[tooth][gear.node_of(*column)]];
        port.terms.push((unknown, weight * direction[0]));
        port.terms.push((unknown + 1, weight * direction[1]));
    }
}
