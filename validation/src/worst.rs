//! Reduction of many differences to the one that is judged.

/// The largest magnitude. Not a number, so that whatever is judged by it fails, if there is nothing to reduce
/// or a value is not finite.
///
/// ```
/// use validation::worst;
///
/// assert_eq!(worst([1.0, -3.0, 2.0]), 3.0);
/// assert!(worst([]).is_nan());
/// assert!(worst([1.0, f64::NAN]).is_nan());
/// assert!(worst([1.0, f64::INFINITY]).is_nan());
/// ```
pub fn worst(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut largest = None;
    for value in values {
        if !value.is_finite() {
            return f64::NAN;
        }
        let so_far: f64 = largest.unwrap_or(0.0);
        largest = Some(so_far.max(value.abs()));
    }
    largest.unwrap_or(f64::NAN)
}

/// Largest value less smallest. Not a number if there is nothing to reduce or a value is not finite.
pub fn peak_to_peak(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut ends: Option<(f64, f64)> = None;
    for value in values {
        if !value.is_finite() {
            return f64::NAN;
        }
        let (low, high) = ends.unwrap_or((value, value));
        ends = Some((low.min(value), high.max(value)));
    }
    ends.map_or(f64::NAN, |(low, high)| high - low)
}

/// Pairs of two lists of equal length. If the lengths differ, one pair whose values are not numbers, so that
/// a check on it fails instead of comparing the shorter list.
pub fn paired<'a>(a: &'a [f64], b: &'a [f64]) -> Box<dyn Iterator<Item = (f64, f64)> + 'a> {
    if a.len() == b.len() {
        Box::new(a.iter().copied().zip(b.iter().copied()))
    } else {
        Box::new(std::iter::once((f64::NAN, f64::NAN)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_different_lengths_never_agree() {
        let off = |a: &[f64], b: &[f64]| worst(paired(a, b).map(|(a, b)| a - b));
        assert_eq!(off(&[1.0, 2.0], &[1.0, 2.5]), 0.5);
        assert!(off(&[1.0, 2.0], &[1.0]).is_nan());
        assert!(off(&[], &[]).is_nan());
    }
}
