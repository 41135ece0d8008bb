//! Slopes of the deformed flanks at the positions of a mesh cycle, in the equilibrium of the set.

use nalgebra::DVector;

use crate::complementarity::ActiveSet;
use crate::error::FeError;
use crate::statics::{PlacedMesh, SetTables, Slopes, StaticSet};

/// Slopes of the flanks of all meshes at one position, and the load that they leave on the races.
#[derive(Debug, Clone)]
pub(super) struct Leaning {
    /// Of each front mesh; none without load.
    slopes: Vec<Slopes>,
    /// Load on the races that depends on the position only, n, N: the rest of the gradient of the
    /// meshes' energy, ∂W/∂σ − κᵀP and the same for a', and Σ F̄ ∂²δ q_ref.
    pub(super) load: DVector<f64>,
}

impl Leaning {
    /// No slopes, and no load.
    pub(super) fn none(statics: &StaticSet<'_>) -> Self {
        Self { slopes: Vec::new(), load: DVector::zeros(statics.races.count) }
    }

    /// At each of the `positions` (cycles), in the equilibrium under the reference's torque; those that are `known` by
    /// the number of the position are taken over.
    pub(super) fn at<'k>(
        statics: &StaticSet<'_>,
        tables: &SetTables,
        positions: &[f64],
        known: &dyn Fn(usize) -> Option<&'k Self>,
    ) -> Result<Vec<Self>, FeError> {
        let reference = statics.reference();
        let turning = &reference.stiffness * &reference.q;
        let f = statics.load(reference.torque_nm);
        if reference.torque_nm > 0.0 {
            statics.lay_out_beside(tables)?;
        }
        let mut list = Vec::with_capacity(positions.len());
        let mut start = reference.q.clone();
        for (k, position) in positions.iter().enumerate() {
            if let Some(own) = known(k) {
                list.push(own.clone());
                continue;
            }
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

    /// Load that the slopes leave on the races, without Σ F̄ ∂²δ q_ref, n, N.
    pub(super) fn rest_of(&self, statics: &StaticSet<'_>) -> DVector<f64> {
        let reference = statics.reference();
        &self.load - &reference.stiffness * &reference.q
    }

    /// Includes the slopes in the rows of the front meshes at the position.
    pub(super) fn apply(&self, statics: &StaticSet<'_>, placed: &mut [PlacedMesh<'_>]) {
        let mut known = DVector::zeros(self.load.len());
        for (mesh, (own, slopes)) in placed.iter_mut().zip(&self.slopes).enumerate() {
            statics.lean(mesh, own, slopes, &mut known);
        }
    }
}
