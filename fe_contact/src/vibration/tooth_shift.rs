//! The modes of a gear after it has turned by one tooth, either way.
//!
//! Gears turn on in their own frames while everything else repeats with the mesh cycle. A gear with equal teeth
//! that has turned by one tooth is the same gear, its teeth renumbered.

use dynamics::Motion;
use gearset::PathDirection;
use nalgebra::DMatrix;

use super::flexible_bodies::FlexibleBodies;
use super::gear::VibratingGear;
use crate::error::FeError;

/// Largest part of R φ outside the space of the modes, relative to the largest displacement: eigenvectors are
/// found with errors of about 1e-8.
const OUTSIDE: f64 = 1e-4;

/// S of one gear, modes×modes.
///
/// `[eq:tooth-shift]` R φ_j = Σ_i φ_i S_ij of the shapes φ_j renumbered and turned, because modes of equal frequency
/// are kept together.
/// Source: derived here.
/// Checked by: `fe_contact/src/vibration/tooth_shift.rs::a_turn_forward_and_one_back_leave_the_modes`,
/// `experiments/tests/shooting/agreement.rs::shooting_and_marching_agree_on_modal_bodies`.
#[derive(Debug, Clone)]
pub(super) struct ToothShift(DMatrix<f64>);

impl ToothShift {
    /// Those of carrier (none: it stands in its frame), ring, sun and planets; `None` for bodies without modes.
    ///
    /// # Errors
    /// If the modes of a gear are not those of equal teeth.
    pub(super) fn of_set(
        bodies: &FlexibleBodies<'_>,
        direction: PathDirection,
    ) -> Result<Vec<Option<Self>>, FeError> {
        let mut all: Vec<Option<Self>> = vec![None];
        for (k, gear) in bodies.gears.iter().enumerate() {
            // Planets are alike.
            let own = match (k > 2, all.last()) {
                (true, Some(last)) => last.clone(),
                _ => Self::of(gear, direction)?,
            };
            all.push(own);
        }
        Ok(all)
    }

    fn of(gear: &VibratingGear<'_>, direction: PathDirection) -> Result<Option<Self>, FeError> {
        let Some(modal) = gear.vibrating.modal().filter(|modal| !modal.modes.is_empty()) else {
            return Ok(None);
        };
        let mesh = &gear.body.mesh;
        let teeth = mesh.nodes.len();
        let (sin, cos) = (direction.sign() * gear.rate).sin_cos();
        let ahead = direction.whole() * gear.teeth_per_cycle();
        let ahead = ahead.rem_euclid(teeth as i64) as usize;
        let count = modal.modes.len();
        // Normal equations φᵀφ S = φᵀ R φ over the nodes of all teeth.
        let (mut own, mut across) = (DMatrix::zeros(count, count), DMatrix::zeros(count, count));
        let mut rows: Vec<[Vec<f64>; 2]> = Vec::new();
        for tooth in 0..teeth {
            let other = &mesh.nodes[(tooth + ahead) % teeth];
            for (here, there) in mesh.nodes[tooth].iter().zip(other) {
                let (here, there) = (gear.unknown_of[*here], gear.unknown_of[*there]);
                if here == usize::MAX || there == usize::MAX {
                    continue;
                }
                let at = |first: usize, axis: usize| -> Vec<f64> {
                    modal.modes.iter().map(|mode| mode.shape[first + axis]).collect()
                };
                let [x, y] = [at(there, 0), at(there, 1)];
                let along = |a: f64, b: f64| -> Vec<f64> {
                    x.iter().zip(&y).map(|(x, y)| a * x + b * y).collect()
                };
                rows.push([at(here, 0), along(cos, -sin)]);
                rows.push([at(here, 1), along(sin, cos)]);
            }
        }
        for [here, there] in &rows {
            for i in 0..count {
                for j in 0..count {
                    own[(i, j)] += here[i] * here[j];
                    across[(i, j)] += here[i] * there[j];
                }
            }
        }
        let unequal =
            || FeError::NoEquilibrium("the modes of a gear are not those of equal teeth".into());
        let shift = own.cholesky().ok_or_else(unequal)?.solve(&across);
        let (mut largest, mut outside) = (0.0f64, 0.0f64);
        for [here, there] in &rows {
            for (j, there) in there.iter().enumerate() {
                let found: f64 = here.iter().enumerate().map(|(i, x)| x * shift[(i, j)]).sum();
                largest = largest.max(there.abs());
                outside = outside.max((found - there).abs());
            }
        }
        if outside > OUTSIDE * largest {
            return Err(unequal());
        }
        Ok(Some(Self(shift)))
    }

    /// Sᵀ, for gradients by columns.
    pub(super) fn transposed(&self) -> DMatrix<f64> {
        self.0.transpose()
    }

    /// Expresses a motion of the modes in the frame one tooth back.
    pub(super) fn apply(&self, motion: &mut Motion) {
        for list in [&mut motion.x, &mut motion.v, &mut motion.a] {
            let turned: Vec<f64> = self
                .0
                .row_iter()
                .map(|row| row.iter().zip(list.iter()).map(|(s, x)| s * x).sum())
                .collect();
            list.copy_from_slice(&turned);
        }
    }
}

#[cfg(test)]
mod tests {
    use gearset::Facing;
    use scene::{Fidelity, Scene};

    use super::super::prepared::Loading;
    use super::super::rotation::NominalRotation;
    use super::super::set::VibratingSet;
    use super::*;
    use crate::statics::{Bodies, Imperfections};

    /// Modes of equal teeth are their own after a turn by one tooth of either sense, and a turn forward and one back
    /// is none. Teeth that are renumbered one way while shapes turn the other are those of no gear, and are refused.
    #[test]
    fn a_turn_forward_and_one_back_leave_the_modes() {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        scene.fe_contact.flank_elements = 6;
        scene.dynamics.fidelity = Fidelity::Modal(4);
        let bodies = Bodies::new(&scene).unwrap();
        let rotation = NominalRotation::Standing { position: 0.0, step: 5e-6 };
        let loading = Loading { torque_nm: 1130.0, mesh_force: 8000.0 };
        let (sense, none) = (Facing::CounterClockwise, Imperfections::default());
        let set = VibratingSet::new(&scene, &bodies, sense, none, rotation, loading).unwrap();
        let both = [PathDirection::Forward, PathDirection::Backward]
            .map(|direction| ToothShift::of_set(&set.bodies, direction).unwrap());
        let mut turned = 0.0f64;
        for (forward, back) in both[0].iter().zip(&both[1]) {
            let (Some(forward), Some(back)) = (forward, back) else { continue };
            let count = forward.0.nrows();
            let identity = DMatrix::identity(count, count);
            assert!((&forward.0 * &back.0 - &identity).amax() < 1e-4);
            turned = turned.max((&forward.0 - &identity).amax());
        }
        // Modes along x and y turn into each other.
        assert!(turned > 0.05, "{turned}");
    }
}
