//! Natural frequencies, mode types and multiplicities.

use std::f64::consts::TAU;

use nalgebra::DMatrix;
use serde::Serialize;

use dynamics::{generalized_symmetric, group_equal, split};

use crate::error::LumpedError;
use crate::kinds::{Kinds, ModeType};
use crate::model::LumpedModel;

/// Shares of a mode's kinetic energy in the three kinds; they sum to one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Participation {
    /// Rotational kind.
    pub rotational: f64,
    /// Translational kind.
    pub translational: f64,
    /// Planet kind.
    pub planet: f64,
}

/// One distinct frequency of one type.
#[derive(Debug, Clone)]
pub struct ModeGroup {
    /// f = √λ / 2π, Hz.
    pub frequency_hz: f64,
    /// λ = ω², (rad/s)²; rigid-body modes may come out as ± rounding.
    pub lambda: f64,
    /// Kind.
    pub mode_type: ModeType,
    /// How often the frequency occurs with this type.
    pub multiplicity: usize,
    /// Shares in the kinds, averaged over the group.
    pub participation: Participation,
    /// M-orthonormal mode shapes, one a column (n×multiplicity).
    pub vectors: DMatrix<f64>,
}

/// All modes of a model, ascending.
#[derive(Debug, Clone)]
pub struct NaturalModes {
    /// Distinct frequencies; modes of different types that coincide are separate entries.
    pub groups: Vec<ModeGroup>,
    /// All eigenvalues with multiplicity, ascending.
    pub lambda: Vec<f64>,
    /// Largest relative residual ‖Kφ − λMφ‖ of the eigensolution.
    pub residual: f64,
}

impl NaturalModes {
    /// Solves and classifies a model.
    ///
    /// # Errors
    /// If the eigenproblem cannot be solved to a residual of 1e-10.
    pub fn of(model: &LumpedModel) -> Result<Self, LumpedError> {
        Self::with_stiffness(model, &model.stiffness())
    }

    /// The same for a stiffness matrix of one's own on the model's coordinates.
    ///
    /// # Errors
    /// As [`NaturalModes::of`].
    pub fn with_stiffness(model: &LumpedModel, k: &DMatrix<f64>) -> Result<Self, LumpedError> {
        let solution = generalized_symmetric(k, &model.mass)?;
        let n = model.mass.len();
        let root: Vec<f64> = model.mass.iter().map(|m| m.sqrt()).collect();
        let kinds = Kinds::of(model);
        let largest = solution.lambda.last().copied().unwrap_or(0.0);
        let mut groups = Vec::with_capacity(n);
        for range in group_equal(&solution.lambda) {
            let m = range.len();
            let first = range.start;
            let phi = |i: usize, j: usize| solution.vectors[(i, first + j)];
            let projections = kinds.projections(m, |i, j| root[i] * phi(i, j));
            let directions = split(m, &projections)?;
            let mean = solution.lambda[range].iter().sum::<f64>() / m as f64;
            // Rigid-body modes are zero up to rounding of the largest eigenvalue.
            let lambda = if mean.abs() < 1e-12 * largest { 0.0 } else { mean };
            let types =
                [ModeType::Rotational, ModeType::Translational, ModeType::Planet, ModeType::Mixed];
            for mode_type in types {
                let own: Vec<_> =
                    directions.iter().filter(|d| ModeType::of_kind(d.kind) == mode_type).collect();
                if own.is_empty() {
                    continue;
                }
                let share =
                    |k: usize| own.iter().map(|d| d.shares[k]).sum::<f64>() / own.len() as f64;
                let vectors = DMatrix::from_fn(n, own.len(), |i, j| {
                    (0..m).map(|c| phi(i, c) * own[j].coefficients[c]).sum::<f64>()
                });
                groups.push(ModeGroup {
                    frequency_hz: lambda.max(0.0).sqrt() / TAU,
                    lambda,
                    mode_type,
                    multiplicity: own.len(),
                    participation: Participation {
                        rotational: share(0),
                        translational: share(1),
                        planet: share(2),
                    },
                    vectors,
                });
            }
        }
        Ok(Self { groups, lambda: solution.lambda, residual: solution.residual })
    }

    /// The groups of one type, ascending.
    pub fn of_type(&self, mode_type: ModeType) -> impl Iterator<Item = &ModeGroup> {
        self.groups.iter().filter(move |g| g.mode_type == mode_type)
    }
}
