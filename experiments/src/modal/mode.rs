//! One mode of the FE/contact model.

use lumped::ModeType;

use crate::natural_mode::NaturalMode;

/// A mode, found by linearisation or by an impulse test.
#[derive(Debug, Clone)]
pub struct FeMode {
    /// Natural frequency |s|/2π, Hz.
    pub frequency_hz: f64,
    /// −Re s/|s|; zero where damping was left out.
    pub damping_ratio: f64,
    /// Type by the larger part of its kinetic energy.
    pub mode_type: ModeType,
    /// Shares of rotational, translational and planet motion.
    pub shares: [f64; 3],
    /// Displacements of the races' coordinates (real), m.
    pub shape: Vec<f64>,
}

/// Modes of one type, ascending.
pub fn of_type(modes: &[FeMode], mode_type: ModeType) -> Vec<&FeMode> {
    modes.iter().filter(|m| m.mode_type == mode_type).collect()
}

impl From<&FeMode> for NaturalMode {
    fn from(mode: &FeMode) -> Self {
        Self { frequency_hz: mode.frequency_hz, mode_type: mode.mode_type }
    }
}
