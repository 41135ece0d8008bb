//! A model of your own under the checks: implement the trait for the question that it answers, and read the verdict.
//!
//! `cargo run --release --example judge_model`; `examples/your_model` is a whole model in a crate of its own.

use std::error::Error;

use epicyclic::experiments::{ModalModel, ModelError, NaturalMode, models::Lumped};
use epicyclic::gearset::{LoadCase, Scene};
use epicyclic::validation::{Models, judge_model};

/// The lumped model of this project with frequencies that are too high, in place of yours.
struct TooStiff {
    factor: f64,
}

impl ModalModel for TooStiff {
    fn natural_modes(&self, set: &Scene, case: &LoadCase) -> Result<Vec<NaturalMode>, ModelError> {
        let mut modes = Lumped::default().natural_modes(set, case)?;
        modes.iter_mut().for_each(|mode| mode.frequency_hz *= self.factor);
        Ok(modes)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    for factor in [1.0, 1.01] {
        let model = TooStiff { factor };
        let models = Models { modal: Some(&model), ..Models::default() };
        let verdict = judge_model(&models, "table3.lumped")?;
        println!(
            "frequencies times {factor}: {} passed, {} failed",
            verdict.passed, verdict.failed
        );
    }
    Ok(())
}
