//! What a quasi-static carrier lacks in motion: the inertia and the damping of its elastic displacements between race and seats.
//!
//! The carrier is loaded at the same places all the time, so that each harmonic of a motion has a dynamic stiffness of its own. With the bearing forces Q on
//! the seats (displacements ℓ u), the motion q_c = R q of the race and proportional damping (M: α, K: β), harmonic motion of circular frequency ω has
//!
//! ```text
//! (K (1 + iωβ) − μ M_ff) u = ℓᵀ Q + μ M_fr q_c,   μ = ω² − iωα
//! Q/k = B q − ℓ u
//! ```
//!
//! D = Eᵀ (K (1 + iωβ) − μ M_ff)⁻¹ E of the loads E = [ℓᵀ M_fr] has the blocks A (seats), W (seats by accelerations of the race) and A_r (race).
//! Eliminating u and Q, and taking off what the quasi-static carrier has, leaves
//!
//! ```text
//! Z(ω) = Lᵀ (I/k + A)⁻¹ L − μ² Rᵀ A_r R,   L = B − μ W R
//! V(ω) = Bᵀ (I/k + A_0)⁻¹ B − Z(ω)
//! ```
//!
//! D is computed on Ritz vectors: the static displacements under these loads and under the inertia of those, Y = [K⁻¹E, K⁻¹M_ff K⁻¹E], so that
//! it has the first four terms of the series in μ exactly, and the lowest modes from above (load-dependent Ritz vectors: Wilson, Yuan & Dickens,
//! Earthquake Eng. Struct. Dyn. 10 (1982) 813–821),
//!
//! ```text
//! D = (YᵀE)ᵀ (YᵀK Y (1 + iωβ) − μ YᵀM_ff Y)⁻¹ YᵀE
//! ```

use nalgebra::{Complex, DMatrix, DVector, Matrix3xX};

use super::damping::Proportional;
use super::elastic_load::race;
use super::set::VibratingSet;
use crate::statics::CARRIER;

/// The elastic carrier of a set as the loads at its seats and the accelerations of its race move it.
#[derive(Debug, Clone)]
pub struct ElasticCarrier {
    /// I/k + A_0, 2N×2N, m/N.
    compliance: DMatrix<f64>,
    /// B: elongations of the bearings on rigid seats by the n coordinates of the races, 2N×n.
    rigid: DMatrix<f64>,
    /// R, 3×n: x, y (m) and θ of the carrier's race.
    race: Matrix3xX<f64>,
    /// D at ω = 0 between 2N loads on the seats and three accelerations.
    yielding: DMatrix<f64>,
    /// YᵀE, with Y of unit strain energy.
    loaded: DMatrix<f64>,
    /// YᵀK Y.
    stiffness: DMatrix<f64>,
    /// YᵀM_ff Y.
    mass: DMatrix<f64>,
    damping: Proportional,
}

impl ElasticCarrier {
    /// That of a set; `None` if its carrier is rigid.
    pub fn new(set: &VibratingSet<'_>) -> Option<Self> {
        let body = set.races().carrier.as_ref().filter(|body| !body.is_rigid)?;
        let bearings = &set.race_dynamics.bearings;
        let (matrices, ports) = (&body.matrices, &bearings.ports);
        let mut loads = DMatrix::zeros(matrices.size, ports.len() + 3);
        for (mut column, port) in loads.column_iter_mut().zip(ports) {
            port.add_to(1.0, column.as_mut_slice());
        }
        for (k, inertia) in matrices.coupling.iter().enumerate() {
            loads.column_mut(ports.len() + k).copy_from_slice(inertia);
        }
        let solved = |loads: &DMatrix<f64>| {
            let mut u = loads.clone();
            body.factor.solve_columns(&mut u);
            u
        };
        let inertia = |u: &DMatrix<f64>| {
            let mut product = DMatrix::zeros(u.nrows(), u.ncols());
            for (u, mut own) in u.column_iter().zip(product.column_iter_mut()) {
                matrices.mass.multiply_add(1.0, u.as_slice(), own.as_mut_slice());
            }
            product
        };
        let first = solved(&loads);
        // What K makes of both blocks is known: E and M_ff K⁻¹E.
        let pushed = inertia(&first);
        let joined = |a: &DMatrix<f64>, b: &DMatrix<f64>| {
            DMatrix::from_columns(&a.column_iter().chain(b.column_iter()).collect::<Vec<_>>())
        };
        let (vectors, forces) = (joined(&first, &solved(&pushed)), joined(&loads, &pushed));
        let of_unit = DMatrix::from_diagonal(&DVector::from_iterator(
            vectors.ncols(),
            vectors.column_iter().zip(forces.column_iter()).map(|(u, f)| 1.0 / u.dot(&f).sqrt()),
        ));
        let (vectors, forces) = (&vectors * &of_unit, &forces * &of_unit);
        Some(Self {
            compliance: bearings.compliance.clone(),
            rigid: bearings.rigid.clone(),
            race: race(set, CARRIER, bearings.rigid.ncols()),
            yielding: loads.transpose() * &first,
            loaded: vectors.transpose() * &loads,
            stiffness: vectors.transpose() * &forces,
            mass: vectors.transpose() * inertia(&vectors),
            damping: set.race_dynamics.damping,
        })
    }

    /// D at a circular frequency, rad/s. `None` at a resonance without damping.
    fn flexibility(&self, omega: f64) -> Option<DMatrix<Complex<f64>>> {
        let elastic = Complex::new(1.0, omega * self.damping.beta);
        let loaded = self.loaded.map(Complex::from);
        let dynamic = self.stiffness.map(Complex::from) * elastic
            - self.mass.map(Complex::from) * self.accelerating(omega);
        Some(loaded.transpose() * dynamic.lu().solve(&loaded)?)
    }

    /// μ
    fn accelerating(&self, omega: f64) -> Complex<f64> {
        Complex::new(omega * omega, -omega * self.damping.alpha)
    }

    /// V(ω) at a circular frequency, rad/s: what the dynamic stiffness on the n coordinates of the races lacks of that of the quasi-static carrier, N/m.
    /// `None` at a resonance without damping.
    pub fn lacking(&self, omega: f64) -> Option<DMatrix<Complex<f64>>> {
        let seats = self.compliance.nrows();
        let mu = self.accelerating(omega);
        let flexibility = self.flexibility(omega)?;
        let block = |row: usize, column: usize, size: (usize, usize)| {
            flexibility.view((row, column), size).clone_owned()
        };
        let rigid = self.rigid.map(Complex::from);
        let race = DMatrix::from_fn(3, rigid.ncols(), |i, j| Complex::from(self.race[(i, j)]));
        // I/k + A_0, and with what A is more than A_0
        let at_rest = self.compliance.map(Complex::from);
        let own = self.yielding.view((0, 0), (seats, seats)).map(Complex::from);
        let compliance = &at_rest + block(0, 0, (seats, seats)) - own;
        // L = B − μ W R
        let opened = &rigid - block(0, seats, (seats, 3)) * &race * mu;
        // Z = Lᵀ (I/k + A)⁻¹ L − μ² Rᵀ A_r R
        let accelerated = race.transpose() * block(seats, seats, (3, 3)) * &race;
        let stiffness =
            opened.transpose() * compliance.lu().solve(&opened)? - accelerated * (mu * mu);
        Some(rigid.transpose() * at_rest.lu().solve(&rigid)? - stiffness)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::super::elastic_gears::tests::oh58_at_rest;
    use super::super::elastic_inertia::{ElasticInertia, ElasticShift};
    use super::super::fixed_race_mode::{FixedRaceMode, fixed_race_modes};
    use super::*;

    const STILL: Proportional = Proportional { alpha: 0.0, beta: 0.0 };

    /// At low frequency zᵀ V z = ω² δm with the first-order mass δm = 2 q M_rf u_s + λ q M_rf w + u_1ᵀ M_ff u_1 of [`ElasticInertia`], for any motion z.
    #[test]
    fn slow_motion_lacks_the_mass_to_first_order() {
        oh58_at_rest(6, |set| {
            let carrier = ElasticCarrier { damping: STILL, ..ElasticCarrier::new(set).unwrap() };
            let inertia = ElasticInertia::new(set).unwrap().unwrap();
            assert!(carrier.lacking(0.0).unwrap().norm() < 1e-9 * carrier.rigid.norm());
            let omega = TAU * 150.0;
            let lacking = carrier.lacking(omega).unwrap();
            let n = carrier.rigid.ncols();
            for k in 0..n {
                let z =
                    DVector::from_fn(n, |i, _| if i == k { 1.0 } else { 0.1 * (i as f64).sin() });
                let mut shift = ElasticShift { inertia: 0.0, remainder: 0.0, coupling: 0.0 };
                inertia.add_carrier(set, &z, omega * omega, &mut shift);
                let expected = omega * omega * (shift.remainder - shift.inertia);
                let got = z.dot(&(lacking.map(|v| v.re) * &z));
                // The next term is (150/9000)² of it.
                assert!(
                    (got - expected).abs() < 1e-3 * expected.abs(),
                    "{k}: {got:e} {expected:e}"
                );
            }
        });
    }

    /// Beside the sum over sixty modes of the carrier, to which the static displacements of all others are added, up to 1.2 times its first frequency.
    #[test]
    fn dynamic_flexibility_is_that_of_many_modes() {
        oh58_at_rest(6, |set| {
            let carrier = ElasticCarrier::new(set).unwrap();
            let body = set.races().carrier.as_ref().unwrap();
            let modes = fixed_race_modes(&body.matrices, 60, 1.0, "carrier").unwrap();
            let ports = &set.race_dynamics.bearings.ports;
            let along = |mode: &FixedRaceMode| {
                let seats = ports.iter().map(|port| port.read(&mode.shape));
                DVector::from_iterator(ports.len() + 3, seats.chain(mode.participation))
            };
            for damping in [STILL, Proportional { alpha: 142.9, beta: 2.21e-6 }] {
                let own = ElasticCarrier { damping, ..carrier.clone() };
                for (part, allowed) in [(0.3, 1e-4), (0.6, 2e-3), (0.9, 0.05), (1.2, 0.1)] {
                    let omega = part * modes[0].lambda.sqrt();
                    let mu = own.accelerating(omega);
                    let elastic = Complex::new(1.0, omega * damping.beta);
                    let mut expected = own.yielding.map(Complex::from) / elastic;
                    for mode in &modes {
                        let e = along(mode);
                        let shape = (&e * e.transpose()).map(Complex::from);
                        let stiffness = elastic * mode.lambda;
                        expected += shape * (1.0 / (stiffness - mu) - 1.0 / stiffness);
                    }
                    let got = own.flexibility(omega).unwrap();
                    let off = (&got - &expected).norm() / expected.norm();
                    println!("{part} of the first frequency: {off:.2e} apart");
                    assert!(off < allowed, "{part}: {off:e}");
                }
            }
        });
    }
}
