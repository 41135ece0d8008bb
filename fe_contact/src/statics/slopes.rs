//! Slopes of the deformed flanks: how the compliance of a mesh changes as its pairs move along
//! them.
//!
//! With W(P, σ, a') the elastic energy of a mesh whose pairs carry P, and E_k = ∂W/∂P_k the elastic
//! approach of pair k (the gap of tip relief included),
//!
//! ```text
//! κ_k = ∂E_k/∂σ,  rest = ∂W/∂σ − κᵀP        (and the same for a')
//! ```
//!
//! κ is the slope that a pair meets as it moves along the deformed flanks. It contributes two to
//! five per cent of the second harmonic of the sun's rotation at rest; without it the forces of a
//! mesh are not the gradient of its energy. κ and rest are differences between contact tables to
//! either side: distributed loads, as at ports, would miss the effect of the tip edge on a patch
//! near it.

use gearset::{DisplacedMesh, Mesh};
use nalgebra::{DMatrix, DVector};

use super::bodies::Bodies;
use crate::complementarity::ComplementaritySolver;
use crate::contact::{CellSettings, MeshAnswer, MeshTable};
use crate::error::FeError;

/// Slopes of the flanks of one mesh under the forces of its pairs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Slopes {
    /// κ of each pair with respect to σ and a', m/m.
    pub(crate) of_pairs: Vec<[f64; 2]>,
    /// ∂W/∂σ and ∂W/∂a' less κᵀP, N.
    pub(crate) rest: [f64; 2],
}

/// Contact tables of a mesh with σ increased and decreased by a step, and with a' increased and
/// decreased by a step.
#[derive(Debug, Clone)]
pub(crate) struct NeighbourTables {
    tables: Vec<(Mesh, MeshTable)>,
    steps: [f64; 2],
}

/// Steps of the differences along the line of action and of the centre distance, m.
const STEPS: [f64; 2] = [2e-5, 2e-5];

/// Most cells per pair in tables of which only differences are taken.
const CELLS: usize = 20;

impl NeighbourTables {
    /// Tables with at most 20 cells per pair, which suffice for differences.
    pub(crate) fn coarse(
        bodies: &Bodies,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
    ) -> Result<Self, FeError> {
        let cells = settings.cells.min(CELLS);
        Self::new(bodies, mesh, phase, &CellSettings { cells, ..*settings }, STEPS)
    }

    /// The same for pairs with gaps up to a quarter of the window only: up to the deflection of a mesh a
    /// third softer than one pair of steel teeth usually is. Pairs with larger gaps hardly ever carry
    /// load, and without load they change nothing; [`NeighbourTables::hold`] tells whether that suffices.
    pub(crate) fn nearest(
        bodies: &Bodies,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
    ) -> Result<Self, FeError> {
        let window = 0.25 * settings.window;
        Self::coarse(bodies, mesh, phase, &CellSettings { window, ..*settings })
    }

    /// Whether all tables have all pairs of the table `between` them that carry `forces` (N).
    pub(crate) fn hold(&self, between: &MeshTable, forces: &[f64]) -> bool {
        let loaded = || between.pairs.iter().zip(forces).filter(|(_, p)| **p > 0.0);
        self.tables.iter().all(|(_, table)| {
            loaded().all(|(pair, _)| table.pairs.iter().any(|own| own.index == pair.index))
        })
    }

    /// Tables beside a phase (cycles) of a mesh, with steps in σ and a' (m).
    pub(super) fn new(
        bodies: &Bodies,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
        steps: [f64; 2],
    ) -> Result<Self, FeError> {
        let (_, pair) = bodies.joined(mesh.kind)?;
        let roll_length = mesh.path_start + phase * mesh.base_pitch;
        let mut tables = Vec::with_capacity(4);
        for (which, step) in steps.into_iter().enumerate() {
            for sign in [1.0, -1.0] {
                let (mesh, roll_length) = match which {
                    0 => (mesh.clone(), roll_length + sign * step),
                    _ => {
                        let distance = mesh.center_distance + sign * step;
                        (super::reference::moved(bodies, mesh.kind, distance)?, roll_length)
                    }
                };
                let phase = (roll_length - mesh.path_start) / mesh.base_pitch;
                let table = MeshTable::new(&mesh, pair, phase, settings)?;
                tables.push((mesh, table));
            }
        }
        Ok(Self { tables, steps })
    }

    /// Slopes if the pairs of the table `between` the neighbours carry `forces` (N).
    pub(crate) fn slopes(
        &self,
        between: &MeshTable,
        forces: &[f64],
        solver: &dyn ComplementaritySolver,
    ) -> Result<Slopes, FeError> {
        let mut slopes = Slopes { of_pairs: vec![[0.0; 2]; forces.len()], rest: [0.0; 2] };
        if forces.iter().all(|p| *p <= 0.0) {
            return Ok(slopes);
        }
        let mut found: Vec<Elastic> = Vec::with_capacity(self.tables.len());
        for (mesh, table) in &self.tables {
            // Each starts from the one before, a few hundredths of a millimetre away.
            found.push(elastic((mesh, table), between, forces, found.last(), solver)?);
        }
        for (which, (step, ends)) in self.steps.into_iter().zip(found.chunks(2)).enumerate() {
            let [after, before] = ends else { continue };
            slopes.rest[which] = (after.energy - before.energy) / (2.0 * step);
            for (k, force) in forces.iter().enumerate() {
                let kappa = (after.of_pairs[k] - before.of_pairs[k]) / (2.0 * step);
                slopes.of_pairs[k][which] = kappa;
                slopes.rest[which] -= kappa * force;
            }
        }
        Ok(slopes)
    }
}

/// Pose of a mesh whose flanks, without tip relief, just touch at a phase (cycles).
pub(super) fn unrelieved(mesh: &Mesh, phase: f64) -> Result<DisplacedMesh, FeError> {
    mesh.displaced(phase, &[0.0; 6]).map_err(|cause| FeError::NoEquilibrium(cause.to_string()))
}

/// Most Newton iterations for the approaches under given forces.
const MOST: usize = 80;

/// Approach beyond first contact (m) from which the iteration for a loaded pair starts; an
/// iteration changes an approach by at most this much.
const STRIDE: f64 = 1e-5;

/// Elastic state of the pairs of one table under given forces.
struct Elastic {
    /// Elastic approach E, tip relief included, m: of all pairs of the table between.
    of_pairs: Vec<f64>,
    /// Elastic energy W = PᵀE − ½ pᵀCp, J.
    energy: f64,
    /// Cells that touch.
    active: Vec<bool>,
}

/// Elastic state of pairs on `table` under the `forces` (N) that the pairs of the same numbers carry on
/// the table `between`; `near`: that on a table nearby, to start from.
fn elastic(
    (mesh, table): (&Mesh, &MeshTable),
    between: &MeshTable,
    forces: &[f64],
    near: Option<&Elastic>,
    solver: &dyn ComplementaritySolver,
) -> Result<Elastic, FeError> {
    let still = unrelieved(mesh, table.phase)?;
    let pairs: Vec<(usize, usize)> = (0..forces.len())
        .filter(|k| forces[*k] > 0.0)
        .filter_map(|k| {
            let index = between.pairs[k].index;
            Some((k, table.pairs.iter().position(|p| p.index == index)?))
        })
        .collect();
    let wanted = DVector::from_iterator(pairs.len(), pairs.iter().map(|p| forces[p.0]));
    let gap = |j: usize| still.clearance(mesh, table.pairs[j].index).unwrap_or(0.0);
    // Pairs without force are kept apart.
    let mut approaches = vec![-1.0; table.pairs.len()];
    let none = vec![0.0; table.pairs.len()];
    for (k, j) in &pairs {
        let start = near.map_or(table.pairs[*j].relief + STRIDE, |near| near.of_pairs[*k]);
        approaches[*j] = gap(*j) + start;
    }
    let mut warm: Option<Vec<bool>> = near.map(|near| near.active.clone());
    let mut residual = f64::INFINITY;
    let mut now = table.answer(&approaches, &none, solver, warm.as_deref())?;
    // The approaches are where φ = Pᵀa − W(a) is largest; W is convex, as contact only stiffens.
    for _ in 0..MOST {
        let off = off_by(&pairs, &wanted, &now);
        residual = off.amax() / wanted.amax().max(f64::MIN_POSITIVE);
        if residual < 1e-10 {
            let mut of_pairs = vec![0.0; forces.len()];
            let mut energy = -now.energy;
            for ((k, j), p) in pairs.iter().zip(wanted.iter()) {
                of_pairs[*k] = approaches[*j] - gap(*j);
                energy += p * of_pairs[*k];
            }
            return Ok(Elastic { of_pairs, energy, active: now.active });
        }
        let step = ascent(&pairs, &off, &now);
        let slope = off.dot(&step);
        let potential = |approaches: &[f64], answer: &MeshAnswer| {
            let work = pairs.iter().zip(wanted.iter()).map(|((_, j), p)| p * approaches[*j]);
            work.sum::<f64>() - answer.energy
        };
        let before = potential(&approaches, &now);
        warm = now.active.iter().any(|a| *a).then_some(now.active);
        let mut scale = 1.0;
        loop {
            let mut trial = approaches.clone();
            for (i, (_, j)) in pairs.iter().enumerate() {
                trial[*j] += scale * step[i];
            }
            let there = table.answer(&trial, &none, solver, warm.as_deref())?;
            let rounding = 1e-12 * (before.abs() + slope.abs());
            let gain = potential(&trial, &there) - before;
            if gain >= 1e-4 * scale * slope - rounding || scale < 1e-6 {
                (approaches, now) = (trial, there);
                break;
            }
            scale *= 0.5;
        }
    }
    Err(FeError::NotConverged { iterations: MOST, residual })
}

/// Forces wanted less forces found (N) of the loaded pairs.
fn off_by(pairs: &[(usize, usize)], wanted: &DVector<f64>, now: &MeshAnswer) -> DVector<f64> {
    let found = pairs.iter().map(|(_, j)| now.pair_forces[*j]);
    wanted - DVector::from_iterator(pairs.len(), found)
}

/// Direction (m) in which Pᵀa − W(a) grows: Newton's for the pairs that touch, towards contact for those that lost it
/// in the iteration, whose forces do not depend on their approaches.
fn ascent(pairs: &[(usize, usize)], off: &DVector<f64>, now: &MeshAnswer) -> DVector<f64> {
    let touching: Vec<usize> =
        (0..pairs.len()).filter(|i| now.pair_forces[pairs[*i].1] > 0.0).collect();
    let tangent = DMatrix::from_fn(touching.len(), touching.len(), |a, b| {
        now.tangent[(pairs[touching[a]].1, pairs[touching[b]].1)]
    });
    let unbalanced = DVector::from_fn(touching.len(), |a, _| off[touching[a]]);
    let mut step = DVector::from_element(pairs.len(), 0.2 * STRIDE);
    if let Some(factor) = tangent.cholesky() {
        let newton = factor.solve(&unbalanced);
        let most = newton.amax().max(STRIDE) / STRIDE;
        for (a, i) in touching.iter().enumerate() {
            step[*i] = newton[a] / most;
        }
    } else {
        for i in &touching {
            step[*i] *= off[*i].signum();
        }
    }
    step
}
