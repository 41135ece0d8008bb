//! The `epicyclic` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    // The streams drop colour by themselves where nobody would see it.
    let (mut out, mut err) = (anstream::stdout(), anstream::stderr());
    ExitCode::from(epicyclic::run(std::env::args_os(), &mut out, &mut err))
}
