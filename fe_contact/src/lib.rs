//! Finite-element/contact simulator of planetary gears: meshes, elements, bodies, contact, statics
//! and vibration.

pub mod body;
pub mod complementarity;
pub mod contact;
pub mod element;
mod error;
pub mod export;
pub mod fe_mesh;
mod material;
mod short_row;
pub mod statics;
pub mod vibration;

pub use error::FeError;
pub use material::Elastic;
