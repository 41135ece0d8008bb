//! The undamped eigenproblem K φ = λ M φ with a diagonal mass matrix.

use faer::Mat;
use nalgebra::{DMatrix, SymmetricEigen};

use crate::error::EigenError;
use crate::matrix::from_faer;

/// Residuals above this are refused. Sound solutions stay below 1e-13.
const RESIDUAL_LIMIT: f64 = 1e-10;

/// All modes of K φ = λ M φ.
#[derive(Debug, Clone)]
pub struct SymmetricModes {
    /// Eigenvalues λ = ω², ascending, (rad/s)².
    pub lambda: Vec<f64>,
    /// M-orthonormal eigenvectors, one per column (n×n).
    pub vectors: DMatrix<f64>,
    /// max ‖K̃q − λq‖ / max |λ| with K̃ = M^-½ K M^-½, q = M^½ φ.
    pub residual: f64,
}

/// Solves K φ = λ M φ for a symmetric `k` (n×n, lower half used) and M = diag(`mass`).
///
/// `[eq:eigenproblem]` K̃ q = λ q with K̃ = M^−½ K M^−½ and φ = M^−½ q.
/// Source: closed form.
/// Checked by: `dynamics/src/symmetric.rs::chain_of_masses_has_its_closed_form_frequencies`,
/// `lapack_route/tests/agreement.rs`.
///
/// # Errors
/// For unusable input, no convergence, or a residual above 1e-10.
pub fn generalized_symmetric(k: &DMatrix<f64>, mass: &[f64]) -> Result<SymmetricModes, EigenError> {
    let n = mass.len();
    check_input(k, mass)?;
    let root: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
    let scaled = Mat::from_fn(n, n, |i, j| k[(i.max(j), i.min(j))] / (root[i] * root[j]));
    let (lambda, mut vectors) = symmetric_eigen(n, |i, j| scaled[(i, j)])?;
    let largest = lambda.iter().fold(0.0f64, |a, l| a.max(l.abs()));
    let product = &scaled * &vectors;
    let worst = largest_or_nan((0..n).map(|j| {
        let off = |i: usize| product[(i, j)] - lambda[j] * vectors[(i, j)];
        (0..n).map(|i| off(i).powi(2)).sum::<f64>().sqrt()
    }));
    let residual = if largest > 0.0 { worst / largest } else { worst };
    check_residual(residual, n)?;
    for j in 0..n {
        let sign = sign_of_largest((0..n).map(|i| vectors[(i, j)]));
        for i in 0..n {
            vectors[(i, j)] *= sign / root[i];
        }
    }
    Ok(SymmetricModes { lambda, vectors: from_faer(&vectors), residual })
}

/// Eigenvalues (ascending) and orthonormal eigenvectors (columns) of a symmetric matrix.
///
/// nalgebra's QR iteration: at the sizes of a gear set (17 to 45) it takes half the time of faer,
/// and faer's divide and conquer loses accuracy on graded matrices above n ≈ 150 besides.
pub(crate) fn symmetric_eigen(
    n: usize,
    a: impl Fn(usize, usize) -> f64,
) -> Result<(Vec<f64>, Mat<f64>), EigenError> {
    let matrix = DMatrix::from_fn(n, n, a);
    // Two or three iterations per eigenvalue are usual.
    let limit = 100 * n.max(10);
    let solution = SymmetricEigen::try_new(matrix, f64::EPSILON, limit)
        .ok_or(EigenError::NoConvergence { size: n })?;
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| solution.eigenvalues[i].total_cmp(&solution.eigenvalues[j]));
    let values = order.iter().map(|&j| solution.eigenvalues[j]).collect();
    Ok((values, Mat::from_fn(n, n, |i, j| solution.eigenvectors[(i, order[j])])))
}

/// The largest of non-negative numbers, NaN if one of them is NaN, which `f64::max` would ignore.
pub(crate) fn largest_or_nan(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |a, x| if a.is_nan() || x <= a { a } else { x })
}

/// Refuses a residual above the limit, and one that is not a number.
pub(crate) fn check_residual(residual: f64, size: usize) -> Result<(), EigenError> {
    match residual <= RESIDUAL_LIMIT {
        true => Ok(()),
        false => Err(EigenError::Residual { residual, limit: RESIDUAL_LIMIT, size }),
    }
}

pub(crate) fn check_input(k: &DMatrix<f64>, mass: &[f64]) -> Result<(), EigenError> {
    let (rows, columns, masses) = (k.nrows(), k.ncols(), mass.len());
    if rows != masses || columns != masses {
        return Err(EigenError::Size { rows, columns, masses });
    }
    let bad = mass.iter().position(|m| !(*m > 0.0 && m.is_finite()));
    if let Some(index) = bad {
        return Err(EigenError::Mass { index, value: mass[index] });
    }
    for column in 0..columns {
        for row in 0..rows {
            if !k[(row, column)].is_finite() {
                return Err(EigenError::NotFinite { row, column });
            }
        }
    }
    Ok(())
}

/// Sign that makes the component of largest magnitude positive; the first of equals counts.
pub(crate) fn sign_of_largest(components: impl Iterator<Item = f64>) -> f64 {
    let (mut largest, mut sign) = (0.0f64, 1.0);
    for x in components {
        // Of components equal to rounding the first is taken, so that noise does not decide the sign.
        if x.abs() > largest * (1.0 + 1e-9) {
            (largest, sign) = (x.abs(), x.signum());
        }
    }
    sign
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fixed–free chain of n equal masses and springs: λ_j = 4 (k/m) sin²((2j−1)π/(2(2n+1))).
    #[test]
    fn chain_of_masses_has_its_closed_form_frequencies() {
        for n in [1, 2, 17, 150, 201] {
            let (stiffness, mass) = (3e8, 0.7);
            let k = DMatrix::from_fn(n, n, |i, j| match i.abs_diff(j) {
                0 if i + 1 == n => stiffness,
                0 => 2.0 * stiffness,
                1 => -stiffness,
                _ => 0.0,
            });
            let modes = generalized_symmetric(&k, &vec![mass; n]).unwrap();
            for (j, lambda) in modes.lambda.iter().enumerate() {
                let angle = (2 * j + 1) as f64 * std::f64::consts::PI / (2 * (2 * n + 1)) as f64;
                let exact = 4.0 * stiffness / mass * angle.sin().powi(2);
                assert!((lambda - exact).abs() < 1e-12 * 4.0 * stiffness / mass, "{n} {j}");
            }
            assert!(modes.residual < 1e-13, "{n}: {:e}", modes.residual);
        }
    }

    #[test]
    fn bad_input_is_refused() {
        let k = DMatrix::from_fn(2, 2, |i, j| if i == j { 1.0 } else { 0.0 });
        assert!(matches!(generalized_symmetric(&k, &[1.0]), Err(EigenError::Size { .. })));
        assert!(matches!(generalized_symmetric(&k, &[1.0, 0.0]), Err(EigenError::Mass { .. })));
        let nan = DMatrix::from_fn(2, 2, |_, _| f64::NAN);
        let refused = generalized_symmetric(&nan, &[1.0, 1.0]);
        assert!(matches!(refused, Err(EigenError::NotFinite { .. })));
    }
    /// Stiffnesses and masses over eight decades, at sizes where divide and conquer loses accuracy.
    #[test]
    fn graded_systems_keep_their_residual_and_orthonormality() {
        for n in [21, 150, 300] {
            let grade = |i: usize| 10f64.powf(8.0 * ((7 * i) % n) as f64 / n as f64);
            let mass: Vec<f64> = (0..n).map(|i| grade((3 * i + 1) % n) * 1e-4).collect();
            // Springs to ground and to the next coordinate.
            let mut k = DMatrix::zeros(n, n);
            for i in 0..n {
                k[(i, i)] += grade(i);
                if i + 1 < n {
                    let next = grade(i + 1);
                    k[(i, i)] += next;
                    k[(i + 1, i + 1)] += next;
                    k[(i + 1, i)] -= next;
                    k[(i, i + 1)] -= next;
                }
            }
            let modes = generalized_symmetric(&k, &mass).unwrap();
            assert!(modes.residual < 1e-13, "{n}: {:e}", modes.residual);
            for a in 0..n {
                for b in 0..=a {
                    let product: f64 = (0..n)
                        .map(|i| modes.vectors[(i, a)] * mass[i] * modes.vectors[(i, b)])
                        .sum();
                    let expected = if a == b { 1.0 } else { 0.0 };
                    assert!((product - expected).abs() < 1e-12, "{n} ({a}, {b}): {product}");
                }
            }
        }
    }

    #[test]
    fn the_largest_component_is_positive_and_the_first_of_equals_counts() {
        // Two equal masses on a spring: φ = (1, 1)/√2 and (1, −1)/√2.
        let k = DMatrix::from_fn(2, 2, |i, j| if i == j { 1.0 } else { -1.0 });
        let modes = generalized_symmetric(&k, &[1.0, 1.0]).unwrap();
        assert!((0..2).all(|j| modes.vectors[(0, j)] > 0.7) && modes.vectors[(1, 1)] < -0.7);
    }

    /// Finite entries whose mass-normalised form overflows: an error is required, not a mode.
    #[test]
    fn an_overflow_is_an_error_and_not_a_mode() {
        let k = DMatrix::from_fn(2, 2, |i, j| if i == j { 1e200 } else { 0.5e200 });
        assert!(generalized_symmetric(&k, &[1e-200, 1e-200]).is_err());
    }

    #[test]
    fn one_nan_residual_is_enough() {
        assert!(largest_or_nan([1.0, f64::NAN, 2.0]).is_nan());
        assert_eq!(largest_or_nan([1.0, 3.0, 2.0]), 3.0);
        assert!(check_residual(f64::NAN, 2).is_err() && check_residual(2e-10, 2).is_err());
        assert!(check_residual(1e-11, 2).is_ok());
    }
}
