//! Parameters in closed form: limit cases, and what must not matter.

use gearset::Displacements;
use lumped::{AnalyticCycle, AnalyticSet, LumpedError};
use scene::{LoadCase, PlanetOverride, Scene, SceneKind, template};

fn oh58() -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/oh58_4p.toml");
    Scene::from_file(std::path::Path::new(path)).unwrap()
}

/// Equally spaced planets whose meshes have five phases.
fn five_planets() -> Scene {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/five_planets.toml");
    Scene::from_file(std::path::Path::new(path)).unwrap()
}

fn frequencies(scene: &Scene, position: f64) -> Vec<f64> {
    let case = LoadCase::of_scene(scene).unwrap();
    let set = AnalyticSet::new(scene, &case, position).unwrap();
    let groups = set.modes().unwrap().groups;
    let with = |g: &lumped::ModeGroup| g.frequency_hz * (1.0 + set.inertia_change(g));
    let mut all: Vec<f64> =
        groups.iter().flat_map(|g| std::iter::repeat_n(with(g), g.multiplicity)).collect();
    all.sort_by(f64::total_cmp);
    all
}

fn same(a: &[f64], b: &[f64], part: f64) {
    assert_eq!(a.len(), b.len());
    for (x, y) in a.iter().zip(b) {
        assert!((x / y - 1.0).abs() < part, "{a:?}\n{b:?}");
    }
}

/// The mirror image of a set, under the other torque.
fn mirrored(scene: &Scene) -> Scene {
    let mut mirrored = scene.clone();
    let load = mirrored.operation.as_mut().unwrap();
    load.torque_nm = -load.torque_nm;
    mirrored.planets.psi_rad.iter_mut().for_each(|psi| *psi = -*psi);
    mirrored.planets.steps.iter_mut().flatten().for_each(|step| *step = -*step);
    mirrored
}

/// A set under clockwise torque is its mirror image, planets that are not equally spaced included, under the other.
#[test]
fn a_mirrored_set_has_the_same_frequencies() {
    let scene = oh58();
    let mirrored = mirrored(&scene);
    assert!(LoadCase::of_scene(&mirrored).unwrap().sun_torque_nm < 0.0);
    for position in [0.0, 0.3] {
        same(&frequencies(&scene, position), &frequencies(&mirrored, position), 1e-9);
    }
}

/// With another planet as the first one, the set is the same where that planet's mesh starts its path.
#[test]
fn a_renumbered_set_has_the_same_frequencies() {
    let scene = five_planets();
    let geometry = scene.tooth_geometry().unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    let phases =
        gearset::Phasing::new(&geometry, &scene.planets).unwrap().phases(0.0, case.sense());
    for first in 1..scene.planets.count() {
        // Equal spacing: the turned set looks the same, one planet's phase later.
        let later = (phases.sun_planet[0] - phases.sun_planet[first]).rem_euclid(1.0);
        same(&frequencies(&scene, 0.0), &frequencies(&scene, later), 1e-8);
    }
    // Another position is another set.
    let other = frequencies(&scene, 0.1);
    let moved = frequencies(&scene, 0.0).into_iter().zip(&other).map(|(a, b)| (a / b - 1.0).abs());
    assert!(moved.fold(0.0, f64::max) > 1e-3);
}

/// A carrier of a material that hardly yields is a rigid one. Masses and teeth of both sets are the same.
#[test]
fn a_rigid_carrier_is_the_limit_of_small_seats_flexibility() {
    let scene = five_planets();
    let case = LoadCase::of_scene(&scene).unwrap();
    let mut rigid = scene.clone();
    rigid.geometry.as_mut().unwrap().carrier.as_mut().unwrap().is_rigid = true;
    let own = AnalyticSet::new(&scene, &case, 0.0).unwrap();
    let limit = AnalyticSet::new(&rigid, &case, 0.0).unwrap();
    assert!(own.seats.amax() > 0.0 && limit.seats.is_empty());
    assert_eq!(own.model.mass, limit.model.mass);
    assert!(own.seat_share(0) > 0.0 && limit.seat_share(0) == 0.0);
    // A stiffer support never lowers a frequency.
    for (soft, stiff) in own.modes().unwrap().lambda.iter().zip(limit.modes().unwrap().lambda) {
        assert!(*soft <= stiff * (1.0 + 1e-9), "{soft} {stiff}");
    }
    // Reciprocity and symmetry of the seats.
    let seats = &own.seats;
    assert!((seats - seats.transpose()).amax() < 1e-12 * seats.amax());
    assert!(seats.clone().cholesky().is_some());
    let n = seats.nrows() / 2;
    for i in 0..n {
        let next = (i + 1) % n;
        for (a, b) in [(0, 0), (0, 1), (1, 1)] {
            let (one, two) = (seats[(2 * i + a, 2 * i + b)], seats[(2 * next + a, 2 * next + b)]);
            assert!((one - two).abs() < 1e-12 * seats.amax());
        }
    }
}

/// Without load lines of action do not turn, and what they do grows with the load: it is F times the second derivatives
/// of the approach, which the kinematics of displaced meshes know from elsewhere.
#[test]
fn turning_lines_of_action_have_the_second_derivatives_of_the_approach() {
    let geometry = oh58().tooth_geometry().unwrap();
    for (sign, mesh) in [
        (-1.0, geometry.sun_planet.as_ref().unwrap()),
        (1.0, geometry.ring_planet.as_ref().unwrap()),
    ] {
        let hessian = mesh.displaced(0.4, &Displacements::default()).unwrap().hessians().approach;
        let length = mesh.center_distance * mesh.pressure_angle.sin();
        let (sin, cos) = mesh.pressure_angle.sin_cos();
        // Across the line of action of a mesh whose planet is at (a, 0).
        let across = [cos, sign * sin];
        for i in 0..2 {
            for j in 0..2 {
                let expected = sign * across[i] * across[j] / length;
                assert!((hessian[3 + i][3 + j] - expected).abs() < 1e-9 / length, "{hessian:?}");
            }
        }
    }
}

/// Each scene that the closed forms do not hold for is refused with what is wrong with it.
#[test]
fn scenes_without_closed_forms_are_refused() {
    let refused = |change: &dyn Fn(&mut Scene), why: &str| {
        let mut scene = oh58();
        let case = LoadCase::of_scene(&scene).unwrap();
        change(&mut scene);
        let error = AnalyticSet::new(&scene, &case, 0.0).unwrap_err();
        assert!(matches!(&error, LumpedError::NotAnalytic(own) if own.contains(why)), "{error}");
    };
    refused(&|s| s.kind = SceneKind::GearPair, "no planetary set");
    refused(
        &|s| {
            s.overrides.push(PlanetOverride { planet: 0, mass_kg: Some(1.0), ..Default::default() })
        },
        "differ from each other",
    );
    refused(&|s| s.fe_contact.flexibility_factor.sun_planet = 0.5, "flexibility_factor");
    refused(&|s| s.geometry = None, "no teeth");
    refused(
        &|s| s.geometry.as_mut().unwrap().planet.body_radius_m = None,
        "a bore or rim is missing",
    );
    refused(
        &|s| {
            let planet = &mut s.geometry.as_mut().unwrap().planet;
            planet.body_radius_m = Some(0.99 * planet.root_radius_m);
        },
        "a rim is thinner",
    );
    refused(
        &|s| {
            let carrier = s.geometry.as_mut().unwrap().carrier.as_mut().unwrap();
            carrier.pin_seat_radius_m *= 2.0;
        },
        "pin seat",
    );
    let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
    let case = LoadCase::of_scene(&scene).unwrap();
    assert!(AnalyticSet::new(&scene, &case, 0.0).is_ok());
    let error = AnalyticSet::new(&scene, &case.with_sun_torque(0.0), 0.0).unwrap_err();
    assert!(error.to_string().contains("no torque"), "{error}");
}

/// Transmission errors at some positions, m.
fn at_rest(scene: &Scene, positions: &[f64]) -> Vec<f64> {
    let cycle = AnalyticCycle::new(scene, &LoadCase::of_scene(scene).unwrap()).unwrap();
    cycle.at_rest(positions).unwrap().iter().map(|own| own.transmission_error).collect()
}

/// A mirrored set under the other torque has the same transmission error, and one that turns into itself repeats it.
#[test]
fn transmission_errors_know_no_mirror_and_no_first_planet() {
    let positions: Vec<f64> = (0..12).map(|i| f64::from(i) / 12.0 + 0.003).collect();
    let scene = oh58();
    let mirrored = mirrored(&scene);
    let own = at_rest(&scene, &positions);
    same(&own, &at_rest(&mirrored, &positions), 1e-9);
    // Two pairs of planets opposite each other: half a cycle on, the set turned by half a turn.
    same(&own[..6], &own[6..], 1e-9);
    let five: Vec<f64> = positions.iter().map(|x| x + 0.2).collect();
    same(&at_rest(&five_planets(), &positions), &at_rest(&five_planets(), &five), 1e-9);
    // A quarter of a cycle on, and a fifth of one of the other set, is no symmetry.
    let apart = own[0] - own[3];
    assert!(apart.abs() > 1e-4 * own[0], "{own:?}");
}

/// Twice the width, the torque and the stiffness of every bearing is the same set twice beside itself.
#[test]
fn a_set_of_twice_the_width_yields_as_much_under_twice_the_torque() {
    let scene = five_planets();
    let mut twice = scene.clone();
    let geometry = twice.geometry.as_mut().unwrap();
    geometry.face_width_m *= 2.0;
    twice.operation.as_mut().unwrap().torque_nm *= 2.0;
    let supports = &mut twice.supports;
    supports.planet_bearing_n_per_m *= 2.0;
    for support in [&mut supports.carrier, &mut supports.ring, &mut supports.sun] {
        support.bearing_n_per_m *= 2.0;
        support.torsional = match support.torsional {
            scene::Torsional::PerLength(k) => scene::Torsional::PerLength(2.0 * k),
            scene::Torsional::PerAngle(k) => scene::Torsional::PerAngle(2.0 * k),
        };
    }
    let positions = [0.0, 0.13, 0.4, 0.77];
    same(&at_rest(&scene, &positions), &at_rest(&twice, &positions), 1e-7);
}

/// The torque's work on the sun is what springs store: meshes and seats have a share each, and the rest, that of the
/// bearings, is positive; more than the torque alone is not there.
#[test]
fn shares_of_meshes_and_seats_are_parts_of_the_work() {
    for scene in [oh58(), five_planets()] {
        let cycle = AnalyticCycle::new(&scene, &LoadCase::of_scene(&scene).unwrap()).unwrap();
        for own in cycle.at_rest(&[0.0, 0.3, 0.6]).unwrap() {
            let work = cycle.load() * own.transmission_error;
            let [suns, rings] = own.mesh_work.map(|work_of| work_of / work);
            let seats = own.seat_work / work;
            assert!(suns > 0.0 && rings > 0.0 && seats > 0.0, "{own:?}");
            assert!(suns + rings + seats < 1.0, "{suns} {rings} {seats}");
        }
    }
}

/// Stated errors are finite up to the first mode of a body; without a flexible carrier its parts are nothing, and a
/// more slender carrier has more of them.
#[test]
fn stated_errors_follow_the_carrier() {
    let with = |change: fn(&mut gearset::CarrierInput)| {
        let mut scene = oh58();
        change(scene.geometry.as_mut().unwrap().carrier.as_mut().unwrap());
        let case = LoadCase::of_scene(&scene).unwrap();
        let set = AnalyticSet::new(&scene, &case, 0.0).unwrap();
        let groups = set.modes().unwrap().groups;
        let errors: Vec<_> = groups.iter().map(|group| set.frequency_errors(group)).collect();
        (groups, errors)
    };
    let carrier = |errors: &[lumped::StatedError]| errors.last().unwrap().share;
    let (groups, own) = with(|_| ());
    for (group, errors) in groups.iter().zip(&own).filter(|(group, _)| group.lambda > 0.0) {
        let shares: Vec<f64> = errors.iter().map(|error| error.share).collect();
        println!("{:.1} {} {shares:.5?}", group.frequency_hz, group.mode_type.name());
        assert!(shares.iter().all(|share| *share >= 0.0), "{shares:?}");
        let total: f64 = shares.iter().sum();
        // The first torsion of the carrier is at 11.7 kHz, that of the sun higher.
        assert_eq!(total.is_finite(), group.frequency_hz < 11_700.0, "{}", group.frequency_hz);
    }
    let (_, rigid) = with(|carrier| carrier.is_rigid = true);
    for errors in rigid.iter().filter(|errors| !errors.is_empty()) {
        let seats = errors.iter().find(|error| error.source == "pin seats").unwrap();
        assert_eq!([seats.share, carrier(errors)], [0.0, 0.0]);
    }
    let (_, slender) = with(|carrier| carrier.bore_radius_m *= 0.8);
    for (less, more) in own.iter().zip(&slender).take(6) {
        assert!(less.is_empty() && more.is_empty() || carrier(less) < carrier(more));
    }
}
