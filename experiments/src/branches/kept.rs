//! Finished parts of branches, kept so that an interrupted run is gone on with.

use dynamics::continuation::{BranchPoint as Raw, Direction, KeptStep, Scales, StepStore};
use serde::{Deserialize, Serialize};

use super::branch::Branches;
use super::error::BranchError;
use super::family::PeriodicFamily;
use super::judged_point::point;
use super::point::{BranchPoint, BranchPointKind};
use super::settings::BranchSettings;
use crate::sweep::{Memory, StoreError, SweepError, SweepModel};

/// A finished part of branches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum KeptPart {
    /// The motion found from rest.
    Start {
        /// Its coordinates at the start of a mesh cycle.
        coordinates: Vec<f64>,
        /// Scales of the coordinates in the arc length.
        unknowns: Vec<f64>,
        /// Scale of the parameter.
        parameter: f64,
    },
    /// A step of a branch.
    Step {
        /// What continuation goes on from.
        step: KeptStep,
        /// Its points as results have them.
        points: Vec<BranchPoint>,
    },
    /// Everything that was asked for.
    Whole(Branches),
}

/// Where finished parts go. A part is a step along a branch (with the points located within it), the motion that all
/// begin with, or the whole result: a run that is interrupted loses the step that it was taking.
pub trait BranchStore {
    /// A part that an earlier run finished; `place` is a path of folders, divided by `/`, in which parts have numbers.
    ///
    /// # Errors
    /// If it is there and cannot be read.
    fn load(&self, place: &str, number: usize) -> Result<Option<KeptPart>, StoreError>;

    /// Keeps a part for good.
    ///
    /// # Errors
    /// If it cannot be written.
    fn save(&self, place: &str, number: usize, part: &KeptPart) -> Result<(), StoreError>;
}

impl BranchStore for Memory {
    fn load(&self, _: &str, _: usize) -> Result<Option<KeptPart>, StoreError> {
        Ok(None)
    }

    fn save(&self, _: &str, _: usize, _: &KeptPart) -> Result<(), StoreError> {
        Ok(())
    }
}

/// Place of the whole result.
const WHOLE: &str = "whole";

/// The whole result of an earlier run that came to its end; `None` if there is none.
///
/// # Errors
/// If it is there and cannot be read.
pub fn finished(store: &dyn BranchStore) -> Result<Option<Branches>, SweepError> {
    match store.load(WHOLE, 0)? {
        None => Ok(None),
        Some(KeptPart::Whole(found)) => Ok(Some(found)),
        Some(_) => Err(other_part(WHOLE)),
    }
}

pub(super) fn keep_whole(store: &dyn BranchStore, found: &Branches) -> Result<(), SweepError> {
    Ok(store.save(WHOLE, 0, &KeptPart::Whole(found.clone()))?)
}

/// The motion found from rest with tables of a size: from the store, or from `find` and then kept.
pub(super) fn start(
    store: &dyn BranchStore,
    size: usize,
    find: impl FnOnce() -> Result<(Vec<f64>, Scales), BranchError>,
) -> Result<(Vec<f64>, Scales), BranchError> {
    let place = format!("tables_{size}/start");
    match store.load(&place, 0).map_err(SweepError::from)? {
        Some(KeptPart::Start { coordinates, unknowns, parameter }) => {
            Ok((coordinates, Scales { unknowns, parameter }))
        }
        Some(_) => Err(other_part(&place).into()),
        None => {
            let (coordinates, scales) = find()?;
            let Scales { unknowns, parameter } = scales.clone();
            let own = coordinates.clone();
            let part = KeptPart::Start { coordinates: own, unknowns, parameter };
            store.save(&place, 0, &part).map_err(SweepError::from)?;
            Ok((coordinates, scales))
        }
    }
}

fn other_part(place: &str) -> SweepError {
    StoreError { message: format!("the part kept as {place} is of another kind: remove it") }.into()
}

/// Steps of one branch in a store, and the points of all steps so far.
pub(super) struct Steps<'a> {
    pub(super) store: &'a dyn BranchStore,
    pub(super) model: &'a dyn SweepModel,
    pub(super) settings: &'a BranchSettings,
    pub(super) repeats_after: usize,
    pub(super) size: usize,
    /// Folder of the branch.
    pub(super) place: String,
    /// Points towards lower and towards higher values, in the order in which they were found.
    pub(super) points: [Vec<(BranchPoint, Raw)>; 2],
}

impl Steps<'_> {
    fn place(&self, towards: Direction) -> String {
        format!("tables_{}/{}/{}", self.size, self.place, ["down", "up"][index(towards)])
    }

    fn of(
        &self,
        family: &PeriodicFamily<'_>,
        towards: Direction,
        raw: &Raw,
    ) -> Result<BranchPoint, SweepError> {
        let is_own =
            |known: &&(BranchPoint, Raw)| known.1.y == raw.y && known.1.lambda == raw.lambda;
        if let Some((known, _)) = self.points[index(towards)].iter().rev().find(is_own) {
            // At a kink the point before the turn stands for the fold.
            return Ok(BranchPoint { kind: BranchPointKind::Fold, arc: raw.arc, ..known.clone() });
        }
        let Self { model, settings, repeats_after, size, .. } = *self;
        point(model, &family.judged, raw, settings, repeats_after, size)
    }
}

fn index(towards: Direction) -> usize {
    usize::from(towards == Direction::Up)
}

impl<'m> StepStore<PeriodicFamily<'m>> for Steps<'_> {
    fn load(&mut self, towards: Direction, number: usize) -> Result<Option<KeptStep>, SweepError> {
        let place = self.place(towards);
        match self.store.load(&place, number)? {
            None => Ok(None),
            Some(KeptPart::Step { step, points }) if points.len() == step.points.len() => {
                let all = &mut self.points[index(towards)];
                if number == 0 {
                    all.clear();
                }
                all.extend(points.into_iter().zip(step.points.iter().cloned()));
                Ok(Some(step))
            }
            Some(_) => Err(other_part(&place)),
        }
    }

    fn save(
        &mut self,
        family: &mut PeriodicFamily<'m>,
        towards: Direction,
        number: usize,
        step: &KeptStep,
    ) -> Result<(), SweepError> {
        let points = step.points.iter().map(|raw| self.of(family, towards, raw));
        let points = points.collect::<Result<Vec<_>, _>>()?;
        // Motions judged on the way here are not asked for again.
        family.judged.clear();
        let part = KeptPart::Step { step: step.clone(), points: points.clone() };
        self.store.save(&self.place(towards), number, &part)?;
        self.points[index(towards)].extend(points.into_iter().zip(step.points.iter().cloned()));
        Ok(())
    }
}
