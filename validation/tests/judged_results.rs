//! Results in a folder, judged by the references of their kind of model.

use std::fmt::Write;
use std::path::Path;

use experiments::ModalModel;
use experiments::models::Lumped;
use scene::LoadCase;
use tempfile::TempDir;
use validation::results::{Accepted, JudgeError, Judgement, ResultsFolder};
use validation::{
    Models, PublishedScene, Selection, Status, ValidationError, Verdict, judge_model, scene,
};

const HEADER: &str = "scene,frequency_hz,mode_type,multiplicity\n";

/// A folder with modes of this project's lumped model, each frequency changed by `change`, rounded to 0.01 Hz.
fn modes(kind: &str, sets: &[PublishedScene], change: impl Fn(&str, f64) -> f64) -> TempDir {
    let mut table = HEADER.to_owned();
    for set in sets {
        let modes =
            Lumped::default().natural_modes(&scene(*set).unwrap(), &LoadCase::standing(0.0));
        for mode in modes.unwrap() {
            let name = mode.mode_type.name();
            let hz = change(name, mode.frequency_hz);
            writeln!(table, "{},{hz:.2},{name},1", set.id()).unwrap();
        }
    }
    folder(kind, &[("modes.csv", &table)])
}

fn folder(kind: &str, files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("results.toml", &format!("format = 1\nkind = \"{kind}\"\nprogram = \"a test\"\n"));
    files.iter().for_each(|(name, text)| write(name, text));
    folder
}

fn folder_of_modes(kind: &str, table: &str) -> TempDir {
    folder(kind, &[("modes.csv", table)])
}

fn judged(folder: &Path, how: &Judgement) -> Result<Verdict, JudgeError> {
    ResultsFolder::read(folder).unwrap().judge(how)
}

fn count(verdict: &Verdict, front: &str, status: Status) -> usize {
    let of_suite = verdict.checks.iter().filter(|check| check.id.starts_with(front));
    of_suite.filter(|check| check.status == status).count()
}

const LUMPED: [PublishedScene; 3] = [
    PublishedScene::LinParkerFourPlanets,
    PublishedScene::Oh58ThreePlanetsAsPublished,
    PublishedScene::Oh58FourPlanets,
];

#[test]
fn a_right_lumped_model_is_judged_by_lumped_references_alone_and_passes() {
    let folder = modes("lumped", &LUMPED, |_, hz| hz);
    let verdict = judged(folder.path(), &Judgement::default()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    assert_eq!(count(&verdict, "table2.lumped.", Status::Pass), 5);
    assert_eq!(count(&verdict, "table2.lumped.", Status::Miss), 1, "table2.lumped.3 is listed");
    // Three listed digits of the four-planet set, and that set alone.
    assert_eq!(count(&verdict, "lin_parker_1999.four_planets", Status::Miss), 3);
    assert_eq!(count(&verdict, "lin_parker_1999.three_planets", Status::Pass), 0);
    // 15, 8 and 9 frequencies.
    assert!(count(&verdict, "lumped_model.", Status::Pass) >= 30);
    assert_eq!(count(&verdict, "table3.fe_contact.", Status::OtherKind), 7);
    assert_eq!(verdict.of_another_kind, count(&verdict, "", Status::OtherKind));
    let lack = verdict.not_asked.iter().find(|lack| lack.suite == "table3.lumped").unwrap();
    let needs = "modes.csv of oh58_4p_as_published: frequency and type of every mode";
    assert_eq!(lack.lacks, needs);
}

#[test]
fn a_wrong_lumped_model_fails_and_a_rig_with_the_same_numbers_does_not() {
    let soft = |name: &str, hz: f64| if name == "rotational" { 0.98 * hz } else { hz };
    let folder = modes("lumped", &LUMPED, soft);
    let verdict = judged(folder.path(), &Judgement::default()).unwrap();
    assert!(verdict.failed >= 10 && !verdict.is_sound());
    assert!(count(&verdict, "lumped_model.oh58_4p.rotational.1", Status::Fail) == 1);
    // A list with the type of one mode missing is matched by frequency, and a rig's list needs no types.
    let table = "scene,frequency_hz,mode_type\noh58_4p,1150.19,rotational\noh58_4p,1788.53,\n";
    let partly = folder_of_modes("lumped", table);
    let verdict = judged(partly.path(), &Judgement::default()).unwrap();
    assert_eq!(count(&verdict, "lumped_model.oh58_4p.untyped", Status::Pass), 2);
    let lack = verdict.not_asked.iter().find(|lack| lack.suite == "table3.fe_contact").unwrap();
    assert!(lack.lacks.ends_with("; modes.csv:3 has no `mode_type` of oh58_4p"), "{lack:?}");
    // No row names a type that the list does not, and rigid-body motion is shown as it was given.
    assert!(!verdict.checks.iter().any(|c| c.title.contains("rotational mode")));
    let rigid = folder_of_modes(
        "lumped",
        "scene,frequency_hz\nlin_parker_1999_3p,0.0123\nlin_parker_1999_3p,743.164\n",
    );
    let verdict = judged(rigid.path(), &Judgement::default()).unwrap();
    let first = verdict.checks.iter().find(|c| c.id == "lumped_model.lin_parker_1999_3p.untyped.1");
    let first = first.unwrap();
    assert_eq!(
        (first.actual.clone(), first.status),
        (Some(validation::Value::Number(0.0123)), Status::Pass)
    );
    assert!(first.title.ends_with(": frequency 1"), "{}", first.title);
    // A mode under the wrong type is one fault.
    let typed = folder_of_modes("lumped", &table.replace("1788.53,", "1788.53,translational"));
    let verdict = judged(typed.path(), &Judgement::default()).unwrap();
    let named = |c: &&validation::Check| {
        c.status == Status::Fail && c.id.starts_with("lumped_model.oh58_4p.rot")
    };
    let failed: Vec<_> = verdict.checks.iter().filter(named).collect();
    let [one] = failed.as_slice() else { panic!("{failed:#?}") };
    assert_eq!(one.id, "lumped_model.oh58_4p.rotational.2");
    assert_eq!(one.actual, Some(validation::Value::Text("translational".into())));
    let rig = folder_of_modes("measured", table);
    assert!(judged(rig.path(), &Judgement::default()).unwrap().of_another_kind >= 2);
    let measured = modes("measured", &LUMPED, soft);
    let verdict = judged(measured.path(), &Judgement::default()).unwrap();
    assert_eq!((verdict.passed, verdict.failed), (0, 0));
    assert!(verdict.of_another_kind > 10);
}

/// A set of four planets: the only frequencies of a torsional model are those of rotations.
#[test]
fn a_torsional_model_is_held_against_the_lumped_model_with_centres_held() {
    let table = |factor: f64| {
        let set = scene(PublishedScene::LinParkerFourPlanets).unwrap();
        let model = lumped::LumpedModel::from_scene(&set).unwrap().torsional();
        let mut text = "scene,frequency_hz\n".to_owned();
        for lambda in lumped::NaturalModes::of(&model).unwrap().lambda {
            let hz = lambda.max(0.0).sqrt() / std::f64::consts::TAU;
            writeln!(text, "lin_parker_1999_4p,{:.3}", factor * hz).unwrap();
        }
        text
    };
    let right = folder("torsional", &[("modes.csv", &table(1.0))]);
    let verdict = judged(right.path(), &Judgement::default()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    assert!(verdict.passed >= 4 && count(&verdict, "lin_parker", Status::Fail) == 0);
    // The planets' frequency in one row, N − 1 = 3 times; in three typed rows it is no contradiction.
    let once = "scene,frequency_hz,mode_type,multiplicity\nlin_parker_1999_4p,2120.62,rotational,1\n\
                lin_parker_1999_4p,6443.995,planet,3\n";
    let thrice =
        once.replace("planet,3", "planet,1") + &"lin_parker_1999_4p,6443.995,planet,1\n".repeat(2);
    // The kind that is asked for stands before that of the folder.
    let kind = Some(validation::ModelKind::Torsional);
    for (written, text) in [("torsional", once), ("torsional", &thrice), ("lumped", &thrice)] {
        let right = folder(written, &[("modes.csv", text)]);
        let how = Judgement { kind, ..Judgement::default() };
        let verdict = judged(right.path(), &how).unwrap();
        // The rigid-body mode is not listed.
        let failed: Vec<&str> = verdict
            .checks
            .iter()
            .filter(|c| c.status == Status::Fail)
            .map(|c| c.id.as_str())
            .collect();
        assert_eq!(failed, ["lumped_model.lin_parker_1999_4p.torsional.1"], "{text}");
        assert_eq!(verdict.passed, 2, "{:#?}", verdict.checks);
    }
    let wrong = folder("torsional", &[("modes.csv", &table(1.01))]);
    assert!(judged(wrong.path(), &Judgement::default()).unwrap().failed >= 3);
}

#[test]
fn rules_of_any_set_are_held_against_phasor_sums() {
    let set = scene(PublishedScene::Oh58FourPlanets).unwrap();
    let table = |shift: usize| {
        let sums = scene::excitation_of_scene(&set, 10).unwrap();
        let mut text = "scene,harmonic,excites\n".to_owned();
        for l in 0..8 {
            let kinds = sums[l + shift].allowed();
            let mut words = Vec::new();
            words.extend(kinds.rotational.then_some("Rotational"));
            words.extend(kinds.translational.then_some("translational"));
            words.extend(kinds.planet.then_some("planet"));
            writeln!(text, "oh58_4p,{},{}", l + 1, words.join(" + ")).unwrap();
        }
        text
    };
    for (shift, passed) in [(0, 8), (1, 0)] {
        let folder = folder("fe_contact", &[("rules.csv", &table(shift))]);
        let verdict = judged(folder.path(), &Judgement::default()).unwrap();
        assert_eq!((verdict.passed, verdict.failed), (passed, 8 - passed), "{:#?}", verdict.checks);
    }
    // Rotations alone have no translational modes; planets move against one another wherever meshes are out of step.
    let folder =
        folder("torsional", &[("rules.csv", &table(0).replace("translational", "planet"))]);
    assert_eq!(judged(folder.path(), &Judgement::default()).unwrap().passed, 8);
    std::fs::write(folder.path().join("rules.csv"), table(0)).unwrap();
    assert_eq!(judged(folder.path(), &Judgement::default()).unwrap().failed, 4);
}

/// Secant stiffness (N/µm) of this project's pair with the gears of three planets at 1130 N·m, by mesh and position.
fn stiffness_of_the_pair() -> Vec<(&'static str, f64, f64)> {
    use fe_contact::complementarity::ActiveSet;
    use fe_contact::statics::{Bodies, pair_cycle};
    use gearset::{MeshKind, Phasing};
    let set = scene(PublishedScene::Oh58ThreePlanets).unwrap();
    let bodies = Bodies::new(&set).unwrap();
    let force = 1130.0 / 3.0 / bodies.geometry.sun.as_ref().unwrap().base_radius;
    let gamma = Phasing::new(&bodies.geometry, &set.planets).unwrap().gamma();
    let mut rows = Vec::new();
    for (kind, mesh, shift) in
        [(MeshKind::SunPlanet, "sun", 0.0), (MeshKind::RingPlanet, "ring", gamma)]
    {
        let cycle = pair_cycle(&bodies, kind, force, 28, &ActiveSet).unwrap();
        rows.extend(cycle.positions.iter().map(|at| {
            let position = (at.phase - shift).rem_euclid(1.0);
            (mesh, position, 1e-6 * cycle.secant_stiffness(at))
        }));
    }
    rows
}

#[test]
fn mesh_stiffness_is_held_against_print_the_standard_and_the_pair_of_this_project() {
    let cycle = stiffness_of_the_pair();
    let verdict = |kind: &str, change: fn(f64, f64) -> (f64, f64)| {
        let mut table = "scene,sun_torque_nm,body,position,stiffness_n_per_um\n".to_owned();
        for (mesh, position, k) in &cycle {
            let (position, k) = change(*position, *k);
            writeln!(table, "oh58_3p,1130,{mesh}_mesh_0,{position},{k}").unwrap();
        }
        let folder = folder(kind, &[("mesh_stiffness.csv", &table)]);
        let verdict = judged(folder.path(), &Judgement::default()).unwrap();
        let status = |status| {
            let checks = verdict.checks.iter().filter(|check| check.status == status);
            checks.map(|check| check.id.clone()).collect::<Vec<_>>()
        };
        (status(Status::Pass), status(Status::Miss), status(Status::Fail), verdict)
    };
    let (passed, missed, failed, _) = verdict("fe_contact", |p, k| (p, k));
    let beside =
        ["sun_planet.1.mean", "sun_planet.1.shape", "ring_planet.1.mean", "ring_planet.1.shape"]
            .map(|row| format!("pair_stiffness.oh58_3p.{row}"));
    assert_eq!(passed[..2], ["fe.stiffness.series", "fe.iso_6336.sun_planet"]);
    assert_eq!(passed[2..], beside);
    let listed = ["fe.stiffness.sun_planet", "fe.stiffness.ring_planet", "fe.iso_6336.ring_planet"];
    assert_eq!((missed, failed), (listed.map(str::to_owned).to_vec(), Vec::new()));
    // The cycle of a mesh begun half a cycle late has the right mean; soft teeth the right shape.
    let (.., failed, _) = verdict("fe_contact", |p, k| ((p + 0.5).rem_euclid(1.0), k));
    assert_eq!(failed, [beside[1].clone(), beside[3].clone()]);
    let (.., failed, _) = verdict("fe_contact", |p, k| (p, 0.8 * k));
    assert!(failed.contains(&beside[0]) && !failed.contains(&beside[1]), "{failed:?}");
    assert!(failed.contains(&"fe.stiffness.series".to_owned()));
    // A constant stiffness of the right mean fails by its shape.
    let (.., failed, constant) = verdict("fe_contact", |p, _| (p, 611.0));
    assert!(failed.contains(&beside[1]) && failed.contains(&beside[3]), "{failed:?}");
    for shape in constant.checks.iter().filter(|check| check.id.ends_with(".shape")) {
        let Some(validation::Value::Number(percent)) = shape.actual else { panic!("{shape:?}") };
        assert!((percent - 100.0).abs() < 1e-6, "{shape:?}");
    }
    let (.., other) = verdict("lumped", |p, k| (p, k));
    assert_eq!((other.passed, other.failed, other.of_another_kind), (0, 0, 9));
}

/// Peaks of a system as they are kept, of which `chosen` are listed.
fn kept_peaks(
    system: &str,
    id: &str,
    height: impl Fn(&[f64], usize) -> f64,
    chosen: impl Fn(&str, &validation::TorquePeak) -> bool,
) -> String {
    let kept = validation::Reference::load().unwrap().torque_peaks;
    let mut text =
        "scene,sun_torque_nm,body,coordinate,harmonic,frequency_hz,amplitude\n".to_owned();
    for (n, peak) in kept.peak.iter().filter(|peak| peak.system == system).enumerate() {
        let coordinate = if peak.mode.ends_with("rotational") { "rotation" } else { "translation" };
        for (body, heights) in [("sun", &peak.sun), ("planet_0", &peak.planet)] {
            for (k, torque) in kept.torques_nm.iter().enumerate().filter(|_| chosen(body, peak)) {
                let hz = 27.0 * 99.0 / 126.0 / 60.0 * peak.speeds_rpm[k] * f64::from(peak.harmonic);
                let amplitude = 1e-6 * (n + 1) as f64 * height(heights, k);
                let harmonic = peak.harmonic;
                writeln!(
                    text,
                    "{id},{torque},{body},{coordinate},{harmonic},{hz:.1},{amplitude:e}"
                )
                .unwrap();
            }
        }
    }
    text
}

#[test]
fn resonant_peaks_alone_are_judged_by_the_statements_that_they_answer() {
    let judged = |kind: &str, table: String| {
        let folder = folder(kind, &[("torque_peaks.csv", &table)]);
        judged(folder.path(), &Judgement::default()).unwrap()
    };
    let rising = |heights: &[f64], k: usize| heights[k];
    for (system, id, name) in [
        ("default scene", "oh58_4p", "default"),
        ("meshes as soft as published", "oh58_4p_published_stiffness", "published_stiffness"),
        ("second system", "oh58_4p_second_system", "second_system"),
    ] {
        let verdict = judged("fe_contact", kept_peaks(system, id, rising, |_, _| true));
        assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
        let ids = verdict.checks.iter().map(|check| check.id.as_str());
        assert_eq!(ids.clone().filter(|id| id.contains(name)).count(), 10, "{:#?}", verdict.checks);
        assert_eq!(ids.filter(|id| id.starts_with("torque.all.")).count(), 6);
        let lacks: Vec<&str> = verdict
            .not_asked
            .iter()
            .filter(|lack| lack.suite == "torque")
            .map(|lack| lack.lacks.as_str())
            .collect();
        assert_eq!(lacks.len(), 2, "{lacks:?}");
    }
    let falling = |heights: &[f64], k: usize| heights[3 - k];
    let verdict =
        judged("fe_contact", kept_peaks("default scene", "oh58_4p", falling, |_, _| true));
    assert!(verdict.failed >= 4, "{:#?}", verdict.checks);
    let verdict = judged("lumped", kept_peaks("default scene", "oh58_4p", falling, |_, _| true));
    assert_eq!((verdict.failed, verdict.of_another_kind), (0, 10));
    // The first peaks of the sun alone: the other statements are listed with the peaks that they need.
    let first = |body: &str, peak: &validation::TorquePeak| {
        body == "sun" && peak.harmonic < 3 && peak.mode.starts_with("lowest")
    };
    let verdict = judged("fe_contact", kept_peaks("default scene", "oh58_4p", rising, first));
    let ids: Vec<&str> = verdict.checks.iter().map(|check| check.id.as_str()).collect();
    assert_eq!(
        ids,
        ["torque.monotonic.default.sun", "torque.rotation_above_translation.default.sun"]
    );
    let lacks =
        verdict.not_asked.iter().filter(|lack| lack.lacks.contains(" of oh58_4p: statements"));
    assert_eq!(
        lacks.map(|lack| lack.lacks.as_str()).collect::<Vec<_>>()[..2],
        [
            "torque_peaks.csv of oh58_4p: statements on all peaks of the sun need translation in harmonics 1 and 3 near \
             the lowest translational mode and in 3 and 5 near the third, rotation in 2 and 4 near the lowest rotational \
             mode, at 565, 1130, 1695 and 2260 N·m",
            "torque_peaks.csv of oh58_4p: statements on the first peaks of the planet need translation in harmonic 1 near \
             the lowest translational mode, rotation in 2 near the lowest rotational one, at 565, 1130, 1695 and 2260 N·m",
        ]
    );
}

#[test]
fn what_contradicts_itself_is_refused_before_any_check() {
    let twice = format!("{HEADER}oh58_4p,1150.2,rotational,1\noh58_4p,1150.2,rotational,1\n");
    let folder = folder("lumped", &[("modes.csv", &twice)]);
    match judged(folder.path(), &Judgement::default()) {
        Err(JudgeError::Contradictions(found)) => {
            assert!(found[0].to_string().contains("modes.csv:2"), "{}", found[0]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn misses_that_an_author_accepts_are_misses_at_their_pinned_value_alone() {
    let off = |name: &str, hz: f64| if name == "planet" { 1.001 * hz } else { hz };
    let folder = modes("lumped", &[PublishedScene::LinParkerFourPlanets], off);
    let only = || Selection::from("lin_parker_1999.four_planets.planet.1");
    let verdict = judged(folder.path(), &Judgement { only: only(), ..Judgement::default() });
    assert_eq!(verdict.unwrap().failed, 1);
    let file = folder.path().join("accepted.list");
    let entry = |value: f64| {
        let text = format!(
            "[[miss]]\nid = \"lin_parker_1999.four_planets.planet.1\"\nvalue = {value}\n\
             tolerance = 0.01\nanalysis = \"bearings as measured\"\n"
        );
        std::fs::write(&file, text).unwrap();
        let accepted = Accepted::read(&file).unwrap();
        let how = Judgement { only: only(), accepted, ..Judgement::default() };
        judged(folder.path(), &how).unwrap()
    };
    let verdict = entry(1810.0);
    assert_eq!((verdict.missed, verdict.failed), (1, 0), "{:?}", verdict.checks);
    assert_eq!(entry(1820.0).failed, 1);
    // A threshold of half a per cent for all planet modes; a tighter one fails.
    for (percent, failed) in [(0.5, 0), (0.05, 1)] {
        let text = format!(
            "[[threshold]]\nids = \"lin_parker_1999.*.planet.*\"\npercent = {percent}\nreason = \"bearings\"\n"
        );
        std::fs::write(&file, text).unwrap();
        let accepted = Accepted::read(&file).unwrap();
        let how = Judgement { only: only(), accepted, ..Judgement::default() };
        let verdict = judged(folder.path(), &how).unwrap();
        assert_eq!(verdict.failed, failed, "{:?}", verdict.checks);
        assert!(verdict.checks[0].tolerance.reason.ends_with("bearings"));
    }
    // What accepts anything, or says nothing, is refused where it stands.
    let miss = "[[miss]]\nid = \"a\"\nvalue = 100.0\ntolerance = 0.1\nanalysis = \"bearings\"\n";
    let threshold = "[[threshold]]\nids = \"a\"\npercent = 5.0\nreason = \"bearings\"\n";
    let whole = format!("{miss}\n{threshold}");
    for (from, to, message) in [
        (
            "analysis = \"bearings\"",
            "analysis = \" \"",
            ":5: `miss.analysis` is empty: allowed is a sentence on why",
        ),
        ("0.1", "20.1", ":4: `miss.tolerance` is 20.1: allowed is 0 to 20, 20 % of `value`"),
        ("0.1", "-1.0", ":4: `miss.tolerance` is -1: allowed is 0 to 20"),
        ("0.1", "nan", ":4: `miss.tolerance` is NaN: allowed is 0 to 20"),
        ("reason = \"bearings\"", "reason = \"\"", ":10: `threshold.reason` is empty"),
        (
            "5.0",
            "1e9",
            ":9: `threshold.percent` is 1000000000: allowed is 0 to 20 % of the reference",
        ),
    ] {
        std::fs::write(&file, whole.replacen(from, to, 1)).unwrap();
        let refusal = Accepted::read(&file).unwrap_err().to_string();
        assert!(refusal.contains(&format!("accepted.list{message}")), "{refusal}");
    }
    std::fs::write(&file, whole).unwrap();
    assert_eq!(Accepted::read(&file).unwrap().misses.len(), 1);
    std::fs::write(&file, "[[mis]]\n").unwrap();
    let refusal = Accepted::read(&file).unwrap_err().to_string();
    assert!(refusal.contains("accepted.list:1") && refusal.contains("[[miss]]"), "{refusal}");
}

/// Numbers of four digits are judged as such: the mesh cycle of the data set passes when it is rounded, and a planet
/// that carries 1 % more does not.
#[test]
fn symmetries_of_tables_are_judged_to_printed_digits() {
    let rows = validation::certified::CertifiedValues::shipped().rows();
    let is_asked = |row: &&validation::certified::Row| {
        row.kind == "fe_contact" && row.scene == "oh58_3p" && row.position.is_some()
    };
    let rows: Vec<_> = rows.filter(is_asked).filter(|row| !row.coordinate.is_empty()).collect();
    assert!(rows.len() >= 28 * 9);
    let table = |more: f64| {
        let mut text = "sun_torque_nm,position,body,coordinate,value\n".to_owned();
        for row in &rows {
            let factor = match row.subject.as_str() {
                "sun_mesh_1" => 1.0 + more,
                "sun_mesh_2" => 1.0 - more,
                _ => 1.0,
            };
            let (at, body, coordinate) = (row.position.unwrap(), &row.subject, &row.coordinate);
            let value = factor * row.value;
            writeln!(text, "1413,{at:.4},{body},{coordinate},{value:.3e}").unwrap();
        }
        let folder = folder("fe_contact", &[("mesh_cycle.csv", &text)]);
        let file = folder.path().join("results.toml");
        let manifest = std::fs::read_to_string(&file).unwrap() + "scene = \"oh58_3p\"\n";
        std::fs::write(file, manifest).unwrap();
        judged(folder.path(), &Judgement::default()).unwrap()
    };
    let rounded = table(0.0);
    assert_eq!((count(&rounded, "fe.sets", Status::Pass), rounded.failed), (2, 0), "{rounded:#?}");
    let check = rounded.checks.iter().find(|check| check.id == "fe.sets.sharing.three").unwrap();
    assert_eq!(check.tolerance.absolute, 1e-3);
    assert_eq!(count(&table(0.01), "fe.sets.sharing.three", Status::Fail), 1);
}

#[test]
fn a_test_that_asks_nothing_is_an_error() {
    assert!(matches!(judge_model(&Models::default(), ""), Err(ValidationError::NoModel)));
    let lumped = Lumped::default();
    let models = Models { modal: Some(&lumped), ..Models::default() };
    let slip = judge_model(&models, "table3.lumpd").unwrap_err().to_string();
    assert!(slip.contains("did you mean `table3.lumped`?"), "{slip}");
    assert!(matches!(
        judge_model(&models, "fe.sets"),
        Err(ValidationError::NothingAsked(lacks)) if lacks.len() == 2
    ));
}

#[test]
fn a_scene_file_with_the_title_of_a_shipped_scene_must_be_that_scene() {
    let mut set = scene(PublishedScene::Oh58FourPlanets).unwrap();
    let rows = "scene,frequency_hz\nmine,770\n";
    let folder = folder("lumped", &[("modes.csv", rows), ("mine.toml", &set.to_toml())]);
    ResultsFolder::read(folder.path()).unwrap();
    set.supports.planet_bearing_n_per_m *= 1.1;
    std::fs::write(folder.path().join("mine.toml"), set.to_toml()).unwrap();
    let refusal = ResultsFolder::read(folder.path()).unwrap_err().to_string();
    assert!(refusal.contains("mine.toml: `title` is") && refusal.contains("another"), "{refusal}");
}
