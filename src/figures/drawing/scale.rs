//! Scales of axes and their ticks.

/// Values from one end of an axis to the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scale {
    pub(super) low: f64,
    high: f64,
    is_log: bool,
}

impl Scale {
    /// Linear between two ends.
    pub(crate) fn linear(low: f64, high: f64) -> Self {
        let high = if high > low { high } else { low + 1.0 };
        Self { low, high, is_log: false }
    }

    /// Linear over all finite values and a little beyond, except beyond 0.
    pub(super) fn around(values: impl Iterator<Item = f64>) -> Self {
        let (low, high) = ends(values.filter(|v| v.is_finite())).unwrap_or((0.0, 1.0));
        let room = if high > low { 0.04 * (high - low) } else { f64::max(0.5 * low.abs(), 1e-9) };
        let beyond = |end: f64, room: f64| if end == 0.0 { end } else { end + room };
        Self::linear(beyond(low, -room), beyond(high, room))
    }

    /// Logarithmic, a little beyond positive values.
    pub(super) fn log(values: impl Iterator<Item = f64>) -> Self {
        let positive = values.filter(|v| *v > 0.0 && v.is_finite());
        let (low, high) = ends(positive).unwrap_or((0.1, 10.0));
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

    /// A round step between about so many ticks.
    fn step(&self, about: f64) -> f64 {
        let rough = (self.high - self.low) / about.max(1.0);
        let decade = 10f64.powf(rough.log10().floor());
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * decade >= 0.999 * rough);
        factor.unwrap_or(10.0) * decade
    }

    /// About so many round values with their labels.
    pub(crate) fn ticks(&self, about: f64) -> Vec<(f64, String)> {
        if self.is_log {
            return self.log_ticks();
        }
        let step = self.step(about);
        let power = step.log10().floor();
        let from = (self.low / step - 1e-9).ceil() as i64;
        let to = (self.high / step + 1e-9).floor() as i64;
        let is_plain = power >= -4.0 && self.low.abs().max(self.high.abs()) < 1e6;
        let label = |v: f64| match v == 0.0 || is_plain {
            true => format!("{v:.*}", if is_plain { (-power).max(0.0) as usize } else { 0 }),
            false => format!("{v:.*e}", (v.abs().log10().floor() - power).max(0.0) as usize),
        };
        (from..=to).map(|i| i as f64 * step).map(|v| (v, label(v))).collect()
    }

    /// Decades, of many every second or third; fives and twos between them where decades are few.
    fn log_ticks(&self) -> Vec<(f64, String)> {
        let decades = (self.high / self.low).log10();
        let factors: &[f64] = if decades < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let (from, to) = (self.low.log10().floor() as i32, self.high.log10().floor() as i32);
        // All labels of an axis in one form: plain numbers, or powers where one needs them.
        let is_plain = from >= -3 && to <= 4;
        let every = (decades / 10.0).ceil().max(1.0) as usize;
        let values = (from..=to).step_by(every).flat_map(|k| factors.iter().map(move |f| (*f, k)));
        let label = |(factor, k): (f64, i32)| {
            let value = factor * 10f64.powi(k);
            let plain = format!("{value:.3}");
            let plain = plain.trim_end_matches('0').trim_end_matches('.').to_owned();
            (value, if is_plain { plain } else { format!("{factor}e{k}") })
        };
        values.map(label).filter(|(v, _)| self.contains(*v)).collect()
    }
}

/// The smallest and the largest value.
fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.map(|v| (v, v)).reduce(|(a, b), (v, _)| (a.min(v), b.max(v)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(scale: Scale) -> Vec<String> {
        scale.ticks(5.0).into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels(Scale::linear(0.0, 880.0)), ["0", "200", "400", "600", "800"]);
        let small = ["0.000", "0.005", "0.010", "0.015", "0.020"];
        assert_eq!(labels(Scale::linear(0.0, 0.023)), small);
        let large = ["0", "5e6", "1.0e7", "1.5e7"];
        assert_eq!(labels(Scale::linear(0.0, 1.7e7)), large);
    }

    #[test]
    fn scales_around_values_leave_room_at_every_end_but_zero() {
        let found = |values: &[f64]| labels(Scale::around(values.iter().copied()));
        assert_eq!(found(&[0.0, 0.9, f64::NAN]), ["0.0", "0.2", "0.4", "0.6", "0.8"]);
        let scale = Scale::around([2.0, 3.0].into_iter());
        assert!(scale.low < 2.0 && scale.high > 3.0 && scale.share(2.5) == 0.5);
        for equal in [&[][..], &[0.0], &[2.0], &[-3.0]] {
            assert!(found(equal).len() > 1, "{equal:?}");
        }
    }

    /// Powers of ten beside plain numbers (`1e-3`, `0.01`, `1`) would be read as different axes.
    #[test]
    fn labels_of_a_logarithmic_axis_have_one_form() {
        let labels = |values: [f64; 2]| labels(Scale::log(values.into_iter()));
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
}
