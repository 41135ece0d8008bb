//! Frequencies that all agree with the lumped model after one factor.

use std::f64::consts::TAU;

/// Largest difference after the factor, and of the agreement that makes a factor needless.
const TOLERANCE: f64 = 0.02;

/// Fewest frequencies that a factor can be read from, if the model has as many different ones.
const FEWEST: usize = 5;

/// Factors, and what was probably written.
const FACTORS: [(f64, &str, &str); 6] = [
    (1e3, "1000", "kHz?"),
    (1e-3, "1/1000", "mHz?"),
    (TAU, "2π", "divided by 2π twice?"),
    (1.0 / TAU, "1/2π", "rad/s?"),
    (60.0, "60", "divided by 60?"),
    (1.0 / 60.0, "1/60", "per minute?"),
];

/// The factor after which every listed frequency above 0 is one of the model, in words; `None` if there is none, or
/// none is needed.
pub(super) fn factor(listed_hz: &[f64], model_hz: &[f64]) -> Option<(&'static str, &'static str)> {
    let mut different: Vec<f64> = model_hz.iter().copied().filter(|hz| *hz > 0.0).collect();
    different.dedup_by(|a, b| (*a - *b).abs() <= TOLERANCE * *b);
    if listed_hz.len() < FEWEST.min(different.len()).max(2) {
        return None;
    }
    let agree = |factor: f64| {
        let mut free = model_hz.to_vec();
        listed_hz.iter().all(|listed| {
            let hz = listed * factor;
            let near = free.iter().position(|model| (model - hz).abs() <= TOLERANCE * model);
            near.map(|k| free.remove(k)).is_some()
        })
    };
    if agree(1.0) {
        return None;
    }
    FACTORS.into_iter().find(|(by, ..)| agree(*by)).map(|(_, by, guess)| (by, guess))
}
