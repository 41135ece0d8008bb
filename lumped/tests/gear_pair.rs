//! The lumped gear pair against closed forms: natural frequencies, the relative rotation, backlash.

use std::f64::consts::TAU;

use gearset::{Axis, Body, Facing, MeshLaw, PairFlanks, pair_law};
use lumped::{LumpedModel, NaturalModes, TimeVarying};
use scene::{Scene, SceneKind, template};

const K: f64 = 3.0e8;
const INERTIA: [f64; 2] = [0.002, 0.005];

/// The template's pair (27/35 teeth) with lumped parameters and the supports given as text.
fn pair(supports: &str) -> Scene {
    let lumped = format!(
        "{supports}\n[lumped]\nmass_kg = {{ sun = 0.7, planet = 1.1 }}\n\
         inertia_kg_m2 = {{ sun = {}, planet = {} }}\nmesh_n_per_m = {{ sun_planet = {K} }}\n\
         [damping]\nmass_proportional_per_s = 0\nstiffness_proportional_s = 0\n",
        INERTIA[0], INERTIA[1]
    );
    Scene::from_toml(&format!("{}\n{lumped}", template(SceneKind::GearPair))).unwrap()
}

/// r of sun and planet, m.
fn radii(scene: &Scene) -> [f64; 2] {
    let radius = scene.lumped.as_ref().unwrap().radius_m;
    [radius.sun.unwrap(), radius.planet.unwrap()]
}

/// J_s J_p/(J_s r_p² + J_p r_s²).
fn effective_mass(scene: &Scene) -> f64 {
    let ([j_s, j_p], [r_s, r_p]) = (INERTIA, radii(scene));
    j_s * j_p / (j_s * r_p * r_p + j_p * r_s * r_s)
}

fn frequencies(scene: &Scene) -> Vec<f64> {
    let modes = NaturalModes::of(&LumpedModel::from_scene(scene).unwrap()).unwrap();
    modes.lambda.iter().map(|l| l.max(0.0).sqrt() / TAU).collect()
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance * expected.abs(), "{found} {expected}");
}

#[test]
fn rigid_bearings_leave_one_frequency_and_the_rigid_rotation() {
    let scene = pair("");
    let found = frequencies(&scene);
    let expected = (K / effective_mass(&scene)).sqrt() / TAU;
    println!("{found:?}, expected {expected}");
    assert_eq!(found.len(), 2);
    assert!(found[0] < 1e-6 * expected);
    close(found[1], expected, 1e-12);
}

/// The pair of Kahraman & Singh (1991) as a public script gives it, two gears of 50 mm base radius, without tooth
/// geometry. With r²/J twice, √(2 k r²/J)/2π = 6469.16 Hz.
#[test]
fn a_pair_without_geometry_has_natural_frequencies() {
    let scene = Scene::from_toml(
        "format = 1\nkind = \"gear_pair\"\nmesh = \"sun_planet\"\n[lumped]\n\
         inertia_kg_m2 = { sun = 0.00115, planet = 0.00115 }\nradius_mm = { sun = 50, planet = 50 }\n\
         mesh_n_per_m = { sun_planet = 3.8e8 }\npressure_angle_deg = { sun_planet = 20 }\n",
    );
    let found = frequencies(&scene.unwrap());
    assert_eq!(found.len(), 2);
    assert!(found[0] < 1e-3, "{found:?}");
    assert!((found[1] - 6469.16).abs() < 5e-3, "{found:?}");
}

/// With equal gears the motions in and out of phase decouple. Along the line of action, with p = v_s − v_p and
/// w = u_s + u_p: m/2 p̈ + k_b/2 p + k(p + w) = 0 and J/2r² ẅ + k_t/2r² w + k(p + w) = 0. In v_s + v_p and at right
/// angles to the line of action each gear vibrates on its bearing alone, in u_s − u_p on its shaft.
#[test]
fn six_coordinates_of_equal_gears_have_these_frequencies() {
    let (k_b, k_t, m, j): (f64, f64, f64, f64) = (4.0e8, 2.0e5, 0.9, 0.003);
    let gear = format!("bearing_n_per_m = {k_b}\ntorsional_nm_per_rad = {k_t}\n");
    let text = format!(
        "{}\n[sun]\n{gear}[planet]\n{gear}[lumped]\nmass_kg = {{ sun = {m}, planet = {m} }}\n\
         inertia_kg_m2 = {{ sun = {j}, planet = {j} }}\nmesh_n_per_m = {{ sun_planet = {K} }}\n",
        include_str!("../../scenes/pair_50_50.toml")
    );
    let scene = Scene::from_toml(&text).unwrap();
    let [r, r_p] = radii(&scene);
    assert_eq!(r, r_p);
    let (m_u, k_u) = (j / (r * r), k_t / (r * r));
    // λ² (m m_u/4) − λ (a m_u/2 + b m/2) + a b − k² = 0 with a = k_b/2 + k, b = k_u/2 + k.
    let (a, b) = (0.5 * k_b + K, 0.5 * k_u + K);
    let (q, s) = (0.25 * m * m_u, 0.5 * (a * m_u + b * m));
    let root = (s * s - 4.0 * q * (a * b - K * K)).sqrt();
    let coupled = [(s - root) / (2.0 * q), (s + root) / (2.0 * q)];
    let mut expected = vec![k_u / m_u, k_b / m, k_b / m, k_b / m];
    expected.extend(coupled);
    expected.sort_by(f64::total_cmp);
    let found = frequencies(&scene);
    assert_eq!(found.len(), 6);
    for (found, lambda) in found.iter().zip(expected) {
        println!("{found} {}", lambda.sqrt() / TAU);
        close(*found, lambda.sqrt() / TAU, 1e-9);
    }
}

#[test]
fn a_bearing_left_out_is_the_limit_of_a_stiff_one() {
    let rigid = frequencies(&pair(""))[1];
    let stiff = |k: f64| {
        let bearing = format!("bearing_n_per_m = {k:e}\n");
        let scene = pair(&format!("[sun]\n{bearing}[planet]\n{bearing}"));
        let all = frequencies(&scene);
        assert_eq!(all.len(), 6);
        all.into_iter().map(|f| (f / rigid - 1.0).abs()).fold(f64::INFINITY, f64::min)
    };
    let (soft, hard) = (stiff(1e11), stiff(1e12));
    println!("off by {soft:e} and {hard:e}");
    // Proportional to k/k_b.
    close(soft / hard, 10.0, 0.02);
}

const STEPS: usize = 64;

/// Stiffness that changes by a fifth; flanks with backlash.
fn changing() -> MeshLaw {
    let k = |step: usize| K * (1.0 + 0.2 * (TAU * step as f64 / STEPS as f64).cos());
    let k: Vec<f64> = (0..STEPS).map(k).collect();
    pair_law(&k, &[0.0; STEPS], PairFlanks { backlash_m: Some(1e-4), rounding_m: 0.0 }).unwrap()
}

/// δ = u_s + u_p of the pair over some steps.
fn motion(scene: &Scene, torque_nm: f64, steps: usize) -> Vec<f64> {
    let [r_s, r_p] = radii(scene);
    let mut set = TimeVarying::new(scene, Facing::CounterClockwise, changing(), 1500.0).unwrap();
    set.rest(torque_nm).unwrap();
    let step = |_| {
        set.step().unwrap();
        let (central, planets) = set.displacements();
        r_s * central[2][2] + r_p * planets[0][2]
    };
    (0..steps).map(step).collect()
}

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0f64, |a, x| a.max(x.abs()))
}

/// The relative rotation of two free gears by three routes: as the program reduces it; as a sun of the effective
/// inertia against a planet that cannot turn; and both rotations kept, on shafts so soft that they do not matter.
#[test]
fn the_relative_rotation_is_that_of_the_effective_mass() {
    let scene = pair("");
    let own = motion(&scene, 8.0, 5 * STEPS);
    let mut held = scene.clone();
    held.supports.pair.as_mut().unwrap().planet.motion = scene::Freedom::Held;
    held.lumped.as_mut().unwrap().inertia_over_r2_kg.sun = Some(effective_mass(&scene));
    let by_mass = motion(&held, 8.0, 5 * STEPS);
    let size = largest(&own);
    for (a, b) in own.iter().zip(&by_mass) {
        assert!((a - b).abs() < 1e-10 * size, "{a} {b}");
    }
    // A wrong effective mass shows.
    held.lumped.as_mut().unwrap().inertia_over_r2_kg.sun = Some(1.01 * effective_mass(&scene));
    let wrong = motion(&held, 8.0, 5 * STEPS);
    assert!(own.iter().zip(&wrong).any(|(a, b)| (a - b).abs() > 1e-3 * size));

    let off = |stiffness: f64| {
        let soft = pair(&format!("[planet]\ntorsional_n_per_m = {stiffness:e}\n"));
        let kept = motion(&soft, 8.0, 5 * STEPS);
        own.iter().zip(&kept).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / size
    };
    let (softer, soft) = (off(5e4), off(5e5));
    println!("off by {softer:e} and {soft:e} on soft shafts");
    assert!(soft < 1e-2);
    close(soft / softer, 10.0, 0.05);
}

/// Each gear turns in inverse proportion to J/r, as no torque acts on the two together.
#[test]
fn the_gears_share_the_relative_rotation_by_their_inertias() {
    let scene = pair("");
    let mut set = TimeVarying::new(&scene, Facing::Clockwise, changing(), 1500.0).unwrap();
    set.rest(80.0).unwrap();
    (0..10).for_each(|_| set.step().unwrap());
    let (central, planets) = set.displacements();
    let [r_s, r_p] = radii(&scene);
    let (theta_s, theta_p) = (central[2][2], planets[0][2]);
    assert!(theta_s < 0.0 && theta_p < 0.0, "mirrored for clockwise torque");
    close(INERTIA[0] * theta_s / r_s, INERTIA[1] * theta_p / r_p, 1e-12);
}

/// Between the flanks only the torque acts; beyond the backlash the backside flanks press.
#[test]
fn flanks_are_apart_within_the_backlash() {
    let scene = pair("");
    let (f_m, torque, gap) = (1500.0, 80.0, 1e-4);
    let mut set = TimeVarying::new(&scene, Facing::CounterClockwise, changing(), f_m).unwrap();
    set.rest(torque).unwrap();
    let force = torque / radii(&scene)[0];
    let mut forces = Vec::new();
    set.mesh_forces(&mut forces);
    close(forces[0], force, 1e-9);
    let x0 = -0.9 * gap;
    set.set_motion(0, &[x0], &[0.0]).unwrap();
    let acceleration = force / effective_mass(&scene);
    let h = 1.0 / (f_m * STEPS as f64);
    for n in 1..=10 {
        set.step().unwrap();
        let t = n as f64 * h;
        let x = set.motion().x[0];
        assert!(x < 0.0);
        close(x - x0, 0.5 * acceleration * t * t, 1e-9);
        set.mesh_forces(&mut forces);
        assert!(forces.iter().all(|f| *f == 0.0), "{forces:?}");
    }
    set.set_motion(0, &[-1.1 * gap], &[0.0]).unwrap();
    set.step().unwrap();
    set.mesh_forces(&mut forces);
    println!("{forces:?}");
    assert!(forces[0] == 0.0 && forces[1] > 0.0);
}

#[test]
fn a_law_of_more_meshes_than_one_is_refused() {
    let set =
        Scene::from_file(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_4p.toml").as_ref());
    let refused = TimeVarying::new(&set.unwrap(), Facing::CounterClockwise, changing(), 500.0);
    assert!(refused.unwrap_err().to_string().contains("mesh law of 1 meshes"));
    let model = LumpedModel::from_scene(&pair("")).unwrap();
    assert!(model.coordinates.of(Body::Planet(0), Axis::First).is_none());
}
