//! Slopes of the deformed flanks at the positions of a mesh cycle, as the set's equilibrium deforms them.

use nalgebra::DVector;

use crate::complementarity::ActiveSet;
use crate::error::FeError;
use crate::statics::{PlacedMesh, SetTables, Slopes, StaticSet};

/// What the slopes of the flanks put into a set's rows at one position, and leave on its races.
#[derive(Debug, Clone)]
pub(super) struct Leaning {
    /// Of each front mesh; none without load.
    slopes: Vec<Slopes>,
    /// Loads that stay with the position: what the slopes leave of the gradient of the meshes' energy, and
    /// what the turning of their forces takes from the reference, n, N.
    pub(super) load: DVector<f64>,
}

impl Leaning {
    /// Nothing.
    pub(super) fn none(statics: &StaticSet<'_>) -> Self {
        Self { slopes: Vec::new(), load: DVector::zeros(statics.races.count) }
    }

    /// At every one of some positions (cycles), in the equilibrium under the reference's torque.
    pub(super) fn at(
        statics: &StaticSet<'_>,
        tables: &SetTables,
        positions: &[f64],
    ) -> Result<Vec<Self>, FeError> {
        let reference = statics.reference();
        let turning = &reference.stiffness * &reference.q;
        let f = statics.load(reference.torque_nm);
        if reference.torque_nm > 0.0 {
            statics.lay_out_beside(tables)?;
        }
        let mut list = Vec::with_capacity(positions.len());
        let mut start = reference.q.clone();
        for position in positions {
            let mut load = turning.clone();
            let mut slopes: Vec<Slopes> = Vec::new();
            if reference.torque_nm > 0.0 {
                let solver = &ActiveSet;
                let mut found = statics.equilibrium(&f, *position, tables, Some(&start), solver)?;
                statics.lean_all(&f, tables, &mut found, solver)?;
                load += &found.level;
                (slopes, start) = (found.slopes, found.q);
            }
            list.push(Self { slopes, load });
        }
        Ok(list)
    }

    /// What the slopes leave on the races without the turning of the forces, n, N.
    pub(super) fn rest_of(&self, statics: &StaticSet<'_>) -> DVector<f64> {
        let reference = statics.reference();
        &self.load - &reference.stiffness * &reference.q
    }

    /// Puts the slopes into the rows of the front meshes at the position.
    pub(super) fn apply(&self, statics: &StaticSet<'_>, placed: &mut [PlacedMesh<'_>]) {
        let mut known = DVector::zeros(self.load.len());
        for (mesh, (own, slopes)) in placed.iter_mut().zip(&self.slopes).enumerate() {
            statics.lean(mesh, own, slopes, &mut known);
        }
    }
}
