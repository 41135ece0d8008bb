//! Modes of a damped system in first-order form ẏ = A y.

use faer::linalg::evd::EvdError;
use faer::linalg::solvers::Eigen;
use faer::{Mat, c64};
use nalgebra::DMatrix;

use crate::error::EigenError;
use crate::matrix::to_faer;
use crate::symmetric::check_residual;

/// One mode e^{st} of ẏ = A y.
#[derive(Debug, Clone, PartialEq)]
pub struct StateMode {
    /// s = re + i im, 1/s; of a conjugate pair the one with im > 0.
    pub exponent: (f64, f64),
    /// y (re, im), of unit length.
    pub vector: Vec<(f64, f64)>,
}

impl StateMode {
    /// |s|, rad/s: the undamped natural frequency of an oscillating mode.
    pub fn natural_frequency(&self) -> f64 {
        self.exponent.0.hypot(self.exponent.1)
    }

    /// −Re s / |s|; one for a decay without oscillation.
    pub fn damping_ratio(&self) -> f64 {
        -self.exponent.0 / self.natural_frequency()
    }
}

/// All modes of A (n×n), by ascending |s|; one of each conjugate pair.
///
/// `[eq:state-space-modes]` ẏ = A y has the motions y e^{st} with A y = s y; natural frequency |s|, damping ratio −Re
/// s/|s|.
/// Source: closed form.
/// Checked by: `dynamics/src/state_space.rs::a_damped_swing_and_a_decay`,
/// `dynamics/src/state_space.rs::a_repeated_pair_keeps_sound_vectors`.
///
/// The caller scales states and time so that the entries of A are of similar size.
///
/// # Errors
/// If an entry is not finite, the iteration does not converge, or ‖A y − s y‖ exceeds 1e-10 of the
/// largest |s|.
pub fn state_modes(a: &DMatrix<f64>) -> Result<Vec<StateMode>, EigenError> {
    let n = a.nrows();
    for column in 0..n {
        for row in 0..n {
            if !a[(row, column)].is_finite() {
                return Err(EigenError::NotFinite { row, column });
            }
        }
    }
    let solution = complex_eigen(&to_faer(a)).map_err(|_| EigenError::NoConvergence { size: n })?;
    let (values, vectors) = (solution.S(), solution.U());
    let largest = (0..n).map(|j| values[j].re.hypot(values[j].im)).fold(0.0f64, f64::max);
    let mut modes = Vec::new();
    let mut worst = 0.0f64;
    for j in 0..n {
        let (re, im) = (values[j].re, values[j].im);
        let raw: Vec<(f64, f64)> =
            (0..n).map(|i| (vectors[(i, j)].re, vectors[(i, j)].im)).collect();
        let norm = raw.iter().map(|(x, y)| x * x + y * y).sum::<f64>().sqrt();
        let vector: Vec<_> = raw.iter().map(|(x, y)| (x / norm, y / norm)).collect();
        let off = |i: usize| {
            let mut sum = (0.0, 0.0);
            for (k, (x, y)) in vector.iter().enumerate() {
                sum = (sum.0 + a[(i, k)] * x, sum.1 + a[(i, k)] * y);
            }
            let (x, y) = vector[i];
            (sum.0 - (re * x - im * y)).powi(2) + (sum.1 - (re * y + im * x)).powi(2)
        };
        let residual = (0..n).map(off).sum::<f64>().sqrt();
        worst = if residual.is_nan() { f64::NAN } else { worst.max(residual) };
        if im >= 0.0 {
            modes.push(StateMode { exponent: (re, im), vector });
        }
    }
    if largest > 0.0 {
        check_residual(worst / largest, n)?;
    }
    modes.sort_by(|x, y| x.natural_frequency().total_cmp(&y.natural_frequency()));
    Ok(modes)
}

/// Eigenvalues and vectors of a real matrix by the complex route: faer's real one gives wrong
/// vectors where a complex pair is repeated, as translational modes are.
pub(crate) fn complex_eigen(a: &Mat<f64>) -> Result<Eigen<f64>, EvdError> {
    let complex = Mat::from_fn(a.nrows(), a.ncols(), |i, j| c64::new(a[(i, j)], 0.0));
    Eigen::new(complex.as_ref())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal oscillators, mixed by a rotation: a complex pair that occurs twice.
    #[test]
    fn a_repeated_pair_keeps_sound_vectors() {
        let (omega, zeta) = (3.0, 0.02);
        let turn = |angle: f64| {
            let (s, c) = angle.sin_cos();
            DMatrix::from_fn(4, 4, |i, j| match (i % 2, j % 2, i / 2 == j / 2) {
                (a, b, true) if a == b => c,
                (0, 1, true) => -s,
                (1, 0, true) => s,
                _ => 0.0,
            })
        };
        let pure = DMatrix::from_fn(4, 4, |i, j| match (i < 2, j < 2) {
            (true, false) => f64::from(u8::from(j - 2 == i)),
            (false, true) if i - 2 == j => -omega * omega,
            (false, false) if i == j => -2.0 * zeta * omega,
            _ => 0.0,
        });
        let r = turn(0.6);
        let modes = state_modes(&(&r * &pure * r.transpose())).unwrap();
        assert_eq!(modes.len(), 2);
        assert!(modes.iter().all(|m| (m.natural_frequency() - omega).abs() < 1e-10));
    }

    #[test]
    fn a_damped_swing_and_a_decay() {
        // ẍ + 2ζω ẋ + ω² x = 0 with ω = 3, ζ = 0.1; ż = −5 z.
        let (omega, zeta) = (3.0, 0.1);
        let rows = [[0.0, 1.0, 0.0], [-omega * omega, -2.0 * zeta * omega, 0.0], [0.0, 0.0, -5.0]];
        let modes = state_modes(&DMatrix::from_fn(3, 3, |i, j| rows[i][j])).unwrap();
        assert_eq!(modes.len(), 2);
        assert!((modes[0].natural_frequency() - omega).abs() < 1e-12);
        assert!((modes[0].damping_ratio() - zeta).abs() < 1e-12);
        assert!((modes[1].damping_ratio() - 1.0).abs() < 1e-12);
        assert!(state_modes(&DMatrix::from_fn(1, 1, |_, _| f64::NAN)).is_err());
    }
}
