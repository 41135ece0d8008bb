//! Systems that are themselves again after a part of their cycle, with coordinates and couplings renumbered.
//!
//! With P the renumbering of the coordinates and coupling k at the start in the place of coupling c(k) at the end of
//! the part,
//!
//! ```text
//! P M = M P,   P C = C P,   P K = K P,   r_k P = r_c(k),   F_c(k)(step + S/p, ·) = F_k(step, ·),   P f(step + S/p) = f(step)
//! ```
//!
//! make of every motion x(t) another one, P x(t + T/p). All of this is found in the system, not taken from whoever
//! proposes the renumbering.

use nalgebra::DMatrix;

use super::coupling::CouplingForce;
use super::system::Coupled;
use crate::newmark::Motion;
use crate::periodic::MapDerivative;

/// Largest difference of equal quantities, relative to the largest of their kind.
const EQUAL: f64 = 1e-9;

/// A renumbering of coordinates and couplings.
#[derive(Debug, Clone, PartialEq)]
pub struct Renumbering {
    /// Parts of the cycle p.
    pub parts: usize,
    /// P by its entries that are not zero: row, column, value.
    pub coordinates: Vec<(usize, usize, f64)>,
    /// c(k) of every coupling.
    pub couplings: Vec<usize>,
}

/// A renumbering under which a system is itself after a part of its cycle.
#[derive(Debug, Clone)]
pub struct CyclePart {
    /// Parts of the cycle p.
    pub parts: usize,
    /// P in the coordinates of the modes.
    turn: DMatrix<f64>,
    couplings: Vec<usize>,
}

impl<L: CouplingForce> Coupled<L> {
    /// The renumbering as one of this system; `None` if the system is not itself under it.
    pub fn part_of_cycle(&self, own: &Renumbering) -> Option<CyclePart> {
        let (n, count) = (self.modes.count, self.all().count);
        let is_place = |(i, j, _): &(usize, usize, f64)| *i < n && *j < n;
        let fits = self.steps_per_cycle.is_multiple_of(own.parts)
            && own.couplings.len() == count
            && own.couplings.iter().all(|k| *k < count)
            && own.coordinates.iter().all(is_place);
        if !fits {
            return None;
        }
        let mut p = DMatrix::zeros(n, n);
        own.coordinates.iter().for_each(|(i, j, value)| p[(*i, *j)] += value);
        // (P A − A P)_ij = P_ij (a_j − a_i) with a diagonal A
        let commutes_with_diagonal = |p: &DMatrix<f64>, a: &[f64]| {
            let largest = a[..n].iter().fold(0.0f64, |largest, a| largest.max(a.abs()));
            let is_kept = |i: usize, j: usize| (p[(i, j)] * (a[j] - a[i])).abs() <= EQUAL * largest;
            (0..n).all(|j| (0..n).all(|i| is_kept(i, j)))
        };
        // Q = Φ⁻¹ P Φ = Φᵀ M P Φ
        let shapes = DMatrix::from_fn(n, n, |i, j| self.modes.shapes[(i, j)]);
        let weighted = DMatrix::from_fn(n, n, |i, j| self.modes.mass[i] * p[(i, j)]);
        let turn = shapes.tr_mul(&(weighted * &shapes));
        let damping = DMatrix::from_fn(n, n, |i, j| self.modes.damping[(i, j)]);
        let is_linear_part_kept = commutes_with_diagonal(&p, &self.modes.mass)
            && commutes_with_diagonal(&turn, &self.modes.lambda)
            && (&turn * &damping - &damping * &turn).amax() <= EQUAL * damping.amax();
        let part = CyclePart { parts: own.parts, turn, couplings: own.couplings.clone() };
        let is_kept = is_linear_part_kept
            && self.couplings_are_kept(&part)
            && self.laws_are_kept(&part)
            && self.loads_are_kept(&part);
        is_kept.then_some(part)
    }

    /// Whether r_k P = r_c(k), and offsets and lags are those of c(k).
    fn couplings_are_kept(&self, part: &CyclePart) -> bool {
        let (n, all) = (self.modes.count, self.all());
        // The usual couplings come first, and are renumbered among themselves.
        let usual = self.usual.count;
        let rows = DMatrix::from_fn(all.count, n, |k, j| all.rows[j * all.width + k]);
        let turned = &rows * &part.turn;
        let scale = all.offsets.iter().fold(0.0f64, |a, o| a.max(o.abs()));
        let lag = all.lags.iter().fold(0.0f64, |a, o| a.max(o.abs()));
        part.couplings.iter().enumerate().all(|(k, c)| {
            (k < usual) == (*c < usual)
                && (turned.row(k) - rows.row(*c)).amax() <= EQUAL * rows.amax()
                && (all.offsets[k] - all.offsets[*c]).abs() <= EQUAL * scale
                && (all.lags[k] - all.lags[*c]).abs() <= EQUAL * lag
        })
    }

    /// Whether F_c(k)(step + S/p, ·) = F_k(step, ·).
    fn laws_are_kept(&self, part: &CyclePart) -> bool {
        let steps = self.steps_per_cycle;
        let mut all = (0..steps)
            .flat_map(|step| part.couplings.iter().enumerate().map(move |(k, c)| (step, k, *c)));
        all.all(|(step, k, c)| {
            self.law.is_same((k, step), (c, (step + steps / part.parts) % steps))
        })
    }

    /// Whether P f(step + S/p) = f(step).
    fn loads_are_kept(&self, part: &CyclePart) -> bool {
        let (n, steps) = (self.modes.count, self.steps_per_cycle);
        let loads = DMatrix::from_fn(n, steps, |i, step| self.external(step)[i]);
        let (turned, largest) = (&part.turn * &loads, EQUAL * loads.amax());
        (0..steps).all(|step| {
            let after = turned.column((step + steps / part.parts) % steps);
            (after - loads.column(step)).amax() <= largest
        })
    }

    /// Ends a part of a cycle that began at step 0: the system stands at step 0 again, renumbered.
    pub fn take_part_back(&mut self, part: &CyclePart) {
        let n = self.modes.count;
        let Motion { x, v, a } = &mut self.state.modal;
        for list in [x, v, a] {
            let turned = &part.turn * DMatrix::from_column_slice(n, 1, &list[..n]);
            list[..n].copy_from_slice(turned.as_slice());
        }
        for forces in &mut self.state.forces {
            *forces = part.couplings.iter().map(|c| forces[*c]).collect();
        }
        self.state.step_in_cycle = 0;
    }
}

impl CyclePart {
    /// The derivative of the map of a part, renumbered at its end, from that of its steps.
    pub fn renumbered(&self, steps: MapDerivative) -> MapDerivative {
        let MapDerivative { active, mut columns, scales } = steps;
        let n = self.turn.nrows();
        for first in [0, n] {
            let turned = &self.turn * columns.rows(first, n);
            columns.rows_mut(first, n).copy_from(&turned);
        }
        MapDerivative { active, columns, scales }
    }
}
