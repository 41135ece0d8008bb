//! A branch of periodic motions.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter::BranchParameter;
use super::point::{BranchPoint, BranchPointKind};

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
}
