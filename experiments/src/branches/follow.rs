//! Follows branches of periodic motions over speed, torque, damping or a number of the scene.

use dynamics::continuation::{
    self, ContinuationError, ContinuationOptions, End, Scales, branch_off, trace_both,
};

use super::branch::{Branch, BranchEnd, BranchOrigin, Branches, NotFollowed};
use super::direction::critical_direction;
use super::error::BranchError;
use super::family::PeriodicFamily;
use super::first::{first, no_start};
use super::judged_point::drop_doubles;
use super::kept::{self, BranchStore, Steps};
use super::parameter::BranchParameter;
use super::point::{BranchPoint, BranchPointKind};
use super::search::Search;
use super::settings::BranchSettings;
use crate::sweep::{Memory, SweepError, SweepModel};
use crate::table_growth::{Outgrown, large_enough};

/// A branch with its points as continuation has them.
type Followed = (Branch, Vec<continuation::BranchPoint>);

/// The branch of periodic motions through the one found from rest at the first value, both ways.
///
/// Held fixed along it is whatever of speed, torque and damping is not varied, and what the model computed under the
/// torque of its own [`case`](SweepModel::case): the loaded configuration about which the set is linearised and its
/// contact tables, or the law of its meshes.
///
/// # Errors
/// [`BranchError`](super::BranchError) if the settings are out of range, the model has no derivative, or no periodic
/// motion is found to begin with; other errors if the set cannot be built. Whatever happens later ends the branch and
/// stands in [`Branch::ends`].
pub fn branch(model: &dyn SweepModel, settings: &BranchSettings) -> Result<Branch, BranchError> {
    settings.check()?;
    model.prepare()?;
    large_enough(|size| Ok(Follower::new(model, settings, size, &Memory)?.trunk()?.0))
}

/// The same with the branches that leave it at its period doublings and branch points. Those that leave these are not
/// followed.
///
/// # Errors
/// As [`branch`].
pub fn branches(
    model: &dyn SweepModel,
    settings: &BranchSettings,
) -> Result<Branches, BranchError> {
    branches_kept(model, settings, &Search { switch: true }, &Memory)
}

/// The branches asked for, with every finished step kept in `store` and none taken again that is there: it must be that
/// of the same model, settings and search. A run that was interrupted and gone on with has the result of one that was
/// not, to the last bit. Complete, the result itself is kept: [`finished`](super::finished) has it without a model.
///
/// # Errors
/// As [`branch`], or if the store fails.
pub fn branches_kept(
    model: &dyn SweepModel,
    settings: &BranchSettings,
    search: &Search,
    store: &dyn BranchStore,
) -> Result<Branches, BranchError> {
    settings.check()?;
    model.prepare()?;
    let found = large_enough(|size| Follower::new(model, settings, size, store)?.all(search))?;
    kept::keep_whole(store, &found)?;
    Ok(found)
}

/// A model and how its branches are followed.
struct Follower<'a> {
    model: &'a dyn SweepModel,
    settings: &'a BranchSettings,
    /// As in [`SweepModel::turning`].
    size: usize,
    store: &'a dyn BranchStore,
    start: Vec<f64>,
    scales: Scales,
    options: ContinuationOptions,
}

impl<'a> Follower<'a> {
    fn new(
        model: &'a dyn SweepModel,
        settings: &'a BranchSettings,
        size: usize,
        store: &'a dyn BranchStore,
    ) -> Result<Self, BranchError> {
        let (start, scales) = kept::start(store, size, || first(model, settings, size))?;
        let options = ContinuationOptions::within(settings.range);
        let options = ContinuationOptions {
            most_points: settings.most_points,
            steps: [1e-6, settings.longest_step],
            // The same part of the vibration, whatever the unit of arc.
            correction: options.correction / settings.over.vibration_share(),
            ..options
        };
        let own = Self { model, settings, size, store, start, scales, options };
        if let BranchParameter::Key(key) = settings.over {
            let [from, to] = settings.range;
            if own.family(1).is_same(&own.start, settings.range)? {
                let (key, model) = (key.path(), model.name());
                return Err(BranchError::NoEffect { key, model, from, to });
            }
        }
        Ok(own)
    }

    /// Everything that a search asks for.
    fn all(&self, search: &Search) -> Result<Branches, BranchError> {
        let (trunk, points) = self.trunk()?;
        let mut found = Branches { branches: Vec::new(), not_followed: Vec::new() };
        let located = trunk.points.iter().zip(&points).enumerate();
        for (number, (own, raw)) in located.filter(|_| search.switch) {
            let sides: &[f64] = match own.kind {
                // The other side is the same motion one mesh cycle later.
                BranchPointKind::PeriodDoubling => &[1.0],
                BranchPointKind::BranchPoint => &[1.0, -1.0],
                _ => continue,
            };
            for side in sides {
                match self.off((number, own, raw), *side)? {
                    Ok((branch, _)) => found.branches.push(branch),
                    Err(reason) => found.not_followed.push(NotFollowed {
                        parameter: own.parameter,
                        kind: own.kind,
                        reason,
                    }),
                }
            }
        }
        found.branches.insert(0, trunk);
        Ok(found)
    }

    /// Where the steps of a branch are kept.
    fn steps(&self, place: String, repeats_after: usize) -> Steps<'a> {
        let Self { store, model, settings, size, .. } = *self;
        let points = [Vec::new(), Vec::new()];
        Steps { store, model, settings, repeats_after, size, place, points }
    }

    fn family(&self, repeats_after: usize) -> PeriodicFamily<'a> {
        let family =
            PeriodicFamily::new(self.model, self.settings.over, self.size, self.start.len());
        family.repeating_after(repeats_after)
    }

    /// The branch through the first motion.
    fn trunk(&self) -> Result<Followed, BranchError> {
        let Self { settings, start, scales, options, .. } = self;
        let (mut family, mut steps) = (self.family(1), self.steps("first".into(), 1));
        let start = (start.as_slice(), settings.start);
        let found = trace_both(&mut family, start, scales, options, &mut steps);
        let found = found.map_err(|error| match error {
            ContinuationError::Family { cause, .. } => cause.into(),
            other => no_start(settings, other.to_string()),
        })?;
        self.kept(steps, found, BranchOrigin::Start(settings.start))
    }

    /// The branch that leaves at a period doubling or branch point, `at` its number along the first branch, to one
    /// side; the inner error is the reason why none was found.
    fn off(
        &self,
        at: (usize, &BranchPoint, &continuation::BranchPoint),
        side: f64,
    ) -> Result<Result<Followed, String>, BranchError> {
        let (number, own, raw) = at;
        let (repeats_after, multiplier, origin) = match own.kind {
            BranchPointKind::PeriodDoubling => {
                (2, -1.0, BranchOrigin::PeriodDoubling(own.parameter))
            }
            _ => (1, 1.0, BranchOrigin::BranchPoint(own.parameter)),
        };
        let map = self.family(1).map_derivative(&raw.y, raw.lambda)?;
        let Some(mut direction) = critical_direction(&map, multiplier, &self.scales.unknowns)
        else {
            return Ok(Err("the derivative has no direction of the critical multiplier".into()));
        };
        direction.iter_mut().for_each(|d| *d *= side);
        let mut family = self.family(repeats_after);
        let which = if side > 0.0 { "a" } else { "b" };
        let mut steps = self.steps(format!("off_{number:04}{which}"), repeats_after);
        let (from, Self { scales, options, .. }) = ((raw, direction.as_slice()), self);
        match branch_off(&mut family, from, scales, options, &mut steps) {
            Ok(found) => self.kept(steps, found, origin).map(Ok),
            Err(ContinuationError::Family { cause, .. }) if ends_all(&cause) => Err(cause.into()),
            Err(error) => Ok(Err(error.to_string())),
        }
    }

    fn kept(
        &self,
        steps: Steps<'_>,
        found: continuation::Branch<SweepError>,
        origin: BranchOrigin,
    ) -> Result<Followed, BranchError> {
        let mut ends = [BranchEnd::Bound, BranchEnd::Bound];
        for (own, end) in ends.iter_mut().zip(found.ends) {
            *own = match end {
                End::Start => BranchEnd::Origin,
                End::Bound => BranchEnd::Bound,
                End::Closed => BranchEnd::Closed,
                End::MostPoints => BranchEnd::MostPoints,
                End::Stuck(ContinuationError::Family { cause, .. }) if ends_all(&cause) => {
                    return Err(cause.into());
                }
                End::Stuck(why) => BranchEnd::Stuck(why.to_string()),
            };
        }
        let repeats_after = steps.repeats_after;
        // Downwards from the end reached, then upwards without the first point, which both ways have.
        let [down, up] = steps.points;
        let both = usize::from(!down.is_empty());
        let own = down.into_iter().rev().chain(up.into_iter().skip(both)).map(|(own, _)| own);
        // Arc lengths and tangents in the sense of the whole.
        let points =
            own.zip(found.points).map(|(own, raw)| (BranchPoint { arc: raw.arc, ..own }, raw));
        let mut points: Vec<_> = points.collect();
        drop_doubles(&mut points);
        if let Some(back) = points.iter().position(|(own, _)| is_back(own)) {
            points.truncate(back);
            ends[1] = BranchEnd::Origin;
        }
        let (points, raw) = points.into_iter().unzip();
        let (fidelity, over) = (self.model.name(), self.settings.over);
        Ok((Branch { fidelity, over, origin, repeats_after, points, ends }, raw))
    }
}

/// Share of the energy between harmonics below which a motion repeats after one cycle: squares of rounding errors.
const REPEATS_AT_ONCE: f64 = 1e-15;

/// Whether a branch of motions that repeat after several cycles has come back to motions that repeat after one. These
/// solve its equations as well, so that it would follow them from there on.
fn is_back(own: &BranchPoint) -> bool {
    own.between.is_some_and(|share| share < REPEATS_AT_ONCE)
}

/// Whether an error ends all branches: tables that are too small, which are laid out anew, or a store that fails.
fn ends_all(error: &SweepError) -> bool {
    error.is_too_small() || matches!(error, SweepError::Store(_))
}
