//! The symmetric-definite eigenproblem K φ = λ M φ by LAPACK: a second route to the eigenvalues that the rest
//! of the project computes with nalgebra.

mod dsygv;

use nalgebra::{Cholesky, DMatrix};
use nalgebra_lapack::SymmetricEigen;

pub use dsygv::{EigenPairs, dsygv_pairs};

/// LAPACK driver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driver {
    /// `dsygv` on (K, M): Cholesky, reduction and QL iteration all LAPACK's.
    Dsygv,
    /// `dsyev`, through nalgebra-lapack, on L⁻¹KL⁻ᵀ with M = LLᵀ factored by nalgebra.
    Dsyev,
}

impl Driver {
    /// All drivers.
    pub const ALL: [Self; 2] = [Self::Dsygv, Self::Dsyev];
}

/// Why there are no eigenvalues.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LapackError {
    /// K and M are not square and equally large.
    #[error("K is {}×{} and M is {}×{}: both must be square and equally large", .k.0, .k.1, .m.0, .m.1)]
    Shape {
        /// Rows and columns of K.
        k: (usize, usize),
        /// Rows and columns of M.
        m: (usize, usize),
    },
    /// An entry is infinite or not a number.
    #[error("K or M holds an entry that is not finite")]
    NotFinite,
    /// M has no Cholesky factor.
    #[error("M is not positive definite")]
    MassNotPositive,
    /// The driver did not converge, or refused its arguments.
    #[error("the LAPACK driver failed with info = {0}")]
    Failed(i32),
}

/// Eigenvalues λ = ω² of K φ = λ M φ, ascending. K symmetric, M symmetric positive definite; only
/// their lower triangles are read.
///
/// # Errors
/// [`LapackError`] if the matrices do not fit, are not finite, M is not positive definite or the
/// driver fails.
pub fn lapack_generalized(
    k: &DMatrix<f64>,
    m: &DMatrix<f64>,
    driver: Driver,
) -> Result<Vec<f64>, LapackError> {
    let mut values = match driver {
        Driver::Dsygv => dsygv::values(k, m)?,
        Driver::Dsyev => dsyev(k, m)?,
    };
    values.sort_by(f64::total_cmp);
    Ok(values)
}

/// Refuses matrices that are not square, not of one size, or not finite.
fn check(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Result<(), LapackError> {
    if !k.is_square() || k.shape() != m.shape() {
        return Err(LapackError::Shape { k: k.shape(), m: m.shape() });
    }
    if k.iter().chain(m.iter()).any(|x| !x.is_finite()) {
        return Err(LapackError::NotFinite);
    }
    Ok(())
}

fn dsyev(k: &DMatrix<f64>, m: &DMatrix<f64>) -> Result<Vec<f64>, LapackError> {
    check(k, m)?;
    if k.is_empty() {
        return Ok(Vec::new());
    }
    let l = Cholesky::new(m.clone()).ok_or(LapackError::MassNotPositive)?.unpack();
    let mut full = k.clone();
    full.fill_upper_triangle_with_lower_triangle();
    // A = L⁻¹ K L⁻ᵀ = L⁻¹ (L⁻¹ K)ᵀ, K symmetric
    let half = l.solve_lower_triangular(&full).ok_or(LapackError::MassNotPositive)?;
    let a = l.solve_lower_triangular(&half.transpose()).ok_or(LapackError::MassNotPositive)?;
    // With vectors: for values alone nalgebra-lapack 0.28 passes a `jobz` that LAPACK refuses.
    let eigen = SymmetricEigen::try_new(a).ok_or(LapackError::Failed(1))?;
    Ok(eigen.eigenvalues.iter().copied().collect())
}
