//! Options of harmonic balance.

/// How many harmonics are used and when the iteration ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BalanceOptions {
    /// Harmonics of the first solution.
    pub first_harmonics: usize,
    /// Most harmonics; never more than a quarter of the samples in a cycle.
    pub most_harmonics: usize,
    /// Harmonics are added until the amplitudes of the highest quarter of them (at least two) are below this
    /// share of the largest amplitude, over all deflections.
    pub tail: f64,
    /// The iteration ends when the largest entry of a correction is below this share of the largest deflection.
    pub correction: f64,
    /// Most Newton iterations from one starting point.
    pub most_iterations: usize,
}

impl Default for BalanceOptions {
    fn default() -> Self {
        Self {
            first_harmonics: 8,
            most_harmonics: 1024,
            tail: 1e-6,
            correction: 1e-11,
            most_iterations: 30,
        }
    }
}
