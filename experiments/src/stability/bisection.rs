//! Bisection of a border.

/// A bracket of the border between `low`, which is within, and `high`, which is beyond it, halved until it `is_found`;
/// `None` if the ends are not on either side.
pub(super) fn bisected<E>(
    [mut low, mut high]: [f64; 2],
    middle: impl Fn(f64, f64) -> f64,
    is_found: impl Fn(f64, f64) -> bool,
    is_beyond: impl Fn(f64) -> Result<bool, E>,
) -> Result<Option<[f64; 2]>, E> {
    if is_beyond(low)? || !is_beyond(high)? {
        return Ok(None);
    }
    while !is_found(low, high) {
        let half = middle(low, high);
        if is_beyond(half)? { high = half } else { low = half }
    }
    Ok(Some([low, high]))
}
