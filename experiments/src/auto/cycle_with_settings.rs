//! A mesh cycle at rest with settings that are named.

use fe_contact::statics::{Bodies, SetCycle};
use gearset::{LoadCase, Scene};

use super::analytic_mean::AnalyticMean;
use super::cycle_curve::Curve;
use super::cycle_request::{CycleRequest, CycleValue};
use super::settings::AutoSettings;
use crate::error::ExperimentError;

/// The transmission error with given settings, µm.
///
/// # Errors
/// If FE/contact refuses the scene, or the settings have no positions.
pub fn transmission_error_with(
    scene: &Scene,
    case: &LoadCase,
    settings: AutoSettings,
    request: &CycleRequest,
) -> Result<f64, ExperimentError> {
    if settings == AutoSettings::LUMPED && request.value == CycleValue::Mean {
        return Ok(1e6 * AnalyticMean::of(scene, case)?.transmission_error);
    }
    let own = settings.applied_to(scene);
    let bodies = Bodies::new(&own)?;
    Ok(1e6 * request.of(&with_positions(&own, &bodies, case, settings)?.points()))
}

/// A mesh cycle at the positions of given settings, of `scene` with these settings on its bodies: the even ones and, where the
/// settings have them, those about the extremes of the transmission error.
///
/// # Errors
/// If FE/contact refuses the scene, or the settings have no positions.
pub fn cycle_with(
    scene: &Scene,
    bodies: &Bodies,
    case: &LoadCase,
    settings: AutoSettings,
) -> Result<SetCycle, ExperimentError> {
    let curve = with_positions(scene, bodies, case, settings)?;
    curve.into_cycle().ok_or(ExperimentError::Incomplete("number of positions"))
}

fn with_positions<'b>(
    scene: &Scene,
    bodies: &'b Bodies,
    case: &LoadCase,
    settings: AutoSettings,
) -> Result<Curve<'b>, ExperimentError> {
    let even = settings.positions.ok_or(ExperimentError::Incomplete("number of positions"))?;
    let about = settings.positions_about_extremes.unwrap_or(even);
    let mut curve = Curve::new(scene, bodies, case, (1, about))?;
    match about > even {
        true => curve.refine(even, about)?,
        false => drop(curve.at(&curve.even(even))?),
    }
    Ok(curve)
}

#[cfg(test)]
mod tests {
    use gearset::{SceneKind, template};

    use super::*;

    /// A cycle at the positions of a candidate has the candidate's peak to peak, and means that positions close to the extremes do not
    /// pull towards them.
    #[test]
    fn cycles_at_refined_positions_have_their_extremes_and_even_means() {
        let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        let own = AutoSettings::quasi_static(6, 20).at_positions(24).about_extremes(768);
        let scene = own.applied_to(&scene);
        let bodies = Bodies::new(&scene).unwrap();
        let radius = bodies.geometry.sun.as_ref().unwrap().base_radius;
        let cycle = |settings| cycle_with(&scene, &bodies, &case, settings).unwrap();
        let (found, even) = (cycle(own), cycle(own.at_positions(96).about_extremes(96)));
        let te = |cycle: &SetCycle| cycle.transmission_error(radius);
        let asked = CycleRequest { value: CycleValue::PeakToPeak, tolerance_percent: 1.0 };
        let answer = transmission_error_with(&scene, &case, own, &asked).unwrap();
        assert_eq!(1e6 * te(&found).peak_to_peak(), answer);
        let positions: Vec<f64> = found.states.iter().map(|s| s.position).collect();
        assert!(positions.is_sorted() && (28..80).contains(&positions.len()), "{positions:?}");
        // Mean and root mean square about it, if all positions counted alike.
        let alike = |cycle: &SetCycle| {
            let values: Vec<f64> =
                cycle.states.iter().map(|s| s.transmission_error(radius)).collect();
            let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
            let own = mean(&values);
            (own, mean(&values.iter().map(|v| (v - own).powi(2)).collect::<Vec<_>>()).sqrt())
        };
        let by_parts = |cycle: &SetCycle| (te(cycle).mean, radius * cycle.sun_rms().0);
        let off = |(mean, rms): (f64, f64)| {
            let (of_mean, of_rms) = by_parts(&even);
            [(mean - of_mean).abs() / te(&even).peak_to_peak(), (rms / of_rms - 1.0).abs()]
        };
        let (own, plain) = (off(by_parts(&found)), off(alike(&found)));
        println!(
            "means of peak to peak, root mean squares: {own:.4?}, if all count alike {plain:.4?}"
        );
        assert!(own[0] < 0.01 && plain[0] > 5.0 * own[0], "{own:?} {plain:?}");
        assert!(own[1] < 0.08 && plain[1] > 5.0 * own[1], "{own:?} {plain:?}");
        assert!(off(alike(&even)).iter().all(|off| *off < 1e-12));
    }
}
