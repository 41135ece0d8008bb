//! Gradients of a set's state: in place of each number, a column with its derivatives with respect to the
//! changes at the start.

use dynamics::Number;
use nalgebra::{DMatrix, DVector};

use super::lag::WIDTH;

/// Rows of gradients come in whole blocks of this many, so that no loop over a column has a rest.
pub(super) const BLOCK: usize = 8;

/// y += factor x, for columns of whole blocks.
#[inline(always)]
pub(super) fn add<T: Number>(y: &mut [T], factor: f64, x: &[T]) {
    let factor = T::of(factor);
    let (y, x) = (y.as_chunks_mut::<BLOCK>().0, x.as_chunks::<BLOCK>().0);
    for (y, x) in y.iter_mut().zip(x) {
        // Read as a whole: the compiler then needs not know that x is not y.
        let (mut sum, x) = (*y, *x);
        for i in 0..BLOCK {
            sum[i] += factor * x[i];
        }
        *y = sum;
    }
}

/// Column j of columns of length `m`, stored one after another.
#[inline(always)]
pub(super) fn column<T>(all: &[T], m: usize, j: usize) -> &[T] {
    &all[j * m..(j + 1) * m]
}

/// The same, to be changed.
#[inline(always)]
pub(super) fn column_mut<T>(all: &mut [T], m: usize, j: usize) -> &mut [T] {
    &mut all[j * m..(j + 1) * m]
}

/// Gradients of some coordinates: a row for each change at the start, a column for each quantity.
#[derive(Debug, Clone)]
pub(super) struct Gradients<T> {
    /// Of displacements.
    pub(super) x: DMatrix<T>,
    /// Of velocities.
    pub(super) v: DMatrix<T>,
    /// Of accelerations.
    pub(super) a: DMatrix<T>,
}

impl<T: Number> Gradients<T> {
    /// Writes those of a* and v* of Newmark's rule, with 4/h² and 2/h, column after column.
    #[inline(always)]
    pub(super) fn write_histories(&self, rule: [f64; 2], [a, v]: [&mut Vec<T>; 2]) {
        let [inertia, rate] = rule.map(T::of);
        let twice = rate + rate;
        let [x, v0, a0] = [&self.x, &self.v, &self.a].map(|list| list.as_slice());
        let own = x.iter().zip(v0).zip(a0);
        let count = self.x.len();
        [&mut *a, &mut *v].into_iter().for_each(|list| list.resize(count, T::of(0.0)));
        for (((x, v0), a0), (a, v)) in own.zip(a.iter_mut().zip(v)) {
            *v = rate * *x + *v0;
            *a = inertia * *x + twice * *v0 + *a0;
        }
    }

    /// The same as matrices.
    pub(super) fn histories(&self, rule: [f64; 2]) -> [DMatrix<T>; 2] {
        let (mut a, mut v) = (Vec::new(), Vec::new());
        self.write_histories(rule, [&mut a, &mut v]);
        let (rows, columns) = self.x.shape();
        [a, v].map(|list| DMatrix::from_vec(rows, columns, list))
    }

    /// The end of a step with displacements `x` from the histories a*, v* at its start.
    #[inline(always)]
    pub(super) fn advance(&mut self, rule: [f64; 2], x: &[T], [a, v]: [&[T]; 2]) {
        let [inertia, rate] = rule.map(T::of);
        let [x1, v1, a1] = self.lists_mut().map(|list| list.as_mut_slice());
        let own = x1.iter_mut().zip(v1).zip(a1);
        for (((x1, v1), a1), ((x, a), v)) in own.zip(x.iter().zip(a).zip(v)) {
            (*x1, *v1, *a1) = (*x, rate * *x - *v, inertia * *x - *a);
        }
    }

    /// All three lists.
    pub(super) fn lists_mut(&mut self) -> [&mut DMatrix<T>; 3] {
        [&mut self.x, &mut self.v, &mut self.a]
    }
}

/// Gradients of the lag of one mesh: of P̃ (within a step of the part of it at its end that is known at its start), of the
/// forces at the end of the last step, and of those one step earlier.
#[derive(Debug, Clone)]
pub(super) struct LagGradients<T> {
    lists: [DMatrix<T>; 3],
    /// Pairs with gradients other than zero.
    live: [bool; WIDTH],
    /// Steps since each pair touched last.
    parted: [usize; WIDTH],
}

impl<T: Number> LagGradients<T> {
    pub(super) fn new(lists: [DMatrix<T>; 3], live: [bool; WIDTH]) -> Self {
        Self { lists, live, parted: [0; WIDTH] }
    }

    pub(super) fn lists(&self) -> &[DMatrix<T>; 3] {
        &self.lists
    }

    pub(super) fn lists_mut(&mut self) -> &mut [DMatrix<T>; 3] {
        &mut self.lists
    }

    /// The columns of pairs with gradients other than zero, of each list.
    pub(super) fn live_columns_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        let live = &self.live;
        self.lists.iter_mut().flat_map(move |list| {
            let m = list.nrows().max(1);
            let columns = list.as_mut_slice().chunks_exact_mut(m).zip(live);
            columns.filter_map(|(column, is_live)| is_live.then_some(column))
        })
    }

    #[inline(always)]
    pub(super) fn is_live(&self, slot: usize) -> bool {
        self.live[slot]
    }

    /// Starts a step: replaces P̃ by the part of it at the end of the step that is known, as in
    /// [`PairMemory::known`](super::lag::PairMemory::known).
    #[inline(always)]
    pub(super) fn predict(&mut self, weights: [f64; 4]) {
        let [_, start, before, state] = weights.map(T::of);
        let m = self.lists[0].nrows();
        let [filtered, now, earlier] = &mut self.lists;
        for slot in (0..WIDTH).filter(|slot| self.live[*slot]) {
            let own = column_mut(filtered.as_mut_slice(), m, slot).as_chunks_mut::<BLOCK>().0;
            let [now, earlier] = [&*now, &*earlier]
                .map(|list| column(list.as_slice(), m, slot).as_chunks::<BLOCK>().0);
            for ((f, n), e) in own.iter_mut().zip(now).zip(earlier) {
                let (mut sum, n, e) = (*f, *n, *e);
                for i in 0..BLOCK {
                    sum[i] = state * sum[i] + start * n[i] + before * e[i];
                }
                *f = sum;
            }
        }
    }

    /// The known part of a live pair, within a step.
    pub(super) fn known(&self, slot: usize) -> &[T] {
        column(self.lists[0].as_slice(), self.lists[0].nrows(), slot)
    }

    /// Advances by a step at whose end the pairs `pressed` (slot, column of `forces`) have forces. `forgotten`: steps after
    /// which nothing is left of the lag of a pair that does not touch.
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        (end, forgotten): (f64, usize),
        pressed: &[(usize, usize)],
        forces: &[T],
    ) {
        let m = self.lists[0].nrows();
        let [filtered, now, before] = &mut self.lists;
        // The list of the forces one step earlier becomes that of the new ones.
        std::mem::swap(now, before);
        let (filtered, now) = (filtered.as_mut_slice(), now.as_mut_slice());
        for slot in 0..WIDTH {
            match pressed.iter().find(|(own, _)| *own == slot) {
                Some((_, k)) => {
                    let force = column(forces, m, *k);
                    add(column_mut(filtered, m, slot), end, force);
                    column_mut(now, m, slot).copy_from_slice(force);
                    (self.live[slot], self.parted[slot]) = (true, 0);
                }
                None if self.live[slot] => {
                    column_mut(now, m, slot).fill(T::of(0.0));
                    self.parted[slot] += 1;
                    if self.parted[slot] > forgotten {
                        column_mut(filtered, m, slot).fill(T::of(0.0));
                        self.live[slot] = false;
                    }
                }
                None => {}
            }
        }
    }

    /// The mesh starts a new cycle: what was pair k is pair k + 1.
    pub(super) fn move_on(&mut self) {
        for list in &mut self.lists {
            let m = list.nrows();
            let own = list.as_mut_slice();
            own.copy_within(0..(WIDTH - 1) * m, m);
            own[..m].fill(T::of(0.0));
        }
        self.live.copy_within(0..WIDTH - 1, 1);
        self.live[0] = false;
        self.parted.copy_within(0..WIDTH - 1, 1);
    }
}

/// Gradients of the components of a race's vector in a frame turned by `angle` (rad); `of` gives those in the
/// frame of the race's coordinates, `None` for held ones.
pub(super) fn turned_into<T: Number>(
    angle: f64,
    of: impl Fn(usize) -> Option<DVector<T>>,
) -> [Option<DVector<T>>; 3] {
    let [x, y, u] = [of(0), of(1), of(2)];
    let (sin, cos) = angle.sin_cos();
    let (sin, cos) = (T::of(sin), T::of(cos));
    let sum = |a: Option<DVector<T>>, b: Option<DVector<T>>| match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (a, b) => a.or(b),
    };
    let scaled = |v: &Option<DVector<T>>, factor: T| v.as_ref().map(|v| v * factor);
    [sum(scaled(&x, cos), scaled(&y, sin)), sum(scaled(&x, -sin), scaled(&y, cos)), u]
}

/// The inverse of [`turned_into`] for all three components.
pub(super) fn out_of_turned<T: Number>(angle: f64, [x, y, u]: [DVector<T>; 3]) -> [DVector<T>; 3] {
    let (sin, cos) = angle.sin_cos();
    let (sin, cos) = (T::of(sin), T::of(cos));
    [&x * cos - &y * sin, &x * sin + &y * cos, u]
}
