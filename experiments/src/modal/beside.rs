//! Pairing of the modes of one set that were found in two ways.

use lumped::ModeType;

use super::mode::FeMode;

/// Pairs identified modes with linearised ones of their type, one with one: in order if both lists have the same
/// number, otherwise the nearest pairs first. Both lists are ascending.
///
/// Returns indices into both lists, ascending in the identified frequency, or the linearised one of modes
/// that were not identified; every mode occurs once.
pub fn beside(
    identified: &[FeMode],
    linearised: &[&FeMode],
) -> Vec<(Option<usize>, Option<usize>)> {
    let is_as_many = |t: ModeType| {
        let ours = identified.iter().filter(|m| m.mode_type == t).count();
        ours == linearised.iter().filter(|m| m.mode_type == t).count()
    };
    let mut candidates = Vec::new();
    for (i, own) in identified.iter().enumerate() {
        let is_in_order = is_as_many(own.mode_type);
        for (j, other) in linearised.iter().enumerate() {
            if other.mode_type == own.mode_type {
                let off = (other.frequency_hz - own.frequency_hz).abs();
                candidates.push((if is_in_order { 0.0 } else { off }, i, j));
            }
        }
    }
    // Equal distances stay in the order of both lists.
    candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (mut partners, mut is_taken) =
        (vec![None; identified.len()], vec![false; linearised.len()]);
    for (_, i, j) in candidates {
        if partners[i].is_none() && !is_taken[j] {
            (partners[i], is_taken[j]) = (Some(j), true);
        }
    }
    let mut pairs: Vec<_> = partners.iter().enumerate().map(|(i, j)| (Some(i), *j)).collect();
    pairs.extend((0..linearised.len()).filter(|j| !is_taken[*j]).map(|j| (None, Some(j))));
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
        // One pole between two modes that lie 0.03 % apart is the nearer one.
        let theirs = list(&[(300.0, Planet), (300.09, Planet)]);
        let theirs: Vec<&FeMode> = theirs.iter().collect();
        let one = list(&[(300.06, Planet)]);
        assert_eq!(beside(&one, &theirs), [(None, Some(0)), (Some(0), Some(1))]);
        // The nearest pair first: the first pole does not take what the second one is nearer to.
        let three = list(&[(100.0, Planet), (101.0, Planet), (500.0, Planet)]);
        let three: Vec<&FeMode> = three.iter().collect();
        let two = list(&[(100.8, Planet), (101.1, Planet)]);
        let expected = [(Some(0), Some(0)), (Some(1), Some(1)), (None, Some(2))];
        assert_eq!(beside(&two, &three), expected);
        assert_eq!(beside(&[], &theirs[..1]), [(None, Some(0))]);
    }
}
