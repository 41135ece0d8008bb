//! `[geometry.thickness]`: tooth thickness from backlash, or from profile shifts and what teeth are thinner.

use std::f64::consts::PI;

use gearset::{MeshKind, ShiftedMesh, Teeth, ThicknessInput, Thinning};

use crate::read::document::Section;
use crate::read::geometry::GeometryRead;
use crate::warnings::signed_mm;

/// Backlash that is nothing but rounding of the arithmetic, m.
const NOTHING: f64 = 1e-12;

/// The table as it is given.
pub(crate) struct ThicknessRead {
    pub(crate) input: ThicknessInput,
    /// Half-units of the last digits of the shifts of sun, planet and ring.
    pub(crate) shift_rounding: [f64; 3],
    /// Whether the ring's shift is given in the sign of ISO 21771.
    pub(crate) is_iso_sign: bool,
    /// Backlash of the sun and the ring mesh beside profile shifts, m.
    pub(crate) backlash: [Option<f64>; 2],
}

/// Names of the meshes' keys of backlash.
const BACKLASH: [&str; 2] = ["sun_planet_backlash_mm", "ring_planet_backlash_mm"];

pub(crate) fn thickness(
    s: &Section<'_, '_>,
    t: &Section<'_, '_>,
    base_pitch: f64,
) -> ThicknessRead {
    if t.has("profile_shift") {
        return shifted(s, t);
    }
    t.skip("profile_shift");
    t.refuse_as(
        "thinning_mm",
        "nothing without profile_shift",
        "it is counted from nominal shifts",
    );
    // By default 0.04 p_b/π = 0.04 m cos α, a usual value.
    let backlash = |key| t.optional(key).unwrap_or(0.04 * base_pitch / PI);
    ThicknessRead {
        input: ThicknessInput::Backlash {
            sun_planet_m: backlash(BACKLASH[0]),
            ring_planet_m: backlash(BACKLASH[1]),
            planet_share: t.number("planet_share"),
        },
        shift_rounding: [0.0; 3],
        is_iso_sign: false,
        backlash: [None; 2],
    }
}

fn shifted(s: &Section<'_, '_>, t: &Section<'_, '_>) -> ThicknessRead {
    let shift = t.table("profile_shift");
    let why = "shifts and backlash fix the thickness of both gears";
    t.refuse_as("planet_share", "nothing beside profile_shift", why);
    if !s.may_hold("rack") {
        t.fault("profile_shift", "with geometry.rack given", "a shift is counted in modules");
    }
    let backlash = BACKLASH.map(|key| t.optional(key));
    if t.has("thinning_mm") {
        for key in BACKLASH {
            let why = "both say by how much teeth are thinner than their shifts say";
            t.refuse_as(key, "nothing beside thinning_mm", why);
        }
    }
    let thinning = t.table("thinning_mm");
    let is_iso_sign = shift.word("ring_sign") == Some("iso_21771");
    let sign = if is_iso_sign { -1.0 } else { 1.0 };
    ThicknessRead {
        input: ThicknessInput::ProfileShift {
            sun: shift.number("sun"),
            planet: shift.number("planet"),
            ring: sign * shift.number("ring"),
            thinning: Thinning {
                sun_m: thinning.number("sun"),
                planet_m: thinning.number("planet"),
                ring_m: thinning.number("ring"),
            },
        },
        shift_rounding: ["sun", "planet", "ring"].map(|gear| shift.half_unit(gear)),
        is_iso_sign,
        backlash,
    }
}

/// Thins teeth to the backlash that is given beside shifts, and to none where the shifts leave less than none by no
/// more than the rounding of what is written.
pub(crate) fn close(
    s: &Section<'_, '_>,
    t: &Section<'_, '_>,
    read: &mut GeometryRead,
    teeth: &Teeth,
    asked: [Option<f64>; 2],
) {
    let input = &mut read.input;
    let ThicknessInput::ProfileShift { sun, planet, ring, thinning } = input.thickness else {
        return;
    };
    let is_sound = !s.document.is_doubtful("teeth") && !t.document.is_doubtful("geometry.rack");
    let Some(rack) = input.rack.filter(|_| is_sound) else { return };
    let mut needs = [0.0; 2];
    let mut taken_as_zero = [None; 2];
    for (i, kind) in [MeshKind::SunPlanet, MeshKind::RingPlanet].into_iter().enumerate() {
        let a = input.center_distance_m;
        let Some(mesh) = ShiftedMesh::new(kind, teeth, rack, a, &input.thickness) else { continue };
        let Some(of_shifts) = mesh.backlash() else { continue };
        let per_thinning = mesh.backlash_per_thinning();
        let left = of_shifts + thinning.of_mesh(kind) * per_thinning;
        let rounding = mesh.rounding(&read.written);
        let need = asked[i].unwrap_or(0.0) - left;
        if asked[i].is_some() && need < -rounding - NOTHING {
            let allowed = format!("at least {:.4} mm", 1e3 * left);
            let why = format!("the shifts leave the {} mesh as much by themselves", kind.name());
            t.fault(BACKLASH[i], allowed, why);
        }
        let is_rounding = asked[i].is_none() && need > NOTHING && need <= rounding;
        if is_rounding {
            taken_as_zero[i] = Some((kind, left, rounding));
        }
        if asked[i].is_some_and(|_| need > 0.0) || is_rounding {
            needs[i] = need / per_thinning;
        }
    }
    if needs == [0.0; 2] {
        return;
    }
    let more = Thinning::shared(needs);
    for (kind, left, rounding) in taken_as_zero.into_iter().flatten() {
        let um = |length: f64| format!("{:.2} µm", 1e6 * length);
        let (mate, thinner) = match kind {
            MeshKind::SunPlanet => ("sun", more.sun_m),
            MeshKind::RingPlanet => ("ring", more.ring_m),
        };
        let by = match thinner == more.planet_m {
            true => format!("teeth of both gears thinned by {}", um(thinner)),
            false => {
                format!(
                    "teeth of {mate} and planet thinned by {} and {}",
                    um(thinner),
                    um(more.planet_m)
                )
            }
        };
        s.document.remarks.borrow_mut().notes.push(format!(
            "backlash {} mm of the {} mesh lies within the rounding of the given shifts and distance, ±{} mm: taken as 0, {by}",
            signed_mm(left),
            kind.name(),
            signed_mm(rounding)
        ));
    }
    input.thickness = ThicknessInput::ProfileShift {
        sun,
        planet,
        ring,
        thinning: Thinning {
            sun_m: thinning.sun_m + more.sun_m,
            planet_m: thinning.planet_m + more.planet_m,
            ring_m: thinning.ring_m + more.ring_m,
        },
    };
}
