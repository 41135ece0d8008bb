//! The lumped model that results are held against, and the natural frequencies of given matrices.

mod coordinates;
mod spectrum;

pub(super) use coordinates::{CoordinateFault, ReferenceModel};
pub(super) use spectrum::{NoSpectrum, Spectrum};
