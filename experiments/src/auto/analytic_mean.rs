//! The mean transmission error at rest of the lumped model with parameters in closed form, and its estimated errors. `docs/auto.md`
//! derives them.

use gearset::{LoadCase, Scene};
use lumped::{AnalyticCycle, AnalyticRest, LumpedError};

use super::analytic_mode::{SEAT_DOUBT, of_stiffness};
use super::choice::ErrorPart;
use super::settings::divided;

/// Positions over which the mean is taken.
const POSITIONS: u32 = 24;

/// Factor on the change of the mean from half of the positions.
const SAFETY: f64 = 1.25;

/// The mean over a mesh cycle.
#[derive(Debug, Clone, Copy)]
pub(super) struct AnalyticMean {
    /// r_b θ of the sun, m.
    pub(super) transmission_error: f64,
    /// The same over every second position.
    of_half: f64,
    /// Shares of sun meshes, ring meshes and pin seats in it: each is the work of its forces over that of the torque.
    shares: [f64; 3],
    /// Largest angle by which a line of action turns under load, rad.
    turned: f64,
}

impl AnalyticMean {
    /// The mean of a set under its load.
    ///
    /// # Errors
    /// If the scene has no parameters in closed form.
    pub(super) fn of(scene: &Scene, case: &LoadCase) -> Result<Self, LumpedError> {
        let cycle = AnalyticCycle::new(scene, case)?;
        let count = divided(scene, POSITIONS);
        let positions: Vec<f64> = (0..count).map(|i| f64::from(i) / f64::from(count)).collect();
        let all = cycle.at_rest(&positions)?;
        let second: Vec<AnalyticRest> = all.iter().step_by(2).copied().collect();
        let mean = |list: &[AnalyticRest], of: &dyn Fn(&AnalyticRest) -> f64| {
            list.iter().map(of).sum::<f64>() / list.len() as f64
        };
        let transmission_error = mean(&all, &|own| own.transmission_error);
        // f u = Σ F δ + …
        let work = cycle.load() * transmission_error;
        let shares = [
            mean(&all, &|own| own.mesh_work[0]) / work,
            mean(&all, &|own| own.mesh_work[1]) / work,
            mean(&all, &|own| own.seat_work) / work,
        ];
        let of_half = mean(&second, &|own| own.transmission_error);
        Ok(Self { transmission_error, of_half, shares, turned: cycle.turned })
    }

    /// Estimated errors beside FE/contact on fine meshes.
    pub(super) fn error_parts(&self) -> Vec<ErrorPart> {
        let [suns, rings, seats] = self.shares;
        let stiffness = of_stiffness([suns, rings]);
        let positions = SAFETY * (self.of_half / self.transmission_error - 1.0).abs();
        vec![
            ErrorPart::new("mesh stiffness in closed form", stiffness),
            ErrorPart::new("pin seats in closed form", SEAT_DOUBT * seats),
            ErrorPart::new("lines of action of the unloaded set", self.turned),
            ErrorPart::new("positions of the mesh cycle", positions),
        ]
    }
}
