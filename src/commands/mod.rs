//! One module per verb.

mod auto_choice;
mod branches;
mod compare;
mod dataset;
mod impulse;
mod mesh;
mod modes;
mod results;
mod rules;
mod scene;
mod schema;
mod snapshot;
mod stability;
mod statics;
mod study;
mod sweep;
mod turning;
mod validate;

pub use schema::schemas;

use std::ffi::OsString;
use std::io::Write;

use clap::Parser;

use crate::arguments::{Arguments, Verb};
use crate::error::Result;

/// Runs the command: results to `out`, everything else to `err`. Returns the exit code: 0 ran and
/// every check passed, 1 ran and a check failed or a speed of a sweep could not be computed, 2 bad input.
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

/// Runs one verb; whether every check passed and every speed of a sweep was computed.
fn dispatch(
    arguments: Arguments,
    out: &mut dyn Write,
    err: &mut (dyn Write + Send),
) -> Result<bool> {
    match arguments.verb {
        Verb::Validate(arguments) => validate::run(&arguments, out, err),
        Verb::Modes(arguments) => modes::run(&arguments, out, err).map(|()| true),
        Verb::Rules(arguments) => rules::run(&arguments, out, err).map(|()| true),
        Verb::Static(arguments) => statics::run(&arguments, out, err).map(|()| true),
        Verb::Impulse(arguments) => impulse::run(&arguments, out, err).map(|()| true),
        Verb::Sweep(arguments) => sweep::run(&arguments, out, err),
        Verb::Branches(arguments) => branches::run(&arguments, out, err).map(|()| true),
        Verb::Stability(arguments) => stability::run(&arguments, out, err).map(|()| true),
        Verb::Study(arguments) => study::run(&arguments, out, err).map(|()| true),
        Verb::Mesh(arguments) => mesh::run(&arguments, out, err).map(|()| true),
        Verb::Scene(verb) => scene::run(&verb, out).map(|()| true),
        Verb::Results(verb) => results::run(&verb, out).map(|()| true),
        Verb::Dataset(arguments) => dataset::run(&arguments, out),
        Verb::Snapshot(arguments) => snapshot::run(&arguments, out),
        Verb::Compare(arguments) => compare::run(&arguments, out, err),
    }
}
