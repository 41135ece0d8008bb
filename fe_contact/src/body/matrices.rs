//! Matrices of one body between its race and its flexible degrees of freedom.

use super::assembly::{Sparse, Triplets};
use crate::element::matrices;
use crate::error::FeError;
use crate::fe_mesh::FeGearMesh;
use crate::material::Elastic;

/// Stiffness and consistent mass of a body, the race's rigid motion split off.
///
/// The displacement of a point is the race's (x, y, θ) carried along rigidly, plus what the n
/// degrees of freedom u add, which vanish on the race.
///
/// `[eq:body-matrices]` M_rr q̈ + M_rf ü = race loads, M_fr q̈ + M_ff ü + K u = loads.
/// Source: definition.
/// Checked by: `fe_contact/tests/statics.rs::a_ring_of_material_weighs_what_it_should`, `fe.bodies.mass`,
/// `fe.bodies.inertia`.
#[derive(Debug, Clone)]
pub struct BodyMatrices {
    /// K, n×n, N/m.
    pub stiffness: Sparse,
    /// M_ff, n×n, kg.
    pub mass: Sparse,
    /// M_fr by columns x, y, θ about the centre; kg, kg, kg m.
    pub coupling: [Vec<f64>; 3],
    /// Degrees of freedom n.
    pub size: usize,
}

impl BodyMatrices {
    /// Matrices of a gear. Element matrices are computed once in the tooth's frame and rotated to
    /// each tooth, so that the matrices are exactly cyclic.
    ///
    /// # Errors
    /// If an element is distorted.
    pub fn of_gear(
        mesh: &FeGearMesh,
        material: &Elastic,
        face_width: f64,
    ) -> Result<Self, FeError> {
        let unknown_of = number_unknowns(mesh);
        let incompatible = mesh.family == scene::ElementFamily::Incompatible;
        let mut of_sectors = Vec::new();
        for sector in &mesh.sectors {
            let mut list = Vec::with_capacity(sector.elements.len());
            for (i, e) in sector.elements.iter().enumerate() {
                let points: Vec<_> =
                    e.nodes[..e.shape.count()].iter().map(|n| sector.points[*n]).collect();
                let m = matrices(&e.shape, &points, material, face_width, incompatible)
                    .map_err(|cause| FeError::Distorted { body: mesh.name, element: i, cause })?;
                list.push((m.stiffness, m.mass));
            }
            of_sectors.push(list);
        }
        let size = 2 * unknown_of.iter().filter(|u| **u != usize::MAX).count();
        let (mut stiffness, mut mass) = (Triplets::default(), Triplets::default());
        let mut coupling = [(); 3].map(|()| vec![0.0; size]);
        for e in &mesh.elements {
            let (k, m) = &of_sectors[mesh.sector_of[e.tooth]][e.local];
            let (sin, cos) = mesh.tooth_angle(e.tooth).sin_cos();
            let count = e.shape.count();
            for a in 0..count {
                let row = unknown_of[e.nodes[a]];
                if row == usize::MAX {
                    continue;
                }
                for b in 0..count {
                    // The consistent mass is the same in x and y, so that rotation does not change
                    // it.
                    let inertia = m[(2 * a, 2 * b)];
                    // Rigid motion of node b, also where it lies on the race. A translation does
                    // not change derivative nodes.
                    let moved = if mesh.is_derivative[e.nodes[b]] { 0.0 } else { 1.0 };
                    let [x, y] = mesh.points[e.nodes[b]];
                    coupling[0][row] += inertia * moved;
                    coupling[1][row + 1] += inertia * moved;
                    coupling[2][row] -= inertia * y;
                    coupling[2][row + 1] += inertia * x;
                    let column = unknown_of[e.nodes[b]];
                    if column == usize::MAX {
                        continue;
                    }
                    mass.add(row, column, inertia);
                    mass.add(row + 1, column + 1, inertia);
                    let block = |r: usize, c: usize| k[(2 * a + r, 2 * b + c)];
                    // R k Rᵀ with R = [c −s; s c]
                    let [p, q, r, s] = [block(0, 0), block(0, 1), block(1, 0), block(1, 1)];
                    let top = [cos * p - sin * r, cos * q - sin * s];
                    let low = [sin * p + cos * r, sin * q + cos * s];
                    stiffness.add(row, column, top[0] * cos - top[1] * sin);
                    stiffness.add(row, column + 1, top[0] * sin + top[1] * cos);
                    stiffness.add(row + 1, column, low[0] * cos - low[1] * sin);
                    stiffness.add(row + 1, column + 1, low[0] * sin + low[1] * cos);
                }
            }
        }
        let (stiffness, mass) = (stiffness.matrix(size, mesh.name)?, mass.matrix(size, mesh.name)?);
        Ok(Self { stiffness, mass, coupling, size })
    }
}

/// Unknown number (of x; y is the next) of each node; `usize::MAX` on the race.
pub(crate) fn number_unknowns(mesh: &FeGearMesh) -> Vec<usize> {
    let mut next = 0;
    let number = |held: &bool| {
        if *held {
            return usize::MAX;
        }
        next += 2;
        next - 2
    };
    mesh.on_race.iter().map(number).collect()
}
