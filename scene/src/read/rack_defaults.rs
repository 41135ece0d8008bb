//! What follows from the rack where `[geometry]` leaves it out: centre distance and circles.

use std::f64::consts::PI;

use gearset::{
    GearInput, GeometryInput, MeshKind, OpenCircles, RackProfile, ShiftedMesh, Teeth, fill_circles,
};

use crate::read::document::Section;
use crate::read::geometry::RackRead;
use crate::warnings::shown;

/// Fills what is left out, and notes it; what depends on a value at fault stays unknown.
pub(crate) fn choose(
    s: &Section<'_, '_>,
    input: &mut GeometryInput,
    teeth: &Teeth,
    rack: Option<&RackRead>,
    open: &[OpenCircles; 3],
) {
    if let Some(read) = rack.filter(|_| !s.may_hold("center_distance_mm")) {
        let kind = if teeth.sun.is_some() { MeshKind::SunPlanet } else { MeshKind::RingPlanet };
        let mesh = ShiftedMesh::new(kind, teeth, read.rack, f64::NAN, &input.thickness);
        if let Some(mesh) = mesh
            && let Some(a) = mesh.closing_distance().filter(|a| a.is_finite())
        {
            input.center_distance_m = a;
            let why = match mesh.shift_sum == 0.0 {
                true => format!("module times half of {}", mesh.teeth),
                false => format!("where the shifts close the {} mesh", kind.name()),
            };
            s.choose("center_distance_mm", shown(1e3 * a), &why);
        }
    }
    // Without a rack only fillets are left out, for which a usual module is near enough.
    let module = rack.map_or(input.base_pitch_m / PI, |read| read.rack.module_m);
    let profile = rack.map_or(RackProfile { addendum: 1.0, dedendum: 1.25 }, |read| read.profile);
    let before = input.clone();
    if !is_known(input, open) || fill_circles(input, teeth, module, &profile, open).is_err() {
        return;
    }
    note(s, &before, input, teeth, module, open, &profile);
}

/// Whether everything that is not left open is known.
fn is_known(input: &GeometryInput, open: &[OpenCircles; 3]) -> bool {
    let gears = [input.sun.as_ref(), Some(&input.planet), input.ring.as_ref()];
    let is_gear_known = |gear: &GearInput, open: &OpenCircles| {
        (open.tip || gear.tip_radius_m.is_finite())
            && (open.root || gear.root_radius_m.is_finite())
            && gear.fillet_radius_m.is_finite()
    };
    input.center_distance_m.is_finite()
        && input.base_pitch_m.is_finite()
        && gears
            .into_iter()
            .zip(open)
            .all(|(gear, open)| gear.is_none_or(|gear| is_gear_known(gear, open)))
}

/// Notes what was chosen.
fn note(
    s: &Section<'_, '_>,
    before: &GeometryInput,
    after: &GeometryInput,
    teeth: &Teeth,
    module: f64,
    open: &[OpenCircles; 3],
    profile: &RackProfile,
) {
    let gears = [
        ("sun", before.sun.as_ref(), after.sun.as_ref(), teeth.sun),
        ("planet", Some(&before.planet), Some(&after.planet), Some(teeth.planet)),
        ("ring", before.ring.as_ref(), after.ring.as_ref(), teeth.ring),
    ];
    let [x_sun, x_planet, x_ring] = input_shifts(after);
    for (((name, before, after, count), x), open) in
        gears.into_iter().zip([x_sun, x_planet, x_ring]).zip(open)
    {
        let (Some(before), Some(after), Some(count)) = (before, after, count) else { continue };
        let is_ring = name == "ring";
        let mm = |length: f64| shown(1e3 * length);
        let choose = |key: &str, length: f64, why: &str| {
            s.choose(&format!("{name}.{key}"), mm(length), why);
        };
        let (plus, minus) = if is_ring { ("−", "+") } else { ("+", "−") };
        if open.tip {
            let sign = if is_ring { -1.0 } else { 1.0 };
            let plain = module * (f64::from(count) + 2.0 * x + sign * 2.0 * profile.addendum);
            let tip = 2.0 * after.tip_radius_m;
            let why = match (tip - plain).abs() < 1e-8 {
                true => format!("m (Z {plus} 2 h_aP + 2x)"),
                false => format!(
                    "m (Z {plus} 2 h_aP + 2x) = {} would leave too little land or clearance, or leave the mate's involute",
                    mm(plain)
                ),
            };
            choose("tip_diameter_mm", tip, &why);
        }
        if open.root {
            let why = format!("m (Z {minus} 2 h_fP + 2x)");
            choose("root_diameter_mm", 2.0 * after.root_radius_m, &why);
        }
        let is_smaller = after.fillet_radius_m != before.fillet_radius_m;
        if open.fillet && (open.root || is_smaller) {
            let nominal = mm(before.fillet_radius_m);
            let why = match is_smaller {
                true => format!("the most that fits; {nominal} does not"),
                false => "rounding of the rack".to_owned(),
            };
            choose("fillet_radius_mm", after.fillet_radius_m, &why);
        }
        if let Some(body) = after.body_radius_m.filter(|_| open.body) {
            match is_ring {
                true => choose("rim_diameter_mm", 2.0 * body, "root circle and 7 m"),
                false => {
                    choose(
                        "bore_diameter_mm",
                        2.0 * body,
                        "root circle less 7 m, at least half of it",
                    );
                }
            }
        }
    }
}

fn input_shifts(input: &GeometryInput) -> [f64; 3] {
    match input.thickness {
        gearset::ThicknessInput::ProfileShift { sun, planet, ring, .. } => [sun, planet, ring],
        gearset::ThicknessInput::Backlash { .. } => [0.0; 3],
    }
}
