//! Hill's equation of a gear pair at constant deflection: m_e ẅ + k(t) w = 0 with k from FE/contact.

use std::f64::consts::{PI, TAU};

use experiments::branches::BranchPoint;
use experiments::sweep::{Coordinate, Part};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, at_approach};
use gearset::MeshKind;

/// Change of the deflection for a tangent stiffness, m.
const CHANGE: f64 = 5e-8;

/// Phases at which contact is solved.
const PHASES: usize = 140;

/// Transmission error of equal gears that turn by equal angles, m, by harmonic: amplitude and phase.
fn transmission_error(point: &BranchPoint, radius: f64) -> Vec<(f64, f64, f64)> {
    let own = point.state.lines.iter();
    own.filter(|l| l.part == Part::SUN && l.coordinate == Coordinate::Rotation)
        .map(|l| (l.harmonic as f64, 2.0 * radius * l.amplitude, l.phase_rad))
        .collect()
}

fn force(bodies: &Bodies, phase: f64, approach: f64) -> f64 {
    at_approach(bodies, MeshKind::SunPlanet, phase, approach, &ActiveSet).unwrap().force
}

/// m_e ẅ + k(t) w = 0, k constant over each of its parts of a mesh cycle.
pub(crate) struct Hill {
    stiffness: Vec<f64>,
    mass: f64,
}

impl Hill {
    /// Of equal gears, m_e = J/2r_b², along a periodic motion under a torque (N m).
    ///
    /// The phase of the teeth at time 0 of the motion is not taken from the program: it is the one at which Newton's
    /// law m_e ẅ = T/r_b − F(w, φ) holds.
    pub(crate) fn along(point: &BranchPoint, bodies: &Bodies, torque_nm: f64) -> Self {
        let radius = bodies.planet.mesh.outline.gear().base_radius;
        let mass = 0.5 * bodies.planet.inertia / (radius * radius);
        let harmonics = transmission_error(point, radius);
        let omega = TAU * point.state.case.mesh_frequency_hz;
        let of = |time: f64, order: i32| -> f64 {
            let each = harmonics.iter().map(|(l, amplitude, phase)| {
                let cos = amplitude * (TAU * l * time + phase).cos();
                if order == 0 { cos } else { -cos * (l * omega).powi(2) }
            });
            each.sum()
        };
        let mean =
            (0..PHASES).map(|i| of(i as f64 / PHASES as f64, 0)).sum::<f64>() / PHASES as f64;
        // F and ∂F/∂δ at the mean deflection.
        let table: Vec<[f64; 2]> = (0..PHASES)
            .map(|i| {
                let phase = i as f64 / PHASES as f64;
                let [above, below] =
                    [1.0, -1.0].map(|sign| force(bodies, phase, mean + sign * CHANGE));
                [0.5 * (above + below), (above - below) / (2.0 * CHANGE)]
            })
            .collect();
        let residual = |shift: usize| -> f64 {
            let one = |i: usize| {
                let time = i as f64 / PHASES as f64;
                let [f, k] = table[(i + shift) % PHASES];
                let lost = mass * of(time, 2) - torque_nm / radius + f + k * (of(time, 0) - mean);
                (lost * radius / torque_nm).powi(2)
            };
            ((0..PHASES).map(one).sum::<f64>() / PHASES as f64).sqrt()
        };
        let best = (0..PHASES).min_by(|a, b| residual(*a).total_cmp(&residual(*b))).unwrap();
        println!("teeth ahead by {best}/{PHASES}, residual {}", residual(best));
        // Five harmonics leave out what is above.
        assert!(residual(best) < 0.05, "{}", residual(best));
        let stiffness = |i: usize| {
            let phase = ((i + best) % PHASES) as f64 / PHASES as f64;
            let deflection = of(i as f64 / PHASES as f64, 0);
            let [above, below] =
                [1.0, -1.0].map(|sign| force(bodies, phase, deflection + sign * CHANGE));
            (above - below) / (2.0 * CHANGE)
        };
        Self { stiffness: (0..PHASES).map(stiffness).collect(), mass }
    }

    fn mean(&self) -> f64 {
        self.stiffness.iter().sum::<f64>() / self.stiffness.len() as f64
    }

    /// Natural frequency with the mean stiffness, Hz.
    fn natural_hz(&self) -> f64 {
        (self.mean() / self.mass).sqrt() / TAU
    }

    /// Amplitude of the stiffness's first harmonic over its mean.
    pub(crate) fn h(&self) -> f64 {
        let n = self.stiffness.len() as f64;
        let along = |f: fn(f64) -> f64| {
            let each = self.stiffness.iter().enumerate();
            each.map(|(i, k)| k * f(TAU * i as f64 / n)).sum::<f64>() * 2.0 / n
        };
        along(f64::cos).hypot(along(f64::sin)) / self.mean()
    }

    /// Trace of the map over a mesh cycle: −2 where a multiplier is −1.
    fn trace(&self, mesh_frequency_hz: f64) -> f64 {
        let time = 1.0 / (mesh_frequency_hz * self.stiffness.len() as f64);
        let mut map = nalgebra::Matrix2::identity();
        for k in &self.stiffness {
            let omega = (k / self.mass).sqrt();
            let (sin, cos) = (omega * time).sin_cos();
            map = nalgebra::Matrix2::new(cos, sin / omega, -omega * sin, cos) * map;
        }
        map.trace()
    }

    /// Speeds of the sun (rpm, 50 teeth) between which a multiplier is beyond −1.
    pub(crate) fn borders(&self) -> [f64; 2] {
        let centre = 2.0 * self.natural_hz();
        assert!(self.trace(centre) < -2.0, "{}", self.trace(centre));
        [-0.1, 0.1].map(|reach| {
            let (mut inside, mut outside) = (centre, centre * (1.0 + reach));
            for _ in 0..60 {
                let middle = 0.5 * (inside + outside);
                if self.trace(middle) < -2.0 { inside = middle } else { outside = middle }
            }
            1.2 * inside
        })
    }

    /// The same to first order: Ω = 2ω ± ω h/2.
    pub(crate) fn first_order(&self) -> [f64; 2] {
        let omega = TAU * self.natural_hz();
        [-0.5, 0.5].map(|side| 1.2 * omega * (2.0 + side * self.h()) / (2.0 * PI))
    }
}
