//! Motion that the meshes' changing stiffness excites, at rest and in time.
//!
//! While the teeth turn a mesh has one pair of teeth in contact or two, k(τ) = k̄ (1 or 2)/ε with the contact ratio
//! ε and the position τ in the mesh cycle, as a Fourier series that ends at harmonic [`LAST`]. Meshes of one kind
//! follow one another by their phases. Steady states are periodic solutions of
//! M q″ + C q′ + K(t) q = f, all harmonics at once: Σ_m [(−l²ω² M + i l ω C) δ_lm + K_(l−m)] q_m = f δ_l0.

use std::f64::consts::TAU;

use epicyclic::experiments::sweep::{Coordinate, Line, Part, SteadyState};
use epicyclic::experiments::{
    MeshCycle, ModelError, RestState, SpeedRequest, StaticModel, SteadyStateModel,
};
use epicyclic::gearset::{Body, LoadCase, MeshKind, Scene};
use nalgebra::{Complex, DMatrix, DVector};

use crate::{Lacks, Parts, SUN, Spring, YourModel, at};

/// Highest harmonic of the mesh frequency.
const LAST: i32 = 6;

/// Contact ratios of sun and ring meshes.
const CONTACT_RATIOS: [f64; 2] = [1.6, 1.8];

/// Ring meshes are so far ahead of the sun mesh of the same planet, in mesh cycles.
const RING_AHEAD: f64 = 0.4;

type C64 = Complex<f64>;

/// Elongation bᵀq of a spring.
fn elongation<T: Copy + std::iter::Sum + std::ops::Mul<f64, Output = T>>(
    spring: &Spring,
    q: impl Fn(usize) -> T,
) -> T {
    spring.row.iter().map(|(i, b)| q(*i) * *b).sum()
}

/// A set under a torque whose meshes change with position.
struct Excited {
    parts: Parts,
    /// Harmonics −LAST to LAST of each spring's stiffness.
    stiffness: Vec<Vec<C64>>,
    force: Vec<f64>,
    sense: f64,
    /// r of the coordinates u = r·θ, 1 for displacements.
    radius: Vec<f64>,
    damping: [f64; 2],
}

impl Excited {
    fn new(model: &YourModel, scene: &Scene, case: &LoadCase) -> Result<Self, Lacks> {
        let sense = if case.sun_torque_nm < 0.0 { -1.0 } else { 1.0 };
        let parts = model.parts(scene, sense)?;
        let teeth = scene.teeth.ok_or(Lacks("[teeth]"))?;
        let lumped = scene.lumped.as_ref().ok_or(Lacks("[lumped]"))?;
        let of = |count: Option<u32>| count.map(f64::from).ok_or(Lacks("all numbers of teeth"));
        let (sun, ring) = (of(teeth.sun)?, of(teeth.ring)?);
        let ahead = |kind: MeshKind, n: usize| {
            let turns = scene.planets.psi_rad[n] / TAU;
            // Z_s ψ_n teeth of the sun lie between planets 0 and n, Z_r ψ_n of the ring.
            model.phasing
                * sense
                * match kind {
                    MeshKind::SunPlanet => -sun * turns,
                    MeshKind::RingPlanet => ring * turns + sense * RING_AHEAD,
                }
        };
        let series = |spring: &Spring, l: i32| match spring.mesh {
            None if l == 0 => C64::from(spring.stiffness),
            None => C64::from(0.0),
            Some((kind, n)) => {
                let ratio = CONTACT_RATIOS[usize::from(kind == MeshKind::RingPlanet)];
                let turn = |cycles: f64| C64::from_polar(1.0, TAU * f64::from(l) * cycles);
                // Two pairs for ε − 1 of the cycle, centred on τ = 0: sin(π l (ε − 1))/(π l).
                let pairs = if l == 0 {
                    ratio
                } else {
                    (TAU / 2.0 * f64::from(l) * (ratio - 1.0)).sin() / (TAU / 2.0 * f64::from(l))
                };
                turn(ahead(kind, n)) * (spring.stiffness * pairs / ratio)
            }
        };
        let stiffness: Vec<Vec<C64>> =
            parts.springs.iter().map(|s| (-LAST..=LAST).map(|l| series(s, l)).collect()).collect();
        let r = &lumped.radius_m;
        let central = [r.carrier, r.ring, r.sun].map(|r| r.unwrap_or(f64::NAN));
        let radius: Vec<f64> = (0..parts.mass.len())
            .map(|i| match (i / 3, i % 3) {
                (body, 2) => central.get(body).copied().or(r.planet).unwrap_or(f64::NAN),
                _ => 1.0,
            })
            .collect();
        let mut force = vec![0.0; parts.mass.len()];
        force[at(SUN, 2)] = case.sun_torque_nm / radius[at(SUN, 2)];
        if force[at(SUN, 2)].is_nan() || !parts.moving.contains(&at(SUN, 2)) {
            return Err(Lacks("a sun that turns, and its radius"));
        }
        let damping =
            [scene.damping.mass_proportional_per_s, scene.damping.stiffness_proportional_s];
        Ok(Self { parts, stiffness, force, sense, radius, damping })
    }

    /// Stiffness of a spring at a position.
    fn stiffness_at(&self, spring: usize, position: f64) -> f64 {
        let list = self.stiffness[spring].iter().zip(-LAST..=LAST);
        list.map(|(k, l)| (k * C64::from_polar(1.0, TAU * f64::from(l) * position)).re).sum()
    }

    /// Static displacements of all coordinates at a position.
    fn at_rest(&self, position: f64) -> Result<Vec<f64>, Lacks> {
        let Parts { springs, mass, moving } = &self.parts;
        let own = springs.iter().enumerate().map(|(n, s)| Spring {
            stiffness: self.stiffness_at(n, position),
            row: s.row.clone(),
            mesh: s.mesh,
        });
        let now = Parts { springs: own.collect(), mass: mass.clone(), moving: moving.clone() };
        let k = now.stiffness();
        let k = DMatrix::from_fn(moving.len(), moving.len(), |a, b| k[(moving[a], moving[b])]);
        let f = DVector::from_fn(moving.len(), |a, _| self.force[moving[a]]);
        let solved = k.cholesky().ok_or(Lacks("supports that hold the set at rest"))?.solve(&f);
        let mut q = vec![0.0; mass.len()];
        moving.iter().zip(solved.iter()).for_each(|(i, x)| q[*i] = *x);
        Ok(q)
    }

    /// Harmonics −LAST to LAST of all coordinates at a mesh frequency, Hz.
    fn harmonics(&self, mesh_frequency_hz: f64) -> Result<Vec<Vec<C64>>, Lacks> {
        let Parts { springs, mass, moving } = &self.parts;
        let n = moving.len();
        let mut place = vec![None; mass.len()];
        moving.iter().enumerate().for_each(|(a, i)| place[*i] = Some(a));
        let count = 2 * LAST + 1;
        let mut a = DMatrix::<C64>::zeros(n * count as usize, n * count as usize);
        let [alpha, beta] = self.damping;
        for l in -LAST..=LAST {
            let omega = TAU * mesh_frequency_hz * f64::from(l);
            let first = n * (l + LAST) as usize;
            for (j, i) in moving.iter().enumerate() {
                a[(first + j, first + j)] += mass[*i] * C64::new(-omega * omega, omega * alpha);
            }
            for m in (-LAST..=LAST).filter(|m| (l - m).abs() <= LAST) {
                let other = n * (m + LAST) as usize;
                for (spring, own) in springs.iter().zip(&self.stiffness) {
                    let mut k = own[(l - m + LAST) as usize];
                    if l == m {
                        // C has β times the mean stiffness.
                        k *= C64::new(1.0, omega * beta);
                    }
                    for (i, b) in spring.row.iter().filter_map(|(i, b)| Some((place[*i]?, b))) {
                        for (j, c) in spring.row.iter().filter_map(|(j, c)| Some((place[*j]?, c))) {
                            a[(first + i, other + j)] += k * (b * c);
                        }
                    }
                }
            }
        }
        let mut f = DVector::<C64>::zeros(n * count as usize);
        for (j, i) in moving.iter().enumerate() {
            f[n * LAST as usize + j] = C64::from(self.force[*i]);
        }
        let x = a.lu().solve(&f).ok_or(Lacks("supports that hold the set at rest"))?;
        let of = |l: i32| {
            let own =
                |i: usize| place[i].map_or(C64::from(0.0), |j| x[n * (l + LAST) as usize + j]);
            (0..mass.len()).map(own).collect()
        };
        Ok((-LAST..=LAST).map(of).collect())
    }

    /// Harmonic l of the force of a spring, Σ_m k_(l−m) bᵀq_m.
    fn force_of(&self, spring: usize, l: i32, q: &[Vec<C64>]) -> C64 {
        let list = (-LAST..=LAST).filter(|m| (l - m).abs() <= LAST);
        list.map(|m| {
            let own = &q[(m + LAST) as usize];
            let k = self.stiffness[spring][(l - m + LAST) as usize];
            k * elongation(&self.parts.springs[spring], |i| own[i])
        })
        .sum()
    }

    fn lines(&self, mesh_frequency_hz: f64, harmonics: usize) -> Result<Vec<Line>, Lacks> {
        let q = self.harmonics(mesh_frequency_hz)?;
        let mut lines = Vec::new();
        for harmonic in 0..=harmonics.min(LAST as usize) {
            let l = harmonic as i32;
            let mut line = |part, coordinate, value: C64| {
                // A cos(2π l f t + φ) = 2 |c| cos(…) with the coefficient c of e^(2π i l f t); its mean is c.
                let amplitude = if l == 0 { value.norm() } else { 2.0 * value.norm() };
                lines.push(Line { part, coordinate, harmonic, amplitude, phase_rad: value.arg() });
            };
            for body in 0..self.parts.mass.len() / 3 {
                for (axis, coordinate) in Coordinate::DISPLACEMENTS.into_iter().enumerate() {
                    let i = at(body, axis);
                    if self.parts.moving.contains(&i) {
                        let value = q[(l + LAST) as usize][i] / self.radius[i];
                        line(Part::Body(Body::from_index(body)), coordinate, value);
                    }
                }
            }
            for (n, spring) in self.parts.springs.iter().enumerate() {
                let part = match spring.mesh {
                    None => continue,
                    Some((MeshKind::SunPlanet, n)) => Part::SunMesh(n),
                    Some((MeshKind::RingPlanet, n)) => Part::RingMesh(n),
                };
                line(part, Coordinate::Force, self.sense * self.force_of(n, l, &q));
            }
        }
        Ok(lines)
    }
}

impl StaticModel for YourModel {
    fn mesh_cycle(
        &self,
        scene: &Scene,
        case: &LoadCase,
        positions: usize,
    ) -> Result<MeshCycle, ModelError> {
        let set = Excited::new(self, scene, case)?;
        let mut states = Vec::new();
        for position in (0..positions).map(|j| j as f64 / positions as f64) {
            let q = set.at_rest(position)?;
            let own = [0, 1, 2].map(|axis| at(SUN, axis));
            let mut state = RestState {
                position,
                sun: own.map(|i| q[i] / set.radius[i]),
                ..Default::default()
            };
            for (n, spring) in set.parts.springs.iter().enumerate() {
                let force =
                    set.sense * set.stiffness_at(n, position) * elongation(spring, |i| q[i]);
                match spring.mesh {
                    Some((MeshKind::SunPlanet, _)) => state.sun_mesh_n.push(force),
                    Some((MeshKind::RingPlanet, _)) => state.ring_mesh_n.push(force),
                    None => {}
                }
            }
            states.push(state);
        }
        Ok(MeshCycle { case: *case, states })
    }
}

impl SteadyStateModel for YourModel {
    fn steady_states(
        &self,
        scene: &Scene,
        case: &LoadCase,
        request: &SpeedRequest<'_>,
    ) -> Result<Vec<SteadyState>, ModelError> {
        let set = Excited::new(self, scene, case)?;
        let at_speed = |rpm: &f64| {
            let case = case.at_speed(*rpm);
            let lines = set.lines(case.mesh_frequency_hz, request.harmonics)?;
            Ok(SteadyState { case, lines })
        };
        request.speeds_rpm.iter().map(at_speed).collect()
    }
}
