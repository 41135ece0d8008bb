//! Whole mesh cycles of all displacements and mesh forces, sampled at every step.

use dynamics::{Window, spectrum};
use gearset::Symmetry;

use super::error::SweepError;
use super::marching::Marching;
use super::set_shape::SetShape;

/// Samples by rows: three displacements of every body (carrier, ring, sun, planets: radial,
/// tangential, m; rotation, rad), then the forces of sun meshes and ring meshes (N).
///
/// The first sample is the state the cycle starts from, so that phases count from position 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Record {
    shape: SetShape,
    samples: Vec<f64>,
    forces: Vec<f64>,
    /// Whether backside flanks of each mesh (sun meshes, ring meshes) pressed, by rows as the samples.
    backside: Vec<bool>,
    /// Whether the model has backside flanks.
    has_backside: bool,
}

/// Channels of the sun: x, y, rotation.
pub(super) const SUN: [usize; 3] = [6, 7, 8];
/// The same of the ring and of the carrier.
pub(super) const RING: [usize; 3] = [3, 4, 5];
pub(super) const CARRIER: [usize; 3] = [0, 1, 2];

/// Displacements of carrier, ring and sun with x and y turned to radial (towards planet 0, at ψ₀) and tangential.
pub(super) fn radial(central: [[f64; 3]; 3], first_planet_rad: f64) -> [[f64; 3]; 3] {
    let (sin, cos) = first_planet_rad.sin_cos();
    central.map(|[x, y, theta]| [cos * x + sin * y, cos * y - sin * x, theta])
}

impl Record {
    /// An empty record of a set of N planets or of another shape.
    pub fn new(shape: impl Into<SetShape>) -> Self {
        Self { shape: shape.into(), ..Self::default() }
    }

    /// Number of planets, and whether there are ring meshes.
    pub fn shape(&self) -> SetShape {
        self.shape
    }

    /// Bodies: carrier, ring, sun, planets.
    pub fn bodies(&self) -> usize {
        3 + self.shape.planets
    }

    /// Channels of displacements.
    pub fn displacements(&self) -> usize {
        3 * self.bodies()
    }

    /// All channels.
    pub fn width(&self) -> usize {
        self.displacements() + self.shape.meshes()
    }

    /// Samples.
    pub fn len(&self) -> usize {
        self.samples.len() / self.width().max(1)
    }

    /// Whether the record has no samples.
    pub fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// Appends the present state; x and y of the central members are rotated by ψ₀ to radial (towards
    /// planet 0) and tangential.
    fn take(&mut self, set: &dyn Marching, first_planet_rad: f64) {
        let (central, planets) = set.displacements();
        self.samples.extend(radial(central, first_planet_rad).iter().flatten());
        self.samples.extend(planets.iter().flatten());
        set.mesh_forces(&mut self.forces);
        let fronts = self.shape.meshes();
        self.samples.extend(self.forces.iter().take(fronts));
        let behind = self.forces.get(fronts..).unwrap_or_default();
        self.backside.extend((0..fronts).map(|mesh| behind.get(mesh).is_some_and(|f| *f > 0.0)));
    }

    /// Records `steps` time steps from the present state on.
    ///
    /// # Errors
    /// As [`Marching::step`].
    pub fn march(
        &mut self,
        set: &mut dyn Marching,
        first_planet_rad: f64,
        steps: usize,
    ) -> Result<(), SweepError> {
        self.march_and(set, first_planet_rad, steps, &mut |_, _| ())
    }

    /// The same; `after` is called after every step with its number from 0.
    ///
    /// # Errors
    /// As [`Marching::step`].
    pub(super) fn march_and(
        &mut self,
        set: &mut dyn Marching,
        first_planet_rad: f64,
        steps: usize,
        after: &mut dyn FnMut(&mut dyn Marching, usize),
    ) -> Result<(), SweepError> {
        self.samples.clear();
        self.backside.clear();
        self.has_backside = set.has_backside();
        for step in 0..steps {
            self.take(set, first_planet_rad);
            set.step()?;
            after(set, step);
        }
        Ok(())
    }

    /// Mean of the `cycles` mesh cycles of a record, sample by sample: its harmonics are those of the whole record at
    /// multiples of the mesh frequency.
    pub(crate) fn mean_cycle(&self, cycles: usize) -> Self {
        let length = self.samples.len() / cycles.max(1);
        let mut mean = Self { samples: vec![0.0; length], ..self.clone() };
        for cycle in self.samples.chunks(length.max(1)).take(cycles) {
            let sums = mean.samples.iter_mut().zip(cycle);
            sums.for_each(|(sum, x)| *sum += x / cycles as f64);
        }
        mean.backside.truncate(self.backside.len() / cycles.max(1));
        mean
    }

    /// The record with changes of the displacements, sample by sample; forces and backside flanks as they are.
    pub(super) fn changed_by(&self, changes: &[f64]) -> Self {
        let (width, displacements) = (self.width().max(1), self.displacements().max(1));
        let mut changed = self.clone();
        let rows = changed.samples.chunks_mut(width).zip(changes.chunks(displacements));
        rows.for_each(|(row, own)| row.iter_mut().zip(own).for_each(|(x, change)| *x += change));
        changed
    }

    /// Appends the samples of a record of the same set that follows this one in time.
    pub(crate) fn append(&mut self, next: Record) {
        self.samples.extend(next.samples);
        self.backside.extend(next.backside);
        self.has_backside = next.has_backside;
    }

    /// The whole cycle of which this is the first part, of a set that is itself after every part.
    pub(super) fn of_whole_cycle(self, symmetry: &Symmetry) -> Self {
        let (planets, width, parts) = (self.shape.planets, self.width(), symmetry.parts);
        let mut whole = Self {
            samples: Vec::with_capacity(parts * self.samples.len()),
            backside: Vec::with_capacity(parts * self.backside.len()),
            forces: Vec::new(),
            ..self
        };
        for part in 0..parts {
            let (sin, cos) = (part as f64 * symmetry.angle_rad).sin_cos();
            // What planet n does now, planet n + shift does in the next part.
            let from = |n: usize| (n + part * (planets - symmetry.shift)) % planets;
            let mesh = |m: usize| m / planets * planets + from(m % planets);
            for row in self.samples.chunks(width) {
                for body in 0..3 {
                    let [x, y, theta] = [0, 1, 2].map(|axis| row[3 * body + axis]);
                    whole.samples.extend([cos * x - sin * y, sin * x + cos * y, theta]);
                }
                for planet in 0..planets {
                    let first = 3 * (3 + from(planet));
                    whole.samples.extend(&row[first..first + 3]);
                }
                let forces = &row[self.displacements()..];
                whole.samples.extend((0..2 * planets).map(|m| forces[mesh(m)]));
            }
            for row in self.backside.chunks(2 * planets.max(1)) {
                whole.backside.extend((0..2 * planets).map(|m| row[mesh(m)]));
            }
        }
        whole
    }

    /// Forces of one mesh (sun meshes 0 to N−1, ring meshes N to 2N−1, none of a pair) in order of time, N.
    pub fn mesh_force(&self, mesh: usize) -> Vec<f64> {
        self.channel(self.displacements() + mesh)
    }

    /// Share of the samples, 0 to 1, in which backside flanks press: of one mesh (numbered as in
    /// [`mesh_force`](Self::mesh_force)), or for `None` of any mesh. `None` if the model has no backside
    /// flanks.
    pub fn backside_share(&self, mesh: Option<usize>) -> Option<f64> {
        let presses = |row: &&[bool]| match mesh {
            Some(mesh) => row.get(mesh).copied().unwrap_or(false),
            None => row.contains(&true),
        };
        let rows = self.backside.chunks(self.shape.meshes().max(1));
        let share = rows.filter(presses).count() as f64 / self.len().max(1) as f64;
        self.has_backside.then_some(share)
    }

    /// Largest sample of one channel less its smallest.
    pub fn range(&self, channel: usize) -> f64 {
        let own = self.channel(channel);
        let high = own.iter().fold(f64::NEG_INFINITY, |a, x| a.max(*x));
        high - own.iter().fold(f64::INFINITY, |a, x| a.min(*x))
    }

    /// Samples of one channel.
    pub fn channel(&self, channel: usize) -> Vec<f64> {
        self.samples.iter().skip(channel).step_by(self.width()).copied().collect()
    }

    /// `[eq:steady-state]` Largest change from an earlier record of the same length, relative to the largest
    /// peak-to-peak value of all bodies: the larger of the ratios of translations and of rotations.
    ///
    /// Source: definition.
    /// Checked by: `sweep.unsteady`, `sweep.between`.
    pub fn change_from(&self, before: &Record) -> f64 {
        if before.len() != self.len() {
            return f64::INFINITY;
        }
        let width = self.width();
        // Translations, rotations: (largest change, largest peak to peak).
        let mut kinds = [(0.0f64, 0.0f64); 2];
        for channel in 0..self.displacements() {
            let (mut low, mut high, mut change) = (f64::INFINITY, f64::NEG_INFINITY, 0.0f64);
            let own = self.samples.iter().skip(channel).step_by(width);
            let earlier = before.samples.iter().skip(channel).step_by(width);
            for (a, b) in own.zip(earlier) {
                (low, high) = (low.min(*a), high.max(*a));
                change = change.max((a - b).abs());
            }
            let kind = &mut kinds[usize::from(channel % 3 == 2)];
            *kind = (kind.0.max(change), kind.1.max(high - low));
        }
        let ratio = |(change, size): (f64, f64)| if change == 0.0 { 0.0 } else { change / size };
        ratio(kinds[0]).max(ratio(kinds[1]))
    }

    /// Largest change over `later` of the `cycles` mesh cycles of a record, relative as in
    /// [`change_from`](Self::change_from).
    pub(super) fn change_after(&self, later: usize, cycles: usize) -> f64 {
        let ahead = later * self.samples.len() / cycles.max(1);
        let [from, to] = [&self.samples[..self.samples.len() - ahead], &self.samples[ahead..]];
        let part = |samples: &[f64]| Self { samples: samples.to_vec(), ..self.clone() };
        part(to).change_from(&part(from))
    }

    /// Largest peak-to-peak value of all translations (m) and of all rotations (rad).
    pub(super) fn sizes(&self) -> [f64; 2] {
        let count = self.displacements();
        let mut ranges = vec![(f64::INFINITY, f64::NEG_INFINITY); count];
        for row in self.samples.chunks_exact(self.width().max(1)) {
            for ((low, high), x) in ranges.iter_mut().zip(row) {
                (*low, *high) = (low.min(*x), high.max(*x));
            }
        }
        let mut sizes = [0.0f64; 2];
        for (channel, (low, high)) in ranges.into_iter().enumerate() {
            let own = &mut sizes[usize::from(channel % 3 == 2)];
            *own = own.max(high - low);
        }
        sizes
    }

    /// Distance to grazing: the least of lowest over mean force of the meshes that never part, 0 where one is about to;
    /// `None` if all meshes part.
    pub fn grazing_margin(&self) -> Option<f64> {
        let margin = |mesh: usize| {
            let force = self.mesh_force(mesh);
            let lowest = force.iter().copied().fold(f64::INFINITY, f64::min);
            let mean = force.iter().sum::<f64>() / force.len().max(1) as f64;
            (lowest > 0.0).then(|| lowest / mean)
        };
        (0..self.shape().meshes()).filter_map(margin).min_by(f64::total_cmp)
    }

    /// `[eq:harmonics-of-a-record]` Complex amplitudes of the harmonics 0 to `harmonics` of one channel, from a
    /// record of `cycles` mesh cycles: x(t) ≈ Re Σ X_l e^{i 2π l f_m t}, as real and imaginary parts.
    ///
    /// Source: definition.
    /// Checked by: `sweep.static_limit`,
    /// `dynamics/src/spectrum.rs::a_sine_of_whole_periods_gives_its_amplitude_and_phase`.
    ///
    /// # Errors
    /// If the record is too short or not finite.
    pub fn harmonics(
        &self,
        channel: usize,
        cycles: usize,
        harmonics: usize,
    ) -> Result<Vec<[f64; 2]>, SweepError> {
        let lines = spectrum(&self.channel(channel), 1.0, Window::Rectangular, 1)?.lines;
        let at = |l: usize| lines.get(l * cycles).map_or([0.0; 2], |x| [x.re, x.im]);
        Ok((0..=harmonics).map(at).collect())
    }

    /// Share of the vibration's energy (sum of squared amplitudes of all lines but the mean) that lies
    /// between mesh harmonics, from a record of `cycles` mesh cycles: the larger of the shares of
    /// translations and of rotations.
    ///
    /// # Errors
    /// If the record is too short or not finite.
    pub fn between_harmonics(&self, cycles: usize) -> Result<f64, SweepError> {
        let mut kinds = [(0.0f64, 0.0f64); 2];
        for channel in 0..self.displacements() {
            let lines = spectrum(&self.channel(channel), 1.0, Window::Rectangular, 1)?.lines;
            let kind = &mut kinds[usize::from(channel % 3 == 2)];
            for (j, x) in lines.iter().enumerate().skip(1) {
                let energy = x.re * x.re + x.im * x.im;
                kind.1 += energy;
                if j % cycles != 0 {
                    kind.0 += energy;
                }
            }
        }
        let ratio = |(between, all): (f64, f64)| if between == 0.0 { 0.0 } else { between / all };
        Ok(ratio(kinds[0]).max(ratio(kinds[1])))
    }
}
