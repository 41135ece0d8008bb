//! What the inertia of elastic displacements, which quasi-static bodies lack, changes of a steady state, to first order.

use std::f64::consts::TAU;

use fe_contact::vibration::{ElasticInertia, ElasticLoad, RaceMode};
use gearset::AutoResponse;
use nalgebra::Complex;

use super::amplitude_run::Turning;
use super::energy::ModeEnergy;
use super::response::Harmonics;
use crate::error::ExperimentError;

/// Effects of one kind each in [`ElasticLoad`].
const EFFECTS: usize = 4;

/// Change of a response by what quasi-static bodies lack.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ElasticResponse {
    /// Root mean square of the change in the harmonics that are kept, m.
    pub(super) change: f64,
    /// Root of the sum of squares of what each effect changes by itself, m: effects may cancel.
    pub(super) effects: f64,
}

/// The change at one speed, in rpm, of the response `top` there. `None` where nothing is known of it: the teeth of a gear are not
/// meshed alike, or a harmonic with more than `matters` of the mean square is above the first mode of a body with its race
/// held.
///
/// Each harmonic l of the loads on the modes ([`ElasticLoad`]) over a cycle of the steady state moves the response by
///
/// ```text
/// δX_l = Σ_i φ_i f_il/(ω_i² − ω² + 2i ζ_i ω_i ω) · 1/(1 − (ω/ω_1)²),   ω = 2π l f_m
/// ```
///
/// with the modes i of the set linearised at rest at position 0; ω_1 belongs to the first mode of a body with its race held.
///
/// # Errors
/// If the set cannot be linearised or its motion does not become steady again.
pub(super) fn elastic_response(
    turning: &Turning<'_>,
    modes: &[ModeEnergy],
    (rpm, top): (f64, &Harmonics),
    matters: f64,
) -> Result<Option<ElasticResponse>, ExperimentError> {
    let set = turning.standing()?;
    let linear = set.linearised()?;
    let Some(inertia) = ElasticInertia::new(&set)? else { return Ok(None) };
    let own = modes.iter().map(|m| ((TAU * m.frequency_hz).powi(2), m.shape.as_slice()));
    let modes = ElasticInertia::race_modes(&set, &linear, own)?;
    let loads = turning.over_cycle(rpm, |set| Ok(inertia.loads(set, &modes)?))?;
    let omega_m = TAU * turning.mesh_hz(rpm);
    let coordinates: &[usize] = match turning.response() {
        AutoResponse::TransmissionError => &[2],
        AutoResponse::SunTranslation => &[0, 1],
    };
    let (mut squares, mut of_effects) = (0.0, 0.0);
    for (share, l) in top.shares().into_iter().zip(1u32..) {
        let omega = f64::from(l) * omega_m;
        let quotient = omega * omega / inertia.first();
        if quotient >= 1.0 {
            if share > matters {
                return Ok(None);
            }
            continue;
        }
        let effects = changes((&modes, &loads), l, omega);
        for k in coordinates {
            let each = effects.map(|effect| effect[*k] / (1.0 - quotient));
            squares += 0.5 * each.iter().sum::<Complex<f64>>().norm_sqr();
            of_effects += 0.5 * each.iter().map(Complex::norm_sqr).sum::<f64>();
        }
    }
    Ok(Some(ElasticResponse { change: squares.sqrt(), effects: of_effects.sqrt() }))
}

/// What each effect moves the sun by in harmonic l of its loads at the steps of a cycle, in circular frequency `omega`: along x
/// and y, and rotation times base radius, m.
fn changes(
    (modes, loads): (&[RaceMode], &[Vec<ElasticLoad>]),
    l: u32,
    omega: f64,
) -> [[Complex<f64>; 3]; EFFECTS] {
    let steps = loads.len() as f64;
    let mut sum = [[Complex::new(0.0, 0.0); 3]; EFFECTS];
    for (i, mode) in modes.iter().enumerate() {
        let mut lines = [Complex::new(0.0, 0.0); EFFECTS];
        for (load, n) in loads.iter().zip(1u32..) {
            let turned = Complex::cis(-TAU * f64::from(l) * f64::from(n) / steps) * (2.0 / steps);
            // f = −d²/dt² of the first two
            let squared = omega * omega;
            let ElasticLoad { pressed, accelerated, opened, coupled } = load[i];
            let forces = [squared * pressed, squared * accelerated, opened, coupled];
            lines.iter_mut().zip(forces).for_each(|(line, f)| *line += turned * f);
        }
        let stiffness = Complex::new(mode.lambda - omega * omega, mode.damping * omega);
        for (effect, line) in sum.iter_mut().zip(lines) {
            effect.iter_mut().zip(mode.sun).for_each(|(x, phi)| *x += line / stiffness * phi);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use gearset::{LoadCase, Scene};

    use super::super::amplitude::{AmplitudeRequest, amplitude_with};
    use super::super::amplitude_run::on;
    use super::super::energy::of_linear;
    use super::super::settings::AutoSettings;
    use super::*;
    use crate::sweep::SteadySettings;

    /// A load that is even over the cycle moves nothing, and one along cos(l τ) of a mode far above the speed moves the sun by
    /// its static deflection in harmonic l alone.
    #[test]
    fn a_load_moves_the_sun_in_its_own_harmonic() {
        let mode = RaceMode::of_sun([0.0, 0.0, 2.0], 1e8, 0.0);
        let of = |f: &dyn Fn(f64) -> f64| -> Vec<Vec<ElasticLoad>> {
            let at =
                |n: usize| ElasticLoad { coupled: f(TAU * n as f64 / 24.0), ..Default::default() };
            (1..=24).map(|n| vec![at(n)]).collect()
        };
        let loads = of(&|t| 7.0 + 3.0 * (2.0 * t).cos());
        for l in 1..=5 {
            let moved = changes((std::slice::from_ref(&mode), &loads), l, 1.0)[3][2];
            let expected = if l == 2 { 2.0 * 3.0 / 1e8 } else { 0.0 };
            assert!((moved.re - expected).abs() < 1e-7 * 6e-8 + 1e-20, "{l}: {moved}");
        }
    }

    /// Changes of both responses of OH-58 with four planets at some speeds, by so many modes of each body and to first order: each
    /// within a factor of two of the other.
    fn compared(modes: u32, steps: u32, speeds_rpm: &[f64]) {
        let path = format!("{}/../scenes/oh58_4p.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = Scene::from_file(path.as_ref()).unwrap();
        let case = LoadCase::of_scene(&scene).unwrap();
        for response in [AutoResponse::TransmissionError, AutoResponse::SunTranslation] {
            let request = AmplitudeRequest {
                response,
                speeds_rpm: speeds_rpm.to_vec(),
                steady: SteadySettings { between_cycles: 0, ..SteadySettings::default() },
                tolerance_percent: 1.0,
            };
            let rigid = AutoSettings::quasi_static(6, 20).with_steps(steps);
            let of = |settings| amplitude_with(&scene, &case, settings, &request).unwrap();
            let (with, without) =
                (of(AutoSettings::modal(modes, 6, 20).with_steps(steps)), of(rigid));
            let predicted = on((&scene, &case), rigid, &request, |turning| {
                let motions = turning.motions(speeds_rpm)?;
                let set = turning.standing()?;
                let own = of_linear(&set, &set.linearised()?)?;
                let one = |(rpm, top)| elastic_response(turning, &own, (rpm, top), 1e-3);
                let list = speeds_rpm.iter().copied().zip(motions.responses());
                list.map(one).collect::<Result<Vec<_>, _>>()
            });
            let predicted = predicted.unwrap().into_iter().map(|own| own.unwrap().change);
            for (((rpm, predicted), with), without) in
                speeds_rpm.iter().zip(predicted).zip(&with).zip(&without)
            {
                let apart = with.iter().zip(without).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]));
                let seen = 1e-6 * apart.map(|x| 0.5 * x * x).sum::<f64>().sqrt();
                println!("{response:?} {rpm} rpm: {seen:.3e} m by modes, {predicted:.3e} m");
                let ratio = seen / predicted;
                assert!((0.5..2.0).contains(&ratio), "{response:?} {rpm}: {ratio}");
            }
        }
    }

    /// Four modes of each body keep most of the change at these speeds.
    #[test]
    fn modes_change_a_motion_by_about_what_first_order_says() {
        compared(4, 60, &[1500.0, 2500.0]);
    }

    /// The table of `docs/auto.md`, three minutes.
    #[test]
    #[ignore = "three minutes"]
    fn thirty_modes_change_motions_by_about_what_first_order_says() {
        compared(30, 240, &[700.0, 1100.0, 1500.0, 2000.0, 2500.0, 3000.0, 4000.0]);
    }
}
