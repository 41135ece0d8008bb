//! Speeds at which a set is pushed hardest: the resonance that takes most from the mesh forces, and the one whose
//! transient is slowest.

use dynamics::Multiplier;
use scene::LoadCase;

use super::map::MapError;
use crate::sweep::{
    Direction, Memory, Plan, Steady, SteadySettings, SweepError, SweepModel, SweepPoint,
    left_of_transient, run, steady,
};

/// Mesh frequencies among which resonances are sought, Hz, and the step between them as a part.
const SOUGHT_HZ: [f64; 2] = [400.0, 3000.0];
const STEP: f64 = 0.015;

/// Times the bracket of a speed loses a third: to 1e-5 of it.
const NARROWINGS: usize = 20;

/// Speed (rpm) at which the lowest mesh force is lowest at the scene's own damping.
pub(super) fn strongest(model: &dyn SweepModel) -> Result<f64, MapError> {
    first_by(model, |p| p.lowest_force_n)
}

/// Speed (rpm) at which the part of a transient that decays last is largest beside its change from cycle to cycle: at
/// another it turns over from cycle to cycle, and shows.
pub(super) fn slowest(model: &dyn SweepModel) -> Result<f64, MapError> {
    let near = first_by(model, |p| {
        let last = p.multipliers.first().map(|[re, im]| Multiplier { re: *re, im: *im });
        -left_of_transient(last.as_slice())
    })?;
    let left = |rpm: f64| -> Result<f64, MapError> {
        let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
        let found = from_rest(model, &model.case().at_speed(rpm), 1.0, &settings)?;
        Ok(left_of_transient(found.multipliers.get(..1).unwrap_or_default()))
    };
    // The multiplier turns by 2π l for a change of the speed by the whole: one maximum within two of the steps above.
    let (mut low, mut high) = ((1.0 - STEP) * near, (1.0 + STEP) * near);
    for _ in 0..NARROWINGS {
        let third = (high - low) / 3.0;
        if left(low + third)? < left(high - third)? { low += third } else { high -= third }
    }
    Ok(0.5 * (low + high))
}

/// The steady motion to which a set at rest comes with every damping times a factor.
pub(super) fn from_rest(
    model: &dyn SweepModel,
    case: &LoadCase,
    factor: f64,
    settings: &SteadySettings,
) -> Result<Steady, MapError> {
    let mut set = model.turning_damped(case, factor, 0)?;
    set.rest()?;
    let (steps, first) = (model.steps_per_cycle(), model.first_planet_rad());
    Ok(steady(set.as_mut(), model.shape(), first, steps, settings)?)
}

/// Speed (rpm) of the motion that attracts with the least of something.
fn first_by(model: &dyn SweepModel, of: fn(&SweepPoint) -> f64) -> Result<f64, MapError> {
    let per_rpm = model.case().mesh_frequency_per_rpm_hz();
    let count = ((SOUGHT_HZ[1] / SOUGHT_HZ[0]).ln() / STEP).ceil() as i32;
    let speeds: Vec<f64> =
        (0..=count).map(|k| SOUGHT_HZ[0] * (STEP * f64::from(k)).exp() / per_rpm.abs()).collect();
    let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let plan = Plan::new(&speeds, &[Direction::Up], settings).map_err(SweepError::from)?;
    let swept = run(model, &plan, &Memory, &|_| ())?;
    let attract = swept.points().into_iter().filter(|p| p.attracts.is_shown());
    let found = attract.min_by(|a, b| of(a).total_cmp(&of(b)));
    found.map(|p| p.state.case.speed_rpm).ok_or(MapError::NoOperation)
}
