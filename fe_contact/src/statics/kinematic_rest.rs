//! Kinematic rest of a result (what linear kinematics about the reference leave out of the
//! approaches, by exact kinematics), and torques of the gears on carrier and ring.

use std::borrow::Cow;

use gearset::{DisplacedMesh, MeshKind};
use nalgebra::DVector;

use super::equilibrium::Equilibrium;
use super::placed::{Bend, PlacedMesh};
use super::rest::larger;
use super::set::StaticSet;
use super::state::ThroughTorques;
use crate::contact::MeshTable;
use crate::error::FeError;

/// A front mesh at one position by linear kinematics about the reference: what is the same with every motion through
/// the position.
#[derive(Debug)]
pub(crate) struct LinearMesh {
    mesh: usize,
    /// Mesh cycles.
    position: f64,
    /// Phase of its table.
    phase: f64,
    pairs: Vec<LinearPair>,
    /// Second-order terms of the gaps of pairs in corner contact.
    bends: Vec<Bend>,
}

/// A pair of such a mesh.
#[derive(Debug)]
struct LinearPair {
    index: i64,
    /// Approach b·q − offset on the races' coordinates.
    row: DVector<f64>,
    /// m.
    offset: f64,
    /// Clearance of the undisplaced flanks by exact kinematics, m.
    clearance: f64,
}

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

    /// Largest difference of a loaded pair's exact approach from its linear form, m; NaN where
    /// exact kinematics fail.
    pub(super) fn kinematic_rest(&self, found: &Equilibrium<'_>) -> f64 {
        let each =
            found.answers.iter().enumerate().take(self.nominal.len()).map(|(mesh, answer)| {
                let table = &found.meshes[mesh].table;
                let linear = self.linear_mesh(mesh, table, found.position);
                let linear = linear.as_ref().ok();
                linear.map_or(f64::NAN, |own| self.rest_of_mesh(own, &found.q, &answer.pair_forces))
            });
        larger(each)
    }

    /// A front mesh on a table at a position (cycles) by linear kinematics about the reference.
    ///
    /// # Errors
    /// If a corner dips below its mate's base circle.
    pub(crate) fn linear_mesh(
        &self,
        mesh: usize,
        table: &MeshTable,
        position: f64,
    ) -> Result<LinearMesh, FeError> {
        let own = &self.reference.loaded[self.reference.meshes[mesh].group].mesh;
        let inside = || FeError::NoEquilibrium("a corner dips below its mate's base circle".into());
        let still = own.displaced(table.phase, &[0.0; 6]);
        let still = still.map_err(|cause| FeError::NoEquilibrium(cause.to_string()))?;
        let PlacedMesh { rows, offsets, bends, .. } =
            self.place_one(mesh, Cow::Borrowed(table), position);
        let pairs = table.pairs.iter().zip(rows).zip(offsets).map(|((pair, row), offset)| {
            let clearance = still.clearance(own, pair.index).ok_or_else(inside)?;
            Ok(LinearPair { index: pair.index, row, offset, clearance })
        });
        let pairs = pairs.collect::<Result<_, FeError>>()?;
        Ok(LinearMesh { mesh, position, phase: table.phase, pairs, bends })
    }

    /// Largest difference of a loaded pair's exact approach from its linear form, with the races at q (m) and `forces`
    /// (N) on the pairs of one front mesh, m; NaN where exact kinematics fail.
    pub(crate) fn rest_of_mesh(
        &self,
        linear: &LinearMesh,
        q: &DVector<f64>,
        forces: &[f64],
    ) -> f64 {
        let LinearMesh { mesh, position, phase, pairs, bends } = linear;
        let own = &self.reference.loaded[self.reference.meshes[*mesh].group].mesh;
        let Ok(exact) = self.exact_pose(*mesh, *position, q) else { return f64::NAN };
        // The table's phase is reduced to [0, 1): its pair 0 may have another number on the turning
        // gears.
        let whole = (exact.phase() - phase).round();
        let exact = exact.turned_by(-whole);
        let opened = |k: usize| {
            let own = bends.iter().filter(|bend| bend.pair == k);
            own.map(|bend| 0.5 * bend.curvature * bend.moved(q).powi(2)).sum::<f64>()
        };
        larger(pairs.iter().zip(forces).enumerate().map(|(k, (pair, force))| {
            let Some(clearance) = exact.clearance(own, pair.index) else { return f64::NAN };
            if *force <= 0.0 {
                return 0.0;
            }
            // An approach beyond the table's own gaps, exactly and as b·q − offset − ½ G'' Δe².
            let approach = pair.clearance - clearance;
            (approach - (pair.row.dot(q) - pair.offset - opened(k))).abs()
        }))
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
