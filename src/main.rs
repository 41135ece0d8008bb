//! The `epicyclic` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    // anstream removes colour codes where a stream is not a terminal.
    let (mut out, mut err) = (anstream::stdout(), anstream::stderr());
    ExitCode::from(epicyclic::run(std::env::args_os(), &mut out, &mut err))
}
