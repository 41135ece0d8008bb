//! One mesh of a set as it stands without load.

use gearset::MeshKind;

/// One mesh of the unloaded set.
#[derive(Debug, Clone)]
pub(super) struct NominalMesh {
    pub(super) kind: MeshKind,
    pub(super) planet: usize,
    /// Phase where planet 0's sun mesh is at phase 0, cycles.
    pub(super) offset: f64,
    /// The same of its backside flanks, whose phases run backwards.
    pub(super) backside_offset: f64,
}
