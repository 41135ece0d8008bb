//! The paper's mesh stiffness of 350e6 N/m against that of one mesh and of two meshes in series.

use experiments::MeshStiffnessModel;
use fe_contact::complementarity::ActiveSet;
use fe_contact::contact::{Location, MeshTable};
use fe_contact::statics::press;
use gearset::MeshKind;
use scene::{LoadCase, Scene};

use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::lab::{MESHES, of_model};
use crate::suites::{Checks, Lab};

/// Torque on the sun of three planets, N m, and positions that are asked of any model: a mesh force of 10.7 kN.
pub(crate) const LOAD: (f64, usize) = (1130.0, 28);

/// Positions of the mesh cycle; 50 or more make the mean good to 0.1 %.
const POSITIONS: usize = 56;

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut secants = Vec::new();
    for kind in MESHES {
        secants.push((kind, lab.pair(&lab.bodies, kind, POSITIONS)?.mean_secant_stiffness()));
    }
    let mut checks = judged(lab.reference, &lab.four, &secants)?;
    let mut clipped = secants.clone();
    for (kind, secant) in &mut clipped {
        *secant = clipped_mean_stiffness(lab, *kind)?;
    }
    let spoilt = judged(lab.reference, &lab.four, &clipped)?;
    checks.push(lab.reference.control("fe.stiffness.control.clipped_path", &spoilt)?);
    Ok(checks)
}

/// The same of any model. `set`: one with printed mesh stiffness.
pub(crate) fn asked(model: &dyn MeshStiffnessModel, set: &Scene, reference: &Reference) -> Checks {
    judged(reference, set, &means(model, set)?)
}

/// Mean secant stiffness of both meshes of planet 0 under [`LOAD`], N/m.
pub(super) fn means(
    model: &dyn MeshStiffnessModel,
    set: &Scene,
) -> Result<Vec<(MeshKind, f64)>, ValidationError> {
    let (torque_nm, positions) = LOAD;
    let mean = |kind| -> Result<(MeshKind, f64), ValidationError> {
        let case = LoadCase::standing(torque_nm);
        let found = model.mesh_stiffness(set, &case, kind, positions).map_err(of_model)?;
        Ok((kind, found.mean_n_per_m()))
    };
    MESHES.into_iter().map(mean).collect()
}

/// Mean secant stiffnesses (N/m) against the printed stiffness of "each mesh".
fn judged(reference: &Reference, set: &Scene, secants: &[(MeshKind, f64)]) -> Checks {
    let lumped = set.lumped.as_ref().ok_or(ValidationError::Incomplete("lumped"))?;
    let printed = 1e-6 * lumped.mesh_n_per_m.sun_planet;
    let source = &reference.parker.source;
    let mut checks = Vec::new();
    for (kind, secant) in secants {
        let id = format!("fe.stiffness.{}", kind.name());
        let title = format!(
            "mean secant stiffness of the {} mesh against the printed stiffness of each mesh",
            kind.name()
        );
        checks.push(reference.about(&id, &title)?.source(source).number(printed, 1e-6 * secant));
    }
    let series = 1.0 / secants.iter().map(|(_, k)| 1.0 / k).sum::<f64>();
    let title =
        "our reading: the two meshes of a planet in series against the printed mesh stiffness";
    let about = reference.about("fe.stiffness.series", title)?;
    let source = format!("{source}; that it means both meshes in series is our reading");
    checks.push(about.source(source).number(printed, 1e-6 * series));
    Ok(checks)
}

/// Mean secant stiffness of a mesh with tooth pairs beyond the theoretical path left out, N/m.
fn clipped_mean_stiffness(lab: &Lab<'_>, kind: MeshKind) -> Result<f64, ValidationError> {
    let missing = || ValidationError::Incomplete("mesh");
    let mesh = lab.bodies.geometry.mesh(kind).ok_or_else(missing)?;
    let pair = lab.bodies.pair(kind).ok_or_else(missing)?;
    let mut settings = lab.bodies.cells(lab.force);
    // Without the window, pairs beyond the path are no candidates for contact.
    settings.window = 0.0;
    let mut sum = 0.0;
    for i in 0..POSITIONS {
        let phase = i as f64 / POSITIONS as f64;
        let table = MeshTable::new(mesh, pair, phase, &settings)?;
        debug_assert!(table.pairs.iter().all(|p| p.location == Location::Path));
        let (deflection, _) = press(&table, mesh, lab.force, &ActiveSet)?;
        sum += lab.force / deflection;
    }
    Ok(sum / POSITIONS as f64)
}
