//! The statements of section 4.2 of Parker, Agashe & Vijayakar (2000) on growth with torque, one by one.

use lumped::ModeType;

use experiments::torque::Followed;

/// A statement with the number of comparisons in which it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// `monotonic`, `rotation_above_translation`, `third_below_rotation`.
    pub name: &'static str,
    /// In words.
    pub words: &'static str,
    /// Comparisons that the statement is about.
    pub asked: usize,
    /// Of them, those that hold.
    pub holding: usize,
}

impl Statement {
    /// Whether it holds without exception.
    pub fn holds(&self) -> bool {
        self.asked == self.holding
    }
}

/// Judges followed peaks: of the sun, or of planet 0. Heights are normalised at the first torque and
/// harmonics compared in order: the first of one mode with the first of the other.
pub fn judge(followed: &[Followed], is_sun: bool) -> Vec<Statement> {
    let heights = |f: &Followed| Followed::growth(if is_sun { &f.sun } else { &f.planet });
    let of = |kind: ModeType, is_lowest: bool| -> Vec<Vec<f64>> {
        let own = followed.iter();
        own.filter(|f| f.series.mode_type == kind && f.series.is_lowest == is_lowest)
            .map(heights)
            .collect()
    };
    let (rotational, first) = (of(ModeType::Rotational, true), of(ModeType::Translational, true));
    let third = of(ModeType::Translational, false);
    let steps = followed
        .iter()
        .map(heights)
        .flat_map(|h| h.windows(2).map(|w| w[1] > w[0]).collect::<Vec<bool>>());
    let above = |low: &[Vec<f64>]| -> Vec<bool> {
        let pairs = rotational.iter().zip(low);
        pairs.flat_map(|(r, t)| r.iter().zip(t).skip(1).map(|(r, t)| r > t)).collect()
    };
    let statement = |name, words, list: Vec<bool>| Statement {
        name,
        words,
        asked: list.len(),
        holding: list.iter().filter(|x| **x).count(),
    };
    vec![
        statement("monotonic", "peaks grow from torque to torque", steps.collect()),
        statement(
            "rotation_above_translation",
            "the lowest rotational mode's peaks (even harmonics) grow above the lowest translational mode's (odd harmonics)",
            above(&first),
        ),
        statement(
            "third_below_rotation",
            "the third translational mode's peaks grow less than the lowest rotational mode's",
            above(&third),
        ),
    ]
}
