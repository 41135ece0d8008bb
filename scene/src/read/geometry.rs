//! The `[geometry]` table. Lengths that are at fault, or absent and not chosen, are NaN, of which no check reports a
//! consequence.

use std::f64::consts::PI;

use gearset::{
    CarrierInput, GearInput, GeometryInput, OpenCircles, Rack, RackProfile, ReliefShape, TipRelief,
    WrittenRounding,
};

use crate::read::TeethRead;
use crate::read::document::Section;
use crate::read::rack_defaults;
use crate::read::thickness::{self, thickness};
use crate::read::tip_rounding;

/// A gear whose table is absent or at fault.
const UNKNOWN: GearInput = GearInput {
    tip_radius_m: f64::NAN,
    root_radius_m: f64::NAN,
    body_radius_m: None,
    fillet_radius_m: f64::NAN,
    tip_relief: None,
};

/// The table, and how far its numbers are rounded.
pub(crate) struct GeometryRead {
    pub(crate) input: GeometryInput,
    pub(crate) written: WrittenRounding,
    /// The same of tip radius, root radius and fillet of sun, planet and ring, m.
    pub(crate) circles: [CirclesRounding; 3],
    /// Whether the file gives the ring's shift in the sign of ISO 21771.
    pub(crate) is_iso_sign: bool,
}

/// Half-units of the last digits of a gear's circles, as radii, m.
#[derive(Clone, Copy, Default)]
pub(crate) struct CirclesRounding {
    pub(crate) tip: f64,
    pub(crate) root: f64,
    pub(crate) fillet: f64,
}

impl CirclesRounding {
    fn new(s: &Section<'_, '_>) -> Self {
        Self {
            tip: 0.5 * s.half_unit("tip_diameter_mm"),
            root: 0.5 * s.half_unit("root_diameter_mm"),
            fillet: s.half_unit("fillet_radius_mm"),
        }
    }
}

/// The rack with its profile, in modules; heights may be NaN.
pub(crate) struct RackRead {
    pub(crate) rack: Rack,
    pub(crate) profile: RackProfile,
    pub(crate) fillet_radius: f64,
}

pub(crate) fn geometry(s: &Section<'_, '_>, teeth: &TeethRead) -> GeometryRead {
    let (center_distance, face_width) = (s.number("center_distance_mm"), s.number("face_width_mm"));
    let mut module_rounding = 0.0;
    let rack = s.section("rack").map(|s| {
        module_rounding = module_half_unit(&s);
        rack(&s)
    });
    let has_rack = rack.is_some();
    if !has_rack {
        s.demand("center_distance_mm");
    }
    let base_pitch = base_pitch(s, teeth, rack.as_ref().map(|read| read.rack));
    let mut open = [OpenCircles::default(); 3];
    let mut circles = [CirclesRounding::default(); 3];
    let mut one = |index: usize, key, body, is_wanted: bool| {
        let table = s.section(key);
        circles[index] = table.as_ref().map(CirclesRounding::new).unwrap_or_default();
        let is_left_out = table.is_none() && !s.may_hold(key);
        let circles = match (&table, is_wanted && is_left_out, has_rack) {
            (Some(table), ..) => gear(table, body, base_pitch, rack.as_ref(), &mut open[index]),
            (None, true, true) => {
                gear(&s.table(key), body, base_pitch, rack.as_ref(), &mut open[index])
            }
            (None, true, false) => {
                let allowed = format!("[geometry.{key}] with tip and root diameter");
                s.fault(key, allowed, "[teeth] names this gear");
                return None;
            }
            (None, false, _) => return None,
        };
        Some(circles)
    };
    let sun = one(0, "sun", "bore_diameter_mm", teeth.sun.is_some());
    let planet = one(1, "planet", "bore_diameter_mm", true);
    let ring = one(2, "ring", "rim_diameter_mm", teeth.ring.is_some());
    for (key, gear) in [("sun", &sun), ("ring", &ring)] {
        // Without [teeth] as a whole that table is what is missing.
        let teeth = format!("teeth.{key}");
        let is_told = s.document.is_doubtful(&teeth);
        if gear.is_some() && s.document.may_hold("teeth") && !s.document.has(&teeth) && !is_told {
            s.fault(key, format!("with {teeth} given"), "its number of teeth is missing");
        }
    }
    let table = s.table("thickness");
    let thickness = thickness(s, &table, base_pitch);
    let mut read = GeometryRead {
        input: GeometryInput {
            center_distance_m: center_distance,
            base_pitch_m: base_pitch,
            rack: rack.as_ref().map(|read| read.rack),
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
            thickness: thickness.input,
        },
        written: WrittenRounding {
            center_distance_m: s.half_unit("center_distance_mm"),
            module_m: module_rounding,
            shifts: thickness.shift_rounding,
        },
        circles,
        is_iso_sign: thickness.is_iso_sign,
    };
    if let Some(teeth) = teeth.complete() {
        rack_defaults::choose(s, &mut read.input, &teeth, rack.as_ref(), &open);
        thickness::close(s, &table, &mut read, &teeth, thickness.backlash);
        tip_rounding::lower(s, &mut read, &teeth);
    }
    read
}

fn rack(s: &Section<'_, '_>) -> RackRead {
    let profile = RackProfile { addendum: s.number("addendum"), dedendum: s.number("dedendum") };
    if profile.dedendum <= profile.addendum {
        let allowed = format!("above the addendum {}", profile.addendum);
        s.fault("dedendum", allowed, "the difference is the bottom clearance");
    }
    RackRead {
        rack: Rack {
            module_m: s.number("module_mm"),
            pressure_angle_rad: s.number("pressure_angle_deg"),
        },
        profile,
        fillet_radius: s.number("fillet_radius"),
    }
}

/// Half a unit of the module's last digit, m. Modules in steps of 0.05 or of 1/8 mm are nominal sizes, that is exact.
fn module_half_unit(s: &Section<'_, '_>) -> f64 {
    let mm = 1e3 * s.number("module_mm");
    let is_in_steps = |step: f64| (mm / step - (mm / step).round()).abs() < 1e-9;
    if is_in_steps(0.05) || is_in_steps(0.125) { 0.0 } else { s.half_unit("module_mm") }
}

/// The base pitch common to all gears, from the one key that gives it.
fn base_pitch(s: &Section<'_, '_>, teeth: &TeethRead, rack: Option<Rack>) -> f64 {
    let keys = ["base_pitch_mm", "planet_base_diameter_mm", "rack"];
    let pitch = s.optional("base_pitch_mm");
    let diameter_mm = s.in_its_unit("planet_base_diameter_mm");
    let given: Vec<_> = keys.into_iter().filter(|k| s.may_hold(k)).collect();
    let is_known = keys.into_iter().all(|k| s.has(k) || !s.may_hold(k));
    if given.len() != 1 && is_known {
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

fn gear(
    s: &Section<'_, '_>,
    body_key: &'static str,
    base_pitch: f64,
    rack: Option<&RackRead>,
    open: &mut OpenCircles,
) -> GearInput {
    let is_left_out = |key: &str| !s.may_hold(key);
    if rack.is_some() {
        open.tip = is_left_out("tip_diameter_mm");
        open.root = is_left_out("root_diameter_mm");
        open.body = open.root && is_left_out(body_key);
    } else {
        s.demand("tip_diameter_mm");
        s.demand("root_diameter_mm");
    }
    open.fillet = is_left_out("fillet_radius_mm");
    let fillet = match rack.filter(|_| open.root) {
        Some(read) => read.fillet_radius * read.rack.module_m,
        // 0.3 p_b/π = 0.3 m cos α, a usual tip rounding of the rack.
        None => 0.3 * base_pitch / PI,
    };
    GearInput {
        tip_radius_m: 0.5 * s.number("tip_diameter_mm"),
        root_radius_m: 0.5 * s.number("root_diameter_mm"),
        body_radius_m: s.optional(body_key).map(|d| 0.5 * d),
        fillet_radius_m: s.optional("fillet_radius_mm").unwrap_or(fillet),
        tip_relief: s.section("tip_relief").map(|s| TipRelief {
            start_radius_m: 0.5 * s.number("start_diameter_mm"),
            amount_m: s.number("amount_um"),
            shape: s.choice("shape").unwrap_or(ReliefShape::Linear),
        }),
    }
}
