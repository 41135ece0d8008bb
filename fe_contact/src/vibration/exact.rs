//! A set in time with exact kinematics at every step: slow, and the reference against which the
//! linearised set is checked.
//!
//! In each step the meshes are placed at the displacements of the gears, and again until these are
//! the displacements at the end of the step. Contact tables are laid out on a grid of phases, such
//! that a mesh is at most 4 µm of its path from a table; over that distance approaches are exact,
//! and the compliance changes by the slopes of the flanks.

use std::borrow::Cow;
use std::sync::Arc;

use gearset::DisplacedMesh;
use nalgebra::DVector;

use super::frame::{Frame, FrameInputs};
use super::frame_pattern::FramePattern;
use super::set::VibratingSet;
use crate::contact::PairFrame;
use crate::error::FeError;
use crate::statics::{NeighbourTables, PlacedMesh, turned};

/// Tables per mesh cycle.
const GRID: f64 = 1120.0;

/// The iteration ends once displacements change by less than this, m.
const FOUND: f64 = 1e-11;

/// Most placings of the meshes in one step.
const MOST: usize = 12;

/// Placings after which a mesh keeps its table: half-way between two tables it could otherwise
/// alternate.
const FREE: usize = 4;

/// Meshes placed at displacements of the gears.
struct PlacedStep {
    frame: Box<Frame>,
    /// Load that the slopes of the flanks leave on the races, N.
    load: DVector<f64>,
    /// Indices of the meshes' tables.
    places: Vec<usize>,
}

impl VibratingSet<'_> {
    /// The meshes at the end of the step with the races at x (m), on the tables nearest in phase,
    /// or on the tables `kept`.
    fn placed_at(
        &mut self,
        x: &DVector<f64>,
        kept: Option<&[usize]>,
    ) -> Result<PlacedStep, FeError> {
        let position = self.clock.position(self.clock.step_in_cycle);
        let count = self.statics.reference().meshes.len();
        let mut load = DVector::zeros(x.len());
        let mut places = Vec::with_capacity(count);
        let mut poses: Vec<DisplacedMesh> = Vec::with_capacity(count);
        for mesh in 0..count {
            let pose = self.statics.exact_pose(mesh, position, x)?;
            let near = self.statics.phase(mesh, position);
            let pose = pose.turned_by(-(pose.phase() - near).round());
            places.push(match kept.and_then(|kept| kept.get(mesh)) {
                Some(place) => *place,
                None => self.grid_table(mesh, pose.phase())?,
            });
            poses.push(pose);
        }
        let mut placed = Vec::with_capacity(count);
        for (mesh, (place, pose)) in places.iter().zip(&poses).enumerate() {
            placed.push(self.place_on_grid(mesh, *place, pose, x, &mut load)?);
        }
        let inputs = FrameInputs {
            statics: &self.statics,
            gears: &self.bodies.gears,
            lag_end: self.pairs.lag.end,
        };
        let (statics, gears) = (&self.statics, &self.bodies.gears);
        let pattern = FramePattern::new(statics, gears, placed, count, position)?;
        let frame = Frame::new(&inputs, Arc::new(pattern), &places, position)?;
        Ok(PlacedStep { frame: Box::new(frame), load, places })
    }

    /// Index of the table nearest to a phase (cycles), which is computed at its first use.
    fn grid_table(&mut self, mesh: usize, phase: f64) -> Result<usize, FeError> {
        let group = self.statics.reference().meshes[mesh].group;
        let key = (group, (phase * GRID).round() as i64);
        if let Some(place) = self.contact.grid.as_ref().and_then(|grid| grid.place.get(&key)) {
            return Ok(*place);
        }
        let settings = self.contact.tables.settings;
        let phase = key.1 as f64 / GRID;
        let table = self.statics.table(group, phase, &settings)?;
        let own = &self.statics.reference().loaded[group].mesh;
        let beside = NeighbourTables::coarse(self.statics.bodies, own, phase, &settings)?;
        let place = self.contact.add(Arc::new(table));
        let grid = self.contact.grid.get_or_insert_default();
        grid.place.insert(key, place);
        grid.beside.insert(place, beside);
        Ok(place)
    }

    /// One mesh on a table of the grid, with the exact pose of its gears.
    fn place_on_grid(
        &self,
        mesh: usize,
        place: usize,
        pose: &DisplacedMesh,
        x: &DVector<f64>,
        load: &mut DVector<f64>,
    ) -> Result<PlacedMesh<'static>, FeError> {
        let of = &self.statics.reference().meshes[mesh];
        let own = &self.statics.reference().loaded[of.group].mesh;
        let table = self.contact.tables.list[place].as_ref();
        let lost = |cause: String| FeError::NoEquilibrium(cause);
        let there = own.at_center_distance(pose.center_distance);
        let there = there.map_err(|cause| lost(cause.to_string()))?;
        let still = own.displaced(table.phase, &[0.0; 6]).map_err(|e| lost(e.to_string()))?;
        let memory = &self.pairs.memory[mesh];
        let forces: Vec<f64> = table
            .pairs
            .iter()
            .map(|pair| memory.now(super::lag::PairSlot::of(pair.index)).max(0.0))
            .collect();
        let grid = self.contact.grid.as_ref().and_then(|grid| grid.beside.get(&place));
        let beside = grid.ok_or_else(|| lost("a table of the grid is lost".into()))?;
        let slopes = beside.slopes(table, &forces, &crate::complementarity::ActiveSet)?;
        let races = &self.statics.races;
        let onto =
            |row: &[f64; 6]| -> DVector<f64> { races.approach(of.kind, of.planet, row).into() };
        let gradients = pose.gradients();
        let along = [onto(&gradients.roll_length), onto(&gradients.center_distance)];
        let roll_length = own.path_start + table.phase * own.base_pitch;
        let moved =
            [pose.touching_roll_length() - roll_length, pose.center_distance - own.center_distance];
        let (mut rows, mut offsets) = (Vec::new(), Vec::new());
        for (pair, kappa) in table.pairs.iter().zip(&slopes.of_pairs) {
            let here = PairFrame::pressed(&there, pose.phase(), pose.approach, pair.index);
            let row = here.map_or(pair.row, |frame| frame.approach_row());
            let mut row = onto(&turned(&row, pose.line_of_centres));
            let gap = |pose: &DisplacedMesh| pose.clearance(own, pair.index);
            let approach = gap(&still).zip(gap(pose)).map(|(table, now)| table - now);
            let inside = || lost("a corner dips below its mate's base circle".into());
            let mut approach = approach.ok_or_else(inside)?;
            for ((along, kappa), moved) in along.iter().zip(kappa).zip(moved) {
                row.axpy(-kappa, along, 1.0);
                approach -= kappa * moved;
            }
            offsets.push(row.dot(x) - approach);
            rows.push(row);
        }
        for (along, rest) in along.iter().zip(slopes.rest) {
            load.axpy(rest, along, 1.0);
        }
        let mut errors = vec![0.0; rows.len()];
        if self.statics.has_tooth_errors() {
            self.statics.write_errors(mesh, table, self.clock.turned(), &mut errors);
        }
        let (kind, planet, phase) = (of.kind, of.planet, table.phase);
        let table = Cow::Owned(table.clone());
        let (bends, turns) = (Vec::new(), Vec::new());
        Ok(PlacedMesh { kind, planet, phase, table, rows, offsets, errors, bends, turns })
    }

    /// Solves the contact of the step with the meshes placed at its end. On entry `work.load` holds
    /// the loads on the races other than those of the slopes.
    pub(super) fn exact_contact(&mut self) -> Result<Box<Frame>, FeError> {
        let given = self.work.load.clone();
        let mut x = DVector::from_column_slice(&self.race_dynamics.motion.x);
        let mut change = f64::INFINITY;
        let mut kept: Option<Vec<usize>> = None;
        for placing in 0..MOST {
            let PlacedStep { mut frame, load, places } = self.placed_at(&x, kept.as_deref())?;
            if placing >= FREE {
                kept = Some(places);
            }
            self.work.load = &given + load;
            self.solve_contact(&mut frame)?;
            change = (&self.work.x - &x).amax();
            x.copy_from(&self.work.x);
            if change < FOUND {
                return Ok(frame);
            }
        }
        Err(FeError::NotConverged { iterations: MOST, residual: change })
    }
}
