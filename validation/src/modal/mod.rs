//! The virtual modal test: FE/contact natural frequencies from transients, and by linearisation.

mod agreement;
mod band;
mod effect_tables;
mod effects;
mod fed;
mod impulse;
mod kinds;
mod linear;
mod mode;
mod settings;
mod tabled;
mod variant;

pub use agreement::{Agreement, agreement, agreement_after};
pub use band::{FrequencyBand, ModeBand, Spread, frequency_band};
pub use effects::{Effect, EffectStudy, Effects, PathStep, effects};
pub use fed::{fed_from, fed_lumped, lumped_frequencies};
pub use impulse::{Contents, Decay, ImpulseTest, Pulse, impulse_test, pulses};
pub use linear::{MeshInfluence, Preload, linear_modes, mesh_influence, preloaded};
pub use mode::{FeMode, of_type};
pub use settings::{ImpulseSettings, SettingsError};
pub use tabled::{TabledFrequency, TypedFrequency, tabled};
pub use variant::{Base, Variant};
