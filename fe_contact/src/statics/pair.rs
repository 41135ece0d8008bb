//! One mesh alone: driven gear held, driving gear turned by a constant torque.

use gearset::{Mesh, MeshKind, MeshMember};

use super::bodies::Bodies;
use crate::complementarity::ComplementaritySolver;
use crate::contact::hertz::{self, Hertz};
use crate::contact::{MeshAnswer, MeshTable};
use crate::error::FeError;

/// Load of one tooth pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothPairLoad {
    /// Pair k.
    pub index: i64,
    /// Force, N.
    pub force: f64,
    /// Largest cell pressure, Pa.
    pub peak_pressure: f64,
}

/// Equilibrium of one mesh at one phase.
#[derive(Debug, Clone)]
pub struct PairAtPhase {
    /// Phase, cycles.
    pub phase: f64,
    /// δ = r_b · elastic rotation of the driving gear, m.
    pub deflection: f64,
    /// ∂F/∂δ at the load, N/m.
    pub tangent: f64,
    /// Slope from a 1 % load step, N/m.
    pub step_tangent: f64,
    /// Loaded pairs.
    pub pairs: Vec<ToothPairLoad>,
    /// Iterations of the contact solver.
    pub iterations: usize,
    /// Contact cells with gaps and compliance.
    pub table: MeshTable,
    /// Forces and cells in contact.
    pub answer: MeshAnswer,
}

/// Pressure along the flank of one tooth pair.
#[derive(Debug, Clone, PartialEq)]
pub struct PressureProfile {
    /// Pair k stands k base pitches on from pair 0.
    pub index: i64,
    /// Middles of the cells along the flank, from the pair's reference point, m.
    pub places: Vec<f64>,
    /// Pressure in each, Pa.
    pub pressures: Vec<f64>,
    /// Half the length of the grid, m.
    pub half_length: f64,
    /// The ellipse nearest to the pressures; `None` with fewer than four loaded cells.
    pub ellipse: Option<Hertz>,
}

impl PairAtPhase {
    /// Pressure of entry `k` of the table's pairs, whose force is `answer.pair_forces[k]`; `None` if there
    /// is no such entry.
    pub fn pressure_profile(&self, k: usize) -> Option<PressureProfile> {
        let cells = self.table.pairs.get(k)?;
        let pressures = self.table.pressures(k, &self.answer.cell_forces);
        Some(PressureProfile {
            index: cells.index,
            ellipse: hertz::fit(&cells.x, &pressures),
            half_length: 0.5 * cells.length,
            places: cells.x.clone(),
            pressures,
        })
    }
}

/// One mesh cycle of one mesh.
#[derive(Debug, Clone)]
pub struct PairCycle {
    /// Which mesh.
    pub kind: MeshKind,
    /// Normal force F: torque on the driving gear over its base radius, N.
    pub force: f64,
    /// Positions, phase 0 first.
    pub positions: Vec<PairAtPhase>,
}

impl PairCycle {
    fn mean(&self, of: impl Fn(&PairAtPhase) -> f64) -> f64 {
        self.positions.iter().map(of).sum::<f64>() / self.positions.len() as f64
    }

    /// F/δ at one of the positions, N/m.
    pub fn secant_stiffness(&self, position: &PairAtPhase) -> f64 {
        self.force / position.deflection
    }

    /// Mean over the positions of F/δ, N/m.
    pub fn mean_secant_stiffness(&self) -> f64 {
        self.mean(|p| self.secant_stiffness(p))
    }

    /// Force of one tooth pair from first to last contact: position in base pitches from the start
    /// of the path of contact, and force (N), sorted by position.
    ///
    /// Pair k at phase φ is where pair 0 is at φ + k, so that one mesh cycle of all pairs gives the
    /// whole passage of one pair.
    pub fn load_of_one_pair(&self) -> Vec<(f64, f64)> {
        let at = |p: &PairAtPhase| {
            let phase = p.phase;
            p.pairs.clone().into_iter().map(move |load| (phase + load.index as f64, load.force))
        };
        let mut list: Vec<(f64, f64)> = self.positions.iter().flat_map(at).collect();
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        list
    }

    /// Position at which a single pair carries the largest force, and the index of that pair in the
    /// position's table.
    pub fn heaviest_pair(&self) -> Option<(&PairAtPhase, usize)> {
        let of = |p: &PairAtPhase| p.answer.pair_forces.iter().copied().fold(0.0, f64::max);
        let p = self.positions.iter().max_by(|a, b| of(a).total_cmp(&of(b)))?;
        let forces = &p.answer.pair_forces;
        (0..forces.len()).max_by(|a, b| forces[*a].total_cmp(&forces[*b])).map(|k| (p, k))
    }

    /// Mean over the positions of ΔF/Δδ for a load step of 1 %, N/m.
    pub fn mean_tangent_stiffness(&self) -> f64 {
        self.mean(|p| p.step_tangent)
    }

    /// Mean of δ, m.
    pub fn mean_deflection(&self) -> f64 {
        self.mean(|p| p.deflection)
    }

    /// Largest δ less smallest, m.
    pub fn peak_to_peak(&self) -> f64 {
        let fold = |f: fn(f64, f64) -> f64, start| {
            self.positions.iter().map(|p| p.deflection).fold(start, f)
        };
        fold(f64::max, f64::NEG_INFINITY) - fold(f64::min, f64::INFINITY)
    }

    /// Iterations of the contact solver at all positions.
    pub fn iterations(&self) -> usize {
        self.positions.iter().map(|p| p.iterations).sum()
    }

    /// Mean number of loaded pairs.
    pub fn effective_contact_ratio(&self) -> f64 {
        self.mean(|p| p.pairs.iter().filter(|pair| pair.force > 0.0).count() as f64)
    }
}

/// Fewest loaded cells a patch may have.
const LEAST_CELLS: usize = 6;

/// Load step of the tangent stiffness.
const LOAD_STEP: f64 = 0.01;

/// One mesh cycle under a normal force (N), at `positions` evenly spaced phases from 0.
///
/// # Errors
/// If contact cannot be solved, or cells do not suffice.
pub fn pair_cycle(
    bodies: &Bodies,
    kind: MeshKind,
    force: f64,
    positions: usize,
    solver: &dyn ComplementaritySolver,
) -> Result<PairCycle, FeError> {
    let phases = (0..positions).map(|i| i as f64 / positions as f64);
    let list = phases.map(|phase| at_phase(bodies, kind, force, phase, solver));
    Ok(PairCycle { kind, force, positions: list.collect::<Result<_, _>>()? })
}

/// Equilibrium of one mesh at one phase.
///
/// # Errors
/// See [`pair_cycle`].
pub fn at_phase(
    bodies: &Bodies,
    kind: MeshKind,
    force: f64,
    phase: f64,
    solver: &dyn ComplementaritySolver,
) -> Result<PairAtPhase, FeError> {
    let (mesh, pair) = bodies.joined(kind)?;
    let mut settings = bodies.cells(force * (1.0 + LOAD_STEP));
    loop {
        let table = MeshTable::new(mesh, pair, phase, &settings)?;
        let (deflection, answer) = turn(&table, mesh, force, solver, None)?;
        if deflection >= table.next_gap {
            // A corner outside the window has come within reach.
            settings.window *= 2.0;
            continue;
        }
        table.check_patches(&answer, LEAST_CELLS, 0.0)?;
        let stepped = force * (1.0 + LOAD_STEP);
        let (further, _) = turn(&table, mesh, stepped, solver, Some((deflection, &answer)))?;
        let arms = arms(&table, mesh);
        let tangent = quadratic(&answer, &arms);
        let loads = table.pairs.iter().enumerate().filter(|(k, _)| answer.pair_forces[*k] > 0.0);
        let pairs = loads
            .map(|(k, cells)| ToothPairLoad {
                index: cells.index,
                force: answer.pair_forces[k],
                peak_pressure: table.peak_pressure(k, &answer.cell_forces),
            })
            .collect();
        return Ok(PairAtPhase {
            phase,
            deflection,
            tangent,
            step_tangent: (stepped - force) / (further - deflection),
            pairs,
            iterations: answer.iterations,
            table,
            answer,
        });
    }
}

/// Approach of each pair per δ: 1 on the path, the corner's arm over r_b beyond it.
fn arms(table: &MeshTable, mesh: &Mesh) -> Vec<f64> {
    let r_b = mesh.gear(MeshMember::Driver).base_radius;
    // Magnitudes: the sign of the entry is the sense in which the driver turns towards the driven
    // gear.
    table.pairs.iter().map(|pair| pair.row[2].abs() / r_b).collect()
}

fn quadratic(answer: &MeshAnswer, arms: &[f64]) -> f64 {
    let mut sum = 0.0;
    for (i, a) in arms.iter().enumerate() {
        for (j, b) in arms.iter().enumerate() {
            sum += a * answer.tangent[(i, j)] * b;
        }
    }
    sum
}

/// δ (m) of a mesh under a normal force (N), for any of its tables.
///
/// # Errors
/// If contact cannot be solved.
pub fn press(
    table: &MeshTable,
    mesh: &Mesh,
    force: f64,
    solver: &dyn ComplementaritySolver,
) -> Result<(f64, MeshAnswer), FeError> {
    turn(table, mesh, force, solver, None)
}

/// δ at which Σ (arm/r_b) P = F: Newton on a convex function, safeguarded by bisection.
fn turn(
    table: &MeshTable,
    mesh: &Mesh,
    force: f64,
    solver: &dyn ComplementaritySolver,
    start: Option<(f64, &MeshAnswer)>,
) -> Result<(f64, MeshAnswer), FeError> {
    const MOST: usize = 60;
    let arms = arms(table, mesh);
    let offsets = vec![0.0; arms.len()];
    let nothing = table.least_gap();
    let (mut low, mut high) = (nothing, f64::INFINITY);
    let mut deflection = start.map_or(nothing + 2e-5, |s| s.0);
    let mut warm = start.map(|s| s.1.active.clone());
    let mut residual = f64::INFINITY;
    for _ in 0..MOST {
        let approaches: Vec<f64> = arms.iter().map(|a| a * deflection).collect();
        let answer = table.answer(&approaches, &offsets, solver, warm.as_deref())?;
        let carried: f64 = answer.pair_forces.iter().zip(&arms).map(|(p, a)| p * a).sum();
        residual = (carried - force) / force;
        if residual.abs() < 1e-12 {
            return Ok((deflection, answer));
        }
        if residual < 0.0 {
            low = deflection
        } else {
            high = deflection
        }
        let slope = quadratic(&answer, &arms);
        let newton = deflection - residual * force / slope;
        let fallback =
            if high.is_finite() { 0.5 * (low + high) } else { 2.0 * deflection - nothing };
        let inside = newton > low && newton < high && newton.is_finite();
        let next = if inside { newton } else { fallback };
        if (next - deflection).abs() <= 1e-15 * deflection.abs() {
            return Ok((deflection, answer));
        }
        deflection = next;
        warm = Some(answer.active);
    }
    Err(FeError::NotConverged { iterations: MOST, residual })
}
