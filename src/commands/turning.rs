//! What `sweep` and `branches` share: the model that turns, and the strongest motion of the sun in their tables.

use experiments::sweep::{FeModel, MeshLawModel, Response, SteadyState, SweepModel};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};

use crate::arguments::Model;
use crate::error::CommandError;

/// Headings of the cells of [`of_member`].
pub(super) const OF_MEMBER: [&str; 4] = ["rotation µrad", "l", "translation µm", "l"];

/// The model asked for, at the fidelity of the scene.
///
/// # Errors
/// If its mesh forces cannot be tabulated.
pub(super) fn model<'a>(
    asked: Model,
    scene: &'a Scene,
    bodies: &'a Bodies,
    case: LoadCase,
) -> Result<Box<dyn SweepModel + 'a>, CommandError> {
    Ok(match (asked, scene.dynamics.fidelity) {
        (Model::FeContact, Fidelity::MeshLaw) => Box::new(MeshLawModel::new(scene, bodies, case)?),
        (Model::FeContact, _) => {
            Box::new(FeModel::new(scene, bodies, Imperfections::default(), case))
        }
        (Model::Lumped, _) => Box::new(MeshLawModel::new(scene, bodies, case)?.lumped()),
    })
}

/// Strongest harmonics of the sun, or of the member that turns where it is held, of its rotation and of its
/// translation, each with its number.
pub(super) fn of_member(state: &SteadyState, harmonics: usize) -> [String; 4] {
    let member = state.turning_member();
    let rotation = Response::Rotation(member).strongest(state, harmonics);
    let translation = Response::Translation(member).strongest(state, harmonics);
    [
        format!("{:.3}", 1e6 * rotation.0),
        rotation.1.to_string(),
        format!("{:.4}", 1e6 * translation.0),
        if translation.0 > 1e-12 { translation.1.to_string() } else { "–".into() },
    ]
}
