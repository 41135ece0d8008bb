//! What `fidelity = "auto"` chose, as every verb that chooses prints it.

use std::io::Write;

use experiments::auto::{AutoModel, Choice, SHARED_KEYS};

use crate::error::{Result, refused};

/// The quantity with its estimated error, the settings chosen and why, and what was passed over.
pub(super) fn write(choice: &Choice, out: &mut dyn Write) -> std::io::Result<()> {
    let Choice { quantity, value, unit, tolerance_percent, estimated_error_percent, .. } = choice;
    // Hundredths of a hertz; parts of a micrometre as far as they may differ.
    let digits = if unit == "Hz" { 2 } else { 4 };
    writeln!(
        out,
        "{quantity}: {value:.digits$} {unit}, estimated error {estimated_error_percent:.2} % (allowed: {tolerance_percent} %)"
    )?;
    writeln!(out, "chosen: {}", choice.settings)?;
    if choice.settings.model != AutoModel::Lumped {
        writeln!(out, "  with {SHARED_KEYS}")?;
    }
    for part in &choice.error_parts {
        writeln!(out, "  {:.3} % from {}", part.percent, part.source)?;
    }
    for other in &choice.passed_over {
        writeln!(out, "passed over: {}: {}", other.settings, other.why)?;
    }
    Ok(())
}

/// Refuses the first of some arguments that is given although `auto` chooses what it says, or does without it; each
/// has its name, whether it is given, and why it has no place.
pub(super) fn refuse_given(arguments: &[(&'static str, bool, &str)]) -> Result<()> {
    match arguments.iter().find(|(_, is_given, _)| *is_given) {
        Some((argument, _, why)) => {
            let reason = format!("`dynamics.fidelity` = \"auto\" {why}: leave it out");
            Err(refused(argument, reason))
        }
        None => Ok(()),
    }
}
