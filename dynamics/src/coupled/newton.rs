//! Newton's method for δ = b − Y P(δ), with the number of couplings (width W) fixed at compile time.

use super::condensed::Condensed;
use super::coupling::CouplingForce;

/// Iterations after which a step fails.
const MOST_ITERATIONS: usize = 60;

/// Residual over the largest free deflection below which one linear correction ends the iteration.
const NEARLY: f64 = 1e-11;

/// A Jacobian is kept while each iteration reduces the residual to less than this share.
const KEPT: f64 = 0.02;

/// Iteration from which corrections are halved, since the set of touching couplings may alternate.
const ALTERNATING: usize = 14;

/// Data of one time step for the solver.
pub(super) struct Start<'a> {
    pub(super) step_in_cycle: usize,
    /// Least deflection to which residuals are related, m: below it they are rounding.
    pub(super) nothing: f64,
    /// 2/h, 1/s.
    pub(super) rate: f64,
    /// Modal displacements without coupling forces, and v* of the modes.
    pub(super) free: &'a [f64],
    pub(super) velocity_history: &'a [f64],
}

/// A step that did not converge: iterations, coupling, residual (m).
pub(super) type Left = (usize, usize, f64);

/// Solves for the coupling forces from the estimate in `forces`, which receives the solution; returns the
/// number of iterations.
///
/// `[eq:coupled-step]` δ = b − Y P(δ), b_m = r_mᵀ A⁻¹ (history) − o_m, Y = R A⁻¹ Rᵀ, A = (4/h²) M + (2/h) C + K.
/// Source: derived here.
/// Checked by: `dynamics/tests/coupled.rs::a_coupling_of_constant_stiffness_is_a_spring`,
/// `dynamics/tests/coupled.rs::unsymmetric_damping_is_solved_in_full`.
#[inline]
pub(super) fn solve<const W: usize, L: CouplingForce>(
    group: &Condensed,
    law: &L,
    start: &Start<'_>,
    forces: &mut [f64],
) -> Result<usize, Left> {
    let (rows, _) = group.rows.as_chunks::<W>();
    let (y, _) = group.receptance.as_chunks::<W>();
    let (y, own): (&[[f64; W]; W], &mut [f64; W]) =
        match (y.first_chunk::<W>(), forces.first_chunk_mut::<W>()) {
            (Some(y), Some(own)) => (y, own),
            _ => return Err((0, 0, f64::NAN)),
        };
    let mut b = [0.0; W];
    for (row, q) in rows.iter().zip(start.free) {
        add(&mut b, row, *q);
    }
    // z = δ + τ δ̇ = gain δ + shift,  δ̇ = (2/h)(δ + o) − r·v*
    let (mut gain, mut shift) = ([1.0; W], [0.0; W]);
    if group.has_lag {
        let mut w = [0.0; W];
        for (row, v) in rows.iter().zip(start.velocity_history) {
            add(&mut w, row, *v);
        }
        for k in 0..W {
            let lag = group.lags[k];
            gain[k] = 1.0 + lag * start.rate;
            shift[k] = lag * (start.rate * group.offsets[k] - w[k]);
        }
    }
    let mut scale = start.nothing;
    for (b, offset) in b.iter_mut().zip(&group.offsets) {
        *b -= offset;
        scale = b.abs().max(scale);
    }
    let mut delta = less(&b, y, own);
    let mut inverse = [[0.0; W]; W];
    let (mut last, mut is_fresh) = (f64::INFINITY, false);
    for iteration in 1..=MOST_ITERATIONS {
        let (mut p, mut d) = ([0.0; W], [0.0; W]);
        for k in 0..group.count {
            let (force, tangent) =
                law.answer(k, start.step_in_cycle, gain[k] * delta[k] + shift[k]);
            (p[k], d[k]) = (force, gain[k] * tangent);
        }
        // r = δ − (b − Y P)
        let wanted = less(&b, y, &p);
        let mut r = [0.0; W];
        let mut worst = 0.0f64;
        for k in 0..W {
            r[k] = delta[k] - wanted[k];
            worst = worst.max(r[k].abs());
        }
        // `f64::max` ignores NaN.
        if !r.iter().sum::<f64>().is_finite() {
            return Err((iteration, place_of_worst(&r), f64::NAN));
        }
        if worst == 0.0 {
            *own = p;
            return Ok(iteration);
        }
        // The Jacobian is kept while the residual falls fast enough.
        if !(is_fresh && worst < KEPT * last) {
            inverse = inverted(y, &d);
            is_fresh = true;
        }
        last = worst;
        let ends = worst <= NEARLY * scale;
        let part = if iteration < ALTERNATING || ends { -1.0 } else { -0.5 };
        let change = times(&inverse, &r, part);
        for k in 0..W {
            delta[k] += change[k];
        }
        if ends {
            // One linear correction, which makes no compressive force tensile.
            for k in 0..W {
                let least = if p[k] >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
                p[k] = (p[k] + d[k] * change[k]).max(least);
            }
            *own = p;
            return Ok(iteration);
        }
    }
    Err((MOST_ITERATIONS, 0, last))
}

fn place_of_worst(r: &[f64]) -> usize {
    r.iter().position(|r| !r.is_finite()).unwrap_or(0)
}

/// Adds a multiple of a row.
#[inline]
pub(super) fn add<const W: usize>(out: &mut [f64; W], row: &[f64; W], factor: f64) {
    for (out, x) in out.iter_mut().zip(row) {
        *out += x * factor;
    }
}

/// b − Y p, Y by column.
#[inline]
fn less<const W: usize>(b: &[f64; W], y: &[[f64; W]; W], p: &[f64; W]) -> [f64; W] {
    let mut out = *b;
    for (column, p) in y.iter().zip(p) {
        add(&mut out, column, -p);
    }
    out
}

/// part · N r, N by column.
#[inline]
fn times<const W: usize>(n: &[[f64; W]; W], r: &[f64; W], part: f64) -> [f64; W] {
    let mut out = [0.0; W];
    for (column, r) in n.iter().zip(r) {
        add(&mut out, column, part * r);
    }
    out
}

/// (I + Y D)⁻¹ by column: Gauss–Jordan without pivoting. Y is positive semidefinite up to the small
/// skew part of unsymmetric damping, D ≥ 0, so all leading minors are at least about 1.
#[inline(always)]
pub(super) fn inverted<const W: usize>(y: &[[f64; W]; W], d: &[f64; W]) -> [[f64; W]; W] {
    // Columns of I + Y D are the rows of its transpose, whose inverse is the transpose of the inverse.
    let mut g = [[0.0; W]; W];
    for j in 0..W {
        for k in 0..W {
            g[j][k] = d[j] * y[j][k];
        }
        g[j][j] += 1.0;
    }
    eliminate(&mut g);
    g
}

/// Replaces a matrix by its inverse, both by row: Gauss–Jordan without pivoting.
///
/// Rows are read and written as a whole, with factors of 1 and 0 in place of single entries: an entry stored by itself
/// just before its row is read stalls the processor.
#[inline(always)]
pub(super) fn eliminate<const W: usize>(g: &mut [[f64; W]; W]) {
    for k in 0..W {
        let one: [f64; W] = std::array::from_fn(|l| if l == k { 1.0 } else { 0.0 });
        let others: [f64; W] = std::array::from_fn(|l| if l == k { 0.0 } else { 1.0 });
        let pivot = 1.0 / g[k][k];
        for l in 0..W {
            g[k][l] = (g[k][l] * others[l] + one[l]) * pivot;
        }
        let row = g[k];
        for (i, other) in g.iter_mut().enumerate() {
            if i != k {
                let factor = other[k];
                for l in 0..W {
                    other[l] = other[l] * others[l] - factor * row[l];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_times_matrix_is_one() {
        let y: [[f64; 4]; 4] = std::array::from_fn(|i| {
            std::array::from_fn(|j| if i == j { 2.0 } else { 0.3 / (1.0 + (i + j) as f64) })
        });
        let d = [1.5, 0.0, 7.0, 0.2];
        let n = inverted(&y, &d);
        for j in 0..4 {
            // Column j of I + Y D.
            let column: [f64; 4] =
                std::array::from_fn(|i| f64::from(u8::from(i == j)) + y[j][i] * d[j]);
            let found = times(&n, &column, 1.0);
            for (i, x) in found.into_iter().enumerate() {
                assert!((x - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
    }
}
