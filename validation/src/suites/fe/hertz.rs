//! Hertz: two cylinders, and the patches of real teeth.

use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::PairFrame;
use fe_contact::contact::cylinders::Cylinders;
use fe_contact::contact::hertz::{Hertz, fit};
use fe_contact::statics::at_phase;
use gearset::MeshKind;

use super::{Lab, MESHES};
use crate::check::{Check, ReferenceKind};
use crate::error::ValidationError;

const SOURCE: &str = "Johnson, Contact Mechanics (1985), §4.2 and §5.6";

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    let m = &lab.bodies.material;
    let (radius, line_load) = (8.3e-3, lab.force / lab.bodies.geometry.face_width);
    let hertz = Hertz::new(line_load, radius, m);
    // 16 cells across the patch.
    let grid = (1.5 * hertz.half_width, 24);
    let patch = Cylinders::press(m, radius, line_load, grid, &ActiveSet)?;
    let found = fit(&patch.x, &patch.pressures()).ok_or(ValidationError::Incomplete("patch"))?;
    let analytic = ReferenceKind::Analytic;
    let mut number = |id: &str, title: &str, unit: &str, expected: f64, actual: f64| {
        checks.push(lab.number(id, title, analytic, SOURCE, unit, expected, actual)?);
        Ok::<_, ValidationError>(())
    };
    let title =
        "two cylinders, 16 cells across the patch: peak pressure of the ellipse fitted to p²";
    let (expected, actual) = (hertz.peak_pressure * 1e-6, found.peak_pressure * 1e-6);
    number("fe.hertz.cylinders.peak_pressure", title, "MPa", expected, actual)?;
    let title = "two cylinders, 16 cells across the patch: half-width of that ellipse";
    let (expected, actual) = (hertz.half_width * 1e6, found.half_width * 1e6);
    number("fe.hertz.cylinders.half_width", title, "µm", expected, actual)?;
    let depth = 5.0 * hertz.half_width;
    let title = "two cylinders: approach between points five half-widths deep";
    let (expected, actual) = (2.0 * hertz.compression(depth, m), patch.approach(m, depth));
    number("fe.hertz.cylinders.approach", title, "µm", expected * 1e6, actual * 1e6)?;
    for kind in MESHES {
        // Mid-flank of both gears; alone in the sun mesh, beside another pair in the ring mesh.
        let phase = if kind == MeshKind::SunPlanet { 0.7 } else { 0.5 };
        let at = at_phase(&lab.bodies, kind, lab.force, phase, &ActiveSet)?;
        let mesh = lab.bodies.geometry.mesh(kind).ok_or(ValidationError::Incomplete("mesh"))?;
        let k = at.table.pairs.iter().position(|p| p.index == 0);
        let (k, frame) = k
            .zip(PairFrame::new(mesh, phase, 0))
            .ok_or(ValidationError::Incomplete("pair on the path"))?;
        let cells = &at.table.pairs[k];
        let own = &at.answer.cell_forces[cells.first..cells.first + cells.x.len()];
        let area = cells.width * at.table.face_width;
        let pressures: Vec<f64> = own.iter().map(|f| f / area).collect();
        let found = fit(&cells.x, &pressures).ok_or(ValidationError::Incomplete("patch"))?;
        let line_load = at.answer.pair_forces[k] / at.table.face_width;
        let hertz = Hertz::new(line_load, frame.radius(), m);
        let name = kind.name();
        let id = format!("fe.hertz.mid_flank.{name}.peak_pressure");
        let title = format!("{name} teeth at the default setting: peak pressure mid-flank");
        let (expected, actual) = (hertz.peak_pressure * 1e-6, found.peak_pressure * 1e-6);
        number(&id, &title, "MPa", expected, actual)?;
        let id = format!("fe.hertz.mid_flank.{name}.half_width");
        let title = format!("{name} teeth at the default setting: half-width mid-flank");
        let (expected, actual) = (hertz.half_width * 1e6, found.half_width * 1e6);
        number(&id, &title, "µm", expected, actual)?;
    }
    Ok(checks)
}
