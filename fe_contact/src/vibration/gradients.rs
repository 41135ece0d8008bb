//! Gradients of a set's state: in place of each number, a column with its derivatives with respect to the
//! coordinates at the start.

use nalgebra::{DMatrix, DVector, DVectorView};

use super::lag::WIDTH;

/// Gradients of some coordinates: a row for each coordinate at the start, a column for each quantity.
#[derive(Debug, Clone)]
pub(super) struct Gradients {
    /// Of displacements.
    pub(super) x: DMatrix<f64>,
    /// Of velocities.
    pub(super) v: DMatrix<f64>,
    /// Of accelerations.
    pub(super) a: DMatrix<f64>,
}

impl Gradients {
    /// Those of a* and v* of Newmark's rule, with 4/h² and 2/h.
    pub(super) fn histories(&self, inertia: f64, rate: f64) -> [DMatrix<f64>; 2] {
        let velocity = &self.x * rate + &self.v;
        let mut acceleration = &self.x * inertia + &self.a;
        acceleration.zip_apply(&self.v, |a, v| *a += 2.0 * rate * v);
        [acceleration, velocity]
    }

    /// The end of a step with displacements `x` from the histories at its start.
    pub(super) fn advance(
        &mut self,
        [inertia, rate]: [f64; 2],
        x: DMatrix<f64>,
        histories: [DMatrix<f64>; 2],
    ) {
        let [acceleration, velocity] = histories;
        self.v = &x * rate - velocity;
        self.a = &x * inertia - acceleration;
        self.x = x;
    }
}

/// Gradients of the lag of one mesh: of P̃, of the forces at the end of the last step, and of those one step
/// earlier.
#[derive(Debug, Clone)]
pub(super) struct LagGradients {
    lists: [DMatrix<f64>; 3],
    /// Pairs with gradients other than zero.
    live: [bool; WIDTH],
    /// Of the part of P̃ at the end of the step that is known at its start.
    known: DMatrix<f64>,
}

impl LagGradients {
    pub(super) fn new(lists: [DMatrix<f64>; 3], live: [bool; WIDTH]) -> Self {
        let known = DMatrix::zeros(lists[0].nrows(), WIDTH);
        Self { lists, live, known }
    }

    pub(super) fn lists(&self) -> &[DMatrix<f64>; 3] {
        &self.lists
    }

    pub(super) fn lists_mut(&mut self) -> &mut [DMatrix<f64>; 3] {
        &mut self.lists
    }

    pub(super) fn is_live(&self, slot: usize) -> bool {
        self.live[slot]
    }

    /// Starts a step: computes the part of P̃ at its end that is known, as in
    /// [`PairMemory::known`](super::lag::PairMemory::known).
    pub(super) fn predict(&mut self, [_, start, before, state]: [f64; 4]) {
        let [filtered, now, earlier] = &self.lists;
        if self.known.nrows() != filtered.nrows() {
            self.known = DMatrix::zeros(filtered.nrows(), WIDTH);
        }
        for slot in (0..WIDTH).filter(|slot| self.live[*slot]) {
            let mut known = self.known.column_mut(slot);
            known.axpy(state, &filtered.column(slot), 0.0);
            known.axpy(start, &now.column(slot), 1.0);
            known.axpy(before, &earlier.column(slot), 1.0);
        }
    }

    /// The known part of a live pair.
    pub(super) fn known(&self, slot: usize) -> DVectorView<'_, f64> {
        self.known.column(slot)
    }

    /// Advances by a step at whose end the pairs `pressed` (slot, column of `forces`) have forces.
    pub(super) fn advance(&mut self, end: f64, pressed: &[(usize, usize)], forces: &DMatrix<f64>) {
        for slot in 0..WIDTH {
            let force = pressed.iter().find(|(own, _)| *own == slot).map(|(_, column)| *column);
            if !self.live[slot] && force.is_none() {
                continue;
            }
            let [filtered, now, before] = &mut self.lists;
            if std::mem::replace(&mut self.live[slot], true) {
                filtered.column_mut(slot).copy_from(&self.known.column(slot));
            }
            before.column_mut(slot).copy_from(&now.column(slot));
            match force {
                Some(column) => {
                    filtered.column_mut(slot).axpy(end, &forces.column(column), 1.0);
                    now.column_mut(slot).copy_from(&forces.column(column));
                }
                None => now.column_mut(slot).fill(0.0),
            }
        }
    }

    /// The mesh starts a new cycle: what was pair k is pair k + 1.
    pub(super) fn move_on(&mut self) {
        for list in &mut self.lists {
            for slot in (1..WIDTH).rev() {
                let (left, mut right) = list.columns_range_pair_mut(slot - 1, slot);
                right.copy_from(&left);
            }
            list.column_mut(0).fill(0.0);
        }
        self.live.copy_within(0..WIDTH - 1, 1);
        self.live[0] = false;
    }
}

/// Gradients of the components of a race's vector in a frame turned by `angle` (rad); `of` gives those in the
/// frame of the race's coordinates, `None` for held ones.
pub(super) fn turned_into(
    angle: f64,
    of: impl Fn(usize) -> Option<DVector<f64>>,
) -> [Option<DVector<f64>>; 3] {
    let [x, y, u] = [of(0), of(1), of(2)];
    let (sin, cos) = angle.sin_cos();
    let sum = |a: Option<DVector<f64>>, b: Option<DVector<f64>>| match (a, b) {
        (Some(a), Some(b)) => Some(a + b),
        (a, b) => a.or(b),
    };
    let scaled = |v: &Option<DVector<f64>>, factor: f64| v.as_ref().map(|v| v * factor);
    [sum(scaled(&x, cos), scaled(&y, sin)), sum(scaled(&x, -sin), scaled(&y, cos)), u]
}

/// The inverse of [`turned_into`] for all three components.
pub(super) fn out_of_turned(angle: f64, [x, y, u]: [DVector<f64>; 3]) -> [DVector<f64>; 3] {
    let (sin, cos) = angle.sin_cos();
    [&x * cos - &y * sin, &x * sin + &y * cos, u]
}
