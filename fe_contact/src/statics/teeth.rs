//! Points at which tooth pairs load the two gears of a mesh, and the gears' static flexibility
//! between them.

use gearset::{Body, Mesh, MeshKind, MeshMember};
use nalgebra::DMatrix;

use super::bodies::Bodies;
use crate::contact::{PairCells, PairFrame};

/// One end of a tooth pair: its load on a tooth of one gear.
///
/// The load is distributed over a width set by the matching depth, below which the FE field does
/// not depend on the elements. The displacement measured with it is smooth, so that one load per
/// pair suffices.
#[derive(Debug, Clone)]
pub(crate) struct PairEnd {
    /// Angle of the tooth's axis in the mesh frame, rad.
    pub(crate) axis: f64,
    /// Functions of the flank with their weights.
    pub(crate) load: Vec<(usize, f64)>,
    /// Direction in which displacement of the flank increases the pair's approach, in the tooth's
    /// frame.
    pub(crate) direction: [f64; 2],
}

/// Half-width of a pair's load in matching depths: wider than any contact patch, so that the
/// compliance of the cells always exceeds that through the ports.
const SPREAD_IN_DEPTHS: f64 = 1.5;

/// The same in half lengths of the grid of contact cells, which grows with the load. It is the
/// wider one at loads far above the design load.
const SPREAD_IN_GRIDS: f64 = 5.0 / 3.0;

/// Both ends of a pair of a mesh at a phase (cycles), driver first, with a load about the least gap as
/// wide as the grid of `cells` requires; `None` where the pair's flanks cannot touch.
pub(crate) fn pair_ends(
    bodies: &Bodies,
    mesh: &Mesh,
    phase: f64,
    cells: &PairCells,
) -> Option<[PairEnd; 2]> {
    let gears = bodies.pair(mesh.kind)?;
    let frame = PairFrame::new(mesh, phase, cells.index)?;
    let reach = 0.5 * cells.length;
    let spread = (SPREAD_IN_DEPTHS * bodies.settings.matching.depth).max(SPREAD_IN_GRIDS * reach);
    Some([MeshMember::Driver, MeshMember::Driven].map(|member| {
        let gear = gears[member as usize];
        let tooth = frame.tooth(member);
        // The approach increases as the driver moves along the normal, or the driven gear against
        // it.
        let sign = if member == MeshMember::Driver { 1.0 } else { -1.0 };
        let normal = crate::fe_mesh::rotated(frame.normal, -tooth.axis);
        let (_, roll_length) = frame.flank_point(member, cells.centre);
        let at = gear.mesh.outline.flank_parameter(roll_length);
        PairEnd {
            axis: tooth.axis,
            load: gear.flank_load(tooth.side, at, spread),
            direction: [sign * normal[0], sign * normal[1]],
        }
    }))
}

/// Static FE flexibility between some pairs of a mesh at a phase (cycles) under distributed loads,
/// sum of both gears, m/N; 0 for pairs that cannot touch there.
pub(crate) fn flexibility(
    bodies: &Bodies,
    mesh: &Mesh,
    phase: f64,
    pairs: &[&PairCells],
) -> DMatrix<f64> {
    let count = pairs.len();
    let mut sum = DMatrix::zeros(count, count);
    let Some(gears) = bodies.pair(mesh.kind) else { return sum };
    let ends: Vec<_> = pairs.iter().map(|cells| pair_ends(bodies, mesh, phase, cells)).collect();
    for (member, gear) in gears.into_iter().enumerate() {
        let pitch = gear.mesh.outline.gear().pitch_angle();
        for (k, of) in ends.iter().enumerate() {
            for (l, on) in ends.iter().enumerate() {
                let (Some(on), Some(of)) = (on, of) else { continue };
                let (on, of) = (&on[member], &of[member]);
                let offset = ((of.axis - on.axis) / pitch).round() as i64;
                let (load, point) = ((&*on.load, on.direction), (&*of.load, of.direction));
                sum[(k, l)] += gear.surface_flexibility(load, offset, point);
            }
        }
    }
    sum * bodies.flexibility_factor(mesh.kind)
}

/// The bodies a mesh joins, driver first.
pub(crate) fn mesh_bodies(kind: MeshKind, planet: usize) -> [Body; 2] {
    match kind {
        MeshKind::SunPlanet => [Body::Sun, Body::Planet(planet)],
        MeshKind::RingPlanet => [Body::Planet(planet), Body::Ring],
    }
}
