//! The races' equations of motion within one time step: inertia, supports, bearings, rotating
//! frame.

use dynamics::{AverageAcceleration, Motion};
use gearset::{Axis, Body};
use nalgebra::{DMatrix, DVector};
use scene::Scene;

use super::bearings::Bearings;
use super::body::Port;
use super::build;
use super::damping::Proportional;
use super::flexible_bodies::FlexibleBodies;
use super::gyroscopic::GyroscopicTerms;
use super::packed::Packed;
use crate::error::FeError;
use crate::statics::{Races, StaticSet, planet_bearing};

/// Races of all bodies; n: their free coordinates.
#[derive(Debug)]
pub(super) struct RaceDynamics {
    pub(super) damping: Proportional,
    /// Ratio of dashpots to stiffness, s.
    pub(super) bearing_ratio: f64,
    /// Masses of the races' coordinates, rigid bodies, n, kg.
    pub(super) mass: Vec<f64>,
    pub(super) bearings: Bearings,
    /// Stiffness of the central members' supports, n, N/m.
    pub(super) supports: DVector<f64>,
    /// (I/k + A)⁻¹ with the carrier's whole static flexibility, 2N×2N, N/m.
    pub(super) seat_stiffness: DMatrix<f64>,
    /// Terms of the rotating carrier frame, if they act.
    gyroscopic: Option<GyroscopicTerms>,
    /// A: stiffness of the races within a step, without contact, n×n, N/m.
    pub(super) stiffness: Packed,
    /// A⁻¹, n×n, m/N.
    pub(super) inverse: Packed,
    pub(super) motion: Motion,
}

impl RaceDynamics {
    /// At rest at the reference's displacements. `seats`: ports of the carrier's seats and their
    /// static flexibility (2N×2N, m/N); `carrier_speed` (rad/s) if the terms of the rotating frame
    /// act.
    pub(super) fn new(
        statics: &StaticSet<'_>,
        scene: &Scene,
        rule: &AverageAcceleration,
        bodies: &FlexibleBodies<'_>,
        seats: (Vec<Port>, DMatrix<f64>),
        carrier_speed: Option<f64>,
    ) -> Result<Self, FeError> {
        let races = &statics.races;
        let (ports, flexibility) = seats;
        let of_bearings: Vec<f64> = (0..races.seated).map(|n| planet_bearing(scene, n)).collect();
        let ratio = scene.damping.bearing_s;
        let carrier = bodies.carrier.as_ref();
        let bearings = Bearings::new(races, &of_bearings, ports, &flexibility, carrier, ratio);
        let mut whole = flexibility;
        for i in 0..whole.nrows() {
            whole[(i, i)] += 1.0 / of_bearings[i / 2];
        }
        let unstable = || FeError::NoEquilibrium("the carrier is not stable".into());
        let seat_stiffness = whole.cholesky().ok_or_else(unstable)?.inverse();
        let n = races.count;
        let mut mass = vec![0.0; n];
        let mut supports = DVector::zeros(n);
        for body in Body::all(races.planets()) {
            races.add(body, build::body_mass(statics, scene, body)?, &mut mass);
            let own = Axis::ALL.map(|axis| races.support(body, axis));
            races.add(body, own, supports.as_mut_slice());
        }
        let gyroscopic = carrier_speed.map(|speed| GyroscopicTerms::new(races, &mass, speed));
        let mut motion = Motion::at_rest(n);
        motion.x.copy_from_slice(statics.reference().q.as_slice());
        let mut own = Self {
            damping: Proportional {
                alpha: scene.damping.mass_proportional_per_s,
                beta: scene.damping.stiffness_proportional_s,
            },
            bearing_ratio: ratio,
            mass,
            bearings,
            supports,
            seat_stiffness,
            gyroscopic,
            stiffness: Packed::default(),
            inverse: Packed::default(),
            motion,
        };
        own.factorise(statics, rule, bodies)?;
        Ok(own)
    }

    /// A of the races and its inverse.
    fn factorise(
        &mut self,
        statics: &StaticSet<'_>,
        rule: &AverageAcceleration,
        bodies: &FlexibleBodies<'_>,
    ) -> Result<(), FeError> {
        let races = &statics.races;
        let n = races.count;
        let mut a = self.bearings.prepare(rule, races, bodies.carrier.as_ref())?;
        for (body, vibrating) in bodies.all() {
            let own = vibrating.race_stiffness();
            let places = races.places(body);
            for (i, row) in places.into_iter().zip(&own) {
                for (k, value) in places.into_iter().zip(row) {
                    if let (Some(i), Some(k)) = (i, k) {
                        a[(i, k)] += value;
                    }
                }
            }
        }
        for i in 0..n {
            a[(i, i)] += self.supports[i] * (1.0 + self.bearing_ratio * rule.damping());
        }
        if let Some(terms) = &self.gyroscopic {
            a += &terms.gyroscopic * rule.damping() + &terms.centripetal;
        }
        // Stiffness from mesh forces that turn with their lines of action.
        a += &statics.reference().stiffness;
        let singular = || FeError::NoEquilibrium("the races have no inertia".into());
        self.stiffness = Packed::new(&a);
        self.inverse = Packed::new(&a.try_inverse().ok_or_else(singular)?);
        Ok(())
    }

    /// Adds the part of the dashpots of the supports and of the gyroscopic terms that is known at
    /// the start of the step to the load (n, N); `history` receives v* of Newmark's rule (n, m/s).
    pub(super) fn add_history(
        &self,
        rule: &AverageAcceleration,
        history: &mut [f64],
        load: &mut DVector<f64>,
    ) {
        self.motion.velocity_history(rule, history);
        for (i, v) in history.iter().enumerate() {
            load[i] += self.bearing_ratio * self.supports[i] * v;
        }
        if let Some(terms) = &self.gyroscopic {
            for (i, row) in terms.gyroscopic.row_iter().enumerate() {
                load[i] += row.iter().zip(&*history).map(|(g, v)| g * v).sum::<f64>();
            }
        }
    }

    /// Load on the races by v* of Newmark's rule, n×n: α m + τ k of the supports, gyroscopic terms, and bearings
    /// on rigid seats.
    pub(super) fn velocity_load(&self, rule: &AverageAcceleration) -> DMatrix<f64> {
        let weight = self.bearings.history_weight(rule);
        let mut load = self.bearings.seats_onto_races() * &self.bearings.rigid * weight;
        for (i, mass) in self.mass.iter().enumerate() {
            load[(i, i)] += self.damping.alpha * mass + self.bearing_ratio * self.supports[i];
        }
        if let Some(terms) = &self.gyroscopic {
            load += &terms.gyroscopic;
        }
        load
    }

    /// Ends the step of races and carrier with the races at x, n, m.
    pub(super) fn finish(
        &mut self,
        races: &Races,
        rule: &AverageAcceleration,
        bodies: &mut FlexibleBodies<'_>,
        x: &DVector<f64>,
    ) {
        let race = races.displaced(x, Body::Carrier);
        self.bearings.finish(rule, bodies.carrier.as_mut(), x, race);
        self.motion.advance(rule, x.as_slice());
    }

    /// At rest with the races at q, n, m.
    pub(super) fn rest(&mut self, bodies: &mut FlexibleBodies<'_>, q: &DVector<f64>) {
        self.motion = Motion::at_rest(q.len());
        self.motion.x.copy_from_slice(q.as_slice());
        self.bearings.rest(bodies.carrier.as_mut(), &self.seat_stiffness, q);
    }

    /// Kinetic energy of rigid bodies, J.
    pub(super) fn kinetic_energy(&self) -> f64 {
        self.motion.v.iter().zip(&self.mass).map(|(v, m)| 0.5 * m * v * v).sum()
    }

    /// Energy dissipated by αM and the dashpots over a step in which the races move by `moved` (n,
    /// m) from velocities `start_v` (n, m/s), J.
    pub(super) fn damped_since(
        &self,
        rule: &AverageAcceleration,
        moved: &DVector<f64>,
        start_v: &DVector<f64>,
    ) -> f64 {
        let mean_v = 0.5 * (DVector::from_column_slice(&self.motion.v) + start_v);
        let mut damped = self.bearing_ratio * self.bearings.dashpot_work(rule, moved);
        for (i, dx) in moved.iter().enumerate() {
            let c = self.damping.alpha * self.mass[i] + self.bearing_ratio * self.supports[i];
            damped += c * mean_v[i] * dx;
        }
        damped
    }
}
