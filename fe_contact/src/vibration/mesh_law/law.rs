//! A mesh law as couplings: front flanks, then back flanks.

use dynamics::CouplingLaw;
use gearset::{FlankSide, MeshCurve, MeshLaw};

#[derive(Debug, Clone)]
pub(super) struct Tables(pub(super) MeshLaw);

impl Tables {
    #[inline]
    pub(super) fn curve(&self, coupling: usize, step_in_cycle: usize) -> Option<&MeshCurve> {
        match coupling.checked_sub(self.0.meshes()) {
            None => Some(self.0.front(coupling, step_in_cycle)),
            Some(mesh) => self.0.back(mesh, step_in_cycle),
        }
    }
}

impl CouplingLaw for Tables {
    #[inline]
    fn answer(&self, coupling: usize, step_in_cycle: usize, deflection: f64) -> (f64, f64) {
        self.curve(coupling, step_in_cycle).map_or((0.0, 0.0), |curve| curve.force(deflection))
    }

    fn silent_up_to(&self, coupling: usize) -> f64 {
        let (mesh, side) = match coupling.checked_sub(self.0.meshes()) {
            None => (coupling, FlankSide::Front),
            Some(mesh) => (mesh, FlankSide::Back),
        };
        self.0.first_contact_m(mesh, side).unwrap_or(f64::INFINITY)
    }
}
