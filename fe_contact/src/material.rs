//! Isotropic linear elasticity in the plane.

use scene::{Material, PlaneState};

/// Elastic constants with the state of the plane, SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// E, Pa.
    pub young: f64,
    /// ν.
    pub poisson: f64,
    /// ρ, kg/m³.
    pub density: f64,
    /// Plane strain or plane stress.
    pub plane: PlaneState,
}

impl Elastic {
    /// Constants of a scene's material.
    pub fn new(material: &Material, plane: PlaneState) -> Self {
        Self {
            young: material.young_modulus_pa,
            poisson: material.poisson_ratio,
            density: material.density_kg_per_m3,
            plane,
        }
    }

    /// E (Pa) and ν of the plane-strain body that behaves as this one.
    pub fn plane_strain_equivalent(&self) -> (f64, f64) {
        let material = Material {
            young_modulus_pa: self.young,
            poisson_ratio: self.poisson,
            density_kg_per_m3: self.density,
        };
        material.plane_strain_equivalent(self.plane)
    }

    /// E' = E/(1 − ν²) in plane strain, E in plane stress, Pa.
    pub fn plane_modulus(&self) -> f64 {
        let (e, nu) = self.plane_strain_equivalent();
        e / (1.0 - nu * nu)
    }

    /// `[eq:plane-elasticity]` D of σ = D ε with ε = (ε_x, ε_y, γ_xy), 3×3, Pa: D = E/((1 + ν)(1 − 2ν)) [1−ν, ν, 0;
    /// ν, 1−ν, 0; 0, 0, ½−ν].
    ///
    /// Source: textbook; plane stress by the plane-strain body that behaves alike.
    /// Checked by: `fe_contact/src/material.rs::plane_stress_is_the_textbook_matrix`.
    pub fn stiffness(&self) -> [[f64; 3]; 3] {
        let (e, nu) = self.plane_strain_equivalent();
        let c = e / ((1.0 + nu) * (1.0 - 2.0 * nu));
        let (direct, cross, shear) = (c * (1.0 - nu), c * nu, 0.5 * e / (1.0 + nu));
        [[direct, cross, 0.0], [cross, direct, 0.0], [0.0, 0.0, shear]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plane_stress_is_the_textbook_matrix() {
        let m = Elastic { young: 207e9, poisson: 0.3, density: 1.0, plane: PlaneState::Stress };
        let d = m.stiffness();
        // E/(1 − ν²) [1 ν 0; ν 1 0; 0 0 (1 − ν)/2]
        let c = 207e9 / (1.0 - 0.09);
        for (found, expected) in [(d[0][0], c), (d[0][1], 0.3 * c), (d[2][2], 0.35 * c)] {
            assert!((found / expected - 1.0).abs() < 1e-14);
        }
        assert!((m.plane_modulus() / 207e9 - 1.0).abs() < 1e-14);
    }
}
