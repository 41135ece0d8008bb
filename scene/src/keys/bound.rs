//! What a number in a scene may be.

/// Limits of a number; every number is finite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    /// Greater than zero.
    Positive,
    /// Zero or greater.
    NonNegative,
    /// Any finite number.
    Finite,
    /// Strictly between the two.
    Between(f64, f64),
}

impl Bound {
    pub(crate) fn admits(self, x: f64) -> bool {
        x.is_finite()
            && match self {
                Self::Positive => x > 0.0,
                Self::NonNegative => x >= 0.0,
                Self::Finite => true,
                Self::Between(low, high) => x > low && x < high,
            }
    }

    /// The limits in words.
    pub fn words(self) -> String {
        match self {
            Self::Positive => "a finite number above 0".into(),
            Self::NonNegative => "a finite number, 0 or above".into(),
            Self::Finite => "a finite number".into(),
            Self::Between(low, high) => format!("a number between {low} and {high}"),
        }
    }
}
