//! Harmonics of a linear system whose stiffness varies periodically, by Hill's method.
//!
//! ```text
//! M ẍ + C ẋ + K(θ) x = f(θ),   θ = ω t,   x = X_0 + Re Σ X_l exp(i l θ),   K = κ_0 + 2 Re Σ κ_m exp(i m θ)
//! (κ_0 − (l ω)² M + i l ω C) X_l + Σ_{m ≠ l} κ_{l−m} X_m + Σ_m κ_{l+m} X̄_m + 2 κ_l X_0 = F_l,   1 ≤ l, m ≤ H
//! κ_0 X_0 + Re Σ κ̄_m X_m = F_0
//! ```
//!
//! A dynamic stiffness D_l besides adds D_l X_l. Further terms B(θ) add r_l β_{l−m} c_m to what harmonic m contributes to the equation of harmonic l, and r_l β_{l+m} c_m to that of its conjugate:
//! derivatives in time are factors of this kind, r before and c after the periodic matrix is applied.
//!
//! (Nayfeh & Mook, *Nonlinear Oscillations*, Wiley 1979, ch. 5). One real system of n (2H + 1) equations couples all harmonics: a
//! stiffness that varies passes the motion of one on to the others.

use faer::c64;
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::{Mat, MatRef};
use nalgebra::{DMatrix, DVector};

/// Largest residual of a solution, relative to the forces, at which the equations count as regular.
const REGULAR: f64 = 1e-6;

/// A linear system of n coordinates whose stiffness varies over a cycle.
#[derive(Debug, Clone, Copy)]
pub struct PeriodicSystem<'a> {
    /// M, n×n.
    pub mass: &'a DMatrix<f64>,
    /// C, n×n, constant over the cycle.
    pub damping: &'a DMatrix<f64>,
    /// K, n×n, at θ = 2πk/s for k = 1 … s. Its harmonics from s/2 on are taken to be zero.
    pub stiffness: &'a [DMatrix<f64>],
    /// ω, rad/s.
    pub omega: f64,
    /// D_l besides these, n×n, by harmonic from 0; zero for harmonics that are left out. Of the mean the real part counts.
    pub dynamic: &'a [DMatrix<c64>],
    /// Terms besides these.
    pub terms: &'a [PeriodicTerm<'a>],
}

/// A term of the equations of motion: a periodic matrix applied to even derivatives of the motion, and even derivatives of that.
#[derive(Debug, Clone, Copy)]
pub struct PeriodicTerm<'a> {
    /// B, n×n, as [`PeriodicSystem::stiffness`].
    pub samples: &'a [DMatrix<f64>],
    /// c_l by harmonic from 0: factor on the motion. Zero for harmonics that are left out.
    pub motion: &'a [f64],
    /// r_l by harmonic from 0: factor on the force. Zero for harmonics that are left out.
    pub force: &'a [f64],
}

/// Why the harmonics of a periodic linear system are not found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum HillError {
    /// A matrix or a force of another size than the mass matrix, or no stiffness.
    #[error("{what} does not go with {coordinates} coordinates")]
    Size {
        /// Name of the quantity.
        what: &'static str,
        /// Rows of the mass matrix.
        coordinates: usize,
    },
    /// The equations of the harmonics are singular, or an entry is not finite.
    #[error(
        "the harmonics of the periodic system have no solution: an undamped resonance, or an entry that is not finite"
    )]
    Singular,
}

/// The equations of harmonics 0 … H of a periodic system, factorised.
#[derive(Debug)]
pub struct HillEquations {
    coordinates: usize,
    harmonics: usize,
    matrix: Mat<f64>,
    factors: PartialPivLu<f64>,
}

impl HillEquations {
    /// Of a system, with harmonics up to H.
    ///
    /// # Errors
    /// If sizes differ.
    pub fn new(system: &PeriodicSystem<'_>, harmonics: usize) -> Result<Self, HillError> {
        let n = system.mass.nrows();
        let wrong = |what| HillError::Size { what, coordinates: n };
        let fits = |a: &DMatrix<f64>| a.shape() == (n, n);
        let checks = [
            ("the mass matrix", fits(system.mass)),
            ("the damping matrix", fits(system.damping)),
            ("the stiffness", !system.stiffness.is_empty() && system.stiffness.iter().all(fits)),
            ("a dynamic stiffness", system.dynamic.iter().all(|own| own.shape() == (n, n))),
            ("a term", system.terms.iter().all(|own| own.samples.iter().all(fits))),
        ];
        for (what, is_right) in checks {
            if !is_right {
                return Err(wrong(what));
            }
        }
        let size = n * (2 * harmonics + 1);
        let mut matrix = Mat::zeros(size, size);
        let every = vec![1.0; harmonics + 1];
        let stiffness = PeriodicTerm { samples: system.stiffness, motion: &every, force: &every };
        for term in std::iter::once(&stiffness).chain(system.terms) {
            let lines: Vec<_> = (0..=2 * harmonics).map(|m| line(term.samples, n, m)).collect();
            let factor = |list: &[f64], l: usize| list.get(l).copied().unwrap_or(0.0);
            for l in 0..=harmonics {
                for m in 0..=harmonics {
                    let weight = factor(term.force, l) * factor(term.motion, m);
                    if weight != 0.0 {
                        add_coupling(&mut matrix, n, (l, m), weight, &lines);
                    }
                }
            }
        }
        (0..=harmonics).for_each(|l| add_inertia(&mut matrix, system, l));
        for (l, own) in system.dynamic.iter().enumerate().take(harmonics + 1) {
            add_dynamic(&mut matrix, own, l);
        }
        let factors = matrix.partial_piv_lu();
        Ok(Self { coordinates: n, harmonics, matrix, factors })
    }

    /// X_0 … X_H to forces F_0 … F_H of n entries each; harmonics of the force that are left out are zero.
    ///
    /// # Errors
    /// If a force is of another size, or the equations are singular.
    pub fn response(&self, forces: &[DVector<c64>]) -> Result<Vec<DVector<c64>>, HillError> {
        let n = self.coordinates;
        if forces.iter().any(|f| f.len() != n) {
            return Err(HillError::Size { what: "a force", coordinates: n });
        }
        let mut right = Mat::<f64>::zeros(self.matrix.nrows(), 1);
        for (l, force) in forces.iter().enumerate().take(self.harmonics + 1) {
            let (re, im) = rows(n, l);
            for (i, f) in force.iter().enumerate() {
                right[(re + i, 0)] = f.re;
                if let Some(im) = im {
                    right[(im + i, 0)] = f.im;
                }
            }
        }
        let found = self.factors.solve(&right);
        let left = &self.matrix * &found - &right;
        // NaN is refused.
        let is_regular = left.norm_l2() <= REGULAR * right.norm_l2();
        if !is_regular {
            return Err(HillError::Singular);
        }
        Ok((0..=self.harmonics).map(|l| of_harmonic(found.as_ref(), n, l)).collect())
    }
}

/// First rows of the real and the imaginary part of harmonic l; the mean is real.
fn rows(n: usize, l: usize) -> (usize, Option<usize>) {
    match l {
        0 => (0, None),
        _ => ((2 * l - 1) * n, Some(2 * l * n)),
    }
}

fn of_harmonic(found: MatRef<'_, f64>, n: usize, l: usize) -> DVector<c64> {
    let (re, im) = rows(n, l);
    DVector::from_fn(n, |i, _| {
        c64::new(found[(re + i, 0)], im.map_or(0.0, |im| found[(im + i, 0)]))
    })
}

/// κ_m = Σ_k K(θ_k) exp(−i m θ_k)/s
fn line(list: &[DMatrix<f64>], n: usize, m: usize) -> DMatrix<c64> {
    let samples = list.len();
    let (mut re, mut im) = (DMatrix::<f64>::zeros(n, n), DMatrix::<f64>::zeros(n, n));
    if m == 0 || 2 * m < samples {
        for (k, own) in list.iter().enumerate() {
            // The whole turns of the phase are taken out before it becomes a real number.
            let turn = (m * (k + 1) % samples) as f64 / samples as f64;
            let (sin, cos) = (std::f64::consts::TAU * turn).sin_cos();
            re.zip_apply(own, |x, k| *x += cos * k);
            im.zip_apply(own, |x, k| *x -= sin * k);
        }
    }
    re.zip_map(&im, |re, im| c64::new(re, im) / samples as f64)
}

/// What X_m adds to the equation of harmonic l by a periodic matrix with these lines, times a weight.
fn add_coupling(
    matrix: &mut Mat<f64>,
    n: usize,
    (l, m): (usize, usize),
    weight: f64,
    lines: &[DMatrix<c64>],
) {
    let sum = &lines[l + m];
    // κ_{l−m}, the conjugate of κ_{m−l}
    let difference = &lines[l.abs_diff(m)];
    let sign = if l < m { -1.0 } else { 1.0 };
    let ((row, row_im), (column, column_im)) = (rows(n, l), rows(n, m));
    for j in 0..n {
        for i in 0..n {
            let (a, b) = (difference[(i, j)] * weight, sum[(i, j)] * weight);
            let (a_re, a_im) = (a.re, sign * a.im);
            match (row_im, column_im) {
                (None, None) => matrix[(row + i, column + j)] += a_re,
                // Re κ̄_m X_m, of which κ_{l−m} is κ̄_m
                (None, Some(column_im)) => {
                    matrix[(row + i, column + j)] += a_re;
                    matrix[(row + i, column_im + j)] -= a_im;
                }
                (Some(row_im), None) => {
                    matrix[(row + i, column + j)] += 2.0 * a_re;
                    matrix[(row_im + i, column + j)] += 2.0 * a_im;
                }
                (Some(row_im), Some(column_im)) => {
                    matrix[(row + i, column + j)] += a_re + b.re;
                    matrix[(row + i, column_im + j)] += b.im - a_im;
                    matrix[(row_im + i, column + j)] += b.im + a_im;
                    matrix[(row_im + i, column_im + j)] += a_re - b.re;
                }
            }
        }
    }
}

/// −(l ω)² M + i l ω C
fn add_inertia(matrix: &mut Mat<f64>, system: &PeriodicSystem<'_>, l: usize) {
    let n = system.mass.nrows();
    let (re, Some(im)) = rows(n, l) else { return };
    let omega = l as f64 * system.omega;
    for j in 0..n {
        for i in 0..n {
            let inertia = omega * omega * system.mass[(i, j)];
            let damping = omega * system.damping[(i, j)];
            matrix[(re + i, re + j)] -= inertia;
            matrix[(im + i, im + j)] -= inertia;
            matrix[(re + i, im + j)] -= damping;
            matrix[(im + i, re + j)] += damping;
        }
    }
}

/// D_l
fn add_dynamic(matrix: &mut Mat<f64>, own: &DMatrix<c64>, l: usize) {
    let n = own.nrows();
    let (re, im) = rows(n, l);
    for j in 0..n {
        for i in 0..n {
            let d = own[(i, j)];
            matrix[(re + i, re + j)] += d.re;
            if let Some(im) = im {
                matrix[(im + i, im + j)] += d.re;
                matrix[(re + i, im + j)] -= d.im;
                matrix[(im + i, re + j)] += d.im;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    fn matrix(n: usize, entries: &[f64]) -> DMatrix<f64> {
        DMatrix::from_row_slice(n, n, entries)
    }

    /// With constant stiffness every harmonic answers its own force alone, (K + D_l − (lω)² M + i lω C) X_l = F_l; of D_0 the real part counts.
    #[test]
    fn constant_stiffness_answers_by_its_dynamic_stiffness() {
        let (m, c, k) = (
            matrix(2, &[2.0, 0.1, 0.1, 1.0]),
            matrix(2, &[0.3, -0.1, -0.1, 0.2]),
            matrix(2, &[9.0, -2.0, -2.0, 4.0]),
        );
        let stiffness = vec![k.clone(); 12];
        let further = |l: usize| {
            DMatrix::from_fn(2, 2, |i, j| {
                c64::new(0.4 * (l + i + 2 * j) as f64, 0.3 * (l + 1 + i * j) as f64)
            })
        };
        let all: Vec<_> = (0..=3).map(further).collect();
        for dynamic in [&[], &all[..2], &all] {
            let system = PeriodicSystem {
                mass: &m,
                damping: &c,
                stiffness: &stiffness,
                omega: 0.7,
                dynamic,
                terms: &[],
            };
            let force = |l: usize| {
                DVector::from_fn(2, |i, _| {
                    c64::new(1.0 + l as f64, if l == 0 { 0.0 } else { i as f64 - 0.4 })
                })
            };
            let forces: Vec<_> = (0..=3).map(force).collect();
            let found = HillEquations::new(&system, 3).unwrap().response(&forces).unwrap();
            for (l, (x, f)) in found.iter().zip(&forces).enumerate() {
                let omega = 0.7 * l as f64;
                let mut z =
                    m.zip_zip_map(&c, &k, |m, c, k| c64::new(k - omega * omega * m, omega * c));
                if let Some(own) = dynamic.get(l) {
                    z += own.map(|d| if l == 0 { c64::new(d.re, 0.0) } else { d });
                }
                let left = (z * x - f).norm();
                assert!(left < 1e-13 * f.norm(), "{l}: {left:e}");
            }
        }
    }

    /// An oscillator of stiffness 1 + 0.4 cos θ + 0.2 sin 2θ under a mean force and one in cos θ, marched with small steps of fourth order to its
    /// steady state: the harmonics are those of Hill's equations.
    #[test]
    fn a_varying_stiffness_couples_harmonics_as_marching_does() {
        let (omega, damping) = (0.63, 0.25);
        let stiffness = |theta: f64| 1.0 + 0.4 * theta.cos() + 0.2 * (2.0 * theta).sin();
        let force = |theta: f64| 0.7 + 1.3 * (theta + 0.4).cos();
        let samples: Vec<_> =
            (1..=48).map(|k| matrix(1, &[stiffness(TAU * f64::from(k) / 48.0)])).collect();
        let (mass, c) = (matrix(1, &[1.0]), matrix(1, &[damping]));
        let system = PeriodicSystem {
            mass: &mass,
            damping: &c,
            stiffness: &samples,
            omega,
            dynamic: &[],
            terms: &[],
        };
        let of = |x: c64| DVector::from_element(1, x);
        let forces = [of(c64::new(0.7, 0.0)), of(c64::from_polar(1.3, 0.4))];
        let found = HillEquations::new(&system, 12).unwrap().response(&forces).unwrap();
        // Runge-Kutta of order 4, 400 steps a cycle, 60 cycles.
        let steps = 400usize;
        let h = TAU / omega / steps as f64;
        let rate = |t: f64, [x, v]: [f64; 2]| {
            let theta = omega * t;
            [v, force(theta) - damping * v - stiffness(theta) * x]
        };
        let along = |y: [f64; 2], r: [f64; 2], h: f64| [y[0] + h * r[0], y[1] + h * r[1]];
        let mut y = [0.0; 2];
        let mut lines = [c64::new(0.0, 0.0); 5];
        for k in 0..60 * steps {
            let t = k as f64 * h;
            let a = rate(t, y);
            let b = rate(t + 0.5 * h, along(y, a, 0.5 * h));
            let c = rate(t + 0.5 * h, along(y, b, 0.5 * h));
            let d = rate(t + h, along(y, c, h));
            y = [0, 1].map(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
            if k >= 59 * steps {
                for (l, line) in lines.iter_mut().enumerate() {
                    let turned = c64::from_polar(1.0, -omega * (t + h) * l as f64);
                    *line += turned * (y[0] * if l == 0 { 1.0 } else { 2.0 } / steps as f64);
                }
            }
        }
        let size = lines[1].norm();
        for (l, (own, hill)) in lines.iter().zip(&found).enumerate() {
            let off = (*own - hill[0]).norm() / size;
            assert!(off < 2e-7, "{l}: {own} {}", hill[0]);
        }
        // Harmonic 2 has no force of its own.
        assert!(lines[2].norm() > 0.05 * size);
    }

    /// Samples that begin a third of a cycle later turn harmonic l by l thirds of a turn and change nothing else.
    #[test]
    fn a_cycle_that_begins_later_turns_every_harmonic() {
        let at = |k: usize| {
            let theta = TAU * k as f64 / 24.0;
            let (a, b) = (0.5 * theta.cos(), 0.3 * (theta + 1.0).sin());
            matrix(2, &[5.0 + a, -1.0 + b, -1.0 + b, 3.0 - a])
        };
        let (mass, damping) = (DMatrix::identity(2, 2), 0.2 * DMatrix::identity(2, 2));
        let solved = |first: usize| {
            let stiffness: Vec<_> = (1..=24).map(|k| at(k + first)).collect();
            let system = PeriodicSystem {
                mass: &mass,
                damping: &damping,
                stiffness: &stiffness,
                omega: 1.1,
                dynamic: &[],
                terms: &[],
            };
            let turned = |l: usize| c64::from_polar(1.0, TAU * (l * first) as f64 / 24.0);
            let forces: Vec<_> =
                (0..=2).map(|l| DVector::from_fn(2, |i, _| turned(l) * (1.0 + i as f64))).collect();
            let found = HillEquations::new(&system, 6).unwrap().response(&forces).unwrap();
            let back = found.into_iter().enumerate();
            back.map(|(l, x)| x.map(|x| x * turned(l).conj())).collect::<Vec<_>>()
        };
        for (a, b) in solved(0).iter().zip(&solved(8)) {
            assert!((a - b).norm() < 1e-13, "{a} {b}");
        }
    }

    /// A mass that varies, M + B(θ) with B ẍ as a term, and one that is differentiated with its motion, d²/dt² (B x): a motion X_l put into the equations in
    /// time leaves the forces that give it back.
    #[test]
    fn terms_act_by_derivatives_of_the_motion_and_of_the_force() {
        let (omega, steps) = (1.3, 64usize);
        let b = |theta: f64| 0.2 + 0.3 * (theta + 0.5).cos();
        let samples: Vec<_> =
            (1..=steps).map(|k| matrix(1, &[b(TAU * k as f64 / steps as f64)])).collect();
        let (mass, damping) = (matrix(1, &[1.0]), matrix(1, &[0.3]));
        let second: Vec<f64> = (0..=6).map(|l| -(f64::from(l) * omega).powi(2)).collect();
        let every = [1.0; 7];
        let lines = [c64::new(0.4, 0.0), c64::new(0.7, -0.2), c64::new(0.1, 0.5)];
        let x = |theta: f64, order: i32| -> f64 {
            let of = |(l, x): (usize, &c64)| {
                (c64::new(0.0, l as f64 * omega).powi(order)
                    * x
                    * c64::from_polar(1.0, l as f64 * theta))
                .re
            };
            lines.iter().enumerate().map(of).sum()
        };
        let line = |f: &dyn Fn(f64) -> f64, l: usize| {
            let factor = if l == 0 { 1.0 } else { 2.0 } / steps as f64;
            let of = |k: usize| {
                let theta = TAU * k as f64 / steps as f64;
                c64::from_polar(factor * f(theta), -(l as f64) * theta)
            };
            (1..=steps).map(of).sum::<c64>()
        };
        for is_outside in [false, true] {
            let (motion, force): (&[f64], &[f64]) =
                if is_outside { (&every, &second) } else { (&second, &every) };
            let terms = [PeriodicTerm { samples: &samples, motion, force }];
            let stiffness = [matrix(1, &[5.0])];
            let system = PeriodicSystem {
                mass: &mass,
                damping: &damping,
                stiffness: &stiffness,
                omega,
                dynamic: &[],
                terms: &terms,
            };
            let rest = |t: f64| x(t, 2) + 0.3 * x(t, 1) + 5.0 * x(t, 0);
            let forces: Vec<_> = (0..=6)
                .map(|l| {
                    let of_term = match is_outside {
                        true => line(&|t| b(t) * x(t, 0), l) * second[l],
                        false => line(&|t| b(t) * x(t, 2), l),
                    };
                    DVector::from_element(1, line(&rest, l) + of_term)
                })
                .collect();
            let found = HillEquations::new(&system, 6).unwrap().response(&forces).unwrap();
            for (l, own) in found.iter().enumerate() {
                let expected = lines.get(l).copied().unwrap_or_default();
                assert!((own[0] - expected).norm() < 1e-12, "{is_outside} {l}: {}", own[0]);
            }
        }
    }

    #[test]
    fn resonances_without_damping_and_wrong_sizes_are_refused() {
        let (mass, none) = (matrix(1, &[1.0]), matrix(1, &[0.0]));
        let stiffness = vec![matrix(1, &[4.0]); 8];
        let system = PeriodicSystem {
            mass: &mass,
            damping: &none,
            stiffness: &stiffness,
            omega: 1.0,
            dynamic: &[],
            terms: &[],
        };
        let equations = HillEquations::new(&system, 3).unwrap();
        let force = DVector::from_element(1, c64::new(1.0, 0.0));
        let at_resonance =
            [&force * c64::new(0.0, 0.0), &force * c64::new(0.0, 0.0), force.clone()];
        assert_eq!(equations.response(&at_resonance), Err(HillError::Singular));
        let long = DVector::from_element(2, c64::new(1.0, 0.0));
        assert!(equations.response(&[long]).unwrap_err().to_string().contains("a force"));
        let refused = |system: PeriodicSystem<'_>| HillEquations::new(&system, 3).unwrap_err();
        let two = DMatrix::identity(2, 2);
        let wrong = refused(PeriodicSystem { damping: &two, ..system });
        assert!(wrong.to_string().contains("the damping matrix"));
        let wrong = refused(PeriodicSystem { stiffness: &[], ..system });
        assert!(wrong.to_string().contains("the stiffness"));
    }
}
