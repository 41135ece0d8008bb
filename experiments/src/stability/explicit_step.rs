//! Where the explicit central difference stops being stable, and how many steps a mesh cycle of a set would need.

use dynamics::benchmark_subjects::{Scheme, VibratingSystem, amplification, closed_form};
use dynamics::stability::explicit_limit;
use gearset::{LoadCase, Scene};
use lumped::LumpedModel;
use nalgebra::{DMatrix, DVector};

use super::map::{Border, Map, MapCurve, MapError, MapOf, StabilityMap, empty};

pub(super) const MAP: Map = Map {
    name: "explicit-step",
    about: "Where the explicit central difference becomes unstable, and how many steps a mesh cycle would need",
    meaning: "beyond Δt·ω_max = 2 the explicit central difference grows without bound, however small the motion at the \
         highest frequency",
    of: MapOf::Scene(map),
};

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let mut map = empty(&MAP, scene.title.clone(), "ω Δt");
    for ratio in [0.0, 0.02, 0.3] {
        let limit = explicit_limit(ratio)?;
        let of = format!("central difference, damping ratio {ratio}");
        map.borders.push(Border::new(of, "largest stable ω Δt", "", Some(limit), Some(2.0)));
    }
    for (is_theory, of) in [(false, amplification as Of), (true, exact as Of)] {
        let at = |k: i32| {
            let omega_h = 1.8 + 0.005 * f64::from(k);
            Ok::<_, MapError>((
                omega_h,
                of(&Scheme::CentralDifference, omega_h, 0.0)?.spectral_radius,
            ))
        };
        let points = (0..=80).map(at).collect::<Result<_, _>>()?;
        let (panel, name) = ("spectral radius".into(), "central difference".into());
        let is_points = !is_theory;
        map.curves.push(MapCurve { panel, name, is_theory, is_points, points });
    }
    map.borders.push(steps_per_cycle(scene)?);
    Ok(map)
}

type Of = fn(
    &Scheme,
    f64,
    f64,
) -> Result<
    dynamics::benchmark_subjects::Amplification,
    dynamics::benchmark_subjects::IntegratorError,
>;

fn exact(
    scheme: &Scheme,
    omega_h: f64,
    ratio: f64,
) -> Result<
    dynamics::benchmark_subjects::Amplification,
    dynamics::benchmark_subjects::IntegratorError,
> {
    Ok(closed_form(scheme, omega_h, ratio))
}

/// The least number of steps per mesh cycle that the program's guard admits for the lumped set, against
/// ω_max/(2 f_m).
fn steps_per_cycle(scene: &Scene) -> Result<Border, MapError> {
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
    let measured = least.map(f64::from);
    Ok(Border::new("central difference, lumped set", quantity, "", measured, Some(theory.ceil())))
}
