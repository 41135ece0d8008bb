//! The linear part in the modes of its stiffness and mass.

use faer::Mat;
use faer::prelude::Solve;
use nalgebra::DMatrix;

use super::error::CoupledError;
use crate::matrix::to_faer;
use crate::newmark::AverageAcceleration;
use crate::symmetric::generalized_symmetric;

/// M ẍ + C ẋ + K x with diagonal M, symmetric K and arbitrary C.
#[derive(Debug, Clone)]
pub struct LinearPart {
    /// Diagonal of M, kg.
    pub mass: Vec<f64>,
    /// C, n×n, N s/m.
    pub damping: DMatrix<f64>,
    /// K, n×n, N/m.
    pub stiffness: DMatrix<f64>,
}

/// Off-diagonal modal damping below this part of the largest entry is rounding.
const PROPORTIONAL: f64 = 1e-11;

/// Vectors are padded to multiples of this length.
pub(super) const LANES: usize = 4;

/// The linear part in modal coordinates q, x = Φ q, ΦᵀMΦ = I, padded with zeros to a multiple of [`LANES`].
#[derive(Debug, Clone)]
pub(super) struct Modes {
    /// n.
    pub(super) count: usize,
    /// Φ, n×n.
    pub(super) shapes: Mat<f64>,
    /// ω², (rad/s)².
    pub(super) lambda: Vec<f64>,
    /// M.
    pub(super) mass: Vec<f64>,
    /// ΦᵀCΦ, n×n.
    pub(super) damping: Mat<f64>,
    /// Its diagonal, padded, if C is proportional.
    pub(super) own_damping: Option<Vec<f64>>,
    /// A⁻¹ = ((4/h²) I + (2/h) ΦᵀCΦ + Λ)⁻¹, n×n, by rows.
    pub(super) inverse: Vec<f64>,
    /// Its diagonal, padded.
    pub(super) own_inverse: Vec<f64>,
}

/// n numbers, padded with zeros to a multiple of [`LANES`].
fn padded(n: usize, of: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..n.next_multiple_of(LANES)).map(|i| if i < n { of(i) } else { 0.0 }).collect()
}

impl Modes {
    pub(super) fn new(
        linear: &LinearPart,
        rule: &AverageAcceleration,
    ) -> Result<Self, CoupledError> {
        let n = linear.mass.len();
        let modes = generalized_symmetric(&linear.stiffness, &linear.mass)?;
        let c = &linear.damping;
        for got in [c.nrows(), c.ncols()] {
            if got != n {
                return Err(CoupledError::Size { what: "the damping", got, wanted: n });
            }
        }
        let shapes = to_faer(&modes.vectors);
        let damping = shapes.transpose() * to_faer(c) * &shapes;
        let (mut largest, mut across) = (0.0f64, 0.0f64);
        for j in 0..n {
            for i in 0..n {
                let entry = damping[(i, j)].abs();
                largest = largest.max(entry);
                across = if i == j { across } else { across.max(entry) };
            }
        }
        let is_proportional = across <= PROPORTIONAL * largest;
        let own_damping = is_proportional.then(|| padded(n, |i| damping[(i, i)]));
        let mass = linear.mass.clone();
        let (inverse, own_inverse) = (Vec::new(), Vec::new());
        let (count, lambda) = (n, modes.lambda);
        Self { count, shapes, lambda, mass, damping, own_damping, inverse, own_inverse }.at(rule)
    }

    /// The same modes at other time steps.
    pub(super) fn at(self, rule: &AverageAcceleration) -> Result<Self, CoupledError> {
        let n = self.count;
        let mut a = match self.own_damping {
            Some(_) => Mat::zeros(n, n),
            None => &self.damping * rule.damping(),
        };
        for i in 0..n {
            let own = self.own_damping.as_ref().map_or(0.0, |damping| rule.damping() * damping[i]);
            a[(i, i)] += own + rule.inertia() + self.lambda[i];
        }
        let inverse = a.partial_piv_lu().solve(Mat::<f64>::identity(n, n));
        let is_finite = (0..n).all(|j| (0..n).all(|i| inverse[(i, j)].is_finite()));
        if !is_finite {
            return Err(CoupledError::Singular);
        }
        let own_inverse = padded(n, |i| inverse[(i, i)]);
        let inverse = (0..n * n).map(|k| inverse[(k / n, k % n)]).collect();
        Ok(Self { inverse, own_inverse, ..self })
    }

    /// Φᵀ f, padded.
    pub(super) fn project(&self, force: &[f64], out: &mut [f64]) {
        for (j, out) in out.iter_mut().enumerate().take(self.count) {
            *out = force.iter().enumerate().map(|(i, f)| self.shapes[(i, j)] * f).sum();
        }
    }

    /// Coordinate i of Φ q.
    pub(super) fn coordinate(&self, i: usize, modal: &[f64]) -> f64 {
        (0..self.count).map(|j| self.shapes[(i, j)] * modal[j]).sum()
    }

    /// Modal coordinates Φᵀ M x.
    pub(super) fn modal(&self, x: &[f64], out: &mut [f64]) {
        for (j, out) in out.iter_mut().enumerate().take(self.count) {
            let of = |i: usize| self.shapes[(i, j)] * self.mass[i] * x[i];
            *out = (0..self.count).map(of).sum();
        }
    }

    /// A⁻¹ g with the full ΦᵀCΦ.
    pub(super) fn solve_full(&self, g: &[f64], out: &mut [f64]) {
        for (row, out) in self.inverse.chunks_exact(self.count.max(1)).zip(out) {
            *out = row.iter().zip(g).map(|(a, g)| a * g).sum();
        }
    }

    /// Adds ΦᵀCΦ v.
    pub(super) fn add_damping(&self, v: &[f64], out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate().take(self.count) {
            *out += (0..self.count).map(|j| self.damping[(i, j)] * v[j]).sum::<f64>();
        }
    }
}
