//! Kinematic rest of a result (what linear kinematics about the reference leave out of the
//! approaches, by exact kinematics), and torques of the gears on carrier and ring.

use std::borrow::Cow;

use gearset::{DisplacedMesh, MeshKind};
use nalgebra::DVector;

use super::equilibrium::Equilibrium;
use super::placed::PlacedMesh;
use super::rest::larger;
use super::set::StaticSet;
use super::state::ThroughTorques;
use crate::contact::MeshTable;
use crate::error::FeError;

impl StaticSet<'_> {
    /// Pose of a mesh (front flanks) by exact kinematics, with the races at q (m) at a position
    /// (cycles).
    pub(crate) fn exact_pose(
        &self,
        mesh: usize,
        position: f64,
        q: &DVector<f64>,
    ) -> Result<DisplacedMesh, FeError> {
        let (found, _) = self.inputs().displaced(&self.nominal[mesh], q, 1.0)?;
        let unloaded = position - self.reference.lead() + self.nominal[mesh].offset;
        Ok(found.turned_by(unloaded))
    }

    /// Exact approaches of the pairs of a table beyond its own gaps, with the races at q (m), m.
    pub(crate) fn exact_approaches(
        &self,
        mesh: usize,
        placed: &PlacedMesh<'_>,
        position: f64,
        q: &DVector<f64>,
    ) -> Result<Vec<f64>, FeError> {
        let own = &self.reference.loaded[self.reference.meshes[mesh].group].mesh;
        let exact = self.exact_pose(mesh, position, q)?;
        // The table's phase is reduced to [0, 1): its pair 0 may have another number on the turning
        // gears.
        let whole = (exact.phase() - placed.phase).round();
        let exact = exact.turned_by(-whole);
        let inside = || FeError::NoEquilibrium("a corner dips below its mate's base circle".into());
        let still = own.displaced(placed.phase, &[0.0; 6]);
        let still = still.map_err(|cause| FeError::NoEquilibrium(cause.to_string()))?;
        placed
            .table
            .pairs
            .iter()
            .map(|pair| {
                let now = exact.clearance(own, pair.index).ok_or_else(inside)?;
                Ok(still.clearance(own, pair.index).ok_or_else(inside)? - now)
            })
            .collect()
    }

    /// Largest difference of a loaded pair's exact approach from its linear form, m; NaN where
    /// exact kinematics fail.
    pub(super) fn kinematic_rest(&self, found: &Equilibrium<'_>) -> f64 {
        let each =
            found.answers.iter().enumerate().take(self.nominal.len()).map(|(mesh, answer)| {
                let table = &found.meshes[mesh].table;
                self.rest_of_mesh(mesh, table, found.position, &found.q, &answer.pair_forces)
            });
        larger(each)
    }

    /// The same of one front mesh whose pairs carry `forces` (N).
    pub(crate) fn rest_of_mesh(
        &self,
        mesh: usize,
        table: &MeshTable,
        position: f64,
        q: &DVector<f64>,
        forces: &[f64],
    ) -> f64 {
        let mut rigid = self.place_one(mesh, Cow::Borrowed(table), position);
        rigid.open(q);
        let Ok(exact) = self.exact_approaches(mesh, &rigid, position, q) else { return f64::NAN };
        let pairs = exact.iter().zip(rigid.approaches(q)).zip(forces);
        larger(pairs.filter(|(_, p)| **p > 0.0).map(|((exact, linear), _)| (exact - linear).abs()))
    }

    /// Torques that the gears exert on carrier and ring.
    pub(super) fn reactions(&self, found: &Equilibrium<'_>) -> ThroughTorques {
        let mut ring = 0.0;
        for (which, (mesh, answer)) in found.meshes.iter().zip(&found.answers).enumerate() {
            if mesh.kind != MeshKind::RingPlanet {
                continue;
            }
            for (turn, force) in mesh.turns.iter().zip(&answer.pair_forces) {
                ring -= force * turn;
            }
            for bend in &mesh.bends {
                let moved = bend.moved(&found.q);
                ring += answer.pair_forces[bend.pair] * bend.curvature * moved * bend.turn;
            }
            // Loads from the slopes of the flanks, which only front meshes have.
            let Some(slopes) = found.slopes.get(which) else { continue };
            let pose = &self.reference.meshes[which];
            let by_roll_length = self.reference.loaded[pose.group].gradients.roll_length[5];
            let kappa = slopes.of_pairs.iter().zip(&answer.pair_forces);
            ring += by_roll_length * kappa.map(|(kappa, force)| kappa[0] * force).sum::<f64>();
            ring += by_roll_length * slopes.rest[0];
        }
        let carrier = self.races.carrier_torque(&found.q);
        ThroughTorques { carrier_nm: self.sign * carrier, ring_nm: self.sign * ring }
    }
}
