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
    assert_eq!(count(&verdict, "lumped_model.oh58_4p.rotational", Status::Pass), 2);
    let lack = verdict.not_asked.iter().find(|lack| lack.suite == "table3.fe_contact").unwrap();
    assert!(lack.lacks.ends_with("; modes.csv:3 has no `mode_type` of oh58_4p"), "{lack:?}");
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
    std::fs::write(&file, "[[mis]]\n").unwrap();
    let refusal = Accepted::read(&file).unwrap_err().to_string();
    assert!(refusal.contains("accepted.list:1") && refusal.contains("[[miss]]"), "{refusal}");
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
