//! Scenes with fitted parameters still have the properties to which these were fitted, and drawn scenes those that are
//! kept of them.

use experiments::modal::{Preload, linear_modes, lumped_frequencies, of_type, preloaded};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, MeshKind};
use lumped::ModeType;
use validation::{PublishedScene, scene};

/// Printed lumped mesh stiffness, N/m.
const PRINTED: f64 = 350e6;

#[test]
fn softened_meshes_are_as_stiff_on_average_as_printed() {
    for which in [
        PublishedScene::Oh58ThreePlanetsPublishedStiffness,
        PublishedScene::Oh58FourPlanetsPublishedStiffness,
    ] {
        let scene = scene(which).unwrap();
        let bodies = Bodies::new(&scene).unwrap();
        let perfect = Imperfections::default();
        let set = StaticSet::new(&scene, &bodies, Facing::CounterClockwise, perfect).unwrap();
        let cycle = set.cycle(1130.0, 28, &ActiveSet).unwrap();
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            let off = cycle.mean_secant_stiffness(kind) / PRINTED - 1.0;
            assert!(off.abs() < 1e-3, "{which:?} {kind:?}: {off:e}");
        }
    }
}

#[test]
fn the_second_system_has_its_printed_frequencies() {
    let scene = scene(PublishedScene::Oh58SecondSystem).unwrap();
    let lumped = lumped_frequencies(&scene).unwrap();
    let of = |kind| lumped.iter().filter(move |m| m.mode_type == kind).map(|m| m.frequency_hz);
    let pair: Vec<f64> = of(ModeType::Translational).take(2).collect();
    // The spacing splits the pair by 6.5 Hz.
    assert!((0.5 * (pair[0] + pair[1]) - 622.0).abs() < 0.5, "{pair:?}");
    assert!((pair[1] - pair[0] - 6.5).abs() < 0.5, "{pair:?}");
    let rotational = of(ModeType::Rotational).next().unwrap();
    assert!((rotational - 782.0).abs() < 0.5, "{rotational}");
    // FE/contact, linearised at 1130 N·m: nothing is fitted to it.
    let bodies = Bodies::new(&scene).unwrap();
    let preload = Preload { load: scene::LoadCase::standing(1130.0), position: 0.0, step_s: 5e-6 };
    let set = preloaded(&scene, &bodies, &preload).unwrap();
    let modes = linear_modes(&set, &set.linearised().unwrap()).unwrap();
    let first = |kind| of_type(&modes, kind)[0].frequency_hz;
    let (translational, rotational) = (first(ModeType::Translational), first(ModeType::Rotational));
    assert!((translational / pair[0] - 1.0).abs() < 0.005, "{translational}");
    assert!((rotational / 782.0 - 1.0).abs() < 0.02, "{rotational}");
}

/// `kept/auto.csv`: errors are those of the values beside the truth. `docs/auto.md` has the counts of the answers that
/// are within their estimates, and names every one that is not.
#[test]
fn the_page_of_auto_counts_the_answers_on_drawn_sets() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    let text = std::fs::read_to_string(format!("{root}/kept/auto.csv")).unwrap();
    let page = std::fs::read_to_string(format!("{root}/docs/auto.md")).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert!(rows.len() >= 11);
    let (mut answers, mut beyond, mut pairs, mut apart) = (0, 0, 0, 0);
    for row in rows.iter().filter(|row| !row[2].is_empty()) {
        let number = |k: usize| row[k].parse::<f64>().ok();
        let truth = number(3).unwrap();
        let found = [4, 9].map(|k| Some([number(k + 2)?, number(k + 3)?, number(k + 4)?]));
        for [value, estimate, error] in found.iter().flatten() {
            assert!((100.0 * (value / truth - 1.0).abs() - error).abs() < 2e-3, "{row:?}");
            answers += 1;
            beyond += usize::from(error > estimate);
            if error > estimate {
                assert!(page.contains(row[0]), "{row:?} is beyond its estimate");
            }
        }
        if let [Some([loose, e, _]), Some([tight, f, _])] = found {
            pairs += 1;
            apart += usize::from(100.0 * (loose / tight - 1.0).abs() > e + f);
        }
    }
    let counted = format!(
        "{} of {answers} answers within their estimates, {} of {pairs} pairs within both",
        answers - beyond,
        pairs - apart
    );
    println!("{counted}");
    assert!(page.contains(&counted), "{counted}");
}
