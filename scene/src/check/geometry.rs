//! Faults of the tooth geometry that show only when several keys are seen together.

use gearset::{
    CarrierInput, Gear, GearInput, Geometry, GeometryInput, Mesh, MeshKind, MeshMember,
    PlanetPositions, Teeth, ThicknessInput, assembly,
};

use crate::read::TeethRead;
use crate::read::document::Document;

/// Judges what is there of the tooth geometry; faults go to the document. Of what is absent or at fault no
/// consequence is reported.
pub(crate) fn shape(
    document: &Document<'_>,
    shape: &GeometryInput,
    teeth: &TeethRead,
    positions: Option<&PlanetPositions>,
) {
    let gears = [
        ("sun", shape.sun.as_ref(), teeth.sun),
        ("planet", Some(&shape.planet), teeth.planet),
        ("ring", shape.ring.as_ref(), teeth.ring),
    ];
    for (name, gear, z) in gears {
        if let Some(gear) = gear {
            let is_z_known = !document.is_doubtful(&format!("teeth.{name}"));
            // 2π r_b = Z p_b
            let base = z.filter(|_| is_z_known).map_or(f64::NAN, f64::from);
            circles(document, name, gear, base * shape.base_pitch_m / std::f64::consts::TAU);
        }
    }
    let is_known = |key: &str| !document.is_doubtful(&format!("planets.{key}"));
    let positions = positions.filter(|_| is_known("position_steps") && is_known("positions_deg"));
    let a = shape.center_distance_m;
    if a.is_nan() || meshes(document, shape, teeth) {
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
fn meshes(document: &Document<'_>, shape: &GeometryInput, teeth: &TeethRead) -> bool {
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
    let geometry = match Geometry::new(&input, &known_teeth) {
        Ok(geometry) => geometry,
        Err(no_mesh) => {
            let allowed = format!("above {:.4} mm", no_mesh.least * 1e3);
            document.fault("geometry.center_distance_mm", allowed, no_mesh.to_string());
            return true;
        }
    };
    let gears = [
        ("sun", geometry.sun.as_ref()),
        ("planet", Some(&geometry.planet)),
        ("ring", geometry.ring.as_ref()),
    ];
    if is_whole {
        gears.into_iter().for_each(|(name, gear)| {
            if let Some(gear) = gear {
                tooth(document, name, gear);
            }
        });
    }
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let central = if kind == MeshKind::SunPlanet { "sun" } else { "ring" };
        if let Some(mesh) = geometry.mesh(kind)
            && is_sound(central)
            && is_sound("planet")
        {
            one_mesh(document, &geometry, mesh, is_whole);
        }
    }
    false
}

fn mm(x: f64) -> String {
    format!("{:.4} mm", x * 1e3)
}

/// Checks that the planets' tip circles stay clear of each other.
fn planets_apart(document: &Document<'_>, positions: &PlanetPositions, a: f64, tip: f64) {
    for (p, q, clearance) in assembly::planet_clearances(&positions.psi_rad, a, tip) {
        if clearance <= 0.0 && clearance + 2.0 * tip > 1e-9 * tip {
            let key = if document.has("planets.position_steps") {
                "planets.position_steps"
            } else if document.has("planets.positions_deg") {
                "planets.positions_deg"
            } else {
                "planets.count"
            };
            let why = format!("planets {p} and {q} overlap by {}", mm(-clearance));
            document.fault(key, "planets whose tip circles stay clear of each other", why);
        }
    }
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
    let (tip, root, body) = (gear.tip_radius_m, gear.root_radius_m, gear.body_radius_m);
    let diameter = |r: f64| mm(2.0 * r);
    // One circle not outside another, seen from the teeth: outwards on an external gear, inwards on the ring.
    let is_within = |x: f64, y: f64| if is_ring { x >= y } else { x <= y };
    let words = |beyond: bool| if beyond != is_ring { "above" } else { "below" };
    if is_within(tip, root) {
        let allowed = format!("{} the root diameter {}", words(true), diameter(root));
        let why =
            if is_ring { "internal teeth point inwards" } else { "external teeth point outwards" };
        fault("tip_diameter_mm", allowed, why);
    }
    if if is_ring { tip < base } else { tip <= base } {
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

/// Checks tip land, tooth space, root fillets and tip relief of one gear.
fn tooth(document: &Document<'_>, name: &str, gear: &Gear) {
    let fault = |k: &str, allowed: String, why: &str| {
        document.fault(&format!("geometry.{name}.{k}"), allowed, why);
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
        let why = "the fillets of one tooth space would overlap: make the radius smaller";
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
}

/// Checks interference, clearances and contact ratio of one mesh and, where the tooth thicknesses are known
/// (`is_whole`), tip fouling and backlash.
fn one_mesh(document: &Document<'_>, geometry: &Geometry, mesh: &Mesh, is_whole: bool) {
    let (driver, driven) = match mesh.kind {
        MeshKind::SunPlanet => ("sun", "planet"),
        MeshKind::RingPlanet => ("planet", "ring"),
    };
    let tip_key = |name: &str| format!("geometry.{name}.tip_diameter_mm");
    let mut interferes = false;
    let meets = [(MeshMember::Driver, driver, driven), (MeshMember::Driven, driven, driver)];
    for (member, name, mate) in meets {
        let overrun = mesh.interference(member);
        if overrun > 0.0 {
            interferes = true;
            let why = format!(
                "in the {} mesh the {mate}'s tip touches the {name} {} beyond its form circle ({}), where there is fillet and no involute: lower the tip or the fillet radius",
                mesh.kind.name(),
                mm(overrun),
                mm(2.0 * mesh.gear(member).form_radius())
            );
            let allowed = format!("a tip that stays on the {name}'s involute");
            document.fault(&tip_key(mate), allowed, why);
        }
    }
    for (member, name, mate) in meets {
        let clearance = mesh.root_clearance(member);
        if clearance < 0.0 {
            let kind = mesh.kind.name();
            let why =
                format!("in the {kind} mesh it digs {} into the {mate}'s root", mm(-clearance));
            document.fault(&tip_key(name), "a tip circle that clears the mating root", why);
        }
    }
    if is_whole && mesh.tip_fouling_clearance().is_some_and(|angle| angle < 0.0) {
        let why = "planet and ring tips collide away from the path of contact (tip fouling)";
        document.fault(&tip_key("ring"), "tips that pass each other", why);
    }
    if mesh.contact_ratio < 1.0 && !interferes {
        let why = format!(
            "the {} mesh has contact ratio {:.3}: one pair must take over before the other leaves",
            mesh.kind.name(),
            mesh.contact_ratio
        );
        document.fault(&tip_key(driven), "tips that give a contact ratio of 1 or more", why);
    }
    let backlash = geometry.backlash(mesh.kind).unwrap_or(0.0);
    if is_whole && backlash < -1e-9 {
        let why = format!("the {} mesh has backlash {}: it jams", mesh.kind.name(), mm(backlash));
        let key = "geometry.thickness.profile_shift";
        document.fault(key, "shifts that leave backlash 0 or above", why);
    }
}
