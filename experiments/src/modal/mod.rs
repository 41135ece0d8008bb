//! The virtual modal test: FE/contact natural frequencies from transients, and by linearisation.

mod agreement;
mod band;
mod fed;
mod impulse;
mod kinds;
mod linear;
mod mode;
mod settings;

pub use agreement::{Agreement, agreement, agreement_after, with_rigid_carrier};
pub use band::{FrequencyBand, ModeBand, Spread, frequency_band};
pub use fed::{fed_from, fed_lumped, lumped_frequencies, majority};
pub use impulse::{Contents, Decay, ImpulseTest, Pulse, impulse_test, pulses};
pub use linear::{MeshInfluence, Preload, linear_modes, mesh_influence, preloaded};
pub use mode::{FeMode, of_type};
pub use settings::{ImpulseSettings, SettingsError};
