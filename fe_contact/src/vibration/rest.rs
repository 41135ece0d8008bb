//! The equilibrium a vibrating set starts from, on its own fidelity.

use dynamics::Motion;
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
        let position = self.position(self.step_in_cycle);
        let solver = &ActiveSet;
        let all = |list: &[crate::contact::MeshAnswer]| -> DVector<f64> {
            let forces = list.iter().flat_map(|a| a.pair_forces.iter().copied());
            DVector::from_vec(forces.collect())
        };
        self.external = self.statics.load(torque_nm);
        let f = self.external.clone();
        let tables = &self.tables.clone();
        let start = self.statics.reference().q.clone();
        let mut found = self.statics.equilibrium(&f, position, tables, Some(&start), solver)?;
        let level = self.leaning[self.step_in_cycle].rest_of(&self.statics);
        if torque_nm != 0.0 {
            // The slopes of the flanks are those of the reference's torque, as in every step.
            let leaning = &self.leaning[self.step_in_cycle];
            leaning.apply(&self.statics, &mut found.meshes);
            found.level = level.clone();
            self.statics.settle_bent(&f, &mut found, solver)?;
        }
        let has_backs = found.meshes.len() > 2 * self.statics.races.planets();
        let (mut q, mut p) = (found.q.clone(), all(&found.answers));
        let mut frame = self.take_frame(has_backs)?;
        // Bodies with a state of their own feel all meshes at once; the cells' compliance knows one
        // mesh alone.
        let across = self.across_meshes(&frame);
        if across.amax() > 0.0 && torque_nm != 0.0 {
            for _ in 0..30 {
                let shifted = &across * &p;
                let mut offsets = frame.perfect.iter().zip(shifted.iter());
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
        self.motion = Motion::at_rest(q.len());
        self.motion.x.copy_from_slice(q.as_slice());
        let offsets = frame.opened_at(q.as_slice());
        self.approaches = &frame.rigid * &q - offsets - &across * &p;
        self.bent = if torque_nm == 0.0 { level * 0.0 } else { &found.load - level };
        self.bearings.rest(self.carrier.as_mut(), &self.seat_stiffness, &q);
        self.fill_ports(&frame);
        for (gear, (ports, forces)) in self.work.ports.iter_mut().enumerate() {
            let own = &frame.own[gear];
            if self.gears[gear].vibrating.unknowns() == 0 {
                continue;
            }
            forces.clear();
            forces.extend(own.iter().map(|(pair, _)| p[*pair]));
            self.gears[gear].vibrating.rest_under(&ports[..own.len()], forces);
        }
        for (memory, mesh) in self.memory.iter_mut().zip(&frame.meshes) {
            let own = &p.as_slice()[mesh.first..mesh.first + mesh.count];
            let slots = &frame.slots[mesh.first..mesh.first + mesh.count];
            memory.rest(slots.iter().copied().zip(own.iter().copied()));
        }
        for mesh in &mut frame.meshes {
            let range = mesh.first..mesh.first + mesh.count;
            let delta = &self.approaches.as_slice()[range];
            let table = &self.tables.list[mesh.table];
            self.maps[mesh.table].find(table, delta, &mut mesh.held, solver)?;
        }
        self.forces = p;
        self.touched_back = has_backs;
        self.put_back(frame, has_backs);
        Ok(())
    }

    /// Static flexibility between pairs of different meshes, on bodies with a state of their own, m/N.
    fn across_meshes(&self, frame: &Frame) -> DMatrix<f64> {
        let mut across = frame.lagging.clone() + self.carried(frame);
        for mesh in &frame.meshes {
            across.view_mut((mesh.first, mesh.first), (mesh.count, mesh.count)).fill(0.0);
        }
        across
    }

    /// Static flexibility between pairs that the bodies' states carry, m/N.
    pub(super) fn carried(&self, frame: &Frame) -> DMatrix<f64> {
        let count = frame.offsets.len();
        let mut carried = DMatrix::zeros(count, count);
        for (gear, own) in self.gears.iter().zip(&frame.own) {
            if gear.vibrating.unknowns() == 0 {
                continue;
            }
            let of_gear = gear.vibrating.carried_flexibility(&self.ports_of(frame, gear, own));
            for (i, (a, _)) in own.iter().enumerate() {
                for (j, (b, _)) in own.iter().enumerate() {
                    carried[(*a, *b)] += of_gear[i * own.len() + j];
                }
            }
        }
        carried
    }
}
