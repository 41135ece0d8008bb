//! Balanced realisation of a set of decays and its poles by order.

use faer::linalg::solvers::{Eigen, Solve, Svd};
use faer::{Mat, MatRef, c64};

use super::error::IdentifyError;
use super::hankel::Compressed;

/// Singular vectors and eigenvectors with a larger residual are refused.
const RESIDUAL_LIMIT: f64 = 1e-10;

/// States whose singular value is below this share of the largest are rounding.
const ROUNDING: f64 = 1e-11;

/// x(k+1) = A x(k), y(k) = C x(k), x(0) = B: leading blocks are the realisations of lower order.
pub(super) struct Realisation {
    a: Mat<f64>,
    b: Mat<f64>,
    /// U S^½, p·r × n; its first r rows are C.
    observability: Mat<f64>,
    outputs: usize,
    /// Singular values of the states.
    pub sigma: Vec<f64>,
    /// No state is left out: the data hold no noise above rounding.
    pub complete: bool,
}

/// A pole of one order with its share in outputs and inputs.
pub(super) struct RawPole {
    /// Eigenvalue from one block row to the next.
    pub multiplier: c64,
    /// C ψ, one per output.
    pub shape: Vec<c64>,
    /// Row of Ψ⁻¹ B, one per input.
    pub participation: Vec<c64>,
    /// Coherence of the rows with powers of the multiplier, 0 to 1.
    pub coherence: f64,
}

impl Realisation {
    /// Up to `highest` states.
    ///
    /// `[eq:eigensystem-realisation]` H = U S Vᵀ, A = S^−½ Uᵀ H' V S^−½, B = S^−½ Uᵀ [y(0); y(1); …], the first rows
    /// of U S^½ are C.
    /// Source: Juang & Pappa, J. Guidance 8 (1985); with correlations Juang, Cooper & Wright (1988).
    /// Checked by: `dynamics/tests/identify.rs::close_and_repeated_modes_come_out_to_rounding_without_noise`,
    /// `fe.modal.routes`.
    pub(super) fn new(
        matrices: &Compressed,
        outputs: usize,
        highest: usize,
    ) -> Result<Self, IdentifyError> {
        let Compressed { now, next, first } = matrices;
        let size = now.nrows().min(now.ncols());
        let svd = Svd::new_thin(now.as_ref()).map_err(|_| IdentifyError::NoConvergence { size })?;
        let (u, v, s) = (svd.U(), svd.V(), svd.S().column_vector());
        let largest = s[0];
        if largest <= 0.0 {
            return Err(IdentifyError::Silent);
        }
        let n = (0..highest.min(size)).take_while(|&k| s[k] > ROUNDING * largest).count();
        // Complete if the next singular value is rounding, not if `highest` limits the order.
        let complete = n < size.min(highest);
        let (u, v) = (u.subcols(0, n), v.subcols(0, n));
        let off = now.as_ref() * v - Mat::from_fn(u.nrows(), n, |i, j| u[(i, j)] * s[j]);
        let gram = u.transpose() * u - Mat::<f64>::identity(n, n);
        let residual = (off.norm_max() / largest).max(gram.norm_max());
        check_residual("singular vectors", residual)?;
        let root: Vec<f64> = (0..n).map(|k| s[k].sqrt()).collect();
        let middle = u.transpose() * (next * v);
        let a = Mat::from_fn(n, n, |i, j| middle[(i, j)] / (root[i] * root[j]));
        let start = u.transpose() * first;
        let b = Mat::from_fn(n, first.ncols(), |i, j| start[(i, j)] / root[i]);
        let observability = Mat::from_fn(u.nrows(), n, |i, j| u[(i, j)] * root[j]);
        let sigma = (0..n).map(|k| s[k]).collect();
        Ok(Realisation { a, b, observability, outputs, sigma, complete })
    }

    /// Highest order.
    pub(super) fn highest(&self) -> usize {
        self.sigma.len()
    }

    /// Poles in the upper half plane of the realisation of order `n`.
    ///
    /// A is solved as a complex matrix: faer's real route gives wrong eigenvectors for pairs that
    /// are exactly repeated.
    pub(super) fn poles(&self, n: usize) -> Result<Vec<RawPole>, IdentifyError> {
        let complex = |m: MatRef<'_, f64>| {
            Mat::from_fn(m.nrows(), m.ncols(), |i, j| c64::new(m[(i, j)], 0.0))
        };
        let a = complex(self.a.submatrix(0, 0, n, n));
        let solution =
            Eigen::new(a.as_ref()).map_err(|_| IdentifyError::NoConvergence { size: n })?;
        let (values, psi) = (solution.S().column_vector(), solution.U());
        check_eigenvectors(&a, &solution)?;
        // Ψ⁻¹ B
        let participation = psi.partial_piv_lu().solve(&complex(self.b.subrows(0, n)));
        let rows = complex(self.observability.subcols(0, n)) * psi;
        let mut poles = Vec::new();
        // One of each conjugate pair; the imaginary part of a real eigenvalue is rounding.
        for j in (0..n).filter(|&j| values[j].im > 1e-12 * values[j].norm()) {
            let row: Vec<c64> = (0..rows.nrows()).map(|i| rows[(i, j)]).collect();
            poles.push(RawPole {
                multiplier: values[j],
                coherence: coherence(&row, values[j], self.outputs),
                shape: row[..self.outputs].to_vec(),
                participation: (0..participation.ncols()).map(|i| participation[(j, i)]).collect(),
            });
        }
        Ok(poles)
    }
}

/// Refuses eigenvectors with ‖Aψ − λψ‖ above the limit, relative to ‖A‖‖ψ‖.
fn check_eigenvectors(a: &Mat<c64>, solution: &Eigen<f64>) -> Result<(), IdentifyError> {
    let (values, psi) = (solution.S().column_vector(), solution.U());
    let off = a * psi - Mat::from_fn(a.nrows(), a.ncols(), |i, j| psi[(i, j)] * values[j]);
    let size = a.norm_l2();
    for j in 0..a.ncols() {
        let residual = off.col(j).norm_l2() / (size * psi.col(j).norm_l2());
        check_residual("eigenvectors", residual)?;
    }
    Ok(())
}

fn check_residual(of: &'static str, residual: f64) -> Result<(), IdentifyError> {
    match residual <= RESIDUAL_LIMIT {
        true => Ok(()),
        false => Err(IdentifyError::Residual { of, residual, limit: RESIDUAL_LIMIT }),
    }
}

/// `[eq:modal-amplitude-coherence]` Modal amplitude coherence on the outputs: |ā·o|² / (|a|²|o|²) of the rows o the
/// realisation observes and the rows a = φ λ^i they should be.
///
/// Source: Juang & Pappa (1985), on the side of outputs.
/// Checked by: `dynamics/src/identify/realisation.rs::coherence_sees_rows_that_are_no_powers`.
fn coherence(rows: &[c64], multiplier: c64, outputs: usize) -> f64 {
    let (mut product, mut ideal, mut found) = (c64::new(0.0, 0.0), 0.0, 0.0);
    let mut power = c64::new(1.0, 0.0);
    for block in rows.chunks(outputs) {
        for (o, first) in block.iter().zip(rows) {
            let a = power * first;
            product += a.conj() * o;
            ideal += a.norm_sqr();
            found += o.norm_sqr();
        }
        power *= multiplier;
    }
    let norm = ideal * found;
    if norm > 0.0 { product.norm_sqr() / norm } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A = X D X⁻¹ in which every complex pair of D occurs twice: all eigenvectors must satisfy their
    /// equation and be independent. Solved as a real matrix, half of them do not.
    #[test]
    fn exactly_repeated_pairs_have_eigenvectors() {
        for n in [4, 8, 26, 60] {
            let x = Mat::from_fn(n, n, |i, j| ((i * i + 3 * j * j + 7 * i * j) as f64).sin());
            let d = Mat::from_fn(n, n, |i, j| {
                let angle = 0.3 + 0.03 * (i / 4) as f64;
                match (i / 2 == j / 2, i == j) {
                    (true, true) => 0.98 * angle.cos(),
                    (true, false) => 0.98 * angle.sin() * if i < j { 1.0 } else { -1.0 },
                    _ => 0.0,
                }
            });
            // Xᵀ Aᵀ = (X D)ᵀ
            let a = x.transpose().partial_piv_lu().solve((&x * &d).transpose());
            let complex = Mat::from_fn(n, n, |i, j| c64::new(a[(j, i)], 0.0));
            let solution = Eigen::new(complex.as_ref()).unwrap();
            check_eigenvectors(&complex, &solution).unwrap();
            let sigma = solution.U().singular_values().unwrap();
            assert!(sigma[n - 1] > 1e-6 * sigma[0], "{n}: {:e}", sigma[n - 1] / sigma[0]);
        }
    }

    #[test]
    fn coherence_sees_rows_that_are_no_powers() {
        let multiplier = c64::from_polar(0.97, 0.4);
        let first = [c64::new(1.0, 0.2), c64::new(-0.5, 0.0)];
        let mut rows: Vec<c64> =
            (0..20).flat_map(|k| first.map(|x| x * multiplier.powi(k))).collect();
        assert!((coherence(&rows, multiplier, 2) - 1.0).abs() < 1e-12);
        assert!(coherence(&rows, c64::from_polar(0.97, 0.5), 2) < 0.8);
        rows.fill(c64::new(0.0, 0.0));
        assert_eq!(coherence(&rows, multiplier, 2), 0.0);
    }
}
