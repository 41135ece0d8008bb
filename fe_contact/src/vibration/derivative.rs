//! The derivative of a set's state with respect to its coordinates at the start of a mesh cycle.

use dynamics::MapDerivative;
use nalgebra::{DMatrix, DVector};

use super::gradients::{Gradients, LagGradients};
use super::lag::WIDTH;
use super::set::VibratingSet;
use super::tooth_shift::ToothShift;
use crate::error::FeError;
use crate::short_row::ShortRow;

/// Stiffness (N/m) that relates forces to displacements when the coordinates are scaled.
const STIFFNESS: f64 = 1e9;

/// The derivative so far.
#[derive(Debug, Clone)]
pub struct SetDerivative {
    /// Coordinates with columns of their own.
    pub(super) active: Vec<usize>,
    pub(super) races: Gradients,
    /// Modes of carrier, ring, sun and planets.
    pub(super) elastic: Vec<Gradients>,
    pub(super) meshes: Vec<LagGradients>,
    /// Load on the races by v*, transposed, n×n.
    pub(super) velocity_load: DMatrix<f64>,
    /// A⁻ᵀ, n×n.
    pub(super) inverse: DMatrix<f64>,
    /// Shift of the bodies' modes by one tooth, by body.
    pub(super) shifts: Vec<Option<ToothShift>>,
    /// Steps carried so far.
    pub(super) steps: usize,
    /// Q, (active coordinates)×rows, once the rows of the gradients were compressed: the gradients with respect to
    /// the active coordinates are Q times these.
    basis: Option<DMatrix<f64>>,
}

/// Steps after which the rows of the gradients are compressed: accelerations follow from the other coordinates after
/// one step, and the lag forgets its state within some.
pub(super) const COMPRESSED: [usize; 2] = [6, 30];

/// Rows below this share of the largest are rounding.
const RANK: f64 = 1e-15;

impl VibratingSet<'_> {
    /// The derivative at the start of a cycle.
    ///
    /// # Errors
    /// If a body's modes are not those of equal teeth.
    pub fn start_derivative(&mut self) -> Result<SetDerivative, FeError> {
        let n = self.statics.races.count;
        let unknowns: Vec<usize> = self.bodies.all().map(|(_, body)| body.unknowns()).collect();
        let leading = 3 * (n + unknowns.iter().sum::<usize>());
        let mut active: Vec<usize> = (0..leading).collect();
        let mut live = vec![[false; WIDTH]; self.pairs.memory.len()];
        for (mesh, memory) in self.pairs.memory.iter_mut().enumerate() {
            let lists = memory.lists().map(|list| *list);
            for slot in 0..WIDTH {
                live[mesh][slot] = lists.iter().any(|list| list[slot] != 0.0);
            }
            for (which, list) in lists.iter().enumerate() {
                let first = leading + (3 * mesh + which) * WIDTH;
                // A force that is 0, of a pair that does not touch, stays 0 under small changes.
                let nonzero = (0..WIDTH).filter(|slot| list[*slot] != 0.0);
                active.extend(nonzero.map(|slot| first + slot));
            }
        }
        let m = active.len();
        let unit = |first: usize, count: usize| {
            DMatrix::from_fn(m, count, |row, k| f64::from(u8::from(active[row] == first + k)))
        };
        let gradients = |first: usize, count: usize| Gradients {
            x: unit(first, count),
            v: unit(first + count, count),
            a: unit(first + 2 * count, count),
        };
        let mut at = 3 * n;
        let elastic = unknowns.iter().map(|count| {
            let own = gradients(at, *count);
            at += 3 * count;
            own
        });
        let elastic = elastic.collect();
        let meshes = live.into_iter().enumerate().map(|(mesh, live)| {
            let first = leading + 3 * mesh * WIDTH;
            let lists = [0, 1, 2].map(|which| unit(first + which * WIDTH, WIDTH));
            LagGradients::new(lists, live)
        });
        let meshes = meshes.collect();
        let races = gradients(0, n);
        let shifts = ToothShift::of_set(&self.bodies)?;
        let velocity_load = self.race_dynamics.velocity_load(&self.clock.rule).transpose();
        let inverse = self.race_dynamics.inverse.transpose();
        let (steps, basis) = (0, None);
        Ok(SetDerivative {
            active,
            races,
            elastic,
            meshes,
            velocity_load,
            inverse,
            shifts,
            steps,
            basis,
        })
    }
}

impl SetDerivative {
    /// Displacement along a row that is expected at the end of the step: x + h (v + ½ h a).
    pub(super) fn expected(&self, h: f64, row: &ShortRow) -> DVector<f64> {
        let mut sum = DVector::zeros(self.rows());
        for (i, r) in row.entries() {
            sum.axpy(r, &self.races.x.column(i), 1.0);
            sum.axpy(r * h, &self.races.v.column(i), 1.0);
            sum.axpy(0.5 * r * h * h, &self.races.a.column(i), 1.0);
        }
        sum
    }

    /// Rows of the gradients.
    pub(super) fn rows(&self) -> usize {
        self.races.x.nrows()
    }

    /// All gradients in the order of the coordinates, each list with the size of its quantities beside that of a
    /// displacement.
    fn lists(&self, rate: f64) -> Vec<(&DMatrix<f64>, f64)> {
        let mut lists: Vec<(&DMatrix<f64>, f64)> = Vec::new();
        for own in std::iter::once(&self.races).chain(&self.elastic) {
            lists.extend([(&own.x, 1.0), (&own.v, rate), (&own.a, rate * rate)]);
        }
        for mesh in &self.meshes {
            lists.extend(mesh.lists().iter().map(|list| (list, STIFFNESS)));
        }
        lists
    }

    /// Replaces the rows by fewer: with G the gradients and D the sizes of their columns, G D⁻¹ Π = Q R, of which
    /// only the rows of R above rounding are kept.
    pub(super) fn compress(&mut self, rate: f64) {
        let mut columns: Vec<(DVector<f64>, f64)> = Vec::new();
        for (list, size) in self.lists(rate) {
            let nonzero = list.column_iter().filter(|column| column.iter().any(|x| *x != 0.0));
            columns.extend(nonzero.map(|column| (column.into_owned(), size)));
        }
        let m = self.rows();
        let scaled = faer::Mat::from_fn(m, columns.len(), |i, j| columns[j].0[i] / columns[j].1);
        let qr = scaled.col_piv_qr();
        let r = qr.thin_R();
        let size = r.nrows().min(r.ncols());
        let largest = if size > 0 { r[(0, 0)].abs() } else { 0.0 };
        let rank = (0..size).take_while(|k| r[(*k, *k)].abs() > RANK * largest).count();
        // NaN, which is reported at the end, has no rank.
        if rank == 0 || rank == m {
            return;
        }
        let q = qr.compute_thin_Q();
        let q = DMatrix::from_fn(m, rank, |i, j| q[(i, j)]);
        let transposed = q.transpose();
        let reduce = |list: &mut DMatrix<f64>| *list = &transposed * &*list;
        for own in std::iter::once(&mut self.races).chain(&mut self.elastic) {
            [&mut own.x, &mut own.v, &mut own.a].into_iter().for_each(reduce);
        }
        for mesh in &mut self.meshes {
            mesh.lists_mut().iter_mut().for_each(reduce);
        }
        self.basis = Some(match self.basis.take() {
            Some(basis) => basis * q,
            None => q,
        });
    }

    /// The derivative of the map from the start to now; frequencies of the motion are of the order of `rate`
    /// (rad/s).
    pub fn map_derivative(&self, rate: f64) -> MapDerivative {
        let lists = self.lists(rate);
        let count = lists.iter().map(|(list, _)| list.ncols()).sum();
        let mut columns = DMatrix::zeros(count, self.rows());
        let mut scales = Vec::with_capacity(count);
        for (list, scale) in lists {
            for column in list.column_iter() {
                columns.row_mut(scales.len()).tr_copy_from(&column);
                scales.push(scale);
            }
        }
        if let Some(basis) = &self.basis {
            columns *= basis.transpose();
        }
        MapDerivative { active: self.active.clone(), columns, scales }
    }
}
