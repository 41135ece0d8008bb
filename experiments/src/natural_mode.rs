//! Natural frequencies with their kinds, of any model.

use lumped::ModeType;

/// A natural frequency with its kind; one that occurs twice is listed twice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NaturalMode {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Kind.
    pub mode_type: ModeType,
}

/// A frequency with its multiplicity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistinctMode {
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Kind.
    pub mode_type: ModeType,
    /// How many modes of this kind have it.
    pub multiplicity: usize,
}

/// Frequencies of one kind count as equal within this relative difference, or within this difference in Hz.
const SAME: (f64, f64) = (1e-8, 1e-5);

/// Modes by ascending frequency; those of equal kind and frequency are one entry.
pub fn distinct(modes: &[NaturalMode]) -> Vec<DistinctMode> {
    let mut sorted = modes.to_vec();
    sorted.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    let mut list: Vec<DistinctMode> = Vec::new();
    for NaturalMode { frequency_hz, mode_type } in sorted {
        let is_same = |d: &&mut DistinctMode| {
            let near = (frequency_hz - d.frequency_hz).abs();
            d.mode_type == mode_type && near <= (SAME.0 * frequency_hz).max(SAME.1)
        };
        match list.iter_mut().rev().find(is_same) {
            Some(known) => known.multiplicity += 1,
            None => list.push(DistinctMode { frequency_hz, mode_type, multiplicity: 1 }),
        }
    }
    list
}

/// Distinct frequencies of one kind, ascending, Hz.
pub fn frequencies_of(modes: &[NaturalMode], mode_type: ModeType) -> Vec<f64> {
    let own = distinct(modes).into_iter().filter(|d| d.mode_type == mode_type);
    own.map(|d| d.frequency_hz).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_of_one_kind_and_frequency_are_taken_together() {
        let of = |frequency_hz, mode_type| NaturalMode { frequency_hz, mode_type };
        use ModeType::{Planet, Rotational, Translational};
        let list = distinct(&[
            of(500.0, Translational),
            of(300.0, Planet),
            of(500.0 + 1e-6, Translational),
            of(500.0, Rotational),
            of(501.0, Translational),
        ]);
        let found: Vec<_> = list.iter().map(|d| (d.mode_type, d.multiplicity)).collect();
        assert_eq!(found, [(Planet, 1), (Translational, 2), (Rotational, 1), (Translational, 1)]);
    }
}
