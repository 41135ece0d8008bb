//! One mesh of a set at one position: its cells, and its pairs' rows on the races' coordinates.

use std::borrow::Cow;

use nalgebra::{DMatrix, DVector};

use gearset::MeshKind;

use super::pair::ToothPairLoad;
use super::state::MeshState;
use crate::complementarity::ComplementaritySolver;
use crate::contact::{Location, MeshAnswer, MeshTable};
use crate::error::FeError;

/// One mesh at one position.
#[derive(Debug, Clone)]
pub(crate) struct PlacedMesh<'t> {
    pub(crate) kind: MeshKind,
    pub(crate) planet: usize,
    pub(crate) phase: f64,
    pub(crate) table: Cow<'t, MeshTable>,
    /// Approach of each pair on the races' coordinates.
    pub(crate) rows: Vec<DVector<f64>>,
    /// Offset of each pair, whose approach is b·q − offset, m.
    pub(crate) offsets: Vec<f64>,
    /// What tooth errors add to the gaps, m.
    pub(crate) errors: Vec<f64>,
    /// Second-order terms of the gaps of pairs in corner contact.
    pub(crate) bends: Vec<Bend>,
    /// Approach of each pair per rotation of the driven gear, m/rad.
    pub(crate) turns: Vec<f64>,
}

/// Second-order term of the gap of a pair in corner contact. The gap is quadratic in the distance e
/// of the corner beyond the path,
///
/// ```text
/// approach = b·q − offset − ½ G'' Δe²,   Δe = ∂e·(q − q_ref)
/// ```
#[derive(Debug, Clone)]
pub(crate) struct Bend {
    /// Pair of the mesh.
    pub(crate) pair: usize,
    /// ∂e on the races' coordinates.
    pub(crate) row: DVector<f64>,
    /// ∂e·q_ref, m.
    pub(crate) offset: f64,
    /// G'', 1/m.
    pub(crate) curvature: f64,
    /// ∂e per rotation of the driven gear, m/rad.
    pub(crate) turn: f64,
}

impl Bend {
    /// Δe, m.
    pub(super) fn moved(&self, q: &DVector<f64>) -> f64 {
        self.row.dot(q) - self.offset
    }
}

impl PlacedMesh<'_> {
    pub(crate) fn approaches(&self, q: &DVector<f64>) -> Vec<f64> {
        self.rows.iter().zip(&self.offsets).map(|(b, offset)| b.dot(q) - offset).collect()
    }

    pub(crate) fn answer(
        &self,
        q: &DVector<f64>,
        solver: &dyn ComplementaritySolver,
        warm: Option<&[bool]>,
    ) -> Result<MeshAnswer, FeError> {
        self.table.answer(&self.approaches(q), &self.errors, solver, warm)
    }

    /// Sets the offsets to `perfect` plus the second-order terms of corner gaps at q (m), and adds
    /// what these terms change of the generalised pair forces, P G'' Δe ∂e, to the load on the
    /// races, N.
    pub(crate) fn bend(
        &mut self,
        perfect: &[f64],
        q: &DVector<f64>,
        forces: &[f64],
        load: &mut DVector<f64>,
    ) {
        self.offsets.copy_from_slice(perfect);
        for bend in &self.bends {
            let moved = bend.moved(q);
            self.offsets[bend.pair] += 0.5 * bend.curvature * moved * moved;
            load.axpy(forces[bend.pair] * bend.curvature * moved, &bend.row, 1.0);
        }
    }

    pub(crate) fn untouched(&self) -> MeshAnswer {
        let n = self.table.gaps.len();
        MeshAnswer {
            pair_forces: vec![0.0; self.rows.len()],
            tangent: DMatrix::zeros(self.rows.len(), self.rows.len()),
            cell_forces: vec![0.0; n],
            active: vec![false; n],
            energy: 0.0,
            iterations: 0,
        }
    }

    /// Cells likely in contact: those near the least gap of each pair.
    pub(crate) fn guess(&self) -> Vec<bool> {
        let mut active = Vec::with_capacity(self.table.gaps.len());
        for pair in &self.table.pairs {
            let reach = 0.5 * pair.length;
            active.extend(pair.x.iter().map(|x| (x - pair.centre).abs() < 0.5 * reach));
        }
        active
    }

    pub(crate) fn add_to(
        &self,
        r: &mut DVector<f64>,
        hessian: &mut DMatrix<f64>,
        answer: &MeshAnswer,
    ) {
        for (k, b) in self.rows.iter().enumerate() {
            *r -= answer.pair_forces[k] * b;
            for (l, c) in self.rows.iter().enumerate() {
                let s = answer.tangent[(k, l)];
                if s != 0.0 {
                    hessian.ger(s, b, c, 1.0);
                }
            }
        }
    }

    pub(crate) fn add_nominal(&self, matrix: &mut DMatrix<f64>, stiffness: f64) {
        let least = |k: &usize| {
            let pair = &self.table.pairs[*k];
            let own = &self.table.gaps[pair.first..pair.first + pair.x.len()];
            own.iter().fold(f64::INFINITY, |a, g| a.min(*g)) + self.errors[*k]
        };
        let nearest = (0..self.rows.len()).min_by(|a, b| least(a).total_cmp(&least(b)));
        if let Some(b) = nearest.map(|k| &self.rows[k]) {
            matrix.ger(stiffness, b, b, 1.0);
        }
    }

    /// Refuses a deflection that reaches a corner left out of the table.
    pub(crate) fn check_window(&self, q: &DVector<f64>) -> Result<(), FeError> {
        let deepest = self.approaches(q).into_iter().fold(0.0, f64::max);
        if deepest >= self.table.next_gap {
            return Err(FeError::NoEquilibrium(format!(
                "planet {}'s {} mesh gives way by {:.1} µm, beyond the window for tip contact of \
                 {:.1} µm: the load is too large for these teeth",
                self.planet,
                self.kind.name(),
                deepest * 1e6,
                self.table.next_gap * 1e6
            )));
        }
        Ok(())
    }

    pub(crate) fn state(&self, q: &DVector<f64>, answer: &MeshAnswer) -> MeshState {
        let approaches = self.approaches(q);
        let loaded =
            self.table.pairs.iter().enumerate().filter(|(k, _)| answer.pair_forces[*k] > 0.0);
        let pairs = loaded.map(|(k, cells)| ToothPairLoad {
            index: cells.index,
            force: answer.pair_forces[k],
            peak_pressure: self.table.peak_pressure(k, &answer.cell_forces),
        });
        // All pairs on the path have the same approach; without one there, the approach is that of
        // the first pair, at a corner.
        let on_path = self.table.pairs.iter().position(|p| p.location == Location::Path);
        MeshState {
            kind: self.kind,
            planet: self.planet,
            phase: self.phase,
            force: answer.pair_forces.iter().sum(),
            approach: on_path.or(Some(0)).map_or(0.0, |k| approaches[k]),
            tangent: answer.tangent.sum(),
            pairs: pairs.collect(),
        }
    }
}
