//! Mesh stiffness against the standard's formula for c_γ.

use experiments::MeshStiffnessModel;
use fe_contact::statics::Bodies;
use gearset::MeshKind;
use gearset::iso6336::{BasicRack, mean_mesh_stiffness};
use scene::Scene;

use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::lab::MESHES;
use crate::suites::{Checks, Lab};

use super::stiffness::means;

const SOURCE: &str = "ISO 6336-1:2006, clause 9, method B: c'_th, C_B, c_γ; without C_M = 0.8, which turns theory into measurement";

/// Basic rack of OH-58: 9 DP, 22.5° reproduces every diameter and both operating angles of Table 1
/// (`reference/parker_2000.toml`).
const OH58: BasicRack = BasicRack { module: 25.4e-3 / 9.0, pressure_angle_deg: 22.5 };

/// Stiffness c_γ of a mesh of OH-58 gears per face width by ISO 6336-1, N/(mm µm); `None` without geometry or mesh.
pub fn iso6336_mean_stiffness(scene: &Scene, kind: MeshKind) -> Option<f64> {
    Some(mean_mesh_stiffness(scene.tooth_geometry().ok()?.mesh(kind)?, &OH58))
}

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = judged(lab.reference, &lab.four, &secants(lab, &lab.bodies)?)?;
    let mut soft = Bodies::clone(&lab.bodies);
    let factor = &mut soft.settings.input.flexibility_factor;
    (factor.sun_planet, factor.ring_planet) = (2.0, 2.0);
    let spoilt = judged(lab.reference, &lab.four, &secants(lab, &soft)?)?;
    checks.push(lab.reference.control("fe.iso_6336.control.flexibility", &spoilt)?);
    Ok(checks)
}

/// The same of any model. `set`: one of OH-58 gears.
pub(crate) fn asked(model: &dyn MeshStiffnessModel, set: &Scene, reference: &Reference) -> Checks {
    judged(reference, set, &means(model, set)?)
}

/// Mean secant stiffness of both meshes, N/m.
fn secants(lab: &Lab<'_>, bodies: &Bodies) -> Result<Vec<(MeshKind, f64)>, ValidationError> {
    let mean = |kind| Ok((kind, lab.pair(bodies, kind, 28)?.mean_secant_stiffness()));
    MESHES.into_iter().map(mean).collect()
}

fn judged(reference: &Reference, set: &Scene, secants: &[(MeshKind, f64)]) -> Checks {
    let mut checks = Vec::new();
    let incomplete = || ValidationError::Incomplete("geometry");
    let face_width = set.tooth_geometry().map_err(|_| incomplete())?.face_width;
    for (kind, secant) in secants {
        let expected = iso6336_mean_stiffness(set, *kind).ok_or_else(incomplete)?;
        let per_width = secant / face_width * 1e-9;
        let name = kind.name();
        let id = format!("fe.iso_6336.{name}");
        let title = format!("{name} mesh: mean secant stiffness per face width against c_γ");
        checks.push(reference.about(&id, &title)?.source(SOURCE).number(expected, per_width));
    }
    Ok(checks)
}
