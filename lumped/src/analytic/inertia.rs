//! What the inertia of elastic displacements changes of a natural frequency, to first order and in closed form.
//!
//! Bodies yield under their own inertial forces by λw (`accelerated.rs`), which the forces F of springs on them feel.
//! The carrier is its annulus; a gear is an annulus from its race to the middle of its teeth.

use gearset::{Axis, Body, Gear, Geometry};
use nalgebra::{Complex, DMatrix, DVector};
use scene::Scene;

use super::AnalyticSet;
use super::accelerated::Accelerated;
use super::plane::Plane;
use crate::modes::ModeGroup;
use crate::springs::SpringId;

/// Bodies that their races accelerate.
#[derive(Debug, Clone)]
pub(super) struct ElasticBodies {
    carrier: Option<OnRadius>,
    ring: Option<OnRadius>,
    sun: Option<OnRadius>,
    planet: Option<OnRadius>,
    /// (I/k + A)⁻¹ of bearings on pin seats, N/m.
    bearings: DMatrix<f64>,
}

/// A body where its springs act, and the radius in u = r θ.
#[derive(Debug, Clone, Copy)]
struct OnRadius {
    body: Accelerated,
    at: f64,
    radius: f64,
}

impl ElasticBodies {
    pub(super) fn new(
        scene: &Scene,
        geometry: &Geometry,
        plane: &Plane,
        seats: &DMatrix<f64>,
    ) -> Self {
        let density = scene.material.density_kg_per_m3;
        let gear = |gear: &Gear| {
            let middle = 0.5 * (gear.tip_radius + gear.root_radius);
            let body = Accelerated::new(gear.body_radius?, middle, density, plane);
            Some(OnRadius { body, at: middle, radius: gear.base_radius })
        };
        let carrier = scene.geometry.as_ref().and_then(|g| g.carrier).filter(|c| !c.is_rigid);
        let a = geometry.center_distance;
        let k = scene.supports.planet_bearing_n_per_m;
        let series = DMatrix::identity(seats.nrows(), seats.nrows()) / k + seats;
        Self {
            carrier: carrier.map(|c| OnRadius {
                body: Accelerated::new(c.bore_radius_m, c.outer_radius_m, density, plane),
                at: a,
                radius: a,
            }),
            ring: geometry.ring.as_ref().and_then(gear),
            sun: geometry.sun.as_ref().and_then(gear),
            planet: gear(&geometry.planet),
            bearings: series.try_inverse().unwrap_or_else(|| DMatrix::zeros(0, 0)),
        }
    }

    fn of(&self, body: Body) -> Option<&OnRadius> {
        match body {
            Body::Carrier => self.carrier.as_ref(),
            Body::Ring => self.ring.as_ref(),
            Body::Sun => self.sun.as_ref(),
            Body::Planet(_) => self.planet.as_ref(),
        }
    }

    /// Least λ of a gear with its race held, (rad/s)².
    pub(super) fn first_gear(&self) -> f64 {
        let gears = [&self.ring, &self.sun, &self.planet].into_iter().flatten();
        gears.map(|own| own.body.first_eigenvalue()).fold(f64::INFINITY, f64::min)
    }

    /// Least λ of the carrier with its bore held, (rad/s)²; infinite if it is rigid.
    pub(super) fn first_carrier(&self) -> f64 {
        self.carrier.as_ref().map_or(f64::INFINITY, |own| own.body.first_eigenvalue())
    }
}

impl OnRadius {
    /// w at an angle where the springs act, along (x, y) directions, for a translation d and u = r θ: along a direction
    /// n with the coefficient of u.
    fn along(&self, d: Complex<f64>, u: f64, angle: f64, n: Complex<f64>, of_u: f64) -> f64 {
        let [constant, double] = self.body.by_translation(self.at);
        let turned = Complex::from_polar(1.0, 2.0 * angle);
        let moved = d * constant + d.conj() * turned * double;
        (moved * n.conj()).re + of_u * u * self.body.by_rotation(self.at) / self.at
    }
}

impl AnalyticSet {
    /// Relative change of the frequency of a group of modes, its mean, by the inertia of elastic displacements; 0 for a
    /// rigid-body mode.
    ///
    /// `[eq:annulus-inertia]` δm = Σ_bodies (2 Σ F·w + λ qᵀM w), f'/f = 1/√(1 + δm), with the rigid motion q of a
    /// body in a mode of unit modal mass.
    /// Source: derived in `docs/fe_dynamics.md` for FE/contact.
    /// Checked by: `validation/tests/closed_forms.rs::stated_errors_hold_with_modes_of_the_bodies`.
    pub fn inertia_change(&self, group: &ModeGroup) -> f64 {
        let count = group.multiplicity as f64;
        let added: f64 = (0..group.multiplicity)
            .map(|j| self.added_mass(group.lambda, &group.vectors.column(j).into()))
            .sum();
        1.0 / (1.0 + added / count).max(1e-3).sqrt() - 1.0
    }

    /// δm of a mode of unit modal mass.
    fn added_mass(&self, lambda: f64, shape: &DVector<f64>) -> f64 {
        let coordinates = &self.model.coordinates;
        let at = |body: Body, axis: Axis| coordinates.of(body, axis).map_or(0.0, |i| shape[i]);
        let motion = |body: Body| {
            let d = Complex::new(at(body, Axis::First), at(body, Axis::Second));
            (d, at(body, Axis::Rotation))
        };
        let planets = self.model.psi.len();
        let mut sum = 0.0;
        for body in Body::all(planets) {
            if let Some(own) = self.bodies.of(body) {
                let ((d, u), [translated, rotated]) = (motion(body), own.body.moved());
                sum += lambda * (translated * d.norm_sqr() + rotated * (u / own.radius).powi(2));
            }
        }
        for spring in &self.model.springs {
            let (central, n) = match spring.id {
                SpringId::SunMesh(n) => (Body::Sun, n),
                SpringId::RingMesh(n) => (Body::Ring, n),
                _ => continue,
            };
            let row = &spring.rows[0];
            let stretch: f64 = row.iter().map(|&(i, b)| b * shape[i]).sum();
            for body in [central, Body::Planet(n)] {
                let Some(own) = self.bodies.of(body) else { continue };
                let of = |axis: Axis| {
                    let i = coordinates.of(body, axis);
                    row.iter().find(|(j, _)| Some(*j) == i).map_or(0.0, |(_, b)| *b)
                };
                let normal = Complex::new(of(Axis::First), of(Axis::Second));
                // A planet meets the sun on the side of the centre, in its own radial and tangential directions.
                let angle = match (body, central) {
                    (Body::Planet(_), Body::Sun) => std::f64::consts::PI,
                    (Body::Planet(_), _) => 0.0,
                    _ => self.model.psi[n],
                };
                let (d, u) = motion(body);
                let w = own.along(d, u, angle, normal, of(Axis::Rotation));
                sum -= 2.0 * spring.stiffness * stretch * w;
            }
        }
        if let Some(own) = &self.bodies.carrier {
            let (d, u) = motion(Body::Carrier);
            let elongation: Vec<f64> = self
                .model
                .springs
                .iter()
                .filter(|s| matches!(s.id, SpringId::PlanetBearing(_)))
                .flat_map(|s| {
                    s.rows.iter().map(|row| row.iter().map(|&(i, b)| b * shape[i]).sum::<f64>())
                })
                .collect();
            let force = &self.bodies.bearings * DVector::from_vec(elongation);
            for (n, psi) in self.model.psi.iter().enumerate() {
                let radial = Complex::from_polar(1.0, *psi);
                let tangential = radial * Complex::new(0.0, 1.0);
                sum -= 2.0 * force[2 * n] * own.along(d, u, *psi, radial, 0.0);
                sum -= 2.0 * force[2 * n + 1] * own.along(d, u, *psi, tangential, 1.0);
            }
        }
        sum
    }
}
