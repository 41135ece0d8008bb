//! Scenes with fitted parameters still have the properties to which these were fitted, and drawn scenes those that are
//! kept of them.

use experiments::auto::{
    AutoSettings, amplitude_with, choose_frequency, choose_transmission_error,
    stepped_amplitude_with, transmission_error_with,
};
use experiments::modal::{Preload, linear_modes, lumped_frequencies, of_type, preloaded};
use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{Facing, LoadCase, MeshKind};
use lumped::ModeType;
use validation::{Asked, PublishedScene, auto_tables, drawn_response, drawn_scene, scene};

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
    let preload =
        Preload { load: gearset::LoadCase::standing(1130.0), position: 0.0, step_s: 5e-6 };
    let set = preloaded(&scene, &bodies, &preload).unwrap();
    let modes = linear_modes(&set, &set.linearised().unwrap()).unwrap();
    let first = |kind| of_type(&modes, kind)[0].frequency_hz;
    let (translational, rotational) = (first(ModeType::Translational), first(ModeType::Rotational));
    assert!((translational / pair[0] - 1.0).abs() < 0.005, "{translational}");
    assert!((rotational / 782.0 - 1.0).abs() < 0.02, "{rotational}");
}

/// The tables of `docs/auto.md` are those of the kept files: `remake -- auto_tables` prints them.
#[test]
fn the_page_of_auto_has_the_tables_of_the_kept_files() {
    let read = |name: &str| {
        std::fs::read_to_string(format!("{}/../{name}", env!("CARGO_MANIFEST_DIR"))).unwrap()
    };
    let tables = auto_tables(&read("kept/auto.csv"), &read("kept/auto_responses.csv")).unwrap();
    assert!(read("docs/auto.md").contains(&tables), "{tables}");
}

/// `kept/auto.csv`: sixty sets; the answers of `auto` are within their tolerances in at least 95 %, their estimates are not
/// below the errors more often than that, and a few cheap ones come out again.
#[test]
fn the_record_of_auto_holds_and_comes_out_again() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../kept/auto.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let rows: Vec<Vec<&str>> = lines.skip(1).map(|line| line.split(',').collect()).collect();
    assert_eq!(rows.len(), 60);
    let number = |row: &[&str], k: usize| row[k].parse::<f64>().unwrap();
    let answered: Vec<&Vec<&str>> = rows.iter().filter(|row| row[4] != "refused").collect();
    assert!(answered.len() >= 30, "{}", answered.len());
    let (mut missed, mut below) = (0, 0);
    for row in &answered {
        let error = 100.0 * (number(row, 6) / number(row, 7) - 1.0).abs();
        assert!((error - number(row, 8)).abs() < 1e-3, "{row:?}");
        missed += usize::from(error > number(row, 3));
        below += usize::from(error > number(row, 5));
    }
    assert!(20 * missed <= answered.len() && 20 * below <= answered.len(), "{missed}, {below}");
    let cheap = |row: &&Vec<&str>| !row[4].starts_with("modal") && row[4] != "refused";
    for row in rows.iter().filter(cheap).step_by(6) {
        let drawn = drawn_scene(row[0].parse().unwrap()).unwrap();
        assert_eq!(drawn.request.to_string(), row[2]);
        let case = LoadCase::of_scene(&drawn.scene).unwrap();
        let choice = choose_frequency(&drawn.scene, &case, &drawn.request).unwrap();
        assert_eq!(choice.settings.to_string().replace(',', ""), row[4], "{row:?}");
        assert!((choice.value / number(row, 6) - 1.0).abs() < 1e-6, "{row:?} {}", choice.value);
        assert!((choice.estimated_error_percent - number(row, 5)).abs() < 1e-3, "{row:?}");
    }
}

/// `kept/auto_responses.csv`: 75 sets at rest and 28 in motion; the answers of `auto` for transmission errors and amplitudes are within their
/// tolerances in at least 95 %, and a few cheap ones come out again.
#[test]
fn the_record_of_auto_for_responses_holds_and_comes_out_again() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../kept/auto_responses.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    let rows: Vec<Vec<&str>> = lines.skip(1).map(|line| line.split(',').collect()).collect();
    let at_rest = rows.iter().filter(|row| row[2].ends_with("at rest")).count();
    assert_eq!((at_rest, rows.len() - at_rest), (75, 28));
    let number = |row: &[&str], k: usize| row[k].parse::<f64>().unwrap();
    let answered: Vec<&Vec<&str>> = rows.iter().filter(|row| row[4] != "refused").collect();
    assert!(answered.len() >= 30, "{}", answered.len());
    for of in ["peak-to-peak", "mean transmission", "root mean square"] {
        assert!(answered.iter().any(|row| row[2].starts_with(of)), "{of}");
    }
    let mut missed = 0;
    for row in &answered {
        let error = 100.0 * (number(row, 6) / number(row, 7) - 1.0).abs();
        assert!((error - number(row, 8)).abs() < 1e-2, "{row:?}");
        assert!(number(row, 5) <= number(row, 3), "{row:?}");
        missed += usize::from(error > number(row, 3));
    }
    assert!(20 * missed <= answered.len(), "{missed}");
    let cheap = |row: &&&Vec<&str>| row[4].starts_with("quasi_static 6 ");
    // Finer meshes at rest are computed at some positions only.
    let finer =
        |row: &&&Vec<&str>| row[2].ends_with("at rest") && row[4].starts_with("quasi_static 8 ");
    let finer = answered.iter().filter(finer).step_by(4);
    let in_closed_form = answered.iter().filter(|row| row[4].starts_with("lumped"));
    assert_eq!(in_closed_form.clone().count(), 12);
    for row in answered.iter().filter(cheap).step_by(9).chain(finer).chain(in_closed_form) {
        let (drawn, asked) = drawn_response(row[0].parse().unwrap()).unwrap();
        assert_eq!(asked.to_string().replace(',', ""), row[2]);
        let case = LoadCase::of_scene(&drawn.scene).unwrap();
        let choice = asked.chosen(&drawn.scene, &case).unwrap();
        assert_eq!(choice.settings.to_string().replace(',', ""), row[4], "{row:?}");
        assert!((choice.value / number(row, 6) - 1.0).abs() < 1e-5, "{row:?} {}", choice.value);
        assert!((choice.estimated_error_percent - number(row, 5)).abs() < 1e-2, "{row:?}");
    }
}

/// A drawn set near a resonance, of which modes of the bodies raise the amplitude by two fifths: to first order as much, within the quarter of the change that an answer
/// doubts, although in harmonics that are not asked for most is accelerated.
#[test]
fn a_large_change_by_inertia_is_that_by_modes() {
    let (drawn, asked) = drawn_response(16064).unwrap();
    let Asked::Amplitude(mut request) = asked else { panic!("{asked}") };
    request.speeds_rpm = vec![2889.686];
    let case = LoadCase::of_scene(&drawn.scene).unwrap();
    let coarse = AutoSettings::quasi_static(6, 20);
    let of = |own| amplitude_with(&drawn.scene, &case, own, &request).unwrap();
    let few = coarse.with_steps(60);
    let predicted = of(few.with_elastic_inertia()) / of(few) - 1.0;
    let stepped = |own: AutoSettings| {
        let own = own.with_steps(120);
        let lines = stepped_amplitude_with(&drawn.scene, &case, own, &request).unwrap();
        lines[0].iter().map(|[re, im]| 0.5 * (re * re + im * im)).sum::<f64>().sqrt()
    };
    let by_modes = stepped(AutoSettings::modal(30, 6, 20)) / stepped(coarse) - 1.0;
    println!("{predicted:+.4} to first order, {by_modes:+.4} by thirty modes");
    assert!(by_modes > 0.3 && (predicted / by_modes - 1.0).abs() < 0.25);
}

/// A finer mesh that is computed at some positions of a cycle at rest has the extremes that it has at all of them, also where the
/// difference of the meshes is not smooth: pairs of this set begin and end to touch at its extremes.
#[test]
fn finer_meshes_at_rest_keep_their_own_extremes() {
    let (drawn, asked) = drawn_response(14071).unwrap();
    let Asked::Cycle(mut request) = asked else { panic!("{asked}") };
    // Less than the first mesh is estimated to be within.
    request.tolerance_percent = 0.42;
    let case = LoadCase::of_scene(&drawn.scene).unwrap();
    let choice = choose_transmission_error(&drawn.scene, &case, &request).unwrap();
    assert_eq!(choice.settings.flank_elements, Some(12), "{}", choice.settings);
    let whole = transmission_error_with(&drawn.scene, &case, choice.settings, &request).unwrap();
    let off = 100.0 * (choice.value / whole - 1.0).abs();
    assert!(off < 0.1 * request.tolerance_percent, "{} beside {whole}", choice.value);
}
