//! Matched contact against flanks so finely meshed that elements alone resolve the contact.

use fe_contact::body::GearBody;
use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::hertz::Hertz;
use fe_contact::contact::{Matching, MeshTable, PairFrame};
use fe_contact::mesh::{GearMesh, Outline, Refinement};
use fe_contact::statics::press;
use gearset::{MeshKind, MeshMember};

use super::Lab;
use crate::Profile;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;

/// Elements per Hertz half-width.
const PER_HALF_WIDTH: f64 = 12.0;

/// Load of the one pair, N.
const FORCE: f64 = 5000.0;

/// (mesh, phase, pair, word, whether quick): single pairs, alone in contact.
const CASES: [(MeshKind, f64, i64, &str, bool); 6] = [
    (MeshKind::SunPlanet, 0.7, 0, "interior", true),
    (MeshKind::SunPlanet, 0.5, 1, "driver_tip", true),
    (MeshKind::SunPlanet, 0.92, -1, "driven_tip", false),
    (MeshKind::RingPlanet, 0.3, 0, "interior", false),
    (MeshKind::RingPlanet, 0.8, 1, "driver_tip", false),
    (MeshKind::RingPlanet, 0.9, -1, "driven_tip", false),
];

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    CASES.iter().map(|case| check(lab, case)).collect()
}

fn check(
    lab: &Lab<'_>,
    &(kind, phase, index, word, is_quick): &(MeshKind, f64, i64, &str, bool),
) -> Result<Check, ValidationError> {
    let name = kind.name();
    let id = format!("fe.resolved.{name}.{word}");
    let title = format!(
        "{name} mesh, pair {index} alone at phase {phase} under {FORCE} N: δ with matched contact over δ with resolved flanks"
    );
    let subject = Subject {
        id: &id,
        title: &title,
        kind: ReferenceKind::Analytic,
        source: "the same bodies with 12 elements per Hertz half-width and no half-plane",
        unit: "",
    };
    let tolerance = lab.reference.tolerance(&id, 1.0)?;
    if !is_quick && lab.profile == Profile::Quick {
        return Ok(Check::not_run(subject, 1.0, tolerance));
    }
    let missing = || ValidationError::Incomplete("tooth pair of the resolved check");
    let mesh = lab.bodies.geometry.mesh(kind).ok_or_else(missing)?;
    let frame = PairFrame::new(mesh, phase, index).ok_or_else(missing)?;
    let width = lab.bodies.geometry.face_width;
    let hertz = Hertz::new(FORCE / width, frame.radius(), &lab.bodies.material);
    let fine = |member: MeshMember| -> Result<GearBody, ValidationError> {
        let coarse = lab.bodies.body(kind, member).ok_or_else(missing)?;
        let (_, string) = frame.flank_point(member, 0.0);
        let refine = |outline: &Outline, r: &mut Refinement| {
            let (size, reach) = (hertz.half_width / PER_HALF_WIDTH, 1.6 * hertz.half_width);
            r.resolve(outline, outline.flank_parameter(string), size, reach);
        };
        let flank = lab.bodies.settings.input.flank_elements as usize;
        let (gear, family) = (mesh.gear(member), coarse.mesh.family);
        let mesh = GearMesh::refined(coarse.mesh.name, gear, family, flank, &[(0, &refine)])?;
        Ok(GearBody::new(mesh, lab.bodies.material, width)?)
    };
    let (driver, driven) = (fine(MeshMember::Driver)?, fine(MeshMember::Driven)?);
    let mut settings = lab.bodies.cells(FORCE);
    // Alone, a corner gives way further than beside its neighbours.
    settings.window = 1e-3;
    let bodies = lab.bodies.pair(kind).ok_or_else(missing)?;
    let matched = MeshTable::new(mesh, bodies, phase, &settings)?.only(index);
    let (matched, _) = press(&matched.ok_or_else(missing)?, mesh, FORCE, &ActiveSet)?;
    settings.matching = Matching { depth: 0.0, points: 0 };
    settings.cells = (3.0 * PER_HALF_WIDTH) as usize;
    let resolved = MeshTable::new(mesh, [&driver, &driven], phase, &settings)?.only(index);
    let (resolved, _) = press(&resolved.ok_or_else(missing)?, mesh, FORCE, &ActiveSet)?;
    Ok(Check::number(subject, 1.0, matched / resolved, tolerance))
}
