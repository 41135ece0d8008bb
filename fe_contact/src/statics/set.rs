//! Static equilibrium of a whole set: all 2N meshes in contact together.
//!
//! What holds at every load: phases, tables, meshes at a position. How equilibrium is found:
//! `equilibrium`.

use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

use nalgebra::DVector;
use rayon::prelude::*;

use gearset::{Facing, MeshKind, MeshStart, Phasing, PlanetPositions, Scene};

use super::bodies::{Bodies, missing_mesh};
use super::equilibrium::Equilibrium;
use super::imperfection::Imperfections;
use super::placed::Placed;
use super::races::{PLANETS, Races, SUN};
use super::state::{MeshState, SetCycle, SetState};
use crate::complementarity::ComplementaritySolver;
use crate::contact::{CellSettings, MeshTable, PairCells, PairFrame};
use crate::error::FeError;

/// A set ready for static loads.
#[derive(Debug, Clone)]
pub struct StaticSet<'s> {
    pub(crate) bodies: &'s Bodies,
    pub(crate) races: Races,
    /// Seen in the mirror if the torque is clockwise, so that the loaded flanks always are those of
    /// a counter-clockwise one.
    pub(crate) sign: f64,
    /// Phases of all meshes with planet 0's sun mesh at phase 0: sun meshes, then ring meshes.
    offsets: Vec<(MeshKind, usize, f64)>,
    /// The same for the back flanks, whose phases run backwards, with their normal backlash, m.
    backs: Vec<BackFlank>,
    /// Sun's angle (mirrored frame) where planet 0's sun mesh is at phase 0, rad.
    start_angle: f64,
    imperfections: Imperfections,
}

/// The back flanks of one mesh.
#[derive(Debug, Clone)]
struct BackFlank {
    kind: MeshKind,
    planet: usize,
    /// Phase of the mirrored mesh at position 0, cycles.
    offset: f64,
    /// Normal backlash: what the flanks stand apart when those in front just touch, m.
    backlash: f64,
    /// Approach of a pair on the path, on the races' coordinates, and what a displaced planet takes
    /// from it, m.
    row: DVector<f64>,
    shift: f64,
}

/// Tables of all (mesh kind, phase) some positions need, for one size of load; equal phases share
/// one.
#[derive(Debug, Clone)]
pub struct SetTables {
    /// The tables.
    pub list: Vec<Arc<MeshTable>>,
    place: HashMap<(MeshKind, i64), usize>,
    /// Settings they were made with.
    pub settings: CellSettings,
}

impl SetTables {
    /// Memory of the compliances, bytes.
    pub fn bytes(&self) -> usize {
        self.list.iter().map(|table| 8 * table.compliance.len()).sum()
    }

    /// Whether there is a table for a mesh at a phase (cycles).
    pub(crate) fn holds(&self, kind: MeshKind, phase: f64) -> bool {
        self.place.contains_key(&key(kind, phase))
    }

    /// Place in the list of a mesh at a phase (cycles) the tables were made for.
    pub(crate) fn place_of(&self, kind: MeshKind, phase: f64) -> usize {
        self.place[&key(kind, phase)]
    }
}

/// Phases nearer than this many parts of a cycle are the same phase, rounded differently.
const PHASE_RESOLUTION: f64 = 1e12;

/// How often grids are laid out anew for four times the load.
const RESIZINGS: usize = 3;

fn key(kind: MeshKind, phase: f64) -> (MeshKind, i64) {
    (kind, (phase * PHASE_RESOLUTION).round() as i64)
}

/// Phase in [0, 1), what rounds to 1 being 0.
fn cycle(phase: f64) -> f64 {
    let reduced = phase - phase.floor();
    if reduced * PHASE_RESOLUTION >= PHASE_RESOLUTION - 0.5 { 0.0 } else { reduced }
}

impl<'s> StaticSet<'s> {
    /// A set under a torque on the sun of the given sense.
    ///
    /// # Errors
    /// If the scene is no whole set, or the carrier's mesh fails.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        sense: Facing,
        imperfections: Imperfections,
    ) -> Result<Self, FeError> {
        let sign = sense.sign();
        // The mirror keeps assembly steps whole.
        let positions = PlanetPositions {
            psi_rad: scene.planets.psi_rad.iter().map(|psi| sign * psi).collect(),
            steps: scene
                .planets
                .steps
                .as_ref()
                .map(|steps| steps.iter().map(|s| if sign < 0.0 { -s } else { *s }).collect()),
        };
        bodies.joined(MeshKind::SunPlanet)?;
        let phasing = Phasing::new(&bodies.geometry, &positions)
            .ok_or_else(|| missing_mesh(MeshKind::RingPlanet))?;
        let at_zero = phasing.phases(0.0, Facing::CounterClockwise);
        let first = at_zero.sun_planet[0];
        let list = |kind, phases: &[f64]| -> Vec<(MeshKind, usize, f64)> {
            phases.iter().enumerate().map(|(n, phase)| (kind, n, phase - first)).collect()
        };
        let mut offsets = list(MeshKind::SunPlanet, &at_zero.sun_planet);
        offsets.extend(list(MeshKind::RingPlanet, &at_zero.ring_planet));
        // The other flanks at the same sun angle. The planets stand where the flanks in front touch,
        // one sun-mesh backlash ahead of where the back flanks would.
        let at_back = phasing.phases(-first * pitch_angle(bodies), Facing::Clockwise);
        let normal = |kind| bodies.geometry.normal_backlash(kind).unwrap_or(0.0);
        let ahead = normal(MeshKind::SunPlanet) / bodies.geometry.base_pitch;
        let races = Races::new(scene, bodies, &positions.psi_rad)?;
        let imperfections = imperfections.mirrored(sign);
        let back = |kind, phases: &[f64], ahead: f64| -> Result<Vec<BackFlank>, FeError> {
            let frame = bodies.geometry.mesh(kind).and_then(|mesh| PairFrame::new(mesh, 0.3, 0));
            let row = mirrored(&frame.ok_or_else(|| missing_mesh(kind))?.approach_row());
            let one = |(planet, phase): (usize, &f64)| BackFlank {
                kind,
                planet,
                offset: phase + ahead,
                backlash: normal(kind),
                row: races.approach(kind, planet, &row).into(),
                shift: imperfections.shift(kind, planet, &row),
            };
            Ok(phases.iter().enumerate().map(one).collect())
        };
        let mut backs = back(MeshKind::SunPlanet, &at_back.sun_planet, 0.0)?;
        backs.extend(back(MeshKind::RingPlanet, &at_back.ring_planet, ahead)?);
        let start_angle = -first * pitch_angle(bodies);
        Ok(Self { bodies, races, sign, offsets, backs, start_angle, imperfections })
    }

    /// Equilibrium at `positions` even positions of one mesh cycle; `torque_nm` is the magnitude of
    /// the sun's torque, its sense being the set's.
    ///
    /// # Errors
    /// If contact cannot be solved, the cells do not suffice, or nothing holds the set.
    pub fn cycle(
        &self,
        torque_nm: f64,
        positions: usize,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        // Grids are sized for an even share of the load. Where a mesh carries far more (a planet out
        // of place), all are laid out anew for more.
        let share = torque_nm / self.races.radii[2] / self.races.planets() as f64;
        let mut sized_for = share.max(1.0);
        for _ in 0..RESIZINGS {
            match self.cycle_on(torque_nm, positions, sized_for, solver) {
                Err(FeError::GridOverflow { .. }) => sized_for *= 4.0,
                result => return result,
            }
        }
        self.cycle_on(torque_nm, positions, sized_for, solver)
    }

    fn cycle_on(
        &self,
        torque_nm: f64,
        positions: usize,
        sized_for: f64,
        solver: &(dyn ComplementaritySolver + Sync),
    ) -> Result<SetCycle, FeError> {
        let list: Vec<f64> = (0..positions).map(|i| i as f64 / positions as f64).collect();
        let tables = self.tables(sized_for, &list)?;
        let mut states = Vec::with_capacity(positions);
        let mut start = None;
        for position in list {
            let found = self.equilibrium(torque_nm, position, &tables, start.as_ref(), solver)?;
            states.push(self.state(&found));
            start = Some(found.q);
        }
        Ok(SetCycle { torque_nm: self.sign * torque_nm, states })
    }

    /// Tables for all meshes at the given positions (cycles), their grids sized for meshes that carry
    /// `force` (N).
    ///
    /// # Errors
    /// If a matching point lies outside its tooth.
    pub fn tables(&self, force: f64, positions: &[f64]) -> Result<SetTables, FeError> {
        let settings = self.bodies.cells(force);
        let mut wanted: Vec<(MeshKind, f64)> = Vec::new();
        let mut seen = std::collections::HashSet::new();
        for position in positions {
            for (kind, _, offset) in &self.offsets {
                let phase = cycle(position + offset);
                if seen.insert(key(*kind, phase)) {
                    wanted.push((*kind, phase));
                }
            }
        }
        let list: Result<Vec<_>, FeError> = wanted
            .par_iter()
            .map(|(kind, phase)| {
                let (mesh, pair) = self.bodies.joined(*kind)?;
                MeshTable::new(mesh, pair, *phase, &settings).map(Arc::new)
            })
            .collect();
        let place =
            wanted.iter().enumerate().map(|(i, (kind, phase))| (key(*kind, *phase), i)).collect();
        Ok(SetTables { list: list?, place, settings })
    }

    /// Generalised load of a torque on the sun (N m, magnitude) on the races' coordinates, N.
    pub(crate) fn load(&self, torque_nm: f64) -> DVector<f64> {
        let mut f = DVector::zeros(self.races.count);
        if let Some(i) = self.races.of(SUN, 2) {
            f[i] = torque_nm / self.races.radii[2];
        }
        f
    }

    /// Every mesh at a position, with its rows and gap offsets; the tables must hold its phases.
    pub(crate) fn place<'t>(&self, position: f64, tables: &'t SetTables) -> Vec<Placed<'t>> {
        let sun_angle = self.start_angle + position * pitch_angle(self.bodies);
        let sun = self.bodies.geometry.sun.as_ref();
        let one = |(kind, planet, offset): &(MeshKind, usize, f64)| {
            let phase = cycle(position + offset);
            let table = tables.list[tables.place_of(*kind, phase)].as_ref();
            let row = |p: &PairCells| self.races.approach(*kind, *planet, &p.row).into();
            let gap = |p: &PairCells| {
                self.imperfections.gap(*kind, *planet, p, &self.races, sun_angle, sun)
            };
            let rows = table.pairs.iter().map(row).collect();
            let offsets = table.pairs.iter().map(gap).collect();
            let table = Cow::Borrowed(table);
            Placed { kind: *kind, planet: *planet, phase, table, rows, offsets }
        };
        self.offsets.iter().map(one).collect()
    }

    /// Gap offsets of a front mesh's pairs (sun meshes, then ring meshes) after `turned` mesh cycles,
    /// m: tooth errors come round with the sun.
    pub(crate) fn write_offsets(
        &self,
        mesh: usize,
        table: &MeshTable,
        turned: f64,
        out: &mut [f64],
    ) {
        let (kind, planet, _) = self.offsets[mesh];
        let sun_angle = self.start_angle + turned * pitch_angle(self.bodies);
        let sun = self.bodies.geometry.sun.as_ref();
        for (out, pair) in out.iter_mut().zip(&table.pairs) {
            *out = self.imperfections.gap(kind, planet, pair, &self.races, sun_angle, sun);
        }
    }

    /// Whether gap offsets change from one mesh cycle to the next.
    pub(crate) fn has_tooth_errors(&self) -> bool {
        !self.imperfections.pitch_errors.is_empty()
    }

    /// Phase of a front mesh (sun meshes, then ring meshes) at a position, cycles in [0, 1).
    pub(crate) fn phase(&self, mesh: usize, position: f64) -> f64 {
        cycle(position + self.offsets[mesh].2)
    }

    /// Whether some tables hold the phases of all front meshes at a position.
    pub(crate) fn is_covered(&self, position: f64, tables: &SetTables) -> bool {
        self.offsets.iter().all(|(kind, _, offset)| tables.holds(*kind, cycle(position + offset)))
    }

    /// Where all meshes stand in their cycles at position 0: sun meshes, then ring meshes.
    pub(crate) fn law_starts(&self, has_backs: bool) -> Vec<MeshStart> {
        let each = self.offsets.iter().zip(&self.backs);
        let one = |((kind, _, front), back): (&(MeshKind, usize, f64), &BackFlank)| MeshStart {
            kind: *kind,
            front: *front,
            back: has_backs.then_some(back.offset),
        };
        each.map(one).collect()
    }

    /// The back flanks of all meshes at a position.
    pub(crate) fn place_backs(
        &self,
        position: f64,
        settings: &CellSettings,
    ) -> Result<Vec<Placed<'static>>, FeError> {
        self.backs.iter().map(|back| self.back(back, position, settings)).collect()
    }

    /// Whether any back flanks meet at these displacements.
    pub(crate) fn backs_touch(&self, q: &DVector<f64>) -> bool {
        self.backs.iter().any(|back| back.row.dot(q) - back.shift >= back.backlash)
    }

    /// The back flanks of one mesh: the mesh seen in the mirror along its line of centres. They
    /// share no compliance with the flanks in front.
    fn back(
        &self,
        back: &BackFlank,
        position: f64,
        settings: &CellSettings,
    ) -> Result<Placed<'static>, FeError> {
        let (mesh, pair) = self.bodies.joined(back.kind)?;
        let phase = cycle(back.offset - position);
        let table = MeshTable::new(mesh, pair, phase, settings)?;
        let mut rows = Vec::with_capacity(table.pairs.len());
        let mut offsets = Vec::with_capacity(table.pairs.len());
        for p in &table.pairs {
            let row = mirrored(&p.row);
            rows.push(DVector::from_vec(self.races.approach(back.kind, back.planet, &row)));
            offsets.push(back.backlash + self.imperfections.shift(back.kind, back.planet, &row));
        }
        let table = Cow::Owned(table);
        Ok(Placed { kind: back.kind, planet: back.planet, phase, table, rows, offsets })
    }

    /// Results in the frame of the scene.
    fn state(&self, found: &Equilibrium<'_>) -> SetState {
        let Equilibrium { position, q, meshes, answers, residual, counts } = found;
        let (central, planets) = self.displacements(q);
        let mut states: Vec<MeshState> =
            meshes.iter().zip(answers).map(|(mesh, answer)| mesh.state(q, answer)).collect();
        SetState {
            position: *position,
            central,
            planets,
            backs: states.split_off(self.offsets.len()),
            meshes: states,
            residual: *residual,
            iterations: counts.0,
            contact_iterations: counts.1,
        }
    }

    /// Displacements (m, m, rad) of carrier, ring, sun and of the planets in the frame of the scene.
    pub(crate) fn displacements(&self, q: &DVector<f64>) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let radii = self.races.radii;
        let of = |body: usize, radius: f64| {
            let value = |axis| self.races.of(body, axis).map_or(0.0, |i| q[i]);
            // Mirrored back: y and θ change sign.
            [value(0), self.sign * value(1), self.sign * value(2) / radius]
        };
        let planets = (0..self.races.planets()).map(|n| of(PLANETS + n, radii[3])).collect();
        ([0, 1, 2].map(|body| of(body, radii[body])), planets)
    }
}

/// Angle between the sun's teeth, rad.
fn pitch_angle(bodies: &Bodies) -> f64 {
    bodies.geometry.sun.as_ref().map_or(0.0, gearset::Gear::pitch_angle)
}

/// A pair's row seen in the mirror along the line of centres: y and θ turn round.
pub(crate) fn mirrored(row: &[f64; 6]) -> [f64; 6] {
    [row[0], -row[1], -row[2], row[3], -row[4], -row[5]]
}
