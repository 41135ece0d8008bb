//! Prints `docs/assumptions.md` from the ledger and the kept verdict.
//!
//! `cargo run --release -p remake -- assumptions > docs/assumptions.md`

use serde_json::Value;
use validation::{Figure, Ledger};

pub(crate) fn remake() -> crate::Outcome {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../snapshots/verdict.snap");
    let text = std::fs::read_to_string(path)?;
    // The header that insta writes precedes the JSON.
    let start = text.find("\n{").ok_or("no verdict in the snapshot")?;
    let verdict: Value = serde_json::from_str(&text[start..])?;
    let checks = verdict["checks"].as_array().ok_or("no checks in the verdict")?;
    let figure = |id: &str| {
        let check = checks.iter().find(|check| check["id"] == id)?;
        Some(Figure {
            actual: check["actual"].as_f64()?,
            unit: check["unit"].as_str()?.to_owned(),
            tolerance: check["tolerance"]["absolute"].as_f64()?,
        })
    };
    print!("{}", Ledger::load()?.page(&figure));
    Ok(())
}
