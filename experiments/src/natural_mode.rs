//! A natural frequency with its kind, whichever model it is of.

use lumped::ModeType;

/// A natural frequency with its kind; one that occurs twice is listed twice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NaturalMode {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Kind.
    pub mode_type: ModeType,
}
