//! Table by table.

mod mesh_cycle;
mod mesh_stiffness;
mod modes;
mod rules;
mod steady_states;
mod torque_peaks;

pub(in crate::results) use mesh_cycle::mesh_cycle;
pub(in crate::results) use mesh_stiffness::mesh_stiffness;
pub(super) use modes::by_scene;
pub(in crate::results) use modes::modes;
pub(in crate::results) use rules::rules;
pub(in crate::results) use steady_states::steady_states;
pub(in crate::results) use torque_peaks::torque_peaks;
