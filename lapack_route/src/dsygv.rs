//! Safe interface to `dsygv`.

use nalgebra::DMatrix;

use crate::{LapackError, check};

/// λ ascending, and the mass-normalised eigenvectors as columns: ΦᵀMΦ = 1.
#[derive(Debug, Clone, PartialEq)]
pub struct EigenPairs {
    /// λ = ω².
    pub values: Vec<f64>,
    /// Φ.
    pub vectors: DMatrix<f64>,
}

/// Eigenvalues and eigenvectors of K φ = λ M φ by `dsygv`.
///
/// # Errors
/// As [`crate::lapack_generalized`].
pub fn dsygv_pairs(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Result<EigenPairs, LapackError> {
    let (values, vectors) = call(k, m, b'V')?;
    Ok(EigenPairs { values, vectors })
}

pub(crate) fn values(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Result<Vec<f64>, LapackError> {
    call(k, m, b'N').map(|(values, _)| values)
}

/// Runs the driver; returns the eigenvalues, and the eigenvectors as columns if `jobz` is `V`.
#[allow(unsafe_code)]
fn call(
    k: &DMatrix<f64>,
    m: &DMatrix<f64>,
    jobz: u8,
) -> Result<(Vec<f64>, DMatrix<f64>), LapackError> {
    check(k, m)?;
    let (mut a, mut b) = (k.clone(), m.clone());
    let mut w = vec![0.0; a.nrows()];
    if w.is_empty() {
        return Ok((w, a));
    }
    let n =
        i32::try_from(w.len()).map_err(|_| LapackError::Shape { k: k.shape(), m: m.shape() })?;
    let mut run = |work: &mut [f64], lwork: i32| {
        let mut info = 0;
        // SAFETY: a and b are n×n, column-major and contiguous (leading dimension n), w has n
        // entries; `work` has max(1, lwork) entries, and the query lwork = −1 writes one only.
        unsafe {
            lapack::dsygv(
                &[1], // K φ = λ M φ
                jobz,
                b'L',
                n,
                a.as_mut_slice(),
                n,
                b.as_mut_slice(),
                n,
                &mut w,
                work,
                lwork,
                &mut info,
            );
        }
        match info {
            0 => Ok(()),
            info if info > n => Err(LapackError::MassNotPositive),
            info => Err(LapackError::Failed(info)),
        }
    };
    let mut best = [0.0];
    run(&mut best, -1)?;
    let lwork = (best[0] as i32).max(3 * n - 1);
    run(&mut vec![0.0; lwork as usize], lwork)?;
    Ok((w, a))
}
