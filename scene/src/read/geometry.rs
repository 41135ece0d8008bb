//! The `[geometry]` table.

use std::f64::consts::{PI, TAU};

use gearset::{
    CarrierInput, GearInput, GeometryInput, Rack, ReliefShape, ThicknessInput, TipRelief,
};

use crate::keys::bound::Bound;
use crate::read::TeethRead;
use crate::read::document::Section;

/// The table as far as it can be read. Lengths in m.
#[derive(Debug)]
pub(crate) struct GeometryRead {
    pub(crate) center_distance: Option<f64>,
    pub(crate) base_pitch: Option<f64>,
    pub(crate) face_width: Option<f64>,
    pub(crate) rack: Option<Rack>,
    pub(crate) sun: Option<GearRead>,
    pub(crate) planet: Option<GearRead>,
    pub(crate) ring: Option<GearRead>,
    pub(crate) carrier: Option<CarrierRead>,
    pub(crate) thickness: Option<ThicknessInput>,
}

/// One gear as far as it can be read.
#[derive(Debug, Clone)]
pub(crate) struct GearRead {
    pub(crate) tip_radius: Option<f64>,
    pub(crate) root_radius: Option<f64>,
    pub(crate) body_radius: Option<f64>,
    pub(crate) fillet_radius: f64,
    pub(crate) tip_relief: Option<TipRelief>,
}

/// The carrier as far as it can be read.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CarrierRead {
    pub(crate) bore_radius: Option<f64>,
    pub(crate) outer_radius: Option<f64>,
    pub(crate) pin_seat_radius: f64,
    pub(crate) is_rigid: bool,
}

impl GearRead {
    pub(crate) fn complete(&self) -> Option<GearInput> {
        Some(GearInput {
            tip_radius: self.tip_radius?,
            root_radius: self.root_radius?,
            body_radius: self.body_radius,
            fillet_radius: self.fillet_radius,
            tip_relief: self.tip_relief,
        })
    }
}

impl GeometryRead {
    /// The whole table, `None` if a part is absent or at fault.
    pub(crate) fn complete(&self) -> Option<GeometryInput> {
        let gear = |read: &Option<GearRead>| match read {
            Some(read) => read.complete().map(Some),
            None => Some(None),
        };
        let carrier = |c: CarrierRead| {
            Some(CarrierInput {
                bore_radius: c.bore_radius?,
                outer_radius: c.outer_radius?,
                pin_seat_radius: c.pin_seat_radius,
                is_rigid: c.is_rigid,
            })
        };
        Some(GeometryInput {
            center_distance: self.center_distance?,
            base_pitch: self.base_pitch?,
            rack: self.rack,
            face_width: self.face_width?,
            sun: gear(&self.sun)?,
            planet: self.planet.as_ref()?.complete()?,
            ring: gear(&self.ring)?,
            carrier: self.carrier.and_then(carrier),
            thickness: self.thickness?,
        })
    }
}

pub(crate) fn geometry(s: Section<'_, '_>, teeth: &TeethRead) -> GeometryRead {
    let millimetres = |key, why: &str| s.required(key, Bound::Positive, why).map(|x| x * 1e-3);
    let center_distance = millimetres("center_distance_mm", "distance from sun to planet");
    let face_width = millimetres("face_width_mm", "width of the teeth");
    let rack = s.section("rack").and_then(rack);
    let base_pitch = base_pitch(&s, teeth, rack);
    // Default fillet radius 0.3 p_b/π = 0.3 m cos α, a usual tip rounding of the rack.
    let default_fillet = base_pitch.map_or(0.0, |p| 0.3 * p / PI);
    let one = |key: &'static str, body: &'static str, wanted: bool| {
        let found = s.section(key).map(|g| gear(g, body, default_fillet));
        if found.is_none() && wanted && !s.has(key) {
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
        if gear.is_some() && s.is_in_document("teeth") && !s.is_in_document(&format!("teeth.{key}"))
        {
            s.fault(key, format!("with teeth.{key} given"), "its number of teeth is missing");
        }
    }
    let carrier = s.section("carrier").map(carrier);
    let thickness = thickness(&s, base_pitch);
    s.finish();
    GeometryRead {
        center_distance,
        base_pitch,
        face_width,
        rack,
        sun,
        planet,
        ring,
        carrier,
        thickness,
    }
}

fn rack(s: Section<'_, '_>) -> Option<Rack> {
    let module = s.required("module_mm", Bound::Positive, "module of the generating rack");
    let why = "pressure angle of the generating rack";
    let angle = s.required("pressure_angle_deg", Bound::Between(0.0, 45.0), why);
    s.finish();
    Some(Rack { module: module? * 1e-3, pressure_angle: angle?.to_radians() })
}

/// The base pitch common to all gears, from the one key that gives it.
fn base_pitch(s: &Section<'_, '_>, teeth: &TeethRead, rack: Option<Rack>) -> Option<f64> {
    let keys = ["base_pitch_mm", "planet_base_diameter_mm", "rack"];
    let pitch = s.number("base_pitch_mm", Bound::Positive, "base pitch of every gear");
    let diameter = s.number("planet_base_diameter_mm", Bound::Positive, "p_b = π d_b / Z_p");
    let given: Vec<_> = keys.into_iter().filter(|k| s.may_hold(k)).collect();
    if given.len() != 1 {
        let key = given.last().unwrap_or(&"base_pitch_mm");
        let allowed = format!("exactly one of {}", keys.join(", "));
        s.fault(key, allowed, "one base pitch makes every mesh exactly conjugate");
        return None;
    }
    let from_pitch = pitch.map(|p| p * 1e-3);
    let from_diameter = diameter.zip(teeth.planet).map(|(d, z)| PI * d * 1e-3 / f64::from(z));
    // p_b = π m cos α₀
    let from_rack = rack.map(|r| PI * r.module * r.pressure_angle.cos());
    from_pitch.or(from_diameter).or(from_rack)
}

fn gear(s: Section<'_, '_>, body_key: &'static str, default_fillet: f64) -> GearRead {
    let radius = |key, why: &str| s.required(key, Bound::Positive, why).map(|d| d * 0.5e-3);
    let tip_radius = radius("tip_diameter_mm", "tip circle");
    let root_radius = radius("root_diameter_mm", "root circle");
    let why = "inner circle of an external gear, outer circle of the ring";
    let body_radius = s.number(body_key, Bound::Positive, why).map(|d| d * 0.5e-3);
    let fillet = s.number("fillet_radius_mm", Bound::NonNegative, "root fillet");
    let relief = s.section("tip_relief").and_then(tip_relief);
    s.finish();
    GearRead {
        tip_radius,
        root_radius,
        body_radius,
        fillet_radius: fillet.map_or(default_fillet, |r| r * 1e-3),
        tip_relief: relief,
    }
}

fn carrier(s: Section<'_, '_>) -> CarrierRead {
    let radius = |key, why: &str| s.required(key, Bound::Positive, why).map(|d| d * 0.5e-3);
    let bore_radius = radius("bore_diameter_mm", "the carrier's race");
    let outer_radius = radius("outer_diameter_mm", "edge of the carrier's annulus");
    let why = "rigid seat of each planet's pin";
    let seat = s.number("pin_seat_diameter_mm", Bound::Positive, why).map(|d| d * 0.5e-3);
    let bodies = [("flexible", false), ("rigid", true)];
    let is_rigid =
        s.choice("body", &bodies, "whether the annulus gives way between bore and seats");
    s.finish();
    CarrierRead {
        bore_radius,
        outer_radius,
        pin_seat_radius: seat.unwrap_or(10e-3),
        is_rigid: is_rigid.unwrap_or(false),
    }
}

fn tip_relief(s: Section<'_, '_>) -> Option<TipRelief> {
    let start = s.required("start_diameter_mm", Bound::Positive, "where the relief starts");
    let why = "material taken off at the tip, along the line of action";
    let amount = s.required("amount_um", Bound::NonNegative, why);
    let shapes = [("linear", ReliefShape::Linear), ("parabolic", ReliefShape::Parabolic)];
    let shape = s.choice("shape", &shapes, "growth from start to tip");
    s.finish();
    Some(TipRelief {
        start_radius: start? * 0.5e-3,
        amount: amount? * 1e-6,
        shape: shape.unwrap_or(ReliefShape::Linear),
    })
}

fn thickness(s: &Section<'_, '_>, base_pitch: Option<f64>) -> Option<ThicknessInput> {
    let t = s.section("thickness");
    if let Some(t) = &t
        && t.has("profile_shift")
    {
        let shift = t.section("profile_shift").map(|x| {
            let why = "profile shift coefficient (ring: internal-gear sign)";
            let value = |key| x.number(key, Bound::Between(-5.0, 5.0), why);
            let found = (value("sun"), value("planet"), value("ring"));
            x.finish();
            found
        });
        for key in ["sun_planet_backlash_mm", "ring_planet_backlash_mm", "planet_share"] {
            if t.has(key) {
                t.fault(key, "nothing beside profile_shift", "profile shifts fix the thickness");
            }
            t.skip(key);
        }
        if !s.may_hold("rack") {
            t.fault("profile_shift", "with geometry.rack given", "a shift is counted in modules");
        }
        t.check_keys();
        let (sun, planet, ring) = shift?;
        let or_zero = |x: Option<f64>| x.unwrap_or(0.0);
        let input = ThicknessInput::ProfileShift {
            sun: or_zero(sun),
            planet: or_zero(planet),
            ring: or_zero(ring),
        };
        return Some(input);
    }
    // Default backlash 0.04 p_b/π = 0.04 m cos α, a usual value.
    let default = base_pitch.map(|p| p * 0.08 / TAU);
    let (mut sun_planet, mut ring_planet, mut planet_share) = (None, None, None);
    if let Some(t) = t {
        let why = "circumferential backlash at the operating pitch circles; below 0 the teeth jam";
        let mm = |key| t.number(key, Bound::NonNegative, why).map(|x| x * 1e-3);
        sun_planet = mm("sun_planet_backlash_mm");
        ring_planet = mm("ring_planet_backlash_mm");
        let why = "planet's share of the sum of sun and planet tooth thickness";
        planet_share = t.number("planet_share", Bound::Between(0.0, 1.0), why);
        t.skip("profile_shift");
        t.finish();
    }
    Some(ThicknessInput::Backlash {
        sun_planet: sun_planet.or(default)?,
        ring_planet: ring_planet.or(default)?,
        planet_share: planet_share.unwrap_or(0.5),
    })
}
