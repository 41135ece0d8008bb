//! Undamped systems with gyroscopic terms: (s² M + s G + K) φ = 0.

use faer::Mat;
use nalgebra::DMatrix;

use crate::error::EigenError;
use crate::state_space::complex_eigen;
use crate::symmetric::{check_input, check_residual, largest_or_nan};

/// |Im s| over the scale of the frequencies below which a value is real: s = 0, which occurs twice, comes out with 1e-8.
const REAL: f64 = 1e-9;

/// One mode of a gyroscopic system.
#[derive(Debug, Clone)]
pub struct GyroscopicMode {
    /// ω = |Im s|, rad/s; zero for modes that do not oscillate.
    pub omega: f64,
    /// Re s, 1/s; zero up to rounding for stable motion.
    pub growth: f64,
    /// Complex displacement (re, im), M-normalised, one entry per coordinate.
    pub vector: Vec<(f64, f64)>,
}

/// All n modes for M = diag(`mass`), skew `g` and symmetric `k` (n×n), by ascending ω.
///
/// `[eq:gyroscopic-modes]` (s² M + s G + K) φ = 0 as d/dτ [q; q'] = [0 I; −K̃ −G̃] [q; q'] with τ = ω_ref t.
/// Source: closed form.
/// Checked by: `dynamics/src/gyroscopic.rs::isotropic_oscillator_in_a_turning_frame`,
/// `dynamics/src/gyroscopic.rs::fast_spin_steadies_what_would_fall`.
///
/// Solved as the companion matrix of the mass-normalised problem, time scaled by the largest
/// stiffness row so that displacement and velocity have like size. `k` may be singular or
/// indefinite: a mode that drifts or diverges has ω = 0 and occurs once (s = ±a is one mode, of growth +a);
/// flutter, s = ±a ± iω, is two modes, of growth +a and −a.
///
/// # Errors
/// For unusable input, no convergence, or ‖(s²M̃ + sG̃ + K̃)q‖ above 1e-10 (M̃ = I, time scaled).
pub fn gyroscopic_modes(
    mass: &[f64],
    g: &DMatrix<f64>,
    k: &DMatrix<f64>,
) -> Result<Vec<GyroscopicMode>, EigenError> {
    check_input(k, mass)?;
    check_input(g, mass)?;
    let n = mass.len();
    let root: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
    let scaled = |a: &DMatrix<f64>, i: usize, j: usize| a[(i, j)] / (root[i] * root[j]);
    let largest = (0..n).map(|i| scaled(k, i, i).abs()).fold(0.0f64, f64::max);
    let reference = if largest > 0.0 { largest.sqrt() } else { 1.0 };
    let companion = Mat::from_fn(2 * n, 2 * n, |i, j| match (i < n, j < n) {
        (true, true) => 0.0,
        (true, false) => f64::from(u8::from(j - n == i)),
        (false, true) => -scaled(k, i - n, j) / (reference * reference),
        (false, false) => -scaled(g, i - n, j - n) / reference,
    });
    let solution =
        complex_eigen(&companion).map_err(|_| EigenError::NoConvergence { size: 2 * n })?;
    let values = solution.S().column_vector();
    let vectors = solution.U();
    // Real values have rounding errors of either sign in place of Im, which must not choose between s = a and s = −a.
    let im = |j: usize| if values[j].im.abs() < REAL { 0.0 } else { values[j].im };
    let mut all: Vec<(f64, f64, usize)> =
        (0..2 * n).map(|j| (im(j) * reference, values[j].re * reference, j)).collect();
    // Conjugate pairs s, s̄ describe one motion: of 2n values, the n with the larger Im are kept, of real ones the
    // larger.
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1)));
    let mut modes = Vec::with_capacity(n);
    let mut residuals = Vec::with_capacity(n);
    for &(im, re, j) in &all[..n] {
        let q: Vec<(f64, f64)> = (0..n).map(|i| (vectors[(i, j)].re, vectors[(i, j)].im)).collect();
        let norm = q.iter().map(|(a, b)| a * a + b * b).sum::<f64>().sqrt();
        let unit: Vec<(f64, f64)> = q.iter().map(|(a, b)| (a / norm, b / norm)).collect();
        residuals.push(residual(&companion, (re / reference, im / reference), &unit));
        let vector = unit.iter().zip(&root).map(|((a, b), m)| (a / m, b / m)).collect();
        modes.push(GyroscopicMode { omega: im.abs(), growth: re, vector });
    }
    check_residual(largest_or_nan(residuals), n)?;
    modes.sort_by(|a, b| a.omega.total_cmp(&b.omega));
    Ok(modes)
}

/// ‖(s² + s G̃ + K̃) q‖ for unit q, relative to 1 + |s|²; the lower half of the companion is −K̃, −G̃.
fn residual(companion: &Mat<f64>, (re, im): (f64, f64), q: &[(f64, f64)]) -> f64 {
    let n = q.len();
    let square = (re * re - im * im, 2.0 * re * im);
    let row = |i: usize| {
        let mut sum =
            (square.0 * q[i].0 - square.1 * q[i].1, square.0 * q[i].1 + square.1 * q[i].0);
        for (j, (a, b)) in q.iter().enumerate() {
            let (k, g) = (-companion[(n + i, j)], -companion[(n + i, n + j)]);
            sum.0 += (k + re * g) * a - im * g * b;
            sum.1 += (k + re * g) * b + im * g * a;
        }
        sum.0 * sum.0 + sum.1 * sum.1
    };
    (0..n).map(row).sum::<f64>().sqrt() / (1.0 + re * re + im * im)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two equal unit masses on springs k, coupled by ±g: s² ± i g s + k = 0, so
    /// s = ∓i g/2 ± i √(g²/4 + k).
    fn gyroscope(g: f64, k: f64) -> Vec<GyroscopicMode> {
        let gg = DMatrix::from_fn(2, 2, |i, j| g * (i as f64 - j as f64));
        let kk = DMatrix::from_fn(2, 2, |i, j| if i == j { k } else { 0.0 });
        gyroscopic_modes(&[1.0, 1.0], &gg, &kk).unwrap()
    }

    fn assert_modes(found: &[GyroscopicMode], expected: &[(f64, f64)], tolerance: f64) {
        assert_eq!(found.len(), expected.len());
        for (mode, (omega, growth)) in found.iter().zip(expected) {
            let off = (mode.omega - omega).abs().max((mode.growth - growth).abs());
            assert!(off < tolerance, "{} {} {omega} {growth}", mode.omega, mode.growth);
        }
    }

    #[test]
    fn fast_spin_steadies_what_would_fall() {
        // k = −3, g = 4: ω = 2 ∓ 1.
        assert_modes(&gyroscope(4.0, -3.0), &[(1.0, 0.0), (3.0, 0.0)], 1e-12);
    }

    #[test]
    fn flutter_is_two_modes_one_growing_and_one_dying() {
        // k = −5, g = 4: s = ±1 ± 2i.
        let mut found = gyroscope(4.0, -5.0);
        found.sort_by(|a, b| a.growth.total_cmp(&b.growth));
        assert_modes(&found, &[(2.0, -1.0), (2.0, 1.0)], 1e-12);
    }

    #[test]
    fn free_motion_circles_or_rests() {
        // k = 0: s = 0 twice, ±i g.
        assert_modes(&gyroscope(4.0, 0.0), &[(0.0, 0.0), (4.0, 0.0)], 1e-7);
    }

    #[test]
    fn drifting_and_swinging_modes_keep_their_number() {
        // One diverges, one drifts, one swings: s = ±2; 0, 0; ±3i.
        let k = [-4.0, 0.0, 9.0];
        let kk = DMatrix::from_fn(3, 3, |i, j| if i == j { k[i] } else { 0.0 });
        let mut found = gyroscopic_modes(&[1.0; 3], &DMatrix::zeros(3, 3), &kk).unwrap();
        found.sort_by(|a, b| a.omega.total_cmp(&b.omega).then(a.growth.total_cmp(&b.growth)));
        assert_modes(&found, &[(0.0, 0.0), (0.0, 2.0), (3.0, 0.0)], 1e-7);
        // M-normalised shape of the swinging one.
        let (re, im) = found[2].vector[2];
        assert!((re.hypot(im) - 1.0).abs() < 1e-12);
    }

    /// A wrong eigenvalue or a wrong vector must show in the residual.
    #[test]
    fn residual_sees_a_wrong_mode() {
        // q'' + 4 q = 0 in one coordinate: s = 2i.
        let companion = Mat::from_fn(2, 2, |i, j| [[0.0, 1.0], [-4.0, 0.0]][i][j]);
        assert!(residual(&companion, (0.0, 2.0), &[(1.0, 0.0)]) < 1e-15);
        assert!(residual(&companion, (0.0, 2.001), &[(1.0, 0.0)]) > 1e-4);
    }

    /// A mass on an isotropic spring seen from a frame turning at Ω: frequencies |ω₀ ± Ω|.
    #[test]
    fn isotropic_oscillator_in_a_turning_frame() {
        let (m, k, speed) = (2.0, 8e6, 300.0);
        let g = DMatrix::from_fn(2, 2, |i, j| match (i, j) {
            (0, 1) => -2.0 * m * speed,
            (1, 0) => 2.0 * m * speed,
            _ => 0.0,
        });
        let stiffness = k - m * speed * speed;
        let kk = DMatrix::from_fn(2, 2, |i, j| if i == j { stiffness } else { 0.0 });
        let modes = gyroscopic_modes(&[m, m], &g, &kk).unwrap();
        let natural = (k / m).sqrt();
        assert!((modes[0].omega - (natural - speed)).abs() < 1e-10 * natural);
        assert!((modes[1].omega - (natural + speed)).abs() < 1e-10 * natural);
        assert!(modes.iter().all(|mode| mode.growth.abs() < 1e-9 * natural));
    }

    /// Two equal gyroscopes, mixed: a repeated complex pair whose vectors faer's real route gets wrong.
    #[test]
    fn repeated_gyroscopic_pairs_keep_sound_vectors() {
        let (spin, k) = (1.3, 2.0);
        let (s, c) = 0.7f64.sin_cos();
        // Coordinates 0, 1 are one gyroscope, 2, 3 the other; rows 0 and 2, 1 and 3 are turned.
        let turn = DMatrix::from_fn(4, 4, |i, j| match (i % 2 == j % 2, i / 2, j / 2) {
            (true, a, b) if a == b => c,
            (true, 0, _) => -s,
            (true, _, _) => s,
            _ => 0.0,
        });
        let pure = DMatrix::from_fn(4, 4, |i, j| match i / 2 == j / 2 {
            true => spin * (i as f64 - j as f64),
            false => 0.0,
        });
        let g = &turn * &pure * turn.transpose();
        let g = DMatrix::from_fn(4, 4, |i, j| 0.5 * (g[(i, j)] - g[(j, i)]));
        let kk = DMatrix::from_fn(4, 4, |i, j| if i == j { k } else { 0.0 });
        let modes = gyroscopic_modes(&[1.0; 4], &g, &kk).unwrap();
        let root = (0.25f64 * spin * spin + k).sqrt();
        for (mode, exact) in modes.iter().zip([
            root - 0.5 * spin,
            root - 0.5 * spin,
            root + 0.5 * spin,
            root + 0.5 * spin,
        ]) {
            assert!((mode.omega - exact).abs() < 1e-10);
        }
    }

    #[test]
    fn divergence_is_reported_not_dropped() {
        let g = DMatrix::zeros(1, 1);
        let k = DMatrix::from_fn(1, 1, |_, _| -4.0);
        let modes = gyroscopic_modes(&[1.0], &g, &k).unwrap();
        assert_eq!(modes.len(), 1);
        assert!(modes[0].omega == 0.0 && (modes[0].growth - 2.0).abs() < 1e-12);
    }
}
