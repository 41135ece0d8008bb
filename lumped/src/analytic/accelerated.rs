//! Static displacement of an annulus that its race accelerates, in closed form.
//!
//! A body of density ρ that vibrates with its race as λ = ω² has the inertial forces λρq of the rigid motion q, under
//! which it yields by λw, for a race at r = a and a free edge at r = b.

use std::f64::consts::PI;

use gearset::gauss_points;

use super::plane::Plane;

/// An annulus with its race at `race` (m) and a free edge at `free` (m), accelerated by its race.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accelerated {
    pub(super) race: f64,
    pub(super) free: f64,
    pub(super) density: f64,
    kappa: f64,
    pub(super) shear: f64,
    width: f64,
    /// A, A₂, B and D.
    terms: [f64; 4],
}

impl Accelerated {
    /// Density in kg/m³.
    pub(super) fn new(race: f64, free: f64, density: f64, plane: &Plane) -> Self {
        let kappa = 3.0 - 4.0 * plane.poisson;
        let (a, b) = (race, free);
        let d = -density * (kappa - 1.0) / (4.0 * kappa);
        let log = density * b * b / (2.0 * (1.0 + kappa));
        let right = 2.0 * log * a * a / b.powi(3) - 2.0 * log / b - 2.0 * d * b / (kappa - 1.0);
        let square = right / (2.0 * b + 2.0 * kappa * a.powi(4) / b.powi(3));
        let inverse = a * a * (kappa * square * a * a - log);
        let terms = [log, square, inverse, d];
        Self { race, free, density, kappa, shear: plane.shear, width: plane.width, terms }
    }

    /// w at r under a unit rotation, m per rad and (rad/s)².
    ///
    /// `[eq:annulus-turned]` w = ρ θ r/(4G) [b⁴/2 (1/a² − 1/r²) − (r² − a²)/2], tangential, of a rotation by θ about
    /// the centre.
    /// Source: derived here.
    /// Checked by: `lumped/src/analytic/accelerated.rs::displacements_are_in_equilibrium`.
    pub(super) fn by_rotation(&self, r: f64) -> f64 {
        let (a, b) = (self.race, self.free);
        let shown = 0.5 * b.powi(4) * (1.0 / (a * a) - 1.0 / (r * r)) - 0.5 * (r * r - a * a);
        self.density * r / (4.0 * self.shear) * shown
    }

    /// W₀ and W₂ at r under a unit translation, m per m and (rad/s)².
    ///
    /// `[eq:annulus-moved]` w of a translation by 1 along x:
    /// ```text
    /// w = W₀ + W₂ e^{2iϑ},   2G W₀ = 2κA ln(r/a) − 2(A₂ − D)(r² − a²),   2G W₂ = −A + κA₂ r² − B/r²,
    /// D = −ρ (κ − 1)/(4κ),   A = ρ b²/(2(1 + κ)),   B = a²(κ A₂ a² − A),
    /// A₂ (2b + 2κ a⁴/b³) = 2A a²/b³ − 2A/b − 2D b/(κ − 1).
    /// ```
    /// Source: derived here; notation of `carrier.rs`.
    /// Checked by: `lumped/src/analytic/accelerated.rs::displacements_are_in_equilibrium`.
    ///
    /// 2D z z̄ is a particular solution of the equations of equilibrium; the rest leaves the race at rest and the
    /// free edge without traction.
    pub(super) fn by_translation(&self, r: f64) -> [f64; 2] {
        let [log, square, inverse, d] = self.terms;
        let apart = r * r - self.race * self.race;
        let constant = 2.0 * self.kappa * log * (r / self.race).ln() - 2.0 * (square - d) * apart;
        let double = -log + self.kappa * square * r * r - inverse / (r * r);
        [constant, double].map(|w| w / (2.0 * self.shear))
    }

    /// ∫ρ q·w dV of a unit translation and of a unit rotation: kg and kg m² per (rad/s)².
    pub(super) fn moved(&self) -> [f64; 2] {
        let (low, high) = (self.race.min(self.free), self.race.max(self.free));
        let mut sums = [0.0, 0.0];
        for (r, weight) in gauss_points(low, high) {
            let ring = 2.0 * PI * r * weight * self.density * self.width;
            sums[0] += ring * self.by_translation(r)[0];
            sums[1] += ring * r * self.by_rotation(r);
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(race: f64, free: f64) -> Accelerated {
        let (young, poisson) = (207e9, 0.3);
        let plane = Plane {
            modulus: young / (1.0 - poisson * poisson),
            shear: 0.5 * young / (1.0 + poisson),
            poisson,
            width: 0.02,
        };
        Accelerated::new(race, free, 7800.0, &plane)
    }

    /// Stresses from differences of the displacements: no displacement at the race, no traction at the free edge and
    /// equilibrium with the inertial forces between, for races inside and outside.
    #[test]
    fn displacements_are_in_equilibrium() {
        for (race, free) in [(0.04, 0.1), (0.1, 0.07)] {
            let own = body(race, free);
            assert!(own.by_rotation(race).abs() < 1e-25);
            let at_race = own.by_translation(race);
            let size = own.by_translation(free)[0].abs();
            assert!(at_race.iter().all(|w| w.abs() < 1e-10 * size), "{at_race:?} {size}");
            // Displacement (u, v) at a point under a unit translation along x.
            let u = |x: f64, y: f64| {
                let (r, angle) = (x.hypot(y), y.atan2(x));
                let [constant, double] = own.by_translation(r);
                [constant + double * (2.0 * angle).cos(), double * (2.0 * angle).sin()]
            };
            let (g, nu, h) = (own.shear, 0.3, 1e-4);
            let lame = 2.0 * g * nu / (1.0 - 2.0 * nu);
            let stress = |x: f64, y: f64| {
                let dx = [0, 1].map(|i| (u(x + h, y)[i] - u(x - h, y)[i]) / (2.0 * h));
                let dy = [0, 1].map(|i| (u(x, y + h)[i] - u(x, y - h)[i]) / (2.0 * h));
                let trace = lame * (dx[0] + dy[1]);
                [trace + 2.0 * g * dx[0], trace + 2.0 * g * dy[1], g * (dx[1] + dy[0])]
            };
            for angle in [0.3f64, 1.4, 2.8] {
                let (sin, cos) = angle.sin_cos();
                let [xx, yy, xy] = stress(free * cos, free * sin);
                let scale = 7800.0 * race.max(free);
                for traction in [xx * cos + xy * sin, xy * cos + yy * sin] {
                    assert!(traction.abs() < 2e-4 * scale, "{traction} of {scale}");
                }
                // ∂σ_xx/∂x + ∂σ_xy/∂y + ρ = 0, ∂σ_xy/∂x + ∂σ_yy/∂y = 0
                let r = 0.5 * (race + free);
                let (x, y) = (r * cos, r * sin);
                let across =
                    [0, 1, 2].map(|i| (stress(x + h, y)[i] - stress(x - h, y)[i]) / (2.0 * h));
                let along =
                    [0, 1, 2].map(|i| (stress(x, y + h)[i] - stress(x, y - h)[i]) / (2.0 * h));
                assert!((across[0] + along[2] + 7800.0).abs() < 2.0, "{}", across[0] + along[2]);
                assert!((across[2] + along[1]).abs() < 2.0, "{}", across[2] + along[1]);
            }
            // ∂(r²σ)/∂r + ρ r³ = 0 with σ = G (w' − w/r), and no traction at the free edge.
            let shear = |r: f64| {
                let slope = (own.by_rotation(r + h) - own.by_rotation(r - h)) / (2.0 * h);
                r * r * g * (slope - own.by_rotation(r) / r)
            };
            assert!(shear(free).abs() < 1e-3 * 7800.0 * free.powi(4));
            let r = 0.5 * (race + free);
            let rest = (shear(r + h) - shear(r - h)) / (2.0 * h) + 7800.0 * r.powi(3);
            assert!(rest.abs() < 1e-3 * 7800.0 * r.powi(3), "{rest}");
        }
    }
}
