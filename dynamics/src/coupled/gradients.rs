//! Gradients of the modes' motion, carried over time steps.
//!
//! All that happens to one row of them in a step is independent of the other rows, so that bundles of rows pass through
//! the whole step together.

use nalgebra::DMatrix;

use super::condensed::{Condensed, at_width};
use super::linear::Modes;
use super::newton;
use crate::bundles::{Bundle, Bundles, InBundles, MOST, in_bundles};
use crate::newmark::AverageAcceleration;
use crate::number::Number;
use crate::wide::{Computation, Simd, wide};

/// Gradients of displacements, velocities and accelerations of n modes with respect to 2n coordinates at the start, in
/// the precision of T: column after column, each with zeros to whole vectors.
#[derive(Debug, Clone)]
pub(super) struct Gradients<T> {
    modes: usize,
    /// Rows with zeros to whole vectors.
    rows: usize,
    motion: [Vec<T>; 3],
    factors: Factors<T>,
    /// Memory within a step.
    room: Vec<T>,
}

/// A step over which gradients are carried.
pub(super) struct StepGradient<'s> {
    pub(super) modes: &'s Modes,
    pub(super) rule: &'s AverageAcceleration,
    /// The couplings that took part.
    pub(super) group: &'s Condensed,
    /// Whether rare ones did.
    pub(super) is_rare: bool,
    /// Their tangents at the end of the step, N/m.
    pub(super) tangents: &'s [f64],
}

/// Factors of the steps, in the precision of the gradients.
#[derive(Debug, Clone)]
struct Factors<T> {
    linear: LinearFactors<T>,
    /// Of the usual couplings, and of all; `None` until they take part.
    groups: [Option<GroupFactors<T>>; 2],
    /// A⁻¹ Rᵀ D (I + g Y D)⁻¹, by mode, then coupling.
    by_reach: Vec<T>,
}

/// Factors of the modes.
#[derive(Debug, Clone)]
enum LinearFactors<T> {
    /// Of each mode c and the entry of A⁻¹, where C is diagonal.
    Diagonal(Vec<(T, T)>),
    /// −(h²/4) (2/h + (h/2) λ) of each mode, h²/4, and (4/h²) A⁻¹ by rows: of the order of 1, so that in single
    /// precision no product is too small to be a normal number, which would cost a hundred times as much.
    Full(Vec<T>, T, Vec<T>),
}

/// Factors of a group of couplings.
#[derive(Debug, Clone)]
struct GroupFactors<T> {
    /// g R, by mode, then coupling.
    gain_rows: Vec<T>,
    /// −τ R in the same order; none if no coupling has a lag.
    lag_rows: Vec<T>,
}

impl<T: Number> Gradients<T> {
    /// Of displacements, velocities and accelerations, each 2n×n: rows by coordinate at the start, columns by mode. A
    /// row more is a change of all coordinates.
    pub(super) fn new(
        start: [&DMatrix<f64>; 3],
        modes: &Modes,
        rule: &AverageAcceleration,
    ) -> Self {
        let (count, n) = start[0].shape();
        let rows = count.next_multiple_of(T::MOST_LANES);
        let motion = start.map(|list| {
            let mut own = vec![T::of(0.0); rows * n];
            for (own, list) in own.chunks_exact_mut(rows.max(1)).zip(list.column_iter()) {
                own.iter_mut().zip(&list).for_each(|(own, x)| *own = T::of(*x));
            }
            own
        });
        let linear = match &modes.own_damping {
            Some(damping) => {
                let own = damping.iter().zip(&modes.own_inverse).take(n);
                LinearFactors::Diagonal(own.map(|(c, a)| (T::of(*c), T::of(*a))).collect())
            }
            None => {
                let (rate, inertia) = (rule.damping(), rule.inertia());
                let along = modes.lambda.iter().take(n);
                let along = along.map(|lambda| T::of(-(rate + lambda / rate) / inertia));
                let inverse = modes.inverse.iter().map(|a| T::of(inertia * a)).collect();
                LinearFactors::Full(along.collect(), T::of(1.0 / inertia), inverse)
            }
        };
        let factors = Factors { linear, groups: [None, None], by_reach: Vec::new() };
        Self { modes: n, rows, motion, factors, room: Vec::new() }
    }

    /// Writes one row of the gradients of the displacements.
    pub(super) fn write_displacements(&self, row: usize, out: &mut [f64]) {
        let own = self.motion[0].chunks_exact(self.rows.max(1));
        out.iter_mut().zip(own).for_each(|(x, column)| *x = column[row].double());
    }

    /// Displacements, then velocities of the modes at the end by those at the start, 2n×2n.
    pub(super) fn end_by_start(&self) -> DMatrix<f64> {
        let n = self.modes;
        let of = |i: usize, row: usize| self.motion[i / n][i % n * self.rows + row];
        DMatrix::from_fn(2 * n, 2 * n, |i, row| of(i, row).double())
    }

    /// Carries them over a step.
    pub(super) fn carry(&mut self, step: &StepGradient<'_>) {
        let group = self.factors.groups[usize::from(step.is_rare)].get_or_insert_with(|| {
            let Condensed { gain_rows, lag_rows, has_lag, .. } = step.group;
            let lag_rows = if *has_lag { rounded(lag_rows) } else { Vec::new() };
            GroupFactors { gain_rows: rounded(gain_rows), lag_rows }
        });
        let by_reach = &mut self.factors.by_reach;
        at_width!(step.group.width, W => answer_to_reach::<T, W>(step, by_reach));
        let presses = step.tangents.iter().any(|tangent| *tangent != 0.0);
        wide(Carrying {
            motion: self.motion.each_mut().map(Vec::as_mut_slice),
            stride: self.rows,
            modes: self.modes,
            newmark: [step.rule.inertia(), step.rule.damping()],
            linear: &self.factors.linear,
            group,
            by_reach,
            width: step.group.width,
            pressing: if presses { step.group.count } else { 0 },
            room: &mut self.room,
        });
    }
}

fn rounded<T: Number>(list: &[f64]) -> Vec<T> {
    list.iter().map(|x| T::of(*x)).collect()
}

/// A⁻¹ Rᵀ D (I + g Y D)⁻¹, by mode, then coupling.
fn answer_to_reach<T: Number, const W: usize>(step: &StepGradient<'_>, out: &mut Vec<T>) {
    let StepGradient { modes, rule, group, tangents, .. } = step;
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
    out.clear();
    for j in 0..n {
        let mut sum = [0.0; W];
        for ((answers, row), d) in group.answers.chunks_exact(padded).zip(&g).zip(&d) {
            newton::add(&mut sum, row, answers[j] * d);
        }
        out.extend(sum.iter().map(|x| T::of(*x)));
    }
}

/// Gradients that are carried over a step.
struct Carrying<'c, T> {
    motion: [&'c mut [T]; 3],
    stride: usize,
    modes: usize,
    /// 4/h², 2/h.
    newmark: [f64; 2],
    linear: &'c LinearFactors<T>,
    group: &'c GroupFactors<T>,
    by_reach: &'c [T],
    width: usize,
    /// Couplings, if any of them has a tangent.
    pressing: usize,
    room: &'c mut Vec<T>,
}

impl<T: Number> Computation for Carrying<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { motion, stride, modes, newmark, linear, group, by_reach, .. } = self;
        let (sums, lanes) = (Bundles::<S, T>::new(simd), Bundles::<S, T>::lanes());
        self.room.resize((4 * modes + self.pressing) * MOST * lanes, T::of(0.0));
        let [inertia, rate] = newmark;
        let mut rows = Rows {
            sums,
            motion: motion.map(|list| T::vectors_mut::<S>(list)),
            stride: stride / lanes,
            at: 0,
            modes,
            newmark: [inertia, rate, 2.0 * rate, 1.0 / rate].map(|x| sums.spread(T::of(x))),
            linear,
            group,
            by_reach,
            width: self.width,
            pressing: self.pressing,
            room: T::vectors_mut::<S>(self.room),
        };
        in_bundles(rows.stride, &mut rows);
    }
}

/// Rows of gradients on their way through a step: column j of a list begins at j `stride`.
struct Rows<'r, S: Simd, T: Number> {
    sums: Bundles<S, T>,
    motion: [&'r mut [T::Vector<S>]; 3],
    stride: usize,
    /// First of the vectors that pass through the step now.
    at: usize,
    modes: usize,
    /// 4/h², 2/h, 4/h, h/2.
    newmark: [T::Vector<S>; 4],
    linear: &'r LinearFactors<T>,
    group: &'r GroupFactors<T>,
    by_reach: &'r [T],
    width: usize,
    pressing: usize,
    room: &'r mut [T::Vector<S>],
}

/// Bundles within a step, by mode: v* and a* of Newmark's rule, load and displacement; and by coupling the deflection.
struct Within<'w, V, const U: usize> {
    v: &'w mut [[V; U]],
    a: &'w mut [[V; U]],
    load: &'w mut [[V; U]],
    q: &'w mut [[V; U]],
    z: &'w mut [[V; U]],
}

impl<S: Simd, T: Number> InBundles for Rows<'_, S, T> {
    #[inline(always)]
    fn run<const U: usize>(&mut self, at: usize) {
        self.at = at;
        let room = std::mem::take(&mut self.room);
        let (v, rest) = room.as_chunks_mut::<U>().0.split_at_mut(self.modes);
        let (a, rest) = rest.split_at_mut(self.modes);
        let (load, rest) = rest.split_at_mut(self.modes);
        let (q, rest) = rest.split_at_mut(self.modes);
        let mut within = Within { v, a, load, q, z: &mut rest[..self.pressing] };
        self.start(&mut within);
        self.solve(&mut within);
        self.reach(&mut within);
        self.press(&mut within);
        self.finish(&within);
        self.room = room;
    }
}

impl<S: Simd, T: Number> Rows<'_, S, T> {
    /// a*' = (4/h²) x' + (4/h) ẋ' + ẍ',  v*' = (2/h) x' + ẋ'.
    #[inline(always)]
    fn start<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let [inertia, rate, twice, _] = self.newmark;
        let [x, v, a] = &self.motion;
        for (j, (v1, a1)) in within.v.iter_mut().zip(within.a.iter_mut()).enumerate() {
            let place = j * self.stride + self.at;
            let (x, v, a) = (sums.at(x, place), sums.at(v, place), sums.at(a, place));
            *a1 = sums.plus(inertia, &x, sums.plus(twice, &v, a));
            *v1 = sums.plus(rate, &x, v);
        }
    }

    /// The displacements without coupling forces, A⁻¹ (a*' + C v*'). Where C is full, C = (h/2) (A − (4/h²) I − Λ)
    /// leaves one product with a full matrix,
    ///
    /// ```text
    /// A⁻¹ (a* + C v*) = (h/2) v* + A⁻¹ (a* − (2/h) v* − (h/2) Λ v*)
    /// ```
    #[inline(always)]
    fn solve<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let Within { v, a, load, q, .. } = within;
        match self.linear {
            LinearFactors::Diagonal(own) => {
                let histories = v.iter().zip(a.iter()).zip(own);
                for (q, ((v, a), (c, inverse))) in q.iter_mut().zip(histories) {
                    let load = sums.plus(sums.spread(*c), v, *a);
                    *q = sums.times(sums.spread(*inverse), load);
                }
            }
            LinearFactors::Full(along, scale, inverse) => {
                let histories = v.iter().zip(a.iter()).zip(along);
                for (load, ((v, a), along)) in load.iter_mut().zip(histories) {
                    let own = sums.times(sums.spread(*scale), *a);
                    *load = sums.plus(sums.spread(*along), v, own);
                }
                let mut first = 0;
                while first < self.modes {
                    // As many sums as hide the latency of a sum and fit the registers.
                    let own = &mut q[first..];
                    first += match (U, self.modes - first) {
                        (1, 8..) => self.answer::<U, 8>(&inverse[first * self.modes..], load, own),
                        (1..=3, 4..) => {
                            self.answer::<U, 4>(&inverse[first * self.modes..], load, own)
                        }
                        (_, 2..) => self.answer::<U, 2>(&inverse[first * self.modes..], load, own),
                        _ => self.answer::<U, 1>(&inverse[first * self.modes..], load, own),
                    };
                }
                let half = self.newmark[3];
                for (q, v) in q.iter_mut().zip(v.iter()) {
                    *q = sums.plus(half, v, *q);
                }
            }
        }
    }

    /// The first R rows of a matrix times the loads. Returns R.
    #[inline(always)]
    fn answer<const U: usize, const R: usize>(
        &self,
        matrix: &[T],
        load: &[Bundle<S, T, U>],
        q: &mut [Bundle<S, T, U>],
    ) -> usize {
        let (sums, n) = (self.sums, load.len());
        let mut rows: [&[T]; R] = [&[]; R];
        for (r, row) in rows.iter_mut().enumerate() {
            *row = &matrix[r * n..(r + 1) * n];
        }
        let mut all = [sums.zero(); R];
        for (k, load) in load.iter().enumerate() {
            for r in 0..R {
                all[r] = sums.plus(sums.spread(rows[r][k]), load, all[r]);
            }
        }
        q[..R].copy_from_slice(&all);
        R
    }

    /// z' = g R x' − τ R v*', without coupling forces.
    #[inline(always)]
    fn reach<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let Within { v, q, z, .. } = within;
        let GroupFactors { gain_rows, lag_rows } = self.group;
        for (k, pair) in z.chunks_mut(2).enumerate() {
            let own = self.along(gain_rows, q, 2 * k, [sums.zero(); 2]);
            let own = self.along(lag_rows, v, 2 * k, own);
            pair.copy_from_slice(&own[..pair.len()]);
        }
    }

    /// Adds what rows make of gradients of the modes, for two couplings at a time, of which the second may be a padded
    /// one.
    #[inline(always)]
    fn along<const U: usize>(
        &self,
        rows: &[T],
        x: &[Bundle<S, T, U>],
        coupling: usize,
        mut all: [Bundle<S, T, U>; 2],
    ) -> [Bundle<S, T, U>; 2] {
        let sums = self.sums;
        for (row, x) in rows.chunks_exact(self.width).zip(x) {
            let own = &row[coupling..coupling + 2];
            for r in 0..2 {
                all[r] = sums.plus(sums.spread(own[r]), x, all[r]);
            }
        }
        all
    }

    /// x' less A⁻¹ Rᵀ D (I + g Y D)⁻¹ z'.
    #[inline(always)]
    fn press<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let Within { q, z, .. } = within;
        for (answer, q) in self.by_reach.chunks_exact(self.width).zip(q.iter_mut()) {
            let mut sum = *q;
            for (a, z) in answer.iter().zip(z.iter()) {
                sum = sums.minus(sums.spread(*a), z, sum);
            }
            *q = sum;
        }
    }

    /// ẋ' = (2/h) x' − v*',  ẍ' = (4/h²) x' − a*'.
    #[inline(always)]
    fn finish<const U: usize>(&mut self, within: &Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let [inertia, rate, ..] = self.newmark;
        let Within { v: v1, a: a1, q, .. } = within;
        let [x, v, a] = &mut self.motion;
        for (j, (q, (v1, a1))) in q.iter().zip(v1.iter().zip(a1.iter())).enumerate() {
            let place = j * self.stride + self.at;
            sums.put(x, place, q);
            sums.put(v, place, &sums.times_less(rate, q, *v1));
            sums.put(a, place, &sums.times_less(inertia, q, *a1));
        }
    }
}
