//! Matched contact against flanks so finely meshed that elements alone resolve the contact.

use fe_contact::body::GearBody;
use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::hertz::Hertz;
use fe_contact::contact::{CellSettings, Matching, MeshTable, PairFrame};
use fe_contact::fe_mesh::{FeGearMesh, Outline, Refinement};
use fe_contact::statics::press;
use gearset::{MeshKind, MeshMember};

use crate::error::ValidationError;
use crate::suites::{Checks, Lab};

/// Elements per Hertz half-width.
const PER_HALF_WIDTH: f64 = 12.0;

/// Load of the one pair, N.
const FORCE: f64 = 5000.0;

/// (mesh, phase, pair, word): single pairs, alone in contact.
const CASES: [(MeshKind, f64, i64, &str); 6] = [
    (MeshKind::SunPlanet, 0.7, 0, "interior"),
    (MeshKind::SunPlanet, 0.5, 1, "driver_tip"),
    (MeshKind::SunPlanet, 0.92, -1, "driven_tip"),
    (MeshKind::RingPlanet, 0.3, 0, "interior"),
    (MeshKind::RingPlanet, 0.8, 1, "driver_tip"),
    (MeshKind::RingPlanet, 0.9, -1, "driven_tip"),
];

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let alone = Matching { depth: 0.0, points: 0 };
    let mut checks = Vec::new();
    for (k, case) in CASES.iter().enumerate() {
        let &(kind, phase, index, word) = case;
        let name = kind.name();
        let id = format!("fe.resolved.{name}.{word}");
        let title = format!(
            "{name} mesh, pair {index} alone at phase {phase} under {FORCE} N: δ with matched contact over δ with resolved flanks"
        );
        if !lab.runs(&id)? {
            checks.push(lab.about(&id, &title)?.number_if_run(1.0, None));
            continue;
        }
        let [matched, half_plane_alone] =
            over_resolved(lab, case, [lab.bodies.settings.matching, alone])?;
        checks.push(lab.about(&id, &title)?.number(1.0, matched));
        if k == 0 {
            let spoilt = [lab.about(&id, &title)?.number(1.0, half_plane_alone)];
            let id = "fe.resolved.control.half_plane_alone";
            checks.push(lab.reference.control(id, &spoilt)?);
        }
    }
    Ok(checks)
}

/// Deflection of one pair with contact matched in several ways, over that of resolved flanks.
fn over_resolved(
    lab: &Lab<'_>,
    &(kind, phase, index, _): &(MeshKind, f64, i64, &str),
    matchings: [Matching; 2],
) -> Result<[f64; 2], ValidationError> {
    let missing = || ValidationError::Incomplete("tooth pair of the resolved check");
    let mesh = lab.bodies.geometry.mesh(kind).ok_or_else(missing)?;
    let frame = PairFrame::new(mesh, phase, index).ok_or_else(missing)?;
    let width = lab.bodies.geometry.face_width;
    let hertz = Hertz::new(FORCE / width, frame.radius(), &lab.bodies.material);
    let fine = |member: MeshMember| -> Result<GearBody, ValidationError> {
        let coarse = lab.bodies.body(kind, member).ok_or_else(missing)?;
        let (_, roll_length) = frame.flank_point(member, 0.0);
        let refine = |outline: &Outline, r: &mut Refinement| {
            let (size, reach) = (hertz.half_width / PER_HALF_WIDTH, 1.6 * hertz.half_width);
            r.resolve(outline, outline.flank_parameter(roll_length), size, reach);
        };
        let flank = lab.bodies.settings.input.flank_elements as usize;
        let (gear, family) = (mesh.gear(member), coarse.mesh.family);
        let mesh = FeGearMesh::refined(coarse.mesh.name, gear, family, flank, &[(0, &refine)])?;
        Ok(GearBody::new(mesh, lab.bodies.material, width)?)
    };
    let (driver, driven) = (fine(MeshMember::Driver)?, fine(MeshMember::Driven)?);
    let mut settings = lab.bodies.cells(FORCE);
    // A pair alone in corner contact deflects more than one that shares the load, so the window is wider.
    settings.window = 1e-3;
    let bodies = lab.bodies.pair(kind).ok_or_else(missing)?;
    let deflection = |pair: [&GearBody; 2], settings: &CellSettings| {
        let table = MeshTable::new(mesh, pair, phase, settings)?.only(index);
        Ok::<f64, ValidationError>(press(&table.ok_or_else(missing)?, mesh, FORCE, &ActiveSet)?.0)
    };
    let mut matched = [f64::NAN; 2];
    for (matched, matching) in matched.iter_mut().zip(matchings) {
        settings.matching = matching;
        *matched = deflection(bodies, &settings)?;
    }
    settings.matching = Matching { depth: 0.0, points: 0 };
    settings.cells = (3.0 * PER_HALF_WIDTH) as usize;
    let resolved = deflection([&driver, &driven], &settings)?;
    Ok(matched.map(|one| one / resolved))
}
