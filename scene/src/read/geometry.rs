//! The `[geometry]` table. Lengths that are absent or at fault are NaN, of which no check reports a consequence.

use std::f64::consts::PI;

use gearset::{
    CarrierInput, GearInput, GeometryInput, Rack, ReliefShape, ThicknessInput, Thinning, TipRelief,
};

use crate::read::TeethRead;
use crate::read::document::Section;

/// A gear whose table is absent or at fault.
const UNKNOWN: GearInput = GearInput {
    tip_radius_m: f64::NAN,
    root_radius_m: f64::NAN,
    body_radius_m: None,
    fillet_radius_m: f64::NAN,
    tip_relief: None,
};

pub(crate) fn geometry(s: &Section<'_, '_>, teeth: &TeethRead) -> GeometryInput {
    let (center_distance, face_width) = (s.number("center_distance_mm"), s.number("face_width_mm"));
    let rack = s.section("rack").map(|s| Rack {
        module_m: s.number("module_mm"),
        pressure_angle_rad: s.number("pressure_angle_deg"),
    });
    let base_pitch = base_pitch(s, teeth, rack);
    let one = |key, body, is_wanted: bool| {
        let found = s.section(key).map(|g| gear(&g, body, base_pitch));
        if found.is_none() && is_wanted && !s.has(key) {
            let allowed = format!("[geometry.{key}] with tip and root diameter");
            s.fault(key, allowed, "[teeth] names this gear");
        }
        found
    };
    let sun = one("sun", "bore_diameter_mm", teeth.sun.is_some());
    let planet = one("planet", "bore_diameter_mm", true);
    let ring = one("ring", "rim_diameter_mm", teeth.ring.is_some());
    for (key, gear) in [("sun", &sun), ("ring", &ring)] {
        // Without [teeth] as a whole that table is what is missing.
        let teeth = format!("teeth.{key}");
        if gear.is_some() && s.document.may_hold("teeth") && !s.document.may_hold(&teeth) {
            s.fault(key, format!("with {teeth} given"), "its number of teeth is missing");
        }
    }
    GeometryInput {
        center_distance_m: center_distance,
        base_pitch_m: base_pitch,
        rack,
        face_width_m: face_width,
        sun,
        planet: planet.unwrap_or(UNKNOWN),
        ring,
        carrier: s.section("carrier").map(|s| CarrierInput {
            bore_radius_m: 0.5 * s.number("bore_diameter_mm"),
            outer_radius_m: 0.5 * s.number("outer_diameter_mm"),
            pin_seat_radius_m: 0.5 * s.number("pin_seat_diameter_mm"),
            is_rigid: s.word("body") == Some("rigid"),
        }),
        thickness: thickness(s, base_pitch),
    }
}

/// The base pitch common to all gears, from the one key that gives it.
fn base_pitch(s: &Section<'_, '_>, teeth: &TeethRead, rack: Option<Rack>) -> f64 {
    let keys = ["base_pitch_mm", "planet_base_diameter_mm", "rack"];
    let pitch = s.optional("base_pitch_mm");
    let diameter_mm = s.in_its_unit("planet_base_diameter_mm");
    let given: Vec<_> = keys.into_iter().filter(|k| s.may_hold(k)).collect();
    if given.len() != 1 {
        let key = given.last().unwrap_or(&"base_pitch_mm");
        let allowed = format!("exactly one of {}", keys.join(", "));
        s.fault(key, allowed, "one base pitch makes every mesh exactly conjugate");
        return f64::NAN;
    }
    let from_diameter = diameter_mm.zip(teeth.planet).map(|(d, z)| PI * d * 1e-3 / f64::from(z));
    // p_b = π m cos α₀
    let from_rack = rack.map(|r| PI * r.module_m * r.pressure_angle_rad.cos());
    pitch.or(from_diameter).or(from_rack).unwrap_or(f64::NAN)
}

fn gear(s: &Section<'_, '_>, body_key: &'static str, base_pitch: f64) -> GearInput {
    GearInput {
        tip_radius_m: 0.5 * s.number("tip_diameter_mm"),
        root_radius_m: 0.5 * s.number("root_diameter_mm"),
        body_radius_m: s.optional(body_key).map(|d| 0.5 * d),
        // By default 0.3 p_b/π = 0.3 m cos α, a usual tip rounding of the rack.
        fillet_radius_m: s.optional("fillet_radius_mm").unwrap_or(0.3 * base_pitch / PI),
        tip_relief: s.section("tip_relief").map(|s| TipRelief {
            start_radius_m: 0.5 * s.number("start_diameter_mm"),
            amount_m: s.number("amount_um"),
            shape: s.choice("shape").unwrap_or(ReliefShape::Linear),
        }),
    }
}

fn thickness(s: &Section<'_, '_>, base_pitch: f64) -> ThicknessInput {
    let t = s.table("thickness");
    if t.has("profile_shift") {
        let shift = t.table("profile_shift");
        for key in ["sun_planet_backlash_mm", "ring_planet_backlash_mm", "planet_share"] {
            t.refuse_as(key, "nothing beside profile_shift", "profile shifts fix the thickness");
        }
        if !s.may_hold("rack") {
            t.fault("profile_shift", "with geometry.rack given", "a shift is counted in modules");
        }
        return ThicknessInput::ProfileShift {
            sun: shift.number("sun"),
            planet: shift.number("planet"),
            ring: shift.number("ring"),
            thinning: Thinning::default(),
        };
    }
    t.skip("profile_shift");
    // By default 0.04 p_b/π = 0.04 m cos α, a usual value.
    let backlash = |key| t.optional(key).unwrap_or(0.04 * base_pitch / PI);
    ThicknessInput::Backlash {
        sun_planet_m: backlash("sun_planet_backlash_mm"),
        ring_planet_m: backlash("ring_planet_backlash_mm"),
        planet_share: t.number("planet_share"),
    }
}
