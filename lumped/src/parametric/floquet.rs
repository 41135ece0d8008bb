//! Floquet multipliers of a set with prescribed mesh stiffness, exact between switches.

use std::f64::consts::TAU;

use nalgebra::DMatrix;

use dynamics::{MapDerivative, Multiplier, generalized_symmetric, multipliers};
use gearset::{MeshStart, Phasing};
use scene::Scene;

use super::mesh_wave::MeshWave;
use super::tongues::Tongue;
use crate::error::LumpedError;
use crate::model::LumpedModel;
use crate::springs::{Spring, SpringId};

/// |μ| above 1 by more than this is growth: multipliers of a stable set without damping lie on the unit circle, and
/// nearly double ones leave it by the square root of rounding.
const GROWS: f64 = 1e-6;

/// Eigenvalues of K̃ below this share of the largest are rigid-body motion.
const RIGID: f64 = 1e-12;

/// A set whose mesh stiffnesses follow prescribed waves.
#[derive(Debug, Clone)]
pub struct ParametricSet {
    model: LumpedModel,
    /// k_i and b_i of sun meshes, then ring meshes.
    meshes: Vec<(f64, Vec<(usize, f64)>)>,
    waves: Vec<MeshWave>,
    epsilon: f64,
    stretches: Vec<Stretch>,
}

/// Part of a mesh cycle with constant stiffness.
#[derive(Debug, Clone)]
struct Stretch {
    /// Its part of the cycle.
    part: f64,
    /// ω of the modes at this stiffness, rad/s; 0 for rigid-body motion.
    omega: Vec<f64>,
    /// Q, columns in the order of ω.
    q: DMatrix<f64>,
}

/// Borders of a tongue in mesh frequency, Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TongueEdges {
    /// Lower border.
    pub low_hz: f64,
    /// Upper border.
    pub high_hz: f64,
    /// Largest growth rate found between them, 1/s.
    pub growth_per_s: f64,
}

impl ParametricSet {
    /// With waves for all sun meshes, then all ring meshes, and ε, half of the peak-to-peak variation over the mean
    /// stiffness, 0 ≤ ε.
    ///
    /// # Errors
    /// If there is not one wave for each mesh, a stiffness would be negative, or modes are not found.
    pub fn new(
        model: LumpedModel,
        waves: Vec<MeshWave>,
        epsilon: f64,
    ) -> Result<Self, LumpedError> {
        let of = |is_own: fn(&SpringId) -> bool| {
            let own = model.springs.iter().filter(move |s| is_own(&s.id));
            own.filter_map(|s: &Spring| Some((s.stiffness, s.rows.first()?.clone())))
        };
        let meshes: Vec<_> = of(|id| matches!(id, SpringId::SunMesh(_)))
            .chain(of(|id| matches!(id, SpringId::RingMesh(_))))
            .collect();
        if waves.len() != meshes.len() {
            return Err(LumpedError::Law { got: waves.len(), wanted: meshes.len() });
        }
        // Lowest relative stiffness 1 − 2 c′ ε
        let lowest = waves.iter().map(|w| 1.0 - 2.0 * w.high_part() * epsilon).fold(1.0, f64::min);
        if !(epsilon >= 0.0 && lowest >= 0.0) {
            return Err(LumpedError::Variation { epsilon, lowest });
        }
        let stretches = stretches(&model, &meshes, &waves, epsilon)?;
        Ok(Self { model, meshes, waves, epsilon, stretches })
    }

    /// With contact ratios and mesh phases from the teeth of a scene.
    ///
    /// # Errors
    /// If the scene has no teeth or no lumped parameters, or ε is out of range.
    pub fn from_scene(scene: &Scene, epsilon: f64) -> Result<Self, LumpedError> {
        let model = LumpedModel::from_scene(scene)?;
        let geometry = scene.tooth_geometry().map_err(|_| LumpedError::NoTeeth)?;
        let both = geometry.sun_planet.as_ref().zip(geometry.ring_planet.as_ref());
        let (sun, ring) = both.ok_or(LumpedError::NoTeeth)?;
        let phasing = Phasing::new(&geometry, &scene.planets).ok_or(LumpedError::NoTeeth)?;
        let starts = MeshStart::of_set(&phasing);
        let planets = model.psi.len();
        let wave = |(i, start): (usize, &MeshStart)| MeshWave {
            contact_ratio: if i < planets { sun.contact_ratio } else { ring.contact_ratio },
            phase: start.front,
        };
        let waves = starts.iter().enumerate().map(wave).collect();
        Self::new(model, waves, epsilon)
    }

    /// The same set with another ε.
    ///
    /// # Errors
    /// As [`ParametricSet::new`].
    pub fn with_variation(&self, epsilon: f64) -> Result<Self, LumpedError> {
        Self::new(self.model.clone(), self.waves.clone(), epsilon)
    }

    /// The set with its mean stiffness.
    pub fn model(&self) -> &LumpedModel {
        &self.model
    }

    /// Mean stiffness (N/m) and row of each mesh, sun meshes first.
    pub fn meshes(&self) -> &[(f64, Vec<(usize, f64)>)] {
        &self.meshes
    }

    /// The wave of each mesh.
    pub fn waves(&self) -> &[MeshWave] {
        &self.waves
    }

    /// ε.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// Multipliers over one mesh cycle at a mesh frequency, by descending size.
    ///
    /// `[eq:monodromy]` With y = M^½ q and K̃ = M^-½ K M^-½ = Q Λ Qᵀ of one stretch between switches,
    /// ```text
    /// y(t+Δ) = Q cos(√Λ Δ) Qᵀ y + Q Λ^-½ sin(√Λ Δ) Qᵀ ẏ,
    /// ẏ(t+Δ) = −Q √Λ sin(√Λ Δ) Qᵀ y + Q cos(√Λ Δ) Qᵀ ẏ;
    /// the monodromy matrix is the product over the stretches of a mesh cycle.
    /// ```
    /// Source: closed form.
    /// Checked by: `lumped/tests/parametric.rs::growth_is_inside_the_borders_and_nowhere_near`.
    ///
    /// # Errors
    /// If the frequency is not positive and finite, or eigenvalues are not found.
    pub fn multipliers(&self, mesh_frequency_hz: f64) -> Result<Vec<Multiplier>, LumpedError> {
        if !(mesh_frequency_hz > 0.0 && mesh_frequency_hz.is_finite()) {
            return Err(LumpedError::Frequency(mesh_frequency_hz));
        }
        let n = self.model.mass.len();
        // Velocities in units of Ω y, so that both halves are of one size.
        let rate = TAU * mesh_frequency_hz;
        let mut monodromy = DMatrix::identity(2 * n, 2 * n);
        for stretch in &self.stretches {
            let time = stretch.part / mesh_frequency_hz;
            let block = |f: &dyn Fn(f64) -> f64| {
                let mut scaled = stretch.q.clone();
                for (mut column, omega) in scaled.column_iter_mut().zip(&stretch.omega) {
                    column *= f(*omega);
                }
                scaled * stretch.q.transpose()
            };
            let cos = block(&|w| (w * time).cos());
            let sin = block(&|w| match w > 0.0 {
                true => rate * (w * time).sin() / w,
                false => rate * time,
            });
            let back = block(&|w| -w * (w * time).sin() / rate);
            let mut step = DMatrix::zeros(2 * n, 2 * n);
            step.view_mut((0, 0), (n, n)).copy_from(&cos);
            step.view_mut((0, n), (n, n)).copy_from(&sin);
            step.view_mut((n, 0), (n, n)).copy_from(&back);
            step.view_mut((n, n), (n, n)).copy_from(&cos);
            monodromy = step * monodromy;
        }
        let derivative = MapDerivative {
            active: (0..2 * n).collect(),
            columns: monodromy,
            scales: vec![1.0; 2 * n],
        };
        Ok(multipliers(&derivative)?)
    }

    /// Growth rate ln|μ| f_m of the fastest growing motion, 1/s; 0 where all multipliers lie on the unit circle.
    ///
    /// # Errors
    /// As [`ParametricSet::multipliers`].
    pub fn growth_per_s(&self, mesh_frequency_hz: f64) -> Result<f64, LumpedError> {
        let largest = self.multipliers(mesh_frequency_hz)?.first().map_or(0.0, |m| m.size());
        Ok(if largest > 1.0 + GROWS { largest.ln() * mesh_frequency_hz } else { 0.0 })
    }

    /// Borders of a tongue, searched within three first-order half-widths of its centre; `None` if nothing grows there.
    ///
    /// # Errors
    /// As [`ParametricSet::multipliers`].
    pub fn edges(&self, tongue: &Tongue) -> Result<Option<TongueEdges>, LumpedError> {
        let (centre, half) = (tongue.mesh_frequency_hz, self.epsilon * tongue.half_width_hz);
        let points = 25;
        let mut best = (0.0, centre);
        for k in 0..=points {
            let f = centre + half * (4.0 * f64::from(k) / f64::from(points) - 2.0);
            let growth = self.growth_per_s(f)?;
            if growth > best.0 {
                best = (growth, f);
            }
        }
        if best.0 == 0.0 {
            return Ok(None);
        }
        let edge = |outside: f64| {
            let (mut inside, mut outside) = (best.1, outside);
            while (outside - inside).abs() > 1e-9 * centre * self.epsilon {
                let middle = 0.5 * (inside + outside);
                if self.growth_per_s(middle)? > 0.0 { inside = middle } else { outside = middle }
            }
            Ok::<_, LumpedError>(0.5 * (inside + outside))
        };
        let low_hz = edge(centre - 3.0 * half)?;
        let high_hz = edge(centre + 3.0 * half)?;
        Ok(Some(TongueEdges { low_hz, high_hz, growth_per_s: best.0 }))
    }
}

fn stretches(
    model: &LumpedModel,
    meshes: &[(f64, Vec<(usize, f64)>)],
    waves: &[MeshWave],
    epsilon: f64,
) -> Result<Vec<Stretch>, LumpedError> {
    let mut times: Vec<f64> = waves.iter().flat_map(MeshWave::switches).collect();
    times.extend([0.0, 1.0]);
    times.sort_by(f64::total_cmp);
    let mean = model.stiffness();
    let mut found = Vec::new();
    for pair in times.windows(2) {
        let part = pair[1] - pair[0];
        // Switches that fall together but for rounding.
        if part < 1e-12 {
            continue;
        }
        let middle = 0.5 * (pair[0] + pair[1]);
        let mut k = mean.clone();
        for ((stiffness, row), wave) in meshes.iter().zip(waves) {
            let change = epsilon * stiffness * wave.at(middle);
            for &(i, bi) in row {
                for &(j, bj) in row {
                    k[(i, j)] += change * bi * bj;
                }
            }
        }
        let modes = generalized_symmetric(&k, &model.mass)?;
        let largest = modes.lambda.last().copied().unwrap_or(0.0);
        let omega = modes
            .lambda
            .iter()
            .map(|l| if *l > RIGID * largest { l.sqrt() } else { 0.0 })
            .collect();
        // Q = M^½ Φ
        let n = model.mass.len();
        let q = DMatrix::from_fn(n, n, |i, j| model.mass[i].sqrt() * modes.vectors[(i, j)]);
        found.push(Stretch { part, omega, q });
    }
    Ok(found)
}
