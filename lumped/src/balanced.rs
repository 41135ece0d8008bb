//! Steady motions of the lumped set by harmonic balance: the equations of [`TimeVarying`](crate::TimeVarying) without a
//! time step.

use std::f64::consts::TAU;

use dynamics::harmonic_balance::{BalanceOptions, BalancedMotion, HarmonicBalance};
use gearset::{Facing, MeshLaw};
use scene::Scene;

use crate::coordinates::Coordinates;
use crate::error::LumpedError;
use crate::time_varying::{MeshLawCouplings, Parts};

/// A lumped set under constant torque, its mesh forces given by a mesh law, in motions of the mesh period.
#[derive(Debug, Clone)]
pub struct BalancedSet {
    coordinates: Coordinates,
    balance: HarmonicBalance<MeshLawCouplings>,
}

impl BalancedSet {
    /// A set under a torque on the sun (N m, magnitude) of the given sense. The samples of a period are the law's
    /// steps.
    ///
    /// # Errors
    /// If the scene lacks lumped parameters or radii, the law has another number of meshes, or damping is out of
    /// range.
    pub fn new(
        scene: &Scene,
        sense: Facing,
        law: MeshLaw,
        torque_nm: f64,
    ) -> Result<Self, LumpedError> {
        let Parts { layout, linear, front, backside, side_loads } = Parts::new(scene, sense, &law)?;
        let (couplings, steps) = ([front, backside].concat(), law.steps());
        let mut balance =
            HarmonicBalance::new(&linear, &couplings, MeshLawCouplings(law.into()), steps)?;
        let force: Vec<f64> = layout.by_torque.iter().map(|f| f * torque_nm).collect();
        balance.set_external(&force)?;
        for (step, load) in side_loads.iter().enumerate() {
            balance.add_in_cycle(step, load)?;
        }
        Ok(Self { coordinates: layout.coordinates, balance })
    }

    /// A steady motion at a mesh frequency, from the unknowns of one nearby or from rest.
    ///
    /// Its coordinates are those of [`TimeVarying::motion`](crate::TimeVarying::motion); its deflections and forces are
    /// those of sun meshes, ring meshes, then their backside flanks if the law has them.
    ///
    /// # Errors
    /// As [`HarmonicBalance::solve`].
    pub fn solve(
        &self,
        mesh_frequency_hz: f64,
        start: Option<&[f64]>,
        options: &BalanceOptions,
    ) -> Result<BalancedMotion, LumpedError> {
        Ok(self.balance.solve(TAU * mesh_frequency_hz, start, options)?)
    }

    /// Free coordinates.
    pub fn coordinates(&self) -> &Coordinates {
        &self.coordinates
    }
}
