//! All faults of a scene are reported at once, each with its key, and no file makes the reader panic.

use proptest::prelude::*;
use scene::{Scene, SceneKind, template};

/// The template with some text replaced; the text must be there.
fn changed(changes: &[(&str, &str)]) -> String {
    let mut text = template(SceneKind::Planetary).to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    text
}

/// Keys of all faults of a text.
fn faulty_keys(text: &str) -> Vec<String> {
    match Scene::from_toml(text) {
        Ok(_) => Vec::new(),
        Err(error) => error.faults().iter().map(|f| f.key.clone()).collect(),
    }
}

fn assert_fault(changes: &[(&str, &str)], key: &str, words: &str) {
    let text = changed(changes);
    let error = Scene::from_toml(&text).expect_err(key);
    let found = error.faults().iter().find(|f| f.key == key);
    let found = found.unwrap_or_else(|| panic!("{key}: {error}"));
    assert!(found.to_string().contains(words), "{found}");
    assert!(found.span.end <= text.len() && found.span.start <= found.span.end);
}

/// Texts put in place of others, and the keys at fault then.
type Faults<'t> = (&'t [(&'t str, &'t str)], &'t [&'t str]);

#[test]
fn all_faults_are_reported_at_once() {
    let text = changed(&[
        ("center_distance_mm = 88.9", "center_distance_mm = -1"),
        ("bearing_n_per_m = 87.6e6\n# torsional", "bearing = 1\n# torsional"),
        ("poisson_ratio = 0.3", "poisson_ratio = 0.7"),
        ("fixed = \"ring\"", "fixed = \"moon\""),
        ("sun = 27", "sun = 27.5"),
    ]);
    let keys = faulty_keys(&text);
    for key in [
        "geometry.center_distance_mm",
        "sun.bearing",
        "material.poisson_ratio",
        "operation.fixed",
        "teeth.sun",
    ] {
        assert!(keys.iter().any(|k| k == key), "{key} not in {keys:?}");
    }
}

/// Changes to the template, the key at fault, words of the message.
type Case = (&'static [(&'static str, &'static str)], &'static str, &'static str);

#[test]
fn each_kind_of_fault_names_its_key_and_says_why() {
    const POSITION: &str = "position_steps = [0, -31, 63, 32]";
    let cases: &[Case] = &[
        (&[("format = 1", "format = 2")], "format", "whole number from 1 to 1"),
        (&[("format = 1", "")], "format", "absent"),
        (&[("\"planetary\"  ", "\"planet\"  ")], "kind", "gear_pair"),
        (&[(POSITION, "positions_deg = [0, -88.4, 180, 91.4]")], "planets.positions_deg", "-31"),
        (&[(POSITION, "position_steps = [0, 10, 63, 32]")], "planets.position_steps", "overlap"),
        (&[(POSITION, "position_steps = [0, 63, 63, 32]")], "planets.position_steps", "same place"),
        (&[(POSITION, "position_steps = [0, 63]")], "planets.position_steps", "4 entries"),
        (&[(POSITION, "position_steps = [1, -31, 63, 32]")], "planets.position_steps", "0 first"),
        (&[("count = 4", "count = 0")], "planets.count", "1 to 64"),
        (&[("ring = 99", "ring = 30")], "teeth.ring", "runs inside"),
        (
            &[("tip_diameter_mm = 84.07", "tip_diameter_mm = 70.0")],
            "geometry.sun.tip_diameter_mm",
            "root diameter",
        ),
        (
            &[("tip_diameter_mm = 84.07", "tip_diameter_mm = 99.0")],
            "geometry.sun.tip_diameter_mm",
            "comes to a point",
        ),
        (
            &[("tip_diameter_mm = 84.07", "tip_diameter_mm = 77.0")],
            "geometry.planet.tip_diameter_mm",
            "contact ratio",
        ),
        (
            &[("root_diameter_mm = 91.54", "root_diameter_mm = 94.0")],
            "geometry.sun.tip_diameter_mm",
            "digs",
        ),
        (
            &[("tip_diameter_mm = 271.8", "tip_diameter_mm = 269.0")],
            "geometry.ring.tip_diameter_mm",
            "form circle",
        ),
        (
            &[("fillet_radius_mm = 0.8              #", "fillet_radius_mm = 2.5              #")],
            "geometry.sun.fillet_radius_mm",
            "overlap",
        ),
        (
            &[("sun_planet_backlash_mm = 0.1", "sun_planet_backlash_mm = -0.1")],
            "geometry.thickness.sun_planet_backlash_mm",
            "jam",
        ),
        (
            &[("center_distance_mm = 88.9", "center_distance_mm = 80.0")],
            "geometry.center_distance_mm",
            "overlap",
        ),
        (
            &[("bore_diameter_mm = 136.8", "bore_diameter_mm = 160.0")],
            "geometry.carrier.bore_diameter_mm",
            "inside the annulus",
        ),
        (
            &[("pin_seat_diameter_mm = 20.0", "pin_seat_diameter_mm = -1.0")],
            "geometry.carrier.pin_seat_diameter_mm",
            "above 0",
        ),
        (&[("plane = \"strain\"", "plane = \"strained\"")], "fe_contact.plane", "\"stress\""),
        (
            &[("element = \"quadratic\"", "element = \"cubic\"")],
            "fe_contact.element",
            "incompatible",
        ),
        (
            &[("flank_elements = 14", "flank_elements = 1000")],
            "fe_contact.flank_elements",
            "3 to 64",
        ),
        (&[("contact_cells = 40", "contact_cells = 2")], "fe_contact.contact_cells", "8 to 400"),
        (
            &[("# mean_positions = 14", "mean_positions = 3")],
            "fe_contact.mean_positions",
            "4 to 140",
        ),
        (
            &[("cell_layout = \"graded\"", "cell_layout = \"fine\"")],
            "fe_contact.cell_layout",
            "\"even\"",
        ),
        (
            &[("contact_cells = 40", "contact_cell = 40")],
            "fe_contact.contact_cell",
            "did you mean `contact_cells`",
        ),
        (
            &[("# matching_depth_mm = 0.57", "matching_depth_mm = -0.57")],
            "fe_contact.matching_depth_mm",
            "above 0",
        ),
        (
            &[(
                "# matching_depth_mm = 0.57",
                "matching_depth_mm = 0.57\nmatching_depth_elements = 1.3",
            )],
            "fe_contact.matching_depth_elements",
            "beside `matching_depth_mm`",
        ),
        (
            &[(
                "# flexibility_factor = { sun_planet = 1.0",
                "flexibility_factor = { sun_planet = 0.0",
            )],
            "fe_contact.flexibility_factor.sun_planet",
            "above 0",
        ),
        (
            &[
                (
                    "# flexibility_factor = { sun_planet = 1.0",
                    "flexibility_factor = { sun_planet = 2",
                ),
                ("[operation]", "[dynamics]\nfidelity = \"full\"\n[operation]"),
            ],
            "fe_contact.flexibility_factor.sun_planet",
            "quasi_static",
        ),
        (
            &[("# added_mass_kg = 0.0", "added_mass_kg = -0.1")],
            "planet.added_mass_kg",
            "0 or above",
        ),
        (
            &[("# added_inertia_kg_m2 = 0.0", "added_inertia_kg_m2 = nan")],
            "planet.added_inertia_kg_m2",
            "0 or above",
        ),
        (&[("planet_base_diameter_mm = 91.26", "")], "geometry.base_pitch_mm", "exactly one of"),
        (
            &[(
                "planet_base_diameter_mm = 91.26",
                "rack = { module_mm = 2.8222, addendum = 1.25 }",
            )],
            "geometry.rack.dedendum",
            "above the addendum 1.25",
        ),
        (
            &[(
                "planet_base_diameter_mm = 91.26",
                "rack = { module_mm = 2.8222, fillet_radius = 0 }",
            )],
            "geometry.rack.fillet_radius",
            "above 0",
        ),
        (&[("tip_diameter_mm = 84.07", "")], "geometry.sun.tip_diameter_mm", "absent"),
        (&[("center_distance_mm = 88.9", "")], "geometry.center_distance_mm", "absent"),
        (&[("mass_kg = { sun = 0.40, ", "mass_kg = { ")], "lumped.mass_kg.sun", "can move"),
        (&[("planet = 1.27e-3, ", "")], "lumped.inertia_kg_m2.planet", "can rotate"),
        (&[("# from = \"geometry\"", "from = \"teeth\"")], "lumped.from", "\"geometry\""),
        (
            &[("young_modulus_pa = 207e9", "young_modulus_pa = inf")],
            "material.young_modulus_pa",
            "",
        ),
        (
            &[("young_modulus_pa = 207e9", "young_modulus_pa = nan")],
            "material.young_modulus_pa",
            "",
        ),
        (&[("motion = \"held\"", "motion = \"hold\"")], "ring.motion", "rotation_held"),
        (&[("input = \"sun\"", "input = \"ring\"")], "operation.input", "cannot be driven"),
        (&[("speed_rpm", "speed_rmp")], "operation.speed_rmp", "did you mean `speed_rpm`"),
        (&[("speed_rpm = 1600", "speed_rpm = ")], "speed_rpm", "TOML"),
        (&[("count = 4", "count = 4\ncount = 4")], "count", "TOML"),
    ];
    for (changes, key, words) in cases {
        assert_fault(changes, key, words);
    }
}

/// Parameters follow from the geometry or are given, and from nothing they do not follow.
#[test]
fn parameters_from_the_geometry_stand_alone_in_their_table() {
    let text = scene::template(scene::SceneKind::Planetary);
    let text = text.replace("# from = \"geometry\"", "from = \"geometry\"");
    assert_eq!(
        faulty_keys(&text),
        ["lumped.mass_kg", "lumped.inertia_kg_m2", "lumped.mesh_n_per_m"]
    );
    let without = |table: &str, text: &str| {
        let (head, tail) = text.split_once(&format!("\n[{table}]")).unwrap();
        format!("{head}\n{}", &tail[tail.find("\n[").unwrap()..])
    };
    let bare = without("lumped", &text);
    let from = format!("{bare}\n[lumped]\nfrom = \"geometry\"\n");
    let [bare, from] = [bare, from].map(|text| Scene::from_toml(&text).unwrap());
    assert!(bare.has_closed_forms() && from.has_closed_forms());
    assert!(bare.limits().is_empty(), "{:?}", bare.limits());
    let keys = faulty_keys(
        "format = 1\nkind = \"planetary\"\n[planets]\ncount = 3\n[planet]\nbearing_n_per_m = 1e8\n\
         [ring]\nmotion = \"held\"\n[lumped]\nfrom = \"geometry\"\n",
    );
    assert_eq!(keys, ["lumped.from"]);
    let pair = scene::template(scene::SceneKind::GearPair);
    assert_eq!(faulty_keys(&format!("{pair}\n[lumped]\nfrom = \"geometry\"\n")), ["lumped.from"]);
}

#[test]
fn parameter_only_sets_are_valid_and_say_what_they_lack() {
    let text = "format = 1\nkind = \"planetary\"\n[planets]\ncount = 3\n[planet]\nbearing_n_per_m = 1e8\n\
        [ring]\nmotion = \"held\"\n[lumped]\nmass_kg = { sun = 1, planet = 1, carrier = 1 }\n\
        inertia_over_r2_kg = { sun = 1, planet = 1, carrier = 1 }\n\
        mesh_n_per_m = { sun_planet = 1e8, ring_planet = 1e8 }\n\
        pressure_angle_deg = { sun_planet = 20, ring_planet = 20 }\n";
    let scene = Scene::from_toml(text).unwrap();
    assert!(scene.limits().iter().any(|l| l.contains("[geometry]")));
    assert!(scene.limits().iter().any(|l| l.contains("[teeth]")));
    // An inertia added to the planets requires their radius.
    let keys = faulty_keys(
        &text.replace("_per_m = 1e8\n[ring]", "_per_m = 1e8\nadded_inertia_kg_m2 = 1\n[ring]"),
    );
    assert_eq!(keys, ["lumped.radius_mm.planet"]);
    // Without geometry the angles are needed.
    let keys = faulty_keys(&text.replace("pressure_angle_deg", "# pressure_angle_deg"));
    assert_eq!(keys, ["lumped.pressure_angle_deg"]);
}

#[test]
fn degrees_that_can_be_assembled_become_exact_steps() {
    let text = changed(&[(
        "position_steps = [0, -31, 63, 32]",
        "positions_deg = [0, -88.57142857, 180, 91.42857143]",
    )]);
    // As a paper prints them, with one decimal.
    let list = "-88.6, 180.0, # about, not exactly, opposite\n 91.4,\n";
    let printed = text.replace("-88.57142857, 180, 91.42857143", list);
    let (rounded, remarks) = Scene::with_remarks(&printed).unwrap();
    assert_eq!(rounded.planets.steps, Some(vec![0, -31, 63, 32]));
    assert!(remarks.notes.iter().any(|note| note.contains("[0, -31, 63, 32]")), "{remarks:?}");
    let scene = Scene::from_toml(&text).unwrap();
    assert_eq!(scene.planets, rounded.planets);
    assert_eq!(scene.planets.psi_rad[2], 63.0 * std::f64::consts::TAU / 126.0);
}

/// Keys of all faults, in the order of the alphabet.
fn sorted_keys(text: &str) -> Vec<String> {
    let mut keys = faulty_keys(text);
    keys.sort();
    keys
}

#[test]
fn faults_of_every_stage_are_listed_in_one_run_and_nothing_that_follows_from_them() {
    let text = changed(&[
        ("count = 4", "count = 4\nnumber = 4"), // a key that is none
        ("position_steps = [0, -31, 63, 32]", "position_steps = [0, 63, 63, 32]"), // whole set
        ("face_width_mm = 25.4", ""),           // absent
        ("tip_diameter_mm = 84.07", "tip_diameter_mm = 70.0"), // geometry of the sun
        ("tip_diameter_mm = 271.8", "tip_diameter_mm = 269.0"), // ring mesh, by form circle
        ("outer_diameter_mm = 233.6", "outer_diameter_mm = 180.0"), // carrier and centre distance
        ("poisson_ratio = 0.3", "poisson_ratio = 0.7"), // value
        ("motion = \"held\"", "motion = \"hold\""), // word
        ("bearing_n_per_m = 87.6e6            # between", "# between"), // absent
        ("mesh_n_per_m = { sun_planet = 350e6, ring_planet = 350e6 }", ""), // absent table
        ("mass_kg = { sun = 0.40, ", "mass_kg = { "), // needed by a free sun
        ("speed_rpm = 1600", "speed_rpm = "),   // syntax
        ("\n[fe_contact]", "\n[fe_contact]\nflexibility_factor = { sun_planet = 2.0 }"),
        ("fidelity = \"quasi_static\"", "fidelity = \"full\""), // two tables together
    ]);
    let expected = [
        "fe_contact.flexibility_factor.sun_planet",
        "geometry.carrier.outer_diameter_mm",
        "geometry.face_width_mm",
        "geometry.ring.tip_diameter_mm",
        "geometry.ring.tip_diameter_mm",
        "geometry.sun.tip_diameter_mm",
        "geometry.sun.tip_diameter_mm",
        "lumped.mass_kg.sun",
        "lumped.mesh_n_per_m",
        "material.poisson_ratio",
        "planet.bearing_n_per_m",
        "planets.number",
        "planets.position_steps",
        "ring.motion",
        "speed_rpm",
    ];
    // The sun's tip lies below its root and its base circle; the ring's touches the planet beyond its form circle
    // and collides with its tips.
    assert_eq!(sorted_keys(&text), expected);
}

#[test]
fn nothing_is_reported_that_only_follows_from_another_fault() {
    let cases: [Faults; 19] = [
        // Positions, base radii, meshes and angles depend on the teeth.
        (&[("sun = 27", "sun = 27.5")], &["teeth.sun"]),
        (&[("planet = 35", "")], &["teeth.planet"]),
        (&[("\n[teeth]", "\n[teethe]")], &["teethe"]),
        // The kind decides what must be there.
        (&[("\"planetary\"  ", "\"planet\"  ")], &["kind"]),
        // Without circles of the sun the planet's thickness is not known.
        (&[("root_diameter_mm = 70.55", "")], &["geometry.sun.root_diameter_mm"]),
        (
            &[("center_distance_mm = 88.9", "center_distance_mm = -1")],
            &["geometry.center_distance_mm"],
        ),
        (&[("planet_base_diameter_mm = 91.26", "")], &["geometry.base_pitch_mm"]),
        (&[("planet_share = 0.5", "planet_share = 5")], &["geometry.thickness.planet_share"]),
        (&[("fixed = \"ring\"", "fixed = \"moon\"")], &["operation.fixed"]),
        (
            &[("fidelity = \"quasi_static\"", "fidelity = \"model\"\nmodes = 4")],
            &["dynamics.fidelity"],
        ),
        (
            &[(
                "fidelity = \"quasi_static\"",
                "fidelity = \"auto\"\nquantity = \"natural_frequency\"",
            )],
            &["dynamics.mode_number", "dynamics.mode_type", "dynamics.tolerance_percent"],
        ),
        (
            &[("fidelity = \"quasi_static\"", "fidelity = \"full\"\ntolerance_percent = 1")],
            &["dynamics.tolerance_percent"],
        ),
        (
            &[(
                "fidelity = \"quasi_static\"",
                "fidelity = \"auto\"\nquantity = \"natural_frequency\"\nmode_type = \"planet\"\nmode_number = 0\n\
                 tolerance_percent = 0",
            )],
            &["dynamics.mode_number", "dynamics.tolerance_percent"],
        ),
        (
            &[("fidelity = \"quasi_static\"", "fidelity = \"auto\"\nquantity = \"amplitude\"")],
            &["dynamics.response", "dynamics.steps_per_cycle", "dynamics.tolerance_percent"],
        ),
        (
            &[(
                "fidelity = \"quasi_static\"",
                "fidelity = \"auto\"\nquantity = \"transmission_error\"\nmode_number = 1\nresponse = \"sun_translation\"\n\
                 tolerance_percent = 5",
            )],
            &["dynamics.mode_number", "dynamics.response"],
        ),
        (
            &[
                (
                    "fidelity = \"quasi_static\"",
                    "fidelity = \"auto\"\nquantity = \"transmission_error\"\ntolerance_percent = 5",
                ),
                ("element = \"quadratic\"", "element = \"linear\""),
                ("flank_elements = 14", "flank_elements = 30"),
                ("flank_layer = \"whole\"", "flank_layer = \"divided\""),
                ("contact_cells = 40", "contact_cells = 100\nmatching_depth_mm = 0.5"),
                ("cell_layout_at_rest = \"even\"", "cell_layout_at_rest = \"graded\""),
            ],
            &[
                "fe_contact.cell_layout_at_rest",
                "fe_contact.contact_cells",
                "fe_contact.element",
                "fe_contact.flank_elements",
                "fe_contact.flank_layer",
                "fe_contact.matching_depth_mm",
            ],
        ),
        (
            &[
                (
                    "fidelity = \"quasi_static\"",
                    "fidelity = \"auto\"\nquantity = \"transmission_error\"\ntolerance_percent = 5",
                ),
                ("# matching_depth_elements = 0.85", "matching_depth_elements = 1.3"),
            ],
            &["fe_contact.matching_depth_elements"],
        ),
        (&[("\n[lumped]", "\nlumped_mass = 1\n[lumped]")], &["planet.lumped_mass"]),
        (&[("motion = \"free\"", "motion = \"fre\"\ntorsional_n_per_m = 1")], &["sun.motion"]),
    ];
    for (changes, keys) in cases {
        assert_eq!(sorted_keys(&changed(changes)), keys, "{changes:?}");
    }
}

#[test]
fn what_a_broken_line_was_to_say_is_not_missed() {
    let nu = ("poisson_ratio = 0.3", "poisson_ratio = 0.7");
    let cases: [Faults; 6] = [
        (&[nu, ("speed_rpm = 1600", "speed_rpm = ")], &["material.poisson_ratio", "speed_rpm"]),
        (&[nu, ("sun = 27", "sun = 27 28")], &["material.poisson_ratio", "sun"]),
        (&[nu, ("\n[operation]", "\n[operation")], &["material.poisson_ratio", "operation"]),
        // After a key without a value nothing is read.
        (&[nu, ("count = 4", "count 4")], &["count 4"]),
        // An unfinished list may hold anything that follows.
        (
            &[("position_steps = [0, -31, 63, 32]", "position_steps = [0, -31,"), nu],
            &["position_steps"],
        ),
        (&[("count = 4", "count = 4\ncount = 4"), nu], &["count", "material.poisson_ratio"]),
    ];
    for (changes, keys) in cases {
        let text = changed(changes);
        let mut found = sorted_keys(&text);
        found.dedup();
        assert_eq!(found, keys, "{}", Scene::from_toml(&text).unwrap_err());
    }
}

#[test]
fn control_characters_reach_no_message_and_no_title() {
    let title = "title = \"A planetary set\"";
    for bad in [
        "title = \"a\\u001b[2Jb\"",
        "title = \"a\\nb\"",
        "title = \"\"\"\na\nb\"\"\"",
        "title = \"a\\u009b2J\"",
    ] {
        assert_fault(&[(title, bad)], "title", "control character U+");
    }
    let source = "source = \"where the numbers come from\"";
    assert_fault(
        &[(source, "source = \"\\u001b]0;x\\u0007\"")],
        "source",
        "control character U+001B",
    );
    // Raw ones, and ones in names of keys, are replaced where faults show the file.
    for bad in
        ["title = \"a\u{1b}[2J\"", "\"t\\u001b[2J\" = 1", "\u{1b}[31m = 1", "x = \"\u{9b}31m\""]
    {
        let error = Scene::from_toml(&changed(&[(title, bad)])).unwrap_err();
        let scene::SceneError::Invalid { text, faults } = &error else { panic!("{error}") };
        let shown: String = faults.iter().map(|f| f.to_string() + &text[f.span.clone()]).collect();
        let is_bad = |c: char| c.is_control() && c != '\n' && c != '\t';
        assert!(!shown.contains(is_bad) && !text.contains(is_bad), "{error}");
    }
}

/// One random edit of a scene's text.
fn mutate(text: &str, kind: u8, at: usize, value: &str) -> String {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let line = at % lines.len();
    match kind % 6 {
        0 => drop(lines.remove(line)),
        1 => lines.insert(line, value.to_owned()),
        2 => lines[line] = lines[line].replacen('=', value, 1),
        3 => {
            let key = lines[line].split('=').next().unwrap_or("").to_owned();
            lines[line] = format!("{key}= {value}");
        }
        4 => lines.swap(line, (at / 7) % text.lines().count()),
        _ => {
            let chars: Vec<char> = lines[line].chars().collect();
            let cut = if chars.is_empty() { 0 } else { (at / 3) % chars.len() };
            lines[line] = chars.iter().take(cut).chain(chars.iter().skip(cut + 1)).collect();
        }
    }
    lines.join("\n")
}

const VALUES: [&str; 20] = [
    "nan",
    "inf",
    "-inf",
    "-1",
    "0",
    "1e308",
    "1e-320",
    "\"x\"",
    "[]",
    "{}",
    "true",
    "1e400",
    "99999999999999999999",
    "[[x]]",
    "'",
    "\u{7f}",
    "é = 1",
    "[geometry]",
    "[0, 1, 2, 3]",
    "1979-05-27",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Up to three edits of a valid scene: it is accepted, or refused with a key and a valid span per fault.
    #[test]
    fn mutated_scenes_never_panic(
        pair in any::<bool>(),
        edits in proptest::collection::vec((any::<u8>(), any::<usize>(), 0..VALUES.len()), 1..4),
    ) {
        let kind = if pair { SceneKind::GearPair } else { SceneKind::Planetary };
        let mut text = template(kind).to_owned();
        for (what, at, value) in edits {
            text = mutate(&text, what, at, VALUES[value]);
        }
        if let Err(error) = Scene::from_toml(&text) {
            prop_assert!(!error.faults().is_empty());
            for fault in error.faults() {
                prop_assert!(!fault.key.is_empty() && !fault.allowed.is_empty());
                prop_assert!(fault.span.end <= text.len());
                prop_assert!(text.is_char_boundary(fault.span.start));
                prop_assert!(text.is_char_boundary(fault.span.end));
            }
        }
    }
}
