//! Static equilibrium of a whole set: all 2N meshes in contact together.
//!
//! The races' coordinates q minimise the convex potential
//!
//! ```text
//! Φ(q) = ½ qᵀ K q − fᵀ q + Σ_meshes Ψ(B q),   Ψ(δ) = max over p ≥ 0 of pᵀ(δ − g) − ½ pᵀ C p
//! ```
//!
//! whose gradient is K q − f + Σ P b (forces P of the pairs, rows b) and whose Hessian is
//! K + Σ bᵀ S b with the meshes' tangents S. Newton's method with a line search ends in finitely
//! many steps, since Ψ is piecewise quadratic.

use std::borrow::Cow;
use std::collections::HashMap;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use gearset::{Facing, MeshKind, MeshStart, Phasing, PlanetPositions, Scene};

use super::bodies::{Bodies, missing_mesh};
use super::imperfection::Imperfections;
use super::placed::Placed;
use super::races::{PLANETS, Races, SUN};
use super::state::{MeshState, SetCycle, SetState};
use crate::complementarity::ComplementaritySolver;
use crate::contact::{CellSettings, MeshAnswer, MeshTable, PairCells, PairFrame};
use crate::error::FeError;

/// A set ready for static loads.
#[derive(Debug)]
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
    pub list: Vec<MeshTable>,
    place: HashMap<(MeshKind, i64), usize>,
    /// Settings they were made with.
    pub settings: CellSettings,
}

impl SetTables {
    /// Memory of the compliances, bytes.
    pub fn bytes(&self) -> usize {
        self.list.iter().map(|table| 8 * table.compliance.len()).sum()
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

/// Fewest loaded cells a patch may have.
const LEAST_CELLS: usize = 6;

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
                MeshTable::new(mesh, pair, *phase, &settings)
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
            let table = &tables.list[tables.place_of(*kind, phase)];
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

    /// Equilibrium at one position.
    ///
    /// # Errors
    /// As [`StaticSet::cycle`].
    pub(crate) fn equilibrium<'t>(
        &self,
        torque_nm: f64,
        position: f64,
        tables: &'t SetTables,
        start: Option<&DVector<f64>>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<Equilibrium<'t>, FeError> {
        let f = self.load(torque_nm);
        let load = f.amax();
        let mut meshes = self.place(position, tables);
        if load == 0.0 {
            let answers = meshes.iter().map(Placed::untouched).collect::<Vec<_>>();
            let q = DVector::zeros(self.races.count);
            return Ok(Equilibrium { position, q, meshes, answers, residual: 0.0, counts: (0, 0) });
        }
        let mut q = match start {
            Some(q) => q.clone(),
            None => self.first_guess(&f, &meshes)?,
        };
        let (mut found, mut counts) = self.balance(&f, load, &mut q, &meshes, solver)?;
        if self.backs_touch(&q) {
            meshes.extend(self.place_backs(position, &tables.settings)?);
            let (again, more) = self.balance(&f, load, &mut q, &meshes, solver)?;
            (found, counts) = (again, (counts.0 + more.0, counts.1 + more.1));
        }
        let (answers, residual) = found;
        for (mesh, answer) in meshes.iter().zip(&answers) {
            // A mesh that carries next to nothing rests on few cells, and that decides nothing.
            mesh.table.check_patches(answer, LEAST_CELLS, 0.2 * tables.settings.force)?;
            mesh.check_window(&q)?;
        }
        Ok(Equilibrium { position, q, meshes, answers, residual, counts })
    }

    /// Finds equilibrium anew after gap offsets were changed.
    pub(crate) fn settle(
        &self,
        torque_nm: f64,
        found: &mut Equilibrium<'_>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(), FeError> {
        let f = self.load(torque_nm);
        let ((answers, residual), counts) =
            self.balance(&f, f.amax(), &mut found.q, &found.meshes, solver)?;
        (found.answers, found.residual, found.counts) = (answers, residual, counts);
        Ok(())
    }

    /// Phase of a front mesh (sun meshes, then ring meshes) at a position, cycles in [0, 1).
    pub(crate) fn phase(&self, mesh: usize, position: f64) -> f64 {
        cycle(position + self.offsets[mesh].2)
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

    /// Newton's method from q; answers of all meshes with the residual, and the iterations it took.
    fn balance(
        &self,
        f: &DVector<f64>,
        load: f64,
        q: &mut DVector<f64>,
        meshes: &[Placed<'_>],
        solver: &dyn ComplementaritySolver,
    ) -> Result<Balance, FeError> {
        const MOST: usize = 60;
        let mut warm: Vec<Option<Vec<bool>>> = meshes.iter().map(|m| Some(m.guess())).collect();
        let mut contact_iterations = 0;
        let mut evaluate = |q: &DVector<f64>, warm: &mut Vec<Option<Vec<bool>>>| {
            let mut answers = Vec::with_capacity(meshes.len());
            for (mesh, warm) in meshes.iter().zip(warm.iter_mut()) {
                let answer = mesh.answer(q, solver, warm.as_deref())?;
                contact_iterations += answer.iterations;
                if answer.active.iter().any(|a| *a) {
                    *warm = Some(answer.active.clone());
                }
                answers.push(answer);
            }
            Ok::<_, FeError>(answers)
        };
        let potential = |q: &DVector<f64>, answers: &[MeshAnswer]| {
            let energy: f64 = answers.iter().map(|a| a.energy).sum();
            0.5 * (&self.races.stiffness * q).dot(q) - f.dot(q) + energy
        };
        let mut answers = evaluate(q, &mut warm)?;
        let mut residual = f64::INFINITY;
        for iteration in 1..=MOST {
            let mut r = f - &self.races.stiffness * &*q;
            let mut hessian = self.races.stiffness.clone();
            for (mesh, answer) in meshes.iter().zip(&answers) {
                mesh.add_to(&mut r, &mut hessian, answer);
            }
            residual = r.amax() / load;
            if residual < 1e-11 {
                return Ok(((answers, residual), (iteration, contact_iterations)));
            }
            // A mesh out of contact leaves the matrix singular: lend it the first guess's springs.
            let step = match definite(hessian.clone()) {
                Some(factor) => factor.solve(&r),
                None => {
                    for mesh in meshes {
                        mesh.add_nominal(&mut hessian, self.nominal_stiffness());
                    }
                    definite(hessian).ok_or_else(turns_freely)?.solve(&r)
                }
            };
            let (before, slope) = (potential(q, &answers), r.dot(&step));
            let mut scale = 1.0;
            loop {
                let trial = &*q + scale * &step;
                let found = evaluate(&trial, &mut warm)?;
                let rounding = 1e-12 * (before.abs() + slope.abs());
                if potential(&trial, &found) <= before - 1e-4 * scale * slope + rounding
                    || scale < 1e-6
                {
                    (*q, answers) = (trial, found);
                    break;
                }
                scale *= 0.5;
            }
        }
        Err(FeError::NotConverged { iterations: MOST, residual })
    }

    /// E b/13: about the stiffness of one pair of steel teeth per unit length.
    fn nominal_stiffness(&self) -> f64 {
        self.bodies.material.young * self.bodies.geometry.face_width / 13.0
    }

    /// Equilibrium with a spring in each mesh's nearest pair.
    fn first_guess(
        &self,
        f: &DVector<f64>,
        meshes: &[Placed<'_>],
    ) -> Result<DVector<f64>, FeError> {
        let mut matrix = self.races.stiffness.clone();
        for mesh in meshes {
            mesh.add_nominal(&mut matrix, self.nominal_stiffness());
        }
        Ok(definite(matrix).ok_or_else(turns_freely)?.solve(f))
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

/// A set in equilibrium.
#[derive(Debug)]
pub(crate) struct Equilibrium<'t> {
    pub(crate) position: f64,
    /// Races' coordinates, m.
    pub(crate) q: DVector<f64>,
    /// Sun meshes, ring meshes, and the back flanks if any touch.
    pub(crate) meshes: Vec<Placed<'t>>,
    pub(crate) answers: Vec<MeshAnswer>,
    /// Largest imbalance over the load.
    pub(crate) residual: f64,
    /// Equilibrium and contact iterations.
    pub(crate) counts: (usize, usize),
}

/// Answers of all meshes with the largest residual over the load; equilibrium and contact iterations.
type Balance = ((Vec<MeshAnswer>, f64), (usize, usize));

/// Angle between the sun's teeth, rad.
fn pitch_angle(bodies: &Bodies) -> f64 {
    bodies.geometry.sun.as_ref().map_or(0.0, gearset::Gear::pitch_angle)
}

/// A pair's row seen in the mirror along the line of centres: y and θ turn round.
pub(crate) fn mirrored(row: &[f64; 6]) -> [f64; 6] {
    [row[0], -row[1], -row[2], row[3], -row[4], -row[5]]
}

/// Cholesky factor of a matrix that is positive definite by more than rounding.
fn definite(matrix: DMatrix<f64>) -> Option<Cholesky<f64, nalgebra::Dyn>> {
    let diagonal = matrix.diagonal();
    let factor = Cholesky::new(matrix)?;
    let l = factor.l_dirty();
    let is_sound = (0..diagonal.len()).all(|i| l[(i, i)].powi(2) > 1e-11 * diagonal[i]);
    is_sound.then_some(factor)
}

fn turns_freely() -> FeError {
    FeError::NoEquilibrium(
        "the set can turn freely under the torque: hold the rotation of two central members, or \
         give them a torsional support"
            .into(),
    )
}
