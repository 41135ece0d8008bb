//! The derivative of the mesh cycle that a set marched last, computed from what its frames keep of every step.

use dynamics::{CarriedChange, MapDerivative, Number};
use faer::linalg::solvers::Solve;
use faer::{MatMut, MatRef};
use gearset::Symmetry;
use nalgebra::{DMatrix, DVector};

use super::checkpoint::replace;
use super::gradients::{Gradients, LagGradients};
use super::lag::WIDTH;
use super::set::VibratingSet;
use super::step_terms::StepTerms;
use super::tooth_shift::ToothShift;
use crate::error::FeError;

/// Stiffness (N/m) that relates forces to displacements when the coordinates are scaled.
const STIFFNESS: f64 = 1e9;

/// The lag forgets its state as e^{−t/β}: after this many β a share of 1e-10 is left.
const FORGOTTEN: f64 = 23.0;

/// Share that may be left of the forces of the last two steps, which the parabola of the lag passes through, until they
/// follow from displacements and velocities as accelerations do after one step.
const LEFT: f64 = 1e-8;

/// Most steps that are waited for that: with a longer β the compliance of the cells, which has no lag, leaves less of
/// them than the lag alone does (0.3 after a step of 10 β).
const MOST_LEFT: usize = 12;

/// The same for corrections of a state: shares of 1e-3 and 2e-3 are left.
const FORGOTTEN_ROUGHLY: f64 = 7.0;
const LEFT_ROUGHLY: f64 = 2e-3;
const MOST_LEFT_ROUGHLY: usize = 5;

/// Changes of the state at the start of a cycle whose effect at its end is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Along {
    /// Of displacements and velocities, with accelerations and lag as they follow from these within some steps.
    /// All others are gone after a cycle, so that these suffice for multipliers and for corrections of a state
    /// that was marched to.
    Motion,
    /// As [`Motion`](Self::Motion), rounded to errors of the order of 1e-4: enough for corrections of a state, not for
    /// multipliers.
    MotionRoughly,
    /// Of every coordinate by itself.
    Every,
}

/// The derivative so far.
#[derive(Debug, Clone)]
pub(super) struct SetDerivative<T> {
    /// Coordinates whose changes at the start are the rows of the gradients, and the sizes of these changes.
    active: Vec<(usize, f64)>,
    pub(super) races: Gradients<T>,
    /// Modes of carrier, ring, sun and planets.
    pub(super) elastic: Vec<Gradients<T>>,
    pub(super) meshes: Vec<LagGradients<T>>,
    pub(super) terms: StepTerms<T>,
    pub(super) work: Work<T>,
    /// Q, (active coordinates)×rows, once the rows of the gradients were compressed: the gradients with respect to
    /// the active coordinates are Q times these.
    basis: Option<DMatrix<T>>,
}

/// Gradients used within a step, kept so that steps allocate little memory; those of the races and of the touching
/// pairs, column after column, only where bodies have modes.
#[derive(Debug, Clone, Default)]
pub(super) struct Work<T> {
    pub(super) acceleration: Vec<T>,
    pub(super) velocity: Vec<T>,
    pub(super) load: Vec<T>,
    pub(super) next: Vec<T>,
    pub(super) b: Vec<T>,
    pub(super) forces: Vec<T>,
    /// Memory for the rows that pass through a step together, and for its matrices.
    pub(super) rows: Vec<T>,
    pub(super) matrices: [Vec<T>; 2],
}

/// Steps after which the rows of the gradients with respect to every coordinate are compressed.
const COMPRESSED: [usize; 2] = [6, 30];

/// Rows below this share of the largest are rounding.
const RANK: f64 = 1e-15;

impl VibratingSet<'_> {
    /// The derivative of the cycle marched last, or of the part of it after which the set is itself, which was
    /// [taken back](VibratingSet::take_cycle_back);
    /// frequencies of the motion are of the order of `rate` (rad/s).
    ///
    /// # Errors
    /// If a body's modes are not those of equal teeth.
    pub fn cycle_derivative(&mut self, along: Along, rate: f64) -> Result<MapDerivative, FeError> {
        match along {
            Along::MotionRoughly => self.cycle_derivative_in::<f32>(along, rate, None),
            Along::Motion | Along::Every => self.cycle_derivative_in::<f64>(along, rate, None),
        }
    }

    /// The same along the motion, with a change of the state carried from the start of the cycle on; it is heard of the
    /// displacements of the races.
    ///
    /// # Errors
    /// If a body's modes are not those of equal teeth, or the change has not as many numbers as the
    /// [coordinates](VibratingSet::coordinates).
    pub fn cycle_derivative_with(
        &mut self,
        rate: f64,
        change: CarriedChange<'_>,
    ) -> Result<MapDerivative, FeError> {
        self.cycle_derivative_in::<f64>(Along::Motion, rate, Some(change))
    }

    /// The derivative with gradients in the precision of T.
    fn cycle_derivative_in<T: Number>(
        &mut self,
        along: Along,
        rate: f64,
        mut change: Option<CarriedChange<'_>>,
    ) -> Result<MapDerivative, FeError> {
        let (count, cycles) = (self.clock.rotation.count(), self.clock.cycles);
        let turn = self.present_renumbering();
        let steps = turn.as_ref().map_or(count, |(own, _)| count / own.parts);
        let more = usize::from(change.is_some());
        let mut derivative: SetDerivative<T> = self.start_derivative(along, rate, more);
        let settling = match along {
            Along::Motion => Some((FORGOTTEN, LEFT, MOST_LEFT)),
            Along::MotionRoughly => Some((FORGOTTEN_ROUGHLY, LEFT_ROUGHLY, MOST_LEFT_ROUGHLY)),
            Along::Every => None,
        };
        if let Some((forgotten, left, most)) = settling {
            // In a periodic motion the steps before the start are those before the end, taken back as the end is.
            let settling = forgotten * self.race_dynamics.damping.beta / self.clock.rule.step();
            // NaN, without any lag, is no step.
            let falling = left.ln() / self.pairs.lag.left_after_step().ln();
            let falling = (falling.ceil() as usize).clamp(1, most);
            let settling = (settling.ceil() as usize + falling).min(steps);
            for step in steps - settling + 1..=steps {
                self.carry_derivative(&mut derivative, step, cycles);
            }
            derivative.turn_back(self.tooth_shifts()?, turn.as_ref());
            derivative.follow_motion(rate)?;
        }
        if let Some(change) = &change {
            derivative.set_last_row(change.start)?;
        }
        for step in 1..=steps {
            if let Some(change) = &mut change {
                (change.hear)(&derivative.last_row_of_races());
            }
            self.carry_derivative(&mut derivative, step, cycles);
            if along == Along::Every && COMPRESSED.contains(&step) {
                derivative.compress(rate);
            }
        }
        derivative.turn_back(self.tooth_shifts()?, turn.as_ref());
        Ok(derivative.map_derivative(rate))
    }

    /// Changes at the start of a step, in gradients with some `more` rows.
    fn start_derivative<T: Number>(
        &mut self,
        along: Along,
        rate: f64,
        more: usize,
    ) -> SetDerivative<T> {
        let n = self.statics.races.count;
        let unknowns: Vec<usize> = self.bodies.all().map(|(_, body)| body.unknowns()).collect();
        let mut active: Vec<(usize, f64)> = Vec::new();
        let mut leading = 0;
        for count in std::iter::once(&n).chain(&unknowns) {
            let range = |k: usize| leading + k * count..leading + (k + 1) * count;
            match along {
                Along::Motion | Along::MotionRoughly => {
                    active.extend(range(0).map(|i| (i, 1.0)));
                    active.extend(range(1).map(|i| (i, rate)));
                }
                Along::Every => {
                    for (k, size) in [1.0, rate, rate * rate].into_iter().enumerate() {
                        active.extend(range(k).map(|i| (i, size)));
                    }
                }
            }
            leading += 3 * count;
        }
        let mut live = vec![[false; WIDTH]; self.pairs.memory.len()];
        for (mesh, memory) in self.pairs.memory.iter_mut().enumerate() {
            if along != Along::Every {
                break;
            }
            let lists = memory.lists().map(|list| *list);
            for slot in 0..WIDTH {
                live[mesh][slot] = lists.iter().any(|list| list[slot] != 0.0);
            }
            for (which, list) in lists.iter().enumerate() {
                let first = leading + (3 * mesh + which) * WIDTH;
                // A force that is 0, of a pair that does not touch, stays 0 under small changes.
                let nonzero = (0..WIDTH).filter(|slot| list[*slot] != 0.0);
                active.extend(nonzero.map(|slot| (first + slot, STIFFNESS)));
            }
        }
        let m = (active.len() + more).next_multiple_of(T::MOST_LANES);
        let unit = |first: usize, count: usize| {
            let mut own = DMatrix::zeros(m, count);
            for (row, (i, size)) in active.iter().enumerate() {
                if let Some(k) = i.checked_sub(first).filter(|k| *k < count) {
                    own[(row, k)] = T::of(*size);
                }
            }
            own
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
        let own = &self.race_dynamics;
        let terms = StepTerms::new(&own.mass, &own.velocity_load(&self.clock.rule));
        let (work, basis) = (Work::default(), None);
        SetDerivative { active, races, elastic, meshes, terms, work, basis }
    }
}

impl<T: Number> SetDerivative<T> {
    /// Rows of the gradients.
    pub(super) fn rows(&self) -> usize {
        self.races.x.nrows()
    }

    /// Puts a change of all coordinates in the row after those of the active ones.
    fn set_last_row(&mut self, change: &[f64]) -> Result<(), FeError> {
        let row = self.active.len();
        replace(change, &mut |each| {
            for list in self.lists_mut() {
                let mut own: Vec<f64> = list.row(row).iter().map(|x| x.double()).collect();
                each(&mut own);
                list.row_mut(row).iter_mut().zip(own).for_each(|(x, own)| *x = T::of(own));
            }
        })?;
        self.meshes.iter_mut().for_each(|own| own.add_live(row));
        Ok(())
    }

    /// What has become of that change of the races' displacements, m.
    fn last_row_of_races(&self) -> Vec<f64> {
        self.races.x.row(self.active.len()).iter().map(|x| x.double()).collect()
    }

    /// All gradients in the order of the coordinates, each list with the size of its quantities beside that of a
    /// displacement.
    fn lists(&self, rate: f64) -> Vec<(&DMatrix<T>, f64)> {
        let mut lists: Vec<(&DMatrix<T>, f64)> = Vec::new();
        for own in std::iter::once(&self.races).chain(&self.elastic) {
            lists.extend([(&own.x, 1.0), (&own.v, rate), (&own.a, rate * rate)]);
        }
        for mesh in &self.meshes {
            lists.extend(mesh.lists().iter().map(|list| (list, STIFFNESS)));
        }
        lists
    }

    /// The same, to be changed.
    fn lists_mut(&mut self) -> impl Iterator<Item = &mut DMatrix<T>> {
        let bodies = std::iter::once(&mut self.races).chain(&mut self.elastic);
        let meshes = self.meshes.iter_mut().flat_map(LagGradients::lists_mut);
        bodies.flat_map(Gradients::lists_mut).chain(meshes)
    }

    /// Hands over the columns of what follows from displacements and velocities: of accelerations, and of the lag of
    /// pairs that have gradients.
    fn following_columns_mut(&mut self, of: &mut dyn FnMut(&mut [T])) {
        let m = self.rows().max(1);
        for own in std::iter::once(&mut self.races).chain(&mut self.elastic) {
            own.a.as_mut_slice().chunks_exact_mut(m).for_each(&mut *of);
        }
        self.meshes.iter_mut().flat_map(LagGradients::live_columns_mut).for_each(of);
    }

    /// Expresses the gradients of the bodies' modes in the frames one tooth back, or renumbers the planets.
    fn turn_back(
        &mut self,
        shifts: &[Option<ToothShift>],
        turn: Option<&(Symmetry, DMatrix<f64>)>,
    ) {
        if let Some((own, turn)) = turn {
            let transposed = turn.transpose().map(T::of);
            self.races.lists_mut().into_iter().for_each(|list| *list *= &transposed);
            let planets = self.meshes.len() / 2;
            // Each mesh takes the place of one other.
            let mut meshes: Vec<_> = self.meshes.drain(..).map(Some).collect();
            let turned =
                (0..2 * planets).filter_map(|mesh| meshes[own.later(mesh, planets)].take());
            self.meshes = turned.collect();
            return;
        }
        for (own, shift) in self.elastic.iter_mut().zip(shifts) {
            if let Some(shift) = shift {
                let shift = shift.transposed().map(T::of);
                own.lists_mut().into_iter().for_each(|list| *list *= &shift);
            }
        }
    }

    /// Replaces the changes by those combinations of them of which each changes one displacement or velocity now by
    /// its size.
    fn follow_motion(&mut self, rate: f64) -> Result<(), FeError> {
        let (m, n) = (self.rows(), self.active.len());
        let mut now = DMatrix::zeros(n, n);
        let mut at = 0;
        for own in std::iter::once(&mut self.races).chain(&mut self.elastic) {
            for (list, size) in [(&mut own.x, 1.0), (&mut own.v, rate)] {
                let count = list.ncols();
                let changes = list.rows(0, n).map(|x| x.double() / size);
                now.columns_mut(at, count).copy_from(&changes);
                list.fill(T::of(0.0));
                (0..count).for_each(|k| list[(at + k, k)] = T::of(size));
                at += count;
            }
        }
        let mut columns = Vec::new();
        self.following_columns_mut(&mut |own| columns.extend(own.iter().map(|x| x.double())));
        let count = columns.len() / m.max(1);
        let factor = MatRef::from_column_major_slice(now.as_slice(), n, n).partial_piv_lu();
        let all = MatMut::from_column_major_slice_mut(&mut columns, m, count);
        factor.solve_in_place(all.subrows_mut(0, n));
        if !columns.iter().all(|x| x.is_finite()) {
            return Err(FeError::NoEquilibrium("motions that differ become equal".into()));
        }
        let mut solved = columns.chunks_exact(m.max(1));
        self.following_columns_mut(&mut |own| {
            let solved = solved.next().into_iter().flatten();
            own.iter_mut().zip(solved).for_each(|(own, x)| *own = T::of(*x));
        });
        Ok(())
    }

    /// Replaces the rows by fewer: with G the gradients and D the sizes of their columns, G D⁻¹ Π = Q R, of which
    /// only the rows of R above rounding are kept.
    fn compress(&mut self, rate: f64) {
        let mut columns: Vec<(DVector<f64>, f64)> = Vec::new();
        for (list, size) in self.lists(rate) {
            let nonzero =
                list.column_iter().filter(|column| column.iter().any(|x| *x != T::of(0.0)));
            columns.extend(nonzero.map(|column| (column.map(Number::double), size)));
        }
        let m = self.rows();
        let scaled = faer::Mat::from_fn(m, columns.len(), |i, j| columns[j].0[i] / columns[j].1);
        let qr = scaled.col_piv_qr();
        let r = qr.thin_R();
        let size = r.nrows().min(r.ncols());
        let largest = if size > 0 { r[(0, 0)].abs() } else { 0.0 };
        let rank = (0..size).take_while(|k| r[(*k, *k)].abs() > RANK * largest).count();
        // NaN, which is reported at the end, has no rank.
        let left = rank.next_multiple_of(T::MOST_LANES);
        if rank == 0 || left == m {
            return;
        }
        let q = qr.compute_thin_Q();
        let q = DMatrix::from_fn(m, left, |i, j| T::of(if j < rank { q[(i, j)] } else { 0.0 }));
        let transposed = q.transpose();
        self.lists_mut().for_each(|list| *list = &transposed * &*list);
        self.basis = Some(match self.basis.take() {
            Some(basis) => basis * q,
            None => q,
        });
    }

    /// The derivative of the map from the start to now.
    fn map_derivative(&self, rate: f64) -> MapDerivative {
        let lists = self.lists(rate);
        let count = lists.iter().map(|(list, _)| list.ncols()).sum();
        let n = self.active.len();
        let back = self.basis.as_ref().map(|basis| basis.rows(0, n).map(Number::double));
        let mut scales = Vec::with_capacity(count);
        // Gradients that are not 0, each with the row that it becomes.
        let mut nonzero: Vec<(usize, DVector<f64>)> = Vec::new();
        for (list, scale) in lists {
            for column in list.column_iter() {
                if column.as_slice().iter().any(|x| *x != T::of(0.0)) {
                    let own = column.map(Number::double);
                    let own = match &back {
                        Some(basis) => basis * own,
                        None => own,
                    };
                    nonzero.push((scales.len(), own));
                }
                scales.push(scale);
            }
        }
        let mut columns = DMatrix::zeros(count, n);
        for (j, (_, size)) in self.active.iter().enumerate() {
            let own = &mut columns.as_mut_slice()[j * count..(j + 1) * count];
            match *size {
                1.0 => nonzero.iter().for_each(|(row, gradient)| own[*row] = gradient[j]),
                size => nonzero.iter().for_each(|(row, gradient)| own[*row] = gradient[j] / size),
            }
        }
        MapDerivative { active: self.active.iter().map(|(i, _)| *i).collect(), columns, scales }
    }
}
