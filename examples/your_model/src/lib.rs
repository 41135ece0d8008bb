//! Somebody's lumped model of a planetary gear: their own assembly and equation solvers, none of this project's.
//! It answers every question that the suites ask: natural modes, the mesh cycle at rest and
//! steady states ([`excited`]).
//!
//! Springs are collected as rows b of their elongation bᵀq (Lin & Parker 1999, eqs. 1 to 6), so that
//! K = Σ k b bᵀ; coordinates are x, y, u = r·θ of carrier, ring and sun, then radial, tangential, u of the
//! planets.

mod excited;

use epicyclic::experiments::{ModalModel, ModelError, NaturalMode};
use epicyclic::gearset::{Freedom, LoadCase, MeshKind, Scene, Support, Torsional};
use epicyclic::lumped::ModeType;
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The model.
#[derive(Debug, Clone, Copy)]
pub struct YourModel {
    /// Sign of the planet's rotation in its sun mesh: +1, or −1 to see a wrong model caught.
    pub sign: f64,
    /// Sign of the mesh phases of the planets: +1, or −1 to see a wrong model caught.
    pub phasing: f64,
}

impl Default for YourModel {
    fn default() -> Self {
        Self { sign: 1.0, phasing: 1.0 }
    }
}

/// What a scene must have for this model.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lacks(pub &'static str);

impl std::fmt::Display for Lacks {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "this model needs {}", self.0)
    }
}

impl std::error::Error for Lacks {}

const CARRIER: usize = 0;
const RING: usize = 1;
const SUN: usize = 2;

/// Column of coordinate `axis` of body k: carrier, ring, sun, planets.
fn at(body: usize, axis: usize) -> usize {
    3 * body + axis
}

/// A spring: its stiffness (the mean over a mesh cycle, N/m) and its elongation as a row.
struct Spring {
    stiffness: f64,
    row: Vec<(usize, f64)>,
    /// Which mesh, of which planet; bearings and supports are none.
    mesh: Option<(MeshKind, usize)>,
}

/// Springs, masses and I/r² (the diagonal of M), and the coordinates that may move.
struct Parts {
    springs: Vec<Spring>,
    mass: Vec<f64>,
    moving: Vec<usize>,
}

impl Parts {
    /// K of the mean stiffnesses, of all coordinates.
    fn stiffness(&self) -> DMatrix<f64> {
        let mut k = DMatrix::zeros(self.mass.len(), self.mass.len());
        for spring in &self.springs {
            for (i, a) in &spring.row {
                for (j, b) in &spring.row {
                    k[(*i, *j)] += spring.stiffness * a * b;
                }
            }
        }
        k
    }
}

impl YourModel {
    /// `sense`: +1 where a counter-clockwise torque acts on the sun; with −1 the other flanks press, whose
    /// lines of action lean the other way.
    fn parts(&self, scene: &Scene, sense: f64) -> Result<Parts, Lacks> {
        let lumped = scene.lumped.as_ref().ok_or(Lacks("[lumped]"))?;
        let psi = &scene.planets.psi_rad;
        let size = at(3 + psi.len(), 0);
        let mut springs = Vec::new();
        let mut spring = |mesh, stiffness: f64, row: &[(usize, f64)]| {
            springs.push(Spring { stiffness, row: row.to_vec(), mesh });
        };
        let (alpha_s, alpha_r) = (
            sense * lumped.pressure_angle_rad.sun_planet,
            sense * lumped.pressure_angle_rad.ring_planet,
        );
        for (n, psi) in psi.iter().enumerate() {
            let own = scene.overrides.iter().filter(|o| o.planet == n);
            let last = |of: fn(&epicyclic::gearset::PlanetOverride) -> Option<f64>, usual: f64| {
                own.clone().filter_map(of).next_back().unwrap_or(usual)
            };
            let p = 3 + n;
            let (sin, cos) = (psi - alpha_s).sin_cos();
            let row = [
                (at(SUN, 0), -sin),
                (at(SUN, 1), cos),
                (at(SUN, 2), 1.0),
                (at(p, 0), -alpha_s.sin()),
                (at(p, 1), -alpha_s.cos()),
                (at(p, 2), self.sign),
            ];
            let mesh = Some((MeshKind::SunPlanet, n));
            spring(mesh, last(|o| o.sun_mesh_n_per_m, lumped.mesh_n_per_m.sun_planet), &row);
            let (sin, cos) = (psi + alpha_r).sin_cos();
            let row = [
                (at(RING, 0), -sin),
                (at(RING, 1), cos),
                (at(RING, 2), 1.0),
                (at(p, 0), alpha_r.sin()),
                (at(p, 1), -alpha_r.cos()),
                (at(p, 2), -1.0),
            ];
            let mesh = Some((MeshKind::RingPlanet, n));
            spring(mesh, last(|o| o.ring_mesh_n_per_m, lumped.mesh_n_per_m.ring_planet), &row);
            let bearing = last(|o| o.bearing_n_per_m, scene.supports.planet_bearing_n_per_m);
            let (sin, cos) = psi.sin_cos();
            let radial = [(at(CARRIER, 0), cos), (at(CARRIER, 1), sin), (at(p, 0), -1.0)];
            let tangential = [
                (at(CARRIER, 0), -sin),
                (at(CARRIER, 1), cos),
                (at(CARRIER, 2), 1.0),
                (at(p, 1), -1.0),
            ];
            spring(None, bearing, &radial);
            spring(None, bearing, &tangential);
        }
        let supports = [scene.supports.carrier, scene.supports.ring, scene.supports.sun];
        let radii = [lumped.radius_m.carrier, lumped.radius_m.ring, lumped.radius_m.sun];
        let mut free = vec![true; size];
        for (body, (support, radius)) in supports.iter().zip(radii).enumerate() {
            let Support { motion, bearing_n_per_m: bearing, torsional } = *support;
            spring(None, bearing, &[(at(body, 0), 1.0)]);
            spring(None, bearing, &[(at(body, 1), 1.0)]);
            let per_length = match (torsional, radius) {
                (Torsional::PerLength(k), _) => k,
                (Torsional::PerAngle(k), Some(r)) => k / (r * r),
                (Torsional::PerAngle(0.0), None) => 0.0,
                (Torsional::PerAngle(_), None) => return Err(Lacks("radii of the members")),
            };
            spring(None, per_length, &[(at(body, 2), 1.0)]);
            for axis in 0..3 {
                free[at(body, axis)] = match motion {
                    Freedom::Free => true,
                    Freedom::CentreHeld => axis == 2,
                    Freedom::RotationHeld => axis < 2,
                    Freedom::Held => false,
                };
            }
        }
        let (m, i) = (&lumped.mass_kg, &lumped.inertia_over_r2_kg);
        let mut mass = Vec::with_capacity(size);
        for (m, i) in [(m.carrier, i.carrier), (m.ring, i.ring), (m.sun, i.sun)] {
            mass.extend([m, m, i].map(|x| x.unwrap_or(f64::NAN)));
        }
        for n in 0..psi.len() {
            let own = scene.overrides.iter().filter(|o| o.planet == n);
            let mass_of = own.clone().filter_map(|o| o.mass_kg).next_back().or(m.planet);
            let inertia = own.filter_map(|o| o.inertia_over_r2_kg).next_back().or(i.planet);
            mass.extend([mass_of, mass_of, inertia].map(|x| x.unwrap_or(f64::NAN)));
        }
        let moving: Vec<usize> = (0..size).filter(|j| free[*j]).collect();
        if moving.iter().any(|j| mass[*j].is_nan()) {
            return Err(Lacks("mass and inertia of every body that moves"));
        }
        Ok(Parts { springs, mass, moving })
    }

    /// Kind of a mode from its shape scaled by √mass: the largest of the shares in which all planets move alike,
    /// in which they follow cos ψ and sin ψ, and the rest.
    fn kind(shape: &DVector<f64>, psi: &[f64]) -> ModeType {
        let n = psi.len() as f64;
        let square = |x: f64| x * x;
        let (mut alike, mut around) = (0.0, 0.0);
        for body in [CARRIER, RING, SUN] {
            alike += square(shape[at(body, 2)]);
            around += square(shape[at(body, 0)]) + square(shape[at(body, 1)]);
        }
        for axis in 0..3 {
            let sum = |weight: &dyn Fn(f64) -> f64| {
                let own = psi.iter().enumerate();
                own.map(|(p, psi)| weight(*psi) * shape[at(3 + p, axis)]).sum::<f64>()
            };
            alike += square(sum(&|_| 1.0)) / n;
            around += 2.0 / n * (square(sum(&f64::cos)) + square(sum(&f64::sin)));
        }
        let rest = shape.norm_squared() - alike - around;
        match alike.max(around).max(rest) {
            most if most == alike => ModeType::Rotational,
            most if most == around => ModeType::Translational,
            _ => ModeType::Planet,
        }
    }
}

impl ModalModel for YourModel {
    fn natural_modes(&self, scene: &Scene, _: &LoadCase) -> Result<Vec<NaturalMode>, ModelError> {
        let parts = self.parts(scene, 1.0)?;
        let (k, Parts { mass, moving, .. }) = (parts.stiffness(), &parts);
        // M^(−½) K M^(−½) has the squares of the natural frequencies.
        let scaled = DMatrix::from_fn(moving.len(), moving.len(), |a, b| {
            let (i, j) = (moving[a], moving[b]);
            k[(i, j)] / (mass[i] * mass[j]).sqrt()
        });
        let solved = SymmetricEigen::new(scaled);
        let mode = |(j, lambda): (usize, &f64)| {
            let mut shape = DVector::zeros(mass.len());
            for (a, i) in moving.iter().enumerate() {
                shape[*i] = solved.eigenvectors[(a, j)];
            }
            let frequency_hz = lambda.max(0.0).sqrt() / std::f64::consts::TAU;
            let mode_type = Self::kind(&shape, &scene.planets.psi_rad);
            NaturalMode { frequency_hz, mode_type }
        };
        Ok(solved.eigenvalues.iter().enumerate().map(mode).collect())
    }
}
