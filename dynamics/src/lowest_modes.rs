//! The lowest modes of a large K φ = ω² M φ by a block Lanczos method.

use nalgebra::DVectorView;

use crate::error::EigenError;
use crate::symmetric::symmetric_eigen;

/// A pair of large matrices K and M, given by their action on vectors.
pub trait ModalOperator {
    /// Order n.
    fn size(&self) -> usize;
    /// Overwrites x (n) with K⁻¹ x.
    fn solve(&self, x: &mut [f64]);
    /// y = M x, both n.
    fn mass(&self, x: &[f64], y: &mut [f64]);
}

/// One mode.
#[derive(Debug, Clone, PartialEq)]
pub struct LowMode {
    /// λ = ω², (rad/s)².
    pub lambda: f64,
    /// M-normalised shape (n).
    pub shape: Vec<f64>,
}

/// Number of vectors in a block: bodies of cyclic symmetry have double modes, and bands of close tooth modes.
const BLOCK: usize = 4;

/// Accepted ‖K⁻¹Mφ − φ/λ‖_M · λ.
const RESIDUAL_LIMIT: f64 = 1e-9;

/// Neighbouring eigenvalues with a smaller relative difference form a group, which is returned whole.
const EQUAL: f64 = 1e-7;

/// The lowest `count` modes, or one or two more where the last belongs to a group of equal ones.
///
/// `[eq:block-lanczos]` Krylov subspaces V of K⁻¹M in the M-inner product, fully reorthogonalised: the eigenvalues of
/// T = VᵀM K⁻¹M V are 1/λ. The start vectors are fixed, so that results are reproducible to the bit.
/// Source: no publication cited.
/// Checked by: `dynamics/src/lowest_modes.rs::double_modes_of_a_ring_come_in_pairs`.
///
/// # Errors
/// If the subspace reaches half the order of the matrices without converging.
pub fn lowest_modes(
    operator: &dyn ModalOperator,
    count: usize,
) -> Result<Vec<LowMode>, EigenError> {
    let n = operator.size();
    if count == 0 || n == 0 {
        return Ok(Vec::new());
    }
    let wanted = (count + 2).min(n);
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut weighted: Vec<Vec<f64>> = Vec::new();
    // K⁻¹M of each basis vector.
    let mut images: Vec<Vec<f64>> = Vec::new();
    // T = VᵀM K⁻¹M V, columns down to the diagonal.
    let mut t: Vec<Vec<f64>> = Vec::new();
    let mut fresh: Vec<Vec<f64>> = (0..BLOCK.min(n)).map(|k| start_vector(n, k)).collect();
    let mut next_check = 2 * wanted + 4 * BLOCK;
    loop {
        for mut v in fresh.drain(..) {
            let mut w = vec![0.0; n];
            operator.mass(&v, &mut w);
            let length = dot(&v, &w).sqrt();
            // Twice is enough (Kahan).
            for _ in 0..2 {
                for (b, mb) in basis.iter().zip(&weighted) {
                    let along = dot(mb, &v);
                    axpy(-along, b, &mut v);
                }
            }
            operator.mass(&v, &mut w);
            let left = dot(&v, &w).max(0.0).sqrt();
            if left > 1e-10 * length && basis.len() < n {
                v.iter_mut().for_each(|x| *x /= left);
                w.iter_mut().for_each(|x| *x /= left);
                let mut image = w.clone();
                operator.solve(&mut image);
                basis.push(v);
                weighted.push(w);
                t.push(weighted.iter().map(|w| dot(w, &image)).collect());
                images.push(image);
            }
        }
        let m = basis.len();
        let first_new = m.saturating_sub(BLOCK);
        let exhausted = m >= n || m >= next_check.max(n / 2);
        if m >= next_check || exhausted {
            if let Some(modes) = ritz(operator, (&basis, &images), &t, wanted, count)? {
                return Ok(modes);
            }
            if exhausted {
                return Err(EigenError::NoConvergence { size: n });
            }
            next_check = m + m / 4 + BLOCK;
        }
        fresh = images[first_new..].to_vec();
    }
}

/// The wanted modes from the subspace, `None` if they have not converged yet.
fn ritz(
    operator: &dyn ModalOperator,
    (basis, images): (&[Vec<f64>], &[Vec<f64>]),
    t: &[Vec<f64>],
    wanted: usize,
    count: usize,
) -> Result<Option<Vec<LowMode>>, EigenError> {
    let (m, n) = (basis.len(), operator.size());
    let (theta, vectors) = symmetric_eigen(m, |i, j| t[i.max(j)][i.min(j)])?;
    let mut modes = Vec::with_capacity(wanted);
    for k in 0..wanted.min(m) {
        let column = m - 1 - k;
        let (mut shape, mut image) = (vec![0.0; n], vec![0.0; n]);
        for i in 0..m {
            axpy(vectors[(i, column)], &basis[i], &mut shape);
            axpy(vectors[(i, column)], &images[i], &mut image);
        }
        axpy(-theta[column], &shape, &mut image);
        let mut w = vec![0.0; n];
        operator.mass(&image, &mut w);
        let residual = dot(&image, &w).max(0.0).sqrt() / theta[column];
        let is_sound = residual < RESIDUAL_LIMIT;
        if !is_sound && k < count {
            return Ok(None);
        }
        modes.push(LowMode { lambda: 1.0 / theta[column], shape });
        if !is_sound {
            break;
        }
    }
    // Groups are kept whole.
    let mut kept = count.min(modes.len());
    while kept < modes.len() {
        let (a, b) = (modes[kept - 1].lambda, modes[kept].lambda);
        if (b - a) > EQUAL * b {
            break;
        }
        kept += 1;
    }
    modes.truncate(kept);
    Ok(Some(modes))
}

/// Pseudo-random numbers between −0.5 and 0.5, the same at every call (linear congruential generator).
fn start_vector(n: usize, k: usize) -> Vec<f64> {
    let mut state = 0x9E37_79B9_7F4A_7C15u64.wrapping_mul(k as u64 + 1);
    let mut next = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    (0..n).map(|_| next()).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Several sums side by side, which one after the other would wait for each addition.
    DVectorView::from_slice(a, a.len()).dot(&DVectorView::from_slice(b, b.len()))
}

fn axpy(factor: f64, x: &[f64], y: &mut [f64]) {
    y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x);
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// A ring of n equal masses and springs, each tied to ground: ω² = k₀ + 4 k sin²(π j/n), all but
    /// two of them twice.
    struct Ring {
        n: usize,
    }

    const TIE: f64 = 0.3;

    impl ModalOperator for Ring {
        fn size(&self) -> usize {
            self.n
        }

        fn solve(&self, x: &mut [f64]) {
            // Conjugate gradients to rounding.
            let n = self.n;
            let apply = |p: &[f64]| -> Vec<f64> {
                (0..n).map(|i| (2.0 + TIE) * p[i] - p[(i + 1) % n] - p[(i + n - 1) % n]).collect()
            };
            let mut solution = vec![0.0; n];
            let mut r = x.to_vec();
            let mut p = r.clone();
            let mut rr = dot(&r, &r);
            let start = rr;
            for _ in 0..4 * n {
                if rr <= 1e-32 * start {
                    break;
                }
                let q = apply(&p);
                let step = rr / dot(&p, &q);
                axpy(step, &p, &mut solution);
                axpy(-step, &q, &mut r);
                let new = dot(&r, &r);
                let ratio = new / rr;
                p.iter_mut().zip(&r).for_each(|(p, r)| *p = r + ratio * *p);
                rr = new;
            }
            x.copy_from_slice(&solution);
        }

        fn mass(&self, x: &[f64], y: &mut [f64]) {
            y.copy_from_slice(x);
        }
    }

    #[test]
    fn double_modes_of_a_ring_come_in_pairs() {
        let ring = Ring { n: 240 };
        for count in [1, 2, 5, 8] {
            let modes = lowest_modes(&ring, count).unwrap();
            // 1 + 2j modes: groups are whole.
            assert_eq!(
                modes.len(),
                if count == 1 { 1 } else { count + usize::from(count % 2 == 0) }
            );
            for (k, mode) in modes.iter().enumerate() {
                let j = k.div_ceil(2) as f64;
                let exact = TIE + 4.0 * (PI * j / 240.0).sin().powi(2);
                assert!((mode.lambda / exact - 1.0).abs() < 1e-9, "{k}: {}", mode.lambda);
                assert!((dot(&mode.shape, &mode.shape) - 1.0).abs() < 1e-9);
            }
        }
    }
}
