//! `stability --guards`: what the program says on either side of each border.

use std::io::Write;

use experiments::stability::{Guard, guards};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::Format;
use crate::error::{Result, refused};
use crate::inputs::Working;
use crate::output::{self, Report, Table};

/// `stability --guards --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct GuardList {
    guards: Vec<Guard>,
}

/// Walks across every border; the text is `docs/guards.md`.
pub(super) fn run(format: Format, out: &mut dyn Write) -> Result<()> {
    let working = Working::new("walking across every border");
    let guards = guards().map_err(|e| refused("--guards", e))?;
    drop(working);
    let list = GuardList { guards };
    match format {
        // Lines of a page are not broken.
        Format::Text => list.text(out),
        _ => output::show(format, &list, out),
    }
}

impl Report for GuardList {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let table = Table::<&Guard>::new()
            .column("name", "", |g| &g.name)
            .column("border", "", |g| &g.border)
            .column("within", "", |g| g.within.clone())
            .column("beyond", "", |g| g.beyond.clone());
        table.csv(&self.guards, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        page(&self.guards, out)
    }
}

fn page(guards: &[Guard], out: &mut dyn Write) -> Result<()> {
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
