//! The cheapest settings that give one quantity within a tolerance, with the estimated error of the answer.
//!
//! Settings are refined along two axes, each until two successive settings agree: discretisation (elements, contact
//! cells, positions or time steps, all by one ratio) and the inertia of the bodies behind the teeth. The estimated
//! error is the sum of what both leave. Equations, limits and the test of the estimates: `docs/auto.md`.

mod amplitude;
mod choice;
mod frequency;
mod question;
mod search;
mod settings;
mod transmission_error;

pub use amplitude::{AmplitudeQuestion, ChosenSweep, choose_amplitude};
pub use choice::{AutoError, Choice, ErrorPart, PassedOver};
pub use frequency::{FrequencyQuestion, choose_frequency};
pub use question::{ClosedForm, Question};
pub use settings::{AutoModel, AutoSettings, BodyInertia, LEVELS, SHARED_KEYS};
pub use transmission_error::{CycleCurve, CycleQuestion, CycleValue, choose_transmission_error};
