//! Slopes of the deformed flanks: how the compliance of a mesh changes as its pairs move along
//! them.
//!
//! κ ([`Slopes`]) is the slope that a pair meets as it moves along the deformed flanks. It contributes two to
//! five per cent of the second harmonic of the sun's rotation at rest; without it the forces of a
//! mesh are not the gradient of its energy. κ and rest are differences between contact tables to
//! either side: distributed loads, as at ports, would miss the effect of the tip edge on a patch
//! near it. On even cells that edge makes κ wrong by an amount proportional to the width of a cell, on
//! graded ones (`contact/cells.rs`) hardly.

use gearset::{DisplacedMesh, Mesh};
use nalgebra::{DMatrix, DVector};
use scene::CellLayout;

use super::bodies::Bodies;
use crate::complementarity::ComplementaritySolver;
use crate::contact::{CellSettings, MeshAnswer, MeshTable};
use crate::error::FeError;

/// Slopes of the flanks of one mesh under the forces of its pairs.
///
/// `[eq:flank-slopes]` κ_k = ∂E_k/∂σ, `rest` = ∂W/∂σ − κᵀP, and the same for a', with the elastic energy W(P, σ, a')
/// of a mesh whose pairs carry P and the elastic approach E_k = ∂W/∂P_k of pair k (the gap of tip relief included).
/// Source: derived here.
/// Checked by: `fe.kinematics.potential`, `fe_contact/src/statics/slopes.rs::slopes_at_tips_need_graded_cells`.
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
    is_graded: bool,
}

/// Steps of the differences along the line of action and of the centre distance, m.
const STEPS: [f64; 2] = [2e-5, 2e-5];

/// Cells per pair in tables of which only differences are taken, if the tables between them have `count`: fewer, but
/// more if these are more than the default 40, so that one number of cells governs the error of both.
fn few_cells(layout: CellLayout, count: usize) -> usize {
    match layout {
        CellLayout::Graded => count.min((2 * count / 5).max(16)),
        CellLayout::Even => count.min(20),
    }
}

impl NeighbourTables {
    /// Tables with few cells per pair, which suffice for differences.
    pub(crate) fn coarse(
        bodies: &Bodies,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
    ) -> Result<Self, FeError> {
        let cells = few_cells(bodies.settings.input.cell_layout, settings.cells);
        Self::new(bodies, mesh, phase, &CellSettings { cells, ..*settings }, STEPS)
    }

    /// The same for meshes that carry `at_rest` (N) if that is less than what the settings are for, and for pairs
    /// with gaps up to a quarter of that load's window only: up to the deflection of a mesh a third softer than one
    /// pair of steel teeth usually is. Pairs with larger gaps hardly ever carry load, and without load they change
    /// nothing; [`NeighbourTables::hold`] tells whether that suffices.
    pub(crate) fn nearest(
        bodies: &Bodies,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
        at_rest: f64,
    ) -> Result<Self, FeError> {
        // Even cells are those of kept results, laid out for the largest load.
        let is_graded = bodies.settings.input.cell_layout == CellLayout::Graded;
        let is_less = is_graded && at_rest > 0.0 && at_rest < settings.force;
        let force = if is_less { at_rest } else { settings.force };
        let window = 0.25 * settings.window * (force / settings.force);
        Self::coarse(bodies, mesh, phase, &CellSettings { force, window, ..*settings })
    }

    /// Whether all tables have all pairs of the table `between` them that carry `forces` (N).
    pub(crate) fn hold(&self, between: &MeshTable, forces: &[f64]) -> bool {
        let loaded = || between.pairs.iter().zip(forces).filter(|(_, p)| **p > 0.0);
        self.tables.iter().all(|(_, table)| {
            loaded().all(|(pair, _)| table.pairs.iter().any(|own| own.index == pair.index))
        })
    }

    /// Tables beside a phase (cycles) of a mesh, with steps in σ and a' (m), on cells in the layout of the scene.
    pub(super) fn new(
        bodies: &Bodies,
        mesh: &Mesh,
        phase: f64,
        settings: &CellSettings,
        steps: [f64; 2],
    ) -> Result<Self, FeError> {
        let (_, pair) = bodies.joined(mesh.kind)?;
        let settings = &CellSettings { layout: bodies.settings.input.cell_layout, ..*settings };
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
        Ok(Self { tables, steps, is_graded: settings.layout == CellLayout::Graded })
    }

    /// [`NeighbourTables::slopes`] on tables of the nearest pairs; `None` if these lack a pair that carries load, or
    /// are too small for it.
    ///
    /// # Errors
    /// If contact cannot be solved.
    pub(crate) fn slopes_of(
        &self,
        between: &MeshTable,
        forces: &[f64],
        solver: &dyn ComplementaritySolver,
    ) -> Result<Option<Slopes>, FeError> {
        if !self.hold(between, forces) {
            return Ok(None);
        }
        match self.slopes(between, forces, solver) {
            Err(FeError::GridOverflow { .. }) => Ok(None),
            found => found.map(Some),
        }
    }

    /// Slopes if the pairs of the table `between` the neighbours carry `forces` (N).
    ///
    /// # Errors
    /// If contact cannot be solved, or a patch reaches the end of its grid of graded cells
    /// ([`FeError::GridOverflow`]).
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
            let (own, answer) = elastic((mesh, table), between, forces, found.last(), solver)?;
            if self.is_graded {
                table.check_patches(&answer, 0, 0.0)?;
            }
            found.push(own);
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
) -> Result<(Elastic, MeshAnswer), FeError> {
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
            let active = now.active.clone();
            return Ok((Elastic { of_pairs, energy, active }, now));
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

#[cfg(test)]
mod tests {
    use gearset::MeshKind;
    use scene::Scene;

    use super::*;
    use crate::complementarity::ActiveSet;
    use crate::statics::press;

    /// Force of a mesh, N: the even share of 1413 N·m on four sun meshes of OH-58.
    const FORCE: f64 = 8900.0;

    /// Where tips cut patches short, even cells give slopes that are off by an amount proportional to their width,
    /// though a pair's force is long converged; graded cells do not, and few suffice.
    #[test]
    fn slopes_at_tips_need_graded_cells() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 8;
        let mut bodies = Bodies::new(&scene).unwrap();
        let mesh = bodies.geometry.mesh(MeshKind::SunPlanet).unwrap().clone();
        let phases = (0..20).map(|i| f64::from(i) / 20.0);
        let cells = bodies.cells(FORCE);
        let loaded: Vec<(MeshTable, Vec<f64>)> = phases
            .map(|phase| {
                let pair = bodies.pair(MeshKind::SunPlanet).unwrap();
                let table = MeshTable::new(&mesh, pair, phase, &cells).unwrap();
                let (_, answer) = press(&table, &mesh, FORCE, &ActiveSet).unwrap();
                (table, answer.pair_forces)
            })
            .collect();
        // κ with respect to σ of all pairs at all phases.
        let mut kappas = |layout: CellLayout, count: usize| -> Vec<f64> {
            bodies.settings.input.cell_layout = layout;
            let settings = CellSettings { cells: count, ..cells };
            let of = |(table, forces): &(MeshTable, Vec<f64>)| {
                let phase = table.phase;
                let beside = NeighbourTables::new(&bodies, &mesh, phase, &settings, STEPS).unwrap();
                let slopes = beside.slopes(table, forces, &ActiveSet).unwrap();
                slopes.of_pairs.into_iter().map(|of| of[0])
            };
            loaded.iter().flat_map(of).collect()
        };
        let fine = kappas(CellLayout::Graded, 120);
        let size: f64 = fine.iter().map(|k| k.abs()).sum();
        let mut off = |layout: CellLayout, count: usize| {
            let own = kappas(layout, count);
            let off: f64 = own.iter().zip(&fine).map(|(a, b)| (a - b).abs()).sum();
            println!("{layout:?} {count} cells: slopes off by {:.2} %", 100.0 * off / size);
            off / size
        };
        let [even, graded] = [CellLayout::Even, CellLayout::Graded]
            .map(|layout| [16, 20, 40, 80].map(|count| off(layout, count)));
        let order = |off: [f64; 2], times: f64| (off[0] / off[1]).log2() / times;
        let of_even = order([even[1], even[3]], 2.0);
        assert!((0.7..1.4).contains(&of_even), "{of_even} {even:?}");
        let of_graded = order([graded[1], graded[2]], 1.0);
        assert!(of_graded > 1.5, "{of_graded} {graded:?}");
        assert!(graded[0] < 0.5 * even[1] && graded[2] < 0.5 * even[3], "{graded:?} {even:?}");
    }
}
