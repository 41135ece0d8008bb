//! Suites about the FE/contact model, and suites about mesh cycles and steady states of any model.

pub(crate) mod bodies;
pub(crate) mod calculix;
pub(crate) mod contact_loss;
pub(crate) mod convergence;
pub(crate) mod fidelity;
pub(crate) mod fig12;
pub(crate) mod hertz;
pub(crate) mod iso6336;
pub(crate) mod kinematics;
pub(crate) mod lumped_from_fe;
mod machines;
pub(crate) mod modal;
pub(crate) mod resolved;
pub(crate) mod sets;
pub(crate) mod stepping;
pub(crate) mod stiffness;
pub(crate) mod sweeps;
pub(crate) mod torque;
pub(crate) mod torque_peaks;
pub(crate) mod truth;
