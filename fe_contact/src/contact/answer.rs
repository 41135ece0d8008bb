//! Forces of one mesh for given approaches of its pairs.

use nalgebra::{Cholesky, DMatrix};

use super::pair::Location;
use super::table::MeshTable;
use crate::complementarity::{ComplementaritySolver, Problem};
use crate::error::FeError;

/// Forces of a mesh under given rigid approaches of its pairs.
#[derive(Debug, Clone)]
pub struct MeshAnswer {
    /// Force of each pair, N.
    pub pair_forces: Vec<f64>,
    /// ∂(pair force)/∂(pair approach), N/m.
    pub tangent: DMatrix<f64>,
    /// Force of each cell, N.
    pub cell_forces: Vec<f64>,
    /// Whether each cell is in contact.
    pub active: Vec<bool>,
    /// Elastic energy ½ pᵀ C p, J.
    pub energy: f64,
    /// Iterations of the contact solver.
    pub iterations: usize,
}

impl MeshTable {
    /// Solves contact for approaches of the pairs (m, positive if the flanks would overlap);
    /// `offsets` (m) are added to all gaps of a pair.
    ///
    /// # Errors
    /// If the contact solver fails.
    pub fn answer(
        &self,
        approaches: &[f64],
        offsets: &[f64],
        solver: &dyn ComplementaritySolver,
        warm: Option<&[bool]>,
    ) -> Result<MeshAnswer, FeError> {
        let owner = self.pair_of_cells();
        let gaps: Vec<f64> =
            self.gaps.iter().zip(&owner).map(|(g, k)| g + offsets[*k] - approaches[*k]).collect();
        let count = self.pairs.len();
        let mut answer = MeshAnswer {
            pair_forces: vec![0.0; count],
            tangent: DMatrix::zeros(count, count),
            cell_forces: vec![0.0; gaps.len()],
            active: vec![false; gaps.len()],
            energy: 0.0,
            iterations: 0,
        };
        if gaps.iter().all(|g| *g >= 0.0) {
            return Ok(answer);
        }
        let problem = Problem { compliance: &self.compliance, gaps: &gaps };
        let (solution, factor) = solver
            .solve_with_factor(&problem, warm)
            .map_err(|cause| FeError::Contact { phase: self.phase, cause })?;
        let active: Vec<usize> = (0..gaps.len()).filter(|i| solution.active[*i]).collect();
        for (force, k) in solution.forces.iter().zip(&owner) {
            answer.pair_forces[*k] += force;
        }
        // ½ pᵀCp = ½ pᵀ(−g) on the active cells.
        answer.energy = -0.5 * solution.forces.iter().zip(&gaps).map(|(p, g)| p * g).sum::<f64>();
        let block = || {
            DMatrix::from_fn(active.len(), active.len(), |i, j| {
                self.compliance[(active[i], active[j])]
            })
        };
        // S = Eᵀ C_AA⁻¹ E = (L⁻¹E)ᵀ L⁻¹E, E: which pair each active cell belongs to.
        if let Some(factor) = factor.or_else(|| Cholesky::new(block())) {
            let mut e = DMatrix::zeros(active.len(), count);
            for (i, cell) in active.iter().enumerate() {
                e[(i, owner[*cell])] = 1.0;
            }
            factor.l_dirty().solve_lower_triangular_unchecked_mut(&mut e);
            answer.tangent = e.tr_mul(&e);
        }
        answer.iterations = solution.iterations;
        answer.cell_forces = solution.forces;
        answer.active = solution.active;
        Ok(answer)
    }

    /// Pressure in each cell of a pair (entry of [`Self::pairs`]), Pa; `forces`: of all cells, N.
    pub fn pressures(&self, pair: usize, forces: &[f64]) -> Vec<f64> {
        let cells = &self.pairs[pair];
        let own = &forces[cells.first..cells.first + cells.x.len()];
        own.iter().zip(&cells.widths).map(|(f, width)| f / (width * self.face_width)).collect()
    }

    /// Largest cell pressure of a pair, Pa.
    pub fn peak_pressure(&self, pair: usize, forces: &[f64]) -> f64 {
        self.pressures(pair, forces).into_iter().fold(0.0, f64::max)
    }

    /// Smallest gap of all cells, m.
    pub fn least_gap(&self) -> f64 {
        self.gaps.iter().fold(f64::INFINITY, |a, g| a.min(*g))
    }

    /// Refuses a patch that reaches an end of its grid where the flanks continue, and one with
    /// fewer than `least_cells` loaded cells under `worth_judging` (N) or more.
    ///
    /// # Errors
    /// [`FeError::GridOverflow`], [`FeError::GridTooCoarse`].
    pub fn check_patches(
        &self,
        answer: &MeshAnswer,
        least_cells: usize,
        worth_judging: f64,
    ) -> Result<(), FeError> {
        for (k, cells) in self.pairs.iter().enumerate() {
            let (pair, force_n) = (cells.index, answer.pair_forces[k]);
            if force_n <= 0.0 {
                continue;
            }
            let own = &answer.active[cells.first..cells.first + cells.x.len()];
            let ends = [own[0], own[own.len() - 1]];
            if (0..2).any(|i| ends[i] && !cells.ends_at_tip[i]) {
                let reach_mm = 0.5e3 * cells.length;
                return Err(FeError::GridOverflow { phase: self.phase, pair, reach_mm, force_n });
            }
            let loaded = own.iter().filter(|a| **a).count();
            // Cells are counted only in patches on the path, clear of the grid's ends, with more
            // than 0.3 of the mesh force: a patch at a corner is narrow on any grid, and a pair
            // that has just begun to touch loads one or two cells.
            let is_whole = cells.location == Location::Path && !ends[0] && !ends[1];
            let total: f64 = answer.pair_forces.iter().sum();
            let counts = force_n >= worth_judging && force_n > 0.3 * total;
            if is_whole && counts && loaded < least_cells {
                let cells = cells.x.len();
                let least = least_cells;
                return Err(FeError::GridTooCoarse { pair, force_n, loaded, least, cells });
            }
        }
        Ok(())
    }
}
