//! First natural frequency of an annulus in its plane, held at its race and free at its other edge.
//!
//! Its lowest mode is torsion, u = r φ(r) around the centre:
//!
//! ```text
//! (r³ φ')' + λ ρ/G r³ φ = 0,   φ = 0 at the race,   φ' = 0 at the free edge
//! ```
//!
//! Inverse iteration with Schwarz's quotient, from above. A quarter of a sine wave in Rayleigh's quotient is too
//! high: by 4 % in frequency where the edges are as 1.7, by 22 % where they are as 2.9. Modes with one and two waves
//! around the circumference are higher where the race is inside, for every ratio of the edges from 1.1 to 3 and ν of
//! 0.23 and 0.3 (a test below); ratio of their frequencies to that of torsion with ν = 0.3:
//!
//! | free edge over race | one wave | two waves |
//! |---:|---:|---:|
//! | 1.3 | 1.05 | 1.17 |
//! | 1.7 | 1.20 | 1.63 |
//! | 2.0 | 1.33 | 1.94 |
//! | 2.9 | 1.75 | 2.73 |
//!
//! So they are where the race is outside and the free edge is at half of its radius or farther out.

use super::accelerated::Accelerated;

/// Intervals between the edges: λ is within 1e-3.
const INTERVALS: usize = 64;

/// Iterations: the second mode of torsion has more than five times the λ of the first, so that λ is converged.
const ITERATIONS: usize = 6;

impl Accelerated {
    /// λ = ω² of the first mode with the race held, (rad/s)².
    ///
    /// `[eq:annulus-torsion]` φ_{j+1}(r) = ∫_race^r s⁻³ ∫_s^free t³ φ_j dt ds, λ ≈ G/ρ ∫ r³ φ_j φ_{j+1} dr / ∫ r³
    /// φ_{j+1}² dr.
    /// Source: Courant & Hilbert, Methods of Mathematical Physics I (1953), chapter VI.
    /// Checked by: `lumped/src/analytic/torsion.rs::torsion_has_its_limit_and_the_zeros_of_bessel_functions`.
    pub(super) fn first_eigenvalue(&self) -> f64 {
        let step = (self.free - self.race) / INTERVALS as f64;
        let cubed: Vec<f64> =
            (0..=INTERVALS).map(|i| (self.race + i as f64 * step).powi(3)).collect();
        // Trapezoids; the step drops out of the quotient.
        let integral = |a: &[f64], b: &[f64]| -> f64 {
            let at = |i: usize| cubed[i] * a[i] * b[i];
            (1..=INTERVALS).map(|i| 0.5 * (at(i - 1) + at(i))).sum()
        };
        let mut shape = vec![1.0; INTERVALS + 1];
        let mut quotient = 0.0;
        for _ in 0..ITERATIONS {
            let mut moment = vec![0.0; INTERVALS + 1];
            for i in (0..INTERVALS).rev() {
                let mean = 0.5 * (cubed[i] * shape[i] + cubed[i + 1] * shape[i + 1]);
                moment[i] = moment[i + 1] + mean * step;
            }
            let mut next = vec![0.0; INTERVALS + 1];
            for i in 1..=INTERVALS {
                let mean = 0.5 * (moment[i - 1] / cubed[i - 1] + moment[i] / cubed[i]);
                next[i] = next[i - 1] + mean * step;
            }
            quotient = integral(&shape, &next) / integral(&next, &next);
            let largest = next[INTERVALS];
            shape = next.into_iter().map(|phi| phi / largest).collect();
        }
        self.shear / self.density * quotient
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, SymmetricEigen};

    use super::super::plane::Plane;
    use super::*;
    use gearset::gauss_points;

    /// ω race/√(G/ρ) of the annulus with its race at 1.
    fn reduced(free: f64, poisson: f64) -> f64 {
        let plane = Plane { modulus: 1.0, shear: 1.0, poisson, width: 1.0 };
        Accelerated::new(1.0, free, 1.0, &plane).first_eigenvalue().sqrt()
    }

    /// The same with n waves around the circumference, converged from above: Ritz's method with u_r = U(r) cos nϑ,
    /// u_ϑ = V(r) sin nϑ (n = 0: both alone), U and V of eight powers of r − 1.
    fn by_ritz(free: f64, poisson: f64, waves: f64) -> f64 {
        const POWERS: usize = 8;
        let (lame, span) = (2.0 * poisson / (1.0 - 2.0 * poisson), free - 1.0);
        let mut k = DMatrix::<f64>::zeros(2 * POWERS, 2 * POWERS);
        let mut m = k.clone();
        let halves = gauss_points(0.0, 0.5).chain(gauss_points(0.5, 1.0));
        for (x, weight) in halves {
            let r = 1.0 + span * x;
            let rows: Vec<[f64; 5]> = (0..2 * POWERS)
                .map(|i| {
                    let power = (i % POWERS + 1) as i32;
                    let (p, d) = (x.powi(power), f64::from(power) * x.powi(power - 1) / span);
                    // u_r, u_ϑ, ε_r, ε_ϑ, γ
                    match i < POWERS {
                        true => [p, 0.0, d, p / r, -waves * p / r],
                        false => [0.0, p, 0.0, waves * p / r, d - p / r],
                    }
                })
                .collect();
            for (i, a) in rows.iter().enumerate() {
                for (j, b) in rows.iter().enumerate() {
                    let trace = (a[2] + a[3]) * (b[2] + b[3]);
                    let strain = lame * trace + 2.0 * (a[2] * b[2] + a[3] * b[3]) + a[4] * b[4];
                    k[(i, j)] += weight * r * strain;
                    m[(i, j)] += weight * r * (a[0] * b[0] + a[1] * b[1]);
                }
            }
        }
        let lower = m.cholesky().unwrap().l().try_inverse().unwrap();
        let values = SymmetricEigen::new(&lower * k * lower.transpose()).eigenvalues;
        values.min().sqrt()
    }

    /// A thin annulus is a bar in shear: ω = π/2 √(G/ρ)/h. Thicker ones have the zeros of J₂(kb) Y₁(ka) − Y₂(kb)
    /// J₁(ka).
    #[test]
    fn torsion_has_its_limit_and_the_zeros_of_bessel_functions() {
        let thin = reduced(1.0 + 1e-4, 0.3) * 1e-4 / std::f64::consts::FRAC_PI_2 - 1.0;
        assert!(thin.abs() < 1e-3, "{thin:e}");
        for (free, wanted) in [(1.1, 14.8106), (1.71, 1.5547), (2.9, 0.3919), (0.7, 6.4192)] {
            let found = reduced(free, 0.3);
            assert!((found / wanted - 1.0).abs() < 1e-3, "{free}: {found}");
        }
    }

    /// Torsion is the lowest mode, and Ritz's method has it as well.
    #[test]
    fn no_mode_with_waves_around_the_circumference_is_below_torsion() {
        for poisson in [0.23, 0.3] {
            for free in [0.5, 0.7, 0.9, 1.1, 1.3, 1.7, 2.0, 2.5, 2.9, 3.0] {
                let torsion = reduced(free, poisson);
                let [none, one, two] = [0.0, 1.0, 2.0].map(|waves| by_ritz(free, poisson, waves));
                assert!((none / torsion - 1.0).abs() < 2e-3, "{free}: {none} {torsion}");
                assert!(one > torsion && two > torsion, "{free}: {torsion} {one} {two}");
            }
        }
    }
}
