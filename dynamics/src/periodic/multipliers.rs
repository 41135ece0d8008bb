//! Floquet multipliers: eigenvalues of the derivative of the map of one period.
//!
//! Perturbations of a periodic solution grow by a factor μ each period. It is stable if every |μ| < 1; where
//! it loses stability, μ = 1 means a fold (or a symmetry-breaking branch point), μ = −1 a period doubling, and
//! a complex pair on the unit circle a Neimark–Sacker bifurcation, towards quasi-periodic motion.

use faer::Mat;
use nalgebra::{Complex, DMatrix, DVector, Schur};

use super::derivative::MapDerivative;
use crate::error::EigenError;

/// Columns of R below this share of its largest entry are rounding: they belong to multipliers of zero.
const RANK: f64 = 1e-13;

/// Where the pivots of an elimination with row exchanges stay above this share of the largest, no multiplier is zero to
/// rounding.
const FULL_RANK: f64 = 1e-6;

/// Iterations of nalgebra's Schur form for each row of a matrix: three are usual.
const MOST_ROTATIONS: usize = 30;

/// A complex pair nearer than this angle (rad) to the real axis loses stability as a real multiplier does.
const REAL: f64 = 1e-7;

/// How a motion loses stability when this multiplier leaves the unit circle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MultiplierKind {
    /// Real and positive: at +1 a fold or a branch point.
    Fold,
    /// Real and negative: at −1 a period doubling.
    PeriodDoubling,
    /// Complex: on the unit circle a Neimark–Sacker bifurcation.
    NeimarkSacker,
}

/// A multiplier μ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Multiplier {
    /// Re μ.
    pub re: f64,
    /// Im μ.
    pub im: f64,
}

impl Multiplier {
    /// |μ|.
    pub fn size(self) -> f64 {
        self.re.hypot(self.im)
    }

    /// The product with another one.
    pub fn times(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }

    /// How stability is lost where it leaves the unit circle.
    pub fn kind(self) -> MultiplierKind {
        if self.im.abs() > REAL * self.size() {
            MultiplierKind::NeimarkSacker
        } else if self.re < 0.0 {
            MultiplierKind::PeriodDoubling
        } else {
            MultiplierKind::Fold
        }
    }
}

/// Share of the size of a multiplier by which the shift of the inverse iteration is off it, so that the shifted matrix
/// can be factorised.
const SHIFTED: f64 = 1e-9;

/// Steps of the inverse iteration. Each leaves at most a share of [`SHIFTED`] over the relative distance to the next
/// multiplier; of those that coincide any combination is an eigenvector.
const ITERATIONS: usize = 3;

/// Real and imaginary part of an eigenvector of DΦ: how the perturbation with a multiplier moves at the start of a
/// period. All n coordinates of [`MapDerivative`]; those without a column of their own, which follow, are left 0. In
/// scaled coordinates the vector has the norm 1 and its parts are orthogonal, the real one the longer.
///
/// # Errors
/// If an entry is not finite or the iteration meets a singular matrix.
pub fn floquet_vector(
    derivative: &MapDerivative,
    multiplier: Multiplier,
) -> Result<[Vec<f64>; 2], EigenError> {
    let m = derivative.scaled();
    let n = m.nrows();
    let shift = Complex::new(multiplier.re, multiplier.im) * (1.0 + SHIFTED);
    let shifted = DMatrix::from_fn(n, n, |i, j| {
        let own = Complex::new(m[(i, j)], 0.0);
        if i == j { own - shift } else { own }
    });
    let factor = shifted.lu();
    // A start that is no eigenvector of any symmetry of the set.
    let mut v = DVector::from_fn(n, |i, _| {
        let x = i as f64;
        Complex::new(1.0 + 0.3 * (1.7 * x).sin(), 0.5 * (2.3 * x + 0.4).cos())
    });
    for _ in 0..ITERATIONS {
        let is_regular = factor.solve_mut(&mut v);
        let norm = v.norm();
        if !(is_regular && norm > 0.0 && norm.is_finite()) {
            return Err(EigenError::NoConvergence { size: n });
        }
        v.unscale_mut(norm);
    }
    // The phase of a complex vector is free: its parts are made orthogonal, the first one the longer.
    let square: Complex<f64> = v.iter().map(|own| own * own).sum();
    let turn = Complex::from_polar(1.0, -0.5 * square.arg());
    let mut parts = [(); 2].map(|()| vec![0.0; derivative.scales.len()]);
    for (k, i) in derivative.active.iter().enumerate() {
        let value = v[k] * turn * derivative.scales[*i];
        (parts[0][*i], parts[1][*i]) = (value.re, value.im);
    }
    Ok(parts)
}

/// All multipliers that are not zero to rounding, by descending size; both of each conjugate pair, and each as
/// often as its multiplicity.
///
/// `[eq:floquet-multipliers]` det(DΦ − μ I) = 0; the product of all μ is that of the steps' determinants.
/// Source: theorem (their product is Liouville's).
/// Checked by: `dynamics/tests/periodic.rs::the_product_of_multipliers_is_that_of_the_steps_determinants`,
/// `dynamics/tests/mathieu.rs::multipliers_leave_the_unit_circle_at_the_borders`.
///
/// # Errors
/// If an entry is not finite or the iteration does not converge.
pub fn multipliers(derivative: &MapDerivative) -> Result<Vec<Multiplier>, EigenError> {
    let m = derivative.scaled();
    let n = m.nrows();
    for column in 0..n {
        for row in 0..n {
            if !m[(row, column)].is_finite() {
                return Err(EigenError::NotFinite { row, column });
            }
        }
    }
    let own = if has_full_rank(&m) {
        m
    } else {
        let m = Mat::from_fn(n, n, |i, j| m[(i, j)]);
        // M P = Q R: with Q₁ the columns of Q that span the range of M, Q₁ᵀ M Q₁ has the multipliers of M that
        // are not zero. Zeros of a high order would otherwise come out as small numbers.
        let qr = m.col_piv_qr();
        let r = qr.thin_R();
        let largest = if n > 0 { r[(0, 0)].abs() } else { 0.0 };
        let rank = (0..n).take_while(|k| r[(*k, *k)].abs() > RANK * largest).count();
        if rank == 0 {
            return Ok(Vec::new());
        }
        let q = qr.compute_thin_Q();
        let q = q.subcols(0, rank);
        let compressed: Mat<f64> = q.transpose() * &m * q;
        DMatrix::from_fn(rank, rank, |i, j| compressed[(i, j)])
    };
    let mut all = eigenvalues(own)?;
    all.sort_by(|a, b| {
        b.size().total_cmp(&a.size()).then(b.re.total_cmp(&a.re)).then(b.im.total_cmp(&a.im))
    });
    Ok(all)
}

fn has_full_rank(m: &DMatrix<f64>) -> bool {
    let pivots = m.clone().lu().u().diagonal().abs();
    !pivots.is_empty() && pivots.min() > FULL_RANK * pivots.max()
}

/// Eigenvalues from nalgebra's Schur form, which at order 34 takes about half of the time of faer's eigenvalues. Of
/// some matrices it does not end, or leaves a block that it cannot solve: these have faer's.
fn eigenvalues(m: DMatrix<f64>) -> Result<Vec<Multiplier>, EigenError> {
    let size = m.nrows();
    let quick = quick_eigenvalues(m.clone());
    quick.map_or_else(
        || {
            let values = Mat::from_fn(size, size, |i, j| m[(i, j)]).eigenvalues();
            let values = values.map_err(|_| EigenError::NoConvergence { size })?;
            Ok(values.iter().map(|value| Multiplier { re: value.re, im: value.im }).collect())
        },
        Ok,
    )
}

/// Those of nalgebra; `None` if it has none.
fn quick_eigenvalues(m: DMatrix<f64>) -> Option<Vec<Multiplier>> {
    let most = MOST_ROTATIONS * m.nrows();
    let values = Schur::try_new(m, f64::EPSILON, most)?.complex_eigenvalues();
    let all = values.iter().map(|value| Multiplier { re: value.re, im: value.im });
    values.iter().all(|value| value.re.is_finite() && value.im.is_finite()).then(|| all.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The roots of zⁿ = 1 from the matrix of a cyclic shift, of which nalgebra's Schur form does not end: it has no
    /// exceptional shifts (its issue 611).
    #[test]
    fn what_one_library_does_not_end_the_other_does() {
        let n = 12;
        let mut columns = DMatrix::<f64>::zeros(n, n);
        (1..n).for_each(|i| columns[(i, i - 1)] = 1.0);
        columns[(0, n - 1)] = 1.0;
        assert!(quick_eigenvalues(columns.clone()).is_none());
        let derivative = MapDerivative { active: (0..n).collect(), columns, scales: vec![1.0; n] };
        let found = multipliers(&derivative).unwrap();
        assert_eq!(found.len(), n);
        let real = found.iter().filter(|m| m.im.abs() < 1e-12).count();
        assert!(real == 2 && found.iter().all(|m| (m.size() - 1.0).abs() < 1e-12), "{found:?}");
    }

    /// Both libraries on a matrix with pairs of all sizes down to 0.03.
    #[test]
    fn both_libraries_find_the_same_multipliers() {
        let n = 34;
        let mut m = DMatrix::<f64>::zeros(n, n);
        for k in 0..n / 2 {
            let (sin, cos) = (0.3 + 0.37 * k as f64).sin_cos();
            let size = 0.99 - 0.06 * k as f64;
            for (i, j, x) in [(0, 0, cos), (0, 1, -sin), (1, 0, sin), (1, 1, cos)] {
                m[(2 * k + i, 2 * k + j)] = size * x;
            }
        }
        let off = |i: usize, j: usize| 0.3 * ((1 + 7 * i + 13 * j) as f64).sin();
        let t = DMatrix::from_fn(n, n, |i, j| if i == j { 1.0 } else { off(i, j) });
        let m = &t * m * t.clone().try_inverse().unwrap();
        assert!(has_full_rank(&m));
        let mut quick: Vec<f64> =
            quick_eigenvalues(m.clone()).unwrap().iter().map(|m| m.size()).collect();
        let other = Mat::from_fn(n, n, |i, j| m[(i, j)]).eigenvalues().unwrap();
        let mut other: Vec<f64> = other.iter().map(|value| value.re.hypot(value.im)).collect();
        quick.sort_by(f64::total_cmp);
        other.sort_by(f64::total_cmp);
        for (k, (a, b)) in quick.iter().zip(&other).enumerate() {
            let exact = 0.99 - 0.06 * ((n - 1 - k) / 2) as f64;
            assert!((a - b).abs() < 1e-11 && (a - exact).abs() < 1e-11, "{k}: {a} {b} {exact}");
        }
    }

    /// A rotation by an angle with decay, a real pair, and a nilpotent block of order three.
    #[test]
    fn known_multipliers_are_found_and_zeros_left_out() {
        let mut m = DMatrix::<f64>::zeros(7, 7);
        let (sin, cos) = 0.7f64.sin_cos();
        let block = [[cos, -sin], [sin, cos]].map(|row| row.map(|x| 0.9 * x));
        for i in 0..2 {
            for j in 0..2 {
                m[(i, j)] = block[i][j];
            }
        }
        (m[(2, 2)], m[(3, 3)]) = (1.5, -0.25);
        (m[(4, 5)], m[(5, 6)]) = (3.0, 2.0);
        let t = DMatrix::from_fn(
            7,
            7,
            |i, j| {
                if i == j { 1.0 } else { 0.2 / (1.0 + (i + 2 * j) as f64) }
            },
        );
        let similar = &t * m * t.clone().try_inverse().unwrap();
        let derivative =
            MapDerivative { active: (0..7).collect(), columns: similar, scales: vec![1.0; 7] };
        let found = multipliers(&derivative).unwrap();
        // The nilpotent block has rank two.
        assert!(found[4..].iter().all(|m| m.size() < 1e-6), "{found:?}");
        let expected = [(1.5, 0.0), (0.9 * cos, 0.9 * sin), (0.9 * cos, -0.9 * sin), (-0.25, 0.0)];
        for (found, (re, im)) in found.iter().zip(expected) {
            assert!((found.re - re).abs() < 1e-12 && (found.im - im).abs() < 1e-12, "{found:?}");
        }
        // M v = μ v with the real and imaginary parts of v, for each of them.
        let scales: Vec<f64> = (0..7).map(|i| 10f64.powi(i % 3)).collect();
        let derivative = MapDerivative { scales: scales.clone(), ..derivative };
        for own in &found[..4] {
            let [re, im] = floquet_vector(&derivative, *own).unwrap();
            let [re, im] = [re, im].map(nalgebra::DVector::from_vec);
            let m = &derivative.columns;
            let off =
                [m * &re - (&re * own.re - &im * own.im), m * &im - (&re * own.im + &im * own.re)];
            assert!(off.iter().all(|o| o.norm() < 1e-10), "{own:?}: {off:?}");
            let [re, im] =
                [re, im].map(|part| nalgebra::DVector::from_fn(7, |i, _| part[i] / scales[i]));
            assert!((re.norm_squared() + im.norm_squared() - 1.0).abs() < 1e-12);
            assert!(re.dot(&im).abs() < 1e-12 && re.norm() >= im.norm());
            // A real multiplier has a real vector.
            assert!(own.im != 0.0 || im.norm() < 1e-10, "{im}");
        }
        use MultiplierKind::{Fold, NeimarkSacker, PeriodDoubling};
        let kinds: Vec<_> = found[..4].iter().map(|m| m.kind()).collect();
        assert_eq!(kinds, [Fold, NeimarkSacker, NeimarkSacker, PeriodDoubling]);
    }
}
