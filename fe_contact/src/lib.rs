#![doc = include_str!("../README.md")]

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

/// The crate whose matrices and vectors stand in signatures.
pub use nalgebra;

pub use error::FeError;
pub use material::Elastic;
