//! The four files of a judgement, and the step summary of a CI.

use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::RecordedOutput;
use super::html::html;
use super::junit::junit;
use super::markdown::markdown;
use crate::error::{Result, unwritten};
use crate::folder::save;
use crate::output;

/// Environment variable in which a CI names the file of its step summary.
const STEP_SUMMARY: &str = "GITHUB_STEP_SUMMARY";

/// Writes `verdict.json`, `verdict.md`, `junit.xml` and `verdict.html` into a folder.
pub(super) fn write(result: &RecordedOutput, folder: &Path) -> Result<()> {
    let suites = result.suites()?;
    let mut json = Vec::new();
    output::json(&mut json, result)?;
    save(&folder.join("verdict.json"), &String::from_utf8_lossy(&json))?;
    save(&folder.join("verdict.md"), &markdown(result, &suites))?;
    save(&folder.join("junit.xml"), &junit(result, &suites))?;
    save(&folder.join("verdict.html"), &html(result, &suites))
}

/// Appends the Markdown to the step summary of a CI, if one is running; the file that it was appended to.
pub(super) fn append_to_step_summary(result: &RecordedOutput) -> Result<Option<PathBuf>> {
    let Some(path) = std::env::var_os(STEP_SUMMARY).filter(|path| !path.is_empty()) else {
        return Ok(None);
    };
    let path = PathBuf::from(path);
    let text = markdown(result, &result.suites()?);
    let file = OpenOptions::new().create(true).append(true).open(&path);
    file.and_then(|mut file| writeln!(file, "{text}")).map_err(unwritten(&path))?;
    Ok(Some(path))
}
