//! What the inertia of elastic displacements, which quasi-static bodies lack, changes of a steady state, to first order.

use std::f64::consts::TAU;

use fe_contact::vibration::{ElasticInertia, ElasticLoad, RaceMode};
use nalgebra::Complex;

use super::amplitude_run::Turning;
use super::response::Harmonics;
use crate::error::ExperimentError;

/// Effects of one kind each in [`ElasticLoad`].
const EFFECTS: usize = 4;

/// Harmonics with a smaller share of the mean square are left out where they have no estimate: one that is off by all of
/// itself changes the root mean square by half of its share.
pub(super) const MATTERS: f64 = 1e-3;

/// Change of a response by what quasi-static bodies lack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ElasticResponse {
    /// By harmonic from 1, then by coordinate, m.
    lines: Vec<Vec<Complex<f64>>>,
}

impl ElasticResponse {
    /// Root mean square in the harmonics that are kept, m.
    pub(super) fn rms(&self) -> f64 {
        self.lines.iter().flatten().map(|line| 0.5 * line.norm_sqr()).sum::<f64>().sqrt()
    }

    /// Root mean square of a response with this change over that without it.
    pub(super) fn growth_of(&self, response: &Harmonics) -> f64 {
        let with = response.changed(|l| self.lines.get(l - 1).cloned().unwrap_or_default());
        with.rms() / response.rms()
    }
}

/// The change at one speed, in rpm, of the response `top` there. `None` where nothing is known of it: the teeth of a gear are not
/// meshed alike, or a harmonic that matters is above the first mode of a body with its race held.
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
    (rpm, top): (f64, &Harmonics),
) -> Result<Option<ElasticResponse>, ExperimentError> {
    let Some(inertia) = ElasticInertia::new(&turning.standing()?)? else { return Ok(None) };
    let modes = turning.modes()?;
    let loads = turning.over_cycle(rpm, |set| Ok(inertia.loads(set, &modes.races)?))?;
    let omega_m = TAU * turning.mesh_hz(rpm);
    let mut lines = Vec::new();
    for (share, l) in top.shares().into_iter().zip(1u32..) {
        let omega = f64::from(l) * omega_m;
        let quotient = omega * omega / inertia.first();
        let mut sum = vec![Complex::new(0.0, 0.0); top.coordinates()];
        if quotient < 1.0 {
            for effect in changes((&modes.races, &modes.responses), &loads, l, omega) {
                sum.iter_mut().zip(effect).for_each(|(sum, own)| *sum += own / (1.0 - quotient));
            }
        } else if share > MATTERS {
            return Ok(None);
        }
        lines.push(sum);
    }
    Ok(Some(ElasticResponse { lines }))
}

/// What each effect moves the response by in harmonic l of its loads at the steps of a cycle, in circular frequency `omega`, m;
/// `responses`: what each mode moves it by.
fn changes(
    (modes, responses): (&[RaceMode], &[Vec<f64>]),
    loads: &[Vec<ElasticLoad>],
    l: u32,
    omega: f64,
) -> [Vec<Complex<f64>>; EFFECTS] {
    let steps = loads.len() as f64;
    let coordinates = responses.first().map_or(0, Vec::len);
    let mut sum = [const { Vec::new() }; EFFECTS];
    sum.iter_mut().for_each(|own| own.resize(coordinates, Complex::new(0.0, 0.0)));
    for (i, (mode, response)) in modes.iter().zip(responses).enumerate() {
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
            effect.iter_mut().zip(response).for_each(|(x, phi)| *x += line / stiffness * *phi);
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use gearset::AutoResponse;

    use super::super::amplitude::stepped_amplitude_with;
    use super::super::amplitude::tests::oh58;
    use super::super::amplitude_run::on;
    use super::super::settings::AutoSettings;
    use super::*;

    /// A load that is even over the cycle moves nothing, and one along cos(l τ) of a mode far above the speed moves the sun by
    /// its static deflection in harmonic l alone.
    #[test]
    fn a_load_moves_the_sun_in_its_own_harmonic() {
        let mode = RaceMode::of(1e8, 0.0);
        let response = [vec![2.0]];
        let of = |f: &dyn Fn(f64) -> f64| -> Vec<Vec<ElasticLoad>> {
            let at =
                |n: usize| ElasticLoad { coupled: f(TAU * n as f64 / 24.0), ..Default::default() };
            (1..=24).map(|n| vec![at(n)]).collect()
        };
        let loads = of(&|t| 7.0 + 3.0 * (2.0 * t).cos());
        for l in 1..=5 {
            let moved = changes((std::slice::from_ref(&mode), &response), &loads, l, 1.0)[3][0];
            let expected = if l == 2 { 2.0 * 3.0 / 1e8 } else { 0.0 };
            assert!((moved.re - expected).abs() < 1e-7 * 6e-8 + 1e-20, "{l}: {moved}");
        }
    }

    /// Changes of both responses of OH-58 with four planets at some speeds, by so many modes of each body and to first order: each
    /// within a factor of two of the other.
    fn compared(modes: u32, steps: u32, speeds_rpm: &[f64]) {
        for response in [AutoResponse::TransmissionError, AutoResponse::SunTranslation] {
            let (scene, case, request) = oh58(response, speeds_rpm);
            let rigid = AutoSettings::quasi_static(6, 20).with_steps(steps);
            let of = |settings| stepped_amplitude_with(&scene, &case, settings, &request).unwrap();
            let (with, without) =
                (of(AutoSettings::modal(modes, 6, 20).with_steps(steps)), of(rigid));
            let predicted = on((&scene, &case), rigid, &request, |turning| {
                let motions = turning.motions(speeds_rpm)?;
                let one = |(rpm, top)| elastic_response(turning, (rpm, top));
                let list = speeds_rpm.iter().copied().zip(motions.stepped());
                list.map(one).collect::<Result<Vec<_>, _>>()
            });
            let predicted = predicted.unwrap().into_iter().map(|own| own.unwrap().rms());
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
