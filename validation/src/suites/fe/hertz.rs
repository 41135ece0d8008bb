//! Hertz: two cylinders, and the patches of real teeth.

use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::PairFrame;
use fe_contact::contact::cylinders::Cylinders;
use fe_contact::contact::hertz::{Hertz, fit};
use fe_contact::statics::at_phase;
use gearset::MeshKind;

use crate::error::ValidationError;
use crate::suites::lab::MESHES;
use crate::suites::{Checks, Lab};

/// Relative radius of curvature of the two cylinders, m.
const RADIUS: f64 = 8.3e-3;

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = cylinders(lab, RADIUS)?;
    checks.extend(mid_flank(lab)?);
    let spoilt = cylinders(lab, 1.1 * RADIUS)?;
    checks.push(lab.reference.control("fe.hertz.control.radius", &spoilt)?);
    Ok(checks)
}

/// Two cylinders of relative radius `pressed` (m) pressed together, against Hertz for the radius of the
/// check.
fn cylinders(lab: &Lab<'_>, pressed: f64) -> Checks {
    let mut checks = Vec::new();
    let m = &lab.bodies.material;
    let line_load = lab.force / lab.bodies.geometry.face_width;
    let hertz = Hertz::new(line_load, RADIUS, m);
    // 16 cells across the patch.
    let grid = (1.5 * hertz.half_width, 24);
    let patch = Cylinders::press(m, pressed, line_load, grid, &ActiveSet)?;
    let found = fit(&patch.x, &patch.pressures()).ok_or(ValidationError::Incomplete("patch"))?;
    let mut number = |id: &str, title: &str, expected: f64, actual: f64| {
        checks.push(lab.about(id, title)?.number(expected, actual));
        Ok::<_, ValidationError>(())
    };
    let title =
        "two cylinders, 16 cells across the patch: peak pressure of the ellipse fitted to p²";
    let (expected, actual) = (hertz.peak_pressure * 1e-6, found.peak_pressure * 1e-6);
    number("fe.hertz.cylinders.peak_pressure", title, expected, actual)?;
    let title = "two cylinders, 16 cells across the patch: half-width of that ellipse";
    let (expected, actual) = (hertz.half_width * 1e6, found.half_width * 1e6);
    number("fe.hertz.cylinders.half_width", title, expected, actual)?;
    let depth = 5.0 * hertz.half_width;
    let title = "two cylinders: approach between points five half-widths deep";
    let (expected, actual) = (2.0 * hertz.compression(depth, m), patch.approach(m, depth));
    number("fe.hertz.cylinders.approach", title, expected * 1e6, actual * 1e6)?;
    Ok(checks)
}

/// Patches of real teeth against Hertz for their curvature and load.
fn mid_flank(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    let m = &lab.bodies.material;
    let mut number = |id: &str, title: &str, expected: f64, actual: f64| {
        checks.push(lab.about(id, title)?.number(expected, actual));
        Ok::<_, ValidationError>(())
    };
    for kind in MESHES {
        // Pair 0 is mid-flank on both gears: alone in the sun mesh, beside another pair in the ring mesh.
        let phase = if kind == MeshKind::SunPlanet { 0.7 } else { 0.5 };
        let at = at_phase(&lab.bodies, kind, lab.force, phase, &ActiveSet)?;
        let mesh = lab.bodies.geometry.mesh(kind).ok_or(ValidationError::Incomplete("mesh"))?;
        let k = at.table.pairs.iter().position(|p| p.index == 0);
        let (k, frame) = k
            .zip(PairFrame::new(mesh, phase, 0))
            .ok_or(ValidationError::Incomplete("pair on the path"))?;
        let cells = &at.table.pairs[k];
        let pressures = at.table.pressures(k, &at.answer.cell_forces);
        let found = fit(&cells.x, &pressures).ok_or(ValidationError::Incomplete("patch"))?;
        let line_load = at.answer.pair_forces[k] / at.table.face_width;
        let hertz = Hertz::new(line_load, frame.radius(), m);
        let name = kind.name();
        let id = format!("fe.hertz.mid_flank.{name}.peak_pressure");
        let title = format!("{name} teeth at the default setting: peak pressure mid-flank");
        let (expected, actual) = (hertz.peak_pressure * 1e-6, found.peak_pressure * 1e-6);
        number(&id, &title, expected, actual)?;
        let id = format!("fe.hertz.mid_flank.{name}.half_width");
        let title = format!("{name} teeth at the default setting: half-width mid-flank");
        let (expected, actual) = (hertz.half_width * 1e6, found.half_width * 1e6);
        number(&id, &title, expected, actual)?;
    }
    Ok(checks)
}
