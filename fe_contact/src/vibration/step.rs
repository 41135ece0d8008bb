//! One time step: the bodies' predictions, contact of all pairs, and the bodies' state at the end.

use dynamics::Motion;
use nalgebra::DVector;

use super::combination::{Combination, StepVectors};
use super::frame::Frame;
use super::rotation::NominalRotation;
use super::set::VibratingSet;
use crate::complementarity::ActiveSet;
use crate::error::FeError;

/// Most Newton iterations of one step.
const MOST_ITERATIONS: usize = 60;

impl VibratingSet<'_> {
    /// One step; the external forces must be those at its end. After a step that fails the set is in the mesh cycle in
    /// which the step began, with a motion to be replaced.
    ///
    /// # Errors
    /// If contact cannot be solved, its cells do not suffice, or the motion diverges.
    pub fn step(&mut self) -> Result<(), FeError> {
        let cycles = self.clock.cycles;
        let done = self.step_on();
        if done.is_err() {
            self.clock.cycles = cycles;
        }
        done
    }

    fn step_on(&mut self) -> Result<(), FeError> {
        self.tick();
        let turned = self.clock.turned();
        self.work.load.copy_from(&self.external);
        self.work.load += &self.contact.leaning[self.clock.step_in_cycle].load;
        let (races, load) = (&self.statics.races, &mut self.work.load);
        self.bodies.predict(races, &self.race_dynamics.motion, turned, load);
        self.race_dynamics.add_history(&self.clock.rule, &mut self.work.history, load);
        self.race_dynamics.bearings.predict(
            &self.clock.rule,
            self.bodies.carrier.as_ref(),
            &mut self.work.load,
        );
        if self.contact.grid.is_some() {
            let frame = self.exact_contact()?;
            self.check(&frame)?;
            self.finish(&frame, turned);
            self.frames.touched_backside[self.clock.step_in_cycle] = false;
            self.frames.put_back(self.clock.step_in_cycle, frame, false);
            self.counts.steps += 1;
            return Ok(());
        }
        let mut with_backside = false;
        let mut frame = self.take_frame(false)?;
        self.bend(&mut frame);
        self.solve_contact(&mut frame)?;
        if self.statics.backside_touches(&self.work.x) {
            self.frames.put_back(self.clock.step_in_cycle, frame, false);
            with_backside = true;
            frame = self.take_frame(true)?;
            self.bend_again(&mut frame);
            self.solve_contact(&mut frame)?;
            self.counts.with_backside += 1;
        }
        self.check(&frame)?;
        self.finish(&frame, turned);
        self.frames.touched_backside[self.clock.step_in_cycle] = with_backside;
        self.frames.put_back(self.clock.step_in_cycle, frame, with_backside);
        self.counts.steps += 1;
        Ok(())
    }

    /// Second-order terms of corner gaps at the displacements of the races and the pair forces P
    /// expected at the end of the step: the gaps open by ½ G'' Δe², and P G'' Δe ∂e is added to the
    /// load on the races.
    ///
    /// The term is some thousandths of the stiffness of a mesh. Extrapolation of the order of the
    /// time step suffices, without iteration.
    fn bend(&mut self, frame: &mut Frame) {
        let h = self.clock.rule.step();
        let Motion { x, v, a } = &self.race_dynamics.motion;
        let each = self.work.expected.iter_mut().zip(x).zip(v).zip(a);
        each.for_each(|(((e, x), v), a)| *e = x + h * (v + 0.5 * h * a));
        self.pairs.bent.fill(0.0);
        for bend in &mut frame.bends {
            let moved = bend.row.dot(&self.work.expected) - bend.offset;
            bend.moved = moved;
            bend.opened = 0.5 * bend.curvature * moved * moved;
            bend.force = self.pairs.memory[bend.mesh].expected(bend.slot);
            if bend.force > 0.0 {
                let pressed = bend.force * bend.curvature * moved;
                bend.row.add_to(pressed, self.pairs.bent.as_mut_slice());
            }
        }
        self.work.load += &self.pairs.bent;
    }

    /// The same for a frame with backside flanks, for which the load on the races was already
    /// added.
    fn bend_again(&mut self, frame: &mut Frame) {
        for bend in &mut frame.bends {
            bend.moved = bend.row.dot(&self.work.expected) - bend.offset;
            bend.opened = 0.5 * bend.curvature * bend.moved * bend.moved;
        }
    }

    /// Advances the clock, and renumbers the pairs in the lag of meshes whose phase starts again at
    /// 0.
    fn tick(&mut self) {
        self.clock.tick();
        if let NominalRotation::Turning { .. } = self.clock.rotation {
            self.pairs.restart(self.clock.step_in_cycle);
        }
    }

    /// Solves for the pairs' forces and the races' displacements.
    ///
    /// `[eq:contact-step]` δ = b − Y P, P = S δ + P₀ on the cells that touch, with b from the state at the start of
    /// the step.
    /// Source: derived here.
    /// Checked by: `fe_contact/tests/vibration.rs::newmark_is_of_second_order_with_and_without_lag`,
    /// `fe.stepping.energy`.
    pub(super) fn solve_contact(&mut self, frame: &mut Frame) -> Result<(), FeError> {
        let count = frame.offsets.len();
        self.bodies.fill_ports(frame, self.clock.cycles);
        let work = &mut self.work;
        // Positions differ in their number of pairs: the vectors are sized for the largest.
        if work.b.len() < count {
            work.b = DVector::zeros(count);
            work.next = DVector::zeros(count);
        }
        self.pairs.fit(count);
        // b = elastic − offsets − lagging · known
        work.b.iter_mut().zip(&frame.offsets).for_each(|(b, offset)| *b = -offset);
        for bend in &frame.bends {
            work.b[bend.pair] -= bend.opened;
        }
        for ((gear, own), (ports, _)) in
            self.bodies.gears.iter().zip(&frame.pattern.own).zip(&self.bodies.ports)
        {
            if gear.vibrating.unknowns() > 0 {
                for ((pair, _), port) in own.iter().zip(ports) {
                    work.b[*pair] += gear.vibrating.free(port);
                }
            }
        }
        let mut lags = frame.lags();
        for (memory, mesh) in self.pairs.memory.iter().zip(&frame.meshes) {
            let lagged = &mut work.b.as_mut_slice()[frame.lagged_by(mesh)];
            for slot in &frame.pattern.slots[mesh.first..mesh.first + mesh.count] {
                let known = memory.known(&self.pairs.lag, *slot);
                let column;
                (column, lags) = lags.split_at(lagged.len());
                lagged.iter_mut().zip(column).for_each(|(b, f)| *b -= f * known);
            }
        }
        let b = &work.b.as_slice()[..count];
        let approaches = &mut self.pairs.approaches.as_mut_slice()[..count];
        let forces = &mut self.pairs.forces.as_mut_slice()[..count];
        if frame.meshes.iter().any(|mesh| mesh.map(&self.contact.maps).is_none()) {
            // First guess at a position not visited before, or for a mesh whose map was replaced:
            // the forces that the last two steps lead to.
            forces.fill(0.0);
            for (memory, mesh) in self.pairs.memory.iter().zip(&frame.meshes) {
                let own = mesh.first..mesh.first + mesh.count;
                let slots = frame.pattern.slots[own.clone()].iter();
                forces[own].iter_mut().zip(slots).for_each(|(p, slot)| *p = memory.expected(*slot));
            }
            // A x = L − Rᵀ P,  δ = R x + b − E P
            work.left.copy_from(&work.load);
            for (row, force) in frame.rows().iter().zip(&*forces) {
                row.add_to(-force, work.left.as_mut_slice());
            }
            work.x.fill(0.0);
            self.race_dynamics.inverse.add_product(work.left.as_slice(), work.x.as_mut_slice());
            for ((delta, b), row) in approaches.iter_mut().zip(b).zip(frame.rows()) {
                *delta = b + row.dot(work.x.as_slice());
            }
            let (factor, mut columns) = frame.excess();
            for group in frame.groups() {
                for force in &forces[group.clone()] {
                    let column;
                    (column, columns) = columns.split_at(group.len());
                    let yielded = factor * force;
                    let of_group = approaches[group.clone()].iter_mut().zip(column);
                    of_group.for_each(|(delta, e)| *delta -= e * yielded);
                }
            }
            self.contact.find_lost(frame, approaches)?;
        }
        let mut residual = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
            let known = combination(frame, &mut work.ids);
            let place = match known {
                Some(place) => place,
                None => {
                    let (maps, races) = (&self.contact.maps, &self.race_dynamics.stiffness);
                    let made =
                        Combination::new(frame, maps, &work.ids, races, &mut work.combining)?;
                    let Some(made) = made else {
                        // Meshes that share a table: the map of one was replaced by that of
                        // another.
                        self.contact.find_lost(frame, approaches)?;
                        continue;
                    };
                    self.counts.combinations += 1;
                    frame.keep(made)
                }
            };
            self.counts.solutions += 1;
            let vectors = StepVectors {
                load: work.load.as_slice(),
                b,
                left: work.left.as_mut_slice(),
                x: work.x.as_mut_slice(),
                approaches: &mut work.next.as_mut_slice()[..count],
                forces: &mut *forces,
            };
            frame.combinations[place].solve(frame, vectors);
            // From iteration 12 on, half of the step is taken, in case contact sets alternate.
            let part = if iteration < 12 { 1.0 } else { 0.5 };
            residual = 0.0;
            for (delta, next) in approaches.iter_mut().zip(&work.next) {
                let change = next - *delta;
                residual = residual.max(change.abs());
                *delta = if part == 1.0 { *next } else { *delta + part * change };
            }
            let mut all_hold = part == 1.0 || residual < 1e-14;
            for mesh in &mut frame.meshes {
                let delta = &approaches[mesh.first..mesh.first + mesh.count];
                let maps = &mut self.contact.maps[mesh.table];
                if !maps.holds(&mut mesh.held, delta) {
                    maps.find(
                        &self.contact.tables.list[mesh.table],
                        delta,
                        &mut mesh.held,
                        &ActiveSet,
                    )?;
                    all_hold = false;
                }
            }
            if all_hold {
                frame.used = place;
                approaches.copy_from_slice(&work.next.as_slice()[..count]);
                return Ok(());
            }
        }
        Err(FeError::NotConverged { iterations: MOST_ITERATIONS, residual })
    }

    /// Refuses patches beyond their grids, deflections beyond the window of the tables, and
    /// divergence.
    fn check(&self, frame: &Frame) -> Result<(), FeError> {
        let bound = self.statics.bodies.geometry.largest_displacement();
        for (i, x) in self.work.x.iter().enumerate() {
            if x.is_nan() || x.abs() > bound {
                return Err(self.statics.races.diverged(self.time(), i, *x));
            }
        }
        for mesh in &frame.meshes {
            let table = &self.contact.tables.list[mesh.table];
            if let Some(pair) = mesh.map(&self.contact.maps).and_then(|map| map.overflows) {
                let (cells, force_n) = (&table.pairs[pair], self.pairs.forces[mesh.first + pair]);
                if force_n > 0.0 {
                    let reach_mm = 0.5e3 * cells.length;
                    let (phase, pair) = (table.phase, cells.index);
                    return Err(FeError::GridOverflow { phase, pair, reach_mm, force_n });
                }
            }
            let own = &self.pairs.approaches.as_slice()[mesh.first..mesh.first + mesh.count];
            let deepest = own.iter().fold(0.0f64, |a, d| a.max(*d));
            if deepest >= table.next_gap {
                return Err(FeError::NoEquilibrium(format!(
                    "a mesh gives way by {:.1} µm, beyond the window for tip contact of {:.1} µm",
                    deepest * 1e6,
                    table.next_gap * 1e6
                )));
            }
        }
        Ok(())
    }

    /// Ends the step.
    fn finish(&mut self, frame: &Frame, turned: f64) {
        let (races, x) = (&self.statics.races, &self.work.x);
        self.bodies.finish_gears(races, x, turned, frame, &self.pairs.forces);
        self.race_dynamics.finish(races, &self.clock.rule, &mut self.bodies, x);
        self.pairs.advance(frame);
    }
}

/// Index of the combination of the present maps, if it was solved before; `ids` receives the maps'
/// ids.
fn combination(frame: &Frame, ids: &mut Vec<u64>) -> Option<usize> {
    ids.clear();
    ids.extend(frame.meshes.iter().map(|mesh| mesh.held.id()));
    frame.combinations.iter().position(|c| c.maps == *ids)
}
