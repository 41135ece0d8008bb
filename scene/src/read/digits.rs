//! How exact a number is as it is written.

/// Digits from which on a number is taken for a computed one, that is exact.
const MANY_DIGITS: usize = 15;

/// Half a unit of the last digit of a decimal number: 0.05 of `0.1`, 0.00005 of `0.3890`. Whole numbers, zero and
/// numbers of many digits are exact: 0.
pub(crate) fn half_unit(text: &str) -> f64 {
    let text = text.trim().replace('_', "");
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((&text, "0"));
    let Some((_, decimals)) = mantissa.split_once('.') else { return 0.0 };
    let digits = mantissa.chars().filter(char::is_ascii_digit);
    let significant = digits.skip_while(|digit| *digit == '0').count();
    let Ok(exponent) = exponent.parse::<i32>() else { return 0.0 };
    if significant == 0 || significant >= MANY_DIGITS {
        return 0.0;
    }
    0.5 * 10f64.powi(exponent.saturating_sub(decimals.len() as i32))
}

#[cfg(test)]
mod tests {
    use super::half_unit;

    #[test]
    fn half_units_are_those_of_the_last_digit_written() {
        for (text, half) in [
            ("0.1", 0.05),
            ("0.3890", 0.5e-4),
            ("-0.1171", 0.5e-4),
            ("1_000.5", 0.05),
            ("1.25e-2", 0.5e-4),
            ("863", 0.0),
            ("0.0", 0.0),
            ("0x1e", 0.0),
            ("18.13517685825927", 0.0),
        ] {
            assert!((half_unit(text) - half).abs() < 1e-15, "{text}");
        }
    }
}
