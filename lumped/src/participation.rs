//! How much of a motion is of each kind.

use serde::Serialize;

use crate::kinds::Kinds;
use crate::model::LumpedModel;

/// Shares of a mode's kinetic energy in the three kinds; they sum to one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Participation {
    /// Rotational kind.
    pub rotational: f64,
    /// Translational kind.
    pub translational: f64,
    /// Planet kind.
    pub planet: f64,
}

impl LumpedModel {
    /// Shares of the kinds in the kinetic energy of a motion, of which `shape` is the displacement of each free
    /// coordinate, m; not a number of a motion that is 0.
    pub fn participation(&self, shape: &[f64]) -> Participation {
        let energy: f64 = shape.iter().zip(&self.mass).map(|(q, m)| m * q * q).sum();
        let projections = Kinds::of(self).projections(1, |i, _| self.mass[i].sqrt() * shape[i]);
        let [rotational, translational] =
            projections.map(|rows| rows.iter().map(|row| row[0] * row[0]).sum::<f64>() / energy);
        Participation { rotational, translational, planet: 1.0 - rotational - translational }
    }
}
