//! Natural frequencies with which resonant peaks are compared.

use fe_contact::statics::Bodies;
use scene::{LoadCase, Scene};

use crate::modal::{FeMode, ModalError, Preload, linear_modes, preloaded};
use crate::natural_mode::NaturalMode;

/// Natural frequencies of the FE/contact set linearised at position 0 under the torque of a load case.
///
/// # Errors
/// If the set has no equilibrium, or an eigenproblem fails.
pub fn naturals(
    scene: &Scene,
    bodies: &Bodies,
    case: LoadCase,
) -> Result<Vec<NaturalMode>, ModalError> {
    let preload = Preload { load: case, position: 0.0, step_s: 5e-6 };
    let set = preloaded(scene, bodies, &preload)?;
    let modes = linear_modes(&set, &set.linearised()?)?;
    let of = |m: &FeMode| NaturalMode { frequency_hz: m.frequency_hz, mode_type: m.mode_type };
    Ok(modes.iter().map(of).collect())
}
