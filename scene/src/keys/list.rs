//! Every key of a scene file, declared once: the reader, its faults, the JSON schema and the page of keys follow this
//! list. One row a key, which no line break would make easier to compare. The reason that a fault gives is the first
//! clause of the meaning, unless the row says why.

use std::sync::LazyLock;

use crate::keys::KeyKind::{Choice, Integer, Integers, Number, Numbers, Table, Tables, Text};
use crate::keys::bound::Bound::{Between, Finite, NonNegative, Positive};
use crate::keys::key::{SceneKey, key};

/// Verbs that need a key.
const NONE: &str = "–";
const ALL: &str = "all";
const FE: &str = "mesh, static, impulse, sweep, branches";
const LUMPED: &str = "modes, compare";
const RULES_FE: &str = "rules, mesh, static, impulse, sweep, branches";
const MOTION: &str = "impulse, sweep, branches";
const SWEEP: &str = "sweep, branches";
const LOAD: &str = "static, impulse, sweep, branches";

/// Verbs whose results a key changes.
const AT_ALL: &str = "modes, rules, mesh, static, impulse, sweep, branches";
const BODIES: &str = "modes, mesh, static, impulse, sweep, branches";
const LOADED: &str = "modes, static, impulse, sweep, branches";
const MOVING: &str = "modes, impulse, sweep, branches";
const POSITIONS: &str = "modes, rules, static, impulse, sweep, branches";
const INERTIAL: &str = "modes, mesh, impulse, sweep, branches";
const PARAMETERS: &str = "modes";
const CHOSEN: &str = "modes, static, sweep";

/// Every key, each table before its keys.
pub(crate) static KEYS: LazyLock<Vec<SceneKey>> = LazyLock::new(|| {
    let bodies = [
        per_body("mass_kg", "kg", "mass", "of every body that can move"),
        per_body("inertia_kg_m2", "kg·m²", "polar moment of inertia I", "of every body that can rotate, or inertia_over_r2_kg"),
        per_body("inertia_over_r2_kg", "kg", "I/r², with the r of u = r·θ", "instead of inertia_kg_m2"),
        per_body("radius_mm", "mm", "r in u = r·θ", "base radius, of the carrier the centre distance, from [geometry]"),
    ];
    let gears = ["sun", "planet", "ring"].map(gear).concat();
    let supports = [support("sun"), shaft("sun"), support("ring"), support("carrier"), planet(), shaft("planet")].concat();
    let shape = changing(BODIES, [set(), geometry(), gears, carrier_and_thickness(), material()].concat());
    let lumped = changing(PARAMETERS, [lumped(), bodies.concat(), lumped_meshes(), planet_override()].concat());
    let supports = changing(LOADED, supports);
    let numerics = changing(FE, fe_contact());
    [shape, supports, lumped, changing(MOTION, damping()), changing(LOADED, operation()), numerics, changing(SWEEP, dynamics())].concat()
});

/// These keys, of which those that do not say it themselves change the results of these verbs.
fn changing(verbs: &'static str, keys: Vec<SceneKey>) -> Vec<SceneKey> {
    let all = |key: SceneKey| if key.is_table() || !key.changes.is_empty() { key } else { key.changes(verbs) };
    keys.into_iter().map(all).collect()
}

/// The set: top of the file, planets, teeth.
fn set() -> Vec<SceneKey> {
    vec![
        key("format", Integer(1, 1), "–", "version of the file format").required().why("the number says how to read the file").needed_by(ALL).changes(NONE),
        key("kind", Choice(&["planetary", "gear_pair"]), "–", "a whole planetary set, or one mesh alone").required().needed_by(ALL).changes(AT_ALL),
        key("mesh", Choice(&["sun_planet", "ring_planet"]), "–", "which mesh a gear pair is").left_out("only, and always, of a gear pair").needed_by(ALL).changes(AT_ALL),
        key("title", Text, "–", "name of the set; results carry it").default_is("untitled").changes(NONE),
        key("source", Text, "–", "where the numbers come from").left_out("none").changes(NONE),
        key("planets", Table, "–", "planets on the carrier").left_out("always of a planetary set, never of a gear pair").needed_by(ALL),
        key("planets.count", Integer(1, 64), "–", "number of planets N").required().needed_by(ALL).changes(AT_ALL),
        key("planets.position_steps", Integers, "360°/(Z_s+Z_r)", "planet positions counter-clockwise from planet 0, in assembly steps; the first is 0").left_out("equal spacing, or the nearest steps; not beside positions_deg").changes(POSITIONS),
        key("planets.positions_deg", Numbers, "°", "planet positions counter-clockwise from planet 0, from -360 to 360; the first is 0; with [teeth] they must be possible to assemble").left_out("equal spacing, or the nearest steps; not beside position_steps").changes(POSITIONS),
        key("teeth", Table, "–", "numbers of teeth").left_out("a set without it and without [geometry] has parameters only").needed_by(RULES_FE),
        key("teeth.sun", Integer(5, 10000), "–", "number of teeth Z_s").left_out("always of a planetary set; of a gear pair that of its mesh").needed_by(RULES_FE).changes(AT_ALL),
        key("teeth.planet", Integer(5, 10000), "–", "number of teeth Z_p").required().needed_by(RULES_FE).changes(BODIES),
        key("teeth.ring", Integer(5, 10000), "–", "number of teeth Z_r, above Z_p").left_out("always of a planetary set; of a gear pair that of its mesh").needed_by(RULES_FE).changes(AT_ALL),
    ]
}

/// Tooth geometry but for its gears.
fn geometry() -> Vec<SceneKey> {
    vec![
        key("geometry", Table, "–", "tooth geometry").left_out("a set without it has parameters only").needed_by(FE),
        key("geometry.center_distance_mm", Number(Positive), "mm", "distance a from the sun, or of a ring–planet pair from the ring, to a planet").left_out("with rack where the profile shifts close the meshes, without shifts m (Z_s + Z_p)/2 or m (Z_r − Z_p)/2").needed_by(FE),
        key("geometry.face_width_mm", Number(Positive), "mm", "width b of the teeth").required().needed_by(FE),
        key("geometry.base_pitch_mm", Number(Positive), "mm", "base pitch p_b of every gear").left_out("exactly one of base_pitch_mm, planet_base_diameter_mm and rack").needed_by(FE),
        key("geometry.planet_base_diameter_mm", Number(Positive), "mm", "base diameter of the planet: p_b = π d_b/Z_p").left_out("exactly one of base_pitch_mm, planet_base_diameter_mm and rack").needed_by(FE),
        key("geometry.rack", Table, "–", "generating rack: p_b = π m cos α₀").left_out("exactly one of base_pitch_mm, planet_base_diameter_mm and rack").needed_by(FE),
        key("geometry.rack.module_mm", Number(Positive), "mm", "module m of the rack, in the transverse section").required().needed_by(FE),
        key("geometry.rack.pressure_angle_deg", Number(Between(5.0, 45.0)), "°", "pressure angle α₀ of the rack, in the transverse section").default_is("20"),
        key("geometry.rack.addendum", Number(Between(0.0, 4.0)), "module", "height h_aP of the rack above its datum line, from which tip circles that are left out follow").default_is("1"),
        key("geometry.rack.dedendum", Number(Between(0.0, 4.0)), "module", "height h_fP below it, from which root circles that are left out follow; above addendum").default_is("1.25"),
        key("geometry.rack.fillet_radius", Number(Positive), "module", "radius ρ_fP of the rack's rounding, and of the root fillets where root circle and fillet are left out").default_is("0.38"),
    ]
}

/// Circles and relief of one gear.
fn gear(name: &str) -> Vec<SceneKey> {
    let circles = key(format!("geometry.{name}"), Table, "–", format!("circles of the {name}")).needed_by(FE);
    let circles = circles.left_out("with rack circles from it; otherwise always where [teeth] names this gear");
    let (body, meaning) = if name == "ring" { ("rim_diameter_mm", "outer circle of the ring, its rigid race") } else { ("bore_diameter_mm", "bore, its rigid race") };
    let from_rack = match name {
        "ring" => ["with rack m (Z − 2 h_aP + 2x), wider where teeth would touch", "with rack m (Z + 2 h_fP + 2x)", "root circle and 7 m, where that is left out; otherwise always for FE/contact"],
        _ => ["with rack m (Z + 2 h_aP + 2x), less where teeth would touch", "with rack m (Z − 2 h_fP + 2x)", "root circle less 7 m, at least half of it, where that is left out; otherwise always for FE/contact"],
    };
    vec![
        circles,
        key(format!("geometry.{name}.tip_diameter_mm"), Number(Positive), "mm", "tip circle").left_out(from_rack[0]).needed_by(FE),
        key(format!("geometry.{name}.root_diameter_mm"), Number(Positive), "mm", "root circle").left_out(from_rack[1]).needed_by(FE),
        key(format!("geometry.{name}.{body}"), Number(Positive), "mm", meaning).left_out(from_rack[2]).needed_by(FE),
        key(format!("geometry.{name}.fillet_radius_mm"), Number(NonNegative), "mm", "radius of the root fillet").left_out("0.3 p_b/π, or geometry.rack.fillet_radius where the root circle is left out, and less where that does not fit; above 0 for FE/contact").needed_by(FE),
        key(format!("geometry.{name}.tip_relief"), Table, "–", "material taken off the flank near the tip").left_out("no relief"),
        key(format!("geometry.{name}.tip_relief.start_diameter_mm"), Number(Positive), "mm", "where the relief starts, between form circle and tip circle").required().changes(LOADED),
        key(format!("geometry.{name}.tip_relief.amount_um"), Number(NonNegative), "µm", "material taken off at the tip circle, measured along the line of action").required().changes(LOADED),
        key(format!("geometry.{name}.tip_relief.shape"), Choice(&["linear", "parabolic"]), "–", "growth with the roll length past the start: proportional to it, or to its square").default_is("linear").changes(LOADED),
    ]
}

/// Carrier and tooth thickness.
fn carrier_and_thickness() -> Vec<SceneKey> {
    vec![
        key("geometry.carrier", Table, "–", "the carrier as an annulus with pin seats").left_out("a rigid carrier; its mass is then lumped.mass_kg.carrier").needed_by(MOTION),
        key("geometry.carrier.bore_diameter_mm", Number(Positive), "mm", "bore, its rigid race").required().needed_by(MOTION),
        key("geometry.carrier.outer_diameter_mm", Number(Positive), "mm", "edge of the annulus").required().needed_by(MOTION),
        key("geometry.carrier.pin_seat_diameter_mm", Number(Positive), "mm", "rigid seat of each planet's pin").default_is("20"),
        key("geometry.carrier.body", Choice(&["flexible", "rigid"]), "–", "whether the annulus gives way between bore and seats").default_is("flexible"),
        key("geometry.thickness", Table, "–", "tooth thickness, from backlash, from profile shifts, or from profile shifts and by how much the teeth are thinner").left_out("its defaults"),
        key("geometry.thickness.sun_planet_backlash_mm", Number(NonNegative), "mm", "circumferential backlash of the sun–planet mesh at its operating pitch circles; beside profile_shift both gears are thinned to it").left_out("0.04 p_b/π; beside profile_shift what the shifts leave").why("circumferential backlash at the operating pitch circles; below 0 the teeth jam"),
        key("geometry.thickness.ring_planet_backlash_mm", Number(NonNegative), "mm", "circumferential backlash of the ring–planet mesh at its operating pitch circles; beside profile_shift both gears are thinned to it").left_out("0.04 p_b/π; beside profile_shift what the shifts leave").why("circumferential backlash at the operating pitch circles; below 0 the teeth jam"),
        key("geometry.thickness.planet_share", Number(Between(0.0, 1.0)), "–", "planet's share of the sum of sun and planet tooth thickness").default_is("0.5"),
        key("geometry.thickness.profile_shift", Table, "–", "profile shift coefficients, with geometry.rack").left_out("backlash gives the thickness"),
        key("geometry.thickness.profile_shift.sun", Number(Between(-5.0, 5.0)), "module", "profile shift x of the sun").default_is("0"),
        key("geometry.thickness.profile_shift.planet", Number(Between(-5.0, 5.0)), "module", "profile shift x of the planet").default_is("0"),
        key("geometry.thickness.profile_shift.ring", Number(Between(-5.0, 5.0)), "module", "profile shift x of the ring, by default positive outwards, where it widens the ring's tooth spaces: without backlash inv α_w = inv α₀ + 2 tan α₀ (x_r − x_p)/(Z_r − Z_p)").default_is("0").why("profile shift x of the ring in the sign of ring_sign"),
        key("geometry.thickness.profile_shift.ring_sign", Choice(&["outward", "iso_21771"]), "–", "sign of the ring's shift: positive outwards, as that of sun and planet, or positive where it makes the ring's teeth thicker, as in ISO 21771 and DIN 3960; x_outward = −x_iso").default_is("outward"),
        key("geometry.thickness.thinning_mm", Table, "–", "thickness allowances: by how much teeth are thinner than profile_shift says, as arcs on the reference circles; not beside backlash keys").left_out("as thick as the shifts say"),
        key("geometry.thickness.thinning_mm.sun", Number(NonNegative), "mm", "thinning of the sun's teeth").default_is("0"),
        key("geometry.thickness.thinning_mm.planet", Number(NonNegative), "mm", "thinning of the planet's teeth").default_is("0"),
        key("geometry.thickness.thinning_mm.ring", Number(NonNegative), "mm", "thinning of the ring's teeth").default_is("0"),
    ]
}

/// Elastic constants and density.
fn material() -> Vec<SceneKey> {
    vec![
        key("material", Table, "–", "elastic constants and density of every body").left_out("its defaults"),
        key("material.young_modulus_pa", Number(Positive), "Pa", "Young's modulus E").default_is("206e9"),
        key("material.poisson_ratio", Number(Between(-1.0, 0.5)), "–", "Poisson's ratio ν").default_is("0.3").why("an isotropic solid"),
        key("material.density_kg_per_m3", Number(Positive), "kg/m³", "density ρ").default_is("7850").changes(INERTIAL),
    ]
}

/// Support of a central member.
fn support(name: &str) -> Vec<SceneKey> {
    let never = "free, without bearing, or held where [planet] is left out and operation.input is another; never of a gear pair";
    let (meaning, left_out, torques, bearing) = match name {
        "sun" => ("support of the sun; of gear pairs only with mesh = \"sun_planet\"", "free, without bearing; of a gear pair with a rigid bearing", "Torques of static, impulse, sweep and branches need one of sun, ring and carrier free without torsional stiffness, on which they act, and the other two held or with a torsional stiffness", "; of a gear pair above 0, and left out the bearing is rigid"),
        "ring" => ("support of the ring", never, "Torques: as `sun.motion`", ""),
        _ => ("support of the carrier", never, "Torques: as `sun.motion`", ""),
    };
    vec![
        key(name, Table, "–", meaning).left_out(left_out).needed_by(if name == "sun" { LOAD } else { NONE }),
        key(format!("{name}.motion"), Choice(&["free", "rotation_held", "held"]), "–", format!("free; rotation held; held in all directions. {torques}")).default_is("free").why("which coordinates the member has").needed_by(LOAD),
        key(format!("{name}.bearing_n_per_m"), Number(NonNegative), "N/m", format!("bearing stiffness to ground, equal in all directions; not of a held member{bearing}")).default_is("0"),
        key(format!("{name}.torsional_n_per_m"), Number(NonNegative), "N/m", "torsional stiffness to ground per u = r·θ; r is the base radius, of the carrier the centre distance; only with motion = \"free\"").default_is("0"),
        key(format!("{name}.torsional_nm_per_rad"), Number(NonNegative), "N·m/rad", "the same per θ, instead of torsional_n_per_m").left_out("torsional_n_per_m holds"),
    ]
}

/// Mass and inertia of a pair's gear with its shaft.
fn shaft(name: &str) -> Vec<SceneKey> {
    vec![
        key(format!("{name}.mass_kg"), Number(Positive), "kg", "mass of the gear with its shaft in the FE/contact model, at \"quasi_static\" and \"mesh_law\"").left_out("that of the finite-element mesh; only of a gear pair").changes(MOTION),
        key(format!("{name}.inertia_kg_m2"), Number(Positive), "kg·m²", "polar inertia of the gear with its shaft, as mass_kg").left_out("that of the finite-element mesh; only of a gear pair").changes(MOTION),
    ]
}

/// Every planet on its pin.
fn planet() -> Vec<SceneKey> {
    vec![
        key("planet", Table, "–", "every planet on its pin; of a gear pair with mesh = \"sun_planet\" the support of its planet").left_out("of a planetary set with [geometry] a bearing of E b/13, ring and carrier held; of a gear pair with a rigid bearing").needed_by(ALL),
        key("planet.bearing_n_per_m", Number(Positive), "N/m", "stiffness between planet and carrier, of a gear pair to ground, equal in all directions").left_out("always of a planetary set; of a gear pair a rigid bearing").needed_by(ALL),
        key("planet.added_mass_kg", Number(NonNegative), "kg", "mass fixed to each planet's race, beside the meshed or lumped mass; not of a gear pair").default_is("0").changes(MOVING),
        key("planet.added_inertia_kg_m2", Number(NonNegative), "kg·m²", "polar inertia of the added mass; not of a gear pair").default_is("0").changes(MOVING),
        key("planet.motion", Choice(&["free", "rotation_held", "held"]), "–", "as `sun.motion`. A planet of a gear pair that turns freely carries the torque that balances the sun's; one that is held or sprung passes it to its support").left_out("free; only of a gear pair").why("which coordinates the member has").changes(MOVING),
        key("planet.torsional_n_per_m", Number(NonNegative), "N/m", "stiffness of the planet's shaft to ground per u = r·θ; only with motion = \"free\"").left_out("0; only of a gear pair").changes(MOVING),
        key("planet.torsional_nm_per_rad", Number(NonNegative), "N·m/rad", "the same per θ, instead of torsional_n_per_m").left_out("torsional_n_per_m holds; only of a gear pair").changes(MOVING),
    ]
}

/// Parameters of the lumped model.
fn lumped() -> Vec<SceneKey> {
    vec![
        key("lumped", Table, "–", "parameters of the Lin–Parker model, or of the lumped sun–planet pair").left_out("of a planetary set with [geometry] parameters in closed form; otherwise no lumped model").needed_by(LUMPED),
        key("lumped.from", Choice(&["geometry"]), "–", "parameters in closed form from [geometry], as without [lumped]; alone in its table, of a planetary set").left_out("numbers are given, unless the whole table is left out"),
    ]
}

/// A table of the lumped model with one value for each body.
fn per_body(name: &str, unit: &'static str, meaning: &str, left_out: &'static str) -> Vec<SceneKey> {
    let needed_by = if name == "mass_kg" || name == "inertia_kg_m2" { LUMPED } else { NONE };
    let mut keys = vec![key(format!("lumped.{name}"), Table, "–", format!("{meaning} of each body")).left_out(left_out).needed_by(needed_by)];
    keys.extend(["carrier", "ring", "sun", "planet"].map(|body| {
        let meaning = format!("{meaning} of the {body}");
        // FE/contact takes mass, inertia and radius of a carrier without a shape from here.
        let changes = if body == "carrier" { MOVING } else { PARAMETERS };
        key(format!("lumped.{name}.{body}"), Number(Positive), unit, meaning).left_out(left_out).needed_by(needed_by).changes(changes)
    }));
    keys
}

/// Stiffnesses and pressure angles of the lumped model's meshes.
fn lumped_meshes() -> Vec<SceneKey> {
    vec![
        key("lumped.mesh_n_per_m", Table, "–", "constant mesh stiffnesses along the line of action").left_out("only with from").needed_by(LUMPED),
        key("lumped.mesh_n_per_m.sun_planet", Number(Positive), "N/m", "stiffness of each sun–planet mesh").required().needed_by(LUMPED),
        key("lumped.mesh_n_per_m.ring_planet", Number(Positive), "N/m", "stiffness of each ring–planet mesh; not of a gear pair").left_out("always of a planetary set, never of a gear pair").needed_by(LUMPED),
        key("lumped.pressure_angle_deg", Table, "–", "operating pressure angles").left_out("from [geometry]"),
        key("lumped.pressure_angle_deg.sun_planet", Number(Between(0.0, 60.0)), "°", "operating pressure angle of the sun–planet meshes").required(),
        key("lumped.pressure_angle_deg.ring_planet", Number(Between(0.0, 60.0)), "°", "operating pressure angle of the ring–planet meshes; not of a gear pair").left_out("always of a planetary set, never of a gear pair"),
    ]
}

/// `[[planet_override]]`.
fn planet_override() -> Vec<SceneKey> {
    vec![
        key("planet_override", Tables, "–", "one planet that differs from the others; values left out stay those of the others. Values of the lumped model alone are refused by static, impulse, sweep and branches, of which they would change nothing").left_out("all planets alike; with [lumped]"),
        key("planet_override.planet", Integer(0, 63), "–", "index of the planet, from 0 and below planets.count; each once").required().changes(LOADED),
        key("planet_override.mass_kg", Number(Positive), "kg", "mass of this planet in the lumped model").left_out("as of the others"),
        key("planet_override.inertia_over_r2_kg", Number(Positive), "kg", "I/r² of this planet in the lumped model").left_out("as of the others"),
        key("planet_override.bearing_n_per_m", Number(Positive), "N/m", "bearing stiffness of this planet").left_out("as of the others").changes(LOADED),
        key("planet_override.sun_planet_n_per_m", Number(Positive), "N/m", "sun mesh stiffness of this planet in the lumped model").left_out("as of the others"),
        key("planet_override.ring_planet_n_per_m", Number(Positive), "N/m", "ring mesh stiffness of this planet in the lumped model").left_out("as of the others"),
    ]
}

/// `[damping]`.
fn damping() -> Vec<SceneKey> {
    vec![
        key("damping", Table, "–", "proportional damping C = αM + βK of the FE/contact model").left_out("its defaults"),
        key("damping.mass_proportional_per_s", Number(NonNegative), "1/s", "α").default_is("142.9").why("α in C = αM + βK"),
        key("damping.stiffness_proportional_s", Number(NonNegative), "s", "β").default_is("2.21e-6").why("β in C = αM + βK"),
        key("damping.bearing_s", Number(NonNegative), "s", "viscous damping of every bearing over its stiffness").left_out("β"),
    ]
}

/// `[operation]`.
fn operation() -> Vec<SceneKey> {
    vec![
        key("operation", Table, "–", "operating point").left_out("no torque, speed or mesh frequency of its own").needed_by(LOAD),
        key("operation.fixed", Choice(&["sun", "ring", "carrier"]), "–", "member that stands still, which gives speeds and the ratio of torques; not of a gear pair, whose bearings do. Supports (`motion`) rule the vibrations: the torque acts on the member that turns without support, which must not be this one").default_is("ring").changes(SWEEP),
        key("operation.input", Choice(&["sun", "ring", "carrier"]), "–", "member whose speed and torque are given; another than fixed; of a gear pair the sun").default_is("sun"),
        key("operation.speed_rpm", Number(Finite), "rpm", "speed of the input member, counter-clockwise positive; --speeds-rpm and --rpm are magnitudes in this sense. With a torque of the same sign the member drives, with one of the other sign it is braked").default_is("1000").needed_by(SWEEP).changes(SWEEP),
        key("operation.torque_nm", Number(Finite), "N·m", "external torque on the input member, counter-clockwise positive; 0 needs the argument --sun-torque-nm").required().needed_by(LOAD),
    ]
}

/// `[fe_contact]`.
fn fe_contact() -> Vec<SceneKey> {
    vec![
        key("fe_contact", Table, "–", "choices of the FE/contact model").left_out("its defaults"),
        key("fe_contact.plane", Choice(&["strain", "stress"]), "–", "plane strain or plane stress").default_is("strain").changes(BODIES),
        key("fe_contact.element", Choice(&["linear", "incompatible", "quadratic"]), "–", "quadrilaterals behind the flanks: bilinear (too stiff in bending), with incompatible bending modes, or of eight nodes").default_is("quadratic"),
        key("fe_contact.flank_elements", Integer(3, 64), "–", "elements along one flank; the rest of the mesh follows their size").default_is("14"),
        key("fe_contact.flank_layer", Choice(&["whole", "divided"]), "–", "elements next to the flanks: as large as the others, or divided in three along and across the flanks, so that three times as many touch the surface (docs/fe_contact.md)").default_is("whole"),
        key("fe_contact.contact_cells", Integer(8, 400), "–", "contact cells of one tooth pair").default_is("40").changes(LOAD),
        key("fe_contact.cell_layout", Choice(&["graded", "even"]), "–", "contact cells in time and for the slopes of the flanks: narrower towards a flank's end and a quarter of a cell off the middle, or all of one width about the contact point").default_is("graded").changes(LOAD),
        key("fe_contact.cell_layout_at_rest", Choice(&["graded", "even"]), "–", "contact cells of a set at rest, of which pressures are asked as well: graded ones give the peak to peak of transmission errors with a third of the cells (docs/auto.md)").default_is("even").changes(LOAD),
        key("fe_contact.matching_depth_mm", Number(Positive), "mm", "depth d below the flank at which half-plane and finite elements are matched").left_out("0.07 p_b, at least matching_depth_elements, at most what the tooth allows"),
        key("fe_contact.matching_depth_elements", Number(Positive), "–", "least depth d of the default in elements of a flank: 1.3 makes meshes of six and ten elements more accurate (docs/auto.md); not beside matching_depth_mm").left_out("0.85"),
        key("fe_contact.matching_points", Integer(1, 2), "–", "1: matched at d; 2: at d and 2d, extrapolated to the surface").default_is("2").why("1: the paper's eq. (1); 2: extrapolated").changes(LOAD),
        key("fe_contact.mean_positions", Integer(4, 140), "–", "number of positions of the mesh cycle whose mean is the loaded configuration, about which a set is linearised; one equilibrium each").left_out("the least from 14 to 140 with which all meshes of a kind pass through the same phases").changes(LOAD),
        key("fe_contact.flexibility_factor", Table, "–", "factors on the FE part of each mesh's flexibility, the half-plane part unchanged; 1 at every fidelity but quasi_static").left_out("1 for both meshes"),
        key("fe_contact.flexibility_factor.sun_planet", Number(Positive), "–", "factor of the sun–planet meshes").default_is("1").changes(LOAD),
        key("fe_contact.flexibility_factor.ring_planet", Number(Positive), "–", "factor of the ring–planet meshes").default_is("1").changes(LOAD),
    ]
}

/// `[dynamics]`.
fn dynamics() -> Vec<SceneKey> {
    vec![
        key("dynamics", Table, "–", "choices of motion in time").left_out("its defaults"),
        key("dynamics.fidelity", Choice(&["mesh_law", "quasi_static", "modal", "full", "auto"]), "–", "inertia of the bodies behind the teeth: quasi_static none of their own, modal that of some modes, full all of it; mesh_law: mesh forces from a table, in sweep and branches only; auto: the cheapest settings are chosen for one quantity").default_is("quasi_static").changes(MOTION),
        key("dynamics.modes", Integer(1, 400), "–", "modes of each body with its race held").left_out("always, and only, with fidelity = \"modal\"").changes(MOTION),
        key("dynamics.quantity", Choice(&["natural_frequency", "transmission_error", "mean_transmission_error", "amplitude"]), "–", "quantity for which settings are chosen: a natural frequency (modes), the peak-to-peak value or the mean of the loaded transmission error at rest (static), or the largest root mean square of a response over the speeds of a sweep").left_out("always, and only, with fidelity = \"auto\"").changes(CHOSEN),
        key("dynamics.mode_type", Choice(&["rotational", "translational", "planet"]), "–", "type of the mode, by the larger part of its kinetic energy").left_out("always, and only, with quantity = \"natural_frequency\"").changes(PARAMETERS),
        key("dynamics.mode_number", Integer(1, 1000), "–", "number of the mode among those of its type by ascending frequency; a frequency that occurs twice counts twice").left_out("always, and only, with quantity = \"natural_frequency\"").changes(PARAMETERS),
        key("dynamics.response", Choice(&["transmission_error", "sun_translation"]), "–", "motion whose amplitude is asked for: r_b times the rotation of the sun, or its translation").left_out("always, and only, with quantity = \"amplitude\"").changes("sweep"),
        key("dynamics.tolerance_percent", Number(Between(0.0, 100.0)), "%", "largest estimated error of the quantity that is accepted").left_out("always, and only, with fidelity = \"auto\"").changes(CHOSEN),
        key("dynamics.steps_per_cycle", Integer(16, 100000), "–", "time steps in a mesh cycle; chosen, and not to be given, with quantity = \"amplitude\"").default_is("140"),
        key("dynamics.gyroscopic", Choice(&["off", "on"]), "–", "gyroscopic and centripetal terms of the turning carrier frame; off of a gear pair").default_is("off"),
        key("dynamics.kinematics", Choice(&["about_mean", "exact"]), "–", "how approaches of tooth pairs follow from displacements in a sweep: exact only about the mean configuration under load, or at every step (slow; quasi_static only)").default_is("about_mean").changes("sweep"),
    ]
}
