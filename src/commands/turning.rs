//! What `sweep` and `branches` share: the model that turns, and columns of their tables.

use experiments::sweep::{
    FeModel, LUMPED, Line, MeshLawModel, Response, SteadyState, SweepModel, fidelity_name,
};
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

/// The fidelity whose keys of the scene the model needs: the lumped one takes its mesh forces from quasi-static bodies.
pub(super) fn fidelity(asked: Model, scene: &Scene) -> Fidelity {
    match asked {
        Model::FeContact => scene.dynamics.fidelity,
        Model::Lumped => Fidelity::QuasiStatic,
    }
}

/// What results call the model.
pub(super) fn name(asked: Model, scene: &Scene) -> String {
    match asked {
        Model::FeContact => fidelity_name(scene.dynamics.fidelity),
        Model::Lumped => LUMPED.into(),
    }
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

/// Adds what files hold of one harmonic of a quantity; a row of text has none.
pub(super) fn with_harmonic<'t, R: 't>(
    table: Table<'t, R>,
    line: impl Fn(&R) -> Option<&Line> + Copy + 't,
) -> Table<'t, R> {
    table
        .column("body", "carrier, ring, sun, planet_n, sun_mesh_n, ring_mesh_n", move |r: &R| {
            line(r).map(|l| l.part.name())
        })
        .column("coordinate", COORDINATE, move |r| line(r).map(|l| l.coordinate.name()))
        .column(
            "harmonic",
            "harmonic of the mesh frequency; 0 is the mean, and stands beside quantities \
             without harmonics",
            move |r| line(r).map(|l| l.harmonic),
        )
        .column("amplitude", "amplitude in the unit of the next column", move |r| {
            line(r).map(|l| l.amplitude)
        })
        .column("unit", "unit", move |r| line(r).map(|l| l.coordinate.unit()))
        .column(
            "phase_rad",
            "phase of A cos(2 pi l f_m t + phase), t from position 0, rad; 0 for \
             quantities without phase",
            move |r| line(r).map(|l| l.phase_rad),
        )
}

/// What the column of coordinates holds.
const COORDINATE: &str = "radial, tangential (m; central bodies: towards planet 0), rotation (rad), \
             translation (m; square root of the sum of the squared amplitudes of radial \
             and tangential), force (N); with harmonic 0 alone: share (largest load share \
             of the mesh), contact_loss (part of the time without force), \
             backside_contact (part of the time in which backside flanks press), \
             lowest_force (N)";
