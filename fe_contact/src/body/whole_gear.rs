//! Response of a gear to loads on one tooth from the stiffness of the whole gear: for teeth meshed
//! differently, and the second route to what [`super::sector_ring`] computes.

use faer::Mat;
use nalgebra::DMatrix;

use super::matrices::{BodyMatrices, number_unknowns};
use super::responses::{LoadNodes, Responses};
use crate::error::FeError;
use crate::fe_mesh::FeGearMesh;
use crate::material::Elastic;

/// Unit loads for which a body is solved at a time.
const AT_ONCE: usize = 16;

/// Assembles and factorises the whole gear and solves for loads on tooth 0.
///
/// # Errors
/// If an element is distorted or the stiffness is not positive definite.
pub(super) fn responses(
    mesh: &FeGearMesh,
    material: &Elastic,
    face_width: f64,
    loads: &LoadNodes,
) -> Result<Responses, FeError> {
    let unknown_of = number_unknowns(mesh);
    let factor =
        BodyMatrices::of_gear(mesh, material, face_width)?.stiffness.factorise(mesh.name)?;
    let columns = loads.columns();
    // Displacements that are kept: a tooth, nodes of its sector, and their response in the
    // tooth's frame.
    let seen = |tooth: usize, locals: Vec<usize>| {
        let response = DMatrix::zeros(2 * locals.len(), columns);
        (tooth, locals, response)
    };
    let mut near: Vec<_> = Responses::near_teeth(mesh)
        .map(|tooth| seen(tooth, (0..mesh.nodes[tooth].len()).collect()))
        .collect();
    let alike = if mesh.sectors.len() > 1 { 1 } else { mesh.nodes.len() };
    let mut around: Vec<_> = (0..alike).map(|tooth| seen(tooth, loads.list.clone())).collect();
    // In blocks of loads: the displacements of the whole body under all loads at once would be
    // the largest array in memory.
    for first in (0..columns).step_by(AT_ONCE) {
        let count = AT_ONCE.min(columns - first);
        let mut right = Mat::zeros(factor.size, count);
        for c in 0..count {
            let (node, axis) = (loads.list[(first + c) / 2], (first + c) % 2);
            right[(unknown_of[mesh.nodes[0][node]] + axis, c)] = 1.0;
        }
        factor.solve(&mut right);
        for (tooth, locals, response) in near.iter_mut().chain(&mut around) {
            let (sin, cos) = mesh.tooth_angle(*tooth).sin_cos();
            for (row, local) in locals.iter().enumerate() {
                let unknown = unknown_of[mesh.nodes[*tooth][*local]];
                if unknown == usize::MAX {
                    continue;
                }
                for c in 0..count {
                    let (x, y) = (right[(unknown, c)], right[(unknown + 1, c)]);
                    response[(2 * row, first + c)] = cos * x + sin * y;
                    response[(2 * row + 1, first + c)] = -sin * x + cos * y;
                }
            }
        }
    }
    let kept = |list: Vec<(usize, Vec<usize>, DMatrix<f64>)>| {
        list.into_iter().map(|(_, _, response)| response).collect()
    };
    Ok(Responses::known(mesh, kept(near), kept(around)))
}
