//! One module a verb.

mod chart;
mod compare;
mod fidelity_chart;
mod figure;
mod impulse;
mod impulse_figures;
mod impulse_output;
mod impulse_text;
mod mesh;
mod mesh_picture;
mod mode_shapes;
mod modes;
mod picture;
mod report;
mod rules;
mod scene;
mod schema;
mod static_approach;
mod static_pair;
mod static_set;
mod statics;
mod sweep;
mod sweep_output;
#[cfg(feature = "parquet")]
mod sweep_parquet;
mod sweep_store;
mod validate;

// Pictures of sweeps and of what is kept, and what they are drawn with.
mod axes;
mod canvas;
mod cost_chart;
mod harmonic_column;
mod sweep_figures;
mod torque_figures;
mod torque_map;
mod waterfall;

pub use schema::schemas;

use std::io::Write;
use std::path::Path;

use gearset::Scene;

use crate::arguments::{Arguments, Verb};
use crate::error::CommandError;

/// Runs one verb; whether every check passed.
pub(crate) fn dispatch(arguments: Arguments, out: &mut dyn Write) -> Result<bool, CommandError> {
    match arguments.verb {
        Verb::Validate(arguments) => validate::run(&arguments, out),
        Verb::Modes(arguments) => modes::run(&arguments, out).map(|()| true),
        Verb::Rules(arguments) => rules::run(&arguments, out).map(|()| true),
        Verb::Static(arguments) => statics::run(&arguments, out).map(|()| true),
        Verb::Impulse(arguments) => impulse::run(&arguments, out).map(|()| true),
        Verb::Sweep(arguments) => sweep::run(&arguments, out).map(|()| true),
        Verb::Mesh(arguments) => mesh::run(&arguments, out).map(|()| true),
        Verb::Scene(verb) => scene::run(&verb, out).map(|()| true),
        Verb::Compare(arguments) => compare::run(&arguments, out),
    }
}

/// Reads a scene, or says what is wrong with it.
fn read_scene(path: &Path) -> Result<Scene, CommandError> {
    Scene::from_file(path).map_err(|source| CommandError::Scene { path: path.to_owned(), source })
}

/// Writes a file, creating its folder if need be.
fn save(path: &Path, text: &str) -> Result<(), CommandError> {
    save_bytes(path, text.as_bytes())
}

fn save_bytes(path: &Path, bytes: &[u8]) -> Result<(), CommandError> {
    let failed = |source| CommandError::File { what: "cannot write", path: path.into(), source };
    if let Some(folder) = path.parent().filter(|p| !p.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(failed)?;
    }
    std::fs::write(path, bytes).map_err(failed)
}

/// A scene that FE/contact cannot work with, or cannot be solved.
fn fe_refused(path: &Path) -> impl Fn(fe_contact::FeError) -> CommandError + '_ {
    |e| unfit(path, e.to_string())
}

/// A valid scene that this verb cannot use.
fn unfit(path: &Path, reason: impl Into<String>) -> CommandError {
    CommandError::Unfit { path: path.to_owned(), reason: reason.into() }
}
