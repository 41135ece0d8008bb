//! A set of a varied scene in the coordinates of the first one.

use dynamics::{CarriedChange, MapDerivative};
use fe_contact::vibration::Along;
use gearset::Symmetry;
use nalgebra::{DMatrix, DVector};

use super::error::SweepError;
use super::marching::{Effort, Marching};
use super::shooting::CycleDerivative;
use crate::modal::MotionKinds;

/// A set without a derivative, or whose coordinates do not determine its displacements.
const UNFIT: SweepError =
    SweepError::Incomplete("coordinates to compare with those of another value");

/// Displacements of all bodies to unit values of the first half of the coordinates, by columns: 3 (3 + N) × n.
pub(super) fn shapes(set: &mut dyn Marching) -> Result<DMatrix<f64>, SweepError> {
    let count = set.derivative().ok_or(UNFIT)?.coordinates().len();
    let n = count / 2;
    let column = |k: usize| {
        let mut y = vec![0.0; count];
        y[k] = 1.0;
        let (central, planets) = set.displacements_of(&y);
        DVector::from_iterator(
            3 * (3 + planets.len()),
            central.into_iter().chain(planets).flatten(),
        )
    };
    Ok(DMatrix::from_columns(&(0..n).map(column).collect::<Vec<_>>()))
}

/// A set whose meshes follow a law has the amplitudes of the modes of its supports as coordinates, q; with stiffness
/// and mass these modes change, and among equal frequencies they turn by any angle. Here the coordinates are those of
/// the first set:
///
/// ```text
/// P₀ q₀ = P q,   q₀ = T q,   T = P₀⁺ P,   DΦ₀ = T DΦ T⁻¹
/// ```
///
/// with P the displacements of all bodies to unit q, and the same T for displacements and velocities.
pub(super) struct FixedBasis<'s> {
    set: Box<dyn Marching + 's>,
    /// T, n×n.
    to_first: DMatrix<f64>,
    /// T⁻¹.
    from_first: DMatrix<f64>,
}

impl<'s> FixedBasis<'s> {
    /// `first`: [`shapes`] of the first set.
    ///
    /// # Errors
    /// If the sets have other coordinates.
    pub(super) fn new(
        first: &DMatrix<f64>,
        mut set: Box<dyn Marching + 's>,
    ) -> Result<Self, SweepError> {
        let own = shapes(set.as_mut())?;
        if own.shape() != first.shape() {
            return Err(UNFIT);
        }
        // Normal equations: displacements (m) and rotations (rad) are each of one size, and modes are scaled by mass.
        let gram = first.transpose() * first;
        let to_first = gram.lu().solve(&(first.transpose() * own)).ok_or(UNFIT)?;
        let from_first = to_first.clone().try_inverse().ok_or(UNFIT)?;
        Ok(Self { set, to_first, from_first })
    }

    fn own(&mut self) -> Result<&mut dyn CycleDerivative, SweepError> {
        self.set.derivative().ok_or(UNFIT)
    }
}

/// The same matrix applied to displacements and to velocities.
fn both(matrix: &DMatrix<f64>, y: &[f64]) -> Vec<f64> {
    let n = matrix.nrows();
    let halves = y.chunks(n).map(|half| matrix * DVector::from_column_slice(half));
    halves.flat_map(|half| half.iter().copied().collect::<Vec<_>>()).collect()
}

impl Marching for FixedBasis<'_> {
    fn rest(&mut self) -> Result<(), SweepError> {
        self.set.rest()
    }

    fn step(&mut self) -> Result<(), SweepError> {
        self.set.step()
    }

    fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements()
    }

    fn mesh_forces(&self, out: &mut Vec<f64>) {
        self.set.mesh_forces(out);
    }

    fn has_backside(&self) -> bool {
        self.set.has_backside()
    }

    fn effort(&self) -> Effort {
        self.set.effort()
    }

    fn state(&mut self) -> Vec<f64> {
        self.set.state()
    }

    fn counters(&self) -> usize {
        self.set.counters()
    }

    fn restore(&mut self, state: &[f64]) -> Result<(), SweepError> {
        self.set.restore(state)
    }

    fn derivative(&mut self) -> Option<&mut dyn CycleDerivative> {
        if self.set.derivative().is_some() { Some(self) } else { None }
    }

    fn kinds(&self) -> Option<MotionKinds> {
        self.set.kinds()
    }

    fn displacements_of(&self, coordinates: &[f64]) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.set.displacements_of(&both(&self.from_first, coordinates))
    }
}

impl CycleDerivative for FixedBasis<'_> {
    fn coordinates(&mut self) -> Vec<f64> {
        let own = self.set.derivative().map(|own| own.coordinates()).unwrap_or_default();
        both(&self.to_first, &own)
    }

    fn set_coordinates(&mut self, y: &[f64]) -> Result<(), SweepError> {
        let own = both(&self.from_first, y);
        self.own()?.set_coordinates(&own)
    }

    fn symmetry(&mut self) -> Result<Option<Symmetry>, SweepError> {
        self.own()?.symmetry()
    }

    fn start(&mut self) {
        if let Some(own) = self.set.derivative() {
            own.start();
        }
    }

    fn keep_step(&mut self) {
        if let Some(own) = self.set.derivative() {
            own.keep_step();
        }
    }

    fn end(&mut self) -> Result<(), SweepError> {
        self.own()?.end()
    }

    fn of_cycle(&mut self, along: Along) -> Result<MapDerivative, SweepError> {
        let own = self.own()?.of_cycle(along)?;
        Ok(self.in_first(own))
    }

    fn of_cycle_with(&mut self, change: CarriedChange<'_>) -> Result<MapDerivative, SweepError> {
        let CarriedChange { start, hear } = change;
        let (start, to_first) = (both(&self.from_first, start), self.to_first.clone());
        let hear = &mut |x: &[f64]| hear(&both(&to_first, x));
        let own = self.own()?.of_cycle_with(CarriedChange { start: &start, hear })?;
        Ok(self.in_first(own))
    }
}

impl FixedBasis<'_> {
    /// A derivative in the coordinates of the first set.
    fn in_first(&self, own: MapDerivative) -> MapDerivative {
        let (n, count) = (self.to_first.nrows(), 2 * self.to_first.nrows());
        let mut whole = DMatrix::zeros(count, count);
        for (k, active) in own.active.iter().enumerate() {
            whole.set_column(*active, &own.columns.column(k));
        }
        let doubled = |half: &DMatrix<f64>| {
            DMatrix::from_fn(count, count, |i, j| match i / n == j / n {
                true => half[(i % n, j % n)],
                false => 0.0,
            })
        };
        let columns = doubled(&self.to_first) * whole * doubled(&self.from_first);
        MapDerivative { active: (0..count).collect(), columns, scales: own.scales }
    }
}
