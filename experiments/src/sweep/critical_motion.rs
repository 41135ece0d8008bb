//! Kind of motion in which a periodic motion is nearest to losing its stability, or loses it.

use dynamics::{EigenError, MapDerivative, Multiplier, floquet_vector};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::marching::Marching;
use crate::modal::type_of;

/// How the perturbation moves whose Floquet multiplier is nearest in size to 1: of a stable motion the one that decays
/// slowest, at a bifurcation the one that neither grows nor decays.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CriticalMotion {
    /// Real and imaginary part of the multiplier of a mesh cycle.
    pub multiplier: [f64; 2],
    /// Type of motion with more than half of the kinetic energy of the eigenvector: rotational, translational, planet,
    /// or mixed if there is none.
    pub mode_type: String,
    /// Share of rotational motion in that kinetic energy, by the displacements at the start of a mesh cycle.
    pub rotational: f64,
    /// Share of translational motion.
    pub translational: f64,
    /// Share of planet motion.
    pub planet: f64,
}

impl CriticalMotion {
    /// Of a set whose period is one of `parts` equal parts of a mesh cycle, or `cycles` mesh cycles, with the
    /// derivative of its map and all multipliers of that period. `None` without multipliers, and for a set without such
    /// types of motion.
    ///
    /// # Errors
    /// If the eigenvector is not found.
    pub(crate) fn of(
        set: &dyn Marching,
        derivative: &MapDerivative,
        of_period: &[Multiplier],
        parts: usize,
    ) -> Result<Option<Self>, EigenError> {
        let off = |m: &Multiplier| (m.size().powi(parts as i32) - 1.0).abs();
        let nearest = of_period.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        let (Some(own), Some(kinds)) = (nearest, set.kinds()) else { return Ok(None) };
        let vector = floquet_vector(derivative, *own)?;
        let [a, b] = vector.map(|part| {
            let (central, planets) = set.displacements_of(&part);
            [central.as_flattened(), planets.as_flattened()].concat()
        });
        let Some(shares) = kinds.shares_of([&a, &b]) else { return Ok(None) };
        let of_cycle = (1..parts).fold(*own, |power, _| power.times(*own));
        Ok(Some(Self {
            multiplier: [of_cycle.re, of_cycle.im],
            mode_type: type_of(&shares).name().into(),
            rotational: shares[0],
            translational: shares[1],
            planet: shares[2],
        }))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use dynamics::{c64, multipliers};
    use fe_contact::vibration::Along;
    use gearset::{MeshCurve, MeshLawPlan, MeshStart, Phasing};
    use lumped::{LumpedModel, NaturalModes};
    use scene::{LoadCase, PlanetOverride, Scene};

    use super::*;
    use crate::sweep::{MeshLawModel, SweepModel};

    const STEPS: usize = 60;

    /// A scene of the repository with meshes of one stiffness, damped in proportion to mass and stiffness.
    fn scene(name: &str) -> Scene {
        let path = format!("{}/../scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut scene = Scene::from_file(path.as_ref()).unwrap();
        let lumped = scene.lumped.as_mut().unwrap();
        lumped.mesh_n_per_m.ring_planet = lumped.mesh_n_per_m.sun_planet;
        scene.damping.mass_proportional_per_s = 40.0;
        scene.damping.stiffness_proportional_s = 1e-6;
        scene.damping.bearing_s = 1e-6;
        scene
    }

    /// The derivative of a mesh cycle of the lumped set with meshes of constant stiffness and the kinds of motion by
    /// its multipliers; natural modes as (predicted multiplier, type).
    #[allow(clippy::type_complexity)]
    fn found(scene: &Scene) -> (Vec<(Multiplier, CriticalMotion)>, Vec<(c64, String)>) {
        let geometry = scene.tooth_geometry().unwrap();
        let starts = MeshStart::of_set(&Phasing::new(&geometry, &scene.planets).unwrap());
        let plan = MeshLawPlan::new(&starts, STEPS).unwrap();
        let k = scene.lumped.as_ref().unwrap().mesh_n_per_m.sun_planet;
        let curve = MeshCurve::new(0.0, 1e-3, &[0.0, k * 1e-3], &[k, k]).unwrap();
        let curves = vec![curve; plan.curves.len()];
        let case = LoadCase::of_scene(scene).unwrap().with_sun_torque(1000.0).at_speed(1200.0);
        let model = MeshLawModel::lumped_with(scene, case, plan.law(curves).unwrap());
        let mut set = model.turning(&case, 0).unwrap();
        set.rest().unwrap();
        set.derivative().unwrap().start();
        for _ in 0..STEPS {
            set.step().unwrap();
            set.derivative().unwrap().keep_step();
        }
        set.derivative().unwrap().end().unwrap();
        let derivative = set.derivative().unwrap().of_cycle(Along::Motion).unwrap();
        let of = |m: &Multiplier| {
            let own = CriticalMotion::of(set.as_ref(), &derivative, &[*m], 1).unwrap().unwrap();
            (*m, own)
        };
        let all = multipliers(&derivative).unwrap();
        // The trapezoidal rule on ẍ + (α + β ω²) ẋ + ω² x = 0: z = (1 + s h/2)/(1 − s h/2) in each step.
        let h = 1.0 / (case.mesh_frequency_hz * STEPS as f64);
        let (alpha, beta) =
            (scene.damping.mass_proportional_per_s, scene.damping.stiffness_proportional_s);
        let expected = |hz: f64| {
            let omega = TAU * hz;
            let decay = 0.5 * (alpha + beta * omega * omega);
            let s = c64::new(-decay, (omega * omega - decay * decay).sqrt());
            let half = s * (0.5 * h);
            ((c64::new(1.0, 0.0) + half) / (c64::new(1.0, 0.0) - half)).powu(STEPS as u32)
        };
        let modes = NaturalModes::of(&LumpedModel::from_scene(scene).unwrap()).unwrap();
        let modes = modes.groups.iter().flat_map(|g| {
            std::iter::repeat_n(
                (expected(g.frequency_hz), g.mode_type.name().into()),
                g.multiplicity,
            )
        });
        (all.iter().map(of).collect(), modes.collect())
    }

    /// With constant mesh stiffness perturbations are natural modes: each has its multiplier, and its type with all of
    /// the energy, also where frequencies occur twice.
    #[test]
    fn perturbations_of_meshes_of_constant_stiffness_are_natural_modes() {
        for name in ["oh58_4p", "oh58_3p", "five_planets"] {
            let (found, modes) = found(&scene(name));
            assert_eq!(found.len(), 2 * modes.len(), "{name}");
            let mut types = Vec::new();
            for (expected, mode_type) in &modes {
                let off = |m: &Multiplier| (c64::new(m.re, m.im) - expected).norm();
                let (m, own) =
                    found.iter().min_by(|(a, _), (b, _)| off(a).total_cmp(&off(b))).unwrap();
                assert!(off(m) < 1e-9 * expected.norm(), "{name}: {m:?} {expected}");
                assert_eq!(own.mode_type, *mode_type, "{name}: {own:?}");
                let share = own.rotational.max(own.translational).max(own.planet);
                assert!(share > 1.0 - 1e-9, "{name}: {own:?}");
                types.push(mode_type.clone());
            }
            assert!(
                types.contains(&"rotational".into()) && types.contains(&"translational".into())
            );
        }
    }

    /// A planet heavier by half mixes the types.
    #[test]
    fn a_heavier_planet_mixes_the_types() {
        let mut scene = scene("oh58_4p");
        let mass = 1.5 * scene.lumped.as_ref().unwrap().mass_kg.planet.unwrap();
        scene.overrides.push(PlanetOverride {
            planet: 0,
            mass_kg: Some(mass),
            ..Default::default()
        });
        let (found, modes) = found(&scene);
        assert_eq!(found.len(), 2 * modes.len());
        let shares = found.iter().map(|(_, m)| m.rotational.max(m.translational).max(m.planet));
        let least = shares.fold(1.0, f64::min);
        assert!(least < 0.95, "{least}");
        for (_, own) in &found {
            let sum = own.rotational + own.translational + own.planet;
            assert!((sum - 1.0).abs() < 1e-9, "{own:?}");
        }
    }
}
