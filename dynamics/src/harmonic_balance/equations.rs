//! The balanced equations at one frequency, with their derivatives.

use faer::prelude::Solve;
use faer::{Mat, c64};
use nalgebra::{DMatrix, DVector};

use super::error::BalanceError;
use super::fourier::FourierSeries;
use super::problem::HarmonicBalance;
use crate::coupled::CouplingForce;

/// Condition number from which a dynamic stiffness counts as singular.
const SINGULAR: f64 = 1e14;

/// The equations of harmonic balance at one frequency with a fixed number of harmonics H.
///
/// `[eq:harmonic-balance]` x = Re Σ X_l exp(i l θ), l = 0 … H, θ = ω t:
/// ```text
/// Z_l = K − (lω)² M + i lω C,   Δ_l = R Z_l⁻¹ (f_l − Rᵀ P_l)   (l ≥ 1),   K X_0 + Rᵀ P_0 = f_0.
/// ```
/// Source: Cameron & Griffin, J. Appl. Mech. 56 (1989) 149–154; Krack & Gross, Harmonic Balance for Nonlinear
/// Vibration Problems, Springer (2019), ch. 2–3.
/// Checked by: `dynamics/tests/oscillators/harmonic_balance.rs::a_linear_oscillator_is_the_closed_form`,
/// `dynamics/tests/oscillators/harmonic_balance.rs::tangents_are_those_of_finite_differences`,
/// `lumped/tests/balanced.rs`, `experiments/tests/balanced_law.rs`.
///
/// Unknowns y, all in m: the means of the n coordinates, then by harmonic l = 1 … H and coupling m the
/// coefficients a, b of δ_m's a cos lθ + b sin lθ. Residuals: the balance of mean forces on the n coordinates (N),
/// then the deflections' equations in the order of the unknowns (m).
#[derive(Debug)]
pub struct BalanceEquations<'a, L> {
    problem: &'a HarmonicBalance<L>,
    frequency: f64,
    harmonics: usize,
    added_damping: f64,
    /// Z_l⁻¹, n×n, l = 1 … H.
    receptance: Vec<Mat<c64>>,
    /// f_l by harmonic 0 … H, then coordinate, N.
    force: Vec<Vec<c64>>,
    /// R Z_l⁻¹ Rᵀ, by harmonic from 1: m×m.
    coupled: Vec<DMatrix<c64>>,
    /// R Z_l⁻¹ f_l, by harmonic from 1, then coupling.
    free: Vec<Vec<c64>>,
}

/// Forces of the couplings along a cycle.
pub(super) struct Answers {
    /// Real coefficients of P_m, N.
    pub(super) forces: Vec<Vec<f64>>,
    /// ∂F/∂z of each coupling at the steps of the cycle, N/m.
    tangents: Vec<Vec<f64>>,
}

impl<'a, L: CouplingForce> BalanceEquations<'a, L> {
    pub(super) fn new(
        problem: &'a HarmonicBalance<L>,
        frequency: f64,
        harmonics: usize,
        added_damping: f64,
    ) -> Result<Self, BalanceError> {
        if !(frequency > 0.0 && frequency.is_finite()) {
            return Err(BalanceError::Value { what: "the frequency", value: frequency });
        }
        if harmonics > problem.most_harmonics() {
            return Err(BalanceError::Samples { harmonics, samples: problem.steps_per_cycle() });
        }
        let n = problem.count();
        let by_coordinate: Vec<Vec<c64>> =
            (0..n).map(|i| problem.force_lines(i, harmonics)).collect();
        let force = (0..=harmonics).map(|l| by_coordinate.iter().map(|f| f[l]).collect()).collect();
        let mut own = Self {
            problem,
            frequency,
            harmonics,
            added_damping,
            receptance: Vec::with_capacity(harmonics),
            force,
            coupled: Vec::with_capacity(harmonics),
            free: Vec::with_capacity(harmonics),
        };
        for l in 1..=harmonics {
            let inverse = own.inverse(l)?;
            // R Z⁻¹
            let rows: Vec<Vec<c64>> = problem
                .couplings
                .iter()
                .map(|c| {
                    let of = |j: usize| (0..n).map(|i| inverse[(i, j)] * c.row[i]).sum::<c64>();
                    (0..n).map(of).collect()
                })
                .collect();
            let count = rows.len();
            let along = |m: usize, k: usize| -> c64 {
                rows[m].iter().zip(&problem.couplings[k].row).map(|(g, r)| *g * *r).sum()
            };
            own.coupled.push(DMatrix::from_fn(count, count, along));
            let of = |row: &Vec<c64>| row.iter().zip(&own.force[l]).map(|(g, f)| *g * *f).sum();
            let free = rows.iter().map(of).collect();
            own.free.push(free);
            own.receptance.push(inverse);
        }
        Ok(own)
    }

    /// (K − (lω)² M + i lω C)⁻¹, with the added damping in C.
    fn inverse(&self, l: usize) -> Result<Mat<c64>, BalanceError> {
        let (linear, n) = (&self.problem.linear, self.problem.count());
        let omega = l as f64 * self.frequency;
        let stiffness = Mat::from_fn(n, n, |i, j| {
            let mass = if i == j { linear.mass[i] } else { 0.0 };
            let damping = linear.damping[(i, j)] + self.added_damping * mass;
            c64::new(linear.stiffness[(i, j)] - omega * omega * mass, omega * damping)
        });
        let inverse = stiffness.partial_piv_lu().solve(Mat::<c64>::identity(n, n));
        let mut each = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let is_finite = each.all(|at| inverse[at].norm().is_finite());
        let condition = stiffness.norm_max() * inverse.norm_max();
        let frequency = self.frequency;
        if is_finite && condition < SINGULAR {
            Ok(inverse)
        } else {
            Err(BalanceError::Singular { harmonic: l, frequency })
        }
    }

    /// Fundamental frequency, rad/s.
    pub fn frequency(&self) -> f64 {
        self.frequency
    }

    /// Number of harmonics H.
    pub fn harmonics(&self) -> usize {
        self.harmonics
    }

    /// Number of unknowns: n + 2 H · couplings.
    pub fn dimension(&self) -> usize {
        self.problem.count() + 2 * self.harmonics * self.problem.couplings()
    }

    /// Place of a of harmonic l ≥ 1 of a coupling; b follows.
    fn place(&self, l: usize, coupling: usize) -> usize {
        self.problem.count() + 2 * ((l - 1) * self.problem.couplings() + coupling)
    }

    /// Real coefficients of a coupling's deflection, m.
    pub(super) fn deflection(&self, y: &[f64], coupling: usize) -> Vec<f64> {
        let own = &self.problem.couplings[coupling];
        let mut out = Vec::with_capacity(2 * self.harmonics + 1);
        out.push(own.row.iter().zip(y).map(|(r, x)| r * x).sum::<f64>() - own.offset);
        for l in 1..=self.harmonics {
            let at = self.place(l, coupling);
            out.extend([y[at], y[at + 1]]);
        }
        out
    }

    /// Forces and tangents of all couplings along the cycle.
    pub(super) fn answers(&self, y: &[f64]) -> Answers {
        let mut out = Answers { forces: Vec::new(), tangents: Vec::new() };
        for (coupling, own) in self.problem.couplings.iter().enumerate() {
            let mut z = self.deflection(y, coupling);
            for l in 1..=self.harmonics {
                // z = δ + τ δ̇:  a + lωτ b,  b − lωτ a
                let turn = l as f64 * self.frequency * own.lag;
                let (a, b) = (z[2 * l - 1], z[2 * l]);
                (z[2 * l - 1], z[2 * l]) = (a + turn * b, b - turn * a);
            }
            let reach = self.problem.transform.samples(&z);
            let at = |(step, z): (usize, &f64)| self.problem.law.answer(coupling, step, *z);
            let (p, d): (Vec<f64>, Vec<f64>) = reach.iter().enumerate().map(at).unzip();
            out.forces.push(self.problem.transform.coefficients(&p, self.harmonics));
            out.tangents.push(d);
        }
        out
    }

    /// Residuals.
    pub(super) fn residual(&self, y: &[f64], answers: &Answers) -> DVector<f64> {
        let n = self.problem.count();
        let mut out = DVector::zeros(self.dimension());
        // K X_0 + Rᵀ P_0 − f_0
        for i in 0..n {
            let held: f64 = (0..n).map(|j| self.problem.linear.stiffness[(i, j)] * y[j]).sum();
            let pressed = self.problem.couplings.iter().zip(&answers.forces);
            out[i] =
                held + pressed.map(|(c, p)| c.row[i] * p[0]).sum::<f64>() - self.force[0][i].re;
        }
        for l in 1..=self.harmonics {
            for m in 0..self.problem.couplings() {
                // Δ_l − R Z⁻¹ f_l + Y P_l, with X = a − i b
                let given = |(k, p): (usize, &Vec<f64>)| {
                    self.coupled[l - 1][(m, k)] * c64::new(p[2 * l - 1], -p[2 * l])
                };
                let pressed: c64 = answers.forces.iter().enumerate().map(given).sum();
                let left = pressed - self.free[l - 1][m];
                let at = self.place(l, m);
                out[at] = y[at] + left.re;
                out[at + 1] = y[at + 1] - left.im;
            }
        }
        out
    }

    /// Derivative of the residuals by the unknowns.
    pub(super) fn jacobian(&self, answers: &Answers) -> DMatrix<f64> {
        let n = self.problem.count();
        let mut out = DMatrix::zeros(self.dimension(), self.dimension());
        out.view_mut((0, 0), (n, n)).copy_from(&self.problem.linear.stiffness);
        for i in n..self.dimension() {
            out[(i, i)] = 1.0;
        }
        for (k, own) in self.problem.couplings.iter().enumerate() {
            // ∂P/∂δ = T ∂z/∂δ
            let mut t = self.problem.transform.product(&answers.tangents[k], self.harmonics);
            for l in 1..=self.harmonics {
                let turn = l as f64 * self.frequency * own.lag;
                for i in 0..t.nrows() {
                    let (a, b) = (t[(i, 2 * l - 1)], t[(i, 2 * l)]);
                    (t[(i, 2 * l - 1)], t[(i, 2 * l)]) = (a - turn * b, b + turn * a);
                }
            }
            let mut add = |row: usize, part: &dyn Fn(usize) -> f64| {
                for (j, r) in own.row.iter().enumerate() {
                    out[(row, j)] += part(0) * r;
                }
                for l in 1..=self.harmonics {
                    let at = self.place(l, k);
                    out[(row, at)] += part(2 * l - 1);
                    out[(row, at + 1)] += part(2 * l);
                }
            };
            for (i, r) in own.row.iter().enumerate().filter(|(_, r)| **r != 0.0) {
                add(i, &|column| r * t[(0, column)]);
            }
            for l in 1..=self.harmonics {
                for m in 0..self.problem.couplings() {
                    // (Y_r + i Y_i)(a − i b)
                    let y = self.coupled[l - 1][(m, k)];
                    let pair = |column| (t[(2 * l - 1, column)], t[(2 * l, column)]);
                    let at = self.place(l, m);
                    add(at, &|column| y.re * pair(column).0 + y.im * pair(column).1);
                    add(at + 1, &|column| y.re * pair(column).1 - y.im * pair(column).0);
                }
            }
        }
        out
    }

    /// Residual and its derivative by the unknowns.
    ///
    /// # Errors
    /// If the number of unknowns is not [`BalanceEquations::dimension`].
    pub fn evaluate(&self, y: &[f64]) -> Result<(DVector<f64>, DMatrix<f64>), BalanceError> {
        self.fits(y)?;
        let answers = self.answers(y);
        Ok((self.residual(y, &answers), self.jacobian(&answers)))
    }

    /// X_l = Z_l⁻¹ (f_l − Rᵀ P_l) of the coordinates, l ≥ 1, m.
    fn amplitudes(&self, l: usize, answers: &Answers) -> Vec<c64> {
        let mut load = self.force[l].clone();
        for (own, p) in self.problem.couplings.iter().zip(&answers.forces) {
            let p = c64::new(p[2 * l - 1], -p[2 * l]);
            load.iter_mut().zip(&own.row).for_each(|(f, r)| *f -= p * *r);
        }
        times(&self.receptance[l - 1], &load)
    }

    /// Fourier series of the coordinates, of the deflections (m) and of the couplings' forces (N) at unknowns y.
    ///
    /// # Errors
    /// If the number of unknowns is not [`BalanceEquations::dimension`].
    pub fn series(&self, y: &[f64]) -> Result<[Vec<FourierSeries>; 3], BalanceError> {
        self.fits(y)?;
        let answers = self.answers(y);
        let mut coordinates: Vec<FourierSeries> =
            y[..self.problem.count()].iter().map(|x| FourierSeries::from_real(&[*x])).collect();
        for l in 1..=self.harmonics {
            let x = self.amplitudes(l, &answers);
            coordinates.iter_mut().zip(x).for_each(|(own, x)| own.lines.push(x));
        }
        let deflections = (0..self.problem.couplings())
            .map(|k| FourierSeries::from_real(&self.deflection(y, k)))
            .collect();
        let forces = answers.forces.iter().map(|p| FourierSeries::from_real(p)).collect();
        Ok([coordinates, deflections, forces])
    }

    pub(super) fn fits(&self, y: &[f64]) -> Result<(), BalanceError> {
        let (what, got, wanted) = ("the list of unknowns", y.len(), self.dimension());
        if got == wanted { Ok(()) } else { Err(BalanceError::Size { what, got, wanted }) }
    }

    /// Largest absolute coefficient of the deflections, means included; without couplings, of the coordinates'
    /// means, m.
    pub(super) fn size(&self, y: &[f64]) -> f64 {
        let largest = |list: &[f64]| list.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let each = (0..self.problem.couplings()).map(|k| largest(&self.deflection(y, k)));
        each.reduce(f64::max).unwrap_or_else(|| largest(y))
    }

    /// Number of coordinates, whose means come first among the unknowns.
    pub(super) fn means(&self) -> usize {
        self.problem.count()
    }

    /// Largest mean force on a coordinate from outside, N.
    pub(super) fn mean_force(&self) -> f64 {
        self.force[0].iter().map(|f| f.re.abs()).fold(0.0, f64::max)
    }
}

fn times(matrix: &Mat<c64>, x: &[c64]) -> Vec<c64> {
    (0..matrix.nrows())
        .map(|i| x.iter().enumerate().map(|(j, x)| matrix[(i, j)] * *x).sum())
        .collect()
}
