//! Loads of a scene: its operating point, the way of its torque, and sizes estimated without finite elements.

pub(crate) mod case;
pub(crate) mod estimates;
pub(crate) mod size;
pub(crate) mod torque_path;
