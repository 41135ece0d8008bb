//! Vectors of modes in a results folder: paired by the motions that they span, held against the lumped model, and
//! against the types beside them.

use std::fmt::Write;

use gearset::{Axis, Body};
use lumped::{LumpedModel, ModeType, NaturalModes};
use validation::{PublishedScene, Status, Value};

use crate::judged_matrices::{check, folder, judged, model, ring_axes_turned};

/// Titles of the columns of a model's coordinates.
fn titles(model: &LumpedModel) -> String {
    let title = |&(body, axis): &(Body, Axis)| {
        let axis = match (body, axis) {
            (_, Axis::Rotation) => "u",
            (Body::Planet(_), Axis::First) => "radial",
            (Body::Planet(_), _) => "tangential",
            (_, Axis::First) => "x",
            (_, Axis::Second) => "y",
        };
        format!("{}_{axis}", body.name())
    };
    model.coordinates.free().iter().map(title).collect::<Vec<_>>().join(",")
}

/// Rows with type, if `typed`, and vectors of two modes of one frequency turned into one another by an angle, in
/// `digits` digits behind the point and with a factor for each row.
fn rows(model: &LumpedModel, typed: bool, digits: usize) -> Vec<String> {
    let mut rows = Vec::new();
    for group in NaturalModes::of(model).unwrap().groups {
        let mut vectors = group.vectors.clone();
        if group.multiplicity == 2 {
            let (sin, cos) = 0.7_f64.sin_cos();
            vectors =
                &vectors * lumped::nalgebra::DMatrix::from_row_slice(2, 2, &[cos, -sin, sin, cos]);
        }
        for vector in vectors.column_iter() {
            let mut row = format!("{:.3},", group.frequency_hz);
            row += if typed { group.mode_type.name() } else { "" };
            let factor = -3.0 / vector.amax();
            vector.iter().for_each(|x| write!(row, ",{:.digits$e}", factor * x).unwrap());
            rows.push(row);
        }
    }
    rows
}

fn table(model: &LumpedModel, rows: &[String]) -> String {
    format!("frequency_hz,mode_type,{}\n{}\n", titles(model), rows.join("\n"))
}

fn manifest(set: PublishedScene) -> String {
    format!("kind = \"lumped\"\nscene = \"{}\"\n", set.id())
}

#[test]
fn right_vectors_pass_in_any_order_and_say_the_types() {
    for set in [
        PublishedScene::LinParkerThreePlanets,
        PublishedScene::LinParkerFourPlanets,
        PublishedScene::Oh58FourPlanets,
        PublishedScene::FivePlanets,
    ] {
        let (_, model) = model(set);
        for (typed, digits) in [(true, 8), (false, 8), (false, 3)] {
            let mut rows = rows(&model, typed, digits);
            rows.reverse();
            let folder = folder(&manifest(set), &[("modes.csv", &table(&model, &rows))]);
            let verdict = judged(folder.path()).unwrap();
            assert_eq!(verdict.failed, 0, "{} {digits}: {:#?}", set.id(), verdict.checks);
            let shapes = verdict.checks.iter().filter(|check| check.id.contains(".shape."));
            assert_eq!(shapes.clone().count(), NaturalModes::of(&model).unwrap().groups.len());
            let worst = shapes.map(|check| match check.actual {
                Some(Value::Number(lost)) => lost,
                _ => f64::NAN,
            });
            let worst = worst.fold(0.0, f64::max);
            assert!(worst < if digits == 8 { 1e-12 } else { 1e-5 }, "{worst}");
        }
    }
    // Types follow from the vectors, so that the printed table is asked by type.
    let (_, model) = model(PublishedScene::LinParkerFourPlanets);
    let rows = rows(&model, false, 8);
    let folder = folder(
        &manifest(PublishedScene::LinParkerFourPlanets),
        &[("modes.csv", &table(&model, &rows))],
    );
    let verdict = judged(folder.path()).unwrap();
    assert!(verdict.checks.iter().any(|c| c.id.starts_with("lin_parker_1999.four_planets.planet")));
}

#[test]
fn a_wrong_sign_that_no_frequency_shows_is_found_in_the_shapes() {
    let set = PublishedScene::LinParkerFourPlanets;
    let (scene, model) = model(set);
    let turned = ring_axes_turned(&scene, &model);
    let rows = rows(&turned, true, 8);
    let folder = folder(&manifest(set), &[("modes.csv", &table(&model, &rows))]);
    let verdict = judged(folder.path()).unwrap();
    let failed: Vec<&str> =
        verdict.checks.iter().filter(|c| c.status == Status::Fail).map(|c| c.id.as_str()).collect();
    assert!(failed.len() >= 3, "{failed:?}");
    let is_translational = |id: &&str| id.contains(".shape.translational.");
    assert!(failed.iter().all(is_translational), "{failed:?}");
}

/// Each frequency stays with the mode of its vector, though it is that of another mode of the type.
#[test]
fn modes_are_paired_by_their_vectors() {
    let set = PublishedScene::Oh58FourPlanets;
    let (_, model) = model(set);
    let mut list = rows(&model, true, 8);
    // 770.6 and 778.7 Hz, both translational, the other way round.
    let (a, b) = (list[0].clone(), list[1].clone());
    let [(hz_a, end_a), (hz_b, end_b)] = [a.split_once(',').unwrap(), b.split_once(',').unwrap()];
    (list[0], list[1]) = (format!("{hz_b},{end_a}"), format!("{hz_a},{end_b}"));
    let folder = folder(&manifest(set), &[("modes.csv", &table(&model, &list))]);
    let verdict = judged(folder.path()).unwrap();
    let of_model =
        |c: &&validation::Check| c.id.starts_with("lumped_model.") && c.status == Status::Fail;
    let failed: Vec<&str> = verdict.checks.iter().filter(of_model).map(|c| c.id.as_str()).collect();
    assert_eq!(
        failed,
        ["lumped_model.oh58_4p.translational.1", "lumped_model.oh58_4p.translational.2"]
    );
    assert_eq!(check(&verdict, "lumped_model.oh58_4p.shape.translational.1").status, Status::Pass);
}

#[test]
fn vectors_in_the_authors_convention() {
    let set = PublishedScene::Oh58FourPlanets;
    let (scene, model) = model(set);
    let radius = scene.lumped.unwrap().radius_m;
    // Clockwise angles, planets along x and y.
    let titles = titles(&model).replace("radial", "x").replace("tangential", "y");
    let mut text = format!("frequency_hz,{titles}\n");
    for group in NaturalModes::of(&model).unwrap().groups {
        for q in group.vectors.column_iter() {
            write!(text, "{:.3}", group.frequency_hz).unwrap();
            for (i, &(body, axis)) in model.coordinates.free().iter().enumerate() {
                let number = match (body, axis) {
                    (_, Axis::Rotation) => -q[i] / radius.of(body).unwrap(),
                    (Body::Planet(n), Axis::First) => {
                        q[i] * model.psi[n].cos() - q[i + 1] * model.psi[n].sin()
                    }
                    (Body::Planet(n), _) => {
                        q[i - 1] * model.psi[n].sin() + q[i] * model.psi[n].cos()
                    }
                    _ => q[i],
                };
                write!(text, ",{number:e}").unwrap();
            }
            text.push('\n');
        }
    }
    let right = manifest(set) + "[convention]\nrotation = \"angle\"\nsense = \"clockwise\"\n";
    let verdict = judged(folder(&right, &[("modes.csv", &text)]).path()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    let wrong = right.replace("clockwise", "counter_clockwise");
    let verdict = judged(folder(&wrong, &[("modes.csv", &text)]).path()).unwrap();
    assert!(
        verdict
            .checks
            .iter()
            .filter(|c| c.id.contains(".shape."))
            .any(|c| c.status == Status::Fail)
    );
}

#[test]
fn vectors_of_rotations_alone() {
    let set = PublishedScene::LinParkerFourPlanets;
    let (_, model) = model(set);
    let model = model.torsional();
    let rows = rows(&model, false, 8);
    let manifest = manifest(set).replace("lumped", "torsional");
    let verdict =
        judged(folder(&manifest, &[("modes.csv", &table(&model, &rows))]).path()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    // Five frequencies, one of them three times.
    let shapes = verdict.checks.iter().filter(|c| c.id.contains(".shape.torsional."));
    assert_eq!(shapes.count(), 5, "{:#?}", verdict.checks);
}

#[test]
fn contradictions_of_vectors_name_their_rows() {
    let set = PublishedScene::LinParkerThreePlanets;
    let (_, model) = model(set);
    let right = rows(&model, true, 8);
    let types = right.iter().map(|row| row.split(',').nth(1).unwrap());
    let of_type = |name: ModeType| types.clone().position(|t| t == name.name()).unwrap();
    let (turning, moving) = (of_type(ModeType::Rotational), of_type(ModeType::Translational));
    let with = |change: &dyn Fn(&mut Vec<String>)| {
        let mut list = right.clone();
        change(&mut list);
        table(&model, &list)
    };
    let line = |k: usize| k + 2;
    let zeros = ",0".repeat(model.mass.len());
    for (text, message) in [
        (
            with(&|list| list[moving] = list[moving].replace("translational", "rotational")),
            format!(
                "modes.csv:{}: column `mode_type`: `mode_type` is rotational, and the vector is translational: 0.0 % of its kinetic energy \
                 is rotational, 100.0 % translational and 0.0 % of planets alone: leave the type out, which then \
                 follows from the vector",
                line(moving)
            ),
        ),
        (
            with(&|list| list[moving + 1] = list[moving].clone()),
            format!(
                "modes.csv:{} and modes.csv:{}: the vectors of two modes are one: give each mode a vector of its own; \
                 those of one frequency span its motions",
                line(moving),
                line(moving + 1)
            ),
        ),
        (
            with(&|list| list[turning] = "1475.7,rotational".to_owned()),
            format!(
                "modes.csv:{} and modes.csv:{}: a row with a vector and one without, both of `lin_parker_1999_3p`: \
                 give the vector of every mode of a scene, or of none",
                if turning == 0 { 3 } else { 2 },
                line(turning)
            ),
        ),
        (
            with(&|list| list[turning] = format!("1475.7,rotational{zeros}")),
            format!("modes.csv:{}: a vector of zeros: leave it out, or give its numbers", line(turning)),
        ),
        (
            with(&|_| ()).replace("planet_1_u", "planet_1_w"),
            "modes.csv:2: the vector has no `planet_1_u`: a vector has a number for every coordinate that moves, and none \
             for others"
                .to_owned(),
        ),
    ] {
        let folder = folder(&manifest(set), &[("modes.csv", &text)]);
        let found = judged(folder.path()).unwrap_err();
        assert!(found.lines().any(|line| line == message), "{found}\n{message}");
    }
    let times = |(k, row): (usize, &String)| {
        let (hz, end) = row.split_once(',').unwrap();
        format!("{hz},{},{end}", if k == 3 { 2 } else { 1 })
    };
    let rows: Vec<String> = right.iter().enumerate().map(times).collect();
    let text = table(&model, &rows).replacen("frequency_hz,", "frequency_hz,multiplicity,", 1);
    let found = judged(folder(&manifest(set), &[("modes.csv", &text)]).path()).unwrap_err();
    let message = "modes.csv:5: column `multiplicity`: one vector with multiplicity 2: write a row for each vector, each of multiplicity 1";
    assert!(found.lines().any(|line| line == message), "{found}");
    // The OH-58 holds its ring.
    let (_, held) = self::model(PublishedScene::Oh58FourPlanets);
    let rows = self::rows(&held, true, 8);
    let text = table(&held, &rows).replacen("frequency_hz,", "ring_u,frequency_hz,", 1);
    let text = text.replace('\n', "\n0.5,").trim_end_matches("0.5,").to_owned();
    let set = PublishedScene::Oh58FourPlanets;
    let found = judged(folder(&manifest(set), &[("modes.csv", &text)]).path()).unwrap_err();
    assert!(found.starts_with("modes.csv:2: `ring_u` of the vector is 0.5, and the scene has no such coordinate or holds it: "), "{found}");
}
