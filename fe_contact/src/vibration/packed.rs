//! Small dense matrices (about 20×20) for the products of every time step, stored in the order in
//! which they are read, without the strides of a general library.

use nalgebra::DMatrix;

/// Rows of a block, whose sums are formed simultaneously.
const BLOCK: usize = 8;

/// `sum` plus the product of a block with x.
#[inline(always)]
fn added(mut sum: [f64; BLOCK], block: &[[f64; BLOCK]], x: &[f64]) -> [f64; BLOCK] {
    for (column, x) in block.iter().zip(x) {
        for (sum, a) in sum.iter_mut().zip(column) {
            *sum += a * x;
        }
    }
    sum
}

/// A dense matrix in blocks of rows, each stored by columns, the last one padded with zeros.
#[derive(Debug, Clone, Default)]
pub(super) struct Packed {
    rows: usize,
    columns: usize,
    data: Vec<[f64; BLOCK]>,
}

impl Packed {
    pub(super) fn new(matrix: &DMatrix<f64>) -> Self {
        let (rows, columns) = matrix.shape();
        let mut data = vec![[0.0; BLOCK]; rows.div_ceil(BLOCK) * columns];
        for (j, column) in matrix.as_slice().chunks_exact(rows.max(1)).enumerate() {
            for (part, block) in column.chunks(BLOCK).zip(data[j..].iter_mut().step_by(columns)) {
                block[..part.len()].copy_from_slice(part);
            }
        }
        Self { rows, columns, data }
    }

    /// out += A x.
    pub(super) fn add_product(&self, x: &[f64], out: &mut [f64]) {
        let (x, out) = (&x[..self.columns], &mut out[..self.rows]);
        let blocks = self.data.chunks_exact(self.columns.max(1));
        for (block, out) in blocks.zip(out.chunks_mut(BLOCK)) {
            // With a length known at compile time, a whole block is not copied by two library
            // calls.
            if let Ok(whole) = <&mut [f64; BLOCK]>::try_from(&mut *out) {
                *whole = added(*whole, block, x);
            } else {
                let mut part = [0.0; BLOCK];
                part[..out.len()].copy_from_slice(out);
                out.copy_from_slice(&added(part, block, x)[..out.len()]);
            }
        }
    }

    /// Memory, bytes.
    pub(super) fn bytes(&self) -> usize {
        8 * BLOCK * self.data.len()
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
}
