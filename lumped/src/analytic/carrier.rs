//! Flexibility of the carrier between the pin seats and its bore, in closed form: forces in an annulus that is held at
//! its bore and free at its outside.
//!
//! Each harmonic σᵏ = e^{ikθ} of both conditions of [`Field`] holds a_k, ā_{2−k} and b̄_{−k}, so that k and 2 − k are
//! solved together ([`Field::new`]).
//!
//! A rigid seat of radius ρ with a uniform traction on its circle moves by the mean of the displacement over the
//! circle, 2κ f ln(1/ρ) of it from the force itself and that of the rest of the field to ρ² by its Laplacian, once for
//! the seat that moves and once for the one that is loaded. A rigid seat resists the strain ε of the rest of the field
//! as a rigid inclusion in a dilute suspension does ([`seat_flexibility`]).

use std::f64::consts::{PI, TAU};

use gearset::CarrierInput;
use nalgebra::{Complex, DMatrix};

use super::plane::Plane;

type C = Complex<f64>;

/// Terms of the series are taken up to this part of the first.
const SERIES: f64 = 1e-7;

/// Most terms: of thinner annuli the series converge slowly.
const MOST_TERMS: f64 = 120.0;

/// Seats that reach farther than this part of the way to the nearest edge of the annulus, or of half the way to the
/// next seat, are no small inclusions.
const NEAREST: f64 = 0.6;

/// Displacement of every seat along unit forces on every seat, 2N×2N, m/N: radial and tangential of each planet in
/// turn, for planets at ψ (rad) on the radius `center_distance` (m). `None` for seats that are not small, or too thin
/// an annulus.
///
/// `[eq:rigid-seats]` Rigid seats of radius ρ, at each of which (s) the forces on seats i and j have the strains ε_i
/// and ε_j with deviators e:
/// ```text
/// A_ij ← A_ij − πρ² b Σ_s [(K + G) tr ε_i tr ε_j + 2G (κ + 1)/κ e_i : e_j],   K = 2G/(κ − 1).
/// ```
/// Source: derived here.
/// Checked by: `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`,
/// `lumped/tests/analytic.rs::a_rigid_carrier_is_the_limit_of_small_seats_flexibility`.
pub(super) fn seat_flexibility(
    carrier: &CarrierInput,
    center_distance: f64,
    psi: &[f64],
    plane: &Plane,
) -> Option<DMatrix<f64>> {
    let [inner, outer, seat] =
        [carrier.bore_radius_m, carrier.outer_radius_m, carrier.pin_seat_radius_m]
            .map(|r| r / center_distance);
    let apart = |i: usize, j: usize| (0.5 * (psi[i] - psi[j])).sin().abs();
    let next = (1..psi.len()).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| apart(i, j));
    let room = next.fold((1.0 - inner).min(outer - 1.0), f64::min);
    if !(seat > 0.0 && seat < NEAREST * room) {
        return None;
    }
    let ratio = inner.max(1.0 / outer);
    let terms = (SERIES.ln() / (2.0 * ratio.ln())).ceil();
    // NaN is no number of terms.
    if terms.is_nan() || terms > MOST_TERMS {
        return None;
    }
    let kappa = 3.0 - 4.0 * plane.poisson;
    let annulus = Annulus { inner, outer, kappa, terms: terms as i32 };
    let fields = [C::new(1.0, 0.0), C::new(0.0, 1.0)].map(|force| Field::new(&annulus, force));
    let count = psi.len();
    let size = 2 * count;
    // 2G b (u + iv) with the force per width F/b.
    let scale = 1.0 / (2.0 * plane.shear * plane.width);
    let mut flexibility = DMatrix::zeros(size, size);
    let mut strains = vec![[0.0, 0.0, 0.0]; size * count];
    let mut known: Vec<(f64, [Seen; 2])> = Vec::with_capacity(count);
    for loaded in 0..count {
        for seen in 0..count {
            let angle = (psi[seen] - psi[loaded]).rem_euclid(TAU);
            let is_same = |(other, _): &&(f64, _)| (angle - other).abs() < 1e-12;
            let both = match known.iter().find(is_same) {
                Some((_, both)) => *both,
                None => {
                    let both =
                        fields.each_ref().map(|f| f.seen(&annulus, angle, seat, seen == loaded));
                    known.push((angle, both));
                    both
                }
            };
            for (direction, own) in both.iter().enumerate() {
                let column = 2 * loaded + direction;
                flexibility[(2 * seen, column)] = scale * own.moved.re;
                flexibility[(2 * seen + 1, column)] = scale * own.moved.im;
                // tr ε = 2 Re ∂u/∂z, e : e = 2 |∂u/∂z̄|²
                strains[column * count + seen] =
                    [2.0 * own.stretch, own.shear.re, own.shear.im].map(|s| s * scale);
            }
        }
    }
    let bulk = 2.0 * plane.shear / (kappa - 1.0) + plane.shear;
    let shear = 4.0 * plane.shear * (kappa + 1.0) / kappa;
    let area = PI * (seat * center_distance).powi(2) * plane.width / center_distance.powi(2);
    for i in 0..size {
        for j in 0..size {
            let at = |s: usize| {
                let ([t, x, y], [u, v, w]) = (strains[i * count + s], strains[j * count + s]);
                bulk * t * u + shear * (x * v + y * w)
            };
            flexibility[(i, j)] -= area * (0..count).map(at).sum::<f64>();
        }
    }
    // Reciprocal but for the terms of higher order that are left out.
    Some(0.5 * (&flexibility + flexibility.transpose()))
}

/// Lengths over the radius of the seats' centres.
struct Annulus {
    inner: f64,
    outer: f64,
    kappa: f64,
    terms: i32,
}

/// What a seat sees of a force, times 2G b, in its own radial and tangential direction.
#[derive(Debug, Clone, Copy)]
struct Seen {
    /// Displacement.
    moved: C,
    /// Re ∂u/∂z.
    stretch: f64,
    /// ∂u/∂z̄.
    shear: C,
}

/// The field of a unit force on a seat: a_n and b_n.
///
/// `[eq:annulus-field]` Complex displacement u + iv of the plane, κ = 3 − 4ν, under a force F at z = c on the real
/// axis, f = F/(2π(1 + κ)), all lengths over c:
/// ```text
/// 2G (u + iv) = κφ − z φ̄' − ψ̄,
/// φ = −f ln(z − 1) + f ln z + Σ a_n zⁿ,   ψ = κ f̄ ln(z − 1) + f/(z − 1) − κ f̄ ln z + Σ b_n zⁿ,
/// |z| = a: u + iv = 0,   |z| = b: φ + z φ̄' + ψ̄ = constant.
/// ```
/// Source: Muskhelishvili, Some Basic Problems of the Mathematical Theory of Elasticity (1953), §§ 32, 56 and 59.
/// Checked by: `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`,
/// `lumped/tests/analytic.rs::a_rigid_carrier_is_the_limit_of_small_seats_flexibility`.
struct Field {
    force: C,
    /// a_n by power.
    a: Vec<(i32, C)>,
    b: Vec<(i32, C)>,
}

impl Field {
    fn new(annulus: &Annulus, direction: C) -> Self {
        let Annulus { inner, outer, kappa, terms } = *annulus;
        let f = direction / (TAU * (1.0 + kappa));
        let fb = f.conj();
        let (mut a, mut b) = (Vec::new(), Vec::new());
        // k = 1 is its own partner: real parts of a₁ and b₋₁ together, and imaginary parts.
        let (r1, r2) = (-(f * kappa - fb) * inner, (f * kappa - fb) / outer);
        let determinant = (kappa - 1.0) * inner / outer + 2.0 * outer / inner;
        let real = [
            (r1.re / outer + r2.re / inner) / determinant,
            ((kappa - 1.0) * inner * r2.re - 2.0 * outer * r1.re) / determinant,
        ];
        let b_imaginary = -outer * r2.im;
        let a_imaginary = (r1.im - b_imaginary / inner) / ((kappa + 1.0) * inner);
        a.push((1, C::new(real[0], a_imaginary)));
        b.push((-1, C::new(real[1], b_imaginary)));
        // k = 2 with k = 0, where a₀ = 0 stands for a rigid displacement and the constant at b is free.
        let r1 = fb - f * (0.5 * kappa * inner * inner);
        let r2 = (f * (0.5 * kappa) - fb) / (outer * outer);
        let a2 = (r1 + r2 * (outer / inner).powi(2))
            / (kappa * inner * inner + outer.powi(4) / (inner * inner));
        a.push((2, a2));
        b.push((-2, ((r2 - a2 * (outer * outer)) * (outer * outer)).conj()));
        let b0 = fb * (1.0 - inner * inner) - a2.conj() * (2.0 * inner * inner)
            + f * (2.0 * kappa * inner.ln());
        b.push((0, b0.conj()));
        for k in 3..=terms.max(3) {
            let (n, m) = (f64::from(k), f64::from(k - 2));
            let power = |x: f64, p: i32| x.powi(p);
            // Conditions at the bore and at the outside for σᵏ, and the conjugate of those for σ^{2−k}.
            let r1 = -f * (kappa * power(inner, k) / n);
            let r1_other = f * power(inner, k) - (fb * (kappa / m) + f) * power(inner, k - 2);
            let r2 = fb * power(outer, 2 - k) + (f * (kappa / n) - fb) * power(outer, -k);
            let r2_other = -fb * (power(outer, 2 - k) / m);
            // b̄₋ₖ and b_{k−2} eliminated: two equations for a_k and ā_{2−k}.
            let (ratio, back) = (power(outer / inner, k), power(inner / outer, k - 2));
            let square = outer * outer;
            let k11 = kappa * power(inner, k) + power(outer, k) * ratio;
            let k12 = -m * (square * power(inner, -k) - power(inner, 2 - k));
            let k21 = n * (power(inner, k - 2) * square - power(inner, k));
            let k22 = kappa * power(inner, 2 - k) + back * power(outer, 2 - k);
            let (x, y) = (r1 + r2 * ratio, r1_other + r2_other * back);
            let determinant = k11 * k22 - k12 * k21;
            let a_k = (x * k22 - y * k12) / determinant;
            let a_other = (y * k11 - x * k21) / determinant;
            a.push((k, a_k));
            a.push((2 - k, a_other.conj()));
            let lower = r2 - a_k * power(outer, k) + a_other * (m * power(outer, 2 - k));
            b.push((-k, (lower * power(outer, k)).conj()));
            let upper = r2_other - a_other * power(outer, 2 - k) - a_k * (n * power(outer, k));
            b.push((k - 2, upper * power(outer, 2 - k)));
        }
        Self { force: f, a, b }
    }

    /// At a seat at an angle from the loaded one.
    fn seen(&self, annulus: &Annulus, angle: f64, seat: f64, is_own: bool) -> Seen {
        let (f, kappa) = (self.force, annulus.kappa);
        let fb = f.conj();
        let z = C::from_polar(1.0, angle);
        // φ, φ', φ'', ψ and ψ'; the logarithms of φ and ψ are one real one in u.
        let (mut phi, mut first, mut second) = (C::default(), f / z, -f / (z * z));
        let (mut psi, mut slope) = (C::default(), -fb * kappa / z);
        for (n, a) in &self.a {
            let (n, term) = (f64::from(*n), a * C::from_polar(1.0, f64::from(*n) * angle));
            phi += term;
            first += term * n / z;
            second += term * (n * (n - 1.0)) / (z * z);
        }
        for (n, b) in &self.b {
            let (n, term) = (f64::from(*n), b * C::from_polar(1.0, f64::from(*n) * angle));
            psi += term;
            slope += term * n / z;
        }
        let mut logarithm = 0.0;
        if is_own {
            logarithm -= seat.ln();
        } else {
            let d = z - 1.0;
            logarithm -= d.norm().ln();
            first -= f / d;
            second += f / (d * d);
            slope += fb * kappa / d - f / (d * d);
            psi += f / d;
        }
        let u = phi * kappa + f * (2.0 * kappa * logarithm) - z * first.conj() - psi.conj();
        // ∂u/∂z = κφ' − φ̄', ∂u/∂z̄ = −z φ̄'' − ψ̄', ∇²u = −4 φ̄''; ρ²/4 ∇²u for each of two seats.
        let moved = u - second.conj() * (2.0 * seat * seat);
        let turned = C::from_polar(1.0, -angle);
        Seen {
            moved: moved * turned,
            stretch: (kappa - 1.0) * first.re,
            shear: (-z * second.conj() - slope.conj()) * turned * turned,
        }
    }
}
