//! A linear vibrating system between rigid obstacles.

use nalgebra::{DMatrix, DVector};

use super::error::IntegratorError;
use super::state::StepState;

/// A rigid obstacle: d + bᵀ x ≥ 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle {
    /// b, n.
    pub row: Vec<f64>,
    /// d, the gap at x = 0, m.
    pub clearance: f64,
}

/// M ẍ + C ẋ + K x = f + Gᵀ λ with n coordinates and m obstacles, 0 ≤ λ ⟂ d + G x ≥ 0.
#[derive(Debug, Clone, PartialEq)]
pub struct VibratingSystem {
    pub(super) mass: DMatrix<f64>,
    pub(super) damping: DMatrix<f64>,
    pub(super) stiffness: DMatrix<f64>,
    pub(super) load: DVector<f64>,
    /// G, m×n.
    pub(super) rows: DMatrix<f64>,
    /// d, m.
    pub(super) clearance: DVector<f64>,
}

impl VibratingSystem {
    /// Symmetric M, C, K (n×n; kg, N s/m, N/m) and a constant load f (n, N). Coordinates without mass are allowed if
    /// they have stiffness.
    ///
    /// # Errors
    /// If sizes differ or an entry is not finite.
    pub fn new(
        mass: DMatrix<f64>,
        damping: DMatrix<f64>,
        stiffness: DMatrix<f64>,
        load: Vec<f64>,
    ) -> Result<Self, IntegratorError> {
        let wanted = load.len();
        for (what, matrix) in [("mass", &mass), ("damping", &damping), ("stiffness", &stiffness)] {
            for got in [matrix.nrows(), matrix.ncols()] {
                if got != wanted {
                    return Err(IntegratorError::Size { what, got, wanted });
                }
            }
            if matrix.iter().any(|x| !x.is_finite()) {
                return Err(IntegratorError::NotFinite { what });
            }
        }
        if load.iter().any(|x| !x.is_finite()) {
            return Err(IntegratorError::NotFinite { what: "load" });
        }
        Ok(Self {
            mass,
            damping,
            stiffness,
            load: DVector::from_vec(load),
            rows: DMatrix::zeros(0, wanted),
            clearance: DVector::zeros(0),
        })
    }

    /// One mass m with c and k: m ẍ + c ẋ + k x = 0.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn oscillator(mass: f64, damping: f64, stiffness: f64) -> Result<Self, IntegratorError> {
        let one = |x| DMatrix::from_element(1, 1, x);
        Self::new(one(mass), one(damping), one(stiffness), vec![0.0])
    }

    /// The same system between obstacles.
    ///
    /// # Errors
    /// If a row has another number of entries than there are coordinates, or an entry is not finite.
    pub fn between(mut self, obstacles: &[Obstacle]) -> Result<Self, IntegratorError> {
        let wanted = self.count();
        for o in obstacles {
            if o.row.len() != wanted {
                let (what, got) = ("the row of an obstacle", o.row.len());
                return Err(IntegratorError::Size { what, got, wanted });
            }
            if !o.clearance.is_finite() || o.row.iter().any(|b| !b.is_finite()) {
                return Err(IntegratorError::NotFinite { what: "an obstacle" });
            }
        }
        self.rows = DMatrix::from_fn(obstacles.len(), wanted, |i, j| obstacles[i].row[j]);
        self.clearance =
            DVector::from_iterator(obstacles.len(), obstacles.iter().map(|o| o.clearance));
        Ok(self)
    }

    /// Number of coordinates n.
    pub fn count(&self) -> usize {
        self.load.len()
    }

    /// Gaps d + G x of the obstacles, m.
    pub fn gaps(&self, x: &DVector<f64>) -> DVector<f64> {
        &self.clearance + &self.rows * x
    }

    /// ½ vᵀ M v + ½ xᵀ K x − fᵀ x, J.
    pub fn energy(&self, state: &StepState) -> f64 {
        let (x, v) = (&state.x, &state.v);
        0.5 * v.dot(&(&self.mass * v)) + 0.5 * x.dot(&(&self.stiffness * x)) - self.load.dot(x)
    }

    /// The state at time 0 with displacements `x` (n, m) and velocities `v` (n, m/s), without contact forces:
    /// M a = f − C v − K x; accelerations of coordinates without mass are 0.
    ///
    /// # Errors
    /// If sizes differ or the mass matrix of the other coordinates is not positive definite.
    pub fn start(&self, x: &[f64], v: &[f64]) -> Result<StepState, IntegratorError> {
        let wanted = self.count();
        for (what, list) in [("displacements", x), ("velocities", v)] {
            if list.len() != wanted {
                return Err(IntegratorError::Size { what, got: list.len(), wanted });
            }
        }
        let (x, v) = (DVector::from_column_slice(x), DVector::from_column_slice(v));
        let force = &self.load - &self.damping * &v - &self.stiffness * &x;
        let own: Vec<usize> = (0..wanted).filter(|&i| self.mass[(i, i)] > 0.0).collect();
        let mass = self.mass.select_rows(&own).select_columns(&own);
        let factor = mass.cholesky().ok_or(IntegratorError::Indefinite {
            scheme: "initial acceleration",
            matrix: "the mass matrix",
        })?;
        let solved = factor.solve(&force.select_rows(&own));
        let mut a = DVector::zeros(wanted);
        own.iter().zip(solved.iter()).for_each(|(&i, value)| a[i] = *value);
        Ok(StepState { time: 0.0, x, v, a, forces: vec![0.0; self.clearance.len()] })
    }
}
