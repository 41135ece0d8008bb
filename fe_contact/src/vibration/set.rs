//! A set in time: Newmark's method with contact solved inside every step.
//!
//! The nominal turning is exact kinematics; what is computed is vibration about it, in the carrier
//! frame. Within a step everything but contact is linear, so the approaches of all tooth pairs are
//!
//! ```text
//! δ = b − Y P,   P = S δ + P₀ on the cells that touch
//! ```
//!
//! with b from the state at the step's beginning. Cells that turn out wrong are changed until all
//! complementarity conditions hold.

use std::sync::Arc;

use dynamics::{AverageAcceleration, Motion};
use gearset::{Facing, Kinematics, Scene};
use nalgebra::{DMatrix, DVector};

use super::bearings::Bearings;
use super::body::{Port, RaceMotion, VibratingBody};
use super::build;
use super::damping::Proportional;
use super::frame::{Combination, Frame, Ground};
use super::lag::{LagRule, PairMemory};
use super::teeth::fill_port;
use crate::body::GearBody;
use crate::complementarity::ActiveSet;
use crate::contact::ContactMaps;
use crate::error::FeError;
use crate::statics::{Bodies, CARRIER, Imperfections, PLANETS, Races, SetTables, StaticSet};

/// How a set moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motive {
    /// Standing at a position of the mesh cycle (cycles), in steps of a given length (s).
    Standing {
        /// Position, cycles.
        position: f64,
        /// Step, s.
        step: f64,
    },
    /// Turning from position 0.
    Turning {
        /// Mesh frequency, Hz.
        mesh_frequency: f64,
        /// Steps in a mesh cycle.
        steps_per_cycle: usize,
    },
}

/// One gear that vibrates.
#[derive(Debug)]
pub(super) struct Gear<'s> {
    pub(super) body: &'s GearBody,
    pub(super) vibrating: Box<dyn VibratingBody>,
    /// Degree of freedom of each node of its mesh.
    pub(super) unknown_of: Arc<Vec<usize>>,
    /// Angle of tooth 0 at the start, rad.
    pub(super) start: f64,
    /// Angle by which it turns against the carrier in a mesh cycle, rad.
    pub(super) rate: f64,
}

impl Gear<'_> {
    /// Angle of tooth 0 in the race's frame after some mesh cycles, rad.
    pub(super) fn angle(&self, turned: f64) -> f64 {
        self.start + self.rate * turned
    }

    /// Number of the tooth whose axis stands at an angle, rad.
    pub(super) fn tooth_at(&self, axis: f64, turned: f64) -> i64 {
        let pitch = self.body.mesh.outline.gear().pitch_angle();
        ((axis - self.angle(turned)) / pitch).round() as i64
    }

    /// By how many teeth the numbers of a position move on in a mesh cycle.
    fn teeth_per_cycle(&self) -> i64 {
        -self.rate.signum() as i64
    }
}

/// A set in time.
#[derive(Debug)]
pub struct VibratingSet<'s> {
    pub(super) statics: StaticSet<'s>,
    pub(super) tables: SetTables,
    pub(super) maps: Vec<ContactMaps>,
    rule: AverageAcceleration,
    motive: Motive,
    lag: LagRule,
    pub(super) damping: Proportional,
    /// Dashpots over stiffness, s.
    pub(super) bearing_ratio: f64,
    /// Masses of the races' coordinates, rigid bodies, kg.
    pub(super) mass: Vec<f64>,
    pub(super) carrier: Box<dyn VibratingBody>,
    pub(super) bearings: Bearings,
    /// Stiffness of the central members' supports, n, N/m.
    pub(super) supports: DVector<f64>,
    /// (I/k + A)⁻¹ with the carrier's whole static flexibility.
    seat_stiffness: DMatrix<f64>,
    /// Ring, sun, planets.
    pub(super) gears: Vec<Gear<'s>>,
    /// A⁻¹.
    inverse: DMatrix<f64>,
    /// Gyroscopic and centripetal terms, n×n: G (kg/s) and −mΩ² (N/m).
    gyroscopic: Option<[DMatrix<f64>; 2]>,
    /// By step in the cycle.
    frames: Vec<Option<Frame>>,
    frames_with_backs: Vec<Option<Frame>>,
    /// Step in the cycle, cycles gone by, steps taken.
    step_in_cycle: usize,
    cycles: i64,
    steps: u64,
    /// External forces on the races' coordinates at the end of the step, n, N.
    pub external: DVector<f64>,
    pub(super) motion: Motion,
    memory: Vec<PairMemory>,
    /// Forces of the pairs of the current frame, N.
    pub(super) forces: DVector<f64>,
    /// Approaches of the pairs, less gap offsets, m.
    pub(super) approaches: DVector<f64>,
    touched_back: bool,
    work: Work,
    /// What it took so far.
    pub counts: Counts,
}

/// What a run took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Steps.
    pub steps: u64,
    /// Solutions of the linear system of all pairs.
    pub solutions: u64,
    /// Combinations of contact sets that were met for the first time, or again after they gave way.
    pub combinations: u64,
    /// Steps in which back flanks took part.
    pub with_backs: u64,
}

#[derive(Debug, Default)]
struct Work {
    load: DVector<f64>,
    free: DVector<f64>,
    b: DVector<f64>,
    x: DVector<f64>,
    history: Vec<f64>,
    ids: Vec<u64>,
    /// Ports and forces of each gear.
    ports: Vec<(Vec<Port>, Vec<f64>)>,
}

/// Newton iterations of one step before it is given up.
const MOST_ITERATIONS: usize = 60;

/// Displacements above this (m) are no vibration of a gear set.
const BOUND: f64 = 1e-2;

impl<'s> VibratingSet<'s> {
    /// A set at rest without load under a torque on the sun of the given sense, meshes sized for
    /// `force` (N) each.
    ///
    /// # Errors
    /// If the scene lacks what the bodies need, or a mesh, a factor or a table cannot be had.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        sense: Facing,
        imperfections: Imperfections,
        motive: Motive,
        force: f64,
    ) -> Result<Self, FeError> {
        let statics = StaticSet::new(scene, bodies, sense, imperfections)?;
        let (step, count, start) = match motive {
            Motive::Standing { position, step } => (step, 1, position),
            Motive::Turning { mesh_frequency, steps_per_cycle } => {
                (1.0 / (mesh_frequency * steps_per_cycle as f64), steps_per_cycle, 0.0)
            }
        };
        let rule = AverageAcceleration::new(step).map_err(|e| FeError::Unfit {
            key: "step".into(),
            value: format!("{} s", e.0),
            allowed: "a positive length of time".into(),
            why: "speed and steps a cycle, or the step itself, give none".into(),
        })?;
        let positions: Vec<f64> = (0..count).map(|i| start + i as f64 / count as f64).collect();
        let tables = statics.tables(force, &positions)?;
        let maps = tables.list.iter().map(|_| ContactMaps::default()).collect();
        let damping = Proportional {
            alpha: scene.damping.mass_proportional_per_s,
            beta: scene.damping.stiffness_proportional_s,
        };
        let races = &statics.races;
        let settings = build::Settings { rung: scene.dynamics.rung, damping, rule };
        let gears = build::gears(&statics, scene, &tables, &settings, start)?;
        let (carrier, ports, flexibility) = build::carrier(&statics, scene, &settings)?;
        let of_bearings = build::bearing_stiffnesses(scene, races.planets());
        let ratio = scene.damping.bearing_s;
        let bearings =
            Bearings::new(races, &of_bearings, ports, &flexibility, carrier.as_ref(), ratio);
        let mut whole = flexibility;
        for i in 0..whole.nrows() {
            whole[(i, i)] += 1.0 / of_bearings[i / 2];
        }
        let unstable = || FeError::NoEquilibrium("the carrier is not stable".into());
        let seat_stiffness = whole.cholesky().ok_or_else(unstable)?.inverse();
        let n = races.count;
        let mut mass = vec![0.0; n];
        let mut supports = DVector::zeros(n);
        for body in 0..PLANETS + races.planets() {
            let own = build::body_mass(&statics, scene, body)?;
            for (axis, m) in own.into_iter().enumerate() {
                if let Some(i) = races.of(body, axis) {
                    mass[i] = m;
                    if body < PLANETS {
                        supports[i] = races.support(scene, body, axis);
                    }
                }
            }
        }
        let gyroscopic = match (scene.dynamics.gyroscopic, motive) {
            (true, Motive::Turning { mesh_frequency, .. }) => {
                let speed = statics.sign * carrier_speed(scene, mesh_frequency);
                Some(build::gyroscopic_terms(races, &mass, speed))
            }
            _ => None,
        };
        let planets = races.planets();
        let mut set = Self {
            tables,
            maps,
            rule,
            motive,
            lag: LagRule::new(damping.beta, &rule),
            damping,
            bearing_ratio: ratio,
            mass,
            carrier,
            bearings,
            supports,
            seat_stiffness,
            gears,
            inverse: DMatrix::zeros(n, n),
            gyroscopic,
            frames: (0..count).map(|_| None).collect(),
            frames_with_backs: (0..count).map(|_| None).collect(),
            step_in_cycle: 0,
            cycles: 0,
            steps: 0,
            external: DVector::zeros(n),
            motion: Motion::at_rest(n),
            memory: vec![PairMemory::default(); 2 * planets],
            forces: DVector::zeros(0),
            approaches: DVector::zeros(0),
            touched_back: false,
            work: Work::default(),
            counts: Counts::default(),
            statics,
        };
        set.prepare()?;
        set.work.load = DVector::zeros(n);
        set.work.free = DVector::zeros(n);
        set.work.x = DVector::zeros(n);
        set.work.history = vec![0.0; n];
        set.work.ports = set.gears.iter().map(|_| Default::default()).collect();
        Ok(set)
    }

    pub(super) fn rule(&self) -> AverageAcceleration {
        self.rule
    }

    /// Step, s.
    pub fn step_length(&self) -> f64 {
        self.rule.step()
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.rule.step()
    }

    /// A of the races and its inverse.
    fn prepare(&mut self) -> Result<(), FeError> {
        let races = &self.statics.races;
        let n = races.count;
        let mut a = self.bearings.set_step(&self.rule, races, self.carrier.as_ref())?;
        let bodies = std::iter::once((CARRIER, self.carrier.as_ref()))
            .chain(self.gears.iter().enumerate().map(|(k, g)| (k + 1, g.vibrating.as_ref())));
        for (body, vibrating) in bodies {
            let own = vibrating.race_stiffness();
            for (i, row) in own.iter().enumerate() {
                for (k, value) in row.iter().enumerate() {
                    if let (Some(i), Some(k)) = (races.of(body, i), races.of(body, k)) {
                        a[(i, k)] += value;
                    }
                }
            }
        }
        for i in 0..n {
            a[(i, i)] += self.supports[i] * (1.0 + self.bearing_ratio * self.rule.damping());
        }
        if let Some([g, k]) = &self.gyroscopic {
            a += g * self.rule.damping() + k;
        }
        let singular = || FeError::NoEquilibrium("the races have no inertia".into());
        self.inverse = a.try_inverse().ok_or_else(singular)?;
        Ok(())
    }

    /// Position of a step in the cycle, cycles.
    fn position(&self, step_in_cycle: usize) -> f64 {
        match self.motive {
            Motive::Standing { position, .. } => position,
            Motive::Turning { steps_per_cycle, .. } => {
                step_in_cycle as f64 / steps_per_cycle as f64
            }
        }
    }

    /// Mesh cycles since the start, as an angle knows them.
    pub(super) fn turned(&self) -> f64 {
        match self.motive {
            Motive::Standing { .. } => 0.0,
            Motive::Turning { .. } => self.cycles as f64 + self.position(self.step_in_cycle),
        }
    }

    /// Puts the set to rest under a torque on the sun (N m, magnitude) at its current position.
    ///
    /// # Errors
    /// If there is no equilibrium.
    pub fn rest(&mut self, torque_nm: f64) -> Result<(), FeError> {
        let position = self.position(self.step_in_cycle);
        let (solver, tables) = (&ActiveSet, &self.tables);
        let first = self.statics.equilibrium(torque_nm, position, tables, None, solver)?;
        let has_backs = first.meshes.len() > 2 * self.statics.races.planets();
        drop(first);
        self.external = self.statics.load(torque_nm);
        let mut frame = self.take_frame(has_backs)?;
        // Bodies with a state of their own feel all meshes at once; the cells' compliance knows one
        // mesh alone.
        let across = self.across_meshes(&frame);
        let tables = &self.tables;
        let mut found = self.statics.equilibrium(torque_nm, position, tables, None, solver)?;
        let all = |list: &[crate::contact::MeshAnswer]| -> DVector<f64> {
            let forces = list.iter().flat_map(|a| a.pair_forces.iter().copied());
            DVector::from_vec(forces.collect())
        };
        let mut p = all(&found.answers);
        if across.amax() > 0.0 && torque_nm != 0.0 {
            for _ in 0..30 {
                let shifted = &across * &p;
                let mut offsets = frame.offsets.iter().zip(shifted.iter());
                for offset in found.meshes.iter_mut().flat_map(|m| m.offsets.iter_mut()) {
                    if let Some((nominal, shift)) = offsets.next() {
                        *offset = nominal + shift;
                    }
                }
                self.statics.settle(torque_nm, &mut found, solver)?;
                let next = all(&found.answers);
                let change = (&next - &p).amax();
                p = next;
                if change <= 1e-13 * p.amax() {
                    break;
                }
            }
        }
        let q = found.q;
        self.motion = Motion::at_rest(q.len());
        self.motion.x.copy_from_slice(q.as_slice());
        let offsets = DVector::from_column_slice(&frame.offsets);
        self.approaches = &frame.rigid * &q - offsets - &across * &p;
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
            memory.rest(mesh.pairs.iter().copied().zip(own.iter().copied()));
        }
        for mesh in &mut frame.meshes {
            let range = mesh.first..mesh.first + mesh.count;
            let delta = &self.approaches.as_slice()[range];
            let scale = (self.tables.settings.force, self.tables.settings.window);
            let table = &self.tables.list[mesh.table];
            mesh.map = self.maps[mesh.table].find(table, delta, scale, mesh.map, solver)?;
        }
        self.forces = p;
        self.touched_back = has_backs;
        self.put_back(frame, has_backs);
        Ok(())
    }

    /// Static flexibility between pairs of different meshes that the bodies' states carry, m/N.
    fn across_meshes(&self, frame: &Frame) -> DMatrix<f64> {
        let count = frame.offsets.len();
        let mut across = DMatrix::zeros(count, count);
        for (gear, own) in self.gears.iter().zip(&frame.own) {
            if gear.vibrating.unknowns() == 0 {
                continue;
            }
            let mut ports = vec![Port::default(); own.len()];
            for (port, (pair, end)) in ports.iter_mut().zip(own) {
                self.fill_one(port, frame, gear, (*pair, *end));
            }
            let carried = gear.vibrating.carried_flexibility(&ports);
            for (i, (a, _)) in own.iter().enumerate() {
                for (j, (b, _)) in own.iter().enumerate() {
                    if frame.mesh_of(*a) != frame.mesh_of(*b) {
                        across[(*a, *b)] += carried[i * own.len() + j];
                    }
                }
            }
        }
        across
    }

    pub(super) fn fill_one(
        &self,
        port: &mut Port,
        frame: &Frame,
        gear: &Gear<'_>,
        at: (usize, usize),
    ) {
        let (Some(ends), Some(teeth)) = (&frame.ends[at.0], &frame.teeth[at.0]) else { return };
        let count = gear.body.mesh.outline.gear().teeth as i64;
        let tooth = teeth[at.1] + gear.teeth_per_cycle() * self.cycles;
        let tooth = tooth.rem_euclid(count) as usize;
        fill_port(port, (gear.body, &gear.unknown_of), &ends[at.1], tooth);
    }

    /// Ports of all gears with a state of their own.
    fn fill_ports(&mut self, frame: &Frame) {
        let mut lists = std::mem::take(&mut self.work.ports);
        for ((gear, own), (ports, _)) in self.gears.iter().zip(&frame.own).zip(&mut lists) {
            if gear.vibrating.unknowns() == 0 {
                continue;
            }
            while ports.len() < own.len() {
                ports.push(Port::default());
            }
            for (port, at) in ports.iter_mut().zip(own) {
                self.fill_one(port, frame, gear, *at);
            }
        }
        self.work.ports = lists;
    }

    /// The frame of the current step, built where it is not there yet.
    fn take_frame(&mut self, with_backs: bool) -> Result<Frame, FeError> {
        let k = self.step_in_cycle;
        let list = if with_backs { &mut self.frames_with_backs } else { &mut self.frames };
        if let Some(frame) = list[k].take() {
            return Ok(frame);
        }
        let position = self.position(k);
        let mut placed = self.statics.place(position, &self.tables);
        let front = placed.len();
        let mut places: Vec<usize> =
            placed.iter().map(|p| self.tables.place_of(p.kind, p.phase)).collect();
        if with_backs {
            let backs = self.statics.place_backs(position, &self.tables.settings)?;
            for (i, back) in backs.into_iter().enumerate() {
                places.push(self.tables.list.len() + i);
                placed.push(back);
            }
        }
        let turned = match self.motive {
            Motive::Standing { .. } => 0.0,
            Motive::Turning { .. } => position,
        };
        let ground = Ground {
            bodies: self.statics.bodies,
            races: &self.statics.races,
            gears: &self.gears,
            inverse: &self.inverse,
            lag_end: self.lag.end,
        };
        let frame = Frame::new(&ground, &placed, &places, front, turned)?;
        let owned: Vec<crate::contact::MeshTable> =
            placed.drain(front..).map(|p| p.table.into_owned()).collect();
        for table in owned {
            self.tables.list.push(table);
            self.maps.push(ContactMaps::default());
        }
        Ok(frame)
    }

    fn put_back(&mut self, frame: Frame, with_backs: bool) {
        let k = self.step_in_cycle;
        let list = if with_backs { &mut self.frames_with_backs } else { &mut self.frames };
        list[k] = Some(frame);
    }

    /// Motion of one body's race; held coordinates are still.
    fn race(&self, body: usize) -> RaceMotion {
        let mut race = RaceMotion::default();
        for axis in 0..3 {
            if let Some(i) = self.statics.races.of(body, axis) {
                race.x[axis] = self.motion.x[i];
                race.v[axis] = self.motion.v[i];
                race.a[axis] = self.motion.a[i];
            }
        }
        race
    }

    /// One step; the external forces must be those at its end.
    ///
    /// # Errors
    /// If contact cannot be solved, its cells do not suffice, or the motion diverges.
    pub fn step(&mut self) -> Result<(), FeError> {
        self.tick();
        let turned = self.turned();
        self.work.load.copy_from(&self.external);
        let race = self.race(CARRIER);
        let own = self.carrier.predict(&race, 0.0);
        add_of(&self.statics.races, CARRIER, own, &mut self.work.load);
        for k in 0..self.gears.len() {
            let (race, angle) = (self.race(k + 1), self.gears[k].angle(turned));
            let own = self.gears[k].vibrating.predict(&race, angle);
            add_of(&self.statics.races, k + 1, own, &mut self.work.load);
        }
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
        self.work.free.gemv(1.0, &self.inverse, &self.work.load, 0.0);
        let mut with_backs = false;
        let mut frame = self.take_frame(false)?;
        self.contact(&mut frame)?;
        if self.statics.backs_touch(&self.work.x) {
            self.put_back(frame, false);
            with_backs = true;
            frame = self.take_frame(true)?;
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

    /// Moves the clock on, and the memories of meshes whose phase starts anew.
    fn tick(&mut self) {
        self.steps += 1;
        if let Motive::Turning { steps_per_cycle, .. } = self.motive {
            let before = self.position(self.step_in_cycle);
            self.step_in_cycle += 1;
            if self.step_in_cycle == steps_per_cycle {
                self.step_in_cycle = 0;
                self.cycles += 1;
            }
            let after = self.position(self.step_in_cycle);
            for (mesh, memory) in self.memory.iter_mut().enumerate() {
                if self.statics.phase(mesh, after) < self.statics.phase(mesh, before) {
                    memory.move_on();
                }
            }
        }
    }

    /// Solves for the pairs' forces and the races' displacements.
    fn contact(&mut self, frame: &mut Frame) -> Result<(), FeError> {
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
        work.b.rows_mut(0, count).gemv(1.0, &frame.rows, &work.free, 0.0);
        for (b, offset) in work.b.iter_mut().zip(&frame.offsets) {
            *b -= offset;
        }
        for ((gear, own), (ports, _)) in self.gears.iter().zip(&frame.own).zip(&work.ports) {
            if gear.vibrating.unknowns() > 0 {
                for ((pair, _), port) in own.iter().zip(ports) {
                    work.b[*pair] += gear.vibrating.free(port);
                }
            }
        }
        for (memory, mesh) in self.memory.iter().zip(&frame.meshes) {
            for (k, pair) in mesh.pairs.iter().enumerate() {
                let known = memory.known(&self.lag, *pair);
                if known != 0.0 {
                    for i in mesh.first..mesh.first + mesh.count {
                        work.b[i] -= frame.lagging[(i, mesh.first + k)] * known;
                    }
                }
                // First guess: the forces of the step before.
                self.forces[mesh.first + k] = memory.now(*pair);
            }
        }
        for mesh in &frame.meshes[self.memory.len()..] {
            self.forces.rows_mut(mesh.first, mesh.count).fill(0.0);
        }
        let (tables, solver) = (&self.tables, &ActiveSet);
        let scale = (tables.settings.force, tables.settings.window);
        let b = work.b.rows(0, count);
        let mut approaches = self.approaches.rows_mut(0, count);
        let mut forces = self.forces.rows_mut(0, count);
        approaches.copy_from(&b);
        approaches.gemv(-1.0, &frame.receptance, &forces, 1.0);
        for mesh in &mut frame.meshes {
            if mesh.map >= self.maps[mesh.table].count() {
                let delta = &approaches.as_slice()[mesh.first..mesh.first + mesh.count];
                let table = &tables.list[mesh.table];
                mesh.map = self.maps[mesh.table].find(table, delta, scale, 0, solver)?;
            }
        }
        let mut residual = f64::INFINITY;
        for iteration in 0..MOST_ITERATIONS {
            let known = combination(frame, &self.maps, &mut work.ids);
            let place = match known {
                Some(place) => place,
                None => {
                    self.counts.combinations += 1;
                    let made = combine(frame, &self.maps, &work.ids)?;
                    frame.keep(made)
                }
            };
            self.counts.solutions += 1;
            let chosen = &frame.combinations[place];
            forces.copy_from(&chosen.offset);
            forces.gemv(1.0, &chosen.slope, &b, 1.0);
            // Where sets alternate, a part of the way is taken.
            let part = if iteration < 12 { 1.0 } else { 0.5 };
            residual = 0.0;
            for (i, b) in b.iter().enumerate() {
                let row = frame.receptance.row(i);
                let along: f64 = row.iter().zip(forces.iter()).map(|(y, p)| y * p).sum();
                let change = b - along - approaches[i];
                residual = residual.max(change.abs());
                approaches[i] += part * change;
            }
            let mut all_hold = part == 1.0 || residual < 1e-14;
            for mesh in &mut frame.meshes {
                let delta = &approaches.as_slice()[mesh.first..mesh.first + mesh.count];
                let (table, maps) = (&tables.list[mesh.table], &mut self.maps[mesh.table]);
                if !maps.holds(mesh.map, table, delta, scale) {
                    mesh.map = maps.find(table, delta, scale, mesh.map, solver)?;
                    all_hold = false;
                }
            }
            if all_hold {
                work.x.copy_from(&work.free);
                work.x.gemv(-1.0, &frame.answers, &forces, 1.0);
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
            let map = self.maps[mesh.table].map(mesh.map);
            if let Some(pair) = map.overflows {
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
        for (k, (gear, (ports, forces))) in
            self.gears.iter_mut().zip(&mut self.work.ports).enumerate()
        {
            let own = &frame.own[k];
            let angle = gear.angle(turned);
            let race = displaced(&self.work.x, k + 1);
            if gear.vibrating.unknowns() > 0 {
                forces.clear();
                forces.extend(own.iter().map(|(pair, _)| self.forces[*pair]));
                gear.vibrating.finish(race, angle, &ports[..own.len()], forces);
            }
        }
        let race = displaced(&self.work.x, CARRIER);
        self.bearings.finish(&self.rule, self.carrier.as_mut(), &self.work.x, race);
        self.motion.advance(&self.rule, self.work.x.as_slice());
        for (memory, mesh) in self.memory.iter_mut().zip(&frame.meshes) {
            let own = &self.forces.as_slice()[mesh.first..mesh.first + mesh.count];
            memory.advance(&self.lag, mesh.pairs.iter().copied().zip(own.iter().copied()));
        }
    }

    /// The frame of the last step.
    pub(super) fn current_frame(&self) -> Option<&Frame> {
        let list = if self.touched_back { &self.frames_with_backs } else { &self.frames };
        list[self.step_in_cycle].as_ref()
    }

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad; carrier frame) and of the planets
    /// (ζ, η, θ), counter-clockwise.
    pub fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.statics.displacements(&DVector::from_column_slice(&self.motion.x))
    }

    /// Displacements, velocities and accelerations of the races' free coordinates, m and s.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The races' coordinates.
    pub fn races(&self) -> &Races {
        &self.statics.races
    }

    /// Masses of the races' coordinates with rigid bodies, kg.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// Forces of the planets' bearings, radial and tangential of each, N.
    pub fn bearing_forces(&self) -> &[f64] {
        self.bearings.forces()
    }

    /// Force of each mesh: sun meshes, ring meshes, and back flanks if they took part, N.
    pub fn mesh_forces(&self, out: &mut Vec<f64>) {
        out.clear();
        if let Some(frame) = self.current_frame() {
            out.extend(frame.meshes.iter().map(|mesh| {
                self.forces.as_slice()[mesh.first..mesh.first + mesh.count].iter().sum::<f64>()
            }));
        }
    }

    /// Degrees of freedom beside the races'.
    pub fn elastic_unknowns(&self) -> usize {
        self.gears.iter().map(|g| g.vibrating.unknowns()).sum::<usize>() + self.carrier.unknowns()
    }

    /// Memory of tables, contact maps and frames, bytes.
    pub fn bytes(&self) -> [usize; 3] {
        let frames = self.frames.iter().chain(&self.frames_with_backs).flatten();
        let maps = self.maps.iter().map(ContactMaps::bytes).sum();
        [self.tables.bytes(), maps, frames.map(Frame::bytes).sum()]
    }

    /// Contact problems solved so far, and maps kept.
    pub fn contact_counts(&self) -> [usize; 2] {
        [self.maps.iter().map(|m| m.solved).sum(), self.maps.iter().map(ContactMaps::count).sum()]
    }
}

/// Speed of the carrier (rad/s) at a mesh frequency (Hz), the sun turning counter-clockwise.
fn carrier_speed(scene: &Scene, mesh_frequency: f64) -> f64 {
    match Kinematics::from_scene(scene) {
        Some(Ok(k)) if k.mesh_frequency_hz > 0.0 => {
            k.speeds_rad_per_s.carrier.abs() * mesh_frequency / k.mesh_frequency_hz
        }
        _ => 0.0,
    }
}

/// The combination whose maps hold now, if it was solved before; `ids` takes the maps' ids.
fn combination(frame: &Frame, maps: &[ContactMaps], ids: &mut Vec<u64>) -> Option<usize> {
    ids.clear();
    ids.extend(frame.meshes.iter().map(|mesh| maps[mesh.table].map(mesh.map).id));
    frame.combinations.iter().position(|c| c.maps == *ids)
}

/// (I + S Y) P = S b + P₀.
fn combine(frame: &Frame, maps: &[ContactMaps], ids: &[u64]) -> Result<Combination, FeError> {
    let count = frame.offsets.len();
    let (mut s, mut p0) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for mesh in &frame.meshes {
        let map = maps[mesh.table].map(mesh.map);
        for i in 0..mesh.count {
            p0[mesh.first + i] = map.forces[i];
            for j in 0..mesh.count {
                s[(mesh.first + i, mesh.first + j)] = map.stiffness[i * mesh.count + j];
            }
        }
    }
    let matrix = DMatrix::identity(count, count) + &s * &frame.receptance;
    let lu = matrix.lu();
    let singular = || FeError::NoEquilibrium("the step's contact problem is singular".into());
    let slope = lu.solve(&s).ok_or_else(singular)?;
    let offset = lu.solve(&p0).ok_or_else(singular)?;
    Ok(Combination { maps: ids.to_vec(), slope, offset })
}

fn add_of(races: &Races, body: usize, own: [f64; 3], load: &mut DVector<f64>) {
    for (axis, value) in own.into_iter().enumerate() {
        if let Some(i) = races.of(body, axis) {
            load[i] += value;
        }
    }
}
