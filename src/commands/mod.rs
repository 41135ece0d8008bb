//! One module per verb.

mod auto_choice;
mod branches;
mod branches_manifest;
mod branches_output;
mod closed_form;
mod compare;
mod files;
mod impulse;
mod impulse_output;
mod impulse_text;
mod kept_files;
mod loads;
mod mesh;
mod modes;
mod needs;
mod report;
mod report_charts;
mod result_folder;
mod rules;
mod scene;
mod scene_summary;
mod scene_text;
mod schema;
mod stability;
mod stability_guards;
mod static_approach;
mod static_auto;
mod static_pair;
mod static_set;
mod statics;
mod study;
mod study_text;
mod suite_progress;
mod sweep;
mod sweep_auto;
mod sweep_claim;
mod sweep_manifest;
mod sweep_output;
#[cfg(feature = "parquet")]
mod sweep_parquet;
mod sweep_store;
mod turning;
mod validate;
mod verdict_table;
mod verdict_text;
mod working;

pub use schema::schemas;

use std::ffi::OsString;
use std::io::Write;
use std::path::Path;

use ::scene::Scene;
use clap::Parser;

use crate::arguments::{Arguments, Verb};
use crate::error::CommandError;

use files::{folder, save, writable};

/// Runs the command: results to `out`, everything else to `err`. Returns the exit code: 0 ran and
/// every check passed, 1 ran and a check failed, 2 bad input.
pub fn run<I, T>(arguments: I, out: &mut dyn Write, err: &mut (dyn Write + Send)) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let parsed = match Arguments::try_parse_from(arguments) {
        Ok(parsed) => parsed,
        Err(refusal) => {
            let asked_for_help = !refusal.use_stderr();
            let styled = refusal.render().ansi().to_string();
            // If this cannot be written either, only the exit code is left.
            let _ = if asked_for_help { write!(out, "{styled}") } else { write!(err, "{styled}") };
            return if asked_for_help { 0 } else { 2 };
        }
    };
    match dispatch(parsed, out, err) {
        Ok(true) => 0,
        Ok(false) => 1,
        Err(error) if error.is_closed_pipe() => 0,
        Err(error) => {
            let _ = write!(err, "{}", error.rendered());
            2
        }
    }
}

/// Runs one verb; whether every check passed.
fn dispatch(
    arguments: Arguments,
    out: &mut dyn Write,
    err: &mut (dyn Write + Send),
) -> Result<bool, CommandError> {
    match arguments.verb {
        Verb::Validate(arguments) => validate::run(&arguments, out, err),
        Verb::Modes(arguments) => modes::run(&arguments, out, err).map(|()| true),
        Verb::Rules(arguments) => rules::run(&arguments, out).map(|()| true),
        Verb::Static(arguments) => statics::run(&arguments, out, err).map(|()| true),
        Verb::Impulse(arguments) => impulse::run(&arguments, out, err).map(|()| true),
        Verb::Sweep(arguments) => sweep::run(&arguments, out, err).map(|()| true),
        Verb::Branches(arguments) => branches::run(&arguments, out, err).map(|()| true),
        Verb::Stability(arguments) => stability::run(&arguments, out, err).map(|()| true),
        Verb::Study(arguments) => study::run(&arguments, out, err).map(|()| true),
        Verb::Mesh(arguments) => mesh::run(&arguments, out, err).map(|()| true),
        Verb::Scene(verb) => scene::run(&verb, out).map(|()| true),
        Verb::Compare(arguments) => compare::run(&arguments, out),
    }
}

/// Reads a scene, or says what is wrong with it.
fn read_scene(path: &Path) -> Result<Scene, CommandError> {
    Scene::from_file(path).map_err(|source| CommandError::Scene { path: path.to_owned(), source })
}

/// The error for a scene that FE/contact cannot use or cannot solve.
fn fe_refused(path: &Path) -> impl Fn(fe_contact::FeError) -> CommandError + '_ {
    |e| unfit(path, e.to_string())
}

/// The error for an argument whose value is not allowed.
fn refused(argument: &'static str, reason: impl Into<String>) -> CommandError {
    CommandError::Argument { argument, reason: reason.into() }
}

/// The error for a valid scene that this verb cannot use.
fn unfit(path: &Path, reason: impl Into<String>) -> CommandError {
    CommandError::Unfit { path: path.to_owned(), reason: reason.into() }
}
