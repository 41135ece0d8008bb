//! A group of modes of equal frequency while its set is changed more and more: how pure its type stays.

use lumped::{ModeGroup, ModeType, NaturalModes};

use super::bisection::bisected;
use super::map::MapError;

/// The group as it was, the theory of its border, and the modes of the set that is changed by some amount.
pub(super) struct ChangedGroup<M> {
    pub(super) frequency_hz: f64,
    pub(super) mode_type: ModeType,
    pub(super) multiplicity: usize,
    /// The amount from which on, by theory, a mode is listed as mixed.
    pub(super) pure_up_to: f64,
    pub(super) modes: M,
}

impl<M: Fn(f64) -> Result<NaturalModes, MapError>> ChangedGroup<M> {
    /// The modes nearest the group's frequency, as many as it had: share outside the type, and type.
    fn nearest(&self, by: f64) -> Result<Vec<(f64, ModeType)>, MapError> {
        let found = (self.modes)(by)?;
        let share = |g: &ModeGroup| match self.mode_type {
            ModeType::Rotational => g.participation.rotational,
            ModeType::Translational => g.participation.translational,
            _ => g.participation.planet,
        };
        let each = |g: &ModeGroup| {
            let own = (g.frequency_hz, 1.0 - share(g), g.mode_type);
            std::iter::repeat_n(own, g.multiplicity).collect::<Vec<_>>()
        };
        let mut all: Vec<_> = found.groups.iter().flat_map(each).collect();
        let off = |f: f64| (f - self.frequency_hz).abs();
        all.sort_by(|a, b| off(a.0).total_cmp(&off(b.0)));
        let own = all.into_iter().take(self.multiplicity);
        Ok(own.map(|(_, lost, kind)| (lost, kind)).collect())
    }

    /// Largest share outside the type.
    pub(super) fn lost(&self, by: f64) -> Result<f64, MapError> {
        Ok(self.nearest(by)?.iter().fold(0.0f64, |a, (lost, _)| a.max(*lost)))
    }

    /// The amount from which on the program lists a mode of the group as another type; `None` if not within a factor of
    /// four of theory.
    pub(super) fn border(&self) -> Result<Option<f64>, MapError> {
        let is_mixed = |by: f64| -> Result<bool, MapError> {
            Ok(self.nearest(by)?.iter().any(|(_, kind)| *kind != self.mode_type))
        };
        let (bounds, middle) = ([0.25, 4.0].map(|part| part * self.pure_up_to), f64::midpoint);
        let is_found = |low: f64, high: f64| high - low <= 1e-5 * high;
        Ok(bisected(bounds, middle, is_found, is_mixed)?.map(|[low, _]| low))
    }
}
