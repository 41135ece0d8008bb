//! Scaled variables of a family: its tangents and corrections.

use faer::Mat;
use faer::prelude::Solve;
use nalgebra::DMatrix;

use super::error::ContinuationError;
use super::family::{Evaluation, Family};
use super::options::Scales;

/// A family in scaled variables u = (y/s, λ/s_λ).
pub(super) struct Space<'a, F> {
    pub(super) family: &'a mut F,
    scales: &'a Scales,
}

/// A corrected point, its tangent and the iterations spent until corrections were rounding.
#[derive(Clone)]
pub(super) struct Corrected {
    pub(super) u: Vec<f64>,
    pub(super) tangent: Vec<f64>,
    /// Sign of det [∂F/∂u; tᵀ], as [`Space::orientation`]; 0 if it is not known.
    pub(super) orientation: f64,
    pub(super) iterations: usize,
}

impl Corrected {
    /// The same point with the tangent turned round.
    pub(super) fn turned_back(&self) -> Self {
        let tangent = self.tangent.iter().map(|t| -t).collect();
        Self { u: self.u.clone(), tangent, orientation: -self.orientation, ..*self }
    }
}

/// When Newton's method ends.
#[derive(Clone, Copy)]
pub(super) struct Stop {
    pub(super) correction: f64,
    pub(super) most_iterations: usize,
}

impl<'a, F: Family> Space<'a, F> {
    pub(super) fn new(
        family: &'a mut F,
        scales: &'a Scales,
    ) -> Result<Self, ContinuationError<F::Error>> {
        let wanted = family.dimension();
        let got = scales.unknowns.len();
        if got != wanted {
            return Err(ContinuationError::Size { what: "the list of scales", got, wanted });
        }
        let all = scales.unknowns.iter().chain([&scales.parameter]);
        if let Some(value) = all.copied().find(|s| !(*s > 0.0 && s.is_finite())) {
            let (what, allowed) = ("a scale", "it must be positive and finite");
            return Err(ContinuationError::Option { what, value, allowed });
        }
        Ok(Self { family, scales })
    }

    pub(super) fn scaled(&self, y: &[f64], lambda: f64) -> Vec<f64> {
        let own = y.iter().zip(&self.scales.unknowns).map(|(y, s)| y / s);
        own.chain([lambda / self.scales.parameter]).collect()
    }

    pub(super) fn plain(&self, u: &[f64]) -> (Vec<f64>, f64) {
        let n = self.scales.unknowns.len();
        let y = u[..n].iter().zip(&self.scales.unknowns).map(|(u, s)| u * s).collect();
        (y, self.lambda(u))
    }

    pub(super) fn lambda(&self, u: &[f64]) -> f64 {
        u[self.scales.unknowns.len()] * self.scales.parameter
    }

    pub(super) fn parameter_scale(&self) -> f64 {
        self.scales.parameter
    }

    fn evaluate(&mut self, u: &[f64]) -> Result<Evaluation, ContinuationError<F::Error>> {
        let (y, lambda) = self.plain(u);
        let found = self.family.evaluate(&y, lambda);
        let found = found.map_err(|cause| ContinuationError::Family { lambda, cause })?;
        let wanted = y.len();
        for (what, got) in [
            ("the residual", found.residual.len()),
            ("the Jacobian", found.jacobian.nrows()),
            ("the Jacobian", found.jacobian.ncols()),
            ("the derivative by the parameter", found.derivative.len()),
        ] {
            if got != wanted {
                return Err(ContinuationError::Size { what, got, wanted });
            }
        }
        Ok(found)
    }

    /// Sign of det [∂F/∂u; tᵀ] at u, 0 if it cannot be told.
    ///
    /// `[eq:branch-orientation]` Along a branch of piecewise smooth equations the sign of det [∂F/∂u; tᵀ] stays the
    /// same, through folds and wherever the branch crosses a kink at which only one of the smooth pieces changes; at
    /// a simple branch point it changes.
    /// Source: Eaves & Scarf, Math. Oper. Res. 1 (1976) 1–27.
    /// Checked by: `dynamics/tests/continuation.rs::a_branch_goes_on_beyond_a_kink_at_which_it_turns_back`.
    pub(super) fn orientation(
        &mut self,
        u: &[f64],
        t: &[f64],
    ) -> Result<f64, ContinuationError<F::Error>> {
        let found = self.evaluate(u)?;
        Ok(sign(&self.bordered_matrix(&found, t).0))
    }

    /// [∂F/∂u; borderᵀ] with rows of F scaled to a largest entry of one, and these scales.
    fn bordered_matrix(&self, found: &Evaluation, border: &[f64]) -> (Mat<f64>, Vec<f64>) {
        let n = self.scales.unknowns.len();
        let entry = |i: usize, j: usize| match j < n {
            true => found.jacobian[(i, j)] * self.scales.unknowns[j],
            false => found.derivative[i] * self.scales.parameter,
        };
        let row = |i: usize| (0..=n).map(|j| entry(i, j).abs()).fold(0.0, f64::max);
        let rows: Vec<f64> =
            (0..n).map(row).map(|r| if r > 0.0 { r.recip() } else { 1.0 }).collect();
        let matrix = Mat::from_fn(n + 1, n + 1, |i, j| match i < n {
            true => rows[i] * entry(i, j),
            false => border[j],
        });
        (matrix, rows)
    }

    /// Solves [∂F/∂u; borderᵀ] x = right for both right sides; rows of F are scaled to a largest entry of one.
    fn bordered(
        &self,
        found: &Evaluation,
        border: &[f64],
        right: [&dyn Fn(usize) -> f64; 2],
    ) -> [Vec<f64>; 2] {
        let n = self.scales.unknowns.len();
        let (matrix, rows) = self.bordered_matrix(found, border);
        let sides = Mat::from_fn(n + 1, 2, |i, k| right[k](i) * if i < n { rows[i] } else { 1.0 });
        let solved = matrix.partial_piv_lu().solve(sides);
        [0, 1].map(|k| (0..=n).map(|i| solved[(i, k)]).collect())
    }

    /// Gives a point the unit tangent with a positive component along `border`.
    pub(super) fn orient(
        &mut self,
        at: &mut Corrected,
        border: &[f64],
    ) -> Result<(), ContinuationError<F::Error>> {
        let found = self.evaluate(&at.u)?;
        let n = border.len() - 1;
        let unit = |i: usize| if i == n { 1.0 } else { 0.0 };
        let [t, _] = self.bordered(&found, border, [&unit, &unit]);
        at.tangent = self.unit(&at.u, t)?;
        at.orientation = sign(&self.bordered_matrix(&found, border).0);
        Ok(())
    }

    /// Unit tangent at u in either sense, from that of some borders to which it is the least inclined.
    pub(super) fn any_tangent(
        &mut self,
        u: &[f64],
        border: &[f64],
    ) -> Result<Vec<f64>, ContinuationError<F::Error>> {
        let found = self.evaluate(u)?;
        let n = border.len() - 1;
        let unit = |i: usize| if i == n { 1.0 } else { 0.0 };
        let even = vec![((n + 1) as f64).sqrt().recip(); n + 1];
        // For a border of unit length at the angle φ to the tangent the solution has the length 1/cos φ.
        let all = [border.to_vec(), self.fixed_parameter(), even].map(|border| {
            let [t, _] = self.bordered(&found, &border, [&unit, &unit]);
            (norm(&t), t)
        });
        let finite = all.into_iter().filter(|(length, _)| length.is_finite());
        let shortest = finite.min_by(|a, b| a.0.total_cmp(&b.0));
        self.unit(u, shortest.map(|(_, t)| t).unwrap_or_default())
    }

    fn unit(&self, u: &[f64], t: Vec<f64>) -> Result<Vec<f64>, ContinuationError<F::Error>> {
        let length = norm(&t);
        if length > 0.0 && length.is_finite() {
            Ok(t.iter().map(|t| t / length).collect())
        } else {
            Err(ContinuationError::NoTangent { lambda: self.lambda(u) })
        }
    }

    /// Newton's method from u in the hyperplane across `border`; the tangent is that of the last matrix but one
    /// correction, which at the tolerance of the correction is that of the solution.
    ///
    /// `[eq:pseudo-arclength]` From the prediction u₀ = u + h t:
    /// ```text
    /// F(u) = 0,   tᵀ(u − u₀) = 0;   next tangent: [∂F/∂u; tᵀ] t' = (0, 1).
    /// ```
    /// Source: Keller, in: Applications of Bifurcation Theory (1977), 359–384.
    /// Checked by: `dynamics/tests/continuation.rs::a_circle_closes_and_has_two_folds`,
    /// `dynamics/tests/oscillators/branches.rs::both_folds_of_duffing_s_first_harmonic_are_the_closed_form`.
    pub(super) fn correct(
        &mut self,
        start: &[f64],
        border: &[f64],
        stop: Stop,
    ) -> Result<Corrected, ContinuationError<F::Error>> {
        let n = border.len() - 1;
        let mut u = start.to_vec();
        let mut last = f64::NAN;
        // Iterations after which corrections no longer shrank.
        let mut to_rounding: Option<usize> = None;
        for iterations in 1..=stop.most_iterations {
            let found = self.evaluate(&u)?;
            // Both F and the distance from the hyperplane, which stays zero.
            let residual = |i: usize| if i < n { -found.residual[i] } else { 0.0 };
            let unit = |i: usize| if i == n { 1.0 } else { 0.0 };
            let [change, t] = self.bordered(&found, border, [&residual, &unit]);
            let length = norm(&change);
            if !length.is_finite() {
                break;
            }
            u.iter_mut().zip(&change).for_each(|(u, d)| *u += d);
            let before = last;
            last = change.iter().map(|d| d.abs()).fold(0.0, f64::max);
            // Corrections that stay as small as this are rounding of F; they may still come below the tolerance.
            let is_small = last <= ROUNDING * stop.correction;
            if is_small && last > 0.5 * before {
                to_rounding.get_or_insert(iterations);
            }
            let is_last = iterations == stop.most_iterations;
            if last <= stop.correction || (is_last && is_small && to_rounding.is_some()) {
                let tangent = self.unit(&u, t)?;
                // The tangent has a positive component along the border, hence the same sign with either.
                let orientation = sign(&self.bordered_matrix(&found, border).0);
                let iterations = to_rounding.unwrap_or(iterations);
                return Ok(Corrected { u, tangent, orientation, iterations });
            }
        }
        let (lambda, iterations) = (self.lambda(&u), stop.most_iterations);
        Err(ContinuationError::NotConverged { lambda, iterations, correction: last })
    }

    /// The border that keeps λ where it is.
    pub(super) fn fixed_parameter(&self) -> Vec<f64> {
        let n = self.scales.unknowns.len();
        (0..=n).map(|i| if i == n { 1.0 } else { 0.0 }).collect()
    }
}

/// Corrections up to this many times the tolerance may be rounding: over very many time steps that of a period comes to
/// more than the tolerance.
const ROUNDING: f64 = 30.0;

/// Sign of the determinant, 0 if it cannot be told. The determinant itself may be too small for a number.
fn sign(matrix: &Mat<f64>) -> f64 {
    let lu = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| matrix[(i, j)]).lu();
    let one = |d: &f64| if *d == 0.0 || d.is_nan() { 0.0 } else { d.signum() };
    lu.u().diagonal().iter().map(one).product::<f64>() * lu.p().determinant::<f64>()
}

pub(super) fn norm(x: &[f64]) -> f64 {
    dot(x, x).sqrt()
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
