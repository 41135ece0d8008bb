//! One time step: the bodies' predictions, contact of all pairs, the bodies' answers.

use dynamics::Motion;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::body::RaceMotion;
use super::frame::{Combination, Frame};
use super::gear::Gear;
use super::packed::Packed;
use super::set::{Loads, Motive, VibratingSet, Work};
use crate::complementarity::ActiveSet;
use crate::contact::ContactMaps;
use crate::error::FeError;
use crate::statics::{CARRIER, Races, SetTables};

/// Newton iterations of one step before it is given up.
const MOST_ITERATIONS: usize = 60;

/// Displacements above this (m) are no vibration of a gear set.
const BOUND: f64 = 1e-2;

impl VibratingSet<'_> {
    /// One step; the external forces must be those at its end.
    ///
    /// # Errors
    /// If contact cannot be solved, its cells do not suffice, or the motion diverges.
    pub fn step(&mut self) -> Result<(), FeError> {
        self.tick();
        let turned = self.turned();
        self.work.load.copy_from(&self.external);
        self.work.load += &self.leaning[self.step_in_cycle].load;
        let race = self.race(CARRIER);
        let own = self.carrier.predict(&race, 0.0);
        add_of(&self.statics.races, CARRIER, own, &mut self.work.load);
        self.predict_gears(turned);
        self.motion.velocity_history(&self.rule, &mut self.work.history);
        for (i, v) in self.work.history.iter().enumerate() {
            self.work.load[i] += self.bearing_ratio * self.supports[i] * v;
        }
        if let Some([g, _]) = &self.gyroscopic {
            for (i, row) in g.row_iter().enumerate() {
                self.work.load[i] +=
                    row.iter().zip(&self.work.history).map(|(g, v)| g * v).sum::<f64>();
            }
        }
        self.bearings.predict(&self.rule, self.carrier.as_ref(), &mut self.work.load);
        if self.grid.is_some() {
            let frame = self.exact_contact()?;
            self.check(&frame)?;
            self.finish(&frame, turned);
            self.touched_back = false;
            self.put_back(frame, false);
            self.counts.steps += 1;
            return Ok(());
        }
        let mut with_backs = false;
        let mut frame = self.take_frame(false)?;
        self.bend(&mut frame);
        self.free_races();
        self.contact(&mut frame)?;
        if self.statics.backs_touch(&self.work.x) {
            self.put_back(frame, false);
            with_backs = true;
            frame = self.take_frame(true)?;
            self.bend_again(&mut frame);
            self.contact(&mut frame)?;
            self.counts.with_backs += 1;
        }
        self.check(&frame)?;
        self.finish(&frame, turned);
        self.touched_back = with_backs;
        self.put_back(frame, with_backs);
        self.counts.steps += 1;
        Ok(())
    }

    /// The bends of gaps at corners where the races and the pairs' forces P are expected at the end of the
    /// step: what they open the gaps by, and P G'' Δe ∂e on the races.
    ///
    /// The term is some thousandths of a mesh's stiffness; expected to the order of the step it needs no
    /// iteration.
    fn bend(&mut self, frame: &mut Frame) {
        let h = self.rule.step();
        let Motion { x, v, a } = &self.motion;
        let each = self.work.expected.iter_mut().zip(x).zip(v).zip(a);
        each.for_each(|(((e, x), v), a)| *e = x + h * (v + 0.5 * h * a));
        self.bent.fill(0.0);
        for bend in &mut frame.bends {
            let moved = bend.row.dot(&self.work.expected) - bend.offset;
            bend.opened = 0.5 * bend.curvature * moved * moved;
            let force = self.memory[bend.mesh].expected(bend.slot);
            if force > 0.0 {
                let pressed = force * bend.curvature * moved;
                bend.row.add_to(pressed, self.bent.as_mut_slice());
            }
        }
        self.work.load += &self.bent;
    }

    /// The same for a frame with back flanks, the loads being in already.
    fn bend_again(&mut self, frame: &mut Frame) {
        for bend in &mut frame.bends {
            let moved = bend.row.dot(&self.work.expected) - bend.offset;
            bend.opened = 0.5 * bend.curvature * moved * moved;
        }
    }

    /// Displacements of the races under `work.load` alone.
    pub(super) fn free_races(&mut self) {
        self.work.free.fill(0.0);
        let Work { load, free, .. } = &mut self.work;
        self.packed_inverse.add_product(load.as_slice(), free.as_mut_slice());
    }

    /// Starts the step of all gears; large ones side by side, which changes no bit.
    fn predict_gears(&mut self, turned: f64) {
        for k in 0..self.gears.len() {
            self.work.started[k].0 = self.race(k + 1);
        }
        let one = |(gear, (race, load)): (&mut Gear<'_>, &mut (RaceMotion, [f64; 3]))| {
            let angle = gear.angle(turned);
            *load = gear.vibrating.predict(race, angle);
        };
        if self.is_large {
            self.gears.par_iter_mut().zip(&mut self.work.started).for_each(one);
        } else {
            self.gears.iter_mut().zip(&mut self.work.started).for_each(one);
        }
        for (k, (_, load)) in self.work.started.iter().enumerate() {
            add_of(&self.statics.races, k + 1, *load, &mut self.work.load);
        }
    }

    /// Moves the clock on, and the memories of meshes whose phase starts anew.
    fn tick(&mut self) {
        self.steps += 1;
        if let Motive::Turning { steps_per_cycle, .. } = self.motive {
            self.step_in_cycle += 1;
            if self.step_in_cycle == steps_per_cycle {
                self.step_in_cycle = 0;
                self.cycles += 1;
            }
            for mesh in &self.restarts[self.step_in_cycle] {
                self.memory[*mesh].move_on();
            }
        }
    }

    /// Solves for the pairs' forces and the races' displacements.
    pub(super) fn contact(&mut self, frame: &mut Frame) -> Result<(), FeError> {
        let count = frame.offsets.len();
        self.fill_ports(frame);
        let work = &mut self.work;
        // Positions differ in their number of pairs: the vectors fit the largest.
        if work.b.len() < count {
            work.b = DVector::zeros(count);
        }
        if self.forces.len() < count {
            self.forces = DVector::zeros(count);
            self.approaches = DVector::zeros(count);
        }
        // b = rows · x_free + elastic − offsets − lagging · known
        for ((b, row), offset) in work.b.iter_mut().zip(&frame.rows).zip(&frame.offsets) {
            *b = row.dot(work.free.as_slice()) - offset;
        }
        for bend in &frame.bends {
            work.b[bend.pair] -= bend.opened;
        }
        for ((gear, own), (ports, _)) in self.gears.iter().zip(&frame.own).zip(&work.ports) {
            if gear.vibrating.unknowns() > 0 {
                for ((pair, _), port) in own.iter().zip(ports) {
                    work.b[*pair] += gear.vibrating.free(port);
                }
            }
        }
        let mut lags = frame.lags.as_slice();
        for (memory, mesh) in self.memory.iter().zip(&frame.meshes) {
            let lagged = &mut work.b.as_mut_slice()[frame.lagged_by(mesh)];
            for slot in &frame.slots[mesh.first..mesh.first + mesh.count] {
                let known = memory.known(&self.lag, *slot);
                let column;
                (column, lags) = lags.split_at(lagged.len());
                lagged.iter_mut().zip(column).for_each(|(b, f)| *b -= f * known);
            }
        }
        let (tables, solver) = (&self.tables, &ActiveSet);
        let b = &work.b.as_slice()[..count];
        let approaches = &mut self.approaches.as_mut_slice()[..count];
        let forces = &mut self.forces.as_mut_slice()[..count];
        if frame.meshes.iter().any(|mesh| mesh.map(&self.maps).is_none()) {
            // First guess at a position not met before, or whose map gave way: the forces of the last step.
            forces.fill(0.0);
            for (memory, mesh) in self.memory.iter().zip(&frame.meshes) {
                let own = mesh.first..mesh.first + mesh.count;
                let slots = frame.slots[own.clone()].iter();
                forces[own].iter_mut().zip(slots).for_each(|(p, slot)| *p = memory.now(*slot));
            }
            for (i, (delta, b)) in approaches.iter_mut().zip(b).enumerate() {
                let row = frame.receptance.row(i);
                *delta = b - row.iter().zip(&*forces).map(|(y, p)| y * p).sum::<f64>();
            }
            find_lost(frame, &mut self.maps, tables, approaches)?;
        }
        let mut residual = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
            let known = combination(frame, &mut work.ids);
            let place = match known {
                Some(place) => place,
                None => {
                    let Some(made) = combine(frame, &self.maps, &work.ids)? else {
                        // Meshes of one table: the map of one gave way to that of another.
                        find_lost(frame, &mut self.maps, tables, approaches)?;
                        continue;
                    };
                    self.counts.combinations += 1;
                    frame.keep(made)
                }
            };
            self.counts.solutions += 1;
            let chosen = &frame.combinations[place];
            // forces takes the approaches until they hold: δ = W b + w
            forces.copy_from_slice(&chosen.offset);
            chosen.slope.add_product(b, forces);
            // Where sets alternate, a part of the way is taken.
            let part = if iteration < 12 { 1.0 } else { 0.5 };
            residual = 0.0;
            for (delta, next) in approaches.iter_mut().zip(&*forces) {
                let change = next - *delta;
                residual = residual.max(change.abs());
                *delta = if part == 1.0 { *next } else { *delta + part * change };
            }
            let mut all_hold = part == 1.0 || residual < 1e-14;
            for mesh in &mut frame.meshes {
                let delta = &approaches[mesh.first..mesh.first + mesh.count];
                let maps = &mut self.maps[mesh.table];
                if !maps.holds(&mut mesh.held, delta) {
                    maps.find(&tables.list[mesh.table], delta, &mut mesh.held, solver)?;
                    all_hold = false;
                }
            }
            if all_hold {
                approaches.copy_from_slice(forces);
                // P = S δ + P₀,  x = A⁻¹ (load − rowsᵀ P)
                let mut laws = frame.combinations[place].laws.as_slice();
                for mesh in &frame.meshes {
                    let own = mesh.first..mesh.first + mesh.count;
                    let delta = &approaches[own.clone()];
                    for force in &mut forces[own] {
                        let law;
                        (law, laws) = laws.split_at(1 + mesh.count);
                        let along = law[1..].iter().zip(delta).map(|(s, d)| s * d);
                        *force = law[0] + along.sum::<f64>();
                    }
                }
                work.left.copy_from(&work.load);
                for (row, force) in frame.rows.iter().zip(&*forces) {
                    row.add_to(-force, work.left.as_mut_slice());
                }
                work.x.fill(0.0);
                self.packed_inverse.add_product(work.left.as_slice(), work.x.as_mut_slice());
                return Ok(());
            }
        }
        Err(FeError::NotConverged { iterations: MOST_ITERATIONS, residual })
    }

    /// Refuses what the tables do not cover, and motion beyond all bounds.
    fn check(&self, frame: &Frame) -> Result<(), FeError> {
        for (i, x) in self.work.x.iter().enumerate() {
            if x.is_nan() || x.abs() > BOUND {
                let (body, quantity) = self.statics.races.name_of(i);
                return Err(FeError::Diverged { time_s: self.time(), body, quantity, value: *x });
            }
        }
        for mesh in &frame.meshes {
            let table = &self.tables.list[mesh.table];
            if let Some(pair) = mesh.map(&self.maps).and_then(|map| map.overflows) {
                let (cells, force_n) = (&table.pairs[pair], self.forces[mesh.first + pair]);
                if force_n > 0.0 {
                    let reach_mm = 0.5e3 * cells.width * cells.x.len() as f64;
                    let (phase, pair) = (table.phase, cells.index);
                    return Err(FeError::GridOverflow { phase, pair, reach_mm, force_n });
                }
            }
            let own = &self.approaches.as_slice()[mesh.first..mesh.first + mesh.count];
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
        let races = &self.statics.races;
        let displaced = |x: &DVector<f64>, body: usize| {
            [0, 1, 2].map(|axis| races.of(body, axis).map_or(0.0, |i| x[i]))
        };
        for ((ports, forces), own) in self.work.ports.iter_mut().zip(&frame.own) {
            if !ports.is_empty() {
                forces.clear();
                forces.extend(own.iter().map(|(pair, _)| self.forces[*pair]));
            }
        }
        let x = &self.work.x;
        let one = |(k, (gear, loads)): (usize, (&mut Gear<'_>, &Loads))| {
            let (ports, forces) = loads;
            if gear.vibrating.unknowns() > 0 {
                let angle = gear.angle(turned);
                gear.vibrating.finish(displaced(x, k + 1), angle, &ports[..forces.len()], forces);
            }
        };
        if self.is_large {
            self.gears.par_iter_mut().zip(&self.work.ports).enumerate().for_each(one);
        } else {
            self.gears.iter_mut().zip(&self.work.ports).enumerate().for_each(one);
        }
        let race = displaced(&self.work.x, CARRIER);
        self.bearings.finish(&self.rule, self.carrier.as_mut(), &self.work.x, race);
        self.motion.advance(&self.rule, self.work.x.as_slice());
        for (memory, mesh) in self.memory.iter_mut().zip(&frame.meshes) {
            let own = &self.forces.as_slice()[mesh.first..mesh.first + mesh.count];
            let slots = &frame.slots[mesh.first..mesh.first + mesh.count];
            memory.advance(&self.lag, slots.iter().copied().zip(own.iter().copied()));
        }
    }
}

/// The combination whose maps hold now, if it was solved before; `ids` takes the maps' ids.
fn combination(frame: &Frame, ids: &mut Vec<u64>) -> Option<usize> {
    ids.clear();
    ids.extend(frame.meshes.iter().map(|mesh| mesh.held.id()));
    frame.combinations.iter().position(|c| c.maps == *ids)
}

/// Finds maps at some approaches for the meshes that have none, or whose map gave way to another.
fn find_lost(
    frame: &mut Frame,
    maps: &mut [ContactMaps],
    tables: &SetTables,
    approaches: &[f64],
) -> Result<(), FeError> {
    for mesh in &mut frame.meshes {
        if mesh.map(maps).is_none() {
            let delta = &approaches[mesh.first..mesh.first + mesh.count];
            maps[mesh.table].find(&tables.list[mesh.table], delta, &mut mesh.held, &ActiveSet)?;
        }
    }
    Ok(())
}

/// (I + Y S) δ = b − Y P₀; `None` if a mesh has no map.
fn combine(
    frame: &Frame,
    maps: &[ContactMaps],
    ids: &[u64],
) -> Result<Option<Combination>, FeError> {
    let count = frame.offsets.len();
    let (mut s, mut p0) = (DMatrix::zeros(count, count), DVector::zeros(count));
    let mut laws = Vec::with_capacity(count * 4);
    for mesh in &frame.meshes {
        let Some(map) = mesh.map(maps) else { return Ok(None) };
        for i in 0..mesh.count {
            p0[mesh.first + i] = map.forces[i];
            laws.push(map.forces[i]);
            laws.extend_from_slice(&map.stiffness[i * mesh.count..(i + 1) * mesh.count]);
            for j in 0..mesh.count {
                s[(mesh.first + i, mesh.first + j)] = map.stiffness[i * mesh.count + j];
            }
        }
    }
    let matrix = DMatrix::identity(count, count) + &frame.receptance * &s;
    let singular = || FeError::NoEquilibrium("the step's contact problem is singular".into());
    let slope = matrix.try_inverse().ok_or_else(singular)?;
    let offset = &slope * (&frame.receptance * -p0);
    let slope = Packed::new(&slope);
    let offset = offset.as_slice().to_vec();
    Ok(Some(Combination { maps: ids.to_vec(), slope, offset, laws }))
}

fn add_of(races: &Races, body: usize, own: [f64; 3], load: &mut DVector<f64>) {
    for (axis, value) in own.into_iter().enumerate() {
        if let Some(i) = races.of(body, axis) {
            load[i] += value;
        }
    }
}
