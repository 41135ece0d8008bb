//! The part of a mesh's flexibility that stiffness-proportional damping acts on.

use gearset::Mesh;

use super::deflected_mesh::{Approaches, DeflectedMesh};
use crate::contact::{MeshTable, PairCells};
use crate::statics::{Bodies, flexibility};

/// Share of the elastic bodies in the flexibility of a mesh under a force, which is the elastic energy in the bodies
/// divided by the whole elastic energy. The half-planes are undamped.
///
/// `[eq:damped-share]` s = pᵀ F p / pᵀ a with the pair forces p = S a that a unit of deflection adds, and the bodies'
/// flexibility F between the pairs; a mesh's force is then F(δ + β s δ̇).
/// Source: derived here.
/// Checked by: `fe_contact/tests/mesh_law.rs::harmonics_are_those_of_the_quasi_static_fidelity`.
pub(super) fn damped_share(
    bodies: &Bodies,
    mesh: &Mesh,
    table: &MeshTable,
    along: &Approaches,
    found: &DeflectedMesh,
) -> f64 {
    let (total, tangent) = (found.stiffness, &found.tangent);
    let arms = &along.arms;
    let count = arms.len();
    let p: Vec<f64> =
        (0..count).map(|k| (0..count).map(|l| tangent[(k, l)] * arms[l]).sum()).collect();
    let cells: Vec<&PairCells> = table.pairs.iter().collect();
    let flexibility = flexibility(bodies, mesh, table.phase, &cells);
    let mut elastic = 0.0;
    for (k, p_k) in p.iter().enumerate() {
        for (l, p_l) in p.iter().enumerate() {
            elastic += p_k * flexibility[(k, l)] * p_l;
        }
    }
    if total > 0.0 { (elastic / total).clamp(0.0, 1.0) } else { 0.0 }
}
