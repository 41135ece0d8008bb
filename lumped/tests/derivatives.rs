//! Sensitivities against difference quotients, sums of energies, gyroscopic terms against closed forms.

use crate::common;

use std::f64::consts::TAU;

use gearset::{Axis, Body};
use lumped::*;
use scene::Torsional;

use common::{modes, of_type, scene};

/// Mean eigenvalue of the group after changing the model.
fn shifted(model: &LumpedModel, group: usize, change: impl Fn(&mut LumpedModel)) -> f64 {
    let base = NaturalModes::of(model).unwrap();
    let first: usize = base.groups[..group].iter().map(|g| g.multiplicity).sum();
    let mut changed = model.clone();
    change(&mut changed);
    let found = NaturalModes::of(&changed).unwrap();
    let own = &found.lambda[first..first + base.groups[group].multiplicity];
    own.iter().sum::<f64>() / own.len() as f64
}

#[test]
fn sensitivities_are_the_differences_they_stand_for() {
    for name in ["oh58_4p.toml", "lin_parker_1999_4p.toml"] {
        let (model, found) = modes(&scene(name));
        for (index, group) in found.groups.iter().enumerate() {
            if group.lambda == 0.0 {
                continue;
            }
            for s in sensitivities(&model, group) {
                // Small: eigenvalues of close pairs depend nonlinearly on the parameter.
                let relative = 1e-6;
                let change = |sign: f64| {
                    let factor = 1.0 + sign * relative;
                    shifted(&model, index, |m| match &s.parameter {
                        Parameter::Stiffness(id) => {
                            let spring = m.springs.iter_mut().find(|s| s.id == *id).unwrap();
                            spring.stiffness *= factor;
                        }
                        Parameter::StiffnessFamily(name) => {
                            let own = m.springs.iter_mut().filter(|s| s.id.family() == *name);
                            own.for_each(|s| s.stiffness *= factor);
                        }
                        Parameter::Inertia(i) => m.mass[*i] *= factor,
                        Parameter::InertiaFamily(name) => {
                            for i in 0..m.mass.len() {
                                let (body, axis) = m.coordinates.free()[i];
                                let rotary = axis == Axis::Rotation;
                                let what = if rotary { "inertia" } else { "mass" };
                                if *name == format!("{}_{what}", body.kind_name()) {
                                    m.mass[i] *= factor;
                                }
                            }
                        }
                    })
                };
                let difference = (change(1.0) - change(-1.0)) / (2.0 * relative);
                let closed = 2.0 * group.lambda * s.logarithmic;
                let scale = group.lambda;
                assert!(
                    (difference - closed).abs() < 2e-6 * scale,
                    "{name} {:.1} Hz {:?}: {difference:e} {closed:e}",
                    group.frequency_hz,
                    s.parameter
                );
            }
        }
    }
}

#[test]
fn logarithmic_sensitivities_add_up_to_half() {
    // Scaling every stiffness scales λ; scaling every inertia divides it.
    let (model, found) = modes(&scene("oh58_4p.toml"));
    for group in &found.groups {
        let sum = |stiffness: bool| -> f64 {
            sensitivities(&model, group)
                .iter()
                .filter(|s| match s.parameter {
                    Parameter::StiffnessFamily(_) => stiffness,
                    Parameter::InertiaFamily(_) => !stiffness,
                    _ => false,
                })
                .map(|s| s.logarithmic)
                .sum()
        };
        assert!((sum(true) - 0.5).abs() < 1e-9 && (sum(false) + 0.5).abs() < 1e-9);
    }
}

#[test]
fn energies_add_up_to_one() {
    for name in ["oh58_4p.toml", "lin_parker_1999_3p.toml"] {
        let (model, found) = modes(&scene(name));
        for group in &found.groups {
            let kinetic: f64 = kinetic_energy(&model, group).iter().map(|e| e.share).sum();
            assert!((kinetic - 1.0).abs() < 1e-12);
            let strain: f64 = strain_energy(&model, group).iter().map(|e| e.share).sum();
            let expected = if group.lambda > 0.0 { 1.0 } else { 0.0 };
            assert!((strain - expected).abs() < 1e-9, "{} {strain}", group.frequency_hz);
        }
    }
}

#[test]
fn a_standing_carrier_gives_the_natural_frequencies() {
    let (model, found) = modes(&scene("oh58_4p.toml"));
    let still = &campbell(&model, &[0.0]).unwrap()[0];
    for (mode, lambda) in still.modes.iter().zip(&found.lambda) {
        assert!((mode.frequency_hz * TAU / lambda.sqrt() - 1.0).abs() < 1e-9);
        assert!(mode.growth_per_s.abs() < 1e-4);
    }
}

#[test]
fn an_unsupported_set_seen_from_the_carrier_whirls_at_carrier_speed() {
    // Without springs to ground the whole set can be at rest in space: in the rotating frame it moves on a
    // circle at Ω. The eigenvalue is double and defective (the set may also drift), hence the tolerance.
    let mut scene = scene("lin_parker_1999_4p.toml");
    for support in [&mut scene.supports.carrier, &mut scene.supports.ring, &mut scene.supports.sun]
    {
        support.bearing_n_per_m = 0.0;
        support.torsional = Torsional::PerLength(0.0);
    }
    let model = LumpedModel::from_scene(&scene).unwrap();
    let speed = 500.0;
    let result = &campbell(&model, &[speed]).unwrap()[0];
    let nearest = result.modes.iter().map(|m| (m.frequency_hz * TAU - speed).abs());
    assert!(nearest.fold(f64::INFINITY, f64::min) < 1e-2);
}

/// A set that turns freely has the common rotation with s = ±a, a in proportion to the speed: K_Ω acts on the planets'
/// tangential motion. The growing one is found at every speed, whatever the signs of rounding errors. Values:
/// eigenvalues with 40 digits.
#[test]
fn a_pair_of_real_eigenvalues_has_its_growing_member_at_every_speed() {
    let (model, _) = modes(&scene("lin_parker_1999_3p.toml"));
    let rpm: Vec<f64> = (1..=60).map(|k| 50.0 * f64::from(k)).collect();
    let speeds: Vec<f64> = rpm.iter().map(|rpm| rpm * TAU / 60.0).collect();
    for (at, rpm) in campbell(&model, &speeds).unwrap().iter().zip(rpm) {
        let growth = at.largest_growth_per_s();
        assert!((growth / rpm - 0.044_28).abs() < 1e-5, "{rpm} rpm: {growth}");
        assert!(at.is_unstable());
        if rpm == 100.0 {
            assert!((growth - 4.428_303).abs() < 1e-4, "{growth}");
        }
    }
    let last = campbell(&model, &[3000.0 * TAU / 60.0]).unwrap();
    assert!((last[0].largest_growth_per_s() - 132.833_31).abs() < 1e-4);
}

/// The common rotation on a held ring: with the carrier's displacement u_c = 1 at the planets, η = 1, planets roll by
/// u_p = −cos α, and the sun turns by u_s = 2 cos α. K_Ω feeds it by Ω² N m_p:
///
/// ```text
/// a²/Ω² = N m_p/(I_c/r_c² + N m_p + N cos²α I_p/r_p² + 4 cos²α I_s/r_s²)
/// ```
///
/// to second order in Ω over the natural frequencies.
#[test]
fn a_common_rotation_grows_by_the_planets_centripetal_term_alone() {
    let own = scene("lin_parker_1999_3p.toml");
    let lumped = own.lumped.as_ref().unwrap();
    let (model, _) = modes(&own);
    let rotation = |body| model.mass[model.coordinates.of(body, Axis::Rotation).unwrap()];
    let planet = model.mass[model.coordinates.of(Body::Planet(0), Axis::First).unwrap()];
    let cos = lumped.pressure_angle_rad.sun_planet.cos();
    let inertia = rotation(Body::Carrier)
        + 3.0 * planet
        + 3.0 * cos * cos * rotation(Body::Planet(0))
        + 4.0 * cos * cos * rotation(Body::Sun);
    let speed = 100.0 * TAU / 60.0;
    let found = &campbell(&model, &[speed]).unwrap()[0];
    let expected = speed * (3.0 * planet / inertia).sqrt();
    let growth = found.largest_growth_per_s();
    assert!((growth / expected - 1.0).abs() < 1e-4, "{growth}, closed form {expected}");
    assert_eq!(found.growing_hz(), Some(0.0));
}

#[test]
fn gyroscopic_terms_split_the_first_pair_by_about_one_percent() {
    let (model, found) = modes(&scene("oh58_3p.toml"));
    let speed = 2500.0 / 60.0 * TAU * 27.0 / 126.0;
    let first = of_type(&found, ModeType::Translational)[0].0;
    let both = campbell(&model, &[speed, -speed]).unwrap();
    let (low, high) = (both[0].modes[0].frequency_hz, both[0].modes[1].frequency_hz);
    assert!((high - low) / first > 0.015 && (high - low) / first < 0.025, "{low} {first} {high}");
    assert!(low < first && high > first);
    // The other sense of rotation gives the same frequencies.
    for (forward, backward) in both[0].modes.iter().zip(&both[1].modes) {
        assert!((forward.frequency_hz - backward.frequency_hz).abs() < 1e-6);
    }
}
