//! The block Hankel matrix, compressed.

use faer::linalg::solvers::Qr;
use faer::{Mat, MatRef};

use super::options::{Method, Options};
use super::records::Records;

/// Rows put through one QR step at a time: bounds the memory.
const CHUNK: usize = 2048;

/// The matrix whose singular vectors span the states, and the same one block row later, both multiplied by
/// the same orthogonal matrix.
pub(super) struct Compressed {
    /// p·r rows.
    pub now: Mat<f64>,
    /// The same, one stride later.
    pub next: Mat<f64>,
    /// First columns: p·r × inputs, the decays from their first sample.
    pub first: Mat<f64>,
}

/// `[eq:block-hankel-matrix]` Lays H with the block y_j(t_c + i·stride) in block row i, for every column start t_c
/// and input j, and compresses it by H = L Q; Q is not needed further.
///
/// Source: Juang & Pappa (1985).
/// Checked by: `dynamics/tests/identify.rs::close_and_repeated_modes_come_out_to_rounding_without_noise`,
/// `dynamics/tests/identify.rs::noise_of_a_ten_thousandth_of_the_peak_moves_little`.
pub(super) fn compressed(records: &Records, options: &Options) -> Compressed {
    let (p, r, m) = (options.block_rows, records.outputs, records.inputs);
    let stride = options.decimation.stride();
    let blocks = match options.method {
        Method::Hankel => p + 1,
        Method::Correlation => 2 * p + 1,
    };
    let sample =
        |t: usize, input: usize, row: usize| records.values[input][row % r][t + (row / r) * stride];
    // Starts from the first sample to the last that leaves room for all rows.
    let last = records.samples - 1 - (blocks - 1) * stride;
    let count = options.block_columns.min(last + 1);
    let start = |c: usize| if count > 1 { c * last / (count - 1) } else { 0 };
    let (columns, size) = (count * m, blocks * r);
    let mut triangle: Mat<f64> = Mat::zeros(0, size);
    let mut done = 0;
    while done < columns {
        let fresh = CHUNK.min(columns - done);
        let old = triangle.nrows();
        // [R; Hᵀ] = Q R'
        let stacked = Mat::from_fn(old + fresh, size, |i, j| match i < old {
            true => triangle[(i, j)],
            false => sample(start((done + i - old) / m), (done + i - old) % m, j),
        });
        triangle = Qr::new(stacked.as_ref()).thin_R().to_owned();
        done += fresh;
    }
    let rank = triangle.nrows();
    let part = |rows: usize, from: usize| -> MatRef<'_, f64> {
        triangle.as_ref().submatrix(0, from, rows.min(rank), p * r)
    };
    let (now, next) = match options.method {
        // H = Rᵀ Qᵀ
        Method::Hankel => (part(rank, 0), part(rank, r)),
        // The rows of the past are R[..pr]ᵀ Q[..pr]ᵀ, so that H Q[..pr] projects H onto them.
        Method::Correlation => (part(p * r, p * r), part(p * r, p * r + r)),
    };
    let (now, next) = (now.transpose().to_owned(), next.transpose().to_owned());
    let first = Mat::from_fn(p * r, m, |i, j| sample(0, j, i));
    Compressed { now, next, first }
}
