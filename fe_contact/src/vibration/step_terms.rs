//! Factors of a step over which gradients are carried, made once for all rows and in their precision.

use dynamics::Number;
use nalgebra::DMatrix;

use super::combination::Combination;
use super::frame::{Frame, FrameBend};
use super::gradients::{LagEnd, LagGradients};
use super::lag::WIDTH;
use crate::short_row::ShortRow;

/// Factors of a step: of n coordinates of the races, and of the pairs that touch at its end.
#[derive(Debug, Clone, Default)]
pub(super) struct StepTerms<T> {
    /// Of each coordinate, its mass (kg), and where its entries in `damping` end.
    pub(super) races: Vec<(T, usize)>,
    /// Load on the races by v*, N s/m: entries of each coordinate, as column and value.
    pub(super) damping: Vec<(usize, T)>,
    /// Of each touching pair, where its entries in `entries` end.
    pub(super) pairs: Vec<usize>,
    /// Entries of R of the touching pairs, as coordinate and value.
    pub(super) entries: Vec<(usize, T)>,
    /// Touching pairs of each group that E couples.
    pub(super) groups: Vec<usize>,
    pub(super) bends: Vec<BendTerms<T>>,
    pub(super) lags: Vec<LagTerms>,
    /// −F between pairs: touching pair and value, m/N.
    pub(super) lagging: Vec<(usize, T)>,
    /// Touching pair of each pair of the frame.
    pub(super) touching_of: Vec<Option<usize>>,
}

/// The second-order term of a corner gap.
#[derive(Debug, Clone)]
pub(super) struct BendTerms<T> {
    /// Entries of its row, and how many there are.
    pub(super) row: [(usize, T); ShortRow::MOST],
    pub(super) count: usize,
    pub(super) load: Option<BendLoad<T>>,
    /// Touching pair whose gap it opens, and −G'' Δe.
    pub(super) gap: Option<(usize, T)>,
}

/// Load on the races by such a term.
#[derive(Debug, Clone)]
pub(super) struct BendLoad<T> {
    /// G'' P, N/m.
    pub(super) stiffness: T,
    /// G'' Δe.
    pub(super) share: T,
    /// Mesh and slot of the pair whose force P is, if its lag is kept.
    pub(super) pair: Option<(usize, usize)>,
}

/// The lag of one pair.
#[derive(Debug, Clone)]
pub(super) struct LagTerms {
    pub(super) mesh: usize,
    pub(super) slot: usize,
    /// Whether the state at the start has gradients.
    pub(super) is_live: bool,
    /// Where its entries in `lagging` end.
    pub(super) lagging: usize,
    pub(super) end: LagEnd,
}

/// Entries of a row, and how many there are.
fn rounded_row<T: Number>(row: &ShortRow) -> ([(usize, T); ShortRow::MOST], usize) {
    let mut own = [(0, T::of(0.0)); ShortRow::MOST];
    own.iter_mut().zip(row.terms()).for_each(|(own, (i, r))| *own = (i, T::of(r)));
    (own, row.count())
}

impl<T: Number> StepTerms<T> {
    /// Of races with masses (n, kg) and the load by v* (n×n, N s/m); of no step yet.
    pub(super) fn new(mass: &[f64], damping: &DMatrix<f64>) -> Self {
        let mut own = Self::default();
        for (mass, row) in mass.iter().zip(damping.row_iter()) {
            let entries = row.iter().enumerate().filter(|(_, c)| **c != 0.0);
            own.damping.extend(entries.map(|(j, c)| (j, T::of(*c))));
            own.races.push((T::of(*mass), own.damping.len()));
        }
        own
    }

    /// Touching pair of a pair of the frame.
    pub(super) fn touching(&self, pair: usize) -> Option<usize> {
        self.touching_of[pair]
    }

    /// Number of touching pairs.
    pub(super) fn count(&self) -> usize {
        self.pairs.len()
    }

    /// Becomes those of the last step to a frame; `plain` is the frame without backside flanks at this position.
    pub(super) fn prepare(
        &mut self,
        frame: &Frame,
        plain: &Frame,
        meshes: &mut [LagGradients<T>],
        forgotten: usize,
    ) {
        let chosen = &frame.combinations[frame.used];
        self.prepare_contact(frame, chosen);
        self.bends.clear();
        let is_same = std::ptr::eq(frame, plain);
        for bend in plain.bends.iter().filter(|_| !is_same) {
            self.add_bend(bend, [true, false]);
        }
        for bend in &frame.bends {
            self.add_bend(bend, [is_same, true]);
        }
        self.prepare_lags(frame, meshes, forgotten);
    }

    fn prepare_contact(&mut self, frame: &Frame, chosen: &Combination) {
        self.touching_of.clear();
        self.touching_of.resize(frame.offsets.len(), None);
        self.pairs.clear();
        self.entries.clear();
        for (at, pair) in chosen.touching().iter().enumerate() {
            self.touching_of[*pair] = Some(at);
            self.entries.extend(frame.rows()[*pair].entries().map(|(i, r)| (i, T::of(r))));
            self.pairs.push(self.entries.len());
        }
        self.groups.clear();
        self.groups.extend_from_slice(chosen.groups());
    }

    fn add_bend(&mut self, bend: &FrameBend, [loads, opens]: [bool; 2]) {
        let share = bend.curvature * bend.moved;
        let load = (loads && bend.force > 0.0).then(|| BendLoad {
            stiffness: T::of(bend.curvature * bend.force),
            share: T::of(share),
            pair: bend.slot.place().map(|slot| (bend.mesh, slot)),
        });
        let touching = self.touching_of.get(bend.pair).copied().flatten();
        let gap = touching.filter(|_| opens).map(|at| (at, T::of(-share)));
        if load.is_some() || gap.is_some() {
            let (row, count) = rounded_row(&bend.row);
            self.bends.push(BendTerms { row, count, load, gap });
        }
    }

    fn prepare_lags(&mut self, frame: &Frame, meshes: &mut [LagGradients<T>], forgotten: usize) {
        self.lags.clear();
        self.lagging.clear();
        let mut columns = frame.lags();
        for ((mesh, own), of) in meshes.iter_mut().enumerate().zip(&frame.meshes) {
            let rows = frame.lagged_by(of);
            // Pairs with a lag that are not in the frame have no force.
            let mut left = own.live();
            let slots = &frame.pattern.slots[of.first..of.first + of.count];
            for (pair, slot) in slots.iter().enumerate() {
                let column;
                (column, columns) = columns.split_at(rows.len());
                let Some(slot) = slot.place() else { continue };
                let is_live = std::mem::take(&mut left[slot]);
                let touching = self.touching_of[of.first + pair];
                let Some(end) = own.end(slot, touching, forgotten) else { continue };
                if is_live {
                    for (touching, f) in self.touching_of[rows.clone()].iter().zip(column) {
                        if let Some(at) = touching.filter(|_| *f != 0.0) {
                            self.lagging.push((at, T::of(-f)));
                        }
                    }
                }
                self.lags.push(LagTerms { mesh, slot, is_live, lagging: self.lagging.len(), end });
            }
            for slot in (0..WIDTH).filter(|slot| left[*slot]) {
                if let Some(end) = own.end(slot, None, forgotten) {
                    let lagging = self.lagging.len();
                    self.lags.push(LagTerms { mesh, slot, is_live: true, lagging, end });
                }
            }
        }
    }
}
