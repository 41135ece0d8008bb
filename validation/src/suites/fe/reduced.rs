//! The reduced models under the same judging as the fidelity they are made from: meshes that follow a law,
//! between FE bodies' races and in the lumped model.

use gearset::excitation_of_scene;

use super::Lab;
use super::sweeps::{PROMINENT, TORQUE, judged, peaks_judged, speeds, swept, under};
use crate::Profile;
use crate::check::Check;
use crate::error::ValidationError;
use experiments::sweep::{LawModel, assigned, naturals};

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let ratio = if lab.profile == Profile::Quick { 0.02 } else { 0.005 };
    let grid = speeds(450.0, 2500.0, ratio);
    let scene = &lab.four;
    let strengths = excitation_of_scene(scene, 5).ok_or(ValidationError::Incomplete("teeth"))?;
    let case = under(scene, TORQUE)?;
    let law = LawModel::new(scene, &lab.bodies, case)?;
    let found = swept(&law, &grid)?;
    let mut checks = judged(lab, "four_mesh_law", &found.points(), &strengths)?;
    let naturals = naturals(scene, &lab.bodies, case)?;
    let list = assigned(&found.states(), &strengths, &naturals, PROMINENT);
    checks.push(peaks_judged(lab, "four_mesh_law", &list)?);
    // Its modes are its own: the printed masses, not those of the meshes.
    let found = swept(&law.lumped(), &grid)?;
    checks.extend(judged(lab, "four_lumped", &found.points(), &strengths)?);
    Ok(checks)
}
