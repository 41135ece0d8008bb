//! Where the explicit central difference stops being stable, and how many steps a mesh cycle of a set would need.

use dynamics::benchmark_subjects::{Scheme, VibratingSystem, amplification, closed_form};
use dynamics::stability::explicit_limit;
use lumped::LumpedModel;
use nalgebra::{DMatrix, DVector};
use scene::{LoadCase, Scene};

use super::map::{Map, MapError, MapOf, StabilityMap};

pub(super) const MAP: Map = Map {
    name: "explicit-step",
    about: "Where the explicit central difference becomes unstable, and how many steps a mesh cycle would need",
    meaning: "beyond Δt·ω_max = 2 the explicit central difference grows without bound, however small the motion at the \
         highest frequency",
    of: MapOf::Scene(map),
};

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let mut map = StabilityMap::of(&MAP, scene.title.clone(), "ω Δt");
    for ratio in [0.0, 0.02, 0.3] {
        let of = format!("central difference, damping ratio {ratio}");
        map.compare(of, "largest stable ω Δt", explicit_limit(ratio)?, Some(2.0));
    }
    let steps = || (0..=80).map(|k| 1.8 + 0.005 * f64::from(k));
    let scheme = Scheme::CentralDifference;
    let measured = steps().map(|x| Ok((x, amplification(&scheme, x, 0.0)?.spectral_radius)));
    let measured = measured.collect::<Result<Vec<_>, MapError>>()?;
    let theory = steps().map(|x| (x, closed_form(&scheme, x, 0.0).spectral_radius));
    map.draw_beside("spectral radius", "central difference", measured, theory);
    steps_per_cycle(&mut map, scene)?;
    Ok(map)
}

/// The least number of steps per mesh cycle that the program's guard admits for the lumped set, against
/// ω_max/(2 f_m).
fn steps_per_cycle(map: &mut StabilityMap, scene: &Scene) -> Result<(), MapError> {
    let model = LumpedModel::from_scene(scene)?;
    let case = LoadCase::of_scene(scene).map_err(|_| MapError::NoOperation)?;
    let n = model.mass.len();
    let mass = DMatrix::from_diagonal(&DVector::from_column_slice(&model.mass));
    let system = VibratingSystem::new(mass, DMatrix::zeros(n, n), model.stiffness(), vec![0.0; n])?;
    let theory = system.highest_frequency()? / (2.0 * case.mesh_frequency_hz);
    let admits = |steps: u32| {
        let h = 1.0 / (case.mesh_frequency_hz * f64::from(steps));
        Scheme::CentralDifference.prepare(&system, h).is_ok()
    };
    let least = (1..=1_000_000u32).find(|steps| f64::from(*steps) > 0.5 * theory && admits(*steps));
    let quantity = format!("steps per mesh cycle at {:.0} Hz", case.mesh_frequency_hz);
    let of = "central difference, lumped set";
    map.compare(of, quantity, least.map(f64::from), Some(theory.ceil()));
    Ok(())
}
