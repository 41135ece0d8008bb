//! Labels that keep clear of one another.

use super::canvas::{Anchor, Pixel, text_width};

/// Size of labels beside their points, px.
pub(super) const SIZE: u32 = 9;

/// A text that belongs to a point of a panel.
pub(crate) struct Label {
    pub(crate) point: (f64, f64),
    pub(crate) text: String,
    pub(crate) colour: &'static str,
}

/// Places for labels at least `gap` apart and at most at `high`. Labels that would overlap form a cluster
/// centred on the mean of their wanted places; `wanted` must be ascending.
pub(crate) fn spread(wanted: &[f64], gap: f64, high: f64) -> Vec<f64> {
    // With the gaps subtracted this is isotonic regression: places that decrease are replaced by their mean.
    let mut clusters: Vec<(f64, usize)> = Vec::new();
    for (i, place) in wanted.iter().enumerate() {
        let (mut mean, mut count) = (place - gap * i as f64, 1);
        while let Some((before, many)) = clusters.pop_if(|(before, _)| *before > mean) {
            mean = (mean * count as f64 + before * many as f64) / (count + many) as f64;
            count += many;
        }
        clusters.push((mean, count));
    }
    let limit = high - gap * wanted.len().saturating_sub(1) as f64;
    let all = clusters.into_iter().flat_map(|(mean, count)| std::iter::repeat_n(mean, count));
    all.enumerate().map(|(i, place)| place.min(limit) + gap * i as f64).collect()
}

/// Left, top, right and bottom, px.
pub(super) type Rectangle = [f64; 4];

/// Square about a point.
pub(super) fn around([x, y]: Pixel, half: f64) -> Rectangle {
    [x - half, y - half, x + half, y + half]
}

/// Place and anchor of a label beside a point where it covers nothing `taken`, if there is one within `frame`; the
/// place is then taken too.
pub(super) fn beside(
    frame: Rectangle,
    [x, y]: Pixel,
    text: &str,
    taken: &mut Vec<Rectangle>,
) -> (Pixel, Anchor) {
    const AWAY: f64 = 11.0;
    let width = text_width(text, SIZE);
    for down in [4.0, -8.0, 16.0, -20.0, 28.0, -32.0] {
        for (left, edge, anchor) in
            [(x + AWAY, x + AWAY, Anchor::Start), (x - AWAY - width, x - AWAY, Anchor::End)]
        {
            let b = [left, y + down - f64::from(SIZE), left + width, y + down + 2.0];
            let is_inside =
                b[0] >= frame[0] && b[1] >= frame[1] && b[2] <= frame[2] && b[3] <= frame[3];
            let meets = |t: &Rectangle| b[0] < t[2] && t[0] < b[2] && b[1] < t[3] && t[1] < b[3];
            if is_inside && !taken.iter().any(meets) {
                taken.push(b);
                return ([edge, y + down], anchor);
            }
        }
    }
    ([x + AWAY, y + 4.0], Anchor::Start)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crowded_labels_keep_apart() {
        assert_eq!(spread(&[10.0, 11.0, 40.0], 5.0, 100.0), [8.0, 13.0, 40.0]);
        assert_eq!(spread(&[], 5.0, 100.0), [0.0; 0]);
        assert_eq!(spread(&[97.0, 99.0], 5.0, 100.0), [95.0, 100.0]);
    }
}
