//! Finite-element/contact simulator of planetary gears: meshes, elements, bodies, contact.

pub mod body;
pub mod complementarity;
pub mod contact;
pub mod element;
mod error;
pub mod export;
mod material;
pub mod mesh;
mod short_row;
pub mod statics;
pub mod vibration;

pub use error::FeError;
pub use material::Elastic;
