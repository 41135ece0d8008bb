//! The elastic plane of a scene's bodies.

use scene::Scene;

/// Constants of the plane-strain body that behaves as the scene's material does, and the face width.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plane {
    /// E' = E/(1 − ν²), Pa.
    pub(super) modulus: f64,
    /// G, Pa.
    pub(super) shear: f64,
    /// ν.
    pub(super) poisson: f64,
    /// b, m.
    pub(super) width: f64,
}

impl Plane {
    pub(super) fn new(scene: &Scene, width: f64) -> Self {
        let (young, poisson) = scene.material.plane_strain_equivalent(scene.fe_contact.plane);
        let modulus = young / (1.0 - poisson * poisson);
        Self { modulus, shear: 0.5 * young / (1.0 + poisson), poisson, width }
    }
}
