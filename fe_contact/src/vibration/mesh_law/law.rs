//! A mesh law as couplings: front flanks, then backside flanks.

use std::sync::Arc;

use dynamics::CouplingForce;
use gearset::MeshLaw;

/// Tables are shared by the sets at all speeds.
#[derive(Debug, Clone)]
pub(super) struct MeshLawCouplings(pub(super) Arc<MeshLaw>);

impl CouplingForce for MeshLawCouplings {
    #[inline]
    fn answer(&self, coupling: usize, step_in_cycle: usize, deflection: f64) -> (f64, f64) {
        self.0.force(coupling, step_in_cycle, deflection)
    }

    fn silent_up_to(&self, coupling: usize) -> f64 {
        self.0.silent_up_to_m(coupling)
    }

    fn is_same(&self, first: (usize, usize), second: (usize, usize)) -> bool {
        self.0.is_same(first, second)
    }
}
