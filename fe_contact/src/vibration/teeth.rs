//! Where tooth pairs push at the gears of a set, at one position of the mesh cycle.

use gearset::{MeshKind, MeshMember};

use super::body::Port;
use crate::body::GearBody;
use crate::contact::PairFrame;
use crate::error::FeError;
use crate::mesh::GearMesh;
use crate::statics::{Bodies, PLANETS, Placed, RING, Races, SUN};

/// One end of a tooth pair: where it pushes at a tooth of one gear.
///
/// Only what inertia and damping change of the elastic displacement goes through this: the static
/// part is the cells' compliance. That field is smooth, so one load a pair serves; it is spread over
/// the matching depth, below which the FE field stands for the tooth, whatever the mesh.
#[derive(Debug, Clone)]
pub(super) struct ToothPoint {
    /// Body in the set's order: carrier, ring, sun, planets.
    pub(super) body: usize,
    /// Angle of the tooth's axis in the race's frame, rad.
    pub(super) axis: f64,
    /// Functions of the flank with their weights.
    pub(super) load: Vec<(usize, f64)>,
    /// Which displacement of the flank closes the pair, in the tooth's frame.
    pub(super) direction: [f64; 2],
}

/// Half-width of a pair's load in matching depths: wider than any contact patch, so that the cells'
/// compliance always exceeds what is taken through the ports.
const SPREAD_IN_DEPTHS: f64 = 1.5;

/// The same in half-grids of cells, which are made for the load: counts where that is far above what
/// the set is designed for.
const SPREAD_IN_GRIDS: f64 = 5.0 / 3.0;

/// Both ends of every pair of a mesh, driver first.
///
/// # Errors
/// If a pair of the table has no contact point, which would be a fault of the table.
pub(super) fn tooth_points(
    bodies: &Bodies,
    races: &Races,
    placed: &Placed<'_>,
) -> Result<Vec<[ToothPoint; 2]>, FeError> {
    let (mesh, gears) = bodies.joined(placed.kind)?;
    let numbers = match placed.kind {
        MeshKind::SunPlanet => [SUN, PLANETS + placed.planet],
        MeshKind::RingPlanet => [PLANETS + placed.planet, RING],
    };
    let one = |cells: &crate::contact::PairCells| {
        let frame = PairFrame::new(mesh, placed.phase, cells.index)?;
        let reach = 0.5 * cells.width * cells.x.len() as f64;
        let spread =
            (SPREAD_IN_DEPTHS * bodies.settings.matching.depth).max(SPREAD_IN_GRIDS * reach);
        Some([MeshMember::Driver, MeshMember::Driven].map(|member| {
            let (i, gear) = (member as usize, gears[member as usize]);
            let tooth = frame.tooth(member);
            // A driver displaced along the normal approaches, a driven gear against it.
            let sign = if member == MeshMember::Driver { 1.0 } else { -1.0 };
            let normal = crate::mesh::rotated(frame.normal, -tooth.axis);
            let (_, string) = frame.flank_point(member, 0.0);
            let outline = &gear.mesh.outline;
            let body = numbers[i];
            // The mesh frame stands ψ on from the carrier frame, and is the planet's own.
            let turned = if body < PLANETS { races.psi[placed.planet] } else { 0.0 };
            ToothPoint {
                body,
                axis: tooth.axis + turned,
                load: gear.flank_load(tooth.side, outline.flank_parameter(string), spread),
                direction: [sign * normal[0], sign * normal[1]],
            }
        }))
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
    let mesh: &GearMesh = &gear.mesh;
    let direction = crate::mesh::rotated(end.direction, mesh.tooth_angle(tooth));
    port.terms.clear();
    for (column, weight) in &end.load {
        let unknown = unknown_of[mesh.nodes[tooth][gear.node_of(*column)]];
        port.terms.push((unknown, weight * direction[0]));
        port.terms.push((unknown + 1, weight * direction[1]));
    }
}
