//! What an impulse test found.

use experiments::modal::{FeMode, FrequencyBand, ImpulseTest};
use fe_contact::statics::{Bodies, Races};
use scene::Scene;

/// All that was found.
pub(super) struct Found {
    pub(super) scene: Scene,
    #[cfg_attr(not(feature = "charts"), expect(dead_code, reason = "figures show its gears"))]
    pub(super) bodies: Bodies,
    pub(super) races: Races,
    pub(super) test: ImpulseTest,
    /// Linearised modes in the band of the test with their ∂ln f/∂ln k_mesh; none for bodies with
    /// every degree of freedom.
    pub(super) linear: Option<Vec<(FeMode, f64)>>,
    /// Linearised modes outside the band, with quasi-static bodies in place of full ones.
    pub(super) outside: Vec<FeMode>,
    pub(super) band: Option<FrequencyBand>,
}
