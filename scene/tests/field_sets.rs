//! Sets of practitioners: what contradicts inside one file is said, what is usual is not, and keys that a verb
//! would not use are refused there.

use gearset::MeshKind;
use scene::{Fault, Fidelity, Scene, Verb, warnings};

/// A public test gearbox for diagnosis, 17/37/91, module 5, with further lines in [lumped] and at the end.
fn diagnosis(lumped: &str, end: &str) -> Scene {
    let gear = |name: &str, tip: f64, root: f64, body: &str| {
        format!(
            "[geometry.{name}]\ntip_diameter_mm = {tip}\nroot_diameter_mm = {root}\n{body}\nfillet_radius_mm = 1.5\n"
        )
    };
    let text = format!(
        "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = {{ sun = 17, planet = 37, ring = 91 }}\n\
         [geometry]\ncenter_distance_mm = 135.0\nface_width_mm = 6.0\n\
         rack = {{ module_mm = 5.0, pressure_angle_deg = 20.0 }}\n{}{}{}\
         [sun]\nbearing_n_per_m = 1e7\ntorsional_n_per_m = 1e7\n\
         [ring]\nbearing_n_per_m = 1e9\ntorsional_n_per_m = 5.76e7\n\
         [carrier]\nbearing_n_per_m = 1.95e8\ntorsional_n_per_m = 1e7\n[planet]\nbearing_n_per_m = 5.8e7\n\
         [lumped]\nmass_kg = {{ sun = 20.29, planet = 3.91, ring = 59.88, carrier = 57.314 }}\n\
         inertia_kg_m2 = {{ sun = 27049.57e-6, planet = 22368.33e-6, ring = 3853845.79e-6, carrier = 776910.239e-6 }}\n\
         mesh_n_per_m = {{ sun_planet = 8e7, ring_planet = 1e8 }}\n{lumped}\n\
         [operation]\nspeed_rpm = 800\ntorque_nm = 7.87\n{end}",
        gear("sun", 95.0, 72.5, "bore_diameter_mm = 36.25"),
        gear("planet", 195.0, 172.5, "bore_diameter_mm = 86.25"),
        gear("ring", 445.0, 467.5, "rim_diameter_mm = 520.0"),
    );
    Scene::from_toml(&text).unwrap()
}

fn keys(scene: &Scene) -> Vec<String> {
    warnings(scene).into_iter().map(|warning| warning.key).collect()
}

/// Shafts and flanges on sun and ring are none of the program's business; the planets are four times as heavy as
/// their teeth are wide, in mass and inertia alike: one line, and only where masses are used.
#[test]
fn shafts_do_not_warn_and_one_cause_is_one_line() {
    let scene = diagnosis("", "");
    assert_eq!(keys(&scene), ["lumped.mass_kg.planet"]);
    assert!(Verb::Modes.reads("lumped.mass_kg.planet"));
    for verb in [Verb::Rules, Verb::Mesh, Verb::Static, Verb::Impulse, Verb::Sweep(Fidelity::Full)]
    {
        assert!(!verb.reads("lumped.mass_kg.planet"), "{verb:?}");
    }
    // A carrier without a shape has its mass from there.
    assert!(Verb::Impulse.reads("lumped.mass_kg.carrier"));
}

/// The mesh cycle of these planets falls into thirds, which 140 steps do not; only other numbers are a choice.
#[test]
fn the_default_number_of_steps_does_not_warn() {
    let steps = |n: u32| keys(&diagnosis("", &format!("[dynamics]\nsteps_per_cycle = {n}\n")));
    let is_of_steps = |keys: Vec<String>| keys.iter().any(|key| key == "dynamics.steps_per_cycle");
    assert!(!is_of_steps(keys(&diagnosis("", ""))) && !is_of_steps(steps(140)));
    assert!(!is_of_steps(steps(141)) && is_of_steps(steps(142)));
    assert!(
        !Verb::Modes.reads("dynamics.steps_per_cycle")
            && !Verb::Static.reads("dynamics.steps_per_cycle")
    );
}

/// A carrier radius of 126.85 mm beside a distance of 135 mm, reference radii for base radii, nominal for operating
/// angles, teeth in N/mm.
#[test]
fn lumped_keys_that_contradict_the_geometry_are_remarked() {
    for (lumped, key, words) in [
        ("radius_mm = { carrier = 126.85 }", "lumped.radius_mm.carrier", "135 mm"),
        ("radius_mm = { sun = 42.5 }", "lumped.radius_mm.sun", "reference radius"),
        ("radius_mm = { ring = 427.56 }", "lumped.radius_mm.ring", "diameter"),
        (
            "pressure_angle_deg = { sun_planet = 22.5, ring_planet = 20 }",
            "lumped.pressure_angle_deg.sun_planet",
            "operating",
        ),
    ] {
        let found = warnings(&diagnosis(lumped, ""));
        let found =
            found.iter().find(|w| w.key == key).unwrap_or_else(|| panic!("{key}: {found:?}"));
        assert!(found.to_string().contains(words), "{found}");
    }
    // As the geometry has them, in the digits of a table.
    let alike = "radius_mm = { carrier = 135, sun = 39.9, planet = 86.9 }\n\
                 pressure_angle_deg = { sun_planet = 20, ring_planet = 20 }";
    assert_eq!(keys(&diagnosis(alike, "")), ["lumped.mass_kg.planet"]);
}

/// A pair has mass and inertia of its gears twice, for FE/contact and for the lumped model.
#[test]
fn two_masses_of_one_gear_are_remarked() {
    let pair = |mass: f64| {
        let text = scene::template(scene::SceneKind::GearPair);
        let text = format!(
            "{text}\n[sun]\nmass_kg = {mass}\n[lumped]\nmass_kg = {{ sun = 0.7, planet = 1.1 }}\n\
             inertia_kg_m2 = {{ sun = 0.0005, planet = 0.0013 }}\nmesh_n_per_m = {{ sun_planet = 3e8 }}\n"
        );
        keys(&Scene::from_toml(&text).unwrap())
    };
    assert!(pair(0.8).contains(&"sun.mass_kg".to_owned()), "{:?}", pair(0.8));
    assert!(!pair(0.7).contains(&"sun.mass_kg".to_owned()));
}

/// Reflected inertia through a ratio of 5: a generator of 5 kg m² on the sun's shaft, teeth and pins all but rigid.
#[test]
fn a_generator_on_the_sun_and_rigid_teeth_are_no_other_units() {
    let text = "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = { sun = 18, planet = 27, ring = 72 }\n\
                [geometry]\ncenter_distance_mm = 225\nface_width_mm = 100\nrack = { module_mm = 10, pressure_angle_deg = 20 }\n\
                [sun]\nbearing_n_per_m = 1e9\n[ring]\nmotion = \"held\"\n\
                [carrier]\nbearing_n_per_m = 1e9\ntorsional_nm_per_rad = 1e6\n[planet]\nbearing_n_per_m = 1e12\n\
                [lumped]\nmass_kg = { sun = 20, planet = 40, carrier = 200 }\n\
                inertia_kg_m2 = { sun = 5, planet = 0.4, carrier = 4 }\n\
                mesh_n_per_m = { sun_planet = 1e12, ring_planet = 1e12 }\n\
                [operation]\nspeed_rpm = 1500\ntorque_nm = 1000\n";
    assert_eq!(warnings(&Scene::from_toml(text).unwrap()), []);
}

/// Three times the mass of one planet changes modes and compare; the verbs whose planets are meshed alike refuse
/// it, and take a bearing.
#[test]
fn keys_of_single_planets_are_refused_where_they_would_change_nothing() {
    let one = |line: &str| diagnosis("", &format!("[[planet_override]]\nplanet = 1\n{line}\n"));
    let in_fe = [
        Verb::Static,
        Verb::Impulse,
        Verb::Sweep(Fidelity::QuasiStatic),
        Verb::Sweep(Fidelity::MeshLaw),
        Verb::Branches(Fidelity::QuasiStatic),
    ];
    for line in [
        "mass_kg = 11.73",
        "inertia_over_r2_kg = 9.0",
        "sun_planet_n_per_m = 6e7",
        "ring_planet_n_per_m = 6e7",
    ] {
        let scene = one(line);
        let key = format!("planet_override.0.{}", line.split(' ').next().unwrap());
        for verb in in_fe {
            let found: Vec<String> = scene.lacks(verb).into_iter().map(|lack| lack.key).collect();
            assert!(found.contains(&key), "{verb:?} {line}: {found:?}");
        }
        for verb in [Verb::Modes, Verb::Compare, Verb::Rules, Verb::Mesh] {
            assert!(scene.lacks(verb).is_empty(), "{verb:?} {line}");
        }
    }
    let bearing = one("bearing_n_per_m = 4e7");
    for verb in in_fe {
        assert!(
            bearing.lacks(verb).iter().all(|lack| !lack.key.starts_with("planet_override")),
            "{verb:?}"
        );
    }
}

/// The fault of a scene of six numbers with a line in a table, or at the end.
fn fault(table: &str, line: &str) -> Fault {
    let rack =
        |line: &str| format!("rack = {{ module_mm = 30.0, pressure_angle_deg = 20.0{line} }}");
    let (in_rack, line) = match table {
        "rack" => (rack(&format!(", {line}")), String::new()),
        "geometry" => (rack(""), format!("geometry.{line}\n")),
        _ => (rack(""), format!("[{table}]\n{line}\n")),
    };
    // Dotted keys leave every table open for its header.
    let text = format!(
        "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = {{ sun = 21, planet = 39, ring = 99 }}\n\
         geometry.face_width_mm = 300\ngeometry.{in_rack}\n{line}"
    );
    let error = Scene::from_toml(&text).unwrap_err();
    // A key that is needed may be absent under its own name.
    let mut faults = error.faults().iter().filter(|fault| fault.value != "absent");
    let first = faults.next().unwrap_or_else(|| panic!("{error}")).clone();
    assert_eq!(faults.count(), 0, "{error}");
    first
}

/// Stage 1 of the DTU 10 MW gearbox: module 30 mm, 20°, 8° helix are 30.294827 mm and 20.180762° in the transverse
/// section, with which its five planets (26/31/89, 877.033 mm) run at 22.479° and 19.909°, contact ratios 1.4929
/// and 1.7852.
#[test]
fn a_helix_is_answered_with_its_transverse_section() {
    let helix = fault("rack", "helix_angle_deg = 8.0");
    assert_eq!(helix.key, "geometry.rack.helix_angle_deg");
    assert_eq!(helix.value, "out of scope");
    for words in ["module_mm = 30.294827", "pressure_angle_deg = 20.180762"] {
        assert!(helix.allowed.contains(words), "{helix}");
    }
    // Away from the rack the formula.
    assert!(fault("geometry.sun", "beta_deg = 8.0").allowed.contains("m_n/cos β"));
    let gear = |name: &str, tip: f64, root: f64, body: &str| {
        format!(
            "[geometry.{name}]\ntip_diameter_mm = {tip}\nroot_diameter_mm = {root}\n{body}\nfillet_radius_mm = 9\n"
        )
    };
    let scene = Scene::from_toml(&format!(
        "format = 1\nkind = \"planetary\"\nplanets.count = 5\nteeth = {{ sun = 26, planet = 31, ring = 89 }}\n\
         [geometry]\ncenter_distance_mm = 877.033\nface_width_mm = 800.0\n\
         rack = {{ module_mm = 30.294827, pressure_angle_deg = 20.180762 }}\n{}{}{}[planet]\nbearing_n_per_m = 1e10\n",
        gear("sun", 862.366, 728.878, "bore_diameter_mm = 368.5"),
        gear("planet", 1010.186, 876.698, "bore_diameter_mm = 491"),
        gear("ring", 2645.786, 2780.786, "rim_diameter_mm = 3235")
    ));
    let geometry = scene.unwrap().tooth_geometry().unwrap();
    for (kind, angle, ratio) in
        [(MeshKind::SunPlanet, 22.479, 1.4929), (MeshKind::RingPlanet, 19.909, 1.7852)]
    {
        let mesh = geometry.mesh(kind).unwrap();
        assert!(
            (mesh.pressure_angle.to_degrees() - angle).abs() < 5.1e-4,
            "{}",
            mesh.pressure_angle.to_degrees()
        );
        assert!((mesh.contact_ratio - ratio).abs() < 5.1e-5, "{}", mesh.contact_ratio);
    }
}

/// What no model here has is said to be so under its usual names, with what can be done.
#[test]
fn what_is_out_of_scope_is_recognised() {
    for (table, line, words) in [
        ("friction", "coefficient = 0.05", "[damping]"),
        ("sun", "friction_coefficient = 0.05", "[damping]"),
        ("stage2", "ratio = 3", "one scene a stage"),
        ("planet", "compound = true", "gear_pair"),
        ("planet", "stepped = true", "gear_pair"),
        ("planet", "bearing_clearance_um = 30", "the stiffness of a bearing at its load"),
        ("planet", "radial_clearance_um = 30", "the stiffness of a bearing at its load"),
        ("material", "temperature_c = 80", "at the temperature of operation"),
        ("planet", "bearing_speed_rpm = [1, 2]", "branches --over"),
        ("planet", "bearing_radial_n_per_m = 2.9e7", "lies between"),
        ("planet", "bearing_n_s_per_m = 1e3", "bearing_s = c/k"),
        ("damping", "damping_ratio = 0.02", "α/2ω + βω/2"),
        ("planet", "position_error_um = 20", "position_steps"),
        ("geometry.planet", "lead_crowning_um = 5", "face_width_mm"),
        ("lubrication", "oil = \"ISO VG 320\"", "[damping]"),
        ("rack", "diametral_pitch = 8", "25.4/DP"),
        ("lumped", "mesh_amplitude_n_per_m = 1e8", "ParametricSet"),
        ("lumped", "mesh_phases = [0, 0.5]", "ParametricSet"),
    ] {
        let found = fault(table, line);
        assert!(
            found.value == "out of scope" && found.allowed.contains(words),
            "{table} {line}: {found}"
        );
    }
}

/// Keys are guessed by their words and by what their unit measures.
#[test]
fn unknown_keys_are_guessed_by_meaning() {
    for (table, line, why) in [
        ("planet", "bearing_stiffness_n_per_m = 1e8", "did you mean `bearing_n_per_m`?"),
        ("planet", "bearing_n_per_mm = 1e5", "did you mean `bearing_n_per_m`, in another unit?"),
        (
            "geometry.sun",
            "tip_radius_mm = 345",
            "did you mean `tip_diameter_mm`, which is twice the radius?",
        ),
        ("geometry.sun", "outside_diameter_mm = 690", "did you mean `tip_diameter_mm`?"),
        ("geometry", "centre_distance_mm = 900", "did you mean `center_distance_mm`?"),
        ("operation", "torque_knm = 1", "did you mean `torque_nm`, in another unit?"),
        ("operation", "speed_rad_per_s = 100", "did you mean `speed_rpm`, in another unit?"),
        ("operation", "speed_rmp = 100", "did you mean `speed_rpm`?"),
        (
            "material",
            "youngs_modulus_gpa = 206",
            "did you mean `young_modulus_pa`, in another unit?",
        ),
        ("rack", "modul_mm = 30", "did you mean `module_mm`?"),
        ("geometry", "width_mm = 300", "did you mean `face_width_mm`?"),
        ("material", "young_pa = 2e11", "did you mean `young_modulus_pa`?"),
        // Of several diameters none is meant.
        ("geometry.sun", "diameter_mm = 300", "unknown key"),
        // A mass is no stiffness, however alike the letters.
        ("planet", "bearing_kg = 2", "unknown key"),
        ("operation", "torque_n = 2", "unknown key"),
    ] {
        let found = fault(table, line);
        assert!(
            found.why == why || found.why == format!("unknown key; {why}"),
            "{table} {line}: {found}"
        );
    }
}

/// A key that must be there and stands under another name is one fault, and so is what would follow from it.
#[test]
fn a_misnamed_key_is_one_fault() {
    let template = scene::template(scene::SceneKind::Planetary);
    for (key, other) in [
        ("\nkind =", "\ntype ="),
        ("\nsun = 27", "\nsun_teeth = 27"),
        ("\ncount =", "\nnumber ="),
        ("center_distance_mm", "centre_distance_mm"),
        ("face_width_mm", "width_mm"),
        ("mass_kg = {", "masses_kg = {"),
        ("mesh_n_per_m = {", "mesh_stiffness_n_per_m = {"),
    ] {
        assert!(template.contains(key), "{key}");
        let error = Scene::from_toml(&template.replacen(key, other, 1)).unwrap_err();
        let [fault] = error.faults() else { panic!("{other}: {error}") };
        assert!(fault.why.contains("did you mean"), "{fault}");
    }
}

/// A slip in one value is told by its key, once, and not by a value that it makes unlikely.
#[test]
fn a_slip_is_told_by_its_own_key() {
    let six = "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = { sun = 21, planet = 39, ring = 99 }\n\
               geometry = { rack.module_mm = 10, face_width_mm = 230 }\noperation.torque_nm = 20000\n";
    for (from, to, key, words) in [
        (
            "torque_nm = 20000\n",
            "torque_nm = 20000\nmaterial.young_modulus_pa = 206\n",
            "material.young_modulus_pa",
            "GPa",
        ),
        ("face_width_mm = 230", "face_width_mm = 0.23", "geometry.face_width_mm", "write it in mm"),
        ("module_mm = 10", "module_mm = 0.01", "geometry.rack.module_mm", "in m"),
        (
            "module_mm = 10,",
            "module_mm = 10, rack.pressure_angle_deg = 0.349,",
            "geometry.rack.pressure_angle_deg",
            "between 5 and 45",
        ),
        (
            "module_mm = 10,",
            "module_mm = 10, rack.addendum = 10, rack.dedendum = 12.5,",
            "geometry.rack.addendum",
            "between 0 and 4",
        ),
        ("ring = 99", "ring = 101", "teeth.ring", "or a centre distance and shifts"),
        ("face_width_mm", "facewidth_mm", "geometry.facewidth_mm", "did you mean `face_width_mm`?"),
        ("planets.count = 3", "planets.count = 7", "planets.count", "and 6 more pairs do"),
        (
            "operation.torque_nm = 20000",
            "operation = { torque_nm = 20000, output = \"carrier\" }",
            "operation.output",
            "from which the third follows",
        ),
        (
            "operation.torque_nm = 20000",
            "operation.torque_nm = 20000\ndamping.beta = 2e-6",
            "damping.beta",
            "did you mean `stiffness_proportional_s`?",
        ),
        (
            "rack.module_mm",
            "rack.normal_module_mm",
            "geometry.rack.normal_module_mm",
            "m_t = m_n/cos β",
        ),
        (
            "face_width_mm = 230",
            "face_width_mm = 230, rim_thickness_mm = 30",
            "geometry.rim_thickness_mm",
            "rim_diameter_mm of the ring",
        ),
    ] {
        assert!(six.contains(from), "{from}");
        let error = Scene::from_toml(&six.replacen(from, to, 1)).unwrap_err();
        let told = error.faults().iter().find(|f| f.key == key);
        let told = told.unwrap_or_else(|| panic!("{to}: {error}")).to_string();
        assert!(told.contains(words), "{to}: {told}");
        // Two heights of a rack are two faults.
        let others = error.faults().iter().filter(|f| !f.key.starts_with(key)).count();
        assert!(others <= usize::from(to.contains("dedendum")), "{to}: {error}");
    }
    let comma = six
        .replace(
            "geometry = { rack.module_mm = 10, face_width_mm = 230 }",
            "[geometry]\nface_width_mm = 10,5\nrack.module_mm = 10\n[operation]",
        )
        .replace("operation.torque_nm", "torque_nm");
    let error = Scene::from_toml(&comma).unwrap_err().to_string();
    assert!(error.contains("decimals are written with a point"), "{error}");
}

/// Parameters alone, in another unit; a tip relief in another unit.
#[test]
fn units_of_parameters_alone_and_of_tip_relief_are_told() {
    let alone = |lumped: &str| {
        let text = format!(
            "format = 1\nkind = \"planetary\"\nplanets.count = 3\nplanet.bearing_n_per_m = 1e8\n[lumped]\n\
             mass_kg = {{ sun = 0.4, ring = 2.35, carrier = 5.43, planet = 0.66 }}\n\
             inertia_over_r2_kg = {{ sun = 0.39, ring = 3, carrier = 6.29, planet = 0.61 }}\n{lumped}"
        );
        warnings(&Scene::from_toml(&text).unwrap()).into_iter().map(|w| w.key).collect::<Vec<_>>()
    };
    let right = "mesh_n_per_m = { sun_planet = 5e8, ring_planet = 5e8 }\n\
                 pressure_angle_deg = { sun_planet = 24.6, ring_planet = 24.6 }\n";
    assert!(alone(right).is_empty(), "{:?}", alone(right));
    let meshes = ["lumped.mesh_n_per_m.sun_planet", "lumped.mesh_n_per_m.ring_planet"];
    assert_eq!(alone(&right.replace("5e8", "500")), meshes);
    let angles = ["lumped.pressure_angle_deg.sun_planet", "lumped.pressure_angle_deg.ring_planet"];
    assert_eq!(alone(&right.replace("24.6", "0.4294")), angles);
    let relieved = |amount: &str| {
        let text = scene::template(scene::SceneKind::Planetary).replacen(
            "tip_diameter_mm = 84.07",
            &format!("tip_relief = {{ start_diameter_mm = 83, amount_um = {amount} }}\ntip_diameter_mm = 84.07"),
            1,
        );
        let found = warnings(&Scene::from_toml(&text).unwrap());
        found.iter().any(|w| w.key == "geometry.sun.tip_relief.amount_um")
    };
    assert!(relieved("300") && relieved("0.02") && !relieved("20") && !relieved("1"));
}
