//! What `sweep` and `branches` share: the model that turns, and the strongest motion of the sun in their tables.

use experiments::sweep::{FeModel, MeshLawModel, Response, SteadyState, SweepModel};
use fe_contact::statics::{Bodies, Imperfections};
use scene::{Fidelity, LoadCase, Scene};

use crate::arguments::Model;
use crate::error::Result;
use crate::output::{Notation, Table};

/// The model asked for, at the fidelity of the scene.
///
/// # Errors
/// If its mesh forces cannot be tabulated.
pub(super) fn model<'a>(
    asked: Model,
    scene: &'a Scene,
    bodies: &'a Bodies,
    case: LoadCase,
) -> Result<Box<dyn SweepModel + 'a>> {
    Ok(match (asked, scene.dynamics.fidelity) {
        (Model::FeContact, Fidelity::MeshLaw) => Box::new(MeshLawModel::new(scene, bodies, case)?),
        (Model::FeContact, _) => {
            Box::new(FeModel::new(scene, bodies, Imperfections::default(), case))
        }
        (Model::Lumped, _) => Box::new(MeshLawModel::new(scene, bodies, case)?.lumped()),
    })
}

/// Adds the strongest harmonics of the rotation and of the translation of the sun, or of the member that turns where it
/// is held, each with its number; `state`: the steady state of a row and its highest harmonic.
pub(super) fn with_strongest<'t, R: 't>(
    table: Table<'t, R>,
    state: impl for<'r> Fn(&'r R) -> (&'r SteadyState, usize) + Copy + 't,
) -> Table<'t, R> {
    let strongest = move |row: &R, response: fn(_) -> Response| {
        let (state, harmonics) = state(row);
        response(state.turning_member()).strongest(state, harmonics)
    };
    let rotation = move |row: &R| strongest(row, Response::Rotation);
    let translation = move |row: &R| strongest(row, Response::Translation);
    table
        .words("rotation µrad", Notation::Fixed(3), move |row| 1e6 * rotation(row).0)
        .meaning(
            "strongest harmonic of the sun, of a held sun that of the ring or carrier that turns, and its number l as a \
             multiple of the mesh frequency",
        )
        .words("l", Notation::Plain, move |row| rotation(row).1)
        .words("translation µm", Notation::Fixed(4), move |row| 1e6 * translation(row).0)
        .meaning(
            "the same of √(R² + T²) of the amplitudes R and T of the radial and the tangential displacement",
        )
        .words("l", Notation::Plain, move |row| {
            let (amplitude, harmonic) = translation(row);
            (amplitude > 1e-12).then_some(harmonic)
        })
}
