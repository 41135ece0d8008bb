//! The equilibrium from which a vibrating set starts, with the bodies of its own fidelity.

use nalgebra::{DMatrix, DVector};

use super::frame::Frame;
use super::set::VibratingSet;
use crate::complementarity::ActiveSet;
use crate::error::FeError;

impl VibratingSet<'_> {
    /// Puts the set to rest under a torque on the sun (N m, magnitude) at its current position.
    ///
    /// # Errors
    /// If there is no equilibrium.
    pub fn rest(&mut self, torque_nm: f64) -> Result<(), FeError> {
        let position = self.clock.position(self.clock.step_in_cycle);
        let solver = &ActiveSet;
        let all = |list: &[crate::contact::MeshAnswer]| -> DVector<f64> {
            let forces = list.iter().flat_map(|a| a.pair_forces.iter().copied());
            DVector::from_vec(forces.collect())
        };
        self.external = self.statics.load(torque_nm);
        let f = self.external.clone();
        let tables = &self.contact.tables.clone();
        let start = self.statics.reference().q.clone();
        let mut found = self.statics.equilibrium(&f, position, tables, Some(&start), solver)?;
        let level = self.contact.leaning[self.clock.step_in_cycle].rest_of(&self.statics);
        if torque_nm != 0.0 {
            // The slopes of the flanks are those of the reference's torque, as in every step.
            let leaning = &self.contact.leaning[self.clock.step_in_cycle];
            leaning.apply(&self.statics, &mut found.meshes);
            found.level = level.clone();
            self.statics.settle_bent(&f, &mut found, solver)?;
        }
        let has_backside = found.meshes.len() > self.statics.meshes();
        let (mut q, mut p) = (found.q.clone(), all(&found.answers));
        let mut frame = self.take_frame(has_backside)?;
        // Bodies with elastic states couple their meshes; the compliance of the cells covers one
        // mesh only.
        let across = self.across_meshes(&frame);
        if across.amax() > 0.0 && torque_nm != 0.0 {
            for _ in 0..30 {
                let shifted = &across * &p;
                let mut offsets = frame.pattern.perfect.iter().zip(shifted.iter());
                for offset in found.meshes.iter_mut().flat_map(|m| m.offsets.iter_mut()) {
                    if let Some((nominal, shift)) = offsets.next() {
                        *offset = nominal + shift;
                    }
                }
                self.statics.settle_bent(&f, &mut found, solver)?;
                let next = all(&found.answers);
                let change = (&next - &p).amax();
                p = next;
                if change <= 1e-13 * p.amax() {
                    break;
                }
            }
            q = found.q.clone();
        }
        let offsets = frame.opened_at(q.as_slice());
        self.pairs.approaches = &frame.pattern.rigid * &q - offsets - &across * &p;
        self.pairs.bent = if torque_nm == 0.0 { level * 0.0 } else { &found.load - level };
        self.race_dynamics.rest(&mut self.bodies, &q);
        self.bodies.fill_ports(&frame, self.clock.cycles);
        self.bodies.rest_gears(&frame, &p);
        self.pairs.rest(&frame, &p);
        for mesh in &mut frame.meshes {
            let range = mesh.first..mesh.first + mesh.count;
            let delta = &self.pairs.approaches.as_slice()[range];
            let table = &self.contact.tables.list[mesh.table];
            self.contact.maps[mesh.table].find(table, delta, &mut mesh.held, solver)?;
        }
        self.pairs.forces = p;
        self.frames.touched_backside[self.clock.step_in_cycle] = has_backside;
        self.frames.put_back(self.clock.step_in_cycle, frame, has_backside);
        Ok(())
    }

    /// Static flexibility between pairs of different meshes, through bodies with elastic states,
    /// m/N.
    fn across_meshes(&self, frame: &Frame) -> DMatrix<f64> {
        let mut across = frame.lagging().clone() + self.bodies.carried(frame, self.clock.cycles);
        for mesh in &frame.meshes {
            across.view_mut((mesh.first, mesh.first), (mesh.count, mesh.count)).fill(0.0);
        }
        across
    }
}
