//! Floquet multipliers: eigenvalues of the derivative of the map of one period.
//!
//! Perturbations of a periodic solution grow by a factor μ each period. It is stable if every |μ| < 1; where
//! it loses stability, μ = 1 means a fold (or a symmetry-breaking branch point), μ = −1 a period doubling, and
//! a complex pair on the unit circle a Neimark–Sacker bifurcation, towards quasi-periodic motion.

use faer::Mat;

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
        use MultiplierKind::{Fold, NeimarkSacker, PeriodDoubling};
        let kinds: Vec<_> = found[..4].iter().map(|m| m.kind()).collect();
        assert_eq!(kinds, [Fold, NeimarkSacker, NeimarkSacker, PeriodDoubling]);
    }
}
