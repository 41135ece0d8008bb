//! What the inertia of elastic displacements, which quasi-static bodies lack, changes of a steady state, to first order.

use std::f64::consts::TAU;

use dynamics::PeriodicTerm;
use fe_contact::vibration::{ElasticCarrier, ElasticGears, ElasticLoad, VibratingSet};
use nalgebra::{Complex, DMatrix, DVector};

use super::amplitude_run::{Motions, Turning};
use super::linear_motion::{Further, HARMONICS, LinearMotion, StepOfCycle, line};
use super::response::Harmonics;
use crate::error::ExperimentError;

/// Harmonics with a smaller share of the mean square are left out where they have no estimate: one that is off by all of
/// itself changes the root mean square by half of its share.
pub(super) const MATTERS: f64 = 1e-3;

/// A response with what quasi-static bodies lack.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ElasticResponse {
    with: Harmonics,
    without: Harmonics,
}

impl ElasticResponse {
    /// Root mean square of the change, m.
    pub(super) fn rms(&self) -> f64 {
        self.with.distance(&self.without)
    }

    /// Root mean square of the response with this change over that without it.
    pub(super) fn growth(&self) -> f64 {
        self.with.rms() / self.without.rms()
    }
}

/// Largest ω²/ω_1² of a harmonic or a mode that is known to first order: there the next term of the series is half as large.
pub(super) const SLOW: f64 = 0.5;

/// The motion `motions` with this change at the speed of its largest response. `None` where nothing is known of it: the teeth of a gear are not
/// meshed alike, or a harmonic that matters is near or above the first mode of a gear with its race held.
///
/// With the load f on the races over a cycle of the steady state and its change V δx by that of the motion ([`ElasticLoad`], and of the carrier
/// [`ElasticCarrier`]) the change is the response of the set linearised about its motion,
///
/// ```text
/// M δẍ + C δẋ + (K(t) − V(t)) δx = f(t)
/// ```
///
/// and to the forces that the frequency of the time steps leaves, in all harmonics that the linearised motion has: those that are not asked for are coupled to them by the stiffness. Displacements of gears by accelerations, and
/// accelerations of displacements, of harmonic l are larger by 1/(1 − (ω/ω_1)²), ω = 2π l f_m; ω_1 belongs to the
/// first mode of a gear with its race held. Load and change of harmonics that are near this mode are left out.
///
/// # Errors
/// If the set cannot be linearised or a step fails.
pub(super) fn elastic_response(
    turning: &Turning<'_>,
    motions: &Motions,
) -> Result<Option<ElasticResponse>, ExperimentError> {
    let unknown = || ExperimentError::Incomplete("steady state");
    let standing = turning.standing()?;
    let Some(gears) = ElasticGears::new(&standing)? else { return Ok(None) };
    let (rpm, top) = motions.top().ok_or_else(unknown)?;
    let omega = TAU * turning.mesh_hz(*rpm);
    let slow = Slow { omega, first: gears.first() };
    let mut shares = top.shares().into_iter().zip(1..);
    if shares.any(|(share, l)| share > MATTERS && slow.raised(l) == 0.0) {
        return Ok(None);
    }
    let cycle = turning.over_cycle(motions, *rpm, |set| {
        let step = StepOfCycle::of(set)?;
        let load = gears.load(set, &step.tangent)?;
        Ok((step, (load, DVector::from_column_slice(&set.motion().a))))
    })?;
    let (steps, loads): (Vec<_>, Vec<_>) = cycle.into_iter().unzip();
    let (loads, accelerations): (Vec<_>, Vec<_>) = loads.into_iter().unzip();
    let mass = gears.mass(&standing, &loads, TAU / (omega * loads.len() as f64));
    let carrier = of_carrier(&standing, omega)?;
    let dynamic: Vec<_> = carrier.iter().map(|lacking| -lacking).collect();
    let factors = slow.factors();
    let samples = Samples::new(&loads, mass.masses);
    let further = Further { dynamic: &dynamic, terms: &samples.terms(&factors) };
    let linear = LinearMotion::with_terms(&steps, omega / TAU, &further)?;
    let momentum =
        loads.iter().zip(&accelerations).map(|(load, a)| &load.pressed - &load.accelerated * a);
    let opened = loads.iter().zip(&accelerations).map(|(load, a)| &load.opened * a);
    let (momentum, opened) = (momentum.collect::<Vec<_>>(), opened.collect::<Vec<_>>());
    let coupled: Vec<_> = loads.iter().map(|load| load.coupled.clone()).collect();
    let force = |(l, x): (usize, &DVector<Complex<f64>>)| {
        let by = |samples: &[DVector<f64>], factor: f64| line(samples, l) * Complex::from(factor);
        // Of the momentum minus the second derivative in time acts.
        let of_gears = by(&momentum, factors.second[l])
            + by(&opened, factors.raised[l])
            + by(&coupled, factors.kept[l])
            + by(&mass.forces, factors.raised[l]);
        match carrier.get(l) {
            Some(lacking) => of_gears + lacking * x,
            None => of_gears,
        }
    };
    let of_bodies = linear.lines().iter().enumerate().map(force);
    let forces: Vec<_> = of_bodies.zip(linear.step_forces()).map(|(a, b)| a + b).collect();
    let changed = linear.changed_by(&forces)?;
    let rest = turning.at_rest()?;
    let of = |l: usize| changed.get(l).map_or_else(Vec::new, |x| rest.response(x));
    let with = motions.in_steps(*rpm).ok_or_else(unknown)?.changed(of);
    Ok(Some(ElasticResponse { with, without: top.clone() }))
}

/// V of the carrier by harmonic from 0; none if it is rigid.
fn of_carrier(
    standing: &VibratingSet<'_>,
    omega: f64,
) -> Result<Vec<DMatrix<Complex<f64>>>, ExperimentError> {
    let Some(carrier) = ElasticCarrier::new(standing) else { return Ok(Vec::new()) };
    let why = "a harmonic is at a resonance of the carrier, which has no damping";
    let undamped = || ExperimentError::Model(why.into());
    (0..=HARMONICS).map(|l| carrier.lacking(l as f64 * omega).ok_or_else(undamped)).collect()
}

/// How slow harmonics are beside the first mode of a gear.
struct Slow {
    /// Mesh frequency, rad/s.
    omega: f64,
    /// ω_1², (rad/s)².
    first: f64,
}

impl Slow {
    /// 1/(1 − (lω/ω_1)²), and 0 for harmonics that are left out.
    fn raised(&self, l: usize) -> f64 {
        let quotient = (l as f64 * self.omega).powi(2) / self.first;
        if quotient < SLOW { 1.0 / (1.0 - quotient) } else { 0.0 }
    }

    fn factors(&self) -> Factors {
        let of = |of: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            (0..=HARMONICS).map(|l| of((l as f64 * self.omega).powi(2), self.raised(l))).collect()
        };
        let kept = |raised: f64| if raised > 0.0 { 1.0 } else { 0.0 };
        Factors {
            kept: of(&|_, raised| kept(raised)),
            raised: of(&|_, raised| raised),
            second: of(&|square, raised| square * raised),
            minus: of(&|_, raised| -kept(raised)),
            minus_second: of(&|square, raised| -square * raised),
            minus_fourth: of(&|square, raised| -square * square * raised),
        }
    }
}

/// Factors by harmonic from 0 (ω: its circular frequency, s: what it is larger by), 0 for those that are left out.
struct Factors {
    /// 1
    kept: Vec<f64>,
    /// s
    raised: Vec<f64>,
    /// ω² s
    second: Vec<f64>,
    /// −1
    minus: Vec<f64>,
    /// −ω² s
    minus_second: Vec<f64>,
    /// −ω⁴ s
    minus_fourth: Vec<f64>,
}

/// What the gears' loads change by with the motion, at the steps of a cycle.
struct Samples {
    /// Tᵀ
    pressed: Vec<DMatrix<f64>>,
    /// T
    opened: Vec<DMatrix<f64>>,
    /// A
    accelerated: Vec<DMatrix<f64>>,
    /// Y
    coupling: Vec<DMatrix<f64>>,
    /// Gᵀ z G
    mass: Vec<DMatrix<f64>>,
}

impl Samples {
    fn new(loads: &[ElasticLoad], mass: Vec<DMatrix<f64>>) -> Self {
        let of = |of: &dyn Fn(&ElasticLoad) -> DMatrix<f64>| loads.iter().map(of).collect();
        Self {
            pressed: of(&|load| load.opened.transpose()),
            opened: of(&|load| load.opened.clone()),
            accelerated: of(&|load| load.accelerated.clone()),
            coupling: of(&|load| load.coupling.clone()),
            mass,
        }
    }

    /// −V = ω² Tᵀ + T ω² − ω⁴ A − Y − ω² Gᵀ z G
    fn terms<'a>(&'a self, factors: &'a Factors) -> [PeriodicTerm<'a>; 5] {
        let Factors { kept, second, minus, minus_second, minus_fourth, .. } = factors;
        [
            PeriodicTerm { samples: &self.pressed, motion: kept, force: second },
            PeriodicTerm { samples: &self.opened, motion: second, force: kept },
            PeriodicTerm { samples: &self.accelerated, motion: kept, force: minus_fourth },
            PeriodicTerm { samples: &self.coupling, motion: kept, force: minus },
            PeriodicTerm { samples: &self.mass, motion: minus_second, force: kept },
        ]
    }
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
    /// within a factor of two of the other, and apart by no more than a part of the larger one.
    fn compared(modes: u32, steps: u32, speeds_rpm: &[f64], part: f64) {
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
                let complex = |[re, im]: [f64; 2]| Complex::new(re, im);
                let seen = with.iter().zip(without).map(|(a, b)| complex(*a) - complex(*b));
                let lines = predicted.with.lines().iter().zip(predicted.without.lines());
                let first_order = lines.map(|(a, b)| 1e6 * (complex(*a) - complex(*b)));
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
                assert!(off < part * seen.max(predicted), "{response:?} {rpm}: {off}");
            }
        }
    }

    /// Four modes of each body keep most of the change at these speeds.
    #[test]
    fn modes_change_a_motion_by_about_what_first_order_says() {
        compared(4, 60, &[1500.0, 2500.0], 0.7);
    }

    /// The table of `docs/auto.md`.
    #[test]
    #[ignore = "thirteen minutes"]
    fn sixty_modes_change_motions_as_first_order_says() {
        compared(60, 240, &[700.0, 1100.0, 1500.0, 2000.0, 2500.0, 3000.0, 4000.0], 0.3);
    }

    /// A steady motion without damping is the same backwards in time, and a set under the reversed torque that
    /// turns the other way moves as its mirror image backwards in time. With a tenth of its damping OH-58 is
    /// loaded by the inertia of its elastic displacements alike in both, although the steps fall otherwise where
    /// pairs begin to touch.
    #[test]
    fn inertia_of_displacements_is_the_same_in_the_reversed_machine() {
        let (mut scene, case, request) = oh58(AutoResponse::TransmissionError, &[2000.0]);
        scene.damping = scene.damping.times(0.1);
        let reversed = case.with_sun_torque(-case.sun_torque_nm).in_direction(case.direction());
        let own = AutoSettings::quasi_static(6, 20).with_steps(120);
        let [one, other] = [case, reversed].map(|case| {
            let found = on((&scene, &case), own, &request, |turning| {
                let motions = turning.motions_in_steps(&request.speeds_rpm)?;
                let standing = turning.standing()?;
                let gears = ElasticGears::new(&standing)?.unwrap();
                let load = |set: &VibratingSet<'_>| Ok(gears.load(set, &set.tangent()?)?);
                let cycle = turning.over_cycle(&motions, 2000.0, load)?;
                let step_s = 1.0 / (turning.mesh_hz(2000.0) * cycle.len() as f64);
                let mass = gears.mass(&standing, &cycle, step_s);
                Ok((1..=HARMONICS).map(|l| line(&mass.forces, l).norm()).collect::<Vec<_>>())
            });
            found.unwrap()
        });
        println!("{one:.2?}\n{other:.2?}");
        let norm = |of: &dyn Fn(f64, f64) -> f64| {
            one.iter().zip(&other).map(|(a, b)| of(*a, *b).powi(2)).sum::<f64>().sqrt()
        };
        let off = norm(&|a, b| a - b) / norm(&|a, _| a);
        assert!(off < 0.1, "{off}");
    }
}
