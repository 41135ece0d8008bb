//! Gradients of a set's state: in place of each number, a column with its derivatives with respect to the
//! changes at the start.

use dynamics::Number;
use gearset::PathDirection;
use nalgebra::{DMatrix, DVector};

use super::lag::WIDTH;

/// y += factor x.
#[inline(always)]
pub(super) fn add<T: Number>(y: &mut [T], factor: f64, x: &[T]) {
    let factor = T::of(factor);
    y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * *x);
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

/// What becomes of the lag of a pair in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LagEnd {
    /// It has the force of a touching pair.
    Pressed(usize),
    /// It has no force.
    Parted,
    /// It has no force, and nothing is left of earlier ones.
    Forgotten,
}

/// Gradients of the lag of one mesh: of P̃ (within a step of the part of it at its end that is known at its start), of
/// the forces at the end of the last step, and of those one step earlier.
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

    /// Adds the pairs with an entry other than zero in a row to those with gradients.
    pub(super) fn add_live(&mut self, row: usize) {
        for list in &self.lists {
            let own = list.row(row);
            self.live.iter_mut().zip(&own).for_each(|(live, x)| *live |= *x != T::of(0.0));
        }
    }

    /// Pairs with gradients other than zero.
    pub(super) fn live(&self) -> [bool; WIDTH] {
        self.live
    }

    /// What becomes of the lag of a pair at the end of a step, at which it may be one of those that touch; `None` if it
    /// has no gradients before and after. `forgotten`: steps after which nothing is left of the lag of a pair that does
    /// not touch.
    pub(super) fn end(
        &mut self,
        slot: usize,
        touching: Option<usize>,
        forgotten: usize,
    ) -> Option<LagEnd> {
        if let Some(pair) = touching {
            (self.live[slot], self.parted[slot]) = (true, 0);
            return Some(LagEnd::Pressed(pair));
        }
        if !self.live[slot] {
            return None;
        }
        self.parted[slot] += 1;
        self.live[slot] = self.parted[slot] <= forgotten;
        Some(if self.live[slot] { LagEnd::Parted } else { LagEnd::Forgotten })
    }

    /// Ends a step whose forces are in the list of those one step earlier.
    pub(super) fn end_step(&mut self) {
        self.lists.swap(1, 2);
    }

    /// The phase of the mesh passes 0: what was pair k is pair k + 1, or k − 1 in backward direction.
    pub(super) fn move_on(&mut self, direction: PathDirection) {
        let (from, to, left) = match direction {
            PathDirection::Forward => (0, 1, 0),
            PathDirection::Backward => (1, 0, WIDTH - 1),
        };
        for list in &mut self.lists {
            let m = list.nrows();
            let own = list.as_mut_slice();
            own.copy_within(from * m..(from + WIDTH - 1) * m, to * m);
            own[left * m..(left + 1) * m].fill(T::of(0.0));
        }
        self.live.copy_within(from..from + WIDTH - 1, to);
        self.live[left] = false;
        self.parted.copy_within(from..from + WIDTH - 1, to);
    }
}

/// Gradients of the components of a race's vector in a frame turned by `angle` (rad); `of` gives those in the
/// frame of the race's coordinates, `None` for held ones.
pub(super) fn turned_into<T: Number>(
    angle: f64,
    [x, y, u]: [Option<DVector<T>>; 3],
) -> [Option<DVector<T>>; 3] {
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
