//! The `epicyclic` command, and the facade over the crates that do the work:
//! [`gearset`], [`dynamics`], [`lumped`], [`fe_contact`] and [`validation`].

mod arguments;
mod commands;
mod error;
mod output;

pub use dynamics;
pub use experiments;
pub use fe_contact;
pub use gearset;
pub use lumped;
pub use validation;

use std::ffi::OsString;
use std::io::Write;

use clap::Parser;

pub use commands::schemas;
pub use error::CommandError;

/// Runs the command: results to `out`, everything else to `err`. Returns the exit code: 0 ran and
/// every check passed, 1 ran and a check failed, 2 bad input.
pub fn run<I, T>(arguments: I, out: &mut dyn Write, err: &mut dyn Write) -> u8
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let parsed = match arguments::Arguments::try_parse_from(arguments) {
        Ok(parsed) => parsed,
        Err(refusal) => {
            let asked_for_help = !refusal.use_stderr();
            let styled = refusal.render().ansi().to_string();
            // Nothing sensible is left to do if even this cannot be written.
            let _ = if asked_for_help { write!(out, "{styled}") } else { write!(err, "{styled}") };
            return if asked_for_help { 0 } else { 2 };
        }
    };
    match commands::dispatch(parsed, out) {
        Ok(true) => 0,
        Ok(false) => 1,
        Err(error) if error.is_closed_pipe() => 0,
        Err(error) => {
            let _ = write!(err, "{}", error.rendered());
            2
        }
    }
}
