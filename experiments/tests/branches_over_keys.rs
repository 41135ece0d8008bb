//! Branches over numbers of the scene: their points are steady states of scenes with these numbers.

use crate::amplitudes;

use amplitudes::{off, rotation};
use dynamics::continuation::Family;
use experiments::branches::{
    BranchEnd, BranchError, BranchParameter, BranchPoint, BranchSettings, PARAMETER_CHANGE,
    PeriodicFamily, branch,
};
use experiments::sweep::{
    FeModel, KeyedModel, MeshLawModel, SteadySettings, SweepError, SweepModel, SweepPoint,
    VariedKey, steady,
};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{LoadCase, Scene};

const STEPS: usize = 56;

/// OH-58 with three planets, no damping by mass, and bearings damped as meshes are; at this fidelity.
fn text(fidelity: &str) -> String {
    let path = format!("{}/../scenes/oh58_3p.toml", env!("CARGO_MANIFEST_DIR"));
    let own = std::fs::read_to_string(path).unwrap();
    assert!(!own.contains("[damping]") && !own.contains("[dynamics]"));
    format!(
        "{own}\n[damping]\nmass_proportional_per_s = 0\nstiffness_proportional_s = 8e-6\n[fe_contact]\n\
         flank_elements = 6\n[dynamics]\nsteps_per_cycle = {STEPS}\nfidelity = \"{fidelity}\"\n"
    )
}

/// The scene of a text with one of its lines, or a line after the head of a table, replaced.
fn changed(text: &str, from: &str, to: &str) -> Scene {
    assert_eq!(text.matches(from).count(), 1, "{from}");
    Scene::from_toml(&text.replace(from, to)).unwrap()
}

fn case(scene: &Scene) -> LoadCase {
    LoadCase::of_scene(scene).unwrap().with_sun_torque(400.0).at_speed(1500.0)
}

fn key(path: &str) -> BranchParameter {
    BranchParameter::Key(VariedKey::named(path).unwrap())
}

fn keyed<'b>(
    text: &str,
    path: &str,
    at: f64,
    bodies: &'b Bodies,
    is_lumped: bool,
) -> KeyedModel<'b> {
    let case = case(&Scene::from_toml(text).unwrap());
    let own = (VariedKey::named(path).unwrap(), at);
    KeyedModel::new(text, own, 1.0, bodies, case, is_lumped).unwrap()
}

/// The steady state of a model by shooting from rest.
fn single(model: &dyn SweepModel) -> SweepPoint {
    let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
    let mut set = model.turning(&model.case(), 0).unwrap();
    set.rest().unwrap();
    let found = steady(set.as_mut(), 3, 0.0, STEPS, &settings).unwrap();
    SweepPoint::new(model.case(), &found, &settings, 0).unwrap()
}

/// The first and last point and the one at the start.
fn three(points: &[BranchPoint], start: f64) -> [&BranchPoint; 3] {
    let middle = points.iter().find(|p| p.parameter == start).unwrap();
    [&points[0], middle, &points[points.len() - 1]]
}

/// Over the stiffness of the planets' bearings, on which the loaded configuration, contact tables and mesh laws depend,
/// and over masses, on which they do not: at three values the branch has the steady state of a model made from a scene
/// with that value, to what steady states are found to; and the motion depends on the key by far more.
fn points_are_steady_states_of_scenes(over: &[(&str, (&str, &str), [f64; 2])]) {
    for &(model_name, (path, line), range) in over {
        let is_lumped = model_name == "lumped";
        let own = text(if is_lumped { "mesh_law" } else { model_name });
        let bodies = Bodies::new(&Scene::from_toml(&own).unwrap()).unwrap();
        let settings = BranchSettings::along(key(path), range);
        let model = keyed(&own, path, settings.start, &bodies, is_lumped);
        let found = branch(&model, &settings).unwrap();
        assert_eq!(found.ends, [BranchEnd::Bound, BranchEnd::Bound]);
        assert!(found.points.len() >= 3);
        let mut motions = Vec::new();
        for p in three(&found.points, settings.start) {
            let value = p.parameter;
            assert!(p.residual < 1e-9 && p.damping_factor == 1.0);
            let with = match path {
                "planet.bearing_n_per_m" => format!("[planet]\nbearing_n_per_m = {value}"),
                "planet.added_mass_kg" => format!("[planet]\nadded_mass_kg = {value}\n"),
                _ => format!("planet = {value}"),
            };
            let scene = changed(&own, line, &with);
            let case = case(&scene);
            let fresh: Box<dyn SweepModel> = match model_name {
                "lumped" => Box::new(MeshLawModel::new(&scene, &bodies, case).unwrap().lumped()),
                "mesh_law" => Box::new(MeshLawModel::new(&scene, &bodies, case).unwrap()),
                _ => Box::new(FeModel::new(&scene, &bodies, Imperfections::default(), case)),
            };
            let difference = off(&rotation(&single(fresh.as_ref()).state), &rotation(&p.state));
            println!("{model_name}, {path} = {value}: {difference:e}");
            assert!(difference < 1e-8, "{model_name}, {path} = {value}: {difference:e}");
            motions.push(rotation(&p.state));
        }
        let effect = off(&motions[0], &motions[2]);
        println!("{model_name}, {path}: motions at the ends differ by {effect:.2e}");
        assert!(effect > 1e-3, "{model_name}, {path}: {effect:e}");
    }
}

/// A key, and the line of the scene that gives it.
const BEARING: (&str, &str) = ("planet.bearing_n_per_m", "[planet]\nbearing_n_per_m = 87.6e6");

#[test]
fn points_of_a_branch_over_a_key_are_steady_states_of_scenes_with_its_values() {
    let mass = ("lumped.mass_kg.planet", "planet = 0.66");
    points_are_steady_states_of_scenes(&[("lumped", mass, [0.6, 0.7])]);
}

#[test]
#[ignore = "long: .ci/full runs it"]
fn points_are_steady_states_also_where_the_loaded_configuration_follows_the_key() {
    let mass = ("planet.added_mass_kg", "[planet]\n");
    points_are_steady_states_of_scenes(&[
        ("mesh_law", BEARING, [85.5e6, 86.5e6]),
        ("quasi_static", BEARING, [85.5e6, 86.5e6]),
        ("quasi_static", mass, [0.1, 0.2]),
    ]);
}

/// Where damping is proportional to stiffness alone, the factor on the damping and the key of this damping say the
/// same.
#[test]
fn a_branch_over_the_key_of_damping_is_that_over_damping() {
    let own = text("mesh_law");
    let (scene, beta) = (Scene::from_toml(&own).unwrap(), 8e-6);
    let bodies = Bodies::new(&scene).unwrap();
    let plain = MeshLawModel::new(&scene, &bodies, case(&scene)).unwrap();
    let factors = [0.5, 1.5];
    let over = BranchParameter::Damping;
    let by_factor = branch(&plain, &BranchSettings::along(over, factors)).unwrap();
    let path = "damping.stiffness_proportional_s";
    let range = factors.map(|factor| factor * beta);
    let model = keyed(&own, path, beta, &bodies, false);
    let by_key = branch(&model, &BranchSettings::along(key(path), range)).unwrap();
    assert_eq!(by_key.points.len(), by_factor.points.len());
    assert!(by_key.points.len() > 4);
    for (a, b) in by_key.points.iter().zip(&by_factor.points) {
        assert!((a.parameter / beta - b.parameter).abs() < 1e-8 * b.parameter);
        let difference = off(&rotation(&a.state), &rotation(&b.state));
        assert!(difference < 1e-8, "{}: {difference:e}", b.parameter);
        assert!((a.largest_multiplier() - b.largest_multiplier()).abs() < 1e-7);
    }
}

/// The derivative in the key is a central difference: halving its share of the key divides its error by four; with the
/// share that is used it is that of a tenth of it. (A share of 1e-4 stands for the derivative itself: within it no cell
/// begins or ceases to touch. From there to 1e-3 cells do, which moves the difference by 1e-4 of its size.)
#[test]
#[ignore = "long: .ci/full runs it"]
fn the_difference_in_the_key_is_of_second_order() {
    let own = text("quasi_static");
    let bodies = Bodies::new(&Scene::from_toml(&own).unwrap()).unwrap();
    let path = "planet.bearing_n_per_m";
    let model = keyed(&own, path, 87.6e6, &bodies, false);
    let settings =
        BranchSettings { most_points: 2, ..BranchSettings::along(key(path), [80e6, 90e6]) };
    assert!(branch(&model, &settings).is_ok());
    let mut set = model.turning(&model.case(), 0).unwrap();
    set.rest().unwrap();
    let y = set.derivative().unwrap().coordinates();
    let derivative = |change: f64| {
        let family = PeriodicFamily::new(&model, key(path), 0, y.len()).with_change(change);
        let mut family = family;
        family.evaluate(&y, 87.6e6).unwrap().derivative
    };
    let exact = derivative(1e-4);
    let errors =
        [0.16, 0.08, 0.04].map(|change| (derivative(change) - &exact).norm() / exact.norm());
    println!("errors at 0.16, 0.08, 0.04: {errors:?}");
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        println!("order {order:.3}");
        assert!((order - 2.0).abs() < 0.1, "{order}");
    }
    let [own, tenth] = [PARAMETER_CHANGE, 0.1 * PARAMETER_CHANGE].map(derivative);
    println!("share used and a tenth: {:e}", (&own - &tenth).norm() / own.norm());
    assert!((&own - &tenth).norm() < 1e-4 * own.norm());
    assert!((&own - &exact).norm() < 1e-4 * own.norm());
}

/// Keys without effect on the model and values that the scene does not allow are refused.
#[test]
fn keys_without_effect_and_values_that_are_not_allowed_are_refused() {
    let own = text("mesh_law");
    let bodies = Bodies::new(&Scene::from_toml(&own).unwrap()).unwrap();
    let path = "lumped.mass_kg.planet";
    let model = keyed(&own, path, 0.7, &bodies, false);
    let error = branch(&model, &BranchSettings::along(key(path), [0.6, 0.8])).unwrap_err();
    assert!(matches!(&error, BranchError::NoEffect { .. }), "{error}");
    assert!(
        error.to_string().contains("lumped.mass_kg.planet")
            && error.to_string().contains("mesh-law")
    );
    let path = "planet.torsional_n_per_m";
    let refused = KeyedModel::check(&own, VariedKey::named(path).unwrap(), 1e6).unwrap_err();
    assert!(refused.to_string().contains("planet.torsional_n_per_m"), "{refused}");
    let settings = BranchSettings::along(key("planet.bearing_n_per_m"), [0.0, 1e8]);
    let error = settings.check().unwrap_err().to_string();
    assert!(error.contains("above 0"), "{error}");
    // A model of one scene has no key.
    let scene = Scene::from_toml(&own).unwrap();
    let plain = MeshLawModel::new(&scene, &bodies, case(&scene)).unwrap();
    let settings = BranchSettings::along(key("planet.bearing_n_per_m"), [8e7, 9e7]);
    assert!(matches!(
        branch(&plain, &settings),
        Err(BranchError::Sweep(SweepError::Incomplete(_)))
    ));
}
