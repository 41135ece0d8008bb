//! Equilibrium with exact kinematics in every iteration: slow, and the reference against which the
//! linearised set is checked.
//!
//! In every iteration contact tables are laid out for the displaced gears. How their compliance
//! changes with σ and a' is computed from further tables beside them, not from distributed loads.

use std::borrow::Cow;

use gearset::{DisplacedMesh, Mesh};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::equilibrium::{Equilibrium, System};
use super::mesh_rows::turned;
use super::phase::cycle;
use super::placed::PlacedMesh;
use super::reference::moved;
use super::set::StaticSet;
use super::slopes::{NeighbourTables, Slopes, unrelieved};
use super::state::{SetCycle, SetState};
use crate::complementarity::{ActiveSet, ComplementaritySolver};
use crate::contact::{CellSettings, MeshAnswer, MeshTable, PairFrame};
use crate::error::FeError;

/// Steps of the differences between tables: along the line of action and of the centre distance, m.
const STEPS: [f64; 2] = [1.6e-5, 1e-5];

/// The iteration ends once displacements change by less than this, m.
const FOUND: f64 = 1e-11;

/// Change of displacements (m) from which on the slopes of the flanks are computed again.
const SLOPES_HOLD: f64 = 1e-7;

/// Displacement to either side between which the tangent is taken, m: a thousandth of a tooth's deflection, and far
/// above the rounding of the forces.
const APART: f64 = 1e-8;

/// Most iterations.
const MOST: usize = 40;

/// Tables from which the slopes of the flanks are taken.
#[derive(Debug, Clone, Copy)]
enum SlopeTables {
    /// As fine as those of contact.
    Full,
    /// Those of the linearised set, with fewer cells.
    AsLinearised,
}

/// A mesh of the displaced gears.
struct There {
    mesh: Mesh,
    pose: DisplacedMesh,
    phase: f64,
    table: MeshTable,
}

impl StaticSet<'_> {
    /// Equilibrium at `positions` evenly spaced positions of one mesh cycle under a torque on the
    /// sun (N·m, magnitude) with exact kinematics; positions are counted as for the set's
    /// reference.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub fn exact_cycle(&self, torque_nm: f64, positions: usize) -> Result<SetCycle, FeError> {
        self.exact_cycle_with(torque_nm, &DVector::zeros(0), positions)
    }

    /// The same with the slopes of the flanks from the coarser tables that the linearised set takes them from: what
    /// differs from [`StaticSet::cycle_here`] is kinematics alone.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub fn exact_kinematics_cycle(
        &self,
        torque_nm: f64,
        positions: usize,
    ) -> Result<SetCycle, FeError> {
        self.cycle_by(torque_nm, &DVector::zeros(0), positions, SlopeTables::AsLinearised)
    }

    /// The same with further loads on the races' coordinates (N, one each, or an empty vector).
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub fn exact_cycle_with(
        &self,
        torque_nm: f64,
        further: &DVector<f64>,
        positions: usize,
    ) -> Result<SetCycle, FeError> {
        self.cycle_by(torque_nm, further, positions, SlopeTables::Full)
    }

    fn cycle_by(
        &self,
        torque_nm: f64,
        further: &DVector<f64>,
        positions: usize,
        tables: SlopeTables,
    ) -> Result<SetCycle, FeError> {
        let f = self.load_with(torque_nm, further);
        let force = self.share(torque_nm).max(1.0);
        let settings = match tables {
            SlopeTables::Full => self.bodies.cells_in_time(force),
            SlopeTables::AsLinearised => self.bodies.cells(force),
        };
        let mut states = Vec::with_capacity(positions);
        let mut q = self.reference.q.clone();
        for i in 0..positions {
            let position = i as f64 / positions as f64;
            let (state, end) = self.exact(&f, position, &settings, q, tables)?;
            states.push(state);
            q = end;
        }
        Ok(SetCycle { torque_nm: self.sign * torque_nm, lead: self.reference.lead(), states })
    }

    /// Equilibrium at a position (cycles), iterated from displacements q (m).
    fn exact(
        &self,
        f: &DVector<f64>,
        position: f64,
        settings: &CellSettings,
        mut q: DVector<f64>,
        tables: SlopeTables,
    ) -> Result<(SetState, DVector<f64>), FeError> {
        let solver = &ActiveSet;
        let mut slopes: Vec<Slopes> = Vec::new();
        let mut slopes_at: Option<DVector<f64>> = None;
        let (mut iterations, mut change) = (0, f64::INFINITY);
        while iterations < MOST {
            iterations += 1;
            let there = self.there(position, &q, settings)?;
            let placed = there.iter().enumerate();
            let placed = placed.map(|(k, t)| self.place_there(k, t, position, &q));
            let mut meshes: Vec<PlacedMesh<'_>> = placed.collect::<Result<_, _>>()?;
            let mut load = DVector::zeros(self.races.count);
            let hold = |at: &DVector<f64>| (at - &q).amax() < SLOPES_HOLD;
            if !slopes_at.as_ref().is_some_and(hold) {
                slopes = self.slopes_there(&there, &meshes, &q, (settings, tables), solver)?;
                slopes_at = Some(q.clone());
            }
            for (k, (t, own)) in there.iter().zip(&slopes).enumerate() {
                self.lean_there(k, t, own, &q, &mut meshes[k], &mut load);
            }
            let system = System { stiffness: self.races.stiffness.clone(), load: f + &load };
            let before = q.clone();
            let ((answers, residual), counts) =
                self.balance(&system, &mut q, (&meshes, &[]), solver)?;
            change = (&q - before).amax();
            if change < FOUND {
                let found = Equilibrium {
                    position,
                    q: q.clone(),
                    meshes,
                    answers,
                    slopes,
                    level: load.clone(),
                    load,
                    residual,
                    counts: (iterations, counts.1),
                };
                return Ok((self.state_of(&found, 0.0), q));
            }
        }
        Err(FeError::NotConverged { iterations, residual: change })
    }

    /// Tangent stiffness K + ∂²Ψ/∂q² (n×n, N/m) of the set in the equilibrium that exact kinematics give at a
    /// position (cycles) under a torque on the sun (N·m, magnitude): central differences of the gradient of the
    /// energy Ψ of the meshes, so that it shares no derivative with the linearised set.
    ///
    /// # Errors
    /// As [`StaticSet::exact_cycle`].
    pub fn exact_tangent(&self, torque_nm: f64, position: f64) -> Result<DMatrix<f64>, FeError> {
        let f = self.load(torque_nm);
        let settings = self.bodies.cells_in_time(self.share(torque_nm).max(1.0));
        let start = self.reference.q.clone();
        let (_, q) = self.exact(&f, position, &settings, start, SlopeTables::Full)?;
        let gradient = |coordinate: usize, by: f64| {
            let mut moved = q.clone();
            moved[coordinate] += by;
            self.mesh_potential(torque_nm, position, &moved).map(|found| found.1)
        };
        let mut tangent = self.races.stiffness.clone();
        for i in 0..q.len() {
            let column = (gradient(i, APART)? - gradient(i, -APART)?) / (2.0 * APART);
            tangent.column_mut(i).axpy(1.0, &column, 1.0);
        }
        Ok(0.5 * (&tangent + tangent.transpose()))
    }

    /// Energy Ψ (J) of all meshes with the races at q (n, m) at a position (cycles), and its
    /// gradient (n, N), the negative of the generalised forces of the meshes on the races. Grids
    /// are sized for a torque on the sun (N·m).
    ///
    /// # Errors
    /// If contact cannot be solved or gears displaced by so much do not mesh.
    pub fn mesh_potential(
        &self,
        torque_nm: f64,
        position: f64,
        q: &DVector<f64>,
    ) -> Result<(f64, DVector<f64>), FeError> {
        let settings = self.bodies.cells_in_time(self.share(torque_nm).max(1.0));
        let there = self.there(position, q, &settings)?;
        let placed = there.iter().enumerate();
        let placed = placed.map(|(k, t)| self.place_there(k, t, position, q));
        let mut meshes: Vec<PlacedMesh<'_>> = placed.collect::<Result<_, _>>()?;
        let full = (&settings, SlopeTables::Full);
        let slopes = self.slopes_there(&there, &meshes, q, full, &ActiveSet)?;
        let mut load = DVector::zeros(q.len());
        let mut energy = 0.0;
        for (k, (t, own)) in there.iter().zip(&slopes).enumerate() {
            self.lean_there(k, t, own, q, &mut meshes[k], &mut load);
            let answer = meshes[k].answer(q, &ActiveSet, None)?;
            energy += answer.energy;
            for (row, force) in meshes[k].rows.iter().zip(&answer.pair_forces) {
                load.axpy(-force, row, 1.0);
            }
        }
        Ok((energy, -load))
    }

    /// Includes the slopes of the flanks of a mesh in its rows, and adds the rest of the gradient
    /// of its energy to the load on the races, N.
    fn lean_there(
        &self,
        which: usize,
        there: &There,
        slopes: &Slopes,
        q: &DVector<f64>,
        placed: &mut PlacedMesh<'_>,
        load: &mut DVector<f64>,
    ) {
        let of = &self.nominal[which];
        let gradients = there.pose.gradients();
        let onto = |row: &[f64; 6]| -> DVector<f64> {
            self.races.approach(of.kind, of.planet, row).into()
        };
        let along = [onto(&gradients.roll_length), onto(&gradients.center_distance)];
        let rows = placed.rows.iter_mut().zip(&mut placed.offsets).zip(&slopes.of_pairs);
        for ((row, offset), kappa) in rows {
            let before = row.dot(q);
            for (along, kappa) in along.iter().zip(kappa) {
                row.axpy(-kappa, along, 1.0);
            }
            *offset += row.dot(q) - before;
        }
        for (along, rest) in along.iter().zip(slopes.rest) {
            load.axpy(rest, along, 1.0);
        }
    }

    /// All meshes of the gears displaced by q (m); meshes with equal phase and centre distance
    /// share one table.
    fn there(
        &self,
        position: f64,
        q: &DVector<f64>,
        settings: &CellSettings,
    ) -> Result<Vec<There>, FeError> {
        let poses: Vec<DisplacedMesh> = (0..self.nominal.len())
            .map(|k| self.exact_pose(k, position, q))
            .collect::<Result<_, _>>()?;
        let same = |a: &DisplacedMesh, b: &DisplacedMesh| {
            let phase = cycle(a.phase()) - cycle(b.phase());
            let distance = a.center_distance - b.center_distance;
            a.kind == b.kind && phase.abs() < 1e-11 && distance.abs() < 1e-14
        };
        let first: Vec<usize> = (0..poses.len())
            .map(|k| (0..k).find(|j| same(&poses[*j], &poses[k])).unwrap_or(k))
            .collect();
        let made: Vec<Option<(Mesh, MeshTable)>> = (0..poses.len())
            .into_par_iter()
            .map(|k| {
                if first[k] != k {
                    return Ok(None);
                }
                let pose = &poses[k];
                let mesh = moved(self.bodies, pose.kind, pose.center_distance)?;
                let table = self.table_of(&mesh, cycle(pose.phase()), settings)?;
                Ok(Some((mesh, table)))
            })
            .collect::<Result<_, FeError>>()?;
        let one = |(k, pose): (usize, DisplacedMesh)| {
            let (mesh, table) = made[first[k]].clone()?;
            let phase = table.phase;
            // The table numbers its pairs at its own phase, reduced to [0, 1).
            let pose = pose.turned_by(-(pose.phase() - phase).round());
            Some(There { mesh, pose, phase, table })
        };
        Ok(poses.into_iter().enumerate().filter_map(one).collect())
    }

    fn table_of(
        &self,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
    ) -> Result<MeshTable, FeError> {
        let (_, pair) = self.bodies.joined(mesh.kind)?;
        MeshTable::new(mesh, pair, phase, settings)
    }

    fn place_there<'t>(
        &self,
        which: usize,
        there: &'t There,
        position: f64,
        q: &DVector<f64>,
    ) -> Result<PlacedMesh<'t>, FeError> {
        let of = &self.nominal[which];
        let still = unrelieved(&there.mesh, there.phase)?;
        let mut rows = Vec::new();
        let mut offsets = Vec::new();
        let mut turns = Vec::new();
        for pair in &there.table.pairs {
            let here =
                PairFrame::pressed(&there.mesh, there.phase, there.pose.approach, pair.index);
            let row = here.map_or(pair.row, |frame| frame.approach_row());
            turns.push(row[5]);
            let row = turned(&row, there.pose.line_of_centres);
            let row = DVector::from_vec(self.races.approach(of.kind, of.planet, &row));
            let gap = |pose: &DisplacedMesh| pose.clearance(&there.mesh, pair.index);
            let approach = gap(&still).zip(gap(&there.pose)).map(|(table, now)| table - now);
            let approach = approach.ok_or_else(|| {
                FeError::NoEquilibrium("a corner dips below its mate's base circle".into())
            })?;
            offsets.push(row.dot(q) - approach);
            rows.push(row);
        }
        let mut errors = vec![0.0; rows.len()];
        if self.has_tooth_errors() {
            let frame = there.pose.line_of_centres + self.races.psi[of.planet];
            let sun = self.bodies.geometry.sun.as_ref();
            // The sun's angle at the reference identifies the teeth: it differs from the actual one
            // by far less than half a pitch.
            let from = self.sun_angle(position);
            for (error, pair) in errors.iter_mut().zip(&there.table.pairs) {
                *error = self.imperfections.gap(of.kind, pair.axes[0] + frame - from, sun);
            }
        }
        let table = Cow::Borrowed(&there.table);
        Ok(PlacedMesh {
            kind: of.kind,
            planet: of.planet,
            phase: there.phase,
            table,
            rows,
            offsets,
            errors,
            bends: Vec::new(),
            turns,
        })
    }

    /// Slopes of the flanks of all meshes at the forces of their present approaches, from tables
    /// beside theirs.
    fn slopes_there(
        &self,
        there: &[There],
        meshes: &[PlacedMesh<'_>],
        q: &DVector<f64>,
        (settings, tables): (&CellSettings, SlopeTables),
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<Vec<Slopes>, FeError> {
        let answers: Vec<MeshAnswer> =
            meshes.iter().map(|mesh| mesh.answer(q, solver, None)).collect::<Result<_, _>>()?;
        (0..there.len())
            .into_par_iter()
            .map(|k| {
                let There { mesh, table, .. } = &there[k];
                let (bodies, phase) = (self.bodies, table.phase);
                let beside = match tables {
                    SlopeTables::Full => NeighbourTables::new(bodies, mesh, phase, settings, STEPS),
                    SlopeTables::AsLinearised => {
                        NeighbourTables::coarse(bodies, mesh, phase, settings)
                    }
                }?;
                beside.slopes(table, &answers[k].pair_forces, solver)
            })
            .collect()
    }
}
