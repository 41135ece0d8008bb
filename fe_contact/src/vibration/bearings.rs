//! Planet bearings on the carrier's pin seats, within one time step.

use dynamics::{AverageAcceleration, Motion};
use gearset::{Axis, Body};
use nalgebra::{DMatrix, DVector};

use super::body::{Port, VibratingBody};
use super::fixed_race_mode::FixedRaceMode;
use super::packed::Packed;
use crate::error::FeError;
use crate::statics::Races;

/// Bearings between the planets' races and the pin seats of a carrier that may be flexible.
///
/// With e the elongations (planet's race less seat, radial and tangential) and Q the bearings'
/// forces,
///
/// ```text
/// Q = (I/k + A)⁻¹ (e + τ ė)
/// ```
///
/// where k is the stiffness of a bearing, A the part of the carrier's static flexibility that its
/// own elastic state does not represent, and τ the ratio of dashpots to stiffness (s).
#[derive(Debug)]
pub(super) struct Bearings {
    /// Elongations of rigid seats on the races' coordinates, 2N×n.
    pub(super) rigid: DMatrix<f64>,
    /// Elongations on the races' coordinates within a step, the carrier's inertia included, 2N×n.
    pub(super) rows: DMatrix<f64>,
    packed_rows: Packed,
    /// I/k + A, m/N.
    pub(super) compliance: DMatrix<f64>,
    ratio: f64,
    /// (K'⁻¹ + G)⁻¹ with K' = (I/k + A)⁻¹ (1 + 2τ/h) and G the carrier's receptance at the seats.
    pub(super) dynamic: DMatrix<f64>,
    /// rowsᵀ (K'⁻¹ + G)⁻¹.
    onto_races: Packed,
    /// (I/k + A) / (1 + 2τ/h).
    softened: DMatrix<f64>,
    pub(super) ports: Vec<Port>,
    pub(super) state: Motion,
    history: DVector<f64>,
    free: DVector<f64>,
    forces: DVector<f64>,
    /// −Q: forces on the seats' ports, positive against the ports' directions, N.
    pressing: Vec<f64>,
    elongation: DVector<f64>,
}

impl Bearings {
    pub(super) fn new(
        races: &Races,
        bearings: &[f64],
        ports: Vec<Port>,
        flexibility: &DMatrix<f64>,
        carrier: &dyn VibratingBody,
        ratio: f64,
    ) -> Self {
        let n = races.seated;
        let mut rigid = DMatrix::zeros(2 * n, races.count);
        for planet in 0..n {
            let (sin, cos) = races.psi[planet].sin_cos();
            let seats = [[cos, sin, 0.0], [-sin, cos, 1.0]];
            for (axis, seat) in Axis::TRANSLATIONS.into_iter().zip(seats) {
                let row = 2 * planet + axis as usize;
                if let Some(i) = races.of(Body::Planet(planet), axis) {
                    rigid[(row, i)] += 1.0;
                }
                for (i, share) in races.places(Body::Carrier).into_iter().zip(seat) {
                    if let Some(i) = i {
                        rigid[(row, i)] -= share;
                    }
                }
            }
        }
        // The flexibility that the carrier's own elastic state represents is not counted twice.
        let carried = carrier.carried_flexibility(&ports);
        let mut compliance =
            DMatrix::from_fn(2 * n, 2 * n, |i, j| flexibility[(i, j)] - carried[i * 2 * n + j]);
        for i in 0..2 * n {
            compliance[(i, i)] += 1.0 / bearings[i / 2];
        }
        let zero = DVector::zeros(2 * n);
        Self {
            rows: rigid.clone(),
            packed_rows: Packed::default(),
            onto_races: Packed::default(),
            rigid,
            dynamic: compliance.clone(),
            softened: compliance.clone(),
            compliance,
            ratio,
            ports,
            state: Motion::at_rest(2 * n),
            history: zero.clone(),
            free: zero.clone(),
            forces: zero.clone(),
            pressing: vec![0.0; 2 * n],
            elongation: zero,
        }
    }

    /// Prepares for a step; returns what the bearings add to the races' stiffness, n×n.
    pub(super) fn prepare(
        &mut self,
        rule: &AverageAcceleration,
        races: &Races,
        carrier: &dyn VibratingBody,
    ) -> Result<DMatrix<f64>, FeError> {
        let count = self.ports.len();
        let receptance = carrier.receptance(&self.ports);
        self.softened = &self.compliance / (1.0 + self.ratio * rule.damping());
        let sum = &self.softened + DMatrix::from_row_slice(count, count, &receptance);
        self.dynamic = sum.cholesky().ok_or_else(unstable)?.inverse();
        self.rows = self.rigid.clone();
        for (row, port) in self.ports.iter().enumerate() {
            let shares = carrier.coupling(port, 0.0);
            for (i, share) in races.places(Body::Carrier).into_iter().zip(shares) {
                if let Some(i) = i {
                    self.rows[(row, i)] -= share;
                }
            }
        }
        let onto_races = self.rows.transpose() * &self.dynamic;
        self.packed_rows = Packed::new(&self.rows);
        self.onto_races = Packed::new(&onto_races);
        Ok(onto_races * &self.rows)
    }

    /// Adds to the races' loads what the bearings contribute from the state at the start of the
    /// step; to be called after the carrier's prediction.
    pub(super) fn predict(
        &mut self,
        rule: &AverageAcceleration,
        carrier: &dyn VibratingBody,
        load: &mut DVector<f64>,
    ) {
        // e_x = Bx − free, (K'⁻¹ + G) Q = e_x − τ' v*
        let weight = self.history_weight(rule);
        for (i, port) in self.ports.iter().enumerate() {
            self.history[i] = weight * rule.velocity_history(self.state.x[i], self.state.v[i]);
            self.free[i] = carrier.free(port) + self.history[i];
        }
        self.onto_races.add_product(self.free.as_slice(), load.as_mut_slice());
    }

    /// Ends the step of bearings and carrier with the races at x (m).
    pub(super) fn finish(
        &mut self,
        rule: &AverageAcceleration,
        carrier: &mut dyn VibratingBody,
        x: &DVector<f64>,
        race: [f64; 3],
    ) {
        self.elongation.fill(0.0);
        self.packed_rows.add_product(x.as_slice(), self.elongation.as_mut_slice());
        if carrier.unknowns() == 0 {
            // The carrier has no elastic state: e = Bx, and Q is not needed.
            self.state.advance(rule, self.elongation.as_slice());
            return;
        }
        // Q = (K'⁻¹ + G)⁻¹ (Bx − free − τ' v*)
        self.elongation -= &self.free;
        self.forces.gemv(1.0, &self.dynamic, &self.elongation, 0.0);
        // e = K'⁻¹ Q + τ' v*
        self.elongation.gemv(1.0, &self.softened, &self.forces, 0.0);
        self.elongation += &self.history;
        self.state.advance(rule, self.elongation.as_slice());
        self.press();
        carrier.finish(race, 0.0, &self.ports, &self.pressing);
    }

    /// Puts bearings and carrier to rest with the races at x (m).
    pub(super) fn rest(
        &mut self,
        carrier: &mut dyn VibratingBody,
        whole: &DMatrix<f64>,
        x: &DVector<f64>,
    ) {
        // Q = (I/k + A_whole)⁻¹ B x
        let forces = whole * (&self.rigid * x);
        self.state = Motion::at_rest(self.ports.len());
        self.state.x.copy_from_slice((&self.compliance * &forces).as_slice());
        self.forces = forces;
        self.press();
        carrier.rest_under(&self.ports, &self.pressing);
    }

    /// τ/(1 + 2τ/h): factor of v* of the elongations in `free`.
    pub(super) fn history_weight(&self, rule: &AverageAcceleration) -> f64 {
        self.ratio / (1.0 + self.ratio * rule.damping())
    }

    /// rowsᵀ (K'⁻¹ + G)⁻¹: load on the races by `free` of the seats, n×2N.
    pub(super) fn seats_onto_races(&self) -> DMatrix<f64> {
        self.rows.transpose() * &self.dynamic
    }

    /// The elongations that belong to a motion of the races and of the carrier's modes.
    pub(super) fn follow(&mut self, races: &Motion, carrier: &dyn VibratingBody, modes: &Motion) {
        let shapes = carrier.modes().unwrap_or_default();
        let lists = [
            (&mut self.state.x, &races.x, &modes.x),
            (&mut self.state.v, &races.v, &modes.v),
            (&mut self.state.a, &races.a, &modes.a),
        ];
        for (own, of_races, of_modes) in lists {
            let rigid = &self.rigid * DVector::from_column_slice(of_races);
            for ((own, rigid), port) in own.iter_mut().zip(rigid.iter()).zip(&self.ports) {
                let along = shapes.iter().zip(of_modes).map(|(m, eta)| port.read(&m.shape) * eta);
                *own = rigid - along.sum::<f64>();
            }
        }
    }

    /// A stretched bearing pulls its seat along the port's direction.
    fn press(&mut self) {
        self.pressing.iter_mut().zip(self.forces.iter()).for_each(|(p, q)| *p = -q);
    }

    /// Stiffness on z = (races, carrier's modes, the rest), N/m.
    pub(super) fn linearised(
        &self,
        modes: &[FixedRaceMode],
        races: usize,
        size: usize,
    ) -> Result<DMatrix<f64>, FeError> {
        let count = self.ports.len();
        let mut rows = DMatrix::zeros(count, size);
        rows.view_mut((0, 0), (count, races)).copy_from(&self.rigid);
        for (i, port) in self.ports.iter().enumerate() {
            for (j, mode) in modes.iter().enumerate() {
                rows[(i, races + j)] = -port.read(&mode.shape);
            }
        }
        let factor = self.compliance.clone().cholesky().ok_or_else(unstable)?;
        Ok(rows.transpose() * factor.solve(&rows))
    }

    /// ∫ ėᵀ (I/k + A)⁻¹ ė dt over a step of rigid seats that moved the races by `moved`, J/s.
    pub(super) fn dashpot_work(&self, rule: &AverageAcceleration, moved: &DVector<f64>) -> f64 {
        let stretched = &self.rigid * moved;
        match self.compliance.clone().cholesky() {
            Some(factor) => stretched.dot(&factor.solve(&stretched)) / rule.step(),
            None => f64::NAN,
        }
    }

    /// ½ Qᵀ (I/k + A) Q at the elongations of the state, J.
    pub(super) fn energy(&self) -> f64 {
        let e = DVector::from_column_slice(&self.state.x);
        match self.compliance.clone().cholesky() {
            Some(factor) => 0.5 * e.dot(&factor.solve(&e)),
            None => f64::NAN,
        }
    }
}

fn unstable() -> FeError {
    FeError::NoEquilibrium("the carrier is not stable".into())
}
