//! What displacing planets in angle does to frequencies and types of modes, against perturbation theory and symmetry.

use std::f64::consts::TAU;
use std::path::Path;

use lumped::{LumpedModel, ModeGroup, ModeType, NaturalModes, SpacingChange};
use scene::Scene;

/// A scene file of the repository.
fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::from_file(&path).unwrap()
}

/// A set of the size of OH-58 with its planets spaced equally.
fn equally_spaced(name: &str) -> LumpedModel {
    let mut scene = scene(name);
    let count = scene.planets.psi_rad.len();
    scene.planets.psi_rad = (0..count).map(|n| TAU * n as f64 / count as f64).collect();
    LumpedModel::from_scene(&scene).unwrap()
}

const SETS: [&str; 3] = ["oh58_3p.toml", "oh58_4p.toml", "five_planets.toml"];

/// |Σ a_n e^(imψ_n)|
fn component(model: &LumpedModel, pattern: &[f64], m: f64) -> f64 {
    let part = |of: fn(f64) -> f64| -> f64 {
        pattern.iter().zip(&model.psi).map(|(a, psi)| a * of(m * psi)).sum()
    };
    part(f64::cos).hypot(part(f64::sin))
}

fn patterns(model: &LumpedModel) -> Vec<Vec<f64>> {
    let mut one = vec![0.0; model.psi.len()];
    one[0] = 1.0;
    let along = |m: f64| model.psi.iter().map(|psi| (m * psi).cos()).collect();
    vec![one, along(1.0), along(2.0)]
}

fn displaced(model: &LumpedModel, pattern: &[f64], by: f64) -> NaturalModes {
    let angles: Vec<f64> = pattern.iter().map(|a| by * a).collect();
    NaturalModes::of(&model.with_displaced_planets(&angles).unwrap()).unwrap()
}

/// (λ_max − λ_min)/λ of the modes nearest a group.
fn split(modes: &NaturalModes, change: &SpacingChange) -> f64 {
    let own = (TAU * change.frequency_hz).powi(2);
    let mut all = modes.lambda.clone();
    all.sort_by(|a, b| (a - own).abs().total_cmp(&(b - own).abs()));
    let near = &all[..change.multiplicity];
    let most = near.iter().fold(f64::MIN, |a, b| a.max(*b));
    (most - near.iter().fold(f64::MAX, |a, b| a.min(*b))) / own
}

/// A displaced model is that of a scene with its planets there.
#[test]
fn displaced_planets_are_those_of_a_scene_with_the_planets_there() {
    for name in SETS {
        let mut scene = scene(name);
        let model = LumpedModel::from_scene(&scene).unwrap();
        let angles: Vec<f64> = (0..model.psi.len()).map(|n| 0.03 * (n as f64 - 1.3)).collect();
        let moved = model.with_displaced_planets(&angles).unwrap();
        scene.planets.psi_rad.iter_mut().zip(&angles).for_each(|(psi, a)| *psi += a);
        let own = LumpedModel::from_scene(&scene).unwrap();
        let off = (moved.stiffness() - own.stiffness()).amax() / own.stiffness().amax();
        assert!(off < 1e-14 && moved.mass == own.mass, "{name}: {off:e}");
        assert!(model.with_displaced_planets(&angles[1..]).is_err());
        assert!(model.with_displaced_planets(&vec![f64::NAN; angles.len()]).is_err());
    }
}

/// Splits at two small displacements have the order and the coefficient of theory, and their order is that of symmetry:
/// the first only if the pattern has a component that goes twice around.
#[test]
fn splits_have_the_order_of_symmetry_and_the_size_of_theory() {
    let mut compared = [0, 0];
    for name in SETS {
        let model = equally_spaced(name);
        let modes = NaturalModes::of(&model).unwrap();
        for pattern in patterns(&model) {
            let twice = component(&model, &pattern, 2.0) > 1e-9;
            for change in model.spacing_changes(&modes, &pattern).unwrap() {
                let told = format!("{name} {pattern:.3?} {change:?}");
                if change.mode_type != ModeType::Translational {
                    assert_eq!(change.split, 0.0, "{told}");
                    continue;
                }
                assert_eq!(change.split_order, if twice { 1 } else { 2 }, "{told}");
                let found = [1e-4, 2e-4].map(|by| split(&displaced(&model, &pattern, by), &change));
                let order = (found[1] / found[0]).log2();
                let coefficient = found[0] / 1e-4f64.powi(change.split_order);
                assert!((order - f64::from(change.split_order)).abs() < 0.01, "{told}: {order}");
                assert!((coefficient / change.split - 1.0).abs() < 0.01, "{told}: {coefficient}");
                compared[usize::from(!twice)] += 1;
            }
        }
    }
    assert!(compared.iter().all(|count| *count > 5), "{compared:?}");
}

/// Modes are listed as mixed from the displacement of the formula on, bisected, within three times the amplitude of
/// 1e-3 that they are then mixed by and the displacement itself.
#[test]
fn modes_turn_mixed_at_the_displacement_of_theory() {
    let mut compared = 0;
    for name in SETS {
        let model = equally_spaced(name);
        let modes = NaturalModes::of(&model).unwrap();
        for pattern in patterns(&model) {
            for change in model.spacing_changes(&modes, &pattern).unwrap() {
                if change.pure_up_to > 0.1 {
                    continue;
                }
                let keeps = |by: f64| {
                    let found = displaced(&model, &pattern, by);
                    let each = |g: &ModeGroup| {
                        std::iter::repeat_n((g.frequency_hz, g.mode_type), g.multiplicity)
                    };
                    let mut near: Vec<_> = found.groups.iter().flat_map(each).collect();
                    let off = |f: f64| (f - change.frequency_hz).abs();
                    near.sort_by(|a, b| off(a.0).total_cmp(&off(b.0)));
                    near[..change.multiplicity].iter().all(|(_, own)| *own == change.mode_type)
                };
                let told = format!("{name} {pattern:.3?} {change:?}");
                let tolerance = 3.0 * (1e-3 + change.pure_up_to);
                assert!(keeps(change.pure_up_to * (1.0 - tolerance)), "{told}");
                assert!(!keeps(change.pure_up_to * (1.0 + tolerance)), "{told}");
                compared += 1;
            }
        }
    }
    assert!(compared > 30, "{compared}");
}

/// Turning all planets together changes nothing; planet modes are those of any spacing; and in a set whose opposed
/// planets stay opposed, rotational and translational modes stay apart.
#[test]
fn symmetry_says_what_does_not_change() {
    for name in SETS {
        let model = equally_spaced(name);
        let modes = NaturalModes::of(&model).unwrap();
        let all = vec![1.0; model.psi.len()];
        for change in model.spacing_changes(&modes, &all).unwrap() {
            assert!(change.split == 0.0 && change.lost == 0.0, "{name}: {change:?}");
        }
        for pattern in patterns(&model) {
            for change in model.spacing_changes(&modes, &pattern).unwrap() {
                let is_planet = change.mode_type == ModeType::Planet;
                assert!(!is_planet || change.lost == 0.0, "{name}: {change:?}");
            }
            let far = displaced(&model, &pattern, 0.05);
            for own in modes.of_type(ModeType::Planet) {
                let still = far.lambda.iter().filter(|l| (*l / own.lambda - 1.0).abs() < 1e-9);
                assert_eq!(still.count(), own.multiplicity, "{name} {:.1}", own.frequency_hz);
            }
        }
    }
    let model = equally_spaced("oh58_4p.toml");
    let modes = NaturalModes::of(&model).unwrap();
    let opposed = [0.0, 1.0, 0.0, 1.0];
    let changes = model.spacing_changes(&modes, &opposed).unwrap();
    assert!(changes.iter().all(|c| c.lost == 0.0), "{changes:?}");
    assert!(changes.iter().any(|c| c.split > 0.0 && c.split_order == 1));
    let apart = model.spacing_changes(&modes, &[1.0, 0.0, -1.0, 0.0]).unwrap();
    assert!(apart.iter().any(|c| c.lost > 0.0) && apart.iter().all(|c| c.split_order == 2));
}
