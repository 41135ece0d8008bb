//! What the inertia of elastic displacements, which quasi-static bodies lack, changes of a steady state, to first order.

use std::f64::consts::TAU;

use dynamics::PeriodicTerm;
use fe_contact::vibration::{ElasticInertia, ElasticLoad};
use nalgebra::{Complex, DMatrix, DVector};

use super::amplitude_run::{Motions, Turning};
use super::linear_motion::{LinearMotion, StepOfCycle, line};
use super::response::Harmonics;
use crate::error::ExperimentError;

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

/// The change of the motion `motions` at the speed of its largest response. `None` where nothing is known of it: the teeth of a gear are not
/// meshed alike, or a harmonic that matters is above the first mode of a body with its race held.
///
/// With the load f on the races over a cycle of the steady state and its change V δx by that of the motion ([`ElasticLoad`]) the change is the response of
/// the set linearised about its motion,
///
/// ```text
/// M δẍ + C δẋ + (K(t) − V(t)) δx = f(t)
/// ```
///
/// where displacements by accelerations, and accelerations of displacements, of harmonic l are larger by 1/(1 − (ω/ω_1)²), ω = 2π l f_m; ω_1 belongs to the
/// first mode of a body with its race held. Load and change of harmonics that are not kept, or above this mode, are left out.
///
/// # Errors
/// If the set cannot be linearised or a step fails.
pub(super) fn elastic_response(
    turning: &Turning<'_>,
    motions: &Motions,
) -> Result<Option<ElasticResponse>, ExperimentError> {
    let unknown = || ExperimentError::Incomplete("steady state");
    let Some(inertia) = ElasticInertia::new(&turning.standing()?)? else { return Ok(None) };
    let (rpm, top) = motions.top().ok_or_else(unknown)?;
    let mesh_hz = turning.mesh_hz(*rpm);
    let quotient = |l: usize| (TAU * mesh_hz * l as f64).powi(2) / inertia.first();
    let is_above = |(share, l): (f64, usize)| share > MATTERS && quotient(l) >= 1.0;
    if top.shares().into_iter().zip(1..).any(is_above) {
        return Ok(None);
    }
    let cycle = turning.over_cycle(motions, *rpm, |set| {
        let step = StepOfCycle::of(set)?;
        let load = inertia.load(set, &step.tangent)?;
        Ok((step, load, DVector::from_column_slice(&set.motion().a)))
    })?;
    let loads: Vec<ElasticLoad> = cycle.iter().map(|(_, load, _)| load.clone()).collect();
    let highest = top.shares().len();
    let by_harmonic = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        let own = |l: usize| {
            let quotient = quotient(l);
            let square = quotient * inertia.first();
            if quotient < 1.0 { of(square, 1.0 / (1.0 - quotient)) } else { 0.0 }
        };
        (0..=highest).map(own).collect()
    };
    let kept = by_harmonic(&|_, _| 1.0);
    let raised = by_harmonic(&|_, raised| raised);
    let second = by_harmonic(&|square, raised| square * raised);
    let minus_fourth = by_harmonic(&|square, raised| -square * square * raised);
    let minus = by_harmonic(&|_, _| -1.0);
    let matrices = |of: &dyn Fn(&ElasticLoad) -> DMatrix<f64>| -> Vec<DMatrix<f64>> {
        loads.iter().map(of).collect()
    };
    let opened = matrices(&|load| load.opened.clone());
    let pressed = matrices(&|load| load.opened.transpose());
    let accelerated = matrices(&|load| load.accelerated.clone());
    let coupling = matrices(&|load| load.coupling.clone());
    // −V = ω² Tᵀ + T ω² − ω⁴ A − Y
    let terms = [
        PeriodicTerm { samples: &pressed, motion: &kept, force: &second },
        PeriodicTerm { samples: &opened, motion: &second, force: &kept },
        PeriodicTerm { samples: &accelerated, motion: &kept, force: &minus_fourth },
        PeriodicTerm { samples: &coupling, motion: &kept, force: &minus },
    ];
    let vectors = |of: &dyn Fn(&ElasticLoad, &DVector<f64>) -> DVector<f64>| -> Vec<DVector<f64>> {
        cycle.iter().map(|(_, load, a)| of(load, a)).collect()
    };
    let momentum = vectors(&|load, a| &load.pressed - &load.accelerated * a);
    let given = vectors(&|load, a| &load.opened * a);
    let coupled = vectors(&|load, _| load.coupled.clone());
    let force = |l: usize| {
        // The first acts by minus its second derivative in time.
        line(&momentum, l) * Complex::from(second[l])
            + line(&given, l) * Complex::from(raised[l])
            + line(&coupled, l) * Complex::from(kept[l])
    };
    let forces: Vec<_> = (0..=highest).map(force).collect();
    let steps: Vec<StepOfCycle> = cycle.into_iter().map(|(step, ..)| step).collect();
    let changed = LinearMotion::with_terms(&steps, mesh_hz, &terms)?.changed_by(&forces)?;
    let rest = turning.at_rest()?;
    let lines = changed.iter().skip(1).take(highest).map(|x| rest.response(x)).collect();
    Ok(Some(ElasticResponse { lines }))
}

#[cfg(test)]
mod tests {
    use gearset::AutoResponse;

    use super::super::amplitude::stepped_amplitude_with;
    use super::super::amplitude::tests::oh58;
    use super::super::amplitude_run::on;
    use super::super::settings::AutoSettings;
    use super::*;

    /// Changes of both responses of OH-58 with four planets at some speeds, by so many modes of each body and to first order: each
    /// within a factor of two of the other, and apart by no more than seven tenths of the larger one.
    fn compared(modes: u32, steps: u32, speeds_rpm: &[f64]) {
        for response in [AutoResponse::TransmissionError, AutoResponse::SunTranslation] {
            let (scene, case, request) = oh58(response, speeds_rpm);
            let rigid = AutoSettings::quasi_static(6, 20).with_steps(steps);
            let of = |settings| stepped_amplitude_with(&scene, &case, settings, &request).unwrap();
            let (with, without) =
                (of(AutoSettings::modal(modes, 6, 20).with_steps(steps)), of(rigid));
            let predicted = on((&scene, &case), rigid, &request, |turning| {
                let one = |rpm: &f64| elastic_response(turning, &turning.motions(&[*rpm])?);
                speeds_rpm.iter().map(one).collect::<Result<Vec<_>, _>>()
            });
            let predicted = predicted.unwrap().into_iter().map(Option::unwrap);
            for (((rpm, predicted), with), without) in
                speeds_rpm.iter().zip(predicted).zip(&with).zip(&without)
            {
                // By coordinate, then by harmonic, µm.
                let seen =
                    with.iter().zip(without).map(|(a, b)| Complex::new(a[0] - b[0], a[1] - b[1]));
                let coordinates = with.len() / predicted.lines.len();
                let first_order = (0..coordinates)
                    .flat_map(|k| predicted.lines.iter().map(move |line| 1e6 * line[k]));
                let rms = |lines: &mut dyn Iterator<Item = Complex<f64>>| {
                    lines.map(|x| 0.5 * x.norm_sqr()).sum::<f64>().sqrt()
                };
                let off = rms(&mut seen.clone().zip(first_order).map(|(a, b)| a - b));
                let (seen, predicted) = (rms(&mut seen.clone()), 1e6 * predicted.rms());
                println!(
                    "{response:?} {rpm} rpm: {seen:.4} µm by modes, {predicted:.4} to first order, {off:.4} apart"
                );
                let ratio = seen / predicted;
                assert!((0.5..2.0).contains(&ratio), "{response:?} {rpm}: {ratio}");
                assert!(off < 0.7 * seen.max(predicted), "{response:?} {rpm}: {off}");
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
