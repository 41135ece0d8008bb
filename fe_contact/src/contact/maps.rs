//! Contact of one mesh as affine maps, one for each set of touching cells met so far.
//!
//! With a given set A of touching cells the cells' forces follow the pairs' approaches δ linearly,
//!
//! ```text
//! p_A = C_AA⁻¹ (E_A δ − g_A),   P = E_Aᵀ p_A = S δ + P₀,   ½ pᵀCp = ½ δᵀ S δ + P₀ᵀ δ + ½ g_Aᵀ C_AA⁻¹ g_A
//! ```
//!
//! (E: which pair a cell belongs to, g: gaps at δ = 0). The map holds while p_A ≥ 0 and the other
//! cells' gaps g − E δ + C p ≥ 0; only when none of the known ones does is contact solved anew.

use nalgebra::{Cholesky, DMatrix};

use super::table::MeshTable;
use crate::complementarity::{ComplementaritySolver, Problem};
use crate::error::FeError;

/// Maps kept of one mesh at one phase; the oldest gives way.
const MOST_MAPS: usize = 64;

/// Cells' forces and gaps may be this much below zero, in parts of the load and of the window that
/// the table is made for: at the border between two sets either may be taken.
const SLACK: f64 = 1e-11;

/// Affine law of one set of touching cells.
#[derive(Debug, Clone)]
pub struct ContactMap {
    /// Unlike that of any other map of the mesh.
    pub id: u64,
    /// S, k×k by rows, N/m.
    pub stiffness: Vec<f64>,
    /// P₀, k, N.
    pub forces: Vec<f64>,
    /// ½ g_Aᵀ C_AA⁻¹ g_A, J.
    energy: f64,
    /// Cells that touch.
    active: Vec<bool>,
    /// For every cell what must not be negative: its value at δ = 0, then its k derivatives.
    cells: Vec<f64>,
    /// Pair whose patch reaches the end of its grid.
    pub overflows: Option<usize>,
}

/// The maps of one mesh at one phase.
#[derive(Debug, Clone, Default)]
pub struct ContactMaps {
    maps: Vec<ContactMap>,
    next: u64,
    /// Which gives way next when there are too many.
    oldest: usize,
    /// Contact problems solved.
    pub solved: usize,
}

impl ContactMap {
    /// Whether it holds at approaches δ (less gap offsets).
    fn holds(&self, delta: &[f64], force_slack: f64, gap_slack: f64) -> bool {
        let width = delta.len() + 1;
        self.cells.chunks_exact(width).zip(&self.active).all(|(cell, active)| {
            let mut value = cell[0];
            for (c, d) in cell[1..].iter().zip(delta) {
                value += c * d;
            }
            value >= if *active { -force_slack } else { -gap_slack }
        })
    }

    /// ½ pᵀ C p at approaches δ, J.
    pub fn energy(&self, delta: &[f64]) -> f64 {
        let k = delta.len();
        let mut sum = self.energy;
        for (i, d) in delta.iter().enumerate() {
            let row = &self.stiffness[i * k..(i + 1) * k];
            let along: f64 = row.iter().zip(delta).map(|(s, d)| s * d).sum();
            sum += d * (0.5 * along + self.forces[i]);
        }
        sum
    }

    fn new(table: &MeshTable, owner: &[usize], active: Vec<bool>, id: u64) -> Option<Self> {
        let k = table.pairs.len();
        let n = table.gaps.len();
        let set: Vec<usize> = (0..n).filter(|i| active[*i]).collect();
        let block =
            DMatrix::from_fn(set.len(), set.len(), |i, j| table.compliance[(set[i], set[j])]);
        // Columns: −g_A, then E_A.
        let mut right = DMatrix::from_fn(set.len(), k + 1, |i, c| match c {
            0 => -table.gaps[set[i]],
            c => f64::from(u8::from(owner[set[i]] == c - 1)),
        });
        if !set.is_empty() {
            Cholesky::new(block)?.solve_mut(&mut right);
        }
        let mut cells = vec![0.0; n * (k + 1)];
        for i in 0..n {
            cells[i * (k + 1)] = table.gaps[i];
            cells[i * (k + 1) + 1 + owner[i]] = -1.0;
        }
        for (a, cell) in set.iter().enumerate() {
            for c in 0..=k {
                cells[cell * (k + 1) + c] = right[(a, c)];
            }
        }
        for i in (0..n).filter(|i| !active[*i]) {
            for c in 0..=k {
                let sum: f64 = set
                    .iter()
                    .enumerate()
                    .map(|(a, j)| table.compliance[(i, *j)] * right[(a, c)])
                    .sum();
                cells[i * (k + 1) + c] += sum;
            }
        }
        let (mut stiffness, mut forces) = (vec![0.0; k * k], vec![0.0; k]);
        let mut energy = 0.0;
        for (a, cell) in set.iter().enumerate() {
            forces[owner[*cell]] += right[(a, 0)];
            energy -= 0.5 * table.gaps[*cell] * right[(a, 0)];
            for c in 0..k {
                stiffness[owner[*cell] * k + c] += right[(a, c + 1)];
            }
        }
        // Rounding must not spoil symmetry.
        for i in 0..k {
            for j in 0..i {
                let mean = 0.5 * (stiffness[i * k + j] + stiffness[j * k + i]);
                (stiffness[i * k + j], stiffness[j * k + i]) = (mean, mean);
            }
        }
        let overflows = table.pairs.iter().position(|pair| {
            let own = &active[pair.first..pair.first + pair.x.len()];
            let ends = [own[0], own[own.len() - 1]];
            (0..2).any(|i| ends[i] && !pair.ends_at_tip[i])
        });
        Some(Self { id, stiffness, forces, energy, active, cells, overflows })
    }
}

impl ContactMaps {
    /// A map by its place.
    pub fn map(&self, place: usize) -> &ContactMap {
        &self.maps[place]
    }

    /// Memory of the maps, bytes.
    pub fn bytes(&self) -> usize {
        self.maps.iter().map(|m| 8 * (m.cells.len() + m.stiffness.len()) + m.active.len()).sum()
    }

    /// Number of maps.
    pub fn count(&self) -> usize {
        self.maps.len()
    }

    /// Whether the map at `place` holds at approaches δ (less gap offsets).
    pub fn holds(&self, place: usize, table: &MeshTable, delta: &[f64], scale: (f64, f64)) -> bool {
        debug_assert_eq!(delta.len(), table.pairs.len());
        self.maps.get(place).is_some_and(|m| m.holds(delta, SLACK * scale.0, SLACK * scale.1))
    }

    /// Place of a map that holds at approaches δ (less gap offsets): the one at `hint` first, then
    /// the others, then a new one. `scale`: load and window of the table, N and m.
    ///
    /// # Errors
    /// If the contact solver fails.
    pub fn find(
        &mut self,
        table: &MeshTable,
        delta: &[f64],
        scale: (f64, f64),
        hint: usize,
        solver: &dyn ComplementaritySolver,
    ) -> Result<usize, FeError> {
        if self.holds(hint, table, delta, scale) {
            return Ok(hint);
        }
        if let Some(place) = (0..self.maps.len()).find(|i| self.holds(*i, table, delta, scale)) {
            return Ok(place);
        }
        self.solved += 1;
        let owner = table.pair_of_cells();
        let gaps: Vec<f64> = table.gaps.iter().zip(&owner).map(|(g, k)| g - delta[*k]).collect();
        let active = if gaps.iter().all(|g| *g >= 0.0) {
            vec![false; gaps.len()]
        } else {
            let problem = Problem { compliance: &table.compliance, gaps: &gaps };
            let warm = self.maps.get(hint).map(|m| m.active.as_slice());
            let solution = solver
                .solve(&problem, warm)
                .map_err(|cause| FeError::Contact { phase: table.phase, cause })?;
            // A touching cell without force belongs to either set.
            solution.active.iter().zip(&solution.forces).map(|(a, p)| *a && *p > 0.0).collect()
        };
        let id = self.next;
        self.next += 1;
        let map = ContactMap::new(table, &owner, active, id).ok_or_else(|| {
            let cause = crate::complementarity::ComplementarityError::Inaccurate {
                residual: f64::INFINITY,
            };
            FeError::Contact { phase: table.phase, cause }
        })?;
        if self.maps.len() < MOST_MAPS {
            self.maps.push(map);
            return Ok(self.maps.len() - 1);
        }
        let place = self.oldest;
        self.oldest = (self.oldest + 1) % MOST_MAPS;
        self.maps[place] = map;
        Ok(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::complementarity::ActiveSet;
    use crate::contact::{CellSettings, Matching};

    /// Maps and the solver's own answer agree wherever contact stands.
    #[test]
    fn maps_answer_as_the_solver_does() {
        let scene = gearset::Scene::from_file(
            concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_sun_planet_pair.toml").as_ref(),
        )
        .unwrap();
        let mut scene = scene;
        scene.fe_contact.flank_elements = 8;
        let bodies = crate::statics::Bodies::new(&scene).unwrap();
        let (mesh, pair) = bodies.joined(gearset::MeshKind::SunPlanet).unwrap();
        let settings: CellSettings = bodies.cells(8000.0);
        let _: Matching = settings.matching;
        for phase in [0.02, 0.3, 0.7] {
            let table = MeshTable::new(mesh, pair, phase, &settings).unwrap();
            let k = table.pairs.len();
            let (mut maps, scale) = (ContactMaps::default(), (8000.0, settings.window));
            let mut hint = 0;
            for step in 0..40 {
                // From apart to pressed, the pairs unevenly.
                let delta: Vec<f64> =
                    (0..k).map(|i| (step as f64 - 4.0 + 0.3 * i as f64) * 0.5e-6).collect();
                hint = maps.find(&table, &delta, scale, hint, &ActiveSet).unwrap();
                let map = maps.map(hint);
                let answer = table.answer(&delta, &vec![0.0; k], &ActiveSet, None).unwrap();
                let total: f64 = answer.pair_forces.iter().sum();
                for i in 0..k {
                    let force: f64 = map.forces[i]
                        + (0..k).map(|j| map.stiffness[i * k + j] * delta[j]).sum::<f64>();
                    assert!((force - answer.pair_forces[i]).abs() <= 1e-9 * total.max(1.0));
                }
                assert!((map.energy(&delta) - answer.energy).abs() <= 1e-9 * answer.energy + 1e-15);
            }
            let (count, solved) = (maps.count(), maps.solved);
            let delta: Vec<f64> = (0..k).map(|i| (15.0 + 0.3 * i as f64) * 0.5e-6).collect();
            maps.find(&table, &delta, scale, 0, &ActiveSet).unwrap();
            assert_eq!((maps.count(), maps.solved), (count, solved), "a known set is not solved");
        }
    }
}
