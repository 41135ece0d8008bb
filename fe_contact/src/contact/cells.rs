//! Contact cells of one pair: where they are along the flanks.
//!
//! Even cells have one width and lie symmetrically about the contact point. Two errors come with them
//! that do not hurt a pressure but hurt the slope of a force:
//!
//! - Where a flank ends inside the patch, pressure grows as 1/√d towards the end (d: distance from it).
//!   Cells of width w then give an elastic approach that is off by an amount proportional to w. As the
//!   pair moves on by ds the end does too, and w changes by ds/n: the slope of the approach along the
//!   flank is off by an amount proportional to 1/n. Graded cells are narrower towards that end,
//!   proportional to √d, on which 1/√d is as easy to resolve as a constant.
//! - Both edges of a symmetric patch pass from cell to cell at the same load, so that the stiffness of the
//!   pair grows in steps of two cells. Graded cells are a quarter of a cell off the middle: the edges
//!   pass in turn, and the steps are half as large.

use scene::CellLayout;

use super::pair::PairFrame;

/// Cells from end to end of the grid of one pair, tangential coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    /// Middles, n, m.
    pub(super) x: Vec<f64>,
    /// Widths, n, m.
    pub(super) widths: Vec<f64>,
    /// Edges, n + 1, m; `None` if all cells have one width.
    pub(super) edges: Option<Vec<f64>>,
    /// Length of the grid, m.
    pub(super) length: f64,
    /// Whether the grid ends where a flank does, at its low and at its high end.
    pub(super) ends_at_tip: [bool; 2],
}

impl Cells {
    /// `count` cells of a pair, on a grid that is `reach` (m) long to either side: see [`PairFrame::grid`].
    pub(super) fn new(frame: &PairFrame<'_>, reach: f64, count: usize, layout: CellLayout) -> Self {
        let (ends, ends_at_tip) = frame.grid(reach);
        match layout {
            CellLayout::Even => Self::even(ends, ends_at_tip, count),
            CellLayout::Graded => {
                let (ends, ends_at_tip) = staggered(frame, ends, ends_at_tip, count);
                let crowding = frame.crowding(reach, ends, ends_at_tip);
                Self::graded(ends, ends_at_tip, crowding, count)
            }
        }
    }

    fn even([low, high]: [f64; 2], ends_at_tip: [bool; 2], count: usize) -> Self {
        let width = (high - low) / count as f64;
        let x = (0..count).map(|i| low + (i as f64 + 0.5) * width).collect();
        Self { x, widths: vec![width; count], edges: None, length: high - low, ends_at_tip }
    }

    /// Cells whose width is proportional to s(u) at a share u of their number from the low end,
    ///
    /// ```text
    /// s(u) = (1 − c₀ + 2 c₀ u) (1 − c₁ + 2 c₁ (1 − u)),   x(u) = low + L ∫₀ᵘ s du / ∫₀¹ s du
    /// ```
    ///
    /// with the crowding c of either end: 0 leaves all cells alike, 1 makes distances from that end grow
    /// with the square of the number of cells.
    fn graded(
        [low, high]: [f64; 2],
        ends_at_tip: [bool; 2],
        crowding: [f64; 2],
        count: usize,
    ) -> Self {
        if crowding == [0.0; 2] {
            return Self::even([low, high], ends_at_tip, count);
        }
        // s = (a + b u)(c + d u)
        let [a, b] = [1.0 - crowding[0], 2.0 * crowding[0]];
        let [c, d] = [1.0 + crowding[1], -2.0 * crowding[1]];
        let sum = |u: f64| u * (a * c + u * (0.5 * (a * d + b * c) + u * b * d / 3.0));
        let edge = |i: usize| low + (high - low) * (sum(i as f64 / count as f64) / sum(1.0));
        let edges: Vec<f64> = (0..=count).map(edge).collect();
        let x = edges.windows(2).map(|e| 0.5 * (e[0] + e[1])).collect();
        let widths = edges.windows(2).map(|e| e[1] - e[0]).collect();
        Self { x, widths, edges: Some(edges), length: high - low, ends_at_tip }
    }
}

/// A grid moved by a quarter of a cell towards its high end, where no flank ends.
fn staggered(
    frame: &PairFrame<'_>,
    [low, high]: [f64; 2],
    ends_at_tip: [bool; 2],
    count: usize,
) -> ([f64; 2], [bool; 2]) {
    let quarter = 0.25 * (high - low) / count as f64;
    let low = if ends_at_tip[0] { low } else { low + quarter };
    if ends_at_tip[1] {
        return ([low, high], ends_at_tip);
    }
    let end = frame.extent()[1];
    ([low, end.min(high + quarter)], [ends_at_tip[0], high + quarter > end])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells fill the grid without gaps and grow away from an end that crowds them; with full crowding the
    /// i-th edge is L (i/n)² away from it.
    #[test]
    fn graded_cells_fill_the_grid() {
        let n = 10;
        let one = Cells::graded([-1.0, 3.0], [false, true], [0.0, 1.0], n);
        let edges = one.edges.as_ref().unwrap();
        assert_eq!((edges[0], edges[n]), (-1.0, 3.0));
        assert!((one.widths.iter().sum::<f64>() - 4.0).abs() < 1e-14);
        for (i, edge) in edges.iter().enumerate() {
            let share = 1.0 - i as f64 / n as f64;
            assert!((3.0 - edge - 4.0 * share * share).abs() < 1e-14, "{i}");
        }
        let both = Cells::graded([-1.0, 3.0], [true; 2], [0.6; 2], n);
        for i in 0..n {
            assert!((both.widths[i] - both.widths[n - 1 - i]).abs() < 1e-14);
            assert!((one.x[i] - 0.5 * (edges[i] + edges[i + 1])).abs() < 1e-15);
        }
        assert!(both.widths[0] < both.widths[4]);
        let plain = Cells::graded([-1.0, 3.0], [true; 2], [0.0; 2], n);
        assert_eq!(plain, Cells::even([-1.0, 3.0], [true; 2], n));
    }
}
