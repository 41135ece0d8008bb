//! Small dense matrices (about 20×20) for the products of every time step, stored in the order in
//! which they are read, without the strides of a general library.

use nalgebra::DMatrix;

use crate::short_row::ShortRow;

/// Rows of a block, whose sums are formed simultaneously.
pub(super) const BLOCK: usize = 8;

/// Rows of a part of a column in an elimination: half a block, so that fewer rows are padding.
pub(super) const LANES: usize = BLOCK / 2;

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

    /// Becomes equal to another matrix, in the memory it has.
    pub(super) fn copy(&mut self, other: &Self) {
        (self.rows, self.columns) = (other.rows, other.columns);
        self.data.clear();
        self.data.extend_from_slice(&other.data);
    }

    /// Length of a column to the end of the last block.
    pub(super) fn column_len(&self) -> usize {
        self.rows.next_multiple_of(BLOCK)
    }

    /// Adds the product of a column, to the end of the last block, with a row.
    #[inline(always)]
    pub(super) fn add_outer(&mut self, column: &[f64], row: &ShortRow) {
        let (parts, _) = column.as_chunks::<BLOCK>();
        for (columns, part) in self.data.chunks_exact_mut(self.columns.max(1)).zip(parts) {
            for (j, r) in row.terms() {
                let mut sum = columns[j];
                for i in 0..BLOCK {
                    sum[i] += part[i] * r;
                }
                columns[j] = sum;
            }
        }
    }

    /// Number of columns.
    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    /// out += A rᵀ, out to the end of the last block.
    #[inline(always)]
    pub(super) fn add_times_row(&self, row: &ShortRow, out: &mut [f64]) {
        let (parts, _) = out.as_chunks_mut::<BLOCK>();
        for (columns, out) in self.data.chunks_exact(self.columns.max(1)).zip(parts) {
            let mut sum = *out;
            for (j, r) in row.terms() {
                sum.iter_mut().zip(&columns[j]).for_each(|(sum, a)| *sum += r * a);
            }
            *out = sum;
        }
    }

    /// out += r A.
    #[inline(always)]
    pub(super) fn add_row_times(&self, row: &ShortRow, out: &mut [f64]) {
        for (i, r) in row.entries() {
            let columns = &self.data[i / BLOCK * self.columns..][..self.columns];
            out.iter_mut().zip(columns).for_each(|(out, column)| *out += r * column[i % BLOCK]);
        }
    }

    /// Adds the product of a column, to the end of the last block, with a whole row.
    #[inline(always)]
    pub(super) fn add_product_of(&mut self, column: &[f64], row: &[f64]) {
        let (parts, _) = column.as_chunks::<BLOCK>();
        for (columns, part) in self.data.chunks_exact_mut(self.columns.max(1)).zip(parts) {
            for (own, r) in columns.iter_mut().zip(row) {
                let mut sum = *own;
                sum.iter_mut().zip(part).for_each(|(sum, c)| *sum += c * r);
                *own = sum;
            }
        }
    }

    /// The inverse; `None` where there is none.
    ///
    /// Elimination by Gauss and Jordan without pivoting: where the symmetric part is positive definite, as that of a
    /// step's matrix, every pivot is positive. A matrix of which a pivot is not positive, or of more than 32 columns,
    /// is inverted by the library. With the library's inverse of every step's matrix a sweep by shooting
    /// (`benches/steady_states.rs`) took a fifth longer: at an order of 20 its loops over views cost more than the
    /// arithmetic.
    #[inline(always)]
    pub(super) fn inverse(&self, work: &mut Vec<[f64; LANES]>) -> Option<Self> {
        let found = match self.columns.div_ceil(LANES) {
            1 => self.eliminated::<1>(work),
            2 => self.eliminated::<2>(work),
            3 => self.eliminated::<3>(work),
            4 => self.eliminated::<4>(work),
            5 => self.eliminated::<5>(work),
            6 => self.eliminated::<6>(work),
            7 => self.eliminated::<7>(work),
            8 => self.eliminated::<8>(work),
            _ => None,
        };
        found.or_else(|| self.inverse_of_library())
    }

    /// The inverse by elimination, columns held in `PARTS` vectors; `None` where a pivot is not positive.
    #[inline(always)]
    fn eliminated<const PARTS: usize>(&self, work: &mut Vec<[f64; LANES]>) -> Option<Self> {
        let n = self.columns;
        work.clear();
        work.resize(PARTS * n, [0.0; LANES]);
        let (own, _) = work.as_chunks_mut::<PARTS>();
        for (block, columns) in self.data.chunks_exact(n).enumerate() {
            for (own, column) in own.iter_mut().zip(columns) {
                let parts = own[2 * block..].iter_mut().zip(column.as_chunks().0);
                parts.for_each(|(own, part)| *own = *part);
            }
        }
        // From the last to the first: planets, of which each is coupled with the central bodies alone, come last, and
        // until those are eliminated most factors are 0.
        for k in (0..n).rev() {
            let (part, lane) = (k / LANES, k % LANES);
            let pivot = own[k][part][lane];
            if pivot.is_nan() || pivot <= 0.0 {
                return None;
            }
            // a_kj' = a_kj/a_kk, a_kk' = 1/a_kk;   a_ik' = −a_ik/a_kk;   a_ij' = a_ij − a_ik a_kj'
            let inverse = 1.0 / pivot;
            let mut pivot_column = std::mem::replace(&mut own[k], [[0.0; LANES]; PARTS]);
            pivot_column[part][lane] = 0.0;
            own[k][part][lane] = 1.0;
            for column in own.iter_mut() {
                if column[part][lane] == 0.0 {
                    continue;
                }
                let factor = column[part][lane] * inverse;
                for (own, pivot_part) in column.iter_mut().zip(&pivot_column) {
                    own.iter_mut().zip(pivot_part).for_each(|(a, p)| *a -= p * factor);
                }
                column[part][lane] = factor;
            }
        }
        let mut inverse =
            Self { data: vec![[0.0; BLOCK]; self.data.len()], rows: self.rows, columns: n };
        for (block, columns) in inverse.data.chunks_exact_mut(n).enumerate() {
            for (own, column) in own.iter().zip(columns) {
                let parts = own[2 * block..].iter().zip(column.as_chunks_mut().0);
                parts.for_each(|(own, part)| *part = *own);
            }
        }
        // 0 times what is not finite is no number.
        let mut zeros = [[0.0; LANES]; PARTS];
        for column in own.iter() {
            for (zeros, part) in zeros.iter_mut().zip(column) {
                zeros.iter_mut().zip(part).for_each(|(zero, x)| *zero += 0.0 * x);
            }
        }
        zeros.as_flattened().iter().all(|zero| *zero == 0.0).then_some(inverse)
    }

    /// The inverse by elimination with pivoting.
    #[cold]
    fn inverse_of_library(&self) -> Option<Self> {
        let mut inverse = self.full();
        let exists = inverse.try_inverse_mut() && inverse.iter().all(|x| x.is_finite());
        exists.then(|| Self::new(&inverse))
    }

    /// Entries by blocks of [`BLOCK`] rows, columns, and rows of the block, the last block padded with zeros.
    pub(super) fn entries(&self) -> &[f64] {
        self.data.as_flattened()
    }

    /// All entries.
    pub(super) fn full(&self) -> DMatrix<f64> {
        let entry = |i: usize, j: usize| self.data[i / BLOCK * self.columns + j][i % BLOCK];
        DMatrix::from_fn(self.rows, self.columns, entry)
    }

    /// out += A x.
    #[inline(always)]
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

    /// Of matrices as those of a step: symmetric and positive definite, with a skew part as gyroscopic terms have it,
    /// and rows of units that differ by a factor of 1000.
    #[test]
    fn inverses_are_right() {
        for n in [1, 7, 8, 17, 24] {
            let root = DMatrix::from_fn(n, n, |i, j| (1.3 * i as f64 + 2.7 * (j * j) as f64).sin());
            let skew = DMatrix::from_fn(n, n, |i, j| 0.1 * (i as f64 - j as f64));
            let definite = &root * root.transpose() + DMatrix::identity(n, n) + skew;
            let units = DMatrix::from_diagonal(&nalgebra::DVector::from_fn(n, |i, _| {
                if i % 3 == 2 { 1e3 } else { 1.0 }
            }));
            let a = &units * definite * &units;
            let inverse = Packed::new(&a).inverse(&mut Vec::new()).unwrap();
            let own =
                &units * (inverse.full() * &a) * units.map(|u| if u > 0.0 { 1.0 / u } else { 0.0 });
            assert!((own - DMatrix::identity(n, n)).amax() < 1e-11, "{n}");
        }
        assert!(Packed::new(&DMatrix::zeros(3, 3)).inverse(&mut Vec::new()).is_none());
    }

    /// Of order 17, symmetric and with a spread of eigenvalues of 1e8 as the races of a set have, the inverse is as
    /// near as that of the library with its pivoting.
    #[test]
    fn inverses_without_pivoting_are_as_near_as_with_pivoting() {
        let n = 17;
        let angles =
            DMatrix::from_fn(n, n, |i, j| (1.0 + 2.1 * i as f64 + (3 * i * j) as f64).sin());
        let turned = angles.qr().q();
        let spread = nalgebra::DVector::from_fn(n, |i, _| 10f64.powf(0.5 * i as f64));
        let a = &turned * DMatrix::from_diagonal(&spread) * turned.transpose();
        let exact = &turned * DMatrix::from_diagonal(&spread.map(f64::recip)) * turned.transpose();
        let off = |inverse: Packed| (inverse.full() - &exact).amax() / exact.amax();
        let packed = Packed::new(&a);
        let (own, library) =
            (packed.inverse(&mut Vec::new()).unwrap(), packed.inverse_of_library().unwrap());
        let [own, library] = [own, library].map(off);
        assert!(own < 1e-7 && own < 4.0 * library, "{own:e}, library {library:e}");
    }

    #[test]
    fn a_pivot_of_zero_is_left_to_the_library() {
        let swap = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, 1.0, 0.0]);
        assert_eq!(Packed::new(&swap).inverse(&mut Vec::new()).unwrap().full(), swap);
    }

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
