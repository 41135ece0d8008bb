//! Natural frequencies, mode types and multiplicities.

use std::f64::consts::TAU;
use std::ops::Range;

use gearset::{Axis, Body};
use nalgebra::DMatrix;
use serde::{Serialize, Serializer};

use dynamics::{SpringRow, factored_modes, generalized_symmetric, group_equal, split};

use crate::coordinates::Coordinates;
use crate::error::LumpedError;
use crate::kinds::{Kinds, ModeType};
use crate::model::LumpedModel;
use crate::participation::Participation;
use crate::springs::Spring;

/// One distinct frequency of one type.
#[derive(Debug, Clone, Serialize)]
pub struct ModeGroup {
    /// f = √λ / 2π, Hz.
    pub frequency_hz: f64,
    /// What rounding may have changed of the frequency, as a part of it.
    pub uncertainty: f64,
    /// λ = ω², (rad/s)².
    pub lambda: f64,
    /// Kind.
    pub mode_type: ModeType,
    /// Number of modes of this type with this frequency.
    pub multiplicity: usize,
    /// Shares in the kinds, averaged over the group.
    pub participation: Participation,
    /// M-orthonormal mode shapes, one per column (n×multiplicity); as JSON a list of columns.
    #[serde(serialize_with = "columns")]
    pub vectors: DMatrix<f64>,
}

fn columns<S: Serializer>(matrix: &DMatrix<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.column_iter().map(|column| column.as_slice().to_vec()))
}

/// All modes of a model, ascending.
#[derive(Debug, Clone, Serialize)]
pub struct NaturalModes {
    /// Body and axis of each row of the mode shapes.
    pub coordinates: Coordinates,
    /// Distinct frequencies; modes of different types that coincide are separate entries.
    pub groups: Vec<ModeGroup>,
    /// All eigenvalues with multiplicity, ascending.
    pub lambda: Vec<f64>,
}

/// Parts by which the squares of two frequencies may differ that are one frequency of several modes.
const EQUAL: f64 = 1e-9;

/// Eigenvalues ascending with what they are worth, and M-orthonormal shapes.
struct Solution {
    lambda: Vec<f64>,
    uncertainty: Vec<f64>,
    vectors: DMatrix<f64>,
    /// Modes that share a frequency.
    equal: Vec<Range<usize>>,
}

impl NaturalModes {
    /// Solves and classifies a model, from its springs: each frequency keeps its own relative accuracy.
    ///
    /// # Errors
    /// If the eigenproblem cannot be solved.
    pub fn of(model: &LumpedModel) -> Result<Self, LumpedError> {
        let of = |spring| {
            let Spring { stiffness, rows, .. }: &Spring = spring;
            rows.iter().map(|row| SpringRow { stiffness: *stiffness, row })
        };
        let springs: Vec<SpringRow<'_>> = model.springs.iter().flat_map(of).collect();
        let found = factored_modes(&springs, &model.mass)?;
        // Neighbours that differ by no more than EQUAL, or by what rounding may have done to them.
        let splits = |i: &usize| {
            let (low, high) = (found.omega[i - 1], found.omega[*i]);
            let unsure = found.uncertainty[i - 1] + found.uncertainty[*i];
            high - low > (0.5 * EQUAL + unsure) * high
        };
        let ends = (1..found.omega.len()).filter(splits).chain([found.omega.len()]);
        let equal = ends
            .scan(0, |start, end| Some(std::mem::replace(start, end)..end))
            .filter(|range| !range.is_empty())
            .collect();
        let lambda = found.omega.iter().map(|omega| omega * omega).collect();
        let (uncertainty, vectors) = (found.uncertainty, found.vectors);
        Self::classified(model, Solution { lambda, uncertainty, vectors, equal })
    }

    /// The same for a stiffness matrix of one's own on the model's coordinates: eigenvalues are good to a part of
    /// the largest, and those below 1e-12 of it count as rigid-body motion.
    ///
    /// # Errors
    /// If the eigenproblem cannot be solved to a residual of 1e-10.
    pub fn with_stiffness(model: &LumpedModel, k: &DMatrix<f64>) -> Result<Self, LumpedError> {
        let mut found = generalized_symmetric(k, &model.mass)?;
        let equal = group_equal(&found.lambda);
        let largest = found.lambda.last().copied().unwrap_or(0.0);
        for range in &equal {
            let mean = found.lambda[range.clone()].iter().sum::<f64>() / range.len() as f64;
            if mean.abs() < 1e-12 * largest {
                found.lambda[range.clone()].fill(0.0);
            }
        }
        let part = found.lambda.len() as f64 * f64::EPSILON * largest;
        let uncertainty =
            found.lambda.iter().map(|l| if *l > 0.0 { part / l } else { 0.0 }).collect();
        let (lambda, vectors) = (found.lambda, found.vectors);
        Self::classified(model, Solution { lambda, uncertainty, vectors, equal })
    }

    fn classified(model: &LumpedModel, solution: Solution) -> Result<Self, LumpedError> {
        let n = model.mass.len();
        let root: Vec<f64> = model.mass.iter().map(|m| m.sqrt()).collect();
        let kinds = Kinds::of(model);
        let mut groups = Vec::with_capacity(n);
        for range in solution.equal {
            let m = range.len();
            let first = range.start;
            let phi = |i: usize, j: usize| solution.vectors[(i, first + j)];
            let projections = kinds.projections(m, |i, j| root[i] * phi(i, j));
            let directions = split(m, &projections)?;
            let lambda = solution.lambda[range.clone()].iter().sum::<f64>() / m as f64;
            // The mean stands for all of a group, which are equal to a part of EQUAL only.
            let spread = solution.lambda[range.clone()]
                .iter()
                .fold(0.0f64, |a, l| a.max((l - lambda).abs()));
            let apart = if lambda > 0.0 { 0.5 * spread / lambda } else { 0.0 };
            let uncertainty =
                solution.uncertainty[range].iter().fold(0.0f64, |a, u| a.max(*u)) + apart;
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
                    uncertainty,
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
        Ok(Self { coordinates: model.coordinates.clone(), groups, lambda: solution.lambda })
    }

    /// Displacement of a body along a coordinate in each mode of a group, M-normalised; `None` if it is held.
    pub fn displacement(&self, group: &ModeGroup, body: Body, axis: Axis) -> Option<Vec<f64>> {
        let row = self.coordinates.of(body, axis)?;
        Some(group.vectors.row(row).iter().copied().collect())
    }

    /// The groups of one type, ascending.
    pub fn of_type(&self, mode_type: ModeType) -> impl Iterator<Item = &ModeGroup> {
        self.groups.iter().filter(move |g| g.mode_type == mode_type)
    }
}
