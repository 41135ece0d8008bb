//! Gradients of the modes' motion, carried over time steps.
//!
//! They are by far the dearest part of a steady state found by shooting. All that happens to one row of them in a
//! step is independent of the other rows, so that the rows that fit a vector pass through the whole step together.

use nalgebra::DMatrix;

use super::condensed::{Condensed, at_width};
use super::linear::Modes;
use super::newton;
use crate::newmark::AverageAcceleration;
use crate::wide::{Computation, Simd, wide};

/// Rows that are stored together: a multiple of the lanes of every vector in use.
const ROWS: usize = 4;

/// Rows of A⁻¹ whose products are formed at the same time.
const AT_ONCE: usize = 8;

/// Gradients of displacements, velocities and accelerations of n modes with respect to 2n coordinates at the start:
/// by bundles of [`ROWS`] of these, then modes, then displacement, velocity and acceleration.
#[derive(Debug, Clone)]
pub(super) struct Gradients {
    modes: usize,
    own: Vec<f64>,
    /// Of the rows of one vector by mode: A⁻¹ (a*' + C v*'), v*', a*', load.
    within: Vec<f64>,
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
    fn run<S: Simd>(self, simd: S) {
        self.0.carry_with::<S, W>(simd, self.1);
    }
}

impl Gradients {
    /// Of displacements, velocities and accelerations, each 2n×n: rows by coordinate at the start, columns by mode.
    pub(super) fn new([x, v, a]: [&DMatrix<f64>; 3]) -> Self {
        let (rows, modes) = x.shape();
        let mut own = vec![0.0; 3 * rows.next_multiple_of(ROWS) * modes];
        for row in 0..rows {
            for j in 0..modes {
                for (kind, all) in [x, v, a].into_iter().enumerate() {
                    own[place(modes, row, j, kind)] = all[(row, j)];
                }
            }
        }
        Self { modes, own, within: Vec::new(), by_reach: Vec::new() }
    }

    /// Displacements, then velocities of the modes at the end by those at the start, 2n×2n.
    pub(super) fn end_by_start(&self) -> DMatrix<f64> {
        let n = self.modes;
        DMatrix::from_fn(2 * n, 2 * n, |i, row| self.own[place(n, row, i % n, i / n)])
    }

    /// Carries them over a step.
    pub(super) fn carry(&mut self, step: &StepGradient<'_>) {
        at_width!(step.group.width, W => wide(Carrying::<W>(self, step)));
    }

    #[inline(always)]
    fn carry_with<S: Simd, const W: usize>(&mut self, simd: S, step: &StepGradient<'_>) {
        const { assert!(ROWS.is_multiple_of(S::F64_LANES)) };
        let n = self.modes;
        self.answer_to_reach::<W>(step);
        self.within.resize(4 * n * S::F64_LANES, 0.0);
        let Self { own, within, by_reach, .. } = self;
        let (within, _) = S::as_mut_simd_f64s(within);
        let (within, loads) = within.split_at_mut(3 * n);
        let step = Step::<S, W> {
            simd,
            modes: step.modes,
            inertia: step.rule.inertia(),
            rate: step.rule.damping(),
            gain_rows: step.group.gain_rows.as_chunks().0,
            lag_rows: step.group.has_lag.then(|| step.group.lag_rows.as_chunks().0),
            by_reach: by_reach.as_chunks().0,
            presses: step.tangents.iter().any(|tangent| *tangent != 0.0),
        };
        let parts = ROWS / S::F64_LANES;
        let (own, _) = S::as_mut_simd_f64s(own);
        for bundle in own.chunks_exact_mut((3 * n * parts).max(1)) {
            for part in 0..parts {
                step.carry(&mut bundle[part..], parts, within, loads);
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

/// Where a row of a mode is: displacement, velocity or acceleration as `kind`.
fn place(modes: usize, row: usize, mode: usize, kind: usize) -> usize {
    ((row / ROWS * modes + mode) * 3 + kind) * ROWS + row % ROWS
}

/// A step as vectors of rows need it.
struct Step<'s, S: Simd, const W: usize> {
    simd: S,
    modes: &'s Modes,
    /// 4/h², 2/h.
    inertia: f64,
    rate: f64,
    /// g R, by mode.
    gain_rows: &'s [[f64; W]],
    /// −τ R, by mode, if any coupling has a lag.
    lag_rows: Option<&'s [[f64; W]]>,
    /// A⁻¹ Rᵀ D (I + g Y D)⁻¹, by mode.
    by_reach: &'s [[f64; W]],
    /// Whether any coupling has a tangent.
    presses: bool,
}

impl<S: Simd, const W: usize> Step<'_, S, W> {
    /// Carries the rows of one vector: `own` has it at every multiple of `parts`, by mode displacement, velocity, acceleration.
    #[inline(always)]
    fn carry(
        &self,
        own: &mut [S::f64s],
        parts: usize,
        within: &mut [S::f64s],
        loads: &mut [S::f64s],
    ) {
        let (simd, n) = (self.simd, self.modes.count);
        let [inertia, rate, twice] =
            [self.inertia, self.rate, 2.0 * self.rate].map(|x| simd.splat_f64s(x));
        let (within, _) = within.as_chunks_mut::<3>();
        let within = &mut within[..n];
        for (j, [q, v1, a1]) in within.iter_mut().enumerate() {
            let [x, v, a] = [0, 1, 2].map(|kind| own[(3 * j + kind) * parts]);
            // a* = (4/h²) x + (4/h) ẋ + ẍ,  v* = (2/h) x + ẋ
            *a1 = simd.mul_add_f64s(inertia, x, simd.mul_add_f64s(twice, v, a));
            *v1 = simd.mul_add_f64s(rate, x, v);
            *q = *a1;
        }
        self.solve(within, loads);
        if self.presses {
            let z = self.reach(within);
            let less = z.map(|z| simd.neg_f64s(z));
            for (answer, [q, ..]) in self.by_reach.iter().zip(within.iter_mut()) {
                let own = answer.iter().zip(&less);
                *q = own.fold(*q, |q, (a, z)| simd.mul_add_f64s(simd.splat_f64s(*a), *z, q));
            }
        }
        for (j, [q, v1, a1]) in within.iter().enumerate() {
            own[3 * j * parts] = *q;
            own[(3 * j + 1) * parts] = simd.sub_f64s(simd.mul_f64s(rate, *q), *v1);
            own[(3 * j + 2) * parts] = simd.sub_f64s(simd.mul_f64s(inertia, *q), *a1);
        }
    }

    /// z' = g R x' − τ R v*', without coupling forces.
    #[inline(always)]
    fn reach(&self, within: &[[S::f64s; 3]]) -> [S::f64s; W] {
        let simd = self.simd;
        let mut z = [simd.splat_f64s(0.0); W];
        for (gain, [q, ..]) in self.gain_rows.iter().zip(within) {
            add(simd, &mut z, gain, *q);
        }
        for (lag, [_, v1, _]) in self.lag_rows.into_iter().flatten().zip(within) {
            add(simd, &mut z, lag, *v1);
        }
        z
    }

    /// Replaces a*' by A⁻¹ (a*' + C v*') in all modes. Where C is full, C = (h/2) (A − (4/h²) I − Λ) leaves one
    /// product with a full matrix,
    ///
    /// ```text
    /// A⁻¹ (a* + C v*) = (h/2) v* + A⁻¹ (a* − (2/h) v* − (h/2) Λ v*)
    /// ```
    #[inline(always)]
    fn solve(&self, within: &mut [[S::f64s; 3]], loads: &mut [S::f64s]) {
        let (simd, modes) = (self.simd, self.modes);
        let n = modes.count;
        if let Some(damping) = &modes.own_damping {
            let own = damping.iter().zip(&modes.own_inverse);
            for ([q, v1, _], (c, inverse)) in within.iter_mut().zip(own) {
                let load = simd.mul_add_f64s(simd.splat_f64s(*c), *v1, *q);
                *q = simd.mul_f64s(simd.splat_f64s(*inverse), load);
            }
            return;
        }
        let loads = &mut loads[..n];
        for ((load, [q, v1, _]), lambda) in loads.iter_mut().zip(&*within).zip(&modes.lambda) {
            let along = simd.splat_f64s(-(self.rate + lambda / self.rate));
            *load = simd.mul_add_f64s(along, *v1, *q);
        }
        let half = simd.splat_f64s(1.0 / self.rate);
        let mut first = 0;
        while first < n {
            // The last block begins earlier than where the one before it ended, so that all are whole.
            let start = first.min(n.saturating_sub(AT_ONCE));
            first = start + AT_ONCE;
            let block = &mut within[start..first.min(n)];
            let rows: [&[f64]; AT_ONCE] = std::array::from_fn(|i| {
                let row = (start + i).min(n - 1);
                &modes.inverse[row * n..(row + 1) * n]
            });
            let mut sums = [simd.splat_f64s(0.0); AT_ONCE];
            for (k, load) in loads.iter().enumerate() {
                for (sum, row) in sums.iter_mut().zip(rows) {
                    *sum = simd.mul_add_f64s(simd.splat_f64s(row[k]), *load, *sum);
                }
            }
            for ([q, v1, _], sum) in block.iter_mut().zip(sums) {
                *q = simd.mul_add_f64s(half, *v1, sum);
            }
        }
    }
}

/// Adds a mode's part to the deflections of all couplings.
#[inline(always)]
fn add<S: Simd, const W: usize>(simd: S, z: &mut [S::f64s; W], along: &[f64; W], x: S::f64s) {
    for (z, along) in z.iter_mut().zip(along) {
        *z = simd.mul_add_f64s(simd.splat_f64s(*along), x, *z);
    }
}
