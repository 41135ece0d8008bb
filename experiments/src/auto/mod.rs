//! The cheapest settings that give one quantity within a tolerance, with the estimated error of the answer.
//!
//! Candidates are tried from cheap to dear. Each answers the question and estimates its own error, one part for every
//! approximation it makes; the parts are added as if all had the same sign, those of an amplitude by squares. The first
//! candidate whose estimate is within the tolerance is the answer, and where none is, there is no answer. Equations,
//! limits and the test of the estimates: `docs/auto.md`.

mod amplitude;
mod amplitude_indicators;
mod amplitude_meshes;
mod amplitude_run;
mod analytic_mean;
mod analytic_mode;
mod choice;
mod cycle_curve;
mod cycle_request;
mod cycle_with_settings;
mod elastic_change;
mod elastic_response;
mod energy;
mod error_parts;
mod finer_curve;
mod frequency;
mod linear_motion;
mod response;
mod set_modes;
mod settings;
mod step_frequency;
mod transmission_error;
mod trial;

pub use amplitude::{
    AmplitudeRequest, ChosenSweep, amplitude_with, choose_amplitude, stepped_amplitude_with,
};
pub use choice::{AutoError, Choice, Correction, ErrorPart, PassedOver};
pub use cycle_request::{CycleRequest, CycleValue};
pub use cycle_with_settings::{cycle_with, transmission_error_with};
pub use error_parts::stiffness_errors;
pub use frequency::{FrequencyRequest, choose_frequency, frequency_with};
pub use settings::{AutoModel, AutoSettings};
pub use transmission_error::choose_transmission_error;
