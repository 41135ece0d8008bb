//! The yardstick of costs: mesh cycles of the lumped model.

use fe_contact::statics::Bodies;
use fe_contact::vibration::{MeshLawSettings, mesh_law};
use scene::{Fidelity, LoadCase, Scene};

use super::cost::Stopwatch;
use crate::model::ModelError;
use crate::sweep::{Marching, MeshLawModel, SweepModel};

/// Least time that the yardstick is marched each time it is asked, s.
const LEAST_S: f64 = 0.02;

/// Cycles marched before the first are timed.
const SETTLING: usize = 20;

/// Steps in a mesh cycle of the yardstick, whatever the study's.
pub(super) const STEPS: u32 = 140;

/// The lumped model of a scene at its operating speed, its mesh forces tabulated by FE/contact at quasi-static bodies,
/// 140 steps to the cycle, under the load of the study.
pub(super) fn yardstick(
    scene: &Scene,
    case: LoadCase,
) -> Result<MeshLawModel<'static>, ModelError> {
    let mut scene = scene.clone();
    scene.dynamics.fidelity = Fidelity::MeshLaw;
    scene.dynamics.steps_per_cycle = STEPS;
    let bodies = Bodies::new(&scene)?;
    let settings = MeshLawSettings::at(case.sun_load_nm());
    let law = mesh_law(&scene, &bodies, case.sense(), STEPS as usize, &settings)?;
    Ok(MeshLawModel::lumped_with(&scene, case, law.in_direction(case.direction())))
}

/// A set of the yardstick that moves.
pub(super) struct Yardstick<'m> {
    set: Box<dyn Marching + 'm>,
}

impl<'m> Yardstick<'m> {
    pub(super) fn new(model: &'m MeshLawModel<'static>) -> Result<Self, ModelError> {
        let mut set = model.turning(&model.case(), 0)?;
        set.rest()?;
        (0..SETTLING * STEPS as usize).try_for_each(|_| set.step())?;
        Ok(Self { set })
    }

    /// Time of one mesh cycle, mean of as many as take 20 ms, s.
    pub(super) fn cycle_s(&mut self, stopwatch: &mut dyn Stopwatch) -> Result<f64, ModelError> {
        let start = stopwatch.seconds();
        for cycles in 1u32.. {
            (0..8 * STEPS).try_for_each(|_| self.set.step())?;
            let gone = stopwatch.seconds() - start;
            if gone >= LEAST_S {
                return Ok(gone / f64::from(8 * cycles));
            }
        }
        Ok(f64::NAN)
    }
}
