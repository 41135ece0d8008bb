//! A branch of solutions.

use serde::{Deserialize, Serialize};

use super::error::ContinuationError;
use super::family::Judgement;

/// What a point of a branch is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PointKind {
    /// Any point.
    Regular,
    /// The branch turns back in λ.
    Fold,
    /// Test function of this number changes sign.
    Bifurcation(usize),
}

/// A solution on a branch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchPoint {
    /// Unknowns.
    pub y: Vec<f64>,
    /// Parameter.
    pub lambda: f64,
    /// Unit tangent along the branch, in scaled unknowns and, last, scaled parameter.
    pub tangent: Vec<f64>,
    /// Scaled arc length from the first point.
    pub arc: f64,
    /// What the point is.
    pub kind: PointKind,
    /// Stability and test functions.
    pub judgement: Judgement,
    /// Newton iterations.
    pub iterations: usize,
}

/// Why a branch ends where it does.
#[derive(Debug, Clone, PartialEq)]
pub enum End<E: std::error::Error> {
    /// It was started here.
    Start,
    /// At a bound of the parameter.
    Bound,
    /// At its first point: the branch is closed.
    Closed,
    /// At the greatest number of points.
    MostPoints,
    /// No step could be taken, for the reason of the shortest one tried; points found so far stand.
    Stuck(ContinuationError<E>),
}

/// Points in their order along a branch; located folds and bifurcations stand between the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Branch<E: std::error::Error> {
    /// Points.
    pub points: Vec<BranchPoint>,
    /// Why the branch ends at its first and at its last point.
    pub ends: [End<E>; 2],
}

impl<E: std::error::Error> Branch<E> {
    /// Its folds, in order.
    pub fn folds(&self) -> impl Iterator<Item = &BranchPoint> {
        self.points.iter().filter(|p| p.kind == PointKind::Fold)
    }

    /// Its other bifurcations, in order.
    pub fn bifurcations(&self) -> impl Iterator<Item = &BranchPoint> {
        self.points.iter().filter(|p| matches!(p.kind, PointKind::Bifurcation(_)))
    }
}
