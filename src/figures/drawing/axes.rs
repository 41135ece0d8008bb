//! Scales and pairs of axes.

use super::canvas::{Anchor, Canvas, Pen, Pixel, Type};

const FRAME: Pen = Pen::new("#333333", 1.0);
const GRID: Pen = Pen::new("#e6e8ea", 0.8);

/// Text style of tick labels.
pub(crate) const TICK_TEXT: Type = Type::new(11, Anchor::Middle);

/// Values from one end of an axis to the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    low: f64,
    high: f64,
    is_log: bool,
}

impl Scale {
    /// Linear between two ends.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        Self { low, high, is_log: false }
    }

    /// Logarithmic, a little beyond positive values.
    pub(crate) fn log(values: impl Iterator<Item = f64>) -> Self {
        let positive = values.filter(|v| *v > 0.0 && v.is_finite());
        let (low, high) = positive.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
        let (low, high) = if low <= high { (low, high) } else { (0.1, 10.0) };
        let margin = (high / low).powf(0.06).max(1.3);
        Self { low: low / margin, high: high * margin, is_log: true }
    }

    pub(crate) fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// 0 at the low end, 1 at the high end.
    pub(crate) fn share(&self, value: f64) -> f64 {
        if self.is_log {
            let value = value.max(self.low);
            return (value / self.low).ln() / (self.high / self.low).ln();
        }
        (value - self.low) / (self.high - self.low)
    }

    /// About so many round values with their labels.
    pub(crate) fn ticks(&self, about: usize) -> Vec<(f64, String)> {
        if self.is_log {
            return self.log_ticks();
        }
        let rough = (self.high - self.low) / about.max(1) as f64;
        let decade = 10f64.powf(rough.log10().floor());
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * decade >= 0.999 * rough);
        let step = factor.unwrap_or(10.0) * decade;
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let from = (self.low / step - 1e-9).ceil() as i64;
        let to = (self.high / step + 1e-9).floor() as i64;
        let value = |i: i64| i as f64 * step;
        (from..=to).map(|i| (value(i), format!("{:.decimals$}", value(i)))).collect()
    }

    /// Decades; fives and twos between them where decades are few.
    fn log_ticks(&self) -> Vec<(f64, String)> {
        let decades = (self.high / self.low).log10();
        let factors: &[f64] = if decades < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (from, to) = (self.low.log10().floor() as i32, self.high.log10().floor() as i32);
        // All labels of an axis in one form: plain numbers, or powers where one needs them.
        let is_plain = from >= -3 && to <= 4;
        let values = (from..=to).flat_map(|k| {
            let label = move |f: &f64| (!is_plain).then(|| format!("{f}e{k}"));
            factors.iter().map(move |f| (f * 10f64.powi(k), label(f)))
        });
        let short = |v: f64| {
            let text = format!("{v:.3}");
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        };
        values
            .filter(|(v, _)| self.contains(*v))
            .map(|(v, label)| (v, label.unwrap_or_else(|| short(v))))
            .collect()
    }
}

/// A framed rectangle with two scales.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Axes {
    pub(crate) x: Scale,
    pub(crate) y: Scale,
    /// Upper left corner, px.
    pub(crate) corner: Pixel,
    /// Width and height, px.
    pub(crate) size: [f64; 2],
}

impl Axes {
    pub(crate) fn left(&self) -> f64 {
        self.corner[0]
    }

    pub(crate) fn top(&self) -> f64 {
        self.corner[1]
    }

    pub(crate) fn right(&self) -> f64 {
        self.corner[0] + self.size[0]
    }

    pub(crate) fn bottom(&self) -> f64 {
        self.corner[1] + self.size[1]
    }

    /// Where a value pair lies.
    pub(crate) fn at(&self, (x, y): (f64, f64)) -> Pixel {
        let [width, height] = self.size;
        [self.left() + width * self.x.share(x), self.bottom() - height * self.y.share(y)]
    }

    /// Grid, frame, tick labels.
    pub(crate) fn frame(&self, canvas: &mut Canvas, about: [usize; 2]) {
        for (value, label) in self.x.ticks(about[0]) {
            let [x, _] = self.at((value, self.y.low));
            canvas.line([[x, self.top()], [x, self.bottom()]], GRID);
            canvas.text([x, self.bottom() + 16.0], TICK_TEXT, label);
        }
        for (value, label) in self.y.ticks(about[1]) {
            let [_, y] = self.at((self.x.low, value));
            canvas.line([[self.left(), y], [self.right(), y]], GRID);
            canvas.text([self.left() - 6.0, y + 4.0], Type::new(11, Anchor::End), label);
        }
        let (left, top, right, bottom) = (self.left(), self.top(), self.right(), self.bottom());
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom], [left, top]];
        canvas.line(corners, FRAME);
    }

    /// Label below.
    pub(crate) fn x_label(&self, canvas: &mut Canvas, label: &str) {
        let middle = 0.5 * (self.left() + self.right());
        canvas.text([middle, self.bottom() + 36.0], Type::new(13, Anchor::Middle), label);
    }

    /// Label to the left, upwards.
    pub(crate) fn y_label(&self, canvas: &mut Canvas, label: &str) {
        let middle = 0.5 * (self.top() + self.bottom());
        let kind = Type::new(13, Anchor::Middle).turned(-90.0);
        canvas.text([self.left() - 52.0, middle], kind, label);
    }

    /// Title above.
    pub(crate) fn title(&self, canvas: &mut Canvas, title: &str) {
        let middle = 0.5 * (self.left() + self.right());
        canvas.text([middle, self.top() - 10.0], Type::new(14, Anchor::Middle), title);
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let labels = |scale: Scale| -> Vec<String> {
            scale.ticks(5).into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels(Scale::linear(0.0, 880.0)), ["0", "200", "400", "600", "800"]);
        assert_eq!(
            labels(Scale::linear(0.0, 0.023)),
            ["0.000", "0.005", "0.010", "0.015", "0.020"]
        );
    }

    /// Powers of ten beside plain numbers (`1e-3`, `0.01`, `1`) would be read as different axes.
    #[test]
    fn labels_of_a_logarithmic_axis_have_one_form() {
        let labels = |values: [f64; 2]| -> Vec<String> {
            Scale::log(values.into_iter()).ticks(5).into_iter().map(|(_, label)| label).collect()
        };
        assert_eq!(labels([0.02, 30.0]), ["0.1", "1", "10"]);
        assert_eq!(labels([0.5, 3.0]), ["0.5", "1", "2"]);
        for values in [[1e-5, 1.0], [3e-2, 4e7], [1.0, 2e5]] {
            let powers = labels(values);
            assert!(powers.len() > 1 && powers.iter().all(|l| l.contains('e')), "{powers:?}");
        }
        for values in [[1e-2, 1.0], [1.0, 3000.0], [0.3, 2.0]] {
            let plain = labels(values);
            assert!(plain.len() > 1 && plain.iter().all(|l| !l.contains('e')), "{plain:?}");
        }
    }

    #[test]
    fn crowded_labels_keep_apart() {
        assert_eq!(spread(&[10.0, 11.0, 40.0], 5.0, 100.0), [8.0, 13.0, 40.0]);
        assert_eq!(spread(&[], 5.0, 100.0), [0.0; 0]);
        assert_eq!(spread(&[97.0, 99.0], 5.0, 100.0), [95.0, 100.0]);
    }
}
