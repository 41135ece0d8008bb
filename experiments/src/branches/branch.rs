//! A branch of periodic motions.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::point::{BranchPoint, BranchPointKind, BranchRow};

/// Why a branch ends where it does.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum BranchEnd {
    /// At the least or greatest speed.
    Bound,
    /// At its first point: the branch is closed.
    Closed,
    /// At the greatest number of points.
    MostPoints,
    /// No step could be taken, for this reason.
    Stuck(String),
}

/// Periodic motions of one model under one torque in their order along the branch; located folds and
/// bifurcations stand between the others.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Branch {
    /// Fidelity or model.
    pub fidelity: String,
    /// Points, from the end reached towards lower speeds at first.
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
    pub fn rows(&self, scene: &str) -> impl Iterator<Item = BranchRow> {
        self.points.iter().enumerate().flat_map(move |(index, p)| {
            p.state.with_translations().into_iter().map(move |line| BranchRow {
                scene: scene.to_owned(),
                fidelity: self.fidelity.clone(),
                sun_torque_nm: p.state.case.sun_torque_nm,
                speed_rpm: p.state.case.speed_rpm,
                mesh_frequency_hz: p.state.case.mesh_frequency_hz,
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
