//! The derivative of the steps of a set with respect to its state at the start of a mesh cycle.
//!
//! A step is affine while the touching cells are the same, apart from the second-order terms of corner gaps.
//! Its derivative follows the step line by line, with gradients in place of numbers
//! ([`VibratingSet::carry_derivative`]). The coordinates are displacements, velocities
//! and accelerations of the races and of the bodies' modes, and the state of the lag of every pair; bearings follow
//! from these. Frames keep the cells that touched in the last step to their position and the second-order terms, so
//! that a whole cycle can be differentiated after it was marched.

use dynamics::{Number, wide};
use gearset::Body;
use nalgebra::{DMatrix, DVector};

use super::body::Port;
use super::derivative::{SetDerivative, Work};
use super::flexible_bodies::FlexibleBodies;
use super::frame::Frame;
use super::gradients::{LagGradients, add, column, column_mut, out_of_turned, turned_into};
use super::set::VibratingSet;
use super::step_rows::{Carrying, StepWeights};

impl VibratingSet<'_> {
    /// Carries the derivative over a step, 1 to the number of steps, of the cycle after `cycles` whole ones.
    ///
    /// `[eq:contact-step-derivative]` With the load L that the histories leave and the change S' of the forces of the
    /// touching pairs with their approaches (`Combination`):
    /// ```text
    /// (A + Rᵀ S' R) x₁' = L' − Rᵀ S' b',   P' = S' (R x₁' + b'),   b' = free' − opened' − F known'.
    /// ```
    /// Source: derived here.
    /// Checked by: `experiments/tests/shooting/derivative.rs::the_derivative_is_that_of_the_cycle`.
    pub(super) fn carry_derivative<T: Number>(
        &self,
        d: &mut SetDerivative<T>,
        step: usize,
        cycles: i64,
    ) {
        let count = self.clock.rotation.count();
        let whole = self.clock.rotation.direction().whole() * (step / count) as i64;
        let (k, cycles) = (step % count, cycles + whole);
        let Some(frame) = self.frames.current(k) else { return };
        let plain = self.frames.at(k).unwrap_or(frame);
        for mesh in &self.pairs.restarts[k] {
            d.meshes[*mesh].move_on(self.pairs.direction);
        }
        let (rule, lag) = (&self.clock.rule, &self.pairs.lag);
        let weights = StepWeights {
            step: rule.step(),
            newmark: [rule.inertia(), rule.damping()],
            lag: lag.weights(),
        };
        d.terms.prepare(frame, plain, &mut d.meshes, lag.forgotten());
        let mut work = std::mem::take(&mut d.work);
        let has_modes = d.elastic.iter().any(|own| own.x.ncols() > 0);
        let bodies = has_modes.then(|| self.predict_bodies(d, frame, (k, cycles), &mut work));
        let Work { load, b, next, forces, rows, matrices, .. } = &mut work;
        let chosen = &frame.combinations[frame.used];
        let modes = has_modes.then_some([load, b, next, forces].map(Vec::as_mut_slice));
        wide(Carrying {
            terms: &d.terms,
            stiffness: chosen.stiffness(),
            inverse: chosen.inverse.entries(),
            weights: &weights,
            races: &mut d.races,
            meshes: &mut d.meshes,
            modes,
            room: rows,
            matrices: matrices.each_mut(),
        });
        d.meshes.iter_mut().for_each(LagGradients::end_step);
        if let Some(bodies) = bodies {
            self.finish_bodies(d, frame, bodies, &work);
        }
        d.work = work;
    }

    /// Approaches of the touching pairs by the bodies' modes.
    fn add_approaches<T: Number>(
        &self,
        d: &SetDerivative<T>,
        frame: &Frame,
        bodies: &[BodyStep<T>],
        b: &mut [T],
    ) {
        for (gear, own) in frame.pattern.own.iter().enumerate() {
            let Some(modal) = self.bodies.gears[gear].vibrating.modal() else { continue };
            let Some(step) = bodies.get(gear + 1) else { continue };
            for ((pair, _), port) in own.iter().zip(&step.ports) {
                let Some(at) = d.terms.touching(*pair) else { continue };
                for (j, mode) in modal.modes.iter().enumerate() {
                    let along = port.read(&mode.shape);
                    add(
                        column_mut(b, d.rows(), at),
                        along,
                        column(step.free.as_slice(), d.rows(), j),
                    );
                }
            }
        }
    }

    /// Starts the step of the bodies' modes and of the bearings; adds their loads on the races.
    fn predict_bodies<T: Number>(
        &self,
        d: &SetDerivative<T>,
        frame: &Frame,
        (k, cycles): (usize, i64),
        work: &mut Work<T>,
    ) -> Vec<BodyStep<T>> {
        let rule = &self.clock.rule;
        let newmark = [rule.inertia(), rule.damping()];
        let races = &self.statics.races;
        let (m, turned) = (d.rows(), cycles as f64 + self.clock.position(k));
        let one = T::of(1.0);
        let mut all = Vec::with_capacity(d.elastic.len());
        d.races.write_histories(newmark, [&mut work.acceleration, &mut work.velocity]);
        let zero = T::of(0.0);
        for (list, columns) in [
            (&mut work.load, races.count),
            (&mut work.next, races.count),
            (&mut work.b, d.terms.count()),
            (&mut work.forces, d.terms.count()),
        ] {
            list.clear();
            list.resize(m * columns, zero);
        }
        for (body, vibrating) in self.bodies.all() {
            let own = &d.elastic[body.index()];
            let histories = own.histories(newmark);
            let mut free = DMatrix::zeros(m, own.x.ncols());
            let angle = match body {
                Body::Carrier => 0.0,
                gear => self.bodies.gears[gear.index() - 1].angle(turned),
            };
            let ports = match (body, own.x.ncols()) {
                (Body::Carrier, _) | (_, 0) => Vec::new(),
                (gear, _) => {
                    let gear = gear.index() - 1;
                    let (ports, gear) = (&frame.pattern.own[gear], &self.bodies.gears[gear]);
                    FlexibleBodies::ports_of(frame, gear, ports, cycles)
                }
            };
            if let Some(modal) = vibrating.modal().filter(|modal| !modal.modes.is_empty()) {
                let super::damping::Proportional { alpha, beta } = modal.damping;
                let c = modal.inertia();
                let of = |i| {
                    let mut sum = DVector::from_column_slice(column(&work.acceleration, m, i));
                    add(sum.as_mut_slice(), alpha, column(&work.velocity, m, i));
                    sum
                };
                let turned = turned_into(angle, races.places(body).map(|place| place.map(of)));
                let mut pulled: [DVector<T>; 3] = std::array::from_fn(|_| DVector::zeros(m));
                for (j, mode) in modal.modes.iter().enumerate() {
                    let (a, v) = (histories[0].column(j), histories[1].column(j));
                    let mut next = a + v * T::of(alpha + beta * mode.lambda);
                    for (gamma, along) in mode.participation.iter().zip(&turned) {
                        if let Some(along) = along {
                            next.axpy(T::of(*gamma), along, one);
                        }
                    }
                    next /= T::of(modal.dynamic[j]);
                    let pull = a + v * T::of(alpha) - &next * T::of(c);
                    for (sum, gamma) in pulled.iter_mut().zip(mode.participation) {
                        sum.axpy(T::of(gamma), &pull, one);
                    }
                    free.set_column(j, &next);
                }
                let pulled = out_of_turned(angle, pulled);
                for (place, turned) in races.places(body).into_iter().zip(pulled) {
                    if let Some(i) = place {
                        add(column_mut(&mut work.load, m, i), 1.0, turned.as_slice());
                    }
                }
            }
            all.push(BodyStep { histories, free, angle, ports });
        }
        if let Some(seats) = all.first().and_then(|carrier| self.seats_of_modes(carrier)) {
            let onto = self.race_dynamics.bearings.seats_onto_races().transpose();
            let loads = seats * onto.map(T::of);
            add(&mut work.load, 1.0, loads.as_slice());
        }
        self.add_approaches(d, frame, &all, &mut work.b);
        all
    }

    /// Ends the step of the bodies' modes with the races' displacements and the forces of the touching pairs.
    fn finish_bodies<T: Number>(
        &self,
        d: &mut SetDerivative<T>,
        frame: &Frame,
        bodies: Vec<BodyStep<T>>,
        work: &Work<T>,
    ) {
        let rule = &self.clock.rule;
        let newmark = [rule.inertia(), rule.damping()];
        let races = &self.statics.races;
        let (m, one) = (d.rows(), T::of(1.0));
        for ((body, vibrating), step) in self.bodies.all().zip(bodies) {
            let Some(modal) = vibrating.modal().filter(|modal| !modal.modes.is_empty()) else {
                continue;
            };
            let c = modal.inertia();
            let of = |i| DVector::from_column_slice(column(&work.next, m, i));
            let turned = turned_into(step.angle, races.places(body).map(|place| place.map(of)));
            let mut next = step.free.clone();
            // Forces on the ports: of the bearings on the carrier, of the tooth pairs on gears.
            if body == Body::Carrier {
                // Q' = (K'⁻¹ + G)⁻¹ (B x' − free' − τ' v*')
                let bearings = &self.race_dynamics.bearings;
                let x = DMatrix::from_column_slice(m, races.count, &work.next);
                let velocity = DMatrix::from_column_slice(m, races.count, &work.velocity);
                let weighted = bearings.rigid.transpose() * bearings.history_weight(rule);
                let mut stretched = x * bearings.rows.transpose().map(T::of);
                stretched -= velocity * weighted.map(T::of);
                if let Some(seats) = self.seats_of_modes(&step) {
                    stretched -= seats;
                }
                let pulling = stretched * bearings.dynamic.map(T::of);
                for (port, pulling) in bearings.ports.iter().zip(pulling.column_iter()) {
                    for (j, mode) in modal.modes.iter().enumerate() {
                        let along = port.read(&mode.shape) / modal.dynamic[j];
                        next.column_mut(j).axpy(T::of(along), &pulling, one);
                    }
                }
            } else {
                let own = frame.pattern.own[body.index() - 1].iter().zip(&step.ports);
                for ((pair, _), port) in own {
                    let Some(at) = d.terms.touching(*pair) else { continue };
                    for (j, mode) in modal.modes.iter().enumerate() {
                        let along = -port.read(&mode.shape) / modal.dynamic[j];
                        let forces = column(&work.forces, m, at);
                        add(column_mut(next.as_mut_slice(), m, j), along, forces);
                    }
                }
            }
            for (j, mode) in modal.modes.iter().enumerate() {
                for (gamma, along) in mode.participation.iter().zip(&turned) {
                    if let Some(along) = along {
                        let factor = T::of(-c * gamma / modal.dynamic[j]);
                        next.column_mut(j).axpy(factor, along, one);
                    }
                }
            }
            let [a, v] = step.histories.each_ref().map(|list| list.as_slice());
            d.elastic[body.index()].advance(newmark, next.as_slice(), [a, v]);
        }
    }

    /// What the carrier's modes add to `free` of the bearings, by seats; `None` for a carrier without modes.
    fn seats_of_modes<T: Number>(&self, carrier: &BodyStep<T>) -> Option<DMatrix<T>> {
        let modal = self.bodies.carrier.modal().filter(|modal| !modal.modes.is_empty())?;
        let bearings = &self.race_dynamics.bearings;
        let weight = bearings.history_weight(&self.clock.rule);
        let one = T::of(1.0);
        let mut seats = DMatrix::zeros(carrier.free.nrows(), bearings.ports.len());
        for (i, port) in bearings.ports.iter().enumerate() {
            for (j, mode) in modal.modes.iter().enumerate() {
                let along = port.read(&mode.shape);
                let mut seat = seats.column_mut(i);
                seat.axpy(T::of(along), &carrier.free.column(j), one);
                seat.axpy(T::of(-along * weight), &carrier.histories[1].column(j), one);
            }
        }
        Some(seats)
    }
}

/// The start of a step of one body.
struct BodyStep<T> {
    histories: [DMatrix<T>; 2],
    /// η at the end of the step with the race at its origin and no loads.
    free: DMatrix<T>,
    /// Angle of the body's frame, rad.
    angle: f64,
    /// Ports of a gear's pairs.
    ports: Vec<Port>,
}
