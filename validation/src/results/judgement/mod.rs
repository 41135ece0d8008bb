//! What a results folder can be asked, and the verdict.

mod completed_modes;
mod judge;
mod questions;
mod recorded;

pub use judge::{JudgeError, Judgement};
pub use questions::{AskedSuite, Questions};
