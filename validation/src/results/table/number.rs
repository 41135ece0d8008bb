//! Numbers as people and programs write them.

/// The number of a cell, and whether it has a decimal comma; `None` of what is no finite number.
///
/// A comma counts as the decimal point only where `comma` allows it and no point stands beside it: of `1.234,5` nobody
/// can say which of the two separates thousands.
pub(in crate::results) fn number(text: &str, comma: bool) -> Option<(f64, bool)> {
    let has_comma = text.contains(',');
    if has_comma && (!comma || text.contains('.') || text.matches(',').count() > 1) {
        return None;
    }
    let number = text.replace(',', ".").replace(['D', 'd'], "e").parse::<f64>().ok()?;
    number.is_finite().then_some((number, has_comma))
}

/// A whole number; `4.0`, as spreadsheets write counts, is one.
pub(super) fn count(text: &str, comma: bool) -> Option<usize> {
    let (number, _) = number(text, comma)?;
    let is_count = number.fract() == 0.0 && (0.0..1e15).contains(&number);
    is_count.then_some(number as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_commas_and_exponents() {
        assert_eq!(number("770,5", true), Some((770.5, true)));
        assert_eq!(number("-7.5e2", false), Some((-750.0, false)));
        assert_eq!(number("1D3", false), Some((1000.0, false)));
        for refused in ["", "NaN", "inf", "1.234,5", "1,2,3", "0x10", "1 000"] {
            assert_eq!(number(refused, true), None, "{refused}");
        }
        assert_eq!(number("770,5", false), None);
        assert_eq!(
            (count("4.0", false), count("4.5", false), count("-1", false)),
            (Some(4), None, None)
        );
    }
}
