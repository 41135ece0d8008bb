//! By how much the approaches of a mesh's pairs may change before a set of touching cells changes.

/// Cells' forces and gaps may be this much below zero, in parts of the load and of the window that
/// the table is made for: at the border between two sets either may be taken.
const SLACK: f64 = 1e-11;

/// Cells that are looked at side by side.
const LANES: usize = 4;

/// For every cell by how much the approaches δ may change before it leaves the set, an affine function of δ:
///
/// ```text
/// room = c₀ + Σ c_k δ_k,   Σ |c_k| = 1
/// ```
///
/// so that no room changes by more than the largest change of a pair's approach. Cells are sorted by their room at the
/// approaches at which the set was found: those whose room cannot be the smallest at others are not looked at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rooms<'m> {
    /// Approaches at which the set was found, k, m.
    found_at: &'m [f64],
    /// Least room of the cells of each lane and of all after it at the approaches at which the set was found, m.
    bounds: &'m [f64],
    /// c₀ (m), then c_k, in lanes of cells; slack included.
    cells: &'m [[f64; LANES]],
}

impl<'m> Rooms<'m> {
    /// Writes, behind other numbers, those of the cells' forces (of those that touch) or gaps, each at δ = 0 and then
    /// its k derivatives: how many lanes they fill, and what slack makes of a room at least and at most (m).
    /// `found_at`: δ at which the set was found; `scale`: load (N) and window (m) of the table.
    pub(super) fn write(
        cells: &[f64],
        active: &[bool],
        found_at: &[f64],
        scale: (f64, f64),
        numbers: &mut Vec<f64>,
    ) -> (usize, [f64; 2]) {
        let k = found_at.len();
        let mut slacks = [f64::INFINITY, 0.0f64];
        let one = |(cell, active): (&[f64], &bool)| {
            let slack = SLACK * if *active { scale.0 } else { scale.1 };
            let steepness: f64 = cell[1..].iter().map(|c| c.abs()).sum();
            let per = if steepness > 0.0 { 1.0 / steepness } else { 1.0 };
            slacks = [slacks[0].min(slack * per), slacks[1].max(slack * per)];
            let first = (cell[0] + slack) * per;
            let own: Vec<f64> =
                std::iter::once(first).chain(cell[1..].iter().map(|c| c * per)).collect();
            let along = own[1..].iter().zip(found_at).map(|(c, d)| c * d);
            (first + along.sum::<f64>(), own)
        };
        let mut sorted: Vec<(f64, Vec<f64>)> =
            cells.chunks_exact(k + 1).zip(active).map(one).collect();
        sorted.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let lanes = sorted.chunks(LANES);
        numbers.extend(lanes.clone().map(|lane| lane[0].0));
        let count = lanes.len();
        for lane in lanes {
            // Lanes that are left over after the last cell must never be the ones that end a map's range.
            let mut own = vec![[0.0; LANES]; k + 1];
            own[0] = [f64::INFINITY; LANES];
            for (place, (_, cell)) in lane.iter().enumerate() {
                own.iter_mut().zip(cell).for_each(|(own, c)| own[place] = *c);
            }
            numbers.extend(own.as_flattened());
        }
        (count, slacks)
    }

    /// Those of a set found at some approaches (k, m) from what was written of it, of so many lanes.
    #[inline]
    pub(super) fn read(found_at: &'m [f64], lanes: usize, written: &'m [f64]) -> Self {
        let (bounds, cells) = written.split_at(lanes);
        Self { found_at, bounds, cells: cells.as_chunks().0 }
    }

    /// Smallest room of any cell at approaches δ, m; `None` if one has none.
    pub(super) fn least_at(&self, delta: &[f64]) -> Option<f64> {
        let changes = delta.iter().zip(self.found_at).map(|(d, at)| (d - at).abs());
        let change = changes.fold(0.0, f64::max);
        let mut least = f64::INFINITY;
        for (cells, bound) in self.cells.chunks_exact(delta.len() + 1).zip(self.bounds) {
            if bound - change > least {
                break;
            }
            let mut value = cells[0];
            for (derivative, d) in cells[1..].iter().zip(delta) {
                for (value, c) in value.iter_mut().zip(derivative) {
                    *value += c * d;
                }
            }
            // No number is not at least 0.
            if !value.iter().all(|v| *v >= 0.0) {
                return None;
            }
            least = value.into_iter().fold(least, f64::min);
        }
        Some(least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The smallest room is that over all cells, near the approaches at which the set was found and far from them.
    #[test]
    fn smallest_room_is_that_of_all_cells() {
        let (k, count) = (3, 61);
        let cells: Vec<f64> = (0..count * (k + 1))
            .map(|i| match i % (k + 1) {
                0 => 1e-6 * (2.0 + (0.7 * i as f64).sin()),
                _ => (1.3 * i as f64).cos(),
            })
            .collect();
        let active = vec![false; count];
        let found_at = [0.2e-6, -0.1e-6, 0.3e-6];
        let mut numbers = Vec::new();
        let (lanes, _) = Rooms::write(&cells, &active, &found_at, (1.0, 1e-5), &mut numbers);
        let rooms = Rooms::read(&found_at, lanes, &numbers);
        let mut held = 0;
        for step in 0..200 {
            let delta: Vec<f64> =
                (0..k).map(|i| 1e-8 * step as f64 * (0.37 * (step * k + i) as f64).sin()).collect();
            let room = |cell: &[f64]| {
                let steepness: f64 = cell[1..].iter().map(|c| c.abs()).sum();
                let along: f64 = cell[1..].iter().zip(&delta).map(|(c, d)| c * d).sum();
                (cell[0] + SLACK * 1e-5 + along) / steepness
            };
            let least = cells.chunks_exact(k + 1).map(room).fold(f64::INFINITY, f64::min);
            match rooms.least_at(&delta) {
                Some(found) => {
                    held += 1;
                    assert!((found - least).abs() < 1e-19, "{step}: {found} {least}");
                }
                None => assert!(least < 0.0, "{step}: {least}"),
            }
        }
        assert!(held > 20 && held < 180, "{held}");
    }
}
