//! Undamped systems with gyroscopic terms: (s² M + s G + K) φ = 0.

use faer::Mat;
use faer::linalg::solvers::Eigen;

use crate::error::EigenError;
use crate::symmetric::check_input;

/// One mode of a gyroscopic system.
#[derive(Debug, Clone)]
pub struct GyroscopicMode {
    /// ω = |Im s|, rad/s; zero for modes that do not oscillate.
    pub omega: f64,
    /// Re s, 1/s; zero up to rounding for stable motion.
    pub growth: f64,
    /// Complex displacement (re, im), M-normalised, one entry a coordinate.
    pub vector: Vec<(f64, f64)>,
}

/// All n modes for M = diag(`mass`), skew `g` and symmetric `k` (n×n), by ascending ω.
///
/// Solved as the companion matrix of the mass-normalised problem, time scaled by the largest
/// stiffness row so that displacement and velocity have like size. `k` may be singular or
/// indefinite: modes that drift or diverge come out with ω = 0.
///
/// # Errors
/// For unusable input or no convergence.
pub fn gyroscopic_modes(
    mass: &[f64],
    g: &Mat<f64>,
    k: &Mat<f64>,
) -> Result<Vec<GyroscopicMode>, EigenError> {
    check_input(k, mass)?;
    check_input(g, mass)?;
    let n = mass.len();
    let root: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
    let scaled = |a: &Mat<f64>, i: usize, j: usize| a[(i, j)] / (root[i] * root[j]);
    let largest = (0..n).map(|i| scaled(k, i, i).abs()).fold(0.0f64, f64::max);
    let reference = if largest > 0.0 { largest.sqrt() } else { 1.0 };
    // d/dτ [q; q'] = [0 I; −K̃ −G̃] [q; q'], τ = t·ω_ref
    let companion = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => 0.0,
        (true, false) => f64::from(u8::from(j - n == i)),
        (false, true) => -scaled(k, i - n, j) / (reference * reference),
        (false, false) => -scaled(g, i - n, j - n) / reference,
    });
    let solution = Eigen::new_from_real(companion.as_ref())
        .map_err(|_| EigenError::NoConvergence { size: 2 * n })?;
    let values = solution.S().column_vector();
    let vectors = solution.U();
    let mut all: Vec<(f64, f64, usize)> =
        (0..2 * n).map(|j| (values[j].im * reference, values[j].re * reference, j)).collect();
    // Conjugate pairs s, s̄ describe one motion: of 2n values, the n with the larger Im are kept.
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
    let mut modes: Vec<GyroscopicMode> = all[..n]
        .iter()
        .map(|&(im, re, j)| {
            let q: Vec<(f64, f64)> =
                (0..n).map(|i| (vectors[(i, j)].re, vectors[(i, j)].im)).collect();
            let norm = q.iter().map(|(a, b)| a * a + b * b).sum::<f64>().sqrt();
            let norm = if norm > 0.0 { norm } else { 1.0 };
            let vector =
                q.iter().zip(&root).map(|((a, b), m)| (a / (norm * m), b / (norm * m))).collect();
            GyroscopicMode { omega: im.abs(), growth: re, vector }
        })
        .collect();
    modes.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Ok(modes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A mass on an isotropic spring seen from a frame turning at Ω: frequencies |ω₀ ± Ω|.
    #[test]
    fn isotropic_oscillator_in_a_turning_frame() {
        let (m, k, speed) = (2.0, 8e6, 300.0);
        let g = Mat::from_fn(2, 2, |i, j| match (i, j) {
            (0, 1) => -2.0 * m * speed,
            (1, 0) => 2.0 * m * speed,
            _ => 0.0,
        });
        let stiffness = k - m * speed * speed;
        let kk = Mat::from_fn(2, 2, |i, j| if i == j { stiffness } else { 0.0 });
        let modes = gyroscopic_modes(&[m, m], &g, &kk).unwrap();
        let natural = (k / m).sqrt();
        assert!((modes[0].omega - (natural - speed)).abs() < 1e-10 * natural);
        assert!((modes[1].omega - (natural + speed)).abs() < 1e-10 * natural);
        assert!(modes.iter().all(|mode| mode.growth.abs() < 1e-9 * natural));
    }

    #[test]
    fn divergence_is_reported_not_dropped() {
        let g = Mat::zeros(1, 1);
        let k = Mat::from_fn(1, 1, |_, _| -4.0);
        let modes = gyroscopic_modes(&[1.0], &g, &k).unwrap();
        assert_eq!(modes.len(), 1);
        assert!(modes[0].omega == 0.0 && (modes[0].growth - 2.0).abs() < 1e-12);
    }
}
