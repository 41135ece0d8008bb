//! Follows branches of periodic motions over speed, torque or damping.

use dynamics::continuation::{
    self, ContinuationError, ContinuationOptions, End, Scales, branch_off, trace_both,
};

use super::branch::{Branch, BranchEnd, BranchOrigin, Branches, NotFollowed};
use super::direction::critical_direction;
use super::family::PeriodicFamily;
use super::first::{first, no_start};
use super::judged_point::{drop_doubles, point};
use super::point::{BranchPoint, BranchPointKind};
use super::settings::BranchSettings;
use crate::error::ExperimentError;
use crate::sweep::SweepModel;
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
pub fn branch(
    model: &dyn SweepModel,
    settings: &BranchSettings,
) -> Result<Branch, ExperimentError> {
    settings.check()?;
    model.prepare()?;
    large_enough(|size| Ok(Follower::new(model, settings, size)?.trunk()?.0))
}

/// The same with the branches that leave it at its period doublings and branch points. Those that leave these are not
/// followed.
///
/// # Errors
/// As [`branch`].
pub fn branches(
    model: &dyn SweepModel,
    settings: &BranchSettings,
) -> Result<Branches, ExperimentError> {
    settings.check()?;
    model.prepare()?;
    large_enough(|size| {
        let follower = Follower::new(model, settings, size)?;
        let (trunk, points) = follower.trunk()?;
        let mut found = Branches { branches: Vec::new(), not_followed: Vec::new() };
        for (own, raw) in trunk.points.iter().zip(&points) {
            let sides: &[f64] = match own.kind {
                // The other side is the same motion one mesh cycle later.
                BranchPointKind::PeriodDoubling => &[1.0],
                BranchPointKind::BranchPoint => &[1.0, -1.0],
                _ => continue,
            };
            for side in sides {
                match follower.off(own, raw, *side)? {
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
    })
}

/// A model and how its branches are followed.
struct Follower<'a> {
    model: &'a dyn SweepModel,
    settings: &'a BranchSettings,
    /// As in [`SweepModel::turning`].
    size: usize,
    start: Vec<f64>,
    scales: Scales,
    options: ContinuationOptions,
}

impl<'a> Follower<'a> {
    fn new(
        model: &'a dyn SweepModel,
        settings: &'a BranchSettings,
        size: usize,
    ) -> Result<Self, ExperimentError> {
        let (start, scales) = first(model, settings, size)?;
        let options = ContinuationOptions {
            most_points: settings.most_points,
            steps: [1e-6, settings.longest_step],
            ..ContinuationOptions::within(settings.range)
        };
        Ok(Self { model, settings, size, start, scales, options })
    }

    fn family(&self, repeats_after: usize) -> PeriodicFamily<'a> {
        let family =
            PeriodicFamily::new(self.model, self.settings.over, self.size, self.start.len());
        family.repeating_after(repeats_after)
    }

    /// The branch through the first motion.
    fn trunk(&self) -> Result<Followed, ExperimentError> {
        let (settings, mut family) = (self.settings, self.family(1));
        let found =
            trace_both(&mut family, &self.start, settings.start, &self.scales, &self.options);
        let found = found.map_err(|error| match error {
            ContinuationError::Family { cause, .. } => cause,
            other => no_start(settings, other.to_string()),
        })?;
        self.kept(&family, found, BranchOrigin::Start(settings.start), 1)
    }

    /// The branch that leaves at a period doubling or branch point, to one side; the inner error is the reason why none
    /// was found.
    fn off(
        &self,
        own: &BranchPoint,
        raw: &continuation::BranchPoint,
        side: f64,
    ) -> Result<Result<Followed, String>, ExperimentError> {
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
        match branch_off(&mut family, raw, &direction, &self.scales, &self.options) {
            Ok(found) => self.kept(&family, found, origin, repeats_after).map(Ok),
            Err(ContinuationError::Family { cause, .. }) if cause.is_too_small() => Err(cause),
            Err(error) => Ok(Err(error.to_string())),
        }
    }

    fn kept(
        &self,
        family: &PeriodicFamily<'_>,
        found: continuation::Branch<ExperimentError>,
        origin: BranchOrigin,
        repeats_after: usize,
    ) -> Result<Followed, ExperimentError> {
        let mut ends = [BranchEnd::Bound, BranchEnd::Bound];
        for (own, end) in ends.iter_mut().zip(found.ends) {
            *own = match end {
                End::Start => BranchEnd::Origin,
                End::Bound => BranchEnd::Bound,
                End::Closed => BranchEnd::Closed,
                End::MostPoints => BranchEnd::MostPoints,
                End::Stuck(ContinuationError::Family { cause, .. }) if cause.is_too_small() => {
                    return Err(cause);
                }
                End::Stuck(why) => BranchEnd::Stuck(why.to_string()),
            };
        }
        let mut points = Vec::with_capacity(found.points.len());
        for raw in found.points {
            let own =
                point(self.model, &family.judged, &raw, self.settings, repeats_after, self.size)?;
            points.push((own, raw));
        }
        drop_doubles(&mut points);
        let (points, raw) = points.into_iter().unzip();
        let (fidelity, over) = (self.model.name(), self.settings.over);
        Ok((Branch { fidelity, over, origin, repeats_after, points, ends }, raw))
    }
}
