//! `stability --guards`: what the program says on either side of each border.

use std::io::Write;

use experiments::stability::{Guard, guards};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::TableFormat;
use crate::error::CommandError;
use crate::output;

use super::working::Working;

/// `stability --guards --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct GuardList {
    guards: Vec<Guard>,
}

/// Walks across every border; the text is `docs/guards.md`.
pub(super) fn run(format: TableFormat, out: &mut dyn Write) -> Result<(), CommandError> {
    let working = Working::new("walking across every border");
    let guards = guards().map_err(|e| super::refused("--guards", e.to_string()))?;
    drop(working);
    match format {
        TableFormat::Json => output::json(out, &GuardList { guards }),
        TableFormat::Csv => {
            let said = |words: &Option<String>| words.clone().unwrap_or_default();
            let row = |g: &Guard| {
                vec![g.name.clone(), g.border.clone(), said(&g.within), said(&g.beyond)]
            };
            output::csv(out, &["name", "border", "within", "beyond"], guards.iter().map(row))
        }
        TableFormat::Text => text(&guards, out),
    }
}

fn text(guards: &[Guard], out: &mut dyn Write) -> Result<(), CommandError> {
    writeln!(
        out,
        "# Guards\n\n\
         Where a method or a model fails, the program says so. Each line below is what it said when this page was written by\n\
         `epicyclic stability --guards > docs/guards.md`: just within the border nothing, just beyond it this. The borders\n\
         themselves are drawn in [stability.md](stability.md).\n\n\
         | what is guarded | tried | said beyond the border |\n|---|---|---|"
    )?;
    for g in guards {
        let words = |said: &Option<String>| match said {
            Some(said) => said.replace('|', "\\|").split_whitespace().collect::<Vec<_>>().join(" "),
            None => "–".to_owned(),
        };
        let within = match &g.within {
            Some(_) => format!(" (within it: {})", words(&g.within)),
            None => String::new(),
        };
        writeln!(out, "| {} | {} | {}{within} |", g.name, g.border, words(&g.beyond))?;
    }
    Ok(())
}
