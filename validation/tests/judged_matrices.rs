//! Matrices in a results folder: every convention, every size, each contradiction with its message.

use std::fmt::Write;
use std::path::Path;

use gearset::{Axis, Body};
use lumped::nalgebra::DMatrix;
use lumped::{LumpedModel, SpringId};
use scene::Scene;
use tempfile::TempDir;
use validation::results::{Judgement, ResultsFolder};
use validation::{Check, PublishedScene, Status, Value, Verdict, scene};

pub(crate) fn model(set: PublishedScene) -> (Scene, LumpedModel) {
    let set = scene(set).unwrap();
    let model = LumpedModel::from_scene(&set).unwrap();
    (set, model)
}

/// A folder with `results.toml` that ends in `manifest`, and further files.
pub(crate) fn folder(manifest: &str, files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("matrices")).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("results.toml", &format!("format = 1\n{manifest}"));
    files.iter().for_each(|(name, text)| write(name, text));
    folder
}

pub(crate) fn judged(folder: &Path) -> Result<Verdict, String> {
    let read = ResultsFolder::read(folder).unwrap();
    let judged = read.judge(&Judgement::default());
    judged.map_err(|error| error.to_string().replace(&format!("{}/", folder.display()), ""))
}

pub(crate) fn check<'v>(verdict: &'v Verdict, id: &str) -> &'v Check {
    let found = verdict.checks.iter().find(|check| check.id == id);
    found.unwrap_or_else(|| panic!("{id} of {:#?}", verdict.checks))
}

fn table(matrix: &DMatrix<f64>) -> String {
    let row = |row: Vec<String>| row.join(",") + "\n";
    matrix.row_iter().map(|r| row(r.iter().map(|x| format!("{x:.12e}")).collect())).collect()
}

fn market(matrix: &DMatrix<f64>) -> String {
    let n = matrix.nrows();
    let places = (0..n).flat_map(|j| (j..n).map(move |i| (i, j)));
    let entries: Vec<_> = places.filter(|place| matrix[*place] != 0.0).collect();
    let mut text = format!(
        "%%MatrixMarket matrix coordinate real symmetric\n% a test\n{n} {n} {}\n",
        entries.len()
    );
    for (i, j) in entries {
        writeln!(text, "{} {} {:.12e}", i + 1, j + 1, matrix[(i, j)]).unwrap();
    }
    text
}

/// T of q = T p on the model's free coordinates, each of which `row` gives as (axis of p, coefficient) of its body.
fn coordinates(model: &LumpedModel, row: impl Fn(Body, Axis) -> Vec<(Axis, f64)>) -> DMatrix<f64> {
    let mut t = DMatrix::zeros(model.mass.len(), model.mass.len());
    for (i, &(body, axis)) in model.coordinates.free().iter().enumerate() {
        for (other, coefficient) in row(body, axis) {
            t[(i, model.coordinates.of(body, other).unwrap())] = coefficient;
        }
    }
    t
}

/// The key of a convention, and T of it.
fn conventions(set: &Scene, model: &LumpedModel) -> Vec<(&'static str, DMatrix<f64>)> {
    let lumped = set.lumped.clone().unwrap();
    let rotation = |factor: &dyn Fn(Body) -> f64| {
        coordinates(model, |body, axis| {
            vec![(axis, if axis == Axis::Rotation { factor(body) } else { 1.0 })]
        })
    };
    // u = r_b θ with w = r_b θ/cos α.
    let cos = |body: Body| match body {
        Body::Carrier => 1.0,
        Body::Ring => lumped.pressure_angle_rad.ring_planet.cos(),
        _ => lumped.pressure_angle_rad.sun_planet.cos(),
    };
    let x_y = coordinates(model, |body, axis| match (body, axis) {
        (Body::Planet(n), Axis::First) => {
            vec![(Axis::First, model.psi[n].cos()), (Axis::Second, model.psi[n].sin())]
        }
        (Body::Planet(n), Axis::Second) => {
            vec![(Axis::First, -model.psi[n].sin()), (Axis::Second, model.psi[n].cos())]
        }
        _ => vec![(axis, 1.0)],
    });
    // Planets before the central members: p has their coordinates first.
    let n = model.mass.len();
    let planets = 3 * model.psi.len();
    let order = DMatrix::from_fn(n, n, |i, j| {
        f64::from(u8::from(j == if i < n - planets { i + planets } else { i + planets - n }))
    });
    let mut list = vec![
        ("sense = \"clockwise\"", rotation(&|_| -1.0)),
        ("radius = \"pitch\"", rotation(&cos)),
        ("planets = \"x_y\"", x_y),
        ("order = [\"planets\", \"carrier\", \"ring\", \"sun\"]", order),
    ];
    if lumped.radius_m.sun.is_some() {
        let radius = |body| lumped.radius_m.of(body).unwrap();
        list.push(("rotation = \"angle\"", rotation(&radius)));
    }
    list
}

const SETS: [PublishedScene; 2] =
    [PublishedScene::LinParkerFourPlanets, PublishedScene::Oh58FourPlanets];

#[test]
fn matrices_alone_are_judged_and_every_convention_is_read_or_named() {
    for which in SETS {
        let (set, model) = model(which);
        let id = which.id();
        for (key, t) in conventions(&set, &model) {
            let (m, k) =
                (t.transpose() * model.mass_matrix() * &t, t.transpose() * model.stiffness() * &t);
            let head = format!("kind = \"lumped\"\nscene = \"{id}\"\n[convention]\n");
            let right = folder(
                &format!("{head}{key}\n"),
                &[("matrices/M.csv", &table(&m)), ("matrices/K.mtx", &market(&k))],
            );
            let verdict = judged(right.path()).unwrap();
            assert_eq!(verdict.failed, 0, "{id} {key}: {:#?}", verdict.checks);
            for name in ["mass", "stiffness"] {
                let check = check(&verdict, &format!("lumped_model.{id}.{name}"));
                assert!(
                    matches!(check.actual, Some(Value::Number(percent)) if percent < 1e-8),
                    "{check:?}"
                );
            }
            // Frequencies and types of the printed tables too.
            let suites = ["lin_parker_1999.", "table3.geometry_consistent."];
            let is_printed =
                |check: &&Check| suites.iter().any(|suite| check.id.starts_with(suite));
            assert!(verdict.checks.iter().filter(is_printed).count() >= 5, "{id} {key}");
            std::fs::write(right.path().join("results.toml"), format!("format = 1\n{head}"))
                .unwrap();
            let verdict = judged(right.path()).unwrap();
            let wrong = check(&verdict, &format!("lumped_model.{id}.stiffness"));
            assert_eq!(wrong.status, Status::Fail, "{id} {key}");
            let note = wrong.note.clone().unwrap();
            // Where a held ring would stand in the order is open.
            let of_moving = |text: &str| match which {
                PublishedScene::Oh58FourPlanets => text.replace("\"ring\", ", ""),
                _ => text.to_owned(),
            };
            let end = of_moving(&format!("; all entries agree with `{key}`"));
            assert!(of_moving(&note).ends_with(&end), "{key}: {note}");
        }
    }
}

#[test]
fn several_keys_at_once_are_named_together() {
    let (set, model) = model(PublishedScene::Oh58FourPlanets);
    let all = conventions(&set, &model);
    let t = &all[0].1 * &all[2].1 * &all[4].1;
    let k = t.transpose() * model.stiffness() * &t;
    let manifest = "kind = \"lumped\"\nscene = \"oh58_4p\"\n";
    let verdict = judged(folder(manifest, &[("matrices/K.csv", &table(&k))]).path()).unwrap();
    let note = check(&verdict, "lumped_model.oh58_4p.stiffness").note.clone().unwrap();
    assert!(
        note.ends_with(
            "agree with `planets = \"x_y\"` and `rotation = \"angle\"` and `sense = \"clockwise\"`"
        ),
        "{note}"
    );
}

/// ψ_n − α_r in place of ψ_n + α_r in the ring's coordinates, which turns the axes of the ring.
pub(crate) fn ring_axes_turned(set: &Scene, model: &LumpedModel) -> LumpedModel {
    let mut turned = model.clone();
    let alpha = set.lumped.as_ref().unwrap().pressure_angle_rad.ring_planet;
    let [x, y] =
        [Axis::First, Axis::Second].map(|axis| model.coordinates.of(Body::Ring, axis).unwrap());
    for spring in &mut turned.springs {
        let SpringId::RingMesh(n) = spring.id else { continue };
        let (sin, cos) = (model.psi[n] - alpha).sin_cos();
        for (i, b) in &mut spring.rows[0] {
            match *i {
                i if i == x => *b = -sin,
                i if i == y => *b = cos,
                _ => {}
            }
        }
    }
    turned
}

#[test]
fn a_wrong_sign_that_no_frequency_shows_is_found_in_the_stiffness_matrix() {
    let (set, model) = model(PublishedScene::LinParkerFourPlanets);
    let turned = ring_axes_turned(&set, &model);
    let files = [
        ("matrices/M.mtx", market(&turned.mass_matrix())),
        ("matrices/K.mtx", market(&turned.stiffness())),
    ];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let folder = folder("kind = \"lumped\"\nscene = \"lin_parker_1999_4p\"\n", &files);
    let verdict = judged(folder.path()).unwrap();
    let failed: Vec<&Check> = verdict.checks.iter().filter(|c| c.status == Status::Fail).collect();
    let [check] = failed.as_slice() else { panic!("{failed:#?}") };
    assert_eq!(check.id, "lumped_model.lin_parker_1999_4p.stiffness");
    let note = check.note.as_deref().unwrap();
    assert!(
        note.starts_with("largest at ring ") && note.contains(": yours ") && note.ends_with(" N/m"),
        "{note}"
    );
}

/// M and K on all coordinates, also held ones, whose rows hold something else.
#[test]
fn held_coordinates_may_be_there_or_struck_out() {
    let (_, model) = model(PublishedScene::Oh58FourPlanets);
    let all: Vec<(Body, Axis)> =
        Body::all(4).flat_map(|body| Axis::ALL.map(|axis| (body, axis))).collect();
    let whole = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(21, 21, |i, j| {
            let of = |k: usize| model.coordinates.of(all[k].0, all[k].1);
            match (of(i), of(j)) {
                (Some(i), Some(j)) => matrix[(i, j)],
                _ => 0.0,
            }
        })
    };
    let (m, k) = (whole(&model.mass_matrix()), whole(&model.stiffness()));
    let files = [("matrices/oh58_4p.M.csv", table(&m)), ("matrices/oh58_4p.K.csv", table(&k))];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let verdict = judged(folder("kind = \"lumped\"\n", &files).path()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    assert_eq!(check(&verdict, "lumped_model.oh58_4p.mass").status, Status::Pass);
    // A set with its ring held, in a scene where it moves.
    let (mut set, _) = self::model(PublishedScene::LinParkerThreePlanets);
    set.supports.ring.motion = scene::Freedom::Held;
    let model = LumpedModel::from_scene(&set).unwrap();
    let files = [
        ("matrices/M.csv", table(&model.mass_matrix())),
        ("matrices/K.csv", table(&model.stiffness())),
    ];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let head = "kind = \"lumped\"\nscene = \"lin_parker_1999_3p\"\n";
    let verdict = judged(folder(&format!("{head}held = [\"ring\"]\n"), &files).path()).unwrap();
    let of_model = verdict.checks.iter().filter(|check| check.id.starts_with("lumped_model."));
    assert!(of_model.clone().count() >= 10);
    assert!(of_model.clone().all(|check| check.status == Status::Pass), "{:#?}", verdict.checks);
    let wrong = folder(head, &files);
    assert_eq!(
        judged(wrong.path()).unwrap_err().lines().next().unwrap(),
        "matrices/M.csv:1: 15 rows: allowed is 18 for `lin_parker_1999_3p`, or 15 with the ring held (`held = \
         [\"ring\"]` in results.toml): see `[convention]` and `held` of results.toml"
    );
}

#[test]
fn matrices_of_rotations_alone() {
    let (_, model) = model(PublishedScene::LinParkerFourPlanets);
    let model = model.torsional();
    let files = [
        ("matrices/M.csv", table(&model.mass_matrix())),
        ("matrices/K.csv", table(&model.stiffness())),
    ];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let folder = folder("kind = \"torsional\"\nscene = \"lin_parker_1999_4p\"\n", &files);
    let verdict = judged(folder.path()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    assert_eq!(verdict.passed, 7, "five frequencies, M and K: {:#?}", verdict.checks);
}

/// Digits as programs print them by default: no frequency is called another, no rigid-body motion is lost.
#[test]
fn six_digits_are_no_contradiction() {
    let (_, model) = model(PublishedScene::LinParkerFourPlanets);
    let rounded = |matrix: DMatrix<f64>| -> String {
        let row = |row: Vec<String>| row.join(" ") + "\n";
        matrix.row_iter().map(|r| row(r.iter().map(|x| format!("{x:.5e}")).collect())).collect()
    };
    let files = [
        ("matrices/M.csv", rounded(model.mass_matrix())),
        ("matrices/K.csv", rounded(model.stiffness())),
    ];
    let files = files.each_ref().map(|(name, text)| (*name, text.as_str()));
    let folder = folder("kind = \"lumped\"\nscene = \"lin_parker_1999_4p\"\n", &files);
    let verdict = judged(folder.path()).unwrap();
    assert_eq!(verdict.failed, 0, "{:#?}", verdict.checks);
    let mut modes = "frequency_hz\n".to_owned();
    for lambda in lumped::NaturalModes::of(&model).unwrap().lambda {
        writeln!(modes, "{:.1}", lambda.max(0.0).sqrt() / std::f64::consts::TAU).unwrap();
    }
    std::fs::write(folder.path().join("modes.csv"), modes).unwrap();
    assert_eq!(judged(folder.path()).unwrap().failed, 0);
}

#[test]
fn contradictions_of_matrices_name_their_entries() {
    let (_, model) = model(PublishedScene::LinParkerThreePlanets);
    let (m, k) = (model.mass_matrix(), model.stiffness());
    let changed = |matrix: &DMatrix<f64>, place: (usize, usize), value: f64| {
        let mut matrix = matrix.clone();
        matrix[place] = value;
        table(&matrix)
    };
    let (right_m, right_k) = (table(&m), table(&k));
    let mut negative = k.clone();
    negative[(0, 0)] *= 0.1;
    let mut indefinite = m.clone();
    indefinite[(0, 1)] = 7.0;
    indefinite[(1, 0)] = 7.0;
    let listed = "frequency_hz\n743.2\n\n1075.2\n";
    for (m, k, modes, message) in [
        (
            right_m.clone(),
            changed(&k, (7, 2), 1e8),
            None,
            "matrices/K.csv:3 and matrices/K.csv:8: K(3, 8) is 0 and K(8, 3) is 100000000: matrices of masses and \
             springs are symmetric",
        ),
        (
            changed(&m, (3, 3), 0.0),
            right_k.clone(),
            None,
            "matrices/M.csv:4: M(4, 4) is 0, of the ring, x displacement: every body that moves has a mass and an \
             inertia above 0",
        ),
        (
            changed(&m, (13, 13), -0.66),
            right_k.clone(),
            None,
            "matrices/M.csv:14: M(14, 14) is -0.66, of the planet 1, tangential displacement: every body that moves \
             has a mass and an inertia above 0",
        ),
        (
            table(&indefinite),
            right_k.clone(),
            None,
            "matrices/M.csv:1: M is not positive definite: a motion has no kinetic energy: every body that moves has \
             a mass and an inertia above 0",
        ),
        (
            right_m.clone(),
            table(&negative),
            None,
            "matrices/K.csv:1: K has a negative eigenvalue: ω² is ",
        ),
        (
            right_m.clone(),
            right_k.clone(),
            Some(listed),
            "modes.csv:4: column `frequency_hz`: 1075.2 Hz, and M.csv with K.csv has 1102.42 Hz as the nearest: write table and matrices from \
             one model",
        ),
    ] {
        let mut files = vec![("matrices/M.csv", m.as_str()), ("matrices/K.csv", k.as_str())];
        files.extend(modes.map(|modes| ("modes.csv", modes)));
        let folder = folder("kind = \"lumped\"\nscene = \"lin_parker_1999_3p\"\n", &files);
        let found = judged(folder.path()).unwrap_err();
        assert!(found.starts_with(message) && found.lines().count() == 1, "{found}\n{message}");
    }
    let small = table(&DMatrix::identity(2, 2));
    let folder = folder("kind = \"lumped\"\nscene = \"oh58_4p\"\n", &[("matrices/M.csv", &small)]);
    assert_eq!(
        judged(folder.path()).unwrap_err(),
        "matrices/M.csv:1: 2 rows: allowed is 17 for `oh58_4p`, 21 with its held coordinates, or 15 with the carrier \
         held (`held = [\"carrier\"]` in results.toml): see `[convention]` and `held` of results.toml"
    );
}

#[test]
fn angles_need_radii() {
    let (_, model) = model(PublishedScene::LinParkerThreePlanets);
    let manifest =
        "kind = \"lumped\"\nscene = \"lin_parker_1999_3p\"\n[convention]\nrotation = \"angle\"\n";
    let folder = folder(manifest, &[("matrices/K.csv", &table(&model.stiffness()))]);
    assert_eq!(
        judged(folder.path()).unwrap_err(),
        "matrices/K.csv:1: `rotation = \"angle\"` needs the radius of the carrier, which the scene does not have: see \
         `[convention]` and `held` of results.toml"
    );
}
