//! `validate --controls`: the suites with their negative controls.

use std::io::Write;

use schemars::JsonSchema;
use serde::Serialize;
use validation::{Asks, Registry, ValidationError};

use crate::arguments::Validate;
use crate::error::Result;
use crate::output::{self, Report, Table};

/// `validate --controls --format json`.
#[derive(Serialize, JsonSchema)]
pub(crate) struct ControlsOutput {
    suites: Vec<SuiteControls>,
}

/// One suite with its negative controls.
#[derive(Serialize, JsonSchema)]
struct SuiteControls {
    suite: String,
    asks: Asks,
    about: String,
    controls: Vec<ControlOutput>,
}

/// A negative control: what is spoilt, and the check that must fail.
#[derive(Serialize, JsonSchema)]
struct ControlOutput {
    id: String,
    spoils: String,
    breaks: String,
}

/// Lists the suites whose names begin with `--only`, with their negative controls.
pub(super) fn run(arguments: &Validate, out: &mut dyn Write) -> Result<()> {
    let registry = Registry::load().map_err(ValidationError::from)?;
    let listed = registry.suite.into_iter().filter(|s| {
        arguments.only.is_empty() || arguments.only.iter().any(|o| s.name.starts_with(o))
    });
    let suites: Vec<SuiteControls> = listed
        .map(|suite| SuiteControls {
            suite: suite.name,
            asks: suite.asks,
            about: suite.about,
            controls: suite
                .control
                .into_iter()
                .map(|c| ControlOutput { id: c.id, spoils: c.spoils, breaks: c.breaks })
                .collect(),
        })
        .collect();
    output::show(arguments.format, &ControlsOutput { suites }, out)
}

impl Report for ControlsOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        type Row<'r> = (&'r SuiteControls, &'r ControlOutput);
        let table = Table::<Row<'_>>::new()
            .column("suite", "", |(suite, _)| &suite.suite)
            .column("control", "", |(_, control)| &control.id)
            .column("spoils", "", |(_, control)| &control.spoils)
            .column("breaks", "", |(_, control)| &control.breaks);
        table.csv(self.suites.iter().flat_map(|s| s.controls.iter().map(move |c| (s, c))), out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        for suite in &self.suites {
            let asks = match suite.asks {
                Asks::NaturalModes => "natural modes of any model",
                Asks::MeshCycle => "mesh cycles at rest of any model",
                Asks::MeshStiffness => "mesh stiffness of any model",
                Asks::SteadyStates => "steady states of any model",
                Asks::ExcitationRules => "excitation rules of any model",
                Asks::OwnNumerics => "our own models",
            };
            writeln!(out, "{} ({asks}): {}", suite.suite, suite.about)?;
            for control in &suite.controls {
                writeln!(out, "  {}", control.id)?;
                writeln!(out, "    {}: {} must fail", control.spoils, control.breaks)?;
            }
        }
        Ok(())
    }
}
