//! The derivative of the steps of a set with respect to its state at the start of a mesh cycle.
//!
//! A step is affine while the touching cells are the same, apart from the second-order terms of corner gaps.
//! Its derivative follows the step line by line, with gradients in place of numbers:
//!
//! ```text
//! x₁' = A⁻¹ (L' − Rᵀ P'),   P' = S W (R A⁻¹ L' + free' − opened' − F known')
//! ```
//!
//! where L is the load that the histories leave, and S W the change of the forces of the touching pairs with
//! their approaches. The coordinates are displacements, velocities and accelerations of the races and of the
//! bodies' modes, and the state of the lag of every pair; bearings follow from these.

use nalgebra::{DMatrix, DVector};

use super::derivative::{COMPRESSED, SetDerivative};
use super::frame::Frame;
use super::gradients::{out_of_turned, turned_into};
use super::set::VibratingSet;
use crate::statics::CARRIER;

impl VibratingSet<'_> {
    /// Carries the derivative over the last step.
    pub fn carry_derivative(&self, d: &mut SetDerivative) {
        let k = self.clock.step_in_cycle;
        let Some(frame) = self.frames.current(k) else { return };
        let plain = self.frames.at(k).unwrap_or(frame);
        for mesh in &self.pairs.restarts[k] {
            d.meshes[*mesh].move_on();
        }
        let weights = self.pairs.lag.weights();
        d.meshes.iter_mut().for_each(|mesh| mesh.predict(weights));
        let (rule, m) = (&self.clock.rule, d.rows());
        let newmark = [rule.inertia(), rule.damping()];
        let histories = d.races.histories(newmark[0], newmark[1]);
        // L' = m a*' + (α m + τ k + G + bearings) v*'
        let mut load = &histories[1] * &d.velocity_load;
        for (i, mass) in self.race_dynamics.mass.iter().enumerate() {
            load.column_mut(i).axpy(*mass, &histories[0].column(i), 1.0);
        }
        let bodies = self.predict_bodies(d, &histories, &mut load);
        self.add_bent(d, plain, &mut load);
        let free = &load * &d.inverse;
        let chosen = &frame.combinations[frame.used];
        let mut b = DMatrix::zeros(m, chosen.touching.len());
        for (column, pair) in chosen.touching.iter().enumerate() {
            let mut own = b.column_mut(column);
            for (i, r) in frame.rows[*pair].entries() {
                own.axpy(r, &free.column(i), 1.0);
            }
        }
        self.add_gaps(d, frame, &bodies, &mut b);
        // P' = S W b'
        let forces = b * chosen.response.transpose();
        for (column, pair) in chosen.touching.iter().enumerate() {
            for (i, r) in frame.rows[*pair].entries() {
                load.column_mut(i).axpy(-r, &forces.column(column), 1.0);
            }
        }
        let next = &load * &d.inverse;
        self.finish_bodies(d, frame, bodies, (&next, &forces));
        for (mesh, own) in frame.meshes.iter().zip(&mut d.meshes) {
            let pairs = mesh.first..mesh.first + mesh.count;
            let touching = chosen.touching.iter().enumerate().filter(|(_, p)| pairs.contains(*p));
            let pressed: Vec<_> = touching
                .filter_map(|(column, pair)| Some((frame.pattern.slots[*pair].place()?, column)))
                .collect();
            own.advance(weights[0], &pressed, &forces);
        }
        d.races.advance(newmark, next, histories);
        d.steps += 1;
        if COMPRESSED.contains(&d.steps) {
            d.compress(newmark[1]);
        }
    }

    /// Load on the races from the second-order terms of corner gaps.
    fn add_bent(&self, d: &SetDerivative, frame: &Frame, load: &mut DMatrix<f64>) {
        for bend in frame.bends.iter().filter(|bend| bend.force > 0.0) {
            let expected = d.expected(self.clock.rule.step(), &bend.row);
            let mut pressed = expected * (bend.curvature * bend.force);
            if let Some(slot) = bend.slot.place() {
                let [_, now, before] = d.meshes[bend.mesh].lists();
                let share = bend.curvature * bend.moved;
                pressed.axpy(2.0 * share, &now.column(slot), 1.0);
                pressed.axpy(-share, &before.column(slot), 1.0);
            }
            for (i, r) in bend.row.entries() {
                load.column_mut(i).axpy(r, &pressed, 1.0);
            }
        }
    }

    /// Adds to the approaches of the touching pairs what corner gaps, the bodies' modes and the lag contribute.
    fn add_gaps(
        &self,
        d: &SetDerivative,
        frame: &Frame,
        bodies: &[BodyStep],
        b: &mut DMatrix<f64>,
    ) {
        let touching = &frame.combinations[frame.used].touching;
        for bend in &frame.bends {
            let Some(column) = touching.iter().position(|pair| *pair == bend.pair) else {
                continue;
            };
            let expected = d.expected(self.clock.rule.step(), &bend.row);
            b.column_mut(column).axpy(-bend.curvature * bend.moved, &expected, 1.0);
        }
        for (gear, own) in frame.pattern.own.iter().enumerate() {
            let Some(modal) = self.bodies.gears[gear].vibrating.modal() else { continue };
            let ports = &self.bodies.ports[gear].0;
            for ((pair, _), port) in own.iter().zip(ports) {
                let Some(column) = touching.iter().position(|p| p == pair) else { continue };
                for (j, mode) in modal.modes.iter().enumerate() {
                    let along = port.read(&mode.shape);
                    b.column_mut(column).axpy(along, &bodies[gear + 1].free.column(j), 1.0);
                }
            }
        }
        let mut lags = frame.lags.as_slice();
        for (own, mesh) in d.meshes.iter().zip(&frame.meshes) {
            let rows = frame.lagged_by(mesh);
            for slot in &frame.pattern.slots[mesh.first..mesh.first + mesh.count] {
                let column;
                (column, lags) = lags.split_at(rows.len());
                let Some(place) = slot.place().filter(|place| own.is_live(*place)) else {
                    continue;
                };
                let known = own.known(place);
                for (row, f) in rows.clone().zip(column).filter(|(_, f)| **f != 0.0) {
                    if let Some(at) = touching.iter().position(|pair| *pair == row) {
                        b.column_mut(at).axpy(-f, &known, 1.0);
                    }
                }
            }
        }
    }

    /// Starts the step of the bodies' modes and of the bearings; adds their loads on the races.
    fn predict_bodies(
        &self,
        d: &SetDerivative,
        race: &[DMatrix<f64>; 2],
        load: &mut DMatrix<f64>,
    ) -> Vec<BodyStep> {
        let rule = &self.clock.rule;
        let races = &self.statics.races;
        let (m, turned) = (d.rows(), self.clock.turned());
        let mut all = Vec::with_capacity(d.elastic.len());
        for (body, vibrating) in self.bodies.all() {
            let own = &d.elastic[body];
            let histories = own.histories(rule.inertia(), rule.damping());
            let mut free = DMatrix::zeros(m, own.x.ncols());
            let angle = match body {
                CARRIER => 0.0,
                gear => self.bodies.gears[gear - 1].angle(turned),
            };
            if let Some(modal) = vibrating.modal().filter(|modal| !modal.modes.is_empty()) {
                let super::damping::Proportional { alpha, beta } = modal.damping;
                let c = modal.inertia();
                let turned = turned_into(angle, |axis| {
                    races.of(body, axis).map(|i| race[0].column(i) + race[1].column(i) * alpha)
                });
                let mut pulled: [DVector<f64>; 3] = std::array::from_fn(|_| DVector::zeros(m));
                for (j, mode) in modal.modes.iter().enumerate() {
                    let (a, v) = (histories[0].column(j), histories[1].column(j));
                    let mut next = a + v * (alpha + beta * mode.lambda);
                    for (gamma, along) in mode.participation.iter().zip(&turned) {
                        if let Some(along) = along {
                            next.axpy(*gamma, along, 1.0);
                        }
                    }
                    next /= modal.dynamic[j];
                    let pull = a + v * alpha - &next * c;
                    for (sum, gamma) in pulled.iter_mut().zip(mode.participation) {
                        sum.axpy(gamma, &pull, 1.0);
                    }
                    free.set_column(j, &next);
                }
                for (axis, turned) in out_of_turned(angle, pulled).into_iter().enumerate() {
                    if let Some(i) = races.of(body, axis) {
                        load.column_mut(i).axpy(1.0, &turned, 1.0);
                    }
                }
            }
            all.push(BodyStep { histories, free, angle });
        }
        if let Some(seats) = self.seats_of_modes(&all[CARRIER]) {
            *load += seats * self.race_dynamics.bearings.seats_onto_races().transpose();
        }
        all
    }

    /// Ends the step of the bodies' modes with the races' displacements and the forces of the touching pairs.
    fn finish_bodies(
        &self,
        d: &mut SetDerivative,
        frame: &Frame,
        bodies: Vec<BodyStep>,
        (x, forces): (&DMatrix<f64>, &DMatrix<f64>),
    ) {
        let rule = &self.clock.rule;
        let races = &self.statics.races;
        let touching = &frame.combinations[frame.used].touching;
        for ((body, vibrating), step) in self.bodies.all().zip(bodies) {
            let Some(modal) = vibrating.modal().filter(|modal| !modal.modes.is_empty()) else {
                continue;
            };
            let c = modal.inertia();
            let turned = turned_into(step.angle, |axis| {
                races.of(body, axis).map(|i| x.column(i).into_owned())
            });
            let mut next = step.free.clone();
            // Forces on the ports: of the bearings on the carrier, of the tooth pairs on gears.
            if body == CARRIER {
                // Q' = (K'⁻¹ + G)⁻¹ (B x' − free' − τ' v*')
                let bearings = &self.race_dynamics.bearings;
                let [_, velocity] = d.races.histories(rule.inertia(), rule.damping());
                let mut stretched = x * bearings.rows.transpose();
                stretched -= velocity * bearings.rigid.transpose() * bearings.history_weight(rule);
                if let Some(seats) = self.seats_of_modes(&step) {
                    stretched -= seats;
                }
                let pulling = stretched * &bearings.dynamic;
                for (port, pulling) in bearings.ports.iter().zip(pulling.column_iter()) {
                    for (j, mode) in modal.modes.iter().enumerate() {
                        let along = port.read(&mode.shape) / modal.dynamic[j];
                        next.column_mut(j).axpy(along, &pulling, 1.0);
                    }
                }
            } else {
                let own = frame.pattern.own[body - 1].iter().zip(&self.bodies.ports[body - 1].0);
                for ((pair, _), port) in own {
                    let Some(column) = touching.iter().position(|p| p == pair) else { continue };
                    for (j, mode) in modal.modes.iter().enumerate() {
                        let along = -port.read(&mode.shape) / modal.dynamic[j];
                        next.column_mut(j).axpy(along, &forces.column(column), 1.0);
                    }
                }
            }
            for (j, mode) in modal.modes.iter().enumerate() {
                for (gamma, along) in mode.participation.iter().zip(&turned) {
                    if let Some(along) = along {
                        next.column_mut(j).axpy(-c * gamma / modal.dynamic[j], along, 1.0);
                    }
                }
            }
            d.elastic[body].advance([rule.inertia(), rule.damping()], next, step.histories);
        }
    }

    /// What the carrier's modes add to `free` of the bearings, by seats; `None` for a carrier without modes.
    fn seats_of_modes(&self, carrier: &BodyStep) -> Option<DMatrix<f64>> {
        let modal = self.bodies.carrier.modal().filter(|modal| !modal.modes.is_empty())?;
        let bearings = &self.race_dynamics.bearings;
        let weight = bearings.history_weight(&self.clock.rule);
        let mut seats = DMatrix::zeros(carrier.free.nrows(), bearings.ports.len());
        for (i, port) in bearings.ports.iter().enumerate() {
            for (j, mode) in modal.modes.iter().enumerate() {
                let along = port.read(&mode.shape);
                let mut seat = seats.column_mut(i);
                seat.axpy(along, &carrier.free.column(j), 1.0);
                seat.axpy(-along * weight, &carrier.histories[1].column(j), 1.0);
            }
        }
        Some(seats)
    }
}

/// The start of a step of one body.
struct BodyStep {
    histories: [DMatrix<f64>; 2],
    /// η at the end of the step with the race at its origin and no loads.
    free: DMatrix<f64>,
    /// Angle of the body's frame, rad.
    angle: f64,
}
