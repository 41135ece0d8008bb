//! What quasi-static gears lack in a moving set, at one step, to first order: the inertia of their elastic displacements and the static
//! flexibility between different meshes of a gear.
//!
//! With the equations of [`ElasticInertia`](super::ElasticInertia) (q: motion of the races, u_s: elastic displacements under the
//! forces P of tooth pairs, w: under accelerations of the races) the races' equation of motion gains to first order the load
//!
//! ```text
//! f = − d²/dt² (p − A q̈) + T q̈ + Gᵀ X P,   G = S R,   T = Gᵀ W,   p = −Wᵀ P
//! ```
//!
//! W: approach of pairs, a row each, under unit accelerations of the races (ℓ w); A: M_rf w of unit accelerations; X: static
//! flexibility between pairs of different meshes of a gear. A small change δ of the motion changes the forces by P = G δ, hence the load by
//!
//! ```text
//! V δ = d²/dt² (Tᵀ δ + A δ̈) + T δ̈ + Y δ,   Y = Gᵀ X G
//! ```
//!
//! For motion in a mode φ of the set at rest, φᵀ V φ is the change of its eigenvalue by gears in
//! [`ElasticInertia::of_mode`](super::ElasticInertia::of_mode) with the other sign, less the kinetic energy of the displacements under the forces
//! ([`ElasticMass`](super::ElasticMass)). The carrier has equations of its own ([`ElasticCarrier`](super::ElasticCarrier)).

use nalgebra::{DMatrix, DVector, Matrix3, Matrix3xX, Vector3};

use super::body::into_frame;
use super::elastic_gears::ElasticGears;
use super::elastic_mass::PressedTooth;
use super::frame::Frame;
use super::linear::LinearSet;
use super::set::VibratingSet;
use crate::error::FeError;
use crate::statics::PLANETS;

/// Load and its change by the motion at one step, on the n coordinates of the races.
#[derive(Debug, Clone, PartialEq)]
pub struct ElasticLoad {
    /// p, kg m: M_rf u_s of the displacement by pair forces.
    pub pressed: DVector<f64>,
    /// Gᵀ X P, N.
    pub coupled: DVector<f64>,
    /// T, n×n, kg: load by accelerations under which pairs give way.
    pub opened: DMatrix<f64>,
    /// A, n×n, kg s².
    pub accelerated: DMatrix<f64>,
    /// Y, n×n, N/m.
    pub coupling: DMatrix<f64>,
    /// Forces on the teeth of each gear.
    pub(super) pressing: Vec<Vec<PressedTooth>>,
    /// What the number of a tooth at a given place changes by from one mesh cycle to the next, for each gear.
    pub(super) teeth_per_cycle: Vec<i64>,
}

impl ElasticGears {
    /// At the present step of a turning set, which is linearised there as `linear`.
    ///
    /// # Errors
    /// If the set has not been stepped or put to rest yet.
    pub fn load(&self, set: &VibratingSet<'_>, linear: &LinearSet) -> Result<ElasticLoad, FeError> {
        let frame = set.frames.current(set.clock.step_in_cycle).ok_or_else(lost)?;
        let n = linear.races;
        let (vector, matrix) = (DVector::zeros(n), DMatrix::zeros(n, n));
        let mut load = ElasticLoad {
            pressed: vector.clone(),
            coupled: vector,
            opened: matrix.clone(),
            accelerated: matrix.clone(),
            coupling: matrix,
            pressing: vec![Vec::new(); set.bodies.gears.len()],
            teeth_per_cycle: set.bodies.gears.iter().map(|gear| gear.teeth_per_cycle()).collect(),
        };
        // G
        let made = &linear.contact * &linear.rows;
        for k in 0..set.bodies.gears.len() {
            self.add_gear_load(set, frame, (k, &made), &mut load);
        }
        Ok(load)
    }

    fn add_gear_load(
        &self,
        set: &VibratingSet<'_>,
        frame: &Frame,
        (k, made): (usize, &DMatrix<f64>),
        load: &mut ElasticLoad,
    ) {
        let (gear, own) = (set.bodies.gears[k].body, self.of(k));
        let forces = &set.pairs.forces;
        let race = race(set, k + 1, load.pressed.len());
        let [c, r] = own.coupled;
        load.accelerated += race.transpose() * Matrix3::from_diagonal(&[c, c, r].into()) * &race;
        let ports = &frame.pattern.own[k];
        for (pair, e) in ports.iter().filter(|(pair, _)| forces[*pair] != 0.0) {
            let Some(ends) = frame.pattern.ends[*pair].as_ref() else { continue };
            let (point, axis) = (&ends[*e].end, ends[*e].axis);
            let at = |q: [f64; 3]| {
                own.at(gear, (point.load.as_slice(), point.direction), into_frame(q, axis))
            };
            // Row of W
            let unit = UNITS.map(at);
            let row = race.tr_mul(&Vector3::from(unit));
            load.opened.ger(1.0, &made.row(*pair).transpose(), &row, 1.0);
            load.pressed.axpy(-forces[*pair], &row, 1.0);
            if let Some(teeth) = &frame.pattern.teeth[*pair] {
                let (columns, d) = (point.load.as_slice(), point.direction);
                let both = |(column, weight): &(usize, f64)| {
                    [(*column, weight * d[0]), (*column + 1, weight * d[1])]
                };
                load.pressing[k].push(PressedTooth {
                    tooth: teeth[*e] + load.teeth_per_cycle[k] * set.clock.cycles,
                    force: forces[*pair],
                    load: columns.iter().flat_map(both).collect(),
                    given: made.row(*pair).transpose(),
                });
            }
        }
        let across = &frame.pattern.across(&set.bodies.gears)[k];
        for (i, (a, _)) in ports.iter().enumerate() {
            let given = made.row(*a).transpose();
            for (j, (b, _)) in ports.iter().enumerate() {
                load.coupled.axpy(across[(i, j)] * forces[*b], &given, 1.0);
                load.coupling.ger(across[(i, j)], &given, &made.row(*b).transpose(), 1.0);
            }
        }
    }
}

const UNITS: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// x, y and θ of a body's race by the n coordinates of all races, 3×n.
pub(super) fn race(set: &VibratingSet<'_>, body: usize, n: usize) -> Matrix3xX<f64> {
    let radius = set.races().radii[body.min(PLANETS)];
    let mut all = Matrix3xX::zeros(n);
    for i in 0..n {
        let unit = DVector::from_fn(n, |j, _| if i == j { 1.0 } else { 0.0 });
        let [x, y, turned] = set.races().displaced(&unit, body);
        all.set_column(i, &Vector3::new(x, y, turned / radius));
    }
    all
}

fn lost() -> FeError {
    FeError::NoEquilibrium("the set has not been stepped or put to rest yet".into())
}

#[cfg(test)]
mod tests {
    use super::super::elastic_gears::tests::oh58_at_rest;
    use super::super::elastic_inertia::{ElasticInertia, ElasticShift};
    use super::*;

    /// A set that moves in one of its modes, q = φ, q̈ = −λφ and P = P_i, loads this mode by −δλ of the same effects, because
    /// ÿ + (λ + δλ) y = 0; a load that lost a sign, a frame or a body would not.
    #[test]
    fn motion_in_a_mode_loads_it_by_the_change_of_its_eigenvalue() {
        oh58_at_rest(8, |set| {
            let linear = set.linearised().unwrap();
            let inertia = ElasticInertia::new(set).unwrap().unwrap();
            let gears = ElasticGears::new(set).unwrap().unwrap();
            let (frequencies, shapes) = linear.undamped().unwrap();
            let lambda = |i: usize| (std::f64::consts::TAU * frequencies[i]).powi(2);
            let columns: Vec<Vec<f64>> =
                shapes.column_iter().map(|c| c.iter().copied().collect()).collect();
            let mut compared = 0;
            for (i, shape) in columns.iter().enumerate().filter(|(i, _)| frequencies[*i] > 100.0) {
                let z = DVector::from_column_slice(shape);
                set.pairs.forces = &linear.contact * (&linear.rows * &z);
                set.race_dynamics.motion.x.copy_from_slice(shape);
                let a = shape.iter().map(|x| -lambda(i) * x).collect::<Vec<_>>();
                set.race_dynamics.motion.a.copy_from_slice(&a);
                let load = gears.load(set, &linear).unwrap();
                let acceleration = DVector::from_column_slice(&a);
                let second = lambda(i) * (&load.pressed - &load.accelerated * &acceleration);
                let sum = z.dot(&(second + &load.opened * &acceleration + &load.coupled));
                // V φ at the frequency of the mode is the load itself.
                let changed = &load.accelerated * (lambda(i) * &z) - load.opened.transpose() * &z;
                let own = lambda(i) * (changed - &load.opened * &z) + &load.coupling * &z;
                let shift = inertia.of_mode(set, &linear, shape, lambda(i)).unwrap();
                let mut carrier = ElasticShift { inertia: 0.0, remainder: 0.0, coupling: 0.0 };
                inertia.add_carrier(set, &z, lambda(i), &mut carrier);
                let of_gears = shift.inertia - carrier.inertia;
                let expected = -lambda(i) * (of_gears + shift.coupling);
                let size = lambda(i) * (of_gears.abs() + shift.coupling.abs());
                for got in [sum, z.dot(&own)] {
                    assert!((got - expected).abs() < 1e-9 * size, "{i}: {got:e} {expected:e}");
                }
                compared += 1;
            }
            assert!(compared > 14, "{compared}");
        });
    }
}
