//! Where the types of modes end when one planet is heavier, against the first-order formula.

use std::path::Path;

use lumped::{LumpedModel, ModeType, NaturalModes, tolerances_to, type_warnings};
use scene::Scene;

/// A scene file of the repository.
fn scene(name: &str) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name);
    Scene::from_file(&path).unwrap()
}

fn modes(scene: &Scene) -> (LumpedModel, NaturalModes) {
    let model = LumpedModel::from_scene(scene).unwrap();
    let modes = NaturalModes::of(&model).unwrap();
    (model, modes)
}

/// Whether the modes nearest a frequency, as many as the group has, are all of the type.
fn keeps(model: &LumpedModel, part: f64, frequency_hz: f64, kind: ModeType, count: usize) -> bool {
    let found = NaturalModes::of(&model.with_heavier_planet(0, part).unwrap()).unwrap();
    let mut near: Vec<(f64, ModeType)> = found
        .groups
        .iter()
        .flat_map(|g| std::iter::repeat_n((g.frequency_hz, g.mode_type), g.multiplicity))
        .collect();
    near.sort_by(|a, b| (a.0 - frequency_hz).abs().total_cmp(&(b.0 - frequency_hz).abs()));
    near[..count].iter().all(|(_, own)| *own == kind)
}

/// The mass at which the program first says `mixed`, bisected, for every group of modes, against the formula. At this
/// border modes are mixed by an amplitude of 1e-3 and the planet is heavier by δ: what the formula leaves out is of the
/// relative size of either, times a few.
#[test]
fn modes_turn_mixed_where_perturbation_theory_says() {
    let mut compared = 0;
    for name in ["five_planets.toml", "oh58_3p.toml", "oh58_4p.toml"] {
        let (model, found) = modes(&scene(name));
        for t in tolerances_to(&model, &found, 0) {
            let group =
                found.of_type(t.mode_type).find(|g| g.frequency_hz == t.frequency_hz).unwrap();
            let still = |part| keeps(&model, part, t.frequency_hz, t.mode_type, group.multiplicity);
            let (mut low, mut high) = (0.5 * t.pure_up_to, 2.0 * t.pure_up_to);
            let told = format!("{name}, {} {:.2} Hz", t.mode_type.name(), t.frequency_hz);
            assert!(still(low) && !still(high), "{told}: {:e}", t.pure_up_to);
            while high - low > 1e-4 * high {
                let middle = 0.5 * (low + high);
                if still(middle) { low = middle } else { high = middle }
            }
            let tolerance = 3.0 * (1e-3 + t.pure_up_to);
            let off = low / t.pure_up_to - 1.0;
            assert!(off.abs() < tolerance, "{told}: {low:e} {:e}", t.pure_up_to);
            compared += 1;
        }
    }
    assert!(compared > 15, "{compared}");
}

/// Both sides of the guard: sets whose types can be relied on, one whose modes coincide, and planets a little and
/// a lot unequal.
#[test]
fn types_that_mean_nothing_are_warned_of() {
    let (model, found) = modes(&scene("oh58_4p.toml"));
    assert!(type_warnings(&model, &found).is_empty(), "{:?}", type_warnings(&model, &found));
    let (model, found) = modes(&scene("coinciding_modes.toml"));
    let warned = type_warnings(&model, &found);
    // One warning for the two of them.
    assert!(warned.len() == 1 && warned[0].contains("lie so close"), "{warned:?}");
    let (model, _) = modes(&scene("five_planets.toml"));
    let of = |part: f64| {
        let heavier = model.with_heavier_planet(2, part).unwrap();
        type_warnings(&heavier, &NaturalModes::of(&heavier).unwrap())
    };
    let is_mixed = |w: &String| w.contains("listed as mixed");
    // One heavier planet is one line, and none is heavier by nothing.
    assert_eq!(of(1e-3).iter().filter(|w| is_mixed(w)).count(), 1, "{:?}", of(1e-3));
    assert!(of(1e-3).len() <= 2 && !of(1e-3).concat().contains("0.0e0"), "{:?}", of(1e-3));
    assert!(!of(1e-7).iter().any(is_mixed), "{:?}", of(1e-7));
    assert!(of(1e-2).iter().any(is_mixed), "{:?}", of(1e-2));
    assert!(model.with_heavier_planet(5, 0.1).is_err());
    assert!(
        model.with_heavier_planet(0, -1.0).is_err()
            && model.with_heavier_planet(0, f64::NAN).is_err()
    );
}
