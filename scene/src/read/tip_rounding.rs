//! Tips that reach beyond the involute of the mating gear by no more than the rounding of the diameters written.

use gearset::{Gear, Geometry, MeshKind, MeshMember, Teeth, ToothSide};

use crate::read::document::Section;
use crate::read::geometry::{CirclesRounding, GeometryRead};
use crate::warnings::{shown, signed_mm};

/// Room that is left between a tip that is lowered and the end of the involute, m.
const ROOM: f64 = 1e-9;
const NAMES: [&str; 3] = ["sun", "planet", "ring"];

/// Lowers such tips to the end of the involute, and notes it.
pub(crate) fn lower(s: &Section<'_, '_>, read: &mut GeometryRead, teeth: &Teeth) {
    let is_sound = !s.document.is_doubtful("geometry") && !s.document.is_doubtful("teeth");
    if !is_sound || s.document.is_exact {
        return;
    }
    let Ok(geometry) = Geometry::new(&read.input, teeth) else { return };
    // Whose tip touches whose fillet.
    for (kind, member, [tip, mate]) in [
        (MeshKind::SunPlanet, MeshMember::Driver, [1, 0]),
        (MeshKind::SunPlanet, MeshMember::Driven, [0, 1]),
        (MeshKind::RingPlanet, MeshMember::Driver, [2, 1]),
        (MeshKind::RingPlanet, MeshMember::Driven, [1, 2]),
    ] {
        let Some(mesh) = geometry.mesh(kind) else { continue };
        let other = match member {
            MeshMember::Driver => MeshMember::Driven,
            MeshMember::Driven => MeshMember::Driver,
        };
        let overrun = mesh.interference(member);
        let rounding = of_tip(mesh.gear(other), &read.circles[tip])
            + of_form(mesh.gear(member), &read.circles[mate]);
        if !(overrun > 0.0 && overrun <= rounding) {
            continue;
        }
        let Some(admissible) = mesh.admissible_tip_radius(other) else { continue };
        let circles = match tip {
            0 => read.input.sun.as_mut(),
            1 => Some(&mut read.input.planet),
            _ => read.input.ring.as_mut(),
        };
        let Some(circles) = circles else { continue };
        let radius = circles.tip_radius_m;
        circles.tip_radius_m = match tip {
            2 => radius.max(admissible + ROOM),
            _ => radius.min(admissible - ROOM),
        };
        s.document.remarks.borrow_mut().notes.push(format!(
            "in the {} mesh the {}'s tip touches the {} {} mm beyond its form circle, within the rounding of the diameters given, ±{} mm: the tip diameter is taken as {} mm",
            kind.name(),
            NAMES[tip],
            NAMES[mate],
            signed_mm(overrun),
            signed_mm(rounding),
            shown(2e3 * circles.tip_radius_m)
        ));
    }
}

/// Change of the roll length at the tip, s = √(r² − r_b²), by rounding: r/s δr.
fn of_tip(gear: &Gear, written: &CirclesRounding) -> f64 {
    match gear.tip_roll_length() {
        s if s > 0.0 => gear.tip_radius / s * written.tip,
        _ => 0.0,
    }
}

/// Change of the roll length at the form circle, s = √((r_f ± ρ)² − r_b²) ∓ ρ, by rounding: with c = (r_f ± ρ)/(s ± ρ)
/// it is c δr_f + |c − 1| δρ.
fn of_form(gear: &Gear, written: &CirclesRounding) -> f64 {
    let sign = if gear.side == ToothSide::External { 1.0 } else { -1.0 };
    let rho = sign * gear.fillet_radius;
    match gear.form_roll_length() {
        Some(s) if s + rho > 0.0 => {
            let slope = (gear.root_radius + rho) / (s + rho);
            slope * written.root + (slope - 1.0).abs() * written.fillet
        }
        _ => 0.0,
    }
}
