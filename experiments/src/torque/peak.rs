//! A resonant peak under one torque, as tables list it.

use gearset::Facing;

use crate::sweep::{Coordinate, Part};

/// The peak of one harmonic of one quantity over speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorquePeak {
    /// Torque on the sun, N m, counter-clockwise positive.
    pub sun_torque_nm: f64,
    /// Sense in which the sun turns relative to the carrier; as its torque does if it is not given.
    pub sun_turns: Option<Facing>,
    /// Body or mesh.
    pub part: Part,
    /// Quantity.
    pub coordinate: Coordinate,
    /// Harmonic l of the mesh frequency.
    pub harmonic: usize,
    /// l f_m at the peak, or the natural frequency of the mode that is in resonance, Hz.
    pub frequency_hz: f64,
    /// Amplitude of the harmonic at the peak, in m, rad or N.
    pub amplitude: f64,
}
