//! Natural frequencies of given matrices.

use std::f64::consts::TAU;

use dynamics::generalized_symmetric;
use lumped::nalgebra::{Cholesky, DMatrix};

/// Eigenvalues below this part of the largest are rounding of the computation.
const NIL: f64 = 1e-9;

/// ω² of K v = ω² M v.
pub(in crate::results) struct Spectrum {
    /// Ascending, (rad/s)².
    pub(in crate::results) lambda: Vec<f64>,
    /// What the digits of M and K may have changed of ω², as a part of it and absolute.
    uncertainty: [f64; 2],
}

/// Why matrices have no spectrum.
pub(in crate::results) enum NoSpectrum {
    /// M is not positive definite.
    Mass,
    /// The eigenproblem was not solved.
    Eigen(dynamics::EigenError),
}

impl Spectrum {
    /// Of a symmetric M and K whose entries are good to a part `rounding` of each.
    ///
    /// K̃ = L⁻¹ K L⁻ᵀ with M = L Lᵀ; rounding of K by a part ρ changes no eigenvalue by more than ρ ‖K̃‖_F.
    pub(in crate::results) fn new(
        mass: &DMatrix<f64>,
        stiffness: &DMatrix<f64>,
        rounding: [f64; 2],
    ) -> Result<Self, NoSpectrum> {
        let factor = Cholesky::new(mass.clone()).ok_or(NoSpectrum::Mass)?.unpack();
        let half = factor.solve_lower_triangular(stiffness).ok_or(NoSpectrum::Mass)?;
        let scaled = factor.solve_lower_triangular(&half.transpose()).ok_or(NoSpectrum::Mass)?;
        let ones = vec![1.0; scaled.nrows()];
        let lambda = generalized_symmetric(&scaled, &ones).map_err(NoSpectrum::Eigen)?.lambda;
        let uncertainty = [rounding[0], rounding[1] * scaled.norm() + NIL * largest(&lambda)];
        Ok(Self { lambda, uncertainty })
    }

    /// Size of the eigenvalues that may be 0 as far as the digits say, (rad/s)².
    pub(in crate::results) fn nil(&self) -> f64 {
        2.0 * self.uncertainty[1]
    }

    /// Largest eigenvalue by size, (rad/s)².
    pub(in crate::results) fn largest(&self) -> f64 {
        largest(&self.lambda)
    }

    /// The frequency, Hz, that is nearest to a listed one, and whether both are one within the part `tolerance` of it
    /// and what the digits say; `half_unit` is what rounding may have changed of the listed one, Hz.
    pub(in crate::results) fn nearest(
        &self,
        listed_hz: f64,
        tolerance: f64,
        half_unit: f64,
    ) -> (f64, bool) {
        let hz = |lambda: f64| lambda.max(0.0).sqrt() / TAU;
        let distance = |lambda: &f64| (hz(*lambda) - listed_hz).abs();
        let near = self.lambda.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let lambda = near.copied().unwrap_or(f64::NAN);
        let unsure = self.uncertainty[0] * lambda.abs() + self.uncertainty[1];
        let slack = tolerance * listed_hz + half_unit;
        let is_one =
            listed_hz + slack >= hz(lambda - unsure) && listed_hz - slack <= hz(lambda + unsure);
        (hz(lambda), is_one)
    }
}

fn largest(lambda: &[f64]) -> f64 {
    lambda.iter().fold(0.0f64, |a, l| a.max(l.abs()))
}
