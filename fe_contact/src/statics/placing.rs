//! The meshes of a set at a position: their tables, and their pairs' rows on the races' coordinates.

use std::borrow::Cow;

use gearset::{Mesh, MeshKind, MeshMember};
use nalgebra::DVector;

use super::mesh_rows::{invariants, mirrored, turned};
use super::phase::cycle;
use super::placed::{Bend, PlacedMesh};
use super::set::StaticSet;
use super::slopes::Slopes;
use super::tables::SetTables;
use crate::contact::{CellSettings, Location, MeshTable, PairCells, PairFrame};
use crate::error::FeError;

impl StaticSet<'_> {
    /// Every mesh at a position, with its rows and gap offsets; the tables must hold its phases.
    pub(crate) fn place<'t>(&self, position: f64, tables: &'t SetTables) -> Vec<PlacedMesh<'t>> {
        let one = |mesh: usize| {
            let table = tables.list[self.place_of(tables, mesh, position)].as_ref();
            self.place_one(mesh, Cow::Borrowed(table), position)
        };
        (0..self.nominal.len()).map(one).collect()
    }

    /// Index of the table of a front mesh at a position (cycles), which must be among the tables.
    pub(crate) fn place_of(&self, tables: &SetTables, mesh: usize, position: f64) -> usize {
        let group = self.reference.meshes[mesh].group;
        tables.place_of(group, self.phase(mesh, position))
    }

    /// A front mesh on a table of its group, with the compliance of the table's phase.
    pub(super) fn place_one<'t>(
        &self,
        mesh: usize,
        table: Cow<'t, MeshTable>,
        position: f64,
    ) -> PlacedMesh<'t> {
        let pose = &self.reference.meshes[mesh];
        let own = &self.reference.loaded[pose.group];
        let (kind, planet) = (pose.kind, pose.planet);
        let [approach, roll_length, distance] = pose.at;
        let phase = table.phase + roll_length / own.mesh.base_pitch;
        let one = |p: &PairCells| {
            let here = PairFrame::pressed(&own.mesh, phase, approach, p.index);
            let of_table = PairFrame::new(&own.mesh, table.phase, p.index);
            let bend = here.as_ref().and_then(|here| {
                let curvature = here.curvature(&own.mesh, phase, approach);
                // e = σ + δ/2 + … at the driver's corner; at the driven gear's −σ + δ/2 ± L(a'), L the
                // length between the tangent points, with ∂L/∂a' = 1/sin α'.
                let reach = 1.0 / own.mesh.pressure_angle.sin();
                let by = match (here.location, kind) {
                    (Location::Corner(MeshMember::Driver), _) => [0.5, 1.0, 0.0],
                    (Location::Corner(MeshMember::Driven), MeshKind::SunPlanet) => {
                        [0.5, -1.0, reach]
                    }
                    (Location::Corner(MeshMember::Driven), MeshKind::RingPlanet) => {
                        [0.5, -1.0, -reach]
                    }
                    (Location::Path, _) => return None,
                };
                let [delta, roll_length] =
                    [own.gradients.approach[5], own.gradients.roll_length[5]];
                let turn = by[0] * delta + by[1] * roll_length;
                let mut row = DVector::zeros(self.races.count);
                for (gradient, by) in pose.gradients.iter().zip(by) {
                    row.axpy(by, gradient, 1.0);
                }
                let offset = row.dot(&self.reference.q);
                (curvature != 0.0).then_some((row, offset, curvature, turn))
            });
            let (row, opened) = match (here, of_table) {
                (Some(here), Some(of_table)) => {
                    (here.approach_row(), here.rigid_gap() - of_table.rigid_gap())
                }
                // The corner cannot reach the mating involute: row and gap of the table.
                _ => (p.row, 0.0),
            };
            let by_distance = invariants(kind, &own.gradients, &row)[2];
            let turn = row[5];
            let row = self.races.approach(kind, planet, &turned(&row, pose.direction));
            let row = DVector::from_vec(row);
            let at = approach - opened + by_distance * distance;
            let offset = row.dot(&self.reference.q) - at;
            (row, offset, bend, turn)
        };
        let (mut rows, mut offsets, mut bends) = (Vec::new(), Vec::new(), Vec::new());
        let mut turns = Vec::new();
        for (pair, (row, offset, bend, turn)) in table.pairs.iter().map(one).enumerate() {
            rows.push(row);
            offsets.push(offset);
            turns.push(turn);
            if let Some((row, offset, curvature, turn)) = bend {
                bends.push(Bend { pair, row, offset, curvature, turn });
            }
        }
        let mut errors = vec![0.0; rows.len()];
        if self.has_tooth_errors() {
            self.write_errors(mesh, &table, position, &mut errors);
        }
        PlacedMesh { kind, planet, phase: table.phase, table, rows, offsets, errors, bends, turns }
    }

    /// The gears of a front mesh at their loaded centre distance, and the direction of its line of centres
    /// from the nominal one, rad.
    pub(crate) fn loaded_mesh(&self, mesh: usize) -> (&Mesh, f64) {
        let pose = &self.reference.meshes[mesh];
        (&self.reference.loaded[pose.group].mesh, pose.direction)
    }

    /// Writes what tooth errors add to the gaps of a front mesh's pairs after `turned` mesh cycles,
    /// m. The errors rotate with the sun.
    pub(crate) fn write_errors(
        &self,
        mesh: usize,
        table: &MeshTable,
        turned: f64,
        out: &mut [f64],
    ) {
        let pose = &self.reference.meshes[mesh];
        let frame = pose.direction + self.races.psi[pose.planet] - self.sun_angle(turned);
        let sun = self.bodies.geometry.sun.as_ref();
        for (out, pair) in out.iter_mut().zip(&table.pairs) {
            *out = self.imperfections.gap(pose.kind, pair.axes[0] + frame, sun);
        }
    }

    /// Includes the slopes of the deformed flanks in a front mesh's rows, and adds the rest of the
    /// gradient of its energy, ∂W/∂σ − κᵀP and the same for a', to the `load` on the races, N.
    pub(crate) fn lean(
        &self,
        mesh: usize,
        placed: &mut PlacedMesh<'_>,
        slopes: &Slopes,
        load: &mut DVector<f64>,
    ) {
        let pose = &self.reference.meshes[mesh];
        let [_, roll_length, distance] = &pose.gradients;
        let pairs = placed.rows.iter_mut().zip(&mut placed.offsets).zip(&slopes.of_pairs);
        for ((row, offset), [by_roll_length, by_distance]) in pairs {
            if *by_roll_length == 0.0 && *by_distance == 0.0 {
                continue;
            }
            let before = row.dot(&self.reference.q);
            row.axpy(-by_roll_length, roll_length, 1.0);
            row.axpy(-by_distance, distance, 1.0);
            let at = by_roll_length * pose.at[1] + by_distance * pose.at[2];
            *offset += row.dot(&self.reference.q) - before + at;
        }
        load.axpy(slopes.rest[0], roll_length, 1.0);
        load.axpy(slopes.rest[1], distance, 1.0);
    }

    /// The backside flanks of all meshes at a position.
    pub(crate) fn place_backside(
        &self,
        position: f64,
        settings: &CellSettings,
    ) -> Result<Vec<PlacedMesh<'static>>, FeError> {
        (0..self.nominal.len()).map(|mesh| self.backside(mesh, position, settings)).collect()
    }

    /// Whether any backside flanks touch at the displacements q (m) of the races.
    pub(crate) fn backside_touches(&self, q: &DVector<f64>) -> bool {
        self.reference.backside.iter().any(|backside| backside.is_met(q.as_slice()))
    }

    /// The backside flanks of one mesh: the mesh mirrored at its line of centres. The compliance
    /// between them and the front flanks is left out.
    fn backside(
        &self,
        mesh: usize,
        position: f64,
        settings: &CellSettings,
    ) -> Result<PlacedMesh<'static>, FeError> {
        let backside = &self.reference.backside[mesh];
        let of = &self.nominal[mesh];
        let (_, pair) = self.bodies.joined(of.kind)?;
        let phase = cycle(self.backside_offset(mesh) - position);
        let table = MeshTable::new(&backside.mesh, pair, phase, settings)?;
        let mut rows = Vec::with_capacity(table.pairs.len());
        let mut offsets = Vec::with_capacity(table.pairs.len());
        for p in &table.pairs {
            let row = mirrored(&turned(&p.row, backside.direction));
            let row = DVector::from_vec(self.races.approach(of.kind, of.planet, &row));
            let [by_approach, ..] = invariants(of.kind, &backside.gradients, &p.row);
            offsets.push(row.dot(&self.reference.q) - by_approach * backside.approach);
            rows.push(row);
        }
        let errors = vec![0.0; rows.len()];
        let table: Cow<'static, MeshTable> = Cow::Owned(table);
        let (kind, planet, bends) = (of.kind, of.planet, Vec::new());
        // Mirroring changes the sign of rotations.
        let turns = table.pairs.iter().map(|p| -p.row[5]).collect();
        Ok(PlacedMesh { kind, planet, phase, table, rows, offsets, errors, bends, turns })
    }
}
