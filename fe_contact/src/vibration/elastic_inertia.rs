//! What quasi-static bodies lack in one mode of a set, to first order: the inertia of their elastic displacement, and
//! the static flexibility between different meshes of a body.
//!
//! q is the motion of a body's race in the mode, u its elastic displacement with the race held. With inertia in the
//! body,
//!
//! ```text
//! (K − λ M_ff) u = −Σ_a ℓ_aᵀ P_a + λ M_fr q,     u_s = −K⁻¹ Σ_a ℓ_aᵀ P_a,   K w = M_fr q,   u_1 = u_s + λ w
//! ```
//!
//! Eliminating u leaves the races with the additional mass, exactly, δm of [`ElasticInertia::of_mode`]. λ_1 is the
//! first eigenvalue with the race held. R is the series u_1ᵀ M_ff (1 + λK⁻¹M_ff + …) u_1. By Rayleigh's quotient of
//! the mode, δλ/λ = −Σ δm for a shape of unit modal mass, to first order in δm.
//!
//! Flexibility X_ab = ℓ_a K⁻¹ ℓ_bᵀ between pairs of different meshes of a body takes −PᵀX P from the stiffness of the
//! mode.

use std::sync::Arc;

use gearset::Body;
use nalgebra::DVector;

use super::body::into_frame;
use super::frame::Frame;
use super::linear::LinearSet;
use super::set::VibratingSet;
use super::teeth::ToothPoint;
use crate::body::{Accelerated, CarrierBody, Factor, GearBody, ToothForce};
use crate::error::FeError;

/// Static displacements of the bodies of a set under accelerations of their races.
#[derive(Debug)]
pub struct ElasticInertia {
    /// Ring, sun, planet: planets are alike in what is elastic.
    gears: Vec<Accelerated>,
    carrier: Option<AcceleratedCarrier>,
}

/// What quasi-static bodies lack in a mode, as relative changes of λ = ω².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticShift {
    /// δλ/λ = −Σ (2 qᵀM_rf u_s + λ qᵀM_rf w) over the bodies.
    pub inertia: f64,
    /// Σ R: what the inertia lowers λ by besides, at most; infinite if λ ≥ λ_1 of a body.
    pub remainder: f64,
    /// δλ/λ = −PᵀX P/λ of the flexibility between meshes.
    pub coupling: f64,
}

#[derive(Debug)]
struct AcceleratedCarrier {
    factor: Arc<Factor>,
    /// w of accelerations along x and y (s²) and about the centre (m s²).
    displacement: [Vec<f64>; 3],
    /// Least Rayleigh quotient of these, (rad/s)².
    first: f64,
}

impl AcceleratedCarrier {
    fn new(body: &CarrierBody) -> Self {
        let (matrices, factor) = (&body.matrices, body.factor.clone());
        let displacement = matrices.coupling.clone().map(|mut column| {
            factor.solve_one(&mut column);
            column
        });
        let quotient = |k: usize| {
            let w = &displacement[k];
            product(&matrices.coupling[k], w) / energy(body, w)
        };
        let first = (0..3).map(quotient).fold(f64::INFINITY, f64::min);
        Self { factor, displacement, first }
    }

    /// w of an acceleration of the race (x, y, θ).
    fn displaced(&self, race: [f64; 3]) -> Vec<f64> {
        let mut w = vec![0.0; self.displacement[0].len()];
        for (part, q) in self.displacement.iter().zip(race) {
            w.iter_mut().zip(part).for_each(|(w, part)| *w += q * part);
        }
        w
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// uᵀ M_ff u of the carrier.
fn energy(body: &CarrierBody, u: &[f64]) -> f64 {
    let mut inertia = vec![0.0; u.len()];
    body.matrices.mass.multiply_add(1.0, u, &mut inertia);
    product(&inertia, u)
}

impl ElasticInertia {
    /// Of the bodies of a set; `None` if the teeth of a gear are not meshed alike.
    ///
    /// # Errors
    /// If a body cannot be solved.
    pub fn new(set: &VibratingSet<'_>) -> Result<Option<Self>, FeError> {
        let gears = set.bodies.gears.iter().take(3);
        let gears = gears.map(|gear| Accelerated::new(gear.body)).collect::<Result<Vec<_>, _>>()?;
        let Some(gears) = gears.into_iter().collect() else { return Ok(None) };
        let carrier = set.races().carrier.as_ref().filter(|body| !body.is_rigid);
        let carrier = carrier.map(|body| AcceleratedCarrier::new(body));
        Ok(Some(Self { gears, carrier }))
    }

    /// Least Rayleigh quotient of the displacements, close to the first eigenvalue λ_1 of a body with its race held,
    /// (rad/s)².
    pub fn first(&self) -> f64 {
        let carrier = self.carrier.as_ref().map_or(f64::INFINITY, |own| own.first);
        self.gears.iter().map(Accelerated::first).fold(carrier, f64::min)
    }

    /// The change of a mode of unit modal mass (`shape`, on the races' coordinates) at `lambda` (rad/s)² of the set of
    /// quasi-static bodies `set`, linearised as `linear`.
    ///
    /// `[eq:elastic-inertia]` With K w = M_fr q and u_s = −K⁻¹ Σ_a ℓ_aᵀ P_a:
    /// ```text
    /// δm = 2 qᵀM_rf u_s + λ qᵀM_rf w + R,   0 ≤ R ≤ u_1ᵀM_ff u_1 /(1 − λ/λ_1)   (λ < λ_1),
    /// qᵀM_rf u_s = −Σ_a P_a ℓ_a w.
    /// ```
    /// Source: derived in `docs/fe_dynamics.md`.
    /// Checked by: `experiments/tests/elastic_inertia.rs::first_order_changes_are_those_by_a_hundred_modes`,
    /// `fe_contact/tests/sector_ring.rs::an_accelerated_race_displaces_a_ring_of_sectors_as_the_whole_gear`,
    /// `fe_contact/src/vibration/elastic_inertia.rs::a_bar_on_a_spring_changes_as_by_its_exact_frequency`.
    ///
    /// # Errors
    /// If the set has no pairs at its present position.
    pub fn of_mode(
        &self,
        set: &VibratingSet<'_>,
        linear: &LinearSet,
        shape: &[f64],
        lambda: f64,
    ) -> Result<ElasticShift, FeError> {
        let lost = || FeError::NoEquilibrium("no mesh touches: a mode has no mesh forces".into());
        let frame = set.frames.current(set.clock.step_in_cycle).ok_or_else(lost)?;
        let z = DVector::from_column_slice(shape);
        // P = S R z
        let forces = &linear.contact * (&linear.rows * &z);
        let mut sum = ElasticShift { inertia: 0.0, remainder: 0.0, coupling: 0.0 };
        self.add_carrier(set, &z, lambda, &mut sum);
        let across = frame.pattern.across(&set.bodies.gears);
        for (k, (own, across)) in frame.pattern.own.iter().zip(across).enumerate() {
            self.add_gear(set, frame, k, (&z, &forces), lambda, &mut sum);
            for (i, (a, _)) in own.iter().enumerate() {
                for (j, (b, _)) in own.iter().enumerate() {
                    sum.coupling -= forces[*a] * across[(i, j)] * forces[*b] / lambda;
                }
            }
        }
        Ok(sum)
    }

    fn add_gear(
        &self,
        set: &VibratingSet<'_>,
        frame: &Frame,
        k: usize,
        (z, forces): (&DVector<f64>, &DVector<f64>),
        lambda: f64,
        sum: &mut ElasticShift,
    ) {
        let gear = set.bodies.gears[k].body;
        let own = &self.gears[k.min(self.gears.len() - 1)];
        let body = Body::from_index(k + 1);
        let mut q = set.races().displaced(z, body);
        q[2] /= set.races().radii[body.kind()];
        let [translated, turned] = [q[0] * q[0] + q[1] * q[1], q[2] * q[2]];
        // λ qᵀM_rf K⁻¹ M_fr q
        let [c, r] = own.coupled;
        sum.inertia -= lambda * (c * translated + r * turned);
        let (pressing, axes) = pressing(frame, k, gear, forces);
        for (force, axis) in pressing.iter().zip(&axes) {
            // − 2 qᵀM_rf u_s = 2 P ℓ w
            let q = into_frame(q, *axis);
            sum.inertia += 2.0 * force.force * own.at(gear, (force.load, force.direction), q);
        }
        let first = axes.first().copied().unwrap_or(0.0);
        let race = into_frame(q, first).map(|x| lambda * x);
        let energy = own.energy(gear, &pressing, race);
        sum.remainder += bounded(energy, lambda, own.first());
    }

    fn add_carrier(
        &self,
        set: &VibratingSet<'_>,
        z: &DVector<f64>,
        lambda: f64,
        sum: &mut ElasticShift,
    ) {
        let (Some(own), Some(body)) = (&self.carrier, &set.races().carrier) else { return };
        let mut q = set.races().displaced(z, Body::Carrier);
        q[2] /= set.races().radii[0];
        // w of q, and the force Q = (I/k + A)⁻¹ B z of each bearing on its seat
        let w = own.displaced(q);
        let bearings = &set.race_dynamics.bearings;
        let forces = &set.race_dynamics.seat_stiffness * (&bearings.rigid * z);
        let mut u = vec![0.0; body.matrices.size];
        for (port, force) in bearings.ports.iter().zip(forces.iter()) {
            sum.inertia -= 2.0 * force * port.read(&w);
            port.add_to(*force, &mut u);
        }
        let inertia = body.matrices.coupling.iter().zip(q);
        sum.inertia -= lambda * inertia.map(|(m, q)| q * product(m, &w)).sum::<f64>();
        own.factor.solve_one(&mut u);
        u.iter_mut().zip(&w).for_each(|(u, w)| *u += lambda * w);
        sum.remainder += bounded(energy(body, &u), lambda, own.first);
    }
}

/// The forces of a frame's pairs on the teeth of gear k, with the angles of the teeth's axes in the frame of its race,
/// rad. Tooth 0 of the gear is taken to be the one of the first force.
fn pressing<'f>(
    frame: &'f Frame,
    k: usize,
    gear: &GearBody,
    forces: &DVector<f64>,
) -> (Vec<ToothForce<'f>>, Vec<f64>) {
    let ports = frame.pattern.own[k].iter().filter(|(pair, _)| forces[*pair] != 0.0);
    let points = ports
        .filter_map(|(pair, e)| Some((forces[*pair], &frame.pattern.ends[*pair].as_ref()?[*e])));
    let points: Vec<_> = points.collect();
    let axes: Vec<f64> = points.iter().map(|(_, point)| point.axis).collect();
    let pitch = gear.mesh.outline.gear().pitch_angle();
    let one = |(force, point): &(f64, &'f ToothPoint)| ToothForce {
        force: *force,
        tooth: ((point.axis - axes[0]) / pitch).round() as i64,
        load: point.end.load.as_slice(),
        direction: point.end.direction,
    };
    (points.iter().map(one).collect(), axes)
}

/// u_1ᵀM_ff u_1/(1 − λ/λ_1).
fn bounded(energy: f64, lambda: f64, first: f64) -> f64 {
    if lambda < first { energy / (1.0 - lambda / first) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    /// An elastic bar of mass 1 on a race without mass, whose tip a spring of stiffness κ EA/L holds. Exactly β tan β =
    /// κ with λ = β² (in units of the bar), and with a quasi-static bar λ = κ/(1 + κ), so that
    ///
    /// ```text
    /// δλ/λ = 2κ/3 + O(κ²):   −2 qᵀM_rf u_s = κ,   −λ qᵀM_rf w = −κ/3
    /// ```
    #[test]
    fn a_bar_on_a_spring_changes_as_by_its_exact_frequency() {
        const ELEMENTS: usize = 200;
        let h = 1.0 / ELEMENTS as f64;
        let stretched = |i: usize, k: usize| match (i, k) {
            _ if i == k => {
                if i + 1 == ELEMENTS {
                    1.0
                } else {
                    2.0
                }
            }
            _ if i.abs_diff(k) == 1 => -1.0,
            _ => 0.0,
        };
        let moved = |i: usize, k: usize| match (i, k) {
            _ if i == k => {
                if i + 1 == ELEMENTS {
                    2.0
                } else {
                    4.0
                }
            }
            _ if i.abs_diff(k) == 1 => 1.0,
            _ => 0.0,
        };
        // Node 0 is the race.
        let k = DMatrix::from_fn(ELEMENTS, ELEMENTS, |i, j| stretched(i, j) / h);
        let m = DMatrix::from_fn(ELEMENTS, ELEMENTS, |i, j| moved(i, j) * h / 6.0);
        let mut m_fr = &m * DVector::from_element(ELEMENTS, 1.0);
        m_fr[0] += h / 6.0;
        let solved = k.cholesky().unwrap();
        for kappa in [1e-3, 1e-2] {
            let lambda = kappa / (1.0 + kappa);
            // q = 1, P = λ
            let mut tip = DVector::zeros(ELEMENTS);
            tip[ELEMENTS - 1] = -lambda;
            let (u_s, w) = (solved.solve(&tip), solved.solve(&m_fr));
            let (stretch, own) = (2.0 * m_fr.dot(&u_s), lambda * m_fr.dot(&w));
            assert!((stretch + kappa).abs() < 2.0 * kappa * kappa, "{stretch:e}");
            assert!((own - kappa / 3.0).abs() < kappa * kappa, "{own:e}");
            let u_1 = u_s + lambda * w;
            let rest = u_1.dot(&(&m * &u_1));
            // β tan β = κ by Newton's method
            let mut beta = kappa.sqrt();
            for _ in 0..20 {
                let (sin, cos) = f64::sin_cos(beta);
                let slope = sin / cos + beta / (cos * cos);
                beta -= (beta * sin / cos - kappa) / slope;
            }
            let exact = beta * beta / lambda - 1.0;
            let first = 1.0 / (1.0 + stretch + own + rest) - 1.0;
            assert!((exact - 2.0 * kappa / 3.0).abs() < kappa * kappa, "{exact:e}");
            assert!((first - exact).abs() < 0.5 * kappa * kappa, "{first:e} {exact:e}");
        }
    }
}
