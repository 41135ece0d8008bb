//! A branch of periodic motions.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter::BranchParameter;
use super::point::{BranchPoint, BranchPointKind, BranchRow};

/// Why a branch ends where it does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchEnd {
    /// At the least or greatest value of the parameter.
    Bound,
    /// At the bifurcation of another branch.
    Origin,
    /// At its first point: the branch is closed.
    Closed,
    /// At the greatest number of points.
    MostPoints,
    /// No step could be taken, for this reason.
    Stuck(String),
}

/// What a branch was begun from, with the value of the parameter there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchOrigin {
    /// The motion found from rest.
    Start(f64),
    /// A period doubling of the first branch.
    PeriodDoubling(f64),
    /// A branch point of the first branch.
    BranchPoint(f64),
}

/// A bifurcation at which no other branch was found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct NotFollowed {
    /// Value of the parameter.
    pub parameter: f64,
    /// What the point is.
    pub kind: BranchPointKind,
    /// Why.
    pub reason: String,
}

/// Branches of one model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Branches {
    /// The branch through the motion found from rest, then those that leave it.
    pub branches: Vec<Branch>,
    /// Bifurcations of the first branch at which no other one was found.
    pub not_followed: Vec<NotFollowed>,
}

impl Branches {
    /// Ranges of the parameter, ascending, in which more than one stable motion was found.
    pub fn coexisting(&self) -> Vec<[f64; 2]> {
        // Where stretches of stable motions begin (+1) and end (−1).
        let mut ends: Vec<(f64, i32)> = Vec::new();
        for branch in &self.branches {
            for pair in branch.points.windows(2) {
                let is_stable = |p: &BranchPoint| {
                    // At a located point itself stability is about to change.
                    p.is_stable || p.kind != BranchPointKind::Regular
                };
                let [a, b] = [&pair[0], &pair[1]];
                if is_stable(a) && is_stable(b) && (a.is_stable || b.is_stable) {
                    let (low, high) = (a.parameter.min(b.parameter), a.parameter.max(b.parameter));
                    ends.extend([(low, 1), (high, -1)]);
                }
            }
        }
        // At one value stretches end before others begin, so that neighbours along a branch count once.
        ends.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let (mut count, mut from, mut ranges) = (0, f64::NAN, Vec::<[f64; 2]>::new());
        for (value, step) in ends {
            let was = count;
            count += step;
            if was < 2 && count == 2 {
                from = value;
            }
            if was == 2 && count < 2 && value > from {
                match ranges.last_mut() {
                    Some(last) if last[1] == from => last[1] = value,
                    _ => ranges.push([from, value]),
                }
            }
        }
        ranges
    }
}

/// Periodic motions of one model in their order along the branch; located folds and
/// bifurcations stand between the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Branch {
    /// Fidelity or model.
    pub fidelity: String,
    /// What is varied.
    pub over: BranchParameter,
    /// What it was begun from.
    pub origin: BranchOrigin,
    /// Mesh cycles after which its motions repeat.
    pub repeats_after: usize,
    /// Points, from the end reached towards lower values at first.
    pub points: Vec<BranchPoint>,
    /// Why it ends at its first and at its last point.
    pub ends: [BranchEnd; 2],
}

impl Branch {
    /// Its folds, in order.
    pub fn folds(&self) -> impl Iterator<Item = &BranchPoint> {
        self.points.iter().filter(|p| p.kind == BranchPointKind::Fold)
    }

    /// Its other bifurcations, in order.
    pub fn bifurcations(&self) -> impl Iterator<Item = &BranchPoint> {
        let is_other = |k| !matches!(k, BranchPointKind::Regular | BranchPointKind::Fold);
        self.points.iter().filter(move |p| is_other(p.kind))
    }

    /// The tidy table: every point in order along the branch, each body's radial, tangential and rotational
    /// harmonics followed by those of its translation.
    /// `branch`: its number.
    pub fn rows(&self, scene: &str, branch: usize) -> impl Iterator<Item = BranchRow> {
        self.points.iter().enumerate().flat_map(move |(index, p)| {
            p.state.with_translations().into_iter().map(move |line| BranchRow {
                scene: scene.to_owned(),
                fidelity: self.fidelity.clone(),
                sun_torque_nm: p.state.case.sun_torque_nm,
                speed_rpm: p.state.case.speed_rpm,
                mesh_frequency_hz: p.state.case.mesh_frequency_hz,
                damping_factor: p.damping_factor,
                parameter: p.parameter,
                branch,
                repeats_after: self.repeats_after,
                point: index,
                kind: p.kind.name().to_owned(),
                is_stable: p.is_stable,
                largest_multiplier: p.largest_multiplier(),
                arc: p.arc,
                body: line.part.name(),
                coordinate: line.coordinate.name().to_owned(),
                harmonic: line.harmonic,
                amplitude: line.amplitude,
                unit: line.coordinate.unit().to_owned(),
                phase_rad: line.phase_rad,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use gearset::LoadCase;

    use super::*;
    use crate::sweep::SteadyState;

    fn branch(points: &[(f64, BranchPointKind, bool)]) -> Branch {
        let point = |&(parameter, kind, is_stable): &(f64, BranchPointKind, bool)| BranchPoint {
            state: SteadyState {
                case: LoadCase::turning(50.0, parameter, parameter),
                lines: Vec::new(),
            },
            parameter,
            damping_factor: 1.0,
            kind,
            is_stable,
            multipliers: Vec::new(),
            critical: None,
            between: None,
            residual: 0.0,
            arc: parameter,
            iterations: 3,
            lowest_force_n: 0.0,
            contact_loss: 0.0,
            backside_contact: None,
            grazing_margin: None,
        };
        Branch {
            fidelity: "mesh-law".into(),
            over: BranchParameter::Speed,
            origin: BranchOrigin::Start(1.0),
            repeats_after: 1,
            points: points.iter().map(point).collect(),
            ends: [BranchEnd::Bound, BranchEnd::Bound],
        }
    }

    #[test]
    fn stable_motions_coexist_between_folds_and_where_branches_overlap() {
        use BranchPointKind::{Fold, Regular};
        let hysteresis = branch(&[
            (1.0, Regular, true),
            (2.5, Regular, true),
            (3.0, Fold, false),
            (2.5, Regular, false),
            (2.0, Fold, false),
            (2.2, Regular, true),
            (4.0, Regular, true),
        ]);
        let mut found = Branches { branches: vec![hysteresis], not_followed: Vec::new() };
        assert_eq!(found.coexisting(), [[2.0, 3.0]]);
        found.branches.push(branch(&[
            (3.5, Regular, true),
            (3.8, Regular, true),
            (3.9, Regular, false),
        ]));
        assert_eq!(found.coexisting(), [[2.0, 3.0], [3.5, 3.8]]);
        let alone = branch(&[(1.0, Regular, true), (2.0, Regular, true), (3.0, Regular, true)]);
        let found = Branches { branches: vec![alone], not_followed: Vec::new() };
        assert!(found.coexisting().is_empty());
    }
}
