//! The modes that Tables 2 and 3 list, out of all that a model has.

use experiments::NaturalMode;
use lumped::ModeType;

use crate::mode_type::type_named;
use crate::reference::ModeTable;

/// One row of a table as a model gives it.
#[derive(Debug, Clone, PartialEq)]
pub struct TabledFrequency {
    /// Its frequency, that of a pair by the mean, Hz; not a number where the model has no such mode.
    pub mean_hz: f64,
    /// Both of a pair, lower first, or the one, Hz.
    pub members_hz: Vec<f64>,
}

impl TabledFrequency {
    /// Upper less lower of a pair, in percent of their mean.
    pub fn split_percent(&self) -> f64 {
        match self.members_hz[..] {
            [low, high] => 100.0 * (high - low) / self.mean_hz,
            _ => 0.0,
        }
    }
}

/// The rows of a table: the k-th frequency of the row's type, translational ones by pairs.
pub fn tabled(table: &ModeTable, modes: &[NaturalMode]) -> Vec<TabledFrequency> {
    let rows = table.mode_type.iter().enumerate();
    rows.map(|(row, name)| {
        let earlier = table.mode_type[..row].iter().filter(|s| *s == name).count();
        let mode_type = type_named(name);
        let mut own: Vec<f64> =
            modes.iter().filter(|m| m.mode_type == mode_type).map(|m| m.frequency_hz).collect();
        own.sort_by(f64::total_cmp);
        let width = if mode_type == ModeType::Translational { 2 } else { 1 };
        let members_hz = own.chunks_exact(width).nth(earlier).unwrap_or_default().to_vec();
        let mean_hz = members_hz.iter().sum::<f64>() / members_hz.len() as f64;
        TabledFrequency { mean_hz, members_hz }
    })
    .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_take_the_next_of_their_type_and_pairs_their_mean() {
        let table = ModeTable {
            mode_type: ["translational", "planet", "translational", "rotational"]
                .map(String::from)
                .to_vec(),
            lumped_hz: Vec::new(),
            fe_contact_hz: Vec::new(),
        };
        let of = |mode_type, frequency_hz| NaturalMode { mode_type, frequency_hz };
        let modes = [
            of(ModeType::Translational, 99.0),
            of(ModeType::Translational, 101.0),
            of(ModeType::Planet, 150.0),
            of(ModeType::Translational, 210.0),
            of(ModeType::Translational, 200.0),
        ];
        let rows = tabled(&table, &modes);
        let means: Vec<f64> = rows.iter().map(|r| r.mean_hz).collect();
        assert_eq!(means[..3], [100.0, 150.0, 205.0]);
        assert!(means[3].is_nan());
        assert_eq!(rows[0].split_percent(), 2.0);
        assert_eq!(rows[2].members_hz, [200.0, 210.0]);
    }
}
