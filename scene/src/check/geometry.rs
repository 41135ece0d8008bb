//! Faults of the tooth geometry that show only when several keys are seen together.

use gearset::{
    CarrierInput, Gear, GearInput, Geometry, GeometryInput, Mesh, MeshKind, MeshMember,
    PlanetPositions, Teeth, ThicknessInput, assembly,
};

use crate::check::closing::Closing;
use crate::read::TeethRead;
use crate::read::document::Document;
use crate::read::geometry::GeometryRead;

/// Judges what is there of the tooth geometry; faults go to the document. Of what is absent or at fault no
/// consequence is reported.
pub(crate) fn shape(
    document: &Document<'_>,
    read: &GeometryRead,
    teeth: &TeethRead,
    positions: Option<&PlanetPositions>,
) {
    let shape = &read.input;
    let gears = [
        ("sun", shape.sun.as_ref(), teeth.sun),
        ("planet", Some(&shape.planet), teeth.planet),
        ("ring", shape.ring.as_ref(), teeth.ring),
    ];
    let base = |z: u32| f64::from(z) * shape.base_pitch_m / std::f64::consts::TAU;
    let is_disordered = gears.iter().any(|(name, gear, z)| {
        gear.zip(*z).is_some_and(|(gear, z)| {
            !reaches_base(name, gear, base(z)) || is_tip_within_root(name, gear)
        })
    });
    let is_sound = !document.is_doubtful("geometry") && !document.is_doubtful("teeth");
    if let Some(teeth) = teeth.complete().filter(|_| is_disordered && is_sound) {
        let causes = Closing::new(document, shape, &teeth, read).causes([true; 2]);
        for cause in &causes {
            document.fault(cause.key, cause.allowed.as_str(), cause.why.as_str());
        }
        if !causes.is_empty() {
            return;
        }
    }
    for (name, gear, z) in gears {
        if let Some(gear) = gear {
            let is_z_known = !document.is_doubtful(&format!("teeth.{name}"));
            // 2π r_b = Z p_b
            circles(document, name, gear, z.filter(|_| is_z_known).map_or(f64::NAN, base));
        }
    }
    let is_known = |key: &str| !document.is_doubtful(&format!("planets.{key}"));
    let positions = positions.filter(|_| is_known("position_steps") && is_known("positions_deg"));
    let a = shape.center_distance_m;
    if a.is_nan() || meshes(document, read, teeth) {
        return;
    }
    if let Some(found) = &shape.carrier {
        carrier(document, found, a, positions);
    }
    let is_tip_known = !document.is_doubtful("geometry.planet.tip_diameter_mm");
    if let Some(positions) = positions.filter(|_| is_tip_known) {
        planets_apart(document, positions, a, shape.planet.tip_radius_m);
    }
}

/// Checks teeth and meshes of the gears that are there without a fault; whether the centre distance leaves no
/// mesh at all.
fn meshes(document: &Document<'_>, read: &GeometryRead, teeth: &TeethRead) -> bool {
    let shape = &read.input;
    let is_sound = |name: &str| {
        !document.is_doubtful(&format!("geometry.{name}"))
            && !document.is_doubtful(&format!("teeth.{name}"))
    };
    let sound = |name: &str, gear: &Option<GearInput>, z: Option<u32>| {
        gear.clone().zip(z).filter(|_| is_sound(name))
    };
    let sun = sound("sun", &shape.sun, teeth.sun);
    let ring = sound("ring", &shape.ring, teeth.ring);
    let (Some(z_planet), true) =
        (teeth.planet.filter(|_| is_sound("planet")), !shape.base_pitch_m.is_nan())
    else {
        return false;
    };
    let is_thickness_known =
        !document.is_doubtful("geometry.thickness") && !document.is_doubtful("geometry.rack");
    // The tooth thickness of one gear follows from those of its mates.
    let is_whole = is_thickness_known
        && sun.is_some() == shape.sun.is_some()
        && ring.is_some() == shape.ring.is_some();
    let no_backlash =
        ThicknessInput::Backlash { sun_planet_m: 0.0, ring_planet_m: 0.0, planet_share: 0.5 };
    let known_teeth = Teeth {
        sun: sun.as_ref().map(|s| s.1),
        planet: z_planet,
        ring: ring.as_ref().map(|r| r.1),
    };
    let input = GeometryInput {
        sun: sun.map(|s| s.0),
        ring: ring.map(|r| r.0),
        thickness: if is_thickness_known { shape.thickness } else { no_backlash },
        ..shape.clone()
    };
    let closing = Closing::new(document, &input, &known_teeth, read);
    let suspect = || closing.wrong_teeth().or_else(|| closing.wrong_distance());
    let geometry = match Geometry::new(&input, &known_teeth) {
        Ok(geometry) => geometry,
        Err(no_mesh) => {
            match suspect().filter(|_| is_thickness_known) {
                Some(cause) => document.fault(cause.key, cause.allowed, cause.why),
                None => {
                    let allowed = format!("above {:.4} mm", no_mesh.least * 1e3);
                    document.fault("geometry.center_distance_mm", allowed, no_mesh.to_string());
                }
            }
            return true;
        }
    };
    let is_known = [is_sound("sun") && is_sound("planet"), is_sound("ring") && is_sound("planet")];
    let gear = |name, gear: Option<&Gear>| {
        gear.filter(|_| is_whole).map_or(Vec::new(), |gear| tooth(name, gear))
    };
    let mesh = |kind, is_known: bool| {
        let mesh = geometry.mesh(kind).filter(|_| is_known);
        mesh.map_or(Vec::new(), |mesh| one_mesh(&geometry, mesh, is_whole, read))
    };
    let of_planet = gear("planet", Some(&geometry.planet));
    let of_sun = [gear("sun", geometry.sun.as_ref()), mesh(MeshKind::SunPlanet, is_known[0])];
    let of_ring = [gear("ring", geometry.ring.as_ref()), mesh(MeshKind::RingPlanet, is_known[1])];
    let groups = [of_sun.concat(), of_ring.concat()];
    let is_faulty = groups.each_ref().map(|faults| !faults.is_empty() || !of_planet.is_empty());
    let mut explained = [false; 2];
    if is_whole {
        for cause in closing.causes(is_faulty) {
            document.fault(cause.key, cause.allowed, cause.why);
            explained = [0, 1].map(|i| explained[i] || cause.meshes[i]);
        }
        if is_faulty == [false; 2]
            && let Some(warning) = closing.sign_warning(document)
        {
            document.remarks.borrow_mut().warnings.push(warning);
        }
    }
    let open =
        groups.into_iter().zip(explained).filter(|(_, is)| !is).flat_map(|(faults, _)| faults);
    let of_planet = of_planet.into_iter().filter(|_| explained == [false; 2]);
    for Found { key, allowed, why } in open.chain(of_planet) {
        document.fault(&key, allowed, why);
    }
    false
}

/// A fault that is reported unless another one explains it.
#[derive(Clone)]
struct Found {
    key: String,
    allowed: String,
    why: String,
}

fn mm(x: f64) -> String {
    format!("{:.4} mm", x * 1e3)
}

/// Checks that the planets' tip circles stay clear of each other.
fn planets_apart(document: &Document<'_>, positions: &PlanetPositions, a: f64, tip: f64) {
    let mut overlaps = assembly::planet_clearances(&positions.psi_rad, a, tip);
    overlaps.retain(|(_, _, gap)| *gap <= 0.0 && gap + 2.0 * tip > 1e-9 * tip);
    let Some((p, q, gap)) = overlaps.iter().min_by(|a, b| a.2.total_cmp(&b.2)) else { return };
    let keys = ["planets.position_steps", "planets.positions_deg"];
    let key = keys.into_iter().find(|key| document.has(key)).unwrap_or("planets.count");
    let others = match overlaps.len() - 1 {
        0 => String::new(),
        1 => ", and one more pair does".into(),
        n => format!(", and {n} more pairs do"),
    };
    let why = format!("planets {p} and {q} overlap by {}{others}", mm(-gap));
    document.fault(key, "planets whose tip circles stay clear of each other", why);
}

/// Checks that the carrier's annulus contains its pin seats and that the seats do not overlap.
fn carrier(
    document: &Document<'_>,
    carrier: &CarrierInput,
    a: f64,
    positions: Option<&PlanetPositions>,
) {
    if document.is_doubtful("geometry.carrier.pin_seat_diameter_mm") {
        return;
    }
    let seat = carrier.pin_seat_radius_m;
    let (bore, outer) = (carrier.bore_radius_m, carrier.outer_radius_m);
    let why = "the pin seats stand at the centre distance, inside the annulus";
    if bore >= a - seat {
        let allowed = format!("below {}", mm(2.0 * (a - seat)));
        document.fault("geometry.carrier.bore_diameter_mm", allowed, why);
    }
    if outer <= a + seat {
        let allowed = format!("above {}", mm(2.0 * (a + seat)));
        document.fault("geometry.carrier.outer_diameter_mm", allowed, why);
    }
    let key = "geometry.carrier.pin_seat_diameter_mm";
    let Some(positions) = positions else { return };
    for (p, q, clearance) in assembly::planet_clearances(&positions.psi_rad, a, seat) {
        if clearance <= 0.0 {
            let why = format!("the seats of planets {p} and {q} overlap by {}", mm(-clearance));
            document.fault(key, "seats that stay apart", why);
        }
    }
}

/// Checks the order of one gear's circles; the base radius in m. What is not known is NaN, and in no wrong order.
fn circles(document: &Document<'_>, name: &str, gear: &GearInput, base: f64) {
    let fault = |k: &str, allowed: String, why: &str| {
        document.fault(&format!("geometry.{name}.{k}"), allowed, why);
    };
    let is_ring = name == "ring";
    let (root, body) = (gear.root_radius_m, gear.body_radius_m);
    let diameter = |r: f64| mm(2.0 * r);
    // One circle not outside another, seen from the teeth: outwards on an external gear, inwards on the ring.
    let is_within = |x: f64, y: f64| if is_ring { x >= y } else { x <= y };
    let words = |beyond: bool| if beyond != is_ring { "above" } else { "below" };
    if is_tip_within_root(name, gear) {
        let allowed = format!("{} the root diameter {}", words(true), diameter(root));
        let why =
            if is_ring { "internal teeth point inwards" } else { "external teeth point outwards" };
        fault("tip_diameter_mm", allowed, why);
    }
    if !reaches_base(name, gear, base) {
        let least = if is_ring { "at least" } else { "above" };
        let allowed = format!("{least} the base diameter {}", diameter(base));
        fault("tip_diameter_mm", allowed, "there is no involute inside the base circle");
    }
    if body.is_some_and(|body| is_within(root, body)) {
        let key = if is_ring { "rim_diameter_mm" } else { "bore_diameter_mm" };
        let allowed = format!("{} the root diameter {}", words(false), diameter(root));
        fault(key, allowed, "the teeth stand on a rim");
    }
}

/// Whether the tip circle is not outside the root circle of an external gear, or not inside that of the ring.
fn is_tip_within_root(name: &str, gear: &GearInput) -> bool {
    let (tip, root) = (gear.tip_radius_m, gear.root_radius_m);
    if name == "ring" { tip >= root } else { tip <= root }
}

/// Whether the flank has an involute up to the tip; true where either radius is not known.
fn reaches_base(name: &str, gear: &GearInput, base: f64) -> bool {
    let tip = gear.tip_radius_m;
    !(if name == "ring" { tip < base } else { tip <= base })
}

/// Checks tip land, tooth space, root fillets and tip relief of one gear.
fn tooth(name: &str, gear: &Gear) -> Vec<Found> {
    let mut found = Vec::new();
    let mut fault = |k: &str, allowed: String, why: &str| {
        found.push(Found { key: format!("geometry.{name}.{k}"), allowed, why: why.into() });
    };
    let is_ring = name == "ring";
    let (tip, root) = (gear.tip_radius, gear.root_radius);
    let diameter = |r: f64| mm(2.0 * r);
    if gear.tooth_thickness(tip) <= 0.0 {
        let why = "the flanks meet before the tip circle: the tooth comes to a point; lower the tip, or give the tooth more thickness";
        let allowed = "a tip circle the flanks reach".to_owned();
        fault("tip_diameter_mm", allowed, why);
    }
    if gear.space_width(root.max(gear.base_radius)) <= 0.0 {
        let why = "the tooth is wider than its pitch there";
        fault("root_diameter_mm", "a root with room between the teeth".into(), why);
    }
    let too_deep = is_ring && gear.root_radius - gear.fillet_radius < gear.base_radius;
    if too_deep || gear.root_land_angle() < 0.0 {
        let why = "the fillets of one tooth space would overlap: make the radius smaller, or the space wider by shift or root circle";
        fault("fillet_radius_mm", "a radius that fits twice into the space".into(), why);
    } else if (is_ring && gear.form_radius() <= tip) || (!is_ring && gear.form_radius() >= tip) {
        let why = "the fillet would eat the whole flank: make the radius smaller";
        fault("fillet_radius_mm", "a radius that leaves a flank".into(), why);
    }
    if let Some(relief) = gear.tip_relief {
        let (low, high) =
            if is_ring { (tip, gear.form_radius()) } else { (gear.form_radius(), tip) };
        if !(relief.start_radius_m > low && relief.start_radius_m < high) {
            let allowed = format!("between {} and {}", diameter(low), diameter(high));
            fault("tip_relief.start_diameter_mm", allowed, "relief lies on the flank");
        }
    }
    found
}

/// Checks interference, clearances and contact ratio of one mesh and, where the tooth thicknesses are known
/// (`is_whole`), tip fouling and backlash.
fn one_mesh(geometry: &Geometry, mesh: &Mesh, is_whole: bool, read: &GeometryRead) -> Vec<Found> {
    let mut found = Vec::new();
    let mut fault = |key: String, allowed: &str, why: String| {
        found.push(Found { key, allowed: allowed.into(), why });
    };
    let (driver, driven) = match mesh.kind {
        MeshKind::SunPlanet => ("sun", "planet"),
        MeshKind::RingPlanet => ("planet", "ring"),
    };
    let [sun, planet, ring] = read.circles;
    let rounding = |name: &str| match name {
        "sun" => sun,
        "planet" => planet,
        _ => ring,
    };
    let kind = mesh.kind.name();
    let tip_key = |name: &str| format!("geometry.{name}.tip_diameter_mm");
    let mut interferes = false;
    let meets = [
        (MeshMember::Driver, driver, MeshMember::Driven, driven),
        (MeshMember::Driven, driven, MeshMember::Driver, driver),
    ];
    for (member, name, mate_member, mate) in meets {
        let overrun = mesh.interference(member);
        if overrun > 0.0 {
            interferes = true;
            let gear = mesh.gear(member);
            // The smallest fillet leaves the involute from the root circle or, where that is lower, the base circle.
            let sharp = Gear { fillet_radius: 0.0, ..gear.clone() };
            let gained = (sharp.form_roll_length().unwrap_or(0.0)
                - gear.form_roll_length().unwrap_or(0.0))
            .abs();
            let or_fillet = if gained > overrun {
                format!(", or a smaller fillet of the {name}")
            } else {
                String::new()
            };
            let why = format!(
                "in the {kind} mesh the {mate}'s tip touches the {name} {} beyond its form circle ({}), where there is fillet and no involute",
                mm(overrun),
                mm(2.0 * gear.form_radius())
            );
            let most = if mate == "ring" { "at least" } else { "at most" };
            let allowed = match mesh.admissible_tip_radius(mate_member) {
                Some(tip) => format!(
                    "a tip that stays on the {name}'s involute: {most} {}{or_fillet}",
                    mm(2.0 * tip)
                ),
                None => {
                    format!("a tip that stays on the {name}'s involute, which none does{or_fillet}")
                }
            };
            fault(tip_key(mate), &allowed, why);
        }
    }
    for (member, name, _, mate) in meets {
        let clearance = mesh.root_clearance(member);
        // Rounding of the diameters and of the distance: at rest and in time roots and tips never touch.
        let written = rounding(name).tip + rounding(mate).root + read.written.center_distance_m;
        if clearance < -written {
            let why =
                format!("in the {kind} mesh it digs {} into the {mate}'s root", mm(-clearance));
            fault(tip_key(name), "a tip circle that clears the mating root", why);
        }
    }
    if is_whole && mesh.tip_fouling_clearance().is_some_and(|angle| angle < 0.0) {
        let why = "planet and ring tips collide away from the path of contact (tip fouling)";
        fault(tip_key("ring"), "tips that pass each other", why.into());
    }
    if mesh.contact_ratio < 1.0 && !interferes {
        let why = format!(
            "the {kind} mesh has contact ratio {:.3}: one pair must take over before the other leaves",
            mesh.contact_ratio
        );
        fault(tip_key(driven), "tips that give a contact ratio of 1 or more", why);
    }
    let backlash = geometry.backlash(mesh.kind).unwrap_or(0.0);
    if is_whole && backlash < -1e-9 {
        let why = format!("the {kind} mesh has backlash {}: it jams", mm(backlash));
        let key = "geometry.thickness.profile_shift".to_owned();
        fault(key, "shifts that leave backlash 0 or above", why);
    }
    found
}
