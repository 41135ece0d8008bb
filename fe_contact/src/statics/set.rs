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

use gearset::{Facing, MeshKind, Phasing, PlanetPositions, Scene};

use super::bodies::{Bodies, missing_mesh};
use super::imperfection::Imperfections;
use super::placed::Placed;
use super::races::{PLANETS, Races, SUN};
use super::state::{MeshState, SetCycle, SetState};
use crate::complementarity::ComplementaritySolver;
use crate::contact::{CellSettings, MeshAnswer, MeshTable, PairFrame};
use crate::error::FeError;

/// A set ready for static loads.
#[derive(Debug)]
pub struct StaticSet<'s> {
    bodies: &'s Bodies,
    races: Races,
    /// Seen in the mirror if the torque is clockwise, so that the loaded flanks always are those of
    /// a counter-clockwise one.
    sign: f64,
    /// Phases of all meshes with planet 0's sun mesh at phase 0: sun meshes, then ring meshes.
    offsets: Vec<(MeshKind, usize, f64)>,
    /// The same for the back flanks, whose phases run backwards, with their normal backlash, m.
    backs: Vec<BackFlank>,
    /// Sun's angle (mirrored frame) where planet 0's sun mesh is at phase 0, rad.
    start_angle: f64,
    imperfections: Imperfections,
}

/// The back flanks of one mesh.
#[derive(Debug, Clone, Copy)]
struct BackFlank {
    kind: MeshKind,
    planet: usize,
    /// Phase of the mirrored mesh at position 0, cycles.
    offset: f64,
    /// Normal backlash: what the flanks stand apart when those in front just touch, m.
    backlash: f64,
}

/// Tables of all (mesh kind, phase) a cycle needs; equal phases share one.
type Tables = HashMap<(MeshKind, i64), MeshTable>;

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
        let back = |kind, phases: &[f64], ahead: f64| -> Vec<BackFlank> {
            let one = |(planet, phase): (usize, &f64)| BackFlank {
                kind,
                planet,
                offset: phase + ahead,
                backlash: normal(kind),
            };
            phases.iter().enumerate().map(one).collect()
        };
        let mut backs = back(MeshKind::SunPlanet, &at_back.sun_planet, 0.0);
        backs.extend(back(MeshKind::RingPlanet, &at_back.ring_planet, ahead));
        let start_angle = -first * pitch_angle(bodies);
        let races = Races::new(scene, bodies, &positions.psi_rad)?;
        let imperfections = imperfections.mirrored(sign);
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
        let settings = self.bodies.cells(sized_for);
        let tables = self.tables(&settings, &list)?;
        let mut states = Vec::with_capacity(positions);
        let mut start = None;
        for position in list {
            let with = (&tables, &settings);
            let (q, state) = self.solve(torque_nm, position, with, start.as_ref(), solver)?;
            start = Some(q);
            states.push(state);
        }
        Ok(SetCycle { torque_nm: self.sign * torque_nm, states })
    }

    /// Tables for all meshes at the given positions.
    fn tables(&self, settings: &CellSettings, positions: &[f64]) -> Result<Tables, FeError> {
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
        let made: Result<Vec<_>, FeError> = wanted
            .par_iter()
            .map(|(kind, phase)| {
                let (mesh, pair) = self.bodies.joined(*kind)?;
                Ok((key(*kind, *phase), MeshTable::new(mesh, pair, *phase, settings)?))
            })
            .collect();
        Ok(made?.into_iter().collect())
    }

    fn solve(
        &self,
        torque_nm: f64,
        position: f64,
        (tables, settings): (&Tables, &CellSettings),
        start: Option<&DVector<f64>>,
        solver: &dyn ComplementaritySolver,
    ) -> Result<(DVector<f64>, SetState), FeError> {
        let n = self.races.count;
        let load = torque_nm / self.races.radii[2];
        let mut f = DVector::zeros(n);
        if let Some(i) = self.races.of(SUN, 2) {
            f[i] = load;
        }
        let sun_angle = self.start_angle + position * pitch_angle(self.bodies);
        // Every mesh with its rows and gap offsets.
        let mut meshes: Vec<Placed<'_>> = self
            .offsets
            .iter()
            .map(|(kind, planet, offset)| {
                let phase = cycle(position + offset);
                let table = &tables[&key(*kind, phase)];
                let rows: Vec<DVector<f64>> = table
                    .pairs
                    .iter()
                    .map(|p| DVector::from_vec(self.races.approach(*kind, *planet, &p.row)))
                    .collect();
                let offsets = table
                    .pairs
                    .iter()
                    .map(|p| {
                        let sun = self.bodies.geometry.sun.as_ref();
                        self.imperfections.gap(*kind, *planet, p, &self.races, sun_angle, sun)
                    })
                    .collect();
                let table = Cow::Borrowed(table);
                Placed { kind: *kind, planet: *planet, phase, table, rows, offsets }
            })
            .collect();
        if load == 0.0 {
            let answers = meshes.iter().map(Placed::untouched).collect::<Vec<_>>();
            let q = DVector::zeros(n);
            let state = self.state(position, &q, &meshes, &answers, 0.0, (0, 0));
            return Ok((q, state));
        }
        let mut q = match start {
            Some(q) => q.clone(),
            None => self.first_guess(&f, &meshes)?,
        };
        let (mut found, mut counts) = self.balance(&f, load, &mut q, &meshes, solver)?;
        if self.backs_touch(&q)? {
            for back in &self.backs {
                meshes.push(self.back(back, position, settings)?);
            }
            let (again, more) = self.balance(&f, load, &mut q, &meshes, solver)?;
            (found, counts) = (again, (counts.0 + more.0, counts.1 + more.1));
        }
        let (answers, residual) = found;
        for (mesh, answer) in meshes.iter().zip(&answers) {
            // A mesh that carries next to nothing rests on few cells, and that decides nothing.
            mesh.table.check_patches(answer, LEAST_CELLS, 0.2 * settings.force)?;
            mesh.check_window(&q)?;
        }
        let state = self.state(position, &q, &meshes, &answers, residual, counts);
        Ok((q, state))
    }

    /// Whether any back flanks meet at these displacements.
    fn backs_touch(&self, q: &DVector<f64>) -> Result<bool, FeError> {
        for back in &self.backs {
            let mesh = self.bodies.geometry.mesh(back.kind);
            let frame = mesh.and_then(|mesh| PairFrame::new(mesh, 0.3, 0));
            let row = frame.map(|frame| mirrored(&frame.approach_row()));
            let row = row.ok_or_else(|| missing_mesh(back.kind))?;
            let b = DVector::from_vec(self.races.approach(back.kind, back.planet, &row));
            let shift = self.imperfections.shift(back.kind, back.planet, &row);
            if b.dot(q) - shift >= back.backlash {
                return Ok(true);
            }
        }
        Ok(false)
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
    fn state(
        &self,
        position: f64,
        q: &DVector<f64>,
        meshes: &[Placed<'_>],
        answers: &[MeshAnswer],
        residual: f64,
        (iterations, contact_iterations): (usize, usize),
    ) -> SetState {
        let of = |body: usize, radius: f64| {
            let value = |axis| self.races.of(body, axis).map_or(0.0, |i| q[i]);
            // Mirrored back: y and θ change sign.
            [value(0), self.sign * value(1), self.sign * value(2) / radius]
        };
        let radii = self.races.radii;
        let mut states: Vec<MeshState> =
            meshes.iter().zip(answers).map(|(mesh, answer)| mesh.state(q, answer)).collect();
        SetState {
            position,
            central: [0, 1, 2].map(|body| of(body, radii[body])),
            planets: (0..self.races.planets()).map(|n| of(PLANETS + n, radii[3])).collect(),
            backs: states.split_off(self.offsets.len()),
            meshes: states,
            residual,
            iterations,
            contact_iterations,
        }
    }
}

/// Answers of all meshes with the largest residual over the load; equilibrium and contact iterations.
type Balance = ((Vec<MeshAnswer>, f64), (usize, usize));

/// Angle between the sun's teeth, rad.
fn pitch_angle(bodies: &Bodies) -> f64 {
    bodies.geometry.sun.as_ref().map_or(0.0, gearset::Gear::pitch_angle)
}

/// A pair's row seen in the mirror along the line of centres: y and θ turn round.
fn mirrored(row: &[f64; 6]) -> [f64; 6] {
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
