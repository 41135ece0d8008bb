//! Sets as reports print them: shifts of three or four digits that close the meshes only nominally, the ring's shift in
//! either sign, and slips of which the message names the cause.

use gearset::{MeshKind, MeshMember, Phasing, Spacing, excitation};
use scene::{Fault, Remarks, Scene, warnings};

/// A planetary set without operating point: teeth, distance, rack, tip, root and fillet of each gear, further lines.
fn set(teeth: [u32; 3], a: &str, module: &str, circles: [[f64; 3]; 3], thickness: &str) -> String {
    let gear = |name: &str, [tip, root, fillet]: [f64; 3]| {
        format!(
            "[geometry.{name}]\ntip_diameter_mm = {tip}\nroot_diameter_mm = {root}\nfillet_radius_mm = {fillet}\n"
        )
    };
    let [z_s, z_p, z_r] = teeth;
    let [sun, planet, ring] = circles;
    format!(
        "format = 1\nkind = \"planetary\"\n[planets]\ncount = 3\n[planet]\nbearing_n_per_m = 1e9\n\
         [teeth]\nsun = {z_s}\nplanet = {z_p}\nring = {z_r}\n\
         [geometry]\ncenter_distance_mm = {a}\nface_width_mm = 100\nrack = {{ {module} }}\n{}{}{}\
         [geometry.thickness]\n{thickness}\n",
        gear("sun", sun),
        gear("planet", planet),
        gear("ring", ring)
    )
}

/// Stage 1 of the NREL 5 MW reference gearbox (19/17/56, module 45).
fn stage_1(shifts: &str) -> String {
    let circles = [[978.808, 798.03, 17.1], [905.47, 724.692, 17.1], [2475.118, 2677.618, 13.5]];
    set(
        [19, 17, 56],
        "863.0",
        "module_mm = 45.0",
        circles,
        &format!("profile_shift = {{ {shifts} }}"),
    )
}

/// Stage 2 (18/36/93, module 21).
fn stage_2(shifts: &str) -> String {
    let circles = [[432.838, 341.838, 7.98], [815.663, 724.663, 7.98], [1906.081, 2000.581, 6.3]];
    set(
        [18, 36, 93],
        "584.0",
        "module_mm = 21.0",
        circles,
        &format!("profile_shift = {{ {shifts} }}"),
    )
}

/// The FZG C pair (16/24, module 4.5) at a distance.
fn c_pair(a: &str, shifts: &str) -> String {
    format!(
        "format = 1\nkind = \"gear_pair\"\nmesh = \"sun_planet\"\n[teeth]\nsun = 16\nplanet = 24\n\
         [geometry]\ncenter_distance_mm = {a}\nface_width_mm = 14.0\nrack = {{ module_mm = 4.5 }}\n\
         [geometry.sun]\ntip_diameter_mm = 82.636\nroot_diameter_mm = 62.386\nfillet_radius_mm = 1.35\n\
         [geometry.planet]\ntip_diameter_mm = 118.544\nroot_diameter_mm = 98.294\nfillet_radius_mm = 1.35\n\
         [geometry.thickness]\n{shifts}\n"
    )
}

/// A planet of 20 teeth in a ring of 50, module 2.
fn ring_pair(a: &str, ring: &str, thickness: &str) -> String {
    format!(
        "format = 1\nkind = \"gear_pair\"\nmesh = \"ring_planet\"\n[teeth]\nplanet = 20\nring = 50\n\
         [geometry]\ncenter_distance_mm = {a}\nface_width_mm = 10.0\nrack = {{ module_mm = 2.0 }}\n\
         [geometry.planet]\ntip_diameter_mm = 44.0\nroot_diameter_mm = 35.0\n{ring}\
         [geometry.thickness]\n{thickness}\n"
    )
}

const RING_96: &str = "[geometry.ring]\ntip_diameter_mm = 96.0\nroot_diameter_mm = 105.0\n";
const RING_97: &str = "fillet_radius_mm = 0.3\n[geometry.ring]\ntip_diameter_mm = 97.0\n\
    root_diameter_mm = 105.0\nfillet_radius_mm = 0.3\n";

fn read(text: &str) -> (Scene, Remarks) {
    Scene::with_remarks(text).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn faults(text: &str) -> Vec<Fault> {
    Scene::from_toml(text).expect_err(text).faults().to_vec()
}

/// The one fault of a text; its key and words of it.
fn assert_only_fault(text: &str, key: &str, words: &[&str]) {
    let faults = faults(text);
    assert!(faults.len() == 1 && faults[0].key == key, "{faults:?}");
    for word in words {
        assert!(faults[0].to_string().contains(word), "{word}: {}", faults[0]);
    }
}

/// Operating pressure angle (°), contact ratio and backlash (mm) of a mesh.
fn mesh(scene: &Scene, kind: MeshKind) -> [f64; 3] {
    let geometry = scene.tooth_geometry().unwrap();
    let mesh = geometry.mesh(kind).unwrap();
    let backlash = 1e3 * geometry.backlash(kind).unwrap();
    [mesh.pressure_angle.to_degrees(), mesh.contact_ratio, backlash]
}

fn assert_mesh(scene: &Scene, kind: MeshKind, expected: [f64; 3], within: [f64; 3]) {
    let found = mesh(scene, kind);
    for i in 0..3 {
        assert!((found[i] - expected[i]).abs() <= within[i], "{kind:?}: {found:?}");
    }
}

/// Warnings of a valid scene, each as one line.
fn all_warnings(text: &str) -> Vec<String> {
    let (scene, remarks) = read(text);
    let found = remarks.warnings.into_iter().chain(warnings(&scene));
    found.map(|warning| warning.to_string()).collect()
}

/// A unit of the last digit printed of an angle, half of one of a contact ratio, and no backlash at all.
const PRINTED: [f64; 3] = [1e-3, 5e-4, 1e-9];

#[test]
fn nominal_shifts_that_leave_less_than_nothing_by_rounding_close_exactly() {
    let (scene, remarks) = read(&stage_2("sun = 0.3890, planet = 0.5039, ring = -0.1171"));
    assert_mesh(&scene, MeshKind::SunPlanet, [24.169, 1.370, 0.0], PRINTED);
    assert_mesh(&scene, MeshKind::RingPlanet, [15.630, 1.618, 0.0], PRINTED);
    assert_eq!(remarks.notes.len(), 2);
    assert!(remarks.notes[0].contains("backlash −0.0005 mm of the sun_planet mesh"), "{remarks:?}");
    assert!(remarks.notes[0].contains("taken as 0"), "{remarks:?}");
    assert!(
        remarks.notes[1].contains("backlash −0.0002 mm of the ring_planet mesh"),
        "{remarks:?}"
    );
    assert!(remarks.warnings.is_empty(), "{remarks:?}");
    // Its file says by how much the teeth are thinner, and is the same scene.
    let again = Scene::from_toml(&scene.to_toml()).unwrap();
    assert_eq!(again, scene);
    scene.check().unwrap();
}

#[test]
fn a_nominal_pair_closes_with_both_gears_thinned_alike() {
    let (scene, remarks) =
        read(&c_pair("91.5", "profile_shift = { sun = 0.1817, planet = 0.1715 }"));
    assert_mesh(&scene, MeshKind::SunPlanet, [22.439, 1.4625, 0.0], [5e-4, 5e-5, 1e-9]);
    assert!(remarks.notes[0].contains("teeth of both gears thinned by"), "{remarks:?}");
    // Hertz at the pitch point under 200 N·m: p = √(F E*/(π b ρ)), printed as 1347 MPa.
    let geometry = scene.tooth_geometry().unwrap();
    let mesh = geometry.sun_planet.as_ref().unwrap();
    let force = 200.0 / mesh.gear(MeshMember::Driver).base_radius;
    let radius = |member| mesh.pitch_radius(member) * mesh.pressure_angle.sin();
    let curvature = 1.0 / radius(MeshMember::Driver) + 1.0 / radius(MeshMember::Driven);
    let modulus = scene.material.young_modulus_pa / (2.0 * (1.0 - 0.3f64.powi(2)));
    let pressure =
        (force / geometry.face_width * modulus * curvature / std::f64::consts::PI).sqrt();
    assert!((pressure / 1e6 - 1347.0).abs() < 0.5, "{pressure}");
}

#[test]
fn exact_numbers_have_no_rounding() {
    let (mut scene, _) = read(&c_pair("91.5", "profile_shift = { sun = 0.19, planet = 0.17 }"));
    let geometry = scene.geometry.as_mut().unwrap();
    let input = gearset::ThicknessInput::ProfileShift {
        sun: 0.1819,
        planet: 0.1715,
        ring: 0.0,
        thinning: gearset::Thinning::default(),
    };
    geometry.thickness = input;
    // The same digits in a file are rounded: −0.7 µm are within them; a program's are not.
    assert!(Scene::from_toml(&scene.to_toml()).is_ok());
    let faults = scene.check().unwrap_err().0;
    assert_eq!(faults[0].key, "geometry.thickness.profile_shift");
}

#[test]
fn generating_shifts_leave_the_printed_backlash() {
    let (scene, remarks) = read(&stage_2("sun = 0.3805, planet = 0.4924, ring = -0.0962"));
    assert_mesh(&scene, MeshKind::SunPlanet, [24.169, 1.370, 0.314], [1e-3, 5e-4, 5e-4]);
    assert_mesh(&scene, MeshKind::RingPlanet, [15.630, 1.618, 0.483], [1e-3, 5e-4, 5e-4]);
    assert!(remarks.notes.is_empty() && remarks.warnings.is_empty());
    let text = stage_1("sun = 0.6170, planet = 0.8021, ring = 0.5013");
    let (scene, _) = read(&text);
    assert_mesh(&scene, MeshKind::SunPlanet, [28.118, 1.115, 0.0012], [5e-4, 5e-4, 1e-4]);
    assert_mesh(&scene, MeshKind::RingPlanet, [17.161, 1.278, 0.0008], [5e-4, 5e-4, 1e-4]);
    assert!(!all_warnings(&text).iter().any(|w| w.contains("sign")));
}

#[test]
fn the_sign_of_iso_21771_is_recognised_and_has_a_key() {
    // Refused: roots and fillets of the ring are no cause.
    let text = stage_1("sun = 0.6170, planet = 0.8021, ring = -0.5013");
    let key = "geometry.thickness.profile_shift.ring";
    assert_only_fault(&text, key, &["ISO 21771", "ring_sign = \"iso_21771\"", "0.0008 mm"]);
    // Accepted, and remarked.
    for (ring, other) in [
        ("sun = 0.3890, planet = 0.5039, ring = 0.1171", "−0.0002 mm"),
        ("sun = 0.3805, planet = 0.4924, ring = 0.0962", "0.4831 mm"),
    ] {
        let found = all_warnings(&stage_2(ring));
        let of_ring: Vec<_> = found.iter().filter(|w| w.contains("backlash")).collect();
        assert!(of_ring.len() == 1 && of_ring[0].contains(other), "{found:?}");
        assert!(of_ring[0].starts_with(&format!("`{key}`")) && of_ring[0].contains("ring_sign"));
    }
    // Named, both are the set itself.
    let iso = stage_1("sun = 0.6170, planet = 0.8021, ring = -0.5013, ring_sign = \"iso_21771\"");
    assert_eq!(read(&iso).0, read(&stage_1("sun = 0.6170, planet = 0.8021, ring = 0.5013")).0);
    let wrong = stage_1("sun = 0.6170, planet = 0.8021, ring = 0.5013, ring_sign = \"iso_21771\"");
    assert_only_fault(&wrong, key, &["positive outwards", "leave `ring_sign` out"]);
}

#[test]
fn backlash_and_allowances_stand_beside_nominal_shifts() {
    let shifts = "profile_shift = { sun = 0.3890, planet = 0.5039, ring = -0.1171 }\n";
    let nominal = stage_2("sun = 0.3890, planet = 0.5039, ring = -0.1171");
    let with = |lines: &str| {
        nominal.replace("[geometry.thickness]\n", &format!("[geometry.thickness]\n{lines}\n"))
    };
    let (scene, _) = read(&with("sun_planet_backlash_mm = 0.3\nring_planet_backlash_mm = 0.4"));
    assert_mesh(&scene, MeshKind::SunPlanet, [24.169, 1.370, 0.3], PRINTED);
    assert_mesh(&scene, MeshKind::RingPlanet, [15.630, 1.618, 0.4], PRINTED);
    // Arcs on the reference circles: 0.25 mm in sum grow by a/a_ref = 584/567.
    let (scene, _) = read(&with("thinning_mm = { sun = 0.1, planet = 0.15, ring = 0.2 }"));
    let more = mesh(&scene, MeshKind::SunPlanet)[2] - 0.25 * 584.0 / 567.0;
    assert!((-5.5e-4..-4.5e-4).contains(&more), "{more}");
    assert_eq!(Scene::from_toml(&scene.to_toml()).unwrap(), scene);
    // Less than the shifts leave by themselves is a contradiction.
    let shifted = stage_2("sun = 0.3805, planet = 0.4924, ring = -0.0962");
    let less = shifted
        .replace("[geometry.thickness]\n", "[geometry.thickness]\nsun_planet_backlash_mm = 0.1\n");
    assert_only_fault(&less, "geometry.thickness.sun_planet_backlash_mm", &["at least 0.3144 mm"]);
    for (lines, key) in [
        ("planet_share = 0.5", "planet_share"),
        ("thinning_mm = { sun = -0.1 }", "thinning_mm.sun"),
        ("thinning_mm = { sun = 0.1 }\nsun_planet_backlash_mm = 0.3", "sun_planet_backlash_mm"),
    ] {
        assert_only_fault(&with(lines), &format!("geometry.thickness.{key}"), &[]);
    }
    let alone = with("thinning_mm = { sun = 0.1 }").replace(shifts, "");
    assert_only_fault(&alone, "geometry.thickness.thinning_mm", &["profile_shift"]);
}

#[test]
fn shift_and_distance_are_named_where_they_jam_the_mesh() {
    for ring in [RING_96, RING_97] {
        let text = ring_pair("31.0", ring, "profile_shift = { planet = 0.0, ring = 0.0 }");
        let words =
            ["x_ring − x_planet = 0.5567 or more at 31.000 mm", "none at 30.000 mm", "−0.8375 mm"];
        assert_only_fault(&text, "geometry.thickness.profile_shift", &words);
        let text = ring_pair("30.0", ring, "profile_shift = { planet = 0, ring = -0.3434 }");
        let words = [
            "backlash −0.4999 mm",
            "with the other sign of the ring's shift it would be 0.4999 mm",
        ];
        assert_only_fault(&text, "geometry.thickness.profile_shift", &words);
    }
    // 0.556693 is backlash 0, and no −0.0000; circles as the shift makes them.
    let ring = "[geometry.ring]\n";
    let text = ring_pair("31.0", ring, "profile_shift = { planet = 0.0, ring = 0.556693 }");
    let (scene, _) = read(&text);
    let [_, _, backlash] = mesh(&scene, MeshKind::RingPlanet);
    assert!((-1e-9..1e-6).contains(&backlash), "{backlash}");
    let (scene, _) =
        read(&ring_pair("30.0", RING_97, "profile_shift = { planet = 0, ring = 0.3434 }"));
    assert!((mesh(&scene, MeshKind::RingPlanet)[2] - 0.4999).abs() < 1e-4);
}

#[test]
fn a_wrong_number_of_teeth_is_named_as_the_cause() {
    let circles = [[95.0, 72.5, 1.5], [195.0, 172.5, 1.5], [455.0, 477.5, 1.5]];
    let with = |teeth| set(teeth, "135.0", "module_mm = 5.0", circles, "");
    assert_only_fault(&with([17, 37, 93]), "teeth.ring", &["is 93", "91, as in Z_r = Z_s + 2 Z_p"]);
    // So far off that the ring's tip lies within its base circle, or that there is no mesh at all.
    assert_only_fault(&with([17, 37, 105]), "teeth.ring", &["91"]);
    let circles = [[95.0, 72.5, 1.5], [195.0, 172.5, 1.5], [445.0, 467.5, 1.5]];
    let with = |teeth| set(teeth, "135.0", "module_mm = 5.0", circles, "");
    assert_only_fault(&with([17, 47, 91]), "teeth.planet", &["37"]);
    assert_only_fault(&with([27, 37, 91]), "teeth.sun", &["17"]);
    assert!(Scene::from_toml(&with([17, 37, 91])).is_ok());
    let bare =
        "format = 1\nkind = \"planetary\"\n[planets]\ncount = 3\n[planet]\nbearing_n_per_m = 1e8\n";
    let found = all_warnings(&format!("{bare}[teeth]\nsun = 18\nplanet = 27\nring = 78\n"));
    assert!(found.len() == 1 && found[0].contains("Z_s + 2 Z_p = 72"), "{found:?}");
    assert!(all_warnings(&format!("{bare}[teeth]\nsun = 18\nplanet = 27\nring = 72\n")).is_empty());
}

#[test]
fn a_wrong_distance_is_named_as_the_cause() {
    let circles = [[410.324, 332.824, 5.0], [716.969, 639.469, 5.0], [1646.359, 1727.359, 5.0]];
    let rack = "module_mm = 18.13517685825927, pressure_angle_deg = 20.138168098991137";
    let shifts = "profile_shift = { sun = 0.41687, planet = 0.37131, ring = -0.11613 }";
    let key = "geometry.center_distance_mm";
    let text = set([20, 37, 93], "584.0", rack, circles, shifts);
    assert_only_fault(&text, key, &["516.853 mm", "529.999 mm"]);
    // A pair set 2.5 mm apart is valid and remarked.
    let shifts = "profile_shift = { sun = 0.1817, planet = 0.1715 }";
    let found = all_warnings(&c_pair("94.0", shifts));
    assert!(found.len() == 1 && found[0].contains("0.50642 of the module"), "{found:?}");
    assert!(found[0].starts_with(&format!("`{key}`")) && found[0].contains("none at 91.5"));
    assert!(all_warnings(&c_pair("91.5", shifts)).is_empty());
}

#[test]
fn interferences_of_both_meshes_are_told_at_once_with_the_tips_that_fit() {
    let default = 0.3 * 2.0 * 20f64.to_radians().cos();
    let circles =
        |planet, ring| [[28.0, 19.0, default], [planet, 31.0, default], [ring, 101.0, default]];
    let with = |planet, ring| set([12, 18, 48], "30", "module_mm = 2", circles(planet, ring), "");
    let found = faults(&with(40.0, 92.0));
    let [planet, ring] = &found[..] else { panic!("{found:?}") };
    assert_eq!(planet.key, "geometry.planet.tip_diameter_mm");
    assert!(planet.why.contains("0.4118 mm") && planet.allowed.contains("at most 39.5666 mm"));
    assert_eq!(ring.key, "geometry.ring.tip_diameter_mm");
    assert!(ring.why.contains("1.2319 mm") && ring.allowed.contains("at least 92.5151 mm"));
    // No fillet helps where the involute ends on the base circle.
    assert!(!planet.allowed.contains("fillet") && !ring.allowed.contains("fillet"));
    assert!(Scene::from_toml(&with(39.566, 92.516)).is_ok());
    // A tip of 39.5666 mm printed with three digits is that tip; one digit further it is another.
    let (scene, remarks) = read(&with(39.567, 92.516));
    assert!((2e3 * scene.geometry.unwrap().planet.tip_radius_m - 39.56655).abs() < 1e-4);
    assert!(
        remarks.notes.len() == 1 && remarks.notes[0].contains("the planet's tip"),
        "{remarks:?}"
    );
    assert_eq!(faults(&with(39.569, 92.516))[0].key, "geometry.planet.tip_diameter_mm");
}

/// 30/60/150 of module 1: 0.4 and 0.25 mm of bottom clearance are missing; what printed digits leave open is none.
#[test]
fn bottom_clearance_of_nothing_is_none_missing() {
    let circles =
        |ring_tip, ring_root| [[32.0, 27.5, 0.1], [60.5, 57.5, 0.1], [ring_tip, ring_root, 0.1]];
    let with = |ring_tip, ring_root| {
        set([30, 60, 150], "45", "module_mm = 1", circles(ring_tip, ring_root), "")
    };
    let digs = |text: &str| {
        Scene::from_toml(text).is_err_and(|e| e.faults().iter().any(|f| f.why.contains("digs")))
    };
    assert!(digs(&with(147.0, 152.5)) && digs(&with(148.5, 150.38)));
    assert!(!digs(&with(148.5, 150.495)) && !digs(&with(148.5, 150.5)));
}

/// A tip that reaches the mating root circle within the rounding of the diameters is told; one with clearance is not.
#[test]
fn missing_bottom_clearance_within_the_rounding_is_told() {
    let warned = |tip: &str| {
        all_warnings(&format!(
            "format = 1\nkind = \"gear_pair\"\nmesh = \"sun_planet\"\nteeth = {{ sun = 40, planet = 75 }}\n\
             [geometry]\ncenter_distance_mm = 115\nface_width_mm = 10\nrack = {{ module_mm = 2 }}\n\
             sun = {{ tip_diameter_mm = {tip}, root_diameter_mm = 75, fillet_radius_mm = 0.05 }}\n\
             planet = {{ tip_diameter_mm = 153, root_diameter_mm = 145.0, fillet_radius_mm = 0.05 }}\n"
        ))
    };
    let [told] = &warned("85.002")[..] else { panic!("{:?}", warned("85.002")) };
    let words = "it lies 1.0000e-3 mm beyond the planet's root circle, within the rounding";
    assert!(told.contains("geometry.sun.tip_diameter_mm") && told.contains(words), "{told}");
    assert!(warned("84").is_empty(), "{:?}", warned("84"));
}

/// Sets of reports on interference: how far which tip goes wrong, planets that overlap, bores taken for diameters.
#[test]
fn interference_is_told_with_its_size() {
    let pair = |mesh: &str, teeth: &str, geometry: &str| {
        format!(
            "format = 1\nkind = \"gear_pair\"\nmesh = \"{mesh}\"\nteeth = {{ {teeth} }}\n[geometry]\n{geometry}"
        )
    };
    let undercut = pair(
        "sun_planet",
        "sun = 20, planet = 8",
        "center_distance_mm = 42\nface_width_mm = 5\nrack = { module_mm = 3, pressure_angle_deg = 14.5 }\n\
         sun = { tip_diameter_mm = 66, root_diameter_mm = 52.5, fillet_radius_mm = 0.5 }\n\
         planet = { tip_diameter_mm = 30, root_diameter_mm = 16.5, fillet_radius_mm = 0.5 }\n",
    );
    assert_only_fault(&undercut, "geometry.sun.tip_diameter_mm", &["5.1500 mm", "61.7791 mm"]);
    let few_teeth = pair(
        "ring_planet",
        "planet = 68, ring = 70",
        "center_distance_mm = 1\nface_width_mm = 10\nrack = { module_mm = 1 }\n\
         planet = { tip_diameter_mm = 70, root_diameter_mm = 65.5, fillet_radius_mm = 0.2 }\n\
         ring = { tip_diameter_mm = 68.5, root_diameter_mm = 72.5, fillet_radius_mm = 0.2 }\n",
    );
    assert_only_fault(&few_teeth, "geometry.ring.tip_diameter_mm", &["tip fouling"]);
    let bores = pair(
        "sun_planet",
        "sun = 40, planet = 75",
        "center_distance_mm = 115\nface_width_mm = 20\nrack = { module_mm = 2 }\n\
         sun = { tip_diameter_mm = 84, root_diameter_mm = 75, bore_diameter_mm = 80 }\n\
         planet = { tip_diameter_mm = 154, root_diameter_mm = 145, bore_diameter_mm = 150 }\n",
    );
    let keys: Vec<String> = faults(&bores).into_iter().map(|fault| fault.key).collect();
    assert_eq!(keys, ["geometry.sun.bore_diameter_mm", "geometry.planet.bore_diameter_mm"]);
    let four = DIAGNOSIS.replace("planets.count = 3", "planets.count = 4");
    let overlaps = faults(&four);
    assert!(overlaps.iter().all(|f| f.key == "planets.count" && f.why.contains("4.0812 mm")));
    assert!(overlaps.len() == 1 && overlaps[0].why.contains("3 more pairs"), "{overlaps:?}");
}

/// A test gearbox for diagnosis from a thesis: 17/37/91, module 5, with the tips of standard teeth.
const DIAGNOSIS: &str = "format = 1\nkind = \"planetary\"\nplanets.count = 3\n\
    teeth = { sun = 17, planet = 37, ring = 91 }\n[planet]\nbearing_n_per_m = 5.8e7\n\
    [geometry]\ncenter_distance_mm = 135\nface_width_mm = 6\nrack = { module_mm = 5 }\n\
    [geometry.sun]\ntip_diameter_mm = 95\nroot_diameter_mm = 72.5\nfillet_radius_mm = 1.5\n\
    [geometry.planet]\ntip_diameter_mm = 195\nroot_diameter_mm = 172.5\nfillet_radius_mm = 1.5\n\
    [geometry.ring]\ntip_diameter_mm = 445\nroot_diameter_mm = 467.5\nfillet_radius_mm = 1.5\n\
    [operation]\nfixed = \"ring\"\ninput = \"sun\"\nspeed_rpm = 800\ntorque_nm = 7.87\n";

/// f_m = Z_s Z_r n_s/60 (Z_s + Z_r), contact ratios from tip circle to tip circle, γ of the ring meshes.
#[test]
fn a_set_of_standard_teeth_has_the_meshing_of_the_formulas() {
    let scene = read(DIAGNOSIS).0;
    let geometry = scene.tooth_geometry().unwrap();
    let ratio = |kind| geometry.mesh(kind).unwrap().contact_ratio;
    assert!((ratio(MeshKind::SunPlanet) - 1.6064).abs() < 5e-5);
    assert!((ratio(MeshKind::RingPlanet) - 1.9418).abs() < 5e-5);
    let phases = Phasing::new(&geometry, &scene.planets).unwrap();
    assert!((phases.gamma() - 0.23779).abs() < 5e-6, "{}", phases.gamma());
    let frequency = scene.kinematics().unwrap().mesh_frequency_hz;
    assert!((frequency - 190.988).abs() < 5e-4, "{frequency}");
}

/// Stage 1 under the torque that its report prints: T/(N r_b) is 829 478.6 N in each sun mesh.
#[test]
fn the_force_of_each_mesh_is_that_of_the_printed_torque() {
    let scene = read(&stage_1("sun = 0.6170, planet = 0.8021, ring = 0.5013")).0;
    let radius = scene.tooth_geometry().unwrap().sun.unwrap().base_radius;
    let force = 999_650.9 / 3.0 / radius;
    assert!((force - 829_478.6).abs() < 0.05, "{force}");
}

/// Planets of published sets by the phases of their first harmonic: rotation, translation, planets against each other.
/// Where (Z_s + Z_r)/N is not whole, the nearest steps are taken.
#[test]
fn planets_stand_at_the_nearest_steps_and_mesh_with_their_phasors() {
    for (count, [z_s, z_p, z_r], steps, torque, [plus, minus], planets) in [
        (4, [16, 16, 48], vec![0, 16, 32, 48], 1.0, [0.0, 0.0], 0.0),
        (4, [17, 17, 51], vec![0, 17, 34, 51], 0.0, [0.0, 1.0], 0.0),
        (4, [18, 18, 54], vec![0, 18, 36, 54], 0.0, [0.0, 0.0], 1.0),
        (4, [18, 17, 52], vec![0, 18, 35, 53], 0.393, [0.0, 0.0], 0.920),
        (5, [18, 17, 52], vec![0, 14, 28, 42, 56], 0.0, [0.0, 0.0], 1.0),
        (5, [16, 17, 50], vec![0, 13, 26, 40, 53], 0.301, [0.163, 0.920], 0.221),
    ] {
        let scene = read(&format!(
            "format = 1\nkind = \"planetary\"\nplanets.count = {count}\nplanet.bearing_n_per_m = 1e8\n\
             teeth = {{ sun = {z_s}, planet = {z_p}, ring = {z_r} }}\n"
        ))
        .0;
        assert_eq!(scene.planets.steps.as_deref(), Some(&steps[..]));
        let e = excitation(&Spacing::of(&scene.planets, scene.teeth).unwrap(), z_s, 1);
        let found = [e.net_torque, e.net_force_plus, e.net_force_minus, e.planet];
        for (found, expected) in found.into_iter().zip([torque, plus, minus, planets]) {
            assert!((found - expected).abs() < 6e-4, "{steps:?}: {e:?}");
        }
    }
}

/// Numbers between 0 and 1 that are the same in every run.
struct Draws(u64);

impl Draws {
    fn next(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn whole(&mut self, from: u32, to: u32) -> u32 {
        from + (self.next() * f64::from(to - from + 1)) as u32
    }
}

fn inv(alpha: f64) -> f64 {
    alpha.tan() - alpha
}

#[test]
fn two_hundred_published_sets_are_accepted_and_slips_of_sign_told() {
    let mut draws = Draws(58);
    let (mut thinned, mut slips, mut remarked) = (0, 0, 0);
    for index in 0..200 {
        let [z_s, z_p] = [draws.whole(17, 36), draws.whole(20, 48)];
        let z_r = z_s + 2 * z_p + draws.whole(0, 3);
        let module = [1.0, 2.0, 2.5, 4.0, 6.0, 10.0, 21.0][draws.whole(0, 6) as usize];
        // A distance above the reference one, as a whole number, a half or with two digits.
        let reference = 0.5 * module * f64::from(z_s + z_p);
        let wanted = reference + module * (0.15 + 0.75 * draws.next());
        let a = match index % 3 {
            0 => format!("{:.2}", wanted),
            1 => format!("{:.1}", (2.0 * wanted).round() / 2.0),
            _ => format!("{:.3}", wanted),
        };
        let distance: f64 = a.parse().unwrap();
        let alpha = 20f64.to_radians();
        let closing = |teeth: u32| {
            let z = f64::from(teeth);
            let working = (0.5 * module * z * alpha.cos() / distance).acos();
            z * (inv(working) - inv(alpha)) / (2.0 * alpha.tan())
        };
        let (sum, difference) = (closing(z_s + z_p), closing(z_r - z_p));
        let x_p = sum * (0.35 + 0.3 * draws.next());
        let [x_s, x_r] = [sum - x_p, difference + x_p];
        let digits = 3 + index % 2;
        let shifts = |x_r: f64| {
            format!("sun = {x_s:.digits$}, planet = {x_p:.digits$}, ring = {x_r:.digits$}")
        };
        let text = |shifts: &str| {
            format!(
                "format = 1\nkind = \"planetary\"\nplanets.count = 3\nteeth = {{ sun = {z_s}, planet = {z_p}, ring = {z_r} }}\n\
                 [geometry]\nface_width_mm = 30\ncenter_distance_mm = {a}\nrack.module_mm = {module}\n\
                 thickness.profile_shift = {{ {shifts} }}\n"
            )
        };
        let (scene, remarks) = read(&text(&shifts(x_r)));
        thinned += usize::from(!remarks.notes.is_empty());
        assert!(remarks.warnings.is_empty(), "{remarks:?}\n{}", text(&shifts(x_r)));
        let rounding = 0.5 * 10f64.powi(-(digits as i32));
        let per_shift = 4.0 * distance * alpha.tan() / f64::from(z_r - z_p);
        for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
            let backlash = mesh(&scene, kind)[2];
            assert!((-1e-9..3.0 * per_shift * rounding).contains(&backlash), "{kind:?} {backlash}");
        }
        let iso = read(&text(&format!("{}, ring_sign = \"iso_21771\"", shifts(-x_r)))).0;
        assert_eq!(iso, scene);
        // The other sign, with circles that follow it and with those of the set.
        if (2.0 * x_r).abs() <= 4.0 * rounding {
            continue;
        }
        slips += 1;
        let slip = text(&shifts(-x_r));
        let mut circles = String::new();
        let input = scene.geometry.as_ref().unwrap();
        for (name, gear, body) in [
            ("sun", input.sun.as_ref(), "bore"),
            ("planet", Some(&input.planet), "bore"),
            ("ring", input.ring.as_ref(), "rim"),
        ] {
            let gear = gear.unwrap();
            let lower = if name == "ring" { -1e-5 } else { 1e-5 };
            circles += &format!(
                "{name} = {{ tip_diameter_mm = {:.3}, root_diameter_mm = {:.3}, fillet_radius_mm = {:.3}, {body}_diameter_mm = {:.3} }}\n",
                2e3 * (gear.tip_radius_m - lower),
                2e3 * gear.root_radius_m,
                1e3 * gear.fillet_radius_m - 1e-3,
                2e3 * gear.body_radius_m.unwrap()
            );
        }
        for text in [slip.clone(), format!("{slip}{circles}")] {
            let told = match Scene::with_remarks(&text) {
                Ok((scene, remarks)) => {
                    remarked += 1;
                    let found = remarks.warnings.into_iter().chain(warnings(&scene));
                    found.map(|warning| warning.to_string()).collect::<Vec<_>>()
                }
                Err(error) => error.faults().iter().map(Fault::to_string).collect(),
            };
            assert!(told.iter().any(|words| words.contains("sign")), "{told:?}\n{text}");
        }
    }
    println!("{thinned} sets thinned, {slips} slips, {remarked} of them valid and remarked");
    assert!(thinned > 50 && slips > 150 && remarked > 50);
}
