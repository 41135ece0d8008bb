//! Modes of a body with its race held.

use dynamics::{ModalOperator, lowest_modes};

use crate::body::{BodyMatrices, Factor};
use crate::error::FeError;

/// A mode with the race held.
#[derive(Debug, Clone)]
pub struct FixedRaceMode {
    /// ω², (rad/s)².
    pub lambda: f64,
    /// φᵀ M_fr on the race's x, y, u, kg^½.
    pub participation: [f64; 3],
    /// M-normalised shape, n, kg^-½.
    pub shape: Vec<f64>,
}

/// The lowest modes of a body with its race held; modes of equal frequency are kept together.
/// `radius` is r in u = rθ (m).
///
/// # Errors
/// If the stiffness is not definite or the modes do not converge.
pub fn fixed_race_modes(
    matrices: &BodyMatrices,
    count: usize,
    radius: f64,
    body: &'static str,
) -> Result<Vec<FixedRaceMode>, FeError> {
    if count == 0 {
        return Ok(Vec::new());
    }
    let operator = Operator { factor: matrices.stiffness.factorise(body)?, matrices };
    let modes = lowest_modes(&operator, count).map_err(|cause| FeError::Modes { body, cause })?;
    let with_participation = |mode: dynamics::LowMode| {
        let along = |k: usize| {
            matrices.coupling[k].iter().zip(&mode.shape).map(|(m, p)| m * p).sum::<f64>()
        };
        let participation = [along(0), along(1), along(2) / radius];
        FixedRaceMode { lambda: mode.lambda, participation, shape: mode.shape }
    };
    Ok(modes.into_iter().map(with_participation).collect())
}

struct Operator<'m> {
    factor: Factor,
    matrices: &'m BodyMatrices,
}

impl ModalOperator for Operator<'_> {
    fn size(&self) -> usize {
        self.matrices.size
    }

    fn solve(&self, x: &mut [f64]) {
        self.factor.solve_one(x);
    }

    fn mass(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        self.matrices.mass.multiply_add(1.0, x, y);
    }
}
