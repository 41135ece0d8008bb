//! Small matrices as every step multiplies by them: of twenty by twenty, laid out in the order in which
//! they are read, without the strides that a general library allows for.

use nalgebra::{DMatrix, DVector};

/// Rows of a block, which are summed side by side.
const BLOCK: usize = 8;

/// A dense matrix in blocks of rows, each by columns, the last one padded with nils.
#[derive(Debug, Clone, Default)]
pub(super) struct Packed {
    rows: usize,
    columns: usize,
    data: Vec<[f64; BLOCK]>,
}

impl Packed {
    pub(super) fn new(matrix: &DMatrix<f64>) -> Self {
        let (rows, columns) = matrix.shape();
        let entry = |i: usize, j: usize| if i < rows { matrix[(i, j)] } else { 0.0 };
        let column = |block: usize, j| std::array::from_fn(|i| entry(block * BLOCK + i, j));
        let blocks = rows.div_ceil(BLOCK);
        let data = (0..blocks).flat_map(|b| (0..columns).map(move |j| column(b, j))).collect();
        Self { rows, columns, data }
    }

    /// out += A x.
    pub(super) fn add_product(&self, x: &[f64], out: &mut [f64]) {
        let (x, out) = (&x[..self.columns], &mut out[..self.rows]);
        let blocks = self.data.chunks_exact(self.columns.max(1));
        for (block, out) in blocks.zip(out.chunks_mut(BLOCK)) {
            let mut sum = [0.0; BLOCK];
            sum[..out.len()].copy_from_slice(out);
            for (column, x) in block.iter().zip(x) {
                for (sum, a) in sum.iter_mut().zip(column) {
                    *sum += a * x;
                }
            }
            out.copy_from_slice(&sum[..out.len()]);
        }
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        8 * BLOCK * self.data.len()
    }
}

/// Coordinates of the two bodies that meet in a tooth pair.
const SHORT: usize = 6;

/// A row that names two bodies of three coordinates.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct ShortRow {
    places: [u16; SHORT],
    values: [f64; SHORT],
}

impl ShortRow {
    /// `None` if more coordinates take part.
    pub(super) fn new(row: impl Iterator<Item = f64>) -> Option<Self> {
        let mut short = Self::default();
        let nonzero = row.enumerate().filter(|(_, value)| *value != 0.0);
        for (k, (place, value)) in nonzero.enumerate() {
            *short.places.get_mut(k)? = u16::try_from(place).ok()?;
            short.values[k] = value;
        }
        Some(short)
    }

    /// All n entries.
    pub(super) fn full(&self, n: usize) -> DVector<f64> {
        let mut row = DVector::zeros(n);
        self.add_to(1.0, row.as_mut_slice());
        row
    }

    pub(super) fn dot(&self, x: &[f64]) -> f64 {
        self.places.iter().zip(&self.values).map(|(i, r)| x[usize::from(*i)] * r).sum()
    }

    /// x += factor rowᵀ.
    pub(super) fn add_to(&self, factor: f64, x: &mut [f64]) {
        for (i, r) in self.places.iter().zip(&self.values) {
            x[usize::from(*i)] += factor * r;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_those_of_the_library() {
        for (rows, columns) in [(1, 1), (7, 3), (8, 8), (20, 17), (3, 0), (0, 4)] {
            let a = DMatrix::from_fn(rows, columns, |i, j| (1 + 3 * i + 7 * j) as f64 * 0.1);
            let x: Vec<f64> = (0..columns).map(|j| 1.0 - 0.3 * j as f64).collect();
            let start: Vec<f64> = (0..rows).map(|i| 0.5 * i as f64).collect();
            let mut out = start.clone();
            Packed::new(&a).add_product(&x, &mut out);
            for i in 0..rows {
                let exact: f64 = start[i] + (0..columns).map(|j| a[(i, j)] * x[j]).sum::<f64>();
                assert!((out[i] - exact).abs() < 1e-12 * (1.0 + exact.abs()));
            }
        }
    }

    #[test]
    fn short_rows_hold_six_coordinates() {
        let row = [0.0, 2.0, 0.0, -1.0, 0.5];
        let x = [7.0, 3.0, 9.0, 4.0, 2.0];
        let short = ShortRow::new(row.into_iter()).unwrap();
        assert_eq!(short.dot(&x), 3.0);
        let mut sum = x;
        short.add_to(2.0, &mut sum);
        assert_eq!(sum, [7.0, 7.0, 9.0, 2.0, 3.0]);
        assert!(ShortRow::new([1.0; 7].into_iter()).is_none());
    }
}
