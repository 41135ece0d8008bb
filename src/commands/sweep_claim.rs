//! The folder of a sweep: what is in it, and whether that belongs to a sweep with this refinement.

use std::path::Path;

use experiments::sweep::Plan;
use scene::read_text;

use crate::error::CommandError;

use super::kept_files::MOST_BYTES;
use super::result_folder::{Claim, Layout, other_results};
use super::sweep_manifest::SweepManifest;

/// Manifest of the speeds about peaks.
pub(super) const PEAKS: &str = "plan_peaks.json";

/// Folder of finished points.
pub(super) const POINTS: &str = "points";

/// What a sweep writes.
const LAYOUT: Layout = Layout {
    run: "a sweep",
    results: &["sweep.csv", "sweep.json", "sweep.parquet"],
    others: &[PEAKS, POINTS],
    lock: "sweep.lock",
};

/// Takes a folder for a sweep. `refine`: speeds about each peak, 0 for none.
///
/// # Errors
/// As [`Claim::of`], or if the folder holds speeds about peaks of another refinement.
pub(super) fn claim(
    folder: &Path,
    wanted: &SweepManifest,
    refine: u32,
) -> Result<Claim, CommandError> {
    Claim::of(folder, wanted, &LAYOUT, |folder| match refine {
        0 => Ok(()),
        refine => check_refinement(&folder.join(PEAKS), refine),
    })
}

/// Refuses speeds about peaks that an earlier run laid out for another number of them.
fn check_refinement(path: &Path, refine: u32) -> Result<(), CommandError> {
    let Ok(text) = read_text(path, MOST_BYTES) else { return Ok(()) };
    let plan = serde_json::from_str::<serde_json::Value>(&text).ok();
    let plan =
        plan.and_then(|mut v| serde_json::from_value::<Plan>(v.get_mut("plan")?.take()).ok());
    let Some(plan) = plan else {
        return Err(other_results(path.to_owned(), "it is not the manifest of a sweep"));
    };
    let found = plan.chains.first().map(|chain| chain.speeds_rpm.len());
    match found {
        Some(found) if found != refine as usize => {
            let reason = format!("made with --refine {found}, not --refine {refine}");
            Err(other_results(path.to_owned(), &reason))
        }
        _ => Ok(()),
    }
}
