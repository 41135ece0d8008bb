//! Results of this program that take too long to be computed by every run, as kept in `reference/` with
//! the commands that remake them.

use serde::Deserialize;

/// `full_impulse.toml`.
#[derive(Debug, Deserialize)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct FullImpulse {
    pub source: String,
    pub command: String,
    pub flank_elements: u32,
    pub torque_nm: f64,
    pub position: f64,
    pub set: Vec<FullImpulseSet>,
}

/// Modes of one set, ascending.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct FullImpulseSet {
    pub scene: String,
    pub frequencies_hz: Vec<f64>,
    pub damping_ratios: Vec<f64>,
}

/// `torque_peaks.toml`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct TorquePeaks {
    pub source: String,
    pub command: String,
    pub torques_nm: Vec<f64>,
    pub peak: Vec<TorquePeak>,
}

/// One resonance: heights over those at the first torque.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct TorquePeak {
    pub system: String,
    pub mode: String,
    pub harmonic: u32,
    pub frequency_hz: f64,
    pub speeds_rpm: Vec<f64>,
    pub sun: Vec<f64>,
    pub planet: Vec<f64>,
    /// The harmonic of the sun's static deflection that drives it.
    #[serde(rename = "static")]
    pub at_rest: Vec<f64>,
}

/// `torque_map.toml`: section 4.2 over mesh compliance and γ.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct TorqueMap {
    pub source: String,
    pub command: String,
    pub torques_nm: Vec<f64>,
    pub cell: Vec<MapCell>,
}

/// One choice of compliance, γ, damping and relief; heights over those at the first torque.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct MapCell {
    /// `map`, or what is different on a line at the default scene's γ.
    pub line: String,
    /// From the default scene (0) to the printed stiffness (1).
    pub softening: f64,
    pub gamma_cycles: f64,
    /// Sun meshes and ring meshes.
    pub mean_stiffness_n_per_um: [f64; 2],
    pub translational: Vec<f64>,
    /// Height at the first torque, m.
    pub translational_first: f64,
    pub translational_static: Vec<f64>,
    pub rotational: Vec<f64>,
    /// rad
    pub rotational_first: f64,
    pub rotational_static: Vec<f64>,
    pub third: Vec<f64>,
    /// m
    pub third_first: f64,
    pub third_static: Vec<f64>,
    pub monotonic: bool,
    pub rotation_above_translation: bool,
    pub third_below_rotation: bool,
}
