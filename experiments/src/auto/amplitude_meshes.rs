//! Meshes of the candidates for an amplitude, and by how much each is off.

/// Elements along a flank, those next to it divided, and contact cells of a tooth pair, from coarse to fine. FE/contact refuses 20 cells for one set in
/// five, because too few of them carry a load, and 30 for none of 113.
pub(super) const MESHES: [(u32, u32); 3] = [(6, 30), (8, 30), (12, 30)];

/// Error of an amplitude by elements and cells: as a relative change of the stiffness of the meshes, and by how teeth pass from element to element and from
/// cell to cell, over the deflection of a mesh. 95 % of the development sets are within both, added by squares (`docs/auto.md`).
const ERRORS: [[f64; 2]; MESHES.len()] = [[0.007, 0.8e-4], [0.003, 0.9e-4], [0.0015, 0.9e-4]];

/// δk/k by the elements of a mesh, as it changes a motion.
pub(super) fn of_elements(mesh: usize) -> f64 {
    ERRORS[mesh][0]
}

/// What a mesh changes an excitation by besides that of the stiffness, over the deflection of a mesh of teeth.
pub(super) fn unevenness(mesh: usize) -> f64 {
    ERRORS[mesh][1]
}
