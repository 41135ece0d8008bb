//! What the paper's mesh stiffness of 350e6 N/m can be.

use super::{Lab, MESHES};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;

/// Positions of the mesh cycle; 50 or more make the mean good to 0.1 %.
const POSITIONS: usize = 56;

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let lumped = lab.four.lumped.as_ref().ok_or(ValidationError::Incomplete("lumped"))?;
    let printed = lumped.mesh.sun_planet;
    let mut secants = Vec::new();
    let mut tangents = Vec::new();
    for kind in MESHES {
        let cycle = lab.pair(&lab.bodies, kind, POSITIONS)?;
        secants.push(cycle.mean_secant_stiffness());
        tangents.push(cycle.mean_tangent_stiffness());
    }
    let series = |k: &[f64]| 1.0 / k.iter().map(|k| 1.0 / k).sum::<f64>();
    let source = &lab.reference.parker.source;
    let id = "fe.stiffness.series";
    let title =
        "mean secant stiffnesses of the two meshes in series against the printed mesh stiffness";
    let kind = ReferenceKind::Published;
    let (expected, actual) = (printed * 1e-6, series(&secants) * 1e-6);
    let mut checks = vec![lab.number(id, title, kind, source, "1e6 N/m", expected, actual)?];
    // No candidate for one mesh alone comes near: each is half as stiff again and more.
    let subject = Subject {
        id: "fe.stiffness.each_mesh",
        title: "candidates above 1.5 times the printed mesh stiffness: secant and tangent of the sun mesh, of the ring mesh",
        kind: ReferenceKind::OwnRegression,
        source: "converged FE of one mesh with rigid bores; see docs/fe_contact.md",
        unit: "",
    };
    let candidates = [secants[0], tangents[0], secants[1], tangents[1]];
    let above: Vec<f64> =
        candidates.iter().map(|k| f64::from(u8::from(*k > 1.5 * printed))).collect();
    checks.push(Check::equal(subject, vec![1.0; 4], above));
    Ok(checks)
}
