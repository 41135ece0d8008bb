//! Elastic half-plane under a strip of uniform pressure.
//!
//! Displacements in the plane are known up to a rigid motion only (ln r does not vanish far away), so that only their
//! differences have a meaning.

use crate::material::Elastic;

/// Half-plane z ≥ 0 of unit thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// (1 + ν)/(π E), 1/Pa.
    scale: f64,
    poisson: f64,
}

impl HalfPlane {
    /// Half-plane of a material, plane strain or plane stress.
    pub fn new(material: &Elastic) -> Self {
        let (e, poisson) = material.plane_strain_equivalent();
        Self { scale: (1.0 + poisson) / (std::f64::consts::PI * e), poisson }
    }

    /// Normal displacement at (x, z), into the body, under unit pressure on |x| ≤ h, up to a
    /// constant, m/Pa.
    ///
    /// `[eq:half-plane-strip]` Flamant's u_z = (1 + ν)/(πE) [z²/r² − 2 (1 − ν) ln r] for a unit line load, integrated
    /// over the strip: ∫ = [−(1 − ν)(ξ ln(ξ² + z²) − 2ξ) − (1 − 2ν) z atan(ξ/z)] from ξ = x − h to x + h.
    /// Source: Johnson, Contact Mechanics (1985), §2.3 and §2.5.
    /// Checked by: `fe_contact/src/contact/half_plane.rs::line_load_on_its_axis`,
    /// `fe_contact/src/contact/half_plane.rs::field_is_in_equilibrium`.
    pub fn strip(&self, x: f64, z: f64, h: f64) -> f64 {
        self.scale * (self.up_to(x + h, z) - self.up_to(x - h, z))
    }

    /// The bracket of the integral over a strip, at ξ = `xi`, m.
    fn up_to(&self, xi: f64, z: f64) -> f64 {
        let nu = self.poisson;
        let r2 = xi * xi + z * z;
        let log = if r2 > 0.0 { xi * r2.ln() } else { 0.0 };
        let angle = if z > 0.0 { z * (xi / z).atan() } else { 0.0 };
        -(1.0 - nu) * (log - 2.0 * xi) - (1.0 - 2.0 * nu) * angle
    }

    /// Displacement of the surface under unit pressure up to an edge, at `xi` = x less the edge's coordinate, up to a
    /// constant, m/Pa: that of a strip is this at its low edge less this at its high edge.
    pub(super) fn surface_up_to(&self, xi: f64) -> f64 {
        self.scale * self.up_to(xi, 0.0)
    }

    /// Displacement at (x, z) under a unit force per length on a strip whose width squared is `width2` (m²) and which
    /// is narrow beside its distance r = √(x² + z²), up to a constant, m/(N/m).
    ///
    /// `[eq:narrow-strip]` Mean over the strip of Flamant's f = (1 + ν)/(πE) [z²/r² − 2 (1 − ν) ln r]: f + w²/24
    /// ∂²f/∂x², whose first term left out is of the order (w/r)⁴/1920.
    /// Source: derived here.
    /// Checked by: `fe_contact/src/contact/half_plane.rs::a_narrow_strip_is_a_strip`.
    pub(super) fn narrow_strip(&self, x: f64, z: f64, width2: f64) -> f64 {
        let (x2, z2) = (x * x, z * z);
        let (r2, nu) = (x2 + z2, self.poisson);
        let f = z2 / r2 - (1.0 - nu) * r2.ln();
        let bent =
            z2 * (6.0 * x2 - 2.0 * z2) / (r2 * r2 * r2) - 2.0 * (1.0 - nu) * (z2 - x2) / (r2 * r2);
        self.scale * (f + width2 / 24.0 * bent)
    }

    /// Surface displacement at x relative to the point at depth `depth` below it, under unit
    /// pressure on |x| ≤ h: the bracket of the paper's eq. (1), m/Pa.
    pub fn strip_above_depth(&self, x: f64, depth: f64, h: f64) -> f64 {
        self.strip(x, 0.0, h) - self.strip(x, depth, h)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::PlaneState;

    fn steel(plane: PlaneState) -> Elastic {
        Elastic { young: 207e9, poisson: 0.3, density: 7595.0, plane }
    }

    /// On the axis of a narrow strip σ_z = −2P/(πz) and σ_x = 0, so
    /// u(z₁) − u(z₂) = 2P/(πE') ln(z₂/z₁).
    #[test]
    fn line_load_on_its_axis() {
        for plane in [PlaneState::Strain, PlaneState::Stress] {
            let m = steel(plane);
            let half = HalfPlane::new(&m);
            let h = 1e-7;
            let (z1, z2) = (1e-3, 3e-3);
            let found = (half.strip(0.0, z1, h) - half.strip(0.0, z2, h)) / (2.0 * h);
            let expected = 2.0 / (std::f64::consts::PI * m.plane_modulus()) * 3f64.ln();
            assert!((found / expected - 1.0).abs() < 1e-6);
        }
    }

    /// Off the axis: the field obeys the equilibrium of the normal direction. With the surface free
    /// of shear, ∇²u_z + ∂(div u)/∂z/(1 − 2ν) = 0, and div u of Flamant's field is
    /// −2P(1+ν)(1−2ν)/(πE) z/r², whose z-derivative is known.
    #[test]
    fn field_is_in_equilibrium() {
        let m = steel(PlaneState::Strain);
        let half = HalfPlane::new(&m);
        let (h, d) = (1e-7, 1e-5);
        let u = |x: f64, z: f64| half.strip(x, z, h) / (2.0 * h);
        for (x, z) in [(4e-4, 7e-4), (-1e-3, 3e-4), (0.0, 5e-4)] {
            let laplace =
                (u(x + d, z) + u(x - d, z) + u(x, z + d) + u(x, z - d) - 4.0 * u(x, z)) / (d * d);
            let r2: f64 = x * x + z * z;
            // ∂/∂z (z/r²) = (x² − z²)/r⁴
            let divergence = -2.0 * half.scale * (x * x - z * z) / (r2 * r2);
            assert!((laplace + divergence).abs() < 2e-3 * divergence.abs(), "{x} {z}");
        }
    }

    /// The series of a narrow strip is the strip up to its first term left out.
    #[test]
    fn a_narrow_strip_is_a_strip() {
        let half = HalfPlane::new(&steel(PlaneState::Strain));
        let z = 5e-4;
        for w in [1e-4, 5e-5] {
            for x in [0.0, 2e-4, -7e-4] {
                let whole = half.strip(x, z, 0.5 * w) / w;
                let off = (half.narrow_strip(x, z, w * w) - whole).abs();
                // ∂⁴f/∂x⁴ is at most 3! · 2 (1 − ν)/z⁴ from the logarithm and 4!/z⁴ from z²/r².
                assert!(off < 40.0 * half.scale / 1920.0 * (w / z).powi(4), "{w} {x} {off:e}");
            }
        }
    }

    #[test]
    fn strips_add_up() {
        let half = HalfPlane::new(&steel(PlaneState::Stress));
        let whole = half.strip_above_depth(3e-4, 1e-3, 2e-4);
        let parts: f64 =
            [-1.0, 1.0].map(|s| half.strip_above_depth(3e-4 - s * 1e-4, 1e-3, 1e-4)).iter().sum();
        assert!((whole / parts - 1.0).abs() < 1e-12);
    }
}
