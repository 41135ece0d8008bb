//! Hertz's line contact in closed form.

use std::f64::consts::PI;

use crate::material::Elastic;

/// Two cylinders of one material pressed together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// Half-width a, m.
    pub half_width: f64,
    /// Peak pressure p₀, Pa.
    pub peak_pressure: f64,
}

impl Hertz {
    /// Contact under `line_load` (N/m) with 1/R = 1/R₁ ± 1/R₂ given as `radius` (m).
    ///
    /// `[eq:hertz-line-contact]` a² = 4 P R/(π E\*), p₀ = 2P/(π a), 1/E\* = 2/E'.
    /// Source: Johnson, Contact Mechanics (1985), §4.2(c).
    /// Checked by: `fe_contact/tests/hertz.rs::profile_half_width_and_approach`, `fe.hertz.cylinders`,
    /// `fe.hertz.mid_flank`.
    pub fn new(line_load: f64, radius: f64, material: &Elastic) -> Self {
        let e = 0.5 * material.plane_modulus();
        let half_width = (4.0 * line_load * radius / (PI * e)).sqrt();
        let peak_pressure =
            if half_width > 0.0 { 2.0 * line_load / (PI * half_width) } else { 0.0 };
        Self { half_width, peak_pressure }
    }

    /// p(x) = p₀ √(1 − x²/a²), Pa.
    pub fn pressure(&self, x: f64) -> f64 {
        self.peak_pressure * (1.0 - (x / self.half_width).powi(2)).max(0.0).sqrt()
    }

    /// Compression of one body between the centre of its surface and the point at `depth` (m) below
    /// it, m.
    ///
    /// `[eq:hertz-compression]` (p₀/E') [a asinh(d/a) − ν/(1 − ν) (d√(a² + d²) − d²)/a] down to the depth d: ε_z
    /// integrated along the axis with σ_z = −p₀ a/√(a² + z²) and σ_x = −p₀ [(a² + 2z²)/(a√(a² + z²)) − 2z/a].
    /// Source: Johnson, Contact Mechanics (1985), §5.6.
    /// Checked by: `fe_contact/src/contact/hertz.rs::deep_compression_is_johnsons_5_57`,
    /// `fe_contact/tests/hertz.rs::approach_between_matched_points`.
    pub fn compression(&self, depth: f64, material: &Elastic) -> f64 {
        let (a, d) = (self.half_width, depth);
        let (_, nu) = material.plane_strain_equivalent();
        let sideways = (d * a.hypot(d) - d * d) / a;
        self.peak_pressure / material.plane_modulus()
            * (a * (d / a).asinh() - nu / (1.0 - nu) * sideways)
    }
}

/// Half-width and peak pressure of the ellipse nearest to a pressure distribution: p² is a parabola
/// in x, fitted by least squares over the loaded cells. `None` with fewer than four of them.
pub fn fit(positions: &[f64], pressures: &[f64]) -> Option<Hertz> {
    let loaded: Vec<(f64, f64)> =
        positions.iter().zip(pressures).filter(|c| *c.1 > 0.0).map(|(x, p)| (*x, p * p)).collect();
    if loaded.len() < 4 {
        return None;
    }
    let n = loaded.len() as f64;
    let centre = loaded.iter().map(|c| c.0).sum::<f64>() / n;
    let scale = loaded.iter().map(|c| (c.0 - centre).abs()).fold(0.0, f64::max);
    let mut normal = nalgebra::Matrix3::zeros();
    let mut right = nalgebra::Vector3::zeros();
    for (x, square) in &loaded {
        let xi = (x - centre) / scale;
        let row = nalgebra::Vector3::new(1.0, xi, xi * xi);
        normal += row * row.transpose();
        right += row * *square;
    }
    let c = normal.cholesky()?.solve(&right);
    // p² = c₀ + c₁ξ + c₂ξ²: vertex at −c₁/2c₂, zero at √(peak/−c₂) from it.
    let peak = c[0] - c[1] * c[1] / (4.0 * c[2]);
    (c[2] < 0.0 && peak > 0.0)
        .then(|| Hertz { half_width: scale * (peak / -c[2]).sqrt(), peak_pressure: peak.sqrt() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::PlaneState;

    #[test]
    fn deep_compression_is_johnsons_5_57() {
        let m = Elastic { young: 207e9, poisson: 0.3, density: 1.0, plane: PlaneState::Strain };
        let hertz = Hertz::new(4e5, 8e-3, &m);
        let d = 100.0 * hertz.half_width;
        // δ = P (1 − ν²)/(πE) [2 ln(2d/a) − ν/(1 − ν)]
        let expected =
            4e5 / (PI * m.plane_modulus()) * (2.0 * (2.0 * d / hertz.half_width).ln() - 0.3 / 0.7);
        assert!((hertz.compression(d, &m) / expected - 1.0).abs() < 1e-4);
    }

    #[test]
    fn fit_finds_its_own_ellipse() {
        let truth = Hertz { half_width: 2e-4, peak_pressure: 1.3e9 };
        let x: Vec<f64> = (0..30).map(|i| (f64::from(i) - 14.2) * 1.5e-5).collect();
        let p: Vec<f64> = x.iter().map(|x| truth.pressure(x - 1e-5)).collect();
        let found = fit(&x, &p).unwrap();
        assert!((found.half_width / truth.half_width - 1.0).abs() < 1e-12);
        assert!((found.peak_pressure / truth.peak_pressure - 1.0).abs() < 1e-12);
        assert!(fit(&x[..3], &p[..3]).is_none());
    }
}
