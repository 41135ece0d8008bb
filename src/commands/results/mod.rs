//! `results new` and `results check`.

mod check;
mod contents;
mod new;
mod text;

pub(crate) use check::ResultsSummary;

use std::io::Write;

use crate::arguments::Results;
use crate::error::CommandError;

pub(crate) fn run(verb: &Results, out: &mut dyn Write) -> Result<(), CommandError> {
    match verb {
        Results::New { scene, folder, kind } => new::run(scene, folder, *kind, out),
        Results::Check { folder, kind, format } => check::run(folder, *kind, *format, out),
    }
}
