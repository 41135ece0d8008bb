//! The relative rotation of a pair whose gears both turn freely.
//!
//! The motion without relative rotation has no stiffness, and balanced torques and a mesh force along the line of
//! action leave it at rest: m_s u_s = m_p u_p at all times, with m = J/r². What remains of both rotations is one
//! coordinate, the transmission error along the line of action.

use nalgebra::DMatrix;

use dynamics::{Coupling, LinearPart};
use gearset::{Axis, Body};
use scene::Scene;

use crate::model::LumpedModel;

/// Rotations of sun and planet as one coordinate, at the sun's place; the planet's place falls away.
///
/// `[eq:relative-rotation]` w = u_s + u_p, u_s = a_s w, u_p = a_p w, a_s = m_p/(m_s + m_p), a_p = m_s/(m_s + m_p),
/// with the effective mass m_e = m_s m_p/(m_s + m_p) = J_s J_p/(J_s r_p² + J_p r_s²).
/// Source: derived here.
/// Checked by: `lumped/tests/gear_pair.rs::the_relative_rotation_is_that_of_the_effective_mass`,
/// `lumped/tests/gear_pair.rs::the_gears_share_the_relative_rotation_by_their_inertias`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RelativeRotation {
    sun: usize,
    pub(crate) planet: usize,
    /// a_s, a_p.
    share: [f64; 2],
}

impl RelativeRotation {
    /// Of a gear pair with both rotations free and without torsional springs; `None` otherwise.
    pub(crate) fn of(scene: &Scene, model: &LumpedModel) -> Option<Self> {
        let place = |body| model.coordinates.of(body, Axis::Rotation);
        let (sun, planet) = (place(Body::Sun)?, place(Body::Planet(0))?);
        let (m_s, m_p) = (model.mass[sun], model.mass[planet]);
        let share = [m_p / (m_s + m_p), m_s / (m_s + m_p)];
        scene.is_free_pair().then_some(Self { sun, planet, share })
    }

    /// A full coordinate from the reduced ones.
    pub(crate) fn full(&self, i: usize, reduced: impl Fn(usize) -> f64) -> f64 {
        match i {
            i if i == self.sun => self.share[0] * reduced(self.sun),
            i if i == self.planet => self.share[1] * reduced(self.sun),
            i if i > self.planet => reduced(i - 1),
            i => reduced(i),
        }
    }

    /// A row or load on the full coordinates, on the reduced ones.
    pub(crate) fn reduced(&self, full: &[f64]) -> Vec<f64> {
        let mut out = full.to_vec();
        out[self.sun] = self.share[0] * full[self.sun] + self.share[1] * full[self.planet];
        out.remove(self.planet);
        out
    }

    /// Masses, damping and stiffness on the reduced coordinates.
    pub(crate) fn reduce(&self, full: &LinearPart) -> LinearPart {
        let matrix = |full: &DMatrix<f64>| {
            let n = full.nrows();
            let rows: Vec<Vec<f64>> = full
                .row_iter()
                .map(|row| self.reduced(&row.iter().copied().collect::<Vec<_>>()))
                .collect();
            let column = |j: usize| (0..n).map(|i| rows[i][j]).collect::<Vec<_>>();
            let columns: Vec<Vec<f64>> = (0..n - 1).map(|j| self.reduced(&column(j))).collect();
            DMatrix::from_fn(n - 1, n - 1, |i, j| columns[j][i])
        };
        let mass = matrix(&DMatrix::from_diagonal(&full.mass.clone().into()));
        LinearPart {
            mass: mass.diagonal().iter().copied().collect(),
            damping: matrix(&full.damping),
            stiffness: matrix(&full.stiffness),
        }
    }

    /// A coupling on the reduced coordinates.
    pub(crate) fn coupling(&self, full: &Coupling) -> Coupling {
        Coupling { row: self.reduced(&full.row), ..full.clone() }
    }
}
