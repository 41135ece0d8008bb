//! The `[planets]` table.

use gearset::{PlanetPositions, assembly};

use crate::read::TeethRead;
use crate::read::document::Section;
use crate::scene::SceneKind;

/// Reads the positions; `kind` is `None` where the file does not say it.
pub(crate) fn planets(
    root: &Section<'_, '_>,
    kind: Option<SceneKind>,
    teeth: &TeethRead,
) -> Option<PlanetPositions> {
    if kind == Some(SceneKind::GearPair) {
        root.refuse("planets", "a gear pair has one planet, at zero");
        return Some(PlanetPositions::equally_spaced(1));
    }
    let Some(s) = root.section("planets") else {
        if kind.is_some() && !root.has("planets") {
            root.fault("planets", "[planets] with count", "a planetary set has planets");
        }
        return None;
    };
    let count = s.integer("count");
    let (steps, degrees) = (s.integers("position_steps"), s.numbers("positions_deg"));
    if s.may_hold("position_steps") || s.may_hold("positions_deg") {
        return positions(root, &s, count, steps, degrees, teeth);
    }
    equal_positions(&s, count?, teeth.sun.zip(teeth.ring))
}

/// Positions given explicitly, checked against count and assembly.
fn positions(
    root: &Section<'_, '_>,
    s: &Section<'_, '_>,
    count: Option<usize>,
    steps: Option<Vec<i64>>,
    degrees: Option<Vec<f64>>,
    teeth: &TeethRead,
) -> Option<PlanetPositions> {
    let sun_ring = teeth.sun.zip(teeth.ring);
    if s.has("position_steps") && s.has("positions_deg") {
        s.fault("positions_deg", "one of positions_deg and position_steps", "both say the same");
        return None;
    }
    let length_is_right = |key: &str, length: usize| match count {
        Some(n) if n == length => true,
        Some(n) => {
            s.fault(key, format!("{n} entries, as in count"), "one position a planet");
            false
        }
        None => false,
    };
    if let Some(steps) = steps {
        let ok = length_is_right("position_steps", steps.len());
        if ok && steps[0] != 0 {
            s.fault("position_steps", "0 first", "angles are counted from planet 0");
            return None;
        }
        let Some((z_s, z_r)) = sun_ring else {
            // Numbers of teeth that are at fault, or absent beside [geometry], have a fault of their own.
            if !root.may_hold("teeth") && !root.has("geometry") {
                let why = "a step is 360°/(Z_s+Z_r)";
                s.fault("position_steps", "with [teeth] sun and ring given", why);
            }
            return None;
        };
        let step = assembly::assembly_step_rad(z_s, z_r);
        let psi_rad = steps.iter().map(|&k| k as f64 * step).collect();
        return ok.then_some(PlanetPositions { psi_rad, steps: Some(steps) });
    }
    let degrees = degrees?;
    if !length_is_right("positions_deg", degrees.len()) {
        return None;
    }
    if degrees[0] != 0.0 {
        s.fault("positions_deg", "0 first", "angles are counted from planet 0");
        return None;
    }
    if let Some(&far) = degrees.iter().find(|d| d.abs() > 360.0) {
        let why = format!("{far} is more than one turn");
        s.fault("positions_deg", "angles from -360 to 360", why);
        return None;
    }
    let psi_rad: Vec<f64> = degrees.iter().map(|d| d.to_radians()).collect();
    let Some((z_s, z_r)) = sun_ring else {
        return Some(PlanetPositions { psi_rad, steps: None });
    };
    let mut steps = Vec::new();
    let (mut all_fit, mut is_rounded) = (true, false);
    let per_degree = f64::from(z_s + z_r) / 360.0;
    for ((&degree, &psi), half) in degrees.iter().zip(&psi_rad).zip(s.half_units("positions_deg")) {
        let (nearest, off) = assembly::nearest_steps(psi, z_s, z_r);
        steps.push(nearest);
        // Rounding of degrees written with 8 decimals, or of fewer digits; anything more misplaces teeth.
        is_rounded |= off.abs() > 1e-6;
        if off.abs() > 1e-6 + 1.001 * half * per_degree {
            all_fit = false;
            let exact = nearest as f64 * 360.0 / f64::from(z_s + z_r);
            let allowed = format!("multiples of 360°/{}", z_s + z_r);
            let why = format!(
                "{degree}° cannot be assembled: the nearest position that can is {nearest} steps, {exact:.8}°; write position_steps"
            );
            s.fault("positions_deg", allowed, why);
        }
    }
    if all_fit && is_rounded {
        let note = format!(
            "the positions lie within the rounding of their digits at assembly steps {steps:?}: taken there"
        );
        s.document.remarks.borrow_mut().notes.push(note);
    }
    let step = assembly::assembly_step_rad(z_s, z_r);
    let psi_rad = steps.iter().map(|&k| k as f64 * step).collect();
    all_fit.then_some(PlanetPositions { psi_rad, steps: Some(steps) })
}

/// Equal spacing; with teeth known the assembly positions nearest to it.
fn equal_positions(
    s: &Section<'_, '_>,
    n: usize,
    sun_ring: Option<(u32, u32)>,
) -> Option<PlanetPositions> {
    let positions = PlanetPositions::equally_spaced(n);
    let Some((z_s, z_r)) = sun_ring else {
        return Some(positions);
    };
    let (total, count) = (u64::from(z_s) + u64::from(z_r), n as u64);
    // n·total/N, rounded in whole numbers.
    let nearest = (0..count).map(|i| ((2 * i * total + count) / (2 * count)) as i64);
    let steps: Vec<i64> = nearest.collect();
    if total % count == 0 {
        return Some(PlanetPositions { steps: Some(steps), ..positions });
    }
    let why = format!(
        "(Z_s+Z_r)/N = {total}/{n} is not whole, so that equal spacing cannot be assembled; these are the nearest positions"
    );
    if s.document.is_exact {
        let allowed =
            format!("positions that can be assembled, such as position_steps = {steps:?}");
        s.fault("positions_deg", allowed, why);
        return None;
    }
    s.choose("position_steps", format!("{steps:?}"), &why);
    let step = assembly::assembly_step_rad(z_s, z_r);
    let psi_rad = steps.iter().map(|&k| k as f64 * step).collect();
    Some(PlanetPositions { psi_rad, steps: Some(steps) })
}
