//! Correct digits of a result.

/// Part of the largest value of a quantity below which a value counts as this part: a signal that is nearly zero has
/// no relative error.
const SMALLEST_PART: f64 = 1e-3;

/// Most digits that binary numbers of 64 bits have.
const MOST_DIGITS: f64 = 15.0;

/// `[eq:correct-digits]` Correct digits of `given`: d = −log₁₀(|x − v|/max(|v|, 10⁻³ V)), at least 0 and at most what
/// the uncertainty U leaves, −log₁₀(U/max(|v|, 10⁻³ V)). V is the largest magnitude of the quantity in its scene.
///
/// Source: the scale of a relative error after McCullough (1998), with an absolute floor.
/// Checked by: `validation/src/certified/score.rs::digits_are_counted_up_to_what_is_certain`.
///
/// ```
/// use validation::certified::correct_digits;
///
/// let digits = correct_digits(1000.1, 1000.0, 1e-9, 2000.0);
/// assert!((digits - 4.0).abs() < 1e-9);
/// ```
pub fn correct_digits(given: f64, value: f64, uncertainty: f64, largest: f64) -> f64 {
    let scale = value.abs().max(SMALLEST_PART * largest.abs());
    let digits = |difference: f64| match scale > 0.0 {
        true => -(difference.abs() / scale).log10(),
        false if difference == 0.0 => MOST_DIGITS,
        false => 0.0,
    };
    let certain = digits(uncertainty).min(MOST_DIGITS);
    let found = digits(given - value);
    // A number that is none has no correct digit.
    if found.is_nan() { 0.0 } else { found.clamp(0.0, certain.max(0.0)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_counted_up_to_what_is_certain() {
        assert_eq!(correct_digits(1.01, 1.0, 1e-9, 1.0).round(), 2.0);
        assert_eq!(correct_digits(1.0, 1.0, 1e-9, 1.0), 9.0);
        assert_eq!(correct_digits(1.0, 1.0, 0.0, 1.0), 15.0);
        assert_eq!(correct_digits(2.0, 1.0, 1e-9, 1.0), 0.0);
        assert_eq!(correct_digits(1.0 + 1e-12, 1.0, 1e-9, 1.0), 9.0);
    }

    #[test]
    fn a_value_near_zero_is_held_against_the_scale_of_its_quantity() {
        // 1e-5 Hz of rigid-body motion in a set with modes up to 2000 Hz.
        assert!((correct_digits(1e-5, 0.0, 1e-9, 2000.0) - 5.3).abs() < 0.01);
        assert_eq!(correct_digits(0.0, 0.0, 0.0, 0.0), 15.0);
        assert_eq!(correct_digits(1.0, 0.0, 0.0, 0.0), 0.0);
    }

    #[test]
    fn what_is_no_number_has_no_digit() {
        for given in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(correct_digits(given, 1.0, 1e-9, 1.0), 0.0);
        }
    }
}
