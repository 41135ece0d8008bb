//! Floquet multipliers: eigenvalues of the derivative of the map of one period.
//!
//! Perturbations of a periodic solution grow by a factor μ each period. It is stable if every |μ| < 1; where
//! it loses stability, μ = 1 means a fold (or a symmetry-breaking branch point), μ = −1 a period doubling, and
//! a complex pair on the unit circle a Neimark–Sacker bifurcation, towards quasi-periodic motion.

use faer::linalg::solvers::Solve;
use faer::{Mat, c64};

use super::derivative::MapDerivative;
use crate::error::EigenError;

/// Columns of R below this share of its largest entry are rounding: they belong to multipliers of zero.
const RANK: f64 = 1e-13;

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

/// Share of the size of a multiplier by which the shift of the inverse iteration is off it, so that the shifted matrix can
/// be factorised.
const SHIFTED: f64 = 1e-9;

/// Steps of the inverse iteration. Each leaves at most a share of [`SHIFTED`] over the relative distance to the next
/// multiplier; of those that coincide any combination is an eigenvector.
const ITERATIONS: usize = 3;

/// Real and imaginary part of an eigenvector of DΦ: how the perturbation with a multiplier moves at the start of a period.
/// All n coordinates of [`MapDerivative`]; those without a column of their own, which follow, are left 0. In scaled
/// coordinates the vector has the norm 1 and its parts are orthogonal, the real one the longer.
///
/// # Errors
/// If an entry is not finite or the iteration meets a singular matrix.
pub fn floquet_vector(
    derivative: &MapDerivative,
    multiplier: Multiplier,
) -> Result<[Vec<f64>; 2], EigenError> {
    let m = derivative.scaled();
    let n = m.nrows();
    let shift = c64::new(multiplier.re, multiplier.im) * (1.0 + SHIFTED);
    let shifted = Mat::<c64>::from_fn(n, n, |i, j| {
        let own = c64::new(m[(i, j)], 0.0);
        if i == j { own - shift } else { own }
    });
    let factor = shifted.partial_piv_lu();
    // A start that is no eigenvector of any symmetry of the set.
    let mut v = Mat::<c64>::from_fn(n, 1, |i, _| {
        let x = i as f64;
        c64::new(1.0 + 0.3 * (1.7 * x).sin(), 0.5 * (2.3 * x + 0.4).cos())
    });
    for _ in 0..ITERATIONS {
        factor.solve_in_place(&mut v);
        let norm = v.norm_l2();
        if !(norm > 0.0 && norm.is_finite()) {
            return Err(EigenError::NoConvergence { size: n });
        }
        v *= faer::Scale(c64::new(1.0 / norm, 0.0));
    }
    // The phase of a complex vector is free: its parts are made orthogonal, the first one the longer.
    let square: c64 = (0..n).map(|i| v[(i, 0)] * v[(i, 0)]).sum();
    let turn = c64::from_polar(1.0, -0.5 * square.arg());
    let mut parts = [(); 2].map(|()| vec![0.0; derivative.scales.len()]);
    for (k, i) in derivative.active.iter().enumerate() {
        let value = v[(k, 0)] * turn * derivative.scales[*i];
        (parts[0][*i], parts[1][*i]) = (value.re, value.im);
    }
    Ok(parts)
}

/// All multipliers that are not zero to rounding, by descending size; both of each conjugate pair, and each as
/// often as its multiplicity.
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
    let values = compressed.eigenvalues().map_err(|_| EigenError::NoConvergence { size: rank })?;
    let mut all: Vec<Multiplier> =
        values.iter().map(|value| Multiplier { re: value.re, im: value.im }).collect();
    all.sort_by(|a, b| {
        b.size().total_cmp(&a.size()).then(b.re.total_cmp(&a.re)).then(b.im.total_cmp(&a.im))
    });
    Ok(all)
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

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
