//! Faults that show only when several keys are seen together.

use crate::assembly;
use crate::gear::Gear;
use crate::geometry::{Geometry, GeometryError};
use crate::mesh::Mesh;
use crate::mesh_kind::{MeshKind, MeshMember};
use crate::reader::Document;
use crate::scene::{Fidelity, Scene};

/// Judges the whole scene; faults go to the document.
pub(crate) fn whole(document: &Document<'_>, scene: &Scene) {
    distinct_positions(document, scene);
    factors_need_quasi_static(document, scene);
    match Geometry::from_scene(scene) {
        Ok(geometry) => tooth_geometry(document, scene, &geometry),
        Err(GeometryError::NoMesh(no_mesh)) => {
            let allowed = format!("above {:.4} mm", no_mesh.least * 1e3);
            document.fault("geometry.center_distance_mm", allowed, no_mesh.to_string());
        }
        Err(GeometryError::Absent(_)) => {}
    }
}

fn mm(x: f64) -> String {
    format!("{:.4} mm", x * 1e3)
}

fn tooth_geometry(document: &Document<'_>, scene: &Scene, geometry: &Geometry) {
    let gears = [
        ("sun", geometry.sun.as_ref(), "bore_diameter_mm"),
        ("planet", Some(&geometry.planet), "bore_diameter_mm"),
        ("ring", geometry.ring.as_ref(), "rim_diameter_mm"),
    ];
    let mut sound = true;
    for (name, gear, body_key) in gears {
        if let Some(gear) = gear {
            sound &= one_gear(document, name, gear, body_key);
        }
    }
    if !sound {
        return; // Further checks would only report consequences of these faults.
    }
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        if let Some(mesh) = geometry.mesh(kind) {
            one_mesh(document, geometry, mesh);
        }
    }
    carrier(document, scene, geometry.center_distance);
    let tip = geometry.planet.tip_radius;
    let psi = &scene.planets.psi_rad;
    for (p, q, clearance) in assembly::planet_clearances(psi, geometry.center_distance, tip) {
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
fn carrier(document: &Document<'_>, scene: &Scene, a: f64) {
    let Some(carrier) = scene.geometry.as_ref().and_then(|g| g.carrier) else { return };
    let seat = carrier.pin_seat_radius;
    let (bore, outer) = (carrier.bore_radius, carrier.outer_radius);
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
    for (p, q, clearance) in assembly::planet_clearances(&scene.planets.psi_rad, a, seat) {
        if clearance <= 0.0 {
            let why = format!("the seats of planets {p} and {q} overlap by {}", mm(-clearance));
            document.fault(key, "seats that stay apart", why);
        }
    }
}

/// Checks the order of one gear's circles, its tip land, root fillets and tip relief; true without a fault.
fn one_gear(document: &Document<'_>, name: &str, gear: &Gear, body_key: &str) -> bool {
    let key = |k: &str| format!("geometry.{name}.{k}");
    let sound = std::cell::Cell::new(true);
    let fault = |k: &str, allowed: String, why: &str| {
        sound.set(false);
        document.fault(&key(k), allowed, why);
    };
    let is_ring = name == "ring";
    let (tip, root) = (gear.tip_radius, gear.root_radius);
    let diameter = |r: f64| mm(2.0 * r);
    if !is_ring {
        if tip <= root {
            let allowed = format!("above the root diameter {}", diameter(root));
            fault("tip_diameter_mm", allowed, "external teeth point outwards");
        }
        if tip <= gear.base_radius {
            let allowed = format!("above the base diameter {}", diameter(gear.base_radius));
            fault("tip_diameter_mm", allowed, "there is no involute inside the base circle");
        }
    } else {
        if tip >= root {
            let allowed = format!("below the root diameter {}", diameter(root));
            fault("tip_diameter_mm", allowed, "internal teeth point inwards");
        }
        if tip < gear.base_radius {
            let allowed = format!("at least the base diameter {}", diameter(gear.base_radius));
            fault("tip_diameter_mm", allowed, "there is no involute inside the base circle");
        }
    }
    if let Some(body) = gear.body_radius {
        if !is_ring && body >= root {
            let allowed = format!("below the root diameter {}", diameter(root));
            fault(body_key, allowed, "the teeth stand on a rim");
        }
        if is_ring && body <= root {
            let allowed = format!("above the root diameter {}", diameter(root));
            fault(body_key, allowed, "the teeth stand on a rim");
        }
    }
    if !sound.get() {
        return false;
    }
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
        if !(relief.start_radius > low && relief.start_radius < high) {
            let allowed = format!("between {} and {}", diameter(low), diameter(high));
            fault("tip_relief.start_diameter_mm", allowed, "relief lies on the flank");
        }
    }
    sound.get()
}

/// Checks interference, clearances, contact ratio and backlash of one mesh.
fn one_mesh(document: &Document<'_>, geometry: &Geometry, mesh: &Mesh) {
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
    if mesh.tip_fouling_clearance().is_some_and(|angle| angle < 0.0) {
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
    if backlash < -1e-9 {
        let why = format!("the {} mesh has backlash {}: it jams", mesh.kind.name(), mm(backlash));
        let key = "geometry.thickness.profile_shift";
        document.fault(key, "shifts that leave backlash 0 or above", why);
    }
}

/// Refuses flexibility factors at every fidelity but `quasi_static`: elastic states of a body act in several
/// meshes at once and cannot be scaled for one mesh.
fn factors_need_quasi_static(document: &Document<'_>, scene: &Scene) {
    let factor = scene.fe_contact.flexibility_factor;
    if scene.dynamics.fidelity == Fidelity::QuasiStatic {
        return;
    }
    for (name, value) in [("sun_planet", factor.sun_planet), ("ring_planet", factor.ring_planet)] {
        if value != 1.0 {
            let key = format!("fe_contact.flexibility_factor.{name}");
            let why = "a planet that vibrates within itself cannot be softer for one mesh alone";
            document.fault(&key, "1, or dynamics.fidelity = \"quasi_static\"", why);
        }
    }
}

fn distinct_positions(document: &Document<'_>, scene: &Scene) {
    let psi = &scene.planets.psi_rad;
    for (p, q, chord) in assembly::planet_clearances(psi, 1.0, 0.0) {
        if chord < 1e-9 {
            let key = if document.has("planets.position_steps") {
                "planets.position_steps"
            } else {
                "planets.positions_deg"
            };
            let why = format!("planets {p} and {q} stand at the same place");
            document.fault(key, "distinct positions", why);
        }
    }
}
