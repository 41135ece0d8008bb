//! The [symmetry](Symmetry) after a part of a mesh cycle, found in the equations of a set: frames, loads and the matrix
//! of a step must be equal under the renumbering.
//!
//! The map of a part, with the renumbering, then has the same periodic motion as that of the whole cycle.

use std::sync::Arc;

use gearset::Symmetry;
use nalgebra::{DMatrix, DVector};

use super::frame_pattern::FramePattern;
use super::set::VibratingSet;
use crate::error::FeError;

/// Largest difference of equal quantities, relative to the largest of their kind: they come from equilibria that are
/// iterated to about 1e-12.
const EQUAL: f64 = 1e-9;

impl VibratingSet<'_> {
    /// The symmetry with the most parts, if the set has one and no modes: these turn with the gears.
    ///
    /// # Errors
    /// If a position of the meshes cannot be computed.
    pub fn symmetry(&mut self) -> Result<Option<Symmetry>, FeError> {
        if let Some(known) = self.symmetry {
            return Ok(known);
        }
        let found = self.find_symmetry()?;
        self.symmetry = Some(found);
        Ok(found)
    }

    /// Of those of the positions, the first that the races have too.
    fn find_symmetry(&mut self) -> Result<Option<Symmetry>, FeError> {
        if !self.has_derivative() || self.elastic_unknowns() > 0 {
            return Ok(None);
        }
        let of_positions = self.patterns.symmetries(|| self.symmetries_of_positions())?;
        let has = |own: &&Symmetry| {
            self.renumbering(&self.internal(own)).is_some_and(|turn| self.races_are_kept(&turn))
        };
        Ok(of_positions.iter().find(has).copied())
    }

    /// The symmetries under which the meshes and loads at all positions are those of a part of the cycle, by number of
    /// parts and shift.
    fn symmetries_of_positions(&self) -> Result<Vec<Symmetry>, FeError> {
        let (sign, races) = (self.statics.sign(), &self.statics.races);
        let count = self.clock.rotation.count();
        let (mut patterns, mut found) = (Vec::new(), Vec::new());
        // The races are those of counter-clockwise torque: mirrored, if that on the sun is clockwise.
        for internal in Symmetry::candidates(&races.psi, count) {
            let own = internal.seen_with(sign);
            if !self.phases_fit(&own) {
                continue;
            }
            if patterns.is_empty() {
                for k in 0..count {
                    patterns.push(self.shared_pattern(k)?);
                }
            }
            let turn = self.renumbering(&internal);
            if turn.is_some_and(|turn| self.positions_are_kept(&own, &turn, &patterns)) {
                found.push(own);
            }
        }
        Ok(found)
    }

    /// A symmetry in the frame of the races, which is mirrored if the torque on the sun is clockwise.
    fn internal(&self, own: &Symmetry) -> Symmetry {
        own.seen_with(self.statics.sign())
    }

    /// Whether after a part the meshes of the planets `shift` further on have the phases of these at its start.
    fn phases_fit(&self, own: &Symmetry) -> bool {
        let (planets, count) = (self.statics.races.planets(), self.clock.rotation.count());
        let part = count / own.parts;
        let later = |mesh: usize| own.later(mesh, planets);
        (0..count).all(|k| {
            let after = (k + part) % count;
            let restarts = |k: usize, mesh: usize| self.pairs.restarts[k].contains(&mesh);
            (0..2 * planets).all(|mesh| {
                let phase =
                    |mesh: usize, k: usize| self.statics.phase(mesh, self.clock.position(k));
                let off = phase(later(mesh), after) - phase(mesh, k);
                (off - off.round()).abs() < EQUAL
                    && restarts(after, later(mesh)) == restarts(k, mesh)
            })
        })
    }

    /// `[eq:symmetry-after-a-part]` x_{n+s}(t + T/p) = x_n(t) of planets shifted by s after one of p parts; with R,
    /// or P for the internal, possibly mirrored frame, that renumbers them at the end of a part, DΦ = (R DΦ_part)^p.
    ///
    /// Source: derived here.
    /// Checked by: `experiments/tests/shooting/symmetry.rs::parts_of_a_cycle_are_the_whole_of_symmetric_sets`,
    /// `experiments/tests/shooting/symmetry.rs::multipliers_of_parts_are_those_of_the_whole`.
    fn renumbering(&self, internal: &Symmetry) -> Option<DMatrix<f64>> {
        let races = &self.statics.races;
        let entries = internal.renumbering(races.planets(), |body, axis| races.of(body, axis))?;
        let mut turn = DMatrix::zeros(races.count, races.count);
        entries.into_iter().for_each(|(i, j, value)| turn[(i, j)] = value);
        Some(turn)
    }

    /// Whether the equations of the races, at this speed and under this load, are equal under the renumbering.
    fn races_are_kept(&self, turn: &DMatrix<f64>) -> bool {
        let dynamics = &self.race_dynamics;
        let commutes = |a: &DMatrix<f64>| (turn * a - a * turn).amax() <= EQUAL * a.amax();
        let load = dynamics.velocity_load(&self.clock.rule);
        let mass = DMatrix::from_diagonal(&DVector::from_column_slice(&dynamics.mass));
        let is_kept = |x: &DVector<f64>| (turn * x - x).amax() <= EQUAL * x.amax();
        [&dynamics.stiffness.full(), &load, &mass].into_iter().all(commutes)
            && is_kept(&self.external)
    }

    /// Whether the meshes and their loads at all positions are equal under the renumbering.
    fn positions_are_kept(
        &self,
        own: &Symmetry,
        turn: &DMatrix<f64>,
        patterns: &[Arc<FramePattern>],
    ) -> bool {
        let (planets, count) = (self.statics.races.planets(), patterns.len());
        let scale = patterns.iter().flat_map(|p| &p.offsets).fold(0.0f64, |a, o| a.max(o.abs()));
        let loads = self.contact.leaning.iter().map(|leaning| leaning.load.amax());
        let heaviest = loads.fold(0.0, f64::max);
        (0..count).all(|k| {
            let after = (k + count / own.parts) % count;
            let (here, there) = (&patterns[k], &patterns[after]);
            let [now, then] = [k, after].map(|k| &self.contact.leaning[k].load);
            (turn * then - now).amax() <= EQUAL * heaviest
                && (0..2 * planets).all(|mesh| {
                    let (a, b) = (&here.meshes[mesh], &there.meshes[own.later(mesh, planets)]);
                    a.count == b.count
                        && (0..a.count).all(|pair| {
                            let (i, j) = (a.first + pair, b.first + pair);
                            let row = turn * there.rigid.row(j).transpose();
                            here.slots[i] == there.slots[j]
                                && (here.offsets[i] - there.offsets[j]).abs() <= EQUAL * scale
                                && (row - here.rigid.row(i).transpose()).amax() <= EQUAL
                        })
                })
        })
    }

    /// P of the present symmetry.
    pub(super) fn present_renumbering(&self) -> Option<(Symmetry, DMatrix<f64>)> {
        let own = self.symmetry.flatten()?;
        Some((own, self.renumbering(&self.internal(&own))?))
    }

    /// Ends a part of a cycle that began at position 0: the set stands at position 0 again, its planets renumbered.
    /// Nothing happens if the set has no symmetry.
    ///
    /// # Errors
    /// If the meshes at position 0 cannot be computed.
    pub fn take_part_back(&mut self) -> Result<(), FeError> {
        let Some((own, turn)) = self.present_renumbering() else { return Ok(()) };
        if self.clock.step_in_cycle * own.parts != self.clock.rotation.count() {
            return Ok(());
        }
        self.renumber_forces(&own)?;
        let motion = &mut self.race_dynamics.motion;
        for list in [&mut motion.x, &mut motion.v, &mut motion.a] {
            let turned = &turn * DVector::from_column_slice(list);
            list.copy_from_slice(turned.as_slice());
        }
        let planets = self.statics.races.planets();
        let memory = (0..self.pairs.memory.len())
            .map(|mesh| self.pairs.memory[own.later(mesh, planets)].clone());
        self.pairs.memory = memory.collect();
        self.follow_bearings();
        Ok(())
    }

    /// Goes to position 0 with the forces of the pairs, as they are there those of renumbered planets.
    fn renumber_forces(&mut self, own: &Symmetry) -> Result<(), FeError> {
        let end = std::mem::take(&mut self.clock.step_in_cycle);
        let Some(frame) = self.frames.current(end) else { return Ok(()) };
        let planets = self.statics.races.planets();
        let ranges: Vec<_> = (0..frame.meshes.len())
            .map(|mesh| &frame.meshes[own.later(mesh, planets)])
            .map(|mesh| mesh.first..mesh.first + mesh.count)
            .collect();
        for list in [&mut self.pairs.forces, &mut self.pairs.approaches] {
            let old = list.clone();
            let renumbered = ranges.iter().flat_map(|own| old.as_slice()[own.clone()].iter());
            list.iter_mut().zip(renumbered).for_each(|(new, old)| *new = *old);
        }
        let with_backside = self.frames.touched_backside[end];
        let frame = self.take_frame(with_backside)?;
        self.frames.touched_backside[0] = with_backside;
        self.frames.put_back(0, frame, with_backside);
        Ok(())
    }
}
