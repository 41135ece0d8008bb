//! The virtual modal test: FE/contact natural frequencies from transients, and by linearisation.

mod agreement;
mod band;
mod beside;
mod error;
mod first_order_inertia;
mod impulse;
mod kinds;
mod linear;
mod lumped_from_fe;
mod mode;
mod settings;

pub use agreement::{Agreement, agreement, agreement_after, with_rigid_carrier};
pub use band::{FrequencyBand, ModeBand, Spread, frequency_band};
pub use beside::beside;
pub use error::ModalError;
pub(crate) use first_order_inertia::SLOW;
pub use first_order_inertia::first_order_inertia;
pub use impulse::{Contents, Decay, ImpulseTest, Pulse, impulse_test, pulses};
pub use kinds::MotionKinds;
pub(crate) use kinds::type_of;
pub use linear::{MeshInfluence, Preload, linear_modes, mesh_influence, preloaded};
pub use lumped_from_fe::{lumped_frequencies, lumped_from_fe, lumped_from_tangents, majority};
pub use mode::{FeMode, of_type};
pub use settings::{ImpulseSettings, SettingsError, band_of};
