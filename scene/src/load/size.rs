//! Loads and speeds given beside a scene, as on the command line: how far teeth give way, and what a speed can be.

use gearset::MeshKind;

use crate::load::estimates;
use crate::scene::{Scene, SceneKind};

/// Largest deflection, in modules, that is accepted: beyond one module teeth leave their spaces, and displacements
/// that are linear in the load describe no gears.
pub(crate) const MOST_MODULES: f64 = 1.0;

/// Deflection, in modules, from which a load is warned of: OH-58's published loads and bearings give 0.13 at most.
pub(crate) const LARGE_MODULES: f64 = 0.25;

/// Smallest deflection, in modules, that is accepted. Equilibria of sets resolve approaches to some 1e-13 m at a module
/// of 3 mm; teeth behind bearings twenty times as soft as they are take a twentieth of this deflection, and keep three
/// digits.
pub(crate) const LEAST_MODULES: f64 = 1e-6;

/// Lowest and highest speeds of a shaft that a model is asked for, rpm: slower is rest, and the fastest turbines of all
/// reach a tenth of the other.
pub const SPEEDS_RPM: [f64; 2] = [1e-3, 1e7];

/// Whether a speed that is to be swept, rpm, lies between these.
pub fn is_speed(rpm: f64) -> bool {
    (SPEEDS_RPM[0]..=SPEEDS_RPM[1]).contains(&rpm)
}

/// How far teeth give way under a load, by estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadSize {
    /// Deflection along the line of action, m: meshes of E b/13, planet bearing and torsional supports in series.
    pub deflection: f64,
    /// Operating module, m.
    pub module: f64,
}

impl LoadSize {
    /// Whether displacements that are linear in the load have no meaning: more than a module.
    pub fn is_too_large(&self) -> bool {
        !self.deflection.is_finite() || self.deflection > MOST_MODULES * self.module
    }

    /// Whether rounding would show in the displacements: less than a millionth of a module.
    pub fn is_too_small(&self) -> bool {
        self.deflection < LEAST_MODULES * self.module
    }

    /// Whether it is more than a quarter of a module, which hints at a slip of unit.
    pub fn is_worth_a_warning(&self) -> bool {
        self.deflection > LARGE_MODULES * self.module
    }

    /// How far the teeth give way, in words.
    pub fn words(&self) -> String {
        format!(
            "by estimate the teeth give way by {:.3e} mm, {:.3e} of the module",
            1e3 * self.deflection,
            self.deflection / self.module
        )
    }

    /// Why a load of this size is refused, what is allowed, and why; `None` if it is not.
    pub fn refusal(&self, load: f64, unit: &str) -> Option<String> {
        let (bound, why) = match (self.is_too_small(), self.is_too_large()) {
            (true, _) => {
                let bound = format!("above {:.3e} {unit}", self.least(load));
                (bound, ", so little that rounding shows in what is computed")
            }
            (_, true) => {
                let bound = format!("below {:.3e} {unit}", self.most(load));
                (bound, ", and displacements are no longer linear in the load")
            }
            _ => return None,
        };
        Some(format!("{load:e} {unit}: allowed is a magnitude {bound}; {}{why}", self.words()))
    }

    /// The largest deflection that is accepted, m.
    pub fn most_deflection(&self) -> f64 {
        MOST_MODULES * self.module
    }

    /// The load with which teeth give way by a module, for a load that gives this size.
    pub fn most(&self, load: f64) -> f64 {
        MOST_MODULES * load.abs() * self.module / self.deflection
    }

    /// The load with which teeth give way by a millionth of a module, for a load that gives this size.
    pub fn least(&self, load: f64) -> f64 {
        LEAST_MODULES * load.abs() * self.module / self.deflection
    }
}

impl Scene {
    /// Deflection of the teeth of a set or a sun–planet pair under a torque on the sun, N·m. `None` without tooth
    /// geometry and where the torque has no path through the meshes.
    pub fn size_of_sun_torque(&self, torque_nm: f64) -> Option<LoadSize> {
        let geometry = self.tooth_geometry().ok()?;
        let radius = geometry.sun.as_ref()?.base_radius;
        let force = torque_nm.abs() / radius / self.planets.count() as f64;
        let deflection = estimates::way_under(self, &geometry, force)?;
        Some(LoadSize { deflection, module: estimates::module(&geometry)? })
    }

    /// Normal force of a sun–planet pair under the torque of its operating point, |T_s|/r_b, N; `None` without one, or
    /// of another scene.
    pub fn pair_force_n(&self) -> Option<f64> {
        let geometry =
            self.tooth_geometry().ok().filter(|_| self.pair == Some(MeshKind::SunPlanet))?;
        estimates::mesh_force(self, &geometry).filter(|force| *force > 0.0)
    }

    /// Deflection of a gear pair's teeth under a normal force, N. `None` of a set and without tooth geometry.
    pub fn size_of_normal_force(&self, force_n: f64) -> Option<LoadSize> {
        let stiffness = estimates::pair_stiffness(self)?;
        self.size_of_approach(force_n / stiffness)
    }

    /// An approach of a gear pair's teeth, m, beside the module. `None` of a set and without tooth geometry.
    pub fn size_of_approach(&self, approach: f64) -> Option<LoadSize> {
        if self.kind != SceneKind::GearPair {
            return None;
        }
        let geometry = self.tooth_geometry().ok()?;
        Some(LoadSize { deflection: approach, module: estimates::module(&geometry)? })
    }
}
