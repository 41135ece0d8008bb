//! Each warning on both sides of its border; none for the shipped scenes.

use super::*;
use crate::scene::SceneKind;
use crate::templates::template;

fn scene(changes: &[(&str, &str)]) -> Scene {
    let mut text = template(SceneKind::Planetary).to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    Scene::from_toml(&text).unwrap()
}

/// Whether the first change warns of `key` in `words`, and the second of nothing.
fn border(key: &str, words: &str, beyond: &[(&str, &str)], within: &[(&str, &str)]) {
    let found = warnings(&scene(beyond));
    let own = found.iter().find(|w| w.key == key);
    let own = own.unwrap_or_else(|| panic!("{key} not in {found:?}"));
    assert!(own.to_string().contains(words), "{own}");
    let none = warnings(&scene(within));
    assert!(none.is_empty(), "{none:?}");
}

#[test]
fn shipped_scenes_and_templates_are_likely() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let found = warnings(&Scene::from_file(&path).unwrap());
        assert!(found.is_empty(), "{}: {found:?}", path.display());
    }
    for kind in [SceneKind::Planetary, SceneKind::GearPair] {
        assert_eq!(warnings(&Scene::from_toml(template(kind)).unwrap()), []);
    }
}

#[test]
fn elastic_constants_and_density() {
    let e = "young_modulus_pa = 207e9";
    let no_torque = ("torque_nm = 1413", "torque_nm = 0");
    let key = "material.young_modulus_pa";
    // Mesh stiffnesses of 80 MN/m for each 1e11 Pa, which ISO 6336-1 gives these teeth within a quarter.
    let mesh = "mesh_n_per_m = { sun_planet = 350e6, ring_planet = 350e6 }";
    let with = |value: &'static str| {
        let k = 1.7e-3 * value.parse::<f64>().unwrap();
        let (text, stiff) = (
            format!("young_modulus_pa = {value}"),
            format!("mesh_n_per_m = {{ sun_planet = {k:e}, ring_planet = {k:e} }}"),
        );
        warnings(&scene(&[no_torque, (e, &text), (mesh, &stiff)]))
    };
    for (value, likely) in
        [("207", "GPa"), ("207e3", "MPa"), ("0.999e9", "exponent"), ("1.11e12", "exponent")]
    {
        let found = with(value);
        assert!(found[0].key == key && found[0].likely.contains(likely), "{value}: {found:?}");
    }
    for value in ["1.001e9", "1.09e12"] {
        assert!(
            with(value).iter().all(|w| w.key.contains("bearing")),
            "{value}: {:?}",
            with(value)
        );
    }
    let nu = |text: &'static str| [("poisson_ratio = 0.3", text)];
    border(
        "material.poisson_ratio",
        "0.3",
        &nu("poisson_ratio = 0.19"),
        &nu("poisson_ratio = 0.2"),
    );
    border(
        "material.poisson_ratio",
        "0.3",
        &nu("poisson_ratio = 0.41"),
        &nu("poisson_ratio = 0.4"),
    );
    let rho = "density_kg_per_m3 = 7595";
    // Without [lumped] masses there is nothing to compare a light material with.
    let without = |text: &'static str| {
        let text = template(SceneKind::Planetary).replace(rho, text);
        let (head, tail) = text.split_once("[lumped]").unwrap();
        let tail = tail.split_once("[damping]").unwrap().1;
        warnings(&Scene::from_toml(&format!("{head}[damping]{tail}")).unwrap())
    };
    assert!(without("density_kg_per_m3 = 7.8")[0].likely.contains("g/cm³"));
    assert_eq!(without("density_kg_per_m3 = 499")[0].key, "material.density_kg_per_m3");
    assert_eq!(without("density_kg_per_m3 = 501"), []);
    assert_eq!(without("density_kg_per_m3 = 20001")[0].key, "material.density_kg_per_m3");
    assert_eq!(without("density_kg_per_m3 = 19999"), []);
}

#[test]
fn masses_and_inertias_against_discs() {
    let mass = "sun = 0.40, planet = 0.66";
    // The planet's disc: π (49.135² − 36.83²) mm² · 25.4 mm · 7595 kg/m³ = 0.6411 kg.
    border(
        "lumped.mass_kg.planet",
        "disc",
        &[(mass, "sun = 0.40, planet = 1.93")],
        &[(mass, "sun = 0.40, planet = 1.92")],
    );
    // The sun's disc: π (38.66² − 28.58²) mm² · 25.4 mm · 7595 kg/m³ = 0.411 kg. A shaft on it may weigh more, not
    // less.
    let inertia = "{ sun = 0.483e-3, planet = 1.27e-3";
    let light = [(mass, "sun = 0.136, planet = 0.66"), ("{ sun = 0.483e-3", "{ sun = 0.2e-3")];
    border("lumped.mass_kg.sun", "in g or t", &light, &[(mass, "sun = 0.138, planet = 0.66")]);
    border(
        "lumped.mass_kg.sun",
        "in g or t",
        &[(mass, "sun = 138, planet = 0.66")],
        &[(mass, "sun = 136, planet = 0.66")],
    );
    // Its inertia: 0.411/2 (38.66² + 28.58²) mm² = 0.475e-3 kg m²; a generator has some 10⁴ times that.
    border(
        "lumped.inertia_kg_m2.sun",
        "kg mm²",
        &[("{ sun = 0.483e-3", "{ sun = 483")],
        &[("{ sun = 0.483e-3", "{ sun = 150")],
    );
    // The planet's inertia: 0.6411/2 (49.135² + 36.83²) mm² = 1.209e-3 kg m².
    let heavy =
        [(mass, "sun = 0.40, planet = 1.9"), (inertia, "{ sun = 0.483e-3, planet = 3.64e-3")];
    let less =
        [(mass, "sun = 0.40, planet = 1.9"), (inertia, "{ sun = 0.483e-3, planet = 3.61e-3")];
    border("lumped.inertia_kg_m2.planet", "disc", &heavy, &less);
    // Tip radius 52.5 mm: 0.66 kg on it are 1.819e-3 kg m².
    border(
        "lumped.inertia_kg_m2.planet",
        "gyration",
        &[(inertia, "{ sun = 0.483e-3, planet = 1.83e-3")],
        &[(inertia, "{ sun = 0.483e-3, planet = 1.81e-3")],
    );
    // Both beyond their borders have one cause and one line.
    let both =
        [(mass, "sun = 0.40, planet = 3.9"), (inertia, "{ sun = 0.483e-3, planet = 22.4e-3")];
    let found = warnings(&scene(&both));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].key == "lumped.mass_kg.planet" && found[0].what.contains("kg m²"),
        "{found:?}"
    );
}

#[test]
fn a_set_of_another_size_does_not_keep_the_masses_of_the_template() {
    let text: String = template(SceneKind::Planetary)
        .lines()
        .map(|line| {
            let code = line.split('#').next().unwrap_or("");
            match code.split_once('=') {
                Some((key, value)) if key.trim().ends_with("_mm") && !value.contains('{') => {
                    format!("{key}= {}\n", value.trim().parse::<f64>().unwrap() * 3.5)
                }
                _ => format!("{line}\n"),
            }
        })
        .collect();
    let keys: Vec<String> =
        warnings(&Scene::from_toml(&text).unwrap()).into_iter().map(|w| w.key).collect();
    for name in ["sun", "planet", "carrier"] {
        assert!(keys.contains(&format!("lumped.mass_kg.{name}")), "{keys:?}");
    }
}

#[test]
fn inertias_of_parameter_only_sets() {
    let text = std::fs::read_to_string(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../scenes/lin_parker_1999_3p.toml"
    ))
    .unwrap();
    let with = |value: &str| {
        let text = text.replace(
            "inertia_over_r2_kg = { sun = 0.39, ring = 3.00, carrier = 6.29, planet = 0.61",
            &format!("inertia_over_r2_kg = {{ ring = 3.00, carrier = 6.29, {value}"),
        );
        warnings(&Scene::from_toml(&text).unwrap())
    };
    assert_eq!(with("sun = 0.39, planet = 6.59"), []);
    assert_eq!(with("sun = 0.39, planet = 6.61")[0].key, "lumped.inertia_over_r2_kg.planet");
    // A generator on the sun's shaft.
    assert_eq!(with("sun = 1e4, planet = 0.61"), []);
    assert_eq!(with("sun = 390e3, planet = 0.61")[0].key, "lumped.inertia_over_r2_kg.sun");
}

#[test]
fn bearings_and_torsional_supports_against_a_mesh() {
    // Meshes of 350e6 N/m; without a torque only their ratio counts.
    let no_torque = ("torque_nm = 1413", "torque_nm = 0");
    let sun = "motion = \"free\"\nbearing_n_per_m = 87.6e6";
    let at = |text: &'static str| [no_torque, (sun, text)];
    border(
        "sun.bearing_n_per_m",
        "N/mm",
        &at("motion = \"free\"\nbearing_n_per_m = 3.49e4"),
        &at("motion = \"free\"\nbearing_n_per_m = 3.51e4"),
    );
    // Under 10 kN a mesh 1e5 N/m is the border.
    border(
        "sun.bearing_n_per_m",
        "N/mm",
        &[(sun, "motion = \"free\"\nbearing_n_per_m = 87.6e3")],
        &[(sun, "motion = \"free\"\nbearing_n_per_m = 1.01e5")],
    );
    border(
        "sun.torsional_n_per_m",
        "N/µm",
        &at("motion = \"free\"\ntorsional_n_per_m = 3.49e4"),
        &at("motion = \"free\"\ntorsional_n_per_m = 3.51e4"),
    );
    // r_b = 35.2 mm: 3.5e4 N/m are 43.37 N·m/rad.
    border(
        "sun.torsional_nm_per_rad",
        "N·mm/rad",
        &at("motion = \"free\"\ntorsional_nm_per_rad = 43.2"),
        &at("motion = \"free\"\ntorsional_nm_per_rad = 43.5"),
    );
    let pin = "bearing_n_per_m = 87.6e6            # between";
    let at = |text: &'static str| [no_torque, (pin, text)];
    border(
        "planet.bearing_n_per_m",
        "N/mm",
        &at("bearing_n_per_m = 3.49e5 #"),
        &at("bearing_n_per_m = 3.51e5 #"),
    );
}

#[test]
fn lengths_against_the_module() {
    let width = "face_width_mm = 25.4";
    let no_lumped_mass = |value: &str| {
        let text =
            template(SceneKind::GearPair).replace(width, &format!("face_width_mm = {value}"));
        warnings(&Scene::from_toml(&text).unwrap())
    };
    // Operating module 2·88.9/62 = 2.8677 mm.
    assert_eq!(no_lumped_mass("1e-6")[0].key, "geometry.face_width_mm");
    assert_eq!(no_lumped_mass("1.43")[0].key, "geometry.face_width_mm");
    assert_eq!(no_lumped_mass("1.44"), []);
    assert_eq!(no_lumped_mass("573"), []);
    assert_eq!(no_lumped_mass("574")[0].key, "geometry.face_width_mm");
    assert_eq!(no_lumped_mass("10000")[0].key, "geometry.face_width_mm");
    // All lengths of the pair in another unit.
    let scaled = |factor: f64| {
        let mut text = String::new();
        for line in template(SceneKind::GearPair).lines() {
            let code = line.split('#').next().unwrap_or("");
            match code.split_once('=') {
                Some((key, value)) if key.ends_with("_mm ") => {
                    text +=
                        &format!("{key}= {:?}\n", value.trim().parse::<f64>().unwrap() * factor);
                }
                _ => text += &format!("{line}\n"),
            }
        }
        warnings(&Scene::from_toml(&text).unwrap())
    };
    assert!(scaled(1.0 / 25.4)[0].likely.contains("inches"));
    assert!(scaled(1e-3)[0].likely.contains(" m:"));
    assert_eq!(scaled(0.199 / 2.8677)[0].key, "geometry.center_distance_mm");
    assert_eq!(scaled(0.201 / 2.8677), []);
    assert_eq!(scaled(99.0 / 2.8677), []);
    assert_eq!(scaled(101.0 / 2.8677)[0].key, "geometry.center_distance_mm");
}

#[test]
fn deflection_against_the_module_warns_and_then_is_a_fault() {
    // At 1413 N·m: 2·10.0 kN (1/404.4 + 1/87.6) m/GN = 0.279 mm, 0.0973 of the module.
    let torque = |text: &'static str| [("torque_nm = 1413", text)];
    border(
        "operation.torque_nm",
        "give way",
        &torque("torque_nm = 3660"),
        &torque("torque_nm = 3600"),
    );
    let with = |value: &str| {
        let text = template(SceneKind::Planetary)
            .replace("torque_nm = 1413", &format!("torque_nm = {value}"));
        Scene::from_toml(&text).map_err(|e| e.to_string())
    };
    assert!(with("14400").is_ok());
    for value in ["14700", "-14700", "1413e3"] {
        let error = with(value).unwrap_err();
        assert!(
            error.contains("operation.torque_nm") && error.contains("more than the module"),
            "{error}"
        );
    }
    // A planet bearing in N/mm.
    let text = template(SceneKind::Planetary).replace("87.6e6            # between", "87.6e3 #");
    let error = Scene::from_toml(&text).unwrap_err();
    assert_eq!(error.faults().len(), 1);
    assert!(error.to_string().contains("planet.bearing_n_per_m"), "{error}");
}

#[test]
fn damping_near_the_highest_mode() {
    let scene_of = |key: &str, value: f64| {
        let text = template(SceneKind::Planetary);
        let line = text
            .lines()
            .find(|l| l.starts_with(key) || l.starts_with(&format!("# {key}")))
            .unwrap();
        let text = text.replace(line, &format!("{key} = {value:?}"));
        warnings(&Scene::from_toml(&text).unwrap())
    };
    let template = scene(&[]);
    let omega = estimates::highest_frequency(&template).unwrap();
    // Four meshes of 350e6 N/m on a sun of 0.40 kg.
    assert!((omega / (1.4e9f64 / 0.4).sqrt() - 1.0).abs() < 1e-12);
    for (key, border) in [
        ("stiffness_proportional_s", 2.0 / omega),
        ("mass_proportional_per_s", 2.0 * omega),
        ("bearing_s", 2.0 / omega),
    ] {
        assert_eq!(scene_of(key, 0.999 * border), [], "{key}");
        let found = scene_of(key, 1.001 * border);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].key, format!("damping.{key}"));
    }
}

#[test]
fn mesh_frequency() {
    // 1600 rpm make 565.71 Hz.
    let speed = |text: &'static str| [("speed_rpm = 1600", text)];
    border(
        "operation.speed_rpm",
        "mesh frequency",
        &speed("speed_rpm = 282900"),
        &speed("speed_rpm = 282800"),
    );
    border("operation.speed_rpm", "mesh frequency", &speed("speed_rpm = -282900"), &[]);
}

#[test]
fn elements_that_lock_and_steps_that_phasing_does_not_share() {
    let element = "element = \"quadratic\"";
    let key = "fe_contact.element";
    border(
        key,
        "lock",
        &[(element, "element = \"linear\"")],
        &[(element, "element = \"incompatible\"")],
    );
    // Two opposed pairs: half a cycle.
    let steps = "steps_per_cycle = 140";
    let key = "dynamics.steps_per_cycle";
    border(
        key,
        "multiple of 2",
        &[(steps, "steps_per_cycle = 141")],
        &[(steps, "steps_per_cycle = 142")],
    );
}

#[test]
fn lumped_parameters_against_the_geometry() {
    let line = "# radius_mm = { sun = 35.2 }";
    let radius = |text: &'static str| [(line, text)];
    // The centre distance is 88.9 mm.
    border(
        "lumped.radius_mm.carrier",
        "centre distance",
        &radius("radius_mm = { carrier = 88.4 } #"),
        &radius("radius_mm = { carrier = 88.5 } #"),
    );
    border(
        "lumped.radius_mm.carrier",
        "diameter",
        &radius("radius_mm = { carrier = 177.8 } #"),
        &radius("radius_mm = { carrier = 89.3 } #"),
    );
    let angle = "# pressure_angle_deg = { sun_planet = 24.6, ring_planet = 24.6 }";
    let mesh = scene(&[]).tooth_geometry().unwrap();
    let of = |kind| mesh.mesh(kind).unwrap().pressure_angle.to_degrees();
    use gearset::MeshKind::{RingPlanet, SunPlanet};
    let with = |off: f64| {
        let (s, r) = (of(SunPlanet), of(RingPlanet) + off);
        let text = format!("pressure_angle_deg = {{ sun_planet = {s}, ring_planet = {r} }}");
        warnings(&scene(&[(angle, &text)]))
    };
    assert_eq!(with(0.19), []);
    assert_eq!(with(-0.19), []);
    assert_eq!(with(-0.21)[0].key, "lumped.pressure_angle_deg.ring_planet");
    // c_γ of ISO 6336-1: E b/13 (0.75 ε + 0.25).
    let no_torque = ("torque_nm = 1413", "torque_nm = 0");
    let both = "mesh_n_per_m = { sun_planet = 350e6, ring_planet = 350e6 }";
    let estimate = estimates::estimated_mesh_stiffness(&scene(&[]), mesh.mesh(SunPlanet).unwrap());
    let with = |part: f64| {
        let text = format!(
            "mesh_n_per_m = {{ sun_planet = {:e}, ring_planet = 350e6 }}",
            part * estimate.unwrap()
        );
        warnings(&scene(&[no_torque, (both, &text)]))
    };
    assert_eq!(with(0.26), []);
    assert_eq!(with(0.24)[0].key, "lumped.mesh_n_per_m.sun_planet");
    assert_eq!(with(3.9), []);
    assert_eq!(with(4.1)[0].key, "lumped.mesh_n_per_m.sun_planet");
    assert_eq!(with(101.0), [], "teeth that are meant to be rigid");
}
