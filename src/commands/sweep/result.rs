//! What a sweep found.

use experiments::auto::Choice;
use experiments::sweep::{
    Attractors, FailedPoint, SteadyMethod, SteadySettings, Sweep, SweepPoint,
};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

/// A sweep as JSON.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SweepOutput {
    /// Scene.
    pub(super) scene: String,
    /// Name of the fidelity or model.
    pub(super) fidelity: String,
    /// Version of the program.
    version: String,
    /// Torque on the sun, N·m.
    pub(super) sun_torque_nm: f64,
    /// Steps in a mesh cycle.
    pub(super) steps_per_cycle: u32,
    /// How steady states were to be found.
    method: SteadyMethod,
    /// Largest change of a steady state from cycle to cycle, over its peak-to-peak vibration.
    tolerance: f64,
    /// Largest number of mesh cycles integrated at one speed.
    pub(super) most_cycles: usize,
    /// Highest harmonic.
    pub(super) harmonics: usize,
    /// Cycles over which energy between harmonics is measured.
    between_cycles: usize,
    /// Points by speed, at one speed in the order of their chains. The translation that tables and figures show
    /// is √(R² + T²) of the amplitudes R and T of `radial` and `tangential` in one harmonic.
    pub(super) points: Vec<ChainPoint>,
    /// Speeds (rpm) at which chains arrived at different motions that attract.
    coexisting_rpm: Vec<f64>,
    /// Speeds that several chains reached, with the motions that attract on which these ended; empty if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) attractors: Vec<Attractors>,
    /// Speeds at which nothing could be computed, by speed.
    pub(super) failed: Vec<FailedPoint>,
    /// With `fidelity = "auto"`: the settings chosen, why, and the amplitude with its estimated error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) auto: Option<Choice>,
}

/// A point with the chain that it belongs to.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ChainPoint {
    /// Chain of the plan: `up_00`, `down_00`, `peak_00`, `random_01_00` and so on.
    pub(super) chain: String,
    #[serde(flatten)]
    pub(super) point: SweepPoint,
}

impl SweepOutput {
    pub(super) fn new(
        scene: &Scene,
        sun_torque_nm: f64,
        settings: &SteadySettings,
        sweep: &Sweep,
    ) -> Self {
        let point = |(chain, point): (&str, &SweepPoint)| ChainPoint {
            chain: chain.to_owned(),
            point: point.clone(),
        };
        Self {
            scene: scene.title.clone(),
            fidelity: sweep.fidelity.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            sun_torque_nm,
            steps_per_cycle: scene.dynamics.steps_per_cycle,
            tolerance: settings.tolerance,
            method: settings.method,
            most_cycles: settings.most_cycles,
            coexisting_rpm: sweep.coexisting_rpm(),
            attractors: sweep.attractors(),
            harmonics: settings.harmonics,
            between_cycles: settings.between_cycles,
            points: sweep.by_speed().into_iter().map(point).collect(),
            failed: sweep.failed_by_speed().into_iter().cloned().collect(),
            auto: None,
        }
    }

    /// The same with what `fidelity = "auto"` chose.
    pub(super) fn chosen_by(self, choice: Choice) -> Self {
        Self { auto: Some(choice), ..self }
    }
}
