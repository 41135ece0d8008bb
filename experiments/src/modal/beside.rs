//! Pairing of the modes of one set that were found in two ways.

use lumped::ModeType;

use super::mode::FeMode;

/// Pairs identified modes with linearised ones: within a type in order if both lists have the same number,
/// otherwise each identified mode with the nearest linearised one not yet paired. Both lists are ascending.
///
/// Returns indices into both lists, ascending in the identified frequency, or the linearised one of modes
/// that were not identified; every mode occurs once.
pub fn beside(
    identified: &[FeMode],
    linearised: &[&FeMode],
) -> Vec<(Option<usize>, Option<usize>)> {
    let mut left: Vec<usize> = (0..linearised.len()).collect();
    let is_as_many = |t: ModeType| {
        let ours = identified.iter().filter(|m| m.mode_type == t).count();
        ours == linearised.iter().filter(|m| m.mode_type == t).count()
    };
    let mut pairs = Vec::new();
    for (i, mode) in identified.iter().enumerate() {
        let off = |j: usize| (linearised[left[j]].frequency_hz - mode.frequency_hz).abs();
        let mut own = (0..left.len()).filter(|j| linearised[left[*j]].mode_type == mode.mode_type);
        let other = match is_as_many(mode.mode_type) {
            true => own.next(),
            false => own.min_by(|a, b| off(*a).total_cmp(&off(*b))),
        };
        pairs.push((Some(i), other.map(|j| left.remove(j))));
    }
    pairs.extend(left.into_iter().map(|j| (None, Some(j))));
    let frequency = |(i, j): &(Option<usize>, Option<usize>)| {
        let own = i.map(|i| &identified[i]).or(j.map(|j| linearised[j]));
        own.map_or(0.0, |m| m.frequency_hz)
    };
    pairs.sort_by(|a, b| frequency(a).total_cmp(&frequency(b)));
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(frequency_hz: f64, mode_type: ModeType) -> FeMode {
        FeMode { frequency_hz, damping_ratio: 0.0, mode_type, shares: [0.0; 3], shape: Vec::new() }
    }

    #[test]
    fn as_many_go_by_order_and_others_to_the_nearest() {
        use ModeType::{Planet, Rotational};
        let list = |all: &[(f64, ModeType)]| -> Vec<FeMode> {
            all.iter().map(|(f, t)| mode(*f, *t)).collect()
        };
        let ours = list(&[(100.0, Rotational), (205.0, Rotational), (300.0, Planet)]);
        let theirs =
            list(&[(190.0, Rotational), (210.0, Rotational), (250.0, Planet), (299.0, Planet)]);
        let theirs: Vec<&FeMode> = theirs.iter().collect();
        let expected =
            [(Some(0), Some(0)), (Some(1), Some(1)), (None, Some(2)), (Some(2), Some(3))];
        assert_eq!(beside(&ours, &theirs), expected);
        assert_eq!(beside(&ours[..1], &[]), [(Some(0), None)]);
        assert_eq!(beside(&[], &theirs[..1]), [(None, Some(0))]);
    }
}
