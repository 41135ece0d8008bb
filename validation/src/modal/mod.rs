//! The virtual modal test: FE/contact natural frequencies from transients, and by linearisation.

mod impulse;
mod kinds;
mod linear;
mod mode;

pub use impulse::{Contents, Decay, ImpulseSettings, ImpulseTest, Pulse, impulse_test, pulses};
pub use linear::{MeshInfluence, Preload, linear_modes, mesh_influence, preloaded};
pub use mode::{FeMode, of_type};
