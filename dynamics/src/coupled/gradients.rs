//! Gradients of the modes' motion, carried over time steps.
//!
//! They are by far the dearest part of a steady state found by shooting. All that happens to one row of them in a
//! step is independent of the other rows, so that a few rows at a time pass through the whole step in registers.

use nalgebra::DMatrix;

use super::condensed::{Condensed, at_width};
use super::linear::Modes;
use super::newton;
use crate::newmark::AverageAcceleration;
use crate::wide::{Computation, wide};

/// Rows that pass through a step together.
const ROWS: usize = 4;

/// Gradients of displacements, velocities and accelerations of n modes with respect to 2n coordinates at the start:
/// by bundles of [`ROWS`] of these, then modes.
#[derive(Debug, Clone)]
pub(super) struct Gradients {
    modes: usize,
    own: Vec<[[f64; ROWS]; 3]>,
    /// Of one bundle by mode, in turn: A⁻¹ (a*' + C v*'), v*', a*'.
    within: Vec<[[f64; ROWS]; 3]>,
    /// Loads on the modes of one bundle.
    loads: Vec<[f64; ROWS]>,
    /// Answers of the modes to z', by mode, then coupling.
    by_reach: Vec<f64>,
}

/// A step over which gradients are carried.
pub(super) struct StepGradient<'s> {
    pub(super) modes: &'s Modes,
    pub(super) rule: &'s AverageAcceleration,
    /// The couplings that took part.
    pub(super) group: &'s Condensed,
    /// Their tangents at the end of the step, N/m.
    pub(super) tangents: &'s [f64],
}

/// Gradients that are carried over a step with W couplings.
struct Carrying<'g, 's, const W: usize>(&'g mut Gradients, &'g StepGradient<'s>);

impl<const W: usize> Computation for Carrying<'_, '_, W> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        self.0.carry_with::<W>(self.1);
    }
}

impl Gradients {
    /// Of displacements, velocities and accelerations, each 2n×n: rows by coordinate at the start, columns by mode.
    pub(super) fn new([x, v, a]: [&DMatrix<f64>; 3]) -> Self {
        let (rows, modes) = x.shape();
        let mut own = vec![[[0.0; ROWS]; 3]; rows.div_ceil(ROWS) * modes];
        for row in 0..rows {
            for j in 0..modes {
                let place = &mut own[row / ROWS * modes + j];
                for (place, all) in place.iter_mut().zip([x, v, a]) {
                    place[row % ROWS] = all[(row, j)];
                }
            }
        }
        let within = vec![[[0.0; ROWS]; 3]; modes];
        Self { modes, own, within, loads: Vec::new(), by_reach: Vec::new() }
    }

    /// Displacements, then velocities of the modes at the end by those at the start, 2n×2n.
    pub(super) fn end_by_start(&self) -> DMatrix<f64> {
        let n = self.modes;
        DMatrix::from_fn(2 * n, 2 * n, |i, row| self.own[row / ROWS * n + i % n][i / n][row % ROWS])
    }

    /// Carries them over a step.
    pub(super) fn carry(&mut self, step: &StepGradient<'_>) {
        at_width!(step.group.width, W => wide(Carrying::<W>(self, step)));
    }

    #[inline(always)]
    fn carry_with<const W: usize>(&mut self, step: &StepGradient<'_>) {
        let StepGradient { modes, rule, group, tangents } = step;
        let (inertia, rate) = (rule.inertia(), rule.damping());
        let n = self.modes;
        let (rows, _) = group.rows.as_chunks::<W>();
        let rows = &rows[..n];
        self.answer_to_reach::<W>(step);
        let (by_reach, _) = self.by_reach.as_chunks::<W>();
        let by_reach = &by_reach[..n];
        let presses = tangents.iter().any(|tangent| *tangent != 0.0);
        let lags = &group.lags[..W];
        let gains: [f64; W] = std::array::from_fn(|k| 1.0 + lags[k] * rate);
        let within = &mut self.within[..n];
        for bundle in self.own.chunks_exact_mut(n) {
            for ([q, v1, a1], [x, v, a]) in within.iter_mut().zip(bundle.iter()) {
                for row in 0..ROWS {
                    // a* = (4/h²) x + (4/h) ẋ + ẍ,  v* = (2/h) x + ẋ
                    a1[row] = inertia * x[row] + 2.0 * rate * v[row] + a[row];
                    v1[row] = rate * x[row] + v[row];
                    q[row] = a1[row];
                }
            }
            solve(modes, rate, within, &mut self.loads);
            if presses {
                let (mut z, mut rates) = ([[0.0; ROWS]; W], [[0.0; ROWS]; W]);
                for (along, [q, ..]) in rows.iter().zip(within.iter()) {
                    add::<W>(&mut z, along, q);
                }
                if group.has_lag {
                    for (along, [_, v1, _]) in rows.iter().zip(within.iter()) {
                        add::<W>(&mut rates, along, v1);
                    }
                }
                for k in 0..W {
                    for row in 0..ROWS {
                        // z' = g R x' − τ R v*', without coupling forces
                        z[k][row] = gains[k] * z[k][row] - lags[k] * rates[k][row];
                    }
                }
                for (answer, [q, ..]) in by_reach.iter().zip(within.iter_mut()) {
                    for (answer, z) in answer.iter().zip(&z) {
                        for row in 0..ROWS {
                            q[row] -= answer * z[row];
                        }
                    }
                }
            }
            for ([x, v, a], [q, v1, a1]) in bundle.iter_mut().zip(within.iter()) {
                for row in 0..ROWS {
                    x[row] = q[row];
                    v[row] = rate * q[row] - v1[row];
                    a[row] = inertia * q[row] - a1[row];
                }
            }
        }
    }

    /// A⁻¹ Rᵀ D (I + g Y D)⁻¹, by mode, then coupling.
    #[inline(always)]
    fn answer_to_reach<const W: usize>(&mut self, step: &StepGradient<'_>) {
        let StepGradient { modes, rule, group, tangents } = step;
        let (y, _) = group.receptance_by_row.as_chunks::<W>();
        let (lags, rate) = (&group.lags[..W], rule.damping());
        let mut d = [0.0; W];
        d.iter_mut().zip(*tangents).for_each(|(d, tangent)| *d = *tangent);
        // I + g Y D, by row.
        let mut g: [[f64; W]; W] = std::array::from_fn(|k| {
            let gain = 1.0 + lags[k] * rate;
            std::array::from_fn(|l| gain * y[k][l] * d[l] + if k == l { 1.0 } else { 0.0 })
        });
        newton::eliminate(&mut g);
        let (n, padded) = (modes.count, group.answers.len() / W);
        self.by_reach.clear();
        self.by_reach.resize(n * W, 0.0);
        let (out, _) = self.by_reach.as_chunks_mut::<W>();
        for ((answers, row), d) in group.answers.chunks_exact(padded).zip(&g).zip(&d) {
            for (out, answer) in out.iter_mut().zip(answers) {
                newton::add(out, row, answer * d);
            }
        }
    }
}

/// Replaces a*' by A⁻¹ (a*' + C v*') in all modes of a bundle. Where C is full, C = (h/2) (A − (4/h²) I − Λ) leaves one
/// product with a full matrix,
///
/// ```text
/// A⁻¹ (a* + C v*) = (h/2) v* + A⁻¹ (a* − (2/h) v* − (h/2) Λ v*)
/// ```
#[inline(always)]
fn solve(modes: &Modes, rate: f64, within: &mut [[[f64; ROWS]; 3]], loads: &mut Vec<[f64; ROWS]>) {
    match &modes.own_damping {
        Some(damping) => {
            let own = damping.iter().zip(&modes.own_inverse);
            for ([q, v1, _], (c, inverse)) in within.iter_mut().zip(own) {
                for row in 0..ROWS {
                    q[row] = inverse * (q[row] + c * v1[row]);
                }
            }
        }
        None => {
            loads.clear();
            loads.extend(within.iter().zip(&modes.lambda).map(|([q, v1, _], lambda)| {
                std::array::from_fn(|row| q[row] - (rate + lambda / rate) * v1[row])
            }));
            for ([q, v1, _], inverse) in
                within.iter_mut().zip(modes.inverse.chunks_exact(modes.count.max(1)))
            {
                let mut sum = [0.0; ROWS];
                for (load, inverse) in loads.iter().zip(inverse) {
                    for row in 0..ROWS {
                        sum[row] += inverse * load[row];
                    }
                }
                for row in 0..ROWS {
                    q[row] = v1[row] / rate + sum[row];
                }
            }
        }
    }
}

/// Adds the part of one mode to the deflections of all couplings.
#[inline(always)]
fn add<const W: usize>(z: &mut [[f64; ROWS]; W], along: &[f64; W], q: &[f64; ROWS]) {
    for (z, along) in z.iter_mut().zip(along) {
        for row in 0..ROWS {
            z[row] += along * q[row];
        }
    }
}
