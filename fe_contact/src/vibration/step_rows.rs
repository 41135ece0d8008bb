//! Rows of the gradients of the races and of the lag on their way through a step.
//!
//! Each row passes through a step by itself. Bundles of them pass through the whole of it together, so that what they
//! need in between stays in the nearest memory.

use dynamics::{Bundles, Computation, InBundles, MOST_IN_BUNDLE, Number, Simd, in_bundles};

use super::gradients::{Gradients, LagEnd, LagGradients};
use super::packed::BLOCK;
use super::step_terms::{BendLoad, StepTerms};

/// Weights of a step.
pub(super) struct StepWeights {
    /// h, s.
    pub(super) step: f64,
    /// 4/h² and 2/h of Newmark's rule.
    pub(super) newmark: [f64; 2],
    /// Of the forces at the end, at the start and one step earlier, and of P̃.
    pub(super) lag: [f64; 4],
}

/// Gradients that are carried over a step.
pub(super) struct Carrying<'c, T> {
    pub(super) terms: &'c StepTerms<T>,
    /// S' of each group by rows, N/m, and (A + Rᵀ S' R)⁻¹ as [`Packed`](super::packed::Packed) has it, m/N.
    pub(super) stiffness: &'c [f64],
    pub(super) inverse: &'c [f64],
    pub(super) weights: &'c StepWeights,
    pub(super) races: &'c mut Gradients<T>,
    pub(super) meshes: &'c mut [LagGradients<T>],
    /// Loads on the races and approaches of the touching pairs by the bodies' modes, column after column; then the
    /// displacements of the races at the end and the forces of the touching pairs. `None` without modes.
    pub(super) modes: Option<[&'c mut [T]; 4]>,
    /// Memory within the step.
    pub(super) room: &'c mut Vec<T>,
    /// Memory for the two matrices in the precision of T.
    pub(super) matrices: [&'c mut Vec<T>; 2],
}

impl<T: Number> Computation for Carrying<'_, T> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { terms, stiffness, inverse, weights, races, meshes, modes, room, matrices } =
            self;
        let [of_stiffness, of_inverse] = matrices;
        let lanes = Bundles::<S, T>::lanes();
        let stride = races.x.nrows() / lanes;
        let races = races.lists_mut().map(|list| T::vectors_mut::<S>(list.as_mut_slice()));
        let mut lag = Vec::with_capacity(meshes.len());
        for own in meshes {
            let lists = own.lists_mut().each_mut();
            lag.push(lists.map(|list| T::vectors_mut::<S>(list.as_mut_slice())));
        }
        let modes = modes.map(|lists| lists.map(|list| T::vectors_mut::<S>(list)));
        let [step, half] = [weights.step, 0.5 * weights.step * weights.step];
        let [inertia, rate] = weights.newmark;
        let sums = Bundles::<S, T>::new(simd);
        let all = |x: f64| sums.spread(T::of(x));
        let count = (3 * terms.races.len() + 2 * terms.count()) * MOST_IN_BUNDLE * lanes;
        room.resize(count, T::of(0.0));
        let mut rows = Rows::<S, T> {
            sums,
            terms,
            stiffness: T::nearest(stiffness, of_stiffness),
            inverse: T::nearest(inverse, of_inverse),
            stride,
            at: 0,
            ahead: [step, half].map(all),
            newmark: [inertia, rate, 2.0 * rate].map(all),
            lag_weights: weights.lag.map(all),
            races,
            lag,
            modes,
            room: T::vectors_mut::<S>(room),
        };
        in_bundles(stride, &mut rows);
    }
}

/// Vectors within a step: of the coordinates, then of the touching pairs.
struct Within<'w, V, const U: usize> {
    load: &'w mut [[V; U]],
    /// v* and a* of Newmark's rule.
    v: &'w mut [[V; U]],
    a: &'w mut [[V; U]],
    b: &'w mut [[V; U]],
    forces: &'w mut [[V; U]],
}

/// Gradients on their way through a step, by vectors of rows: column j of a list begins at j `stride`.
struct Rows<'r, S: Simd, T: Number> {
    sums: Bundles<S, T>,
    terms: &'r StepTerms<T>,
    stiffness: &'r [T],
    inverse: &'r [T],
    stride: usize,
    /// First of the vectors that pass through the step now.
    at: usize,
    /// h, h²/2.
    ahead: [T::Vector<S>; 2],
    /// 4/h², 2/h, 4/h.
    newmark: [T::Vector<S>; 3],
    lag_weights: [T::Vector<S>; 4],
    /// Displacements, velocities, accelerations.
    races: [&'r mut [T::Vector<S>]; 3],
    /// Of each mesh P̃, the forces at the end of the last step, and those one step earlier.
    lag: Vec<[&'r mut [T::Vector<S>]; 3]>,
    modes: Option<[&'r mut [T::Vector<S>]; 4]>,
    room: &'r mut [T::Vector<S>],
}

impl<S: Simd, T: Number> InBundles for Rows<'_, S, T> {
    #[inline(always)]
    fn run<const U: usize>(&mut self, at: usize) {
        self.at = at;
        let room = std::mem::take(&mut self.room);
        let (n, count) = (self.terms.races.len(), self.terms.count());
        let (load, rest) = room.as_chunks_mut::<U>().0.split_at_mut(n);
        let (v, rest) = rest.split_at_mut(n);
        let (a, rest) = rest.split_at_mut(n);
        let (b, rest) = rest.split_at_mut(count);
        let mut within = Within { load, v, a, b, forces: &mut rest[..count] };
        self.start(&mut within);
        self.bend(&mut within);
        self.predict_lag(&mut within);
        // (A + Rᵀ S' R) x' = L' − Rᵀ S' b'
        self.press(&mut within);
        self.relieve(&mut within);
        self.displace(&within);
        // P' = S' (R x' + b')
        self.approach(&mut within);
        self.press(&mut within);
        self.finish(&within);
        self.room = room;
    }
}

impl<S: Simd, T: Number> Rows<'_, S, T> {
    /// Where the vectors of a column are.
    #[inline(always)]
    fn place(&self, column: usize) -> usize {
        column * self.stride + self.at
    }

    /// L' = m a*' + (α m + τ k + G + bearings) v*', and what the modes contribute to L' and b'.
    #[inline(always)]
    fn start<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let (sums, terms) = (self.sums, self.terms);
        let [inertia, rate, twice] = self.newmark;
        let [x, v, a] = &self.races;
        let Within { load, v: v1, a: a1, b, .. } = within;
        for (j, (v1, a1)) in v1.iter_mut().zip(a1.iter_mut()).enumerate() {
            let place = self.place(j);
            let (x, v, a) = (sums.at(x, place), sums.at(v, place), sums.at(a, place));
            // a* = (4/h²) x + (4/h) ẋ + ẍ,  v* = (2/h) x + ẋ
            *a1 = sums.plus(inertia, &x, sums.plus(twice, &v, a));
            *v1 = sums.plus(rate, &x, v);
        }
        let zero = sums.zero();
        let mut first = 0;
        for (j, (load, (mass, end))) in load.iter_mut().zip(&terms.races).enumerate() {
            let start = match &self.modes {
                Some([loads, ..]) => sums.at(loads, self.place(j)),
                None => zero,
            };
            let mut sum = sums.plus(sums.spread(*mass), &a1[j], start);
            for (k, c) in &terms.damping[first..*end] {
                sum = sums.plus(sums.spread(*c), &v1[*k], sum);
            }
            first = *end;
            *load = sum;
        }
        for (k, b) in b.iter_mut().enumerate() {
            *b = match &self.modes {
                Some([_, own, ..]) => sums.at(own, self.place(k)),
                None => zero,
            };
        }
    }

    /// Second-order terms of corner gaps, at the displacements x + h (v + ½ h a) expected at the end of the step.
    #[inline(always)]
    fn bend<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let [step, half] = self.ahead;
        let [x, v, a] = &self.races;
        for bend in &self.terms.bends {
            let row = &bend.row[..bend.count];
            let mut moved = sums.zero();
            for (i, r) in row {
                let place = self.place(*i);
                let (x, v, a) = (sums.at(x, place), sums.at(v, place), sums.at(a, place));
                let ahead = sums.plus(half, &a, sums.plus(step, &v, x));
                moved = sums.plus(sums.spread(*r), &ahead, moved);
            }
            if let Some((pair, factor)) = bend.gap {
                let b = &mut within.b[pair];
                *b = sums.plus(sums.spread(factor), &moved, *b);
            }
            if let Some(BendLoad { stiffness, share, pair }) = bend.load {
                let mut pressed = sums.times(sums.spread(stiffness), moved);
                if let Some((mesh, slot)) = pair {
                    let [_, now, before] = &self.lag[mesh];
                    let (now, before) =
                        (sums.at(now, self.place(slot)), sums.at(before, self.place(slot)));
                    pressed = sums.plus(sums.spread(share + share), &now, pressed);
                    pressed = sums.minus(sums.spread(share), &before, pressed);
                }
                for (i, r) in row {
                    let load = &mut within.load[*i];
                    *load = sums.plus(sums.spread(*r), &pressed, *load);
                }
            }
        }
    }

    /// Replaces P̃ by the part of it at the end of the step that is known, as in
    /// [`PairMemory::known`](super::lag::PairMemory::known), which opens the gaps.
    #[inline(always)]
    fn predict_lag<const U: usize>(&mut self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let [_, start, before, state] = self.lag_weights;
        let mut first = 0;
        for lag in &self.terms.lags {
            let entries = &self.terms.lagging[first..lag.lagging];
            first = lag.lagging;
            if !lag.is_live {
                continue;
            }
            let place = self.place(lag.slot);
            let [filtered, now, earlier] = &mut self.lag[lag.mesh];
            let known = sums.times(before, sums.at(earlier, place));
            let known = sums.plus(start, &sums.at(now, place), known);
            let known = sums.plus(state, &sums.at(filtered, place), known);
            sums.put(filtered, place, &known);
            for (pair, f) in entries {
                let b = &mut within.b[*pair];
                *b = sums.plus(sums.spread(*f), &known, *b);
            }
        }
    }

    /// P' = S' b'.
    #[inline(always)]
    fn press<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let (mut first, mut rest) = (0, self.stiffness);
        for count in &self.terms.groups {
            let own;
            (own, rest) = rest.split_at(count * count);
            let b = &within.b[first..first + count];
            let forces = &mut within.forces[first..first + count];
            for (force, row) in forces.iter_mut().zip(own.chunks_exact((*count).max(1))) {
                let mut sum = sums.zero();
                for (s, b) in row.iter().zip(b) {
                    sum = sums.plus(sums.spread(*s), b, sum);
                }
                *force = sum;
            }
            first += count;
        }
    }

    /// L' less Rᵀ P'.
    #[inline(always)]
    fn relieve<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let (sums, mut first) = (self.sums, 0);
        for (end, force) in self.terms.pairs.iter().zip(within.forces.iter()) {
            for (i, r) in &self.terms.entries[first..*end] {
                let load = &mut within.load[*i];
                *load = sums.minus(sums.spread(*r), force, *load);
            }
            first = *end;
        }
    }

    /// x' = (A + Rᵀ S' R)⁻¹ L'.
    #[inline(always)]
    fn displace<const U: usize>(&mut self, within: &Within<'_, T::Vector<S>, U>) {
        let load = &*within.load;
        let blocks = self.inverse.chunks_exact((load.len() * BLOCK).max(1));
        for (block, columns) in blocks.enumerate() {
            let (columns, first) = (columns.as_chunks().0, block * BLOCK);
            let count = (load.len() - first).min(BLOCK);
            let mut row = 0;
            while row < count {
                // As many sums as hide the latency of a sum and fit the registers.
                row += match (U, count - row) {
                    (1, BLOCK) => self.displace_some::<U, BLOCK>(columns, [first, row], load),
                    (1..=3, 4..) => self.displace_some::<U, 4>(columns, [first, row], load),
                    (_, 2..) => self.displace_some::<U, 2>(columns, [first, row], load),
                    _ => self.displace_some::<U, 1>(columns, [first, row], load),
                };
            }
        }
    }

    /// R displacements of a block from a row on. Returns R.
    #[inline(always)]
    fn displace_some<const U: usize, const R: usize>(
        &mut self,
        columns: &[[T; BLOCK]],
        [first, row]: [usize; 2],
        load: &[[T::Vector<S>; U]],
    ) -> usize {
        let sums = self.sums;
        let mut all = [sums.zero(); R];
        for (column, load) in columns.iter().zip(load) {
            let column = &column[row..row + R];
            for r in 0..R {
                all[r] = sums.plus(sums.spread(column[r]), load, all[r]);
            }
        }
        for (k, sum) in all.iter().enumerate() {
            let place = self.place(first + row + k);
            sums.put(self.races[0], place, sum);
        }
        R
    }

    /// b' plus R x'.
    #[inline(always)]
    fn approach<const U: usize>(&self, within: &mut Within<'_, T::Vector<S>, U>) {
        let (sums, mut first) = (self.sums, 0);
        for (end, b) in self.terms.pairs.iter().zip(within.b.iter_mut()) {
            // A sum in memory would wait for its store at every entry.
            let mut sum = *b;
            for (i, r) in &self.terms.entries[first..*end] {
                let x = sums.at(self.races[0], self.place(*i));
                sum = sums.plus(sums.spread(*r), &x, sum);
            }
            *b = sum;
            first = *end;
        }
    }

    /// The state at the end of the step. The lists of the forces one step earlier become those of the new ones.
    #[inline(always)]
    fn finish<const U: usize>(&mut self, within: &Within<'_, T::Vector<S>, U>) {
        let sums = self.sums;
        let [inertia, rate, _] = self.newmark;
        let zero = sums.zero::<U>();
        let Within { v: v1, a: a1, forces, .. } = within;
        for (j, (v1, a1)) in v1.iter().zip(a1.iter()).enumerate() {
            let place = self.place(j);
            let [x, v, a] = &mut self.races;
            let x = sums.at(x, place);
            // ẋ = (2/h) x − v*,  ẍ = (4/h²) x − a*
            sums.put(v, place, &sums.times_less(rate, &x, *v1));
            sums.put(a, place, &sums.times_less(inertia, &x, *a1));
        }
        let end = self.lag_weights[0];
        for lag in &self.terms.lags {
            let place = self.place(lag.slot);
            let [filtered, _, next] = &mut self.lag[lag.mesh];
            match lag.end {
                LagEnd::Pressed(pair) => {
                    let sum = sums.plus(end, &forces[pair], sums.at(filtered, place));
                    sums.put(filtered, place, &sum);
                    sums.put(next, place, &forces[pair]);
                }
                LagEnd::Parted => sums.put(next, place, &zero),
                LagEnd::Forgotten => {
                    sums.put(next, place, &zero);
                    sums.put(filtered, place, &zero);
                }
            }
        }
        let (stride, at) = (self.stride, self.at);
        if let Some([_, _, displacements, pressed]) = &mut self.modes {
            for j in 0..v1.len() {
                let place = j * stride + at;
                sums.put(displacements, place, &sums.at::<U>(self.races[0], place));
            }
            for (k, force) in forces.iter().enumerate() {
                sums.put(pressed, k * stride + at, force);
            }
        }
    }
}
