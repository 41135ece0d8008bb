//! The report folder: verdict as Markdown and JSON, the steps that explain the printed four-planet
//! frequencies, a Campbell chart of either set, growth with torque and its map, error against cost and, from
//! the full profile, the error of the fidelities. What studies and stability maps show is in `charts`.

use std::fmt::Write as _;
use std::path::Path;

use validation::{Check, Reference, Status, ValidationError, Verdict, steps};

use crate::error::Result;
use crate::folder::save;

use super::check_cells::{cells, status_word};

/// Writes the folder, creating it if need be.
pub(crate) fn write(verdict: &Verdict, folder: &Path) -> Result<()> {
    let json = serde_json::to_string_pretty(verdict)? + "\n";
    save(&folder.join("verdict.json"), &json)?;
    save(&folder.join("verdict.md"), &markdown(verdict)?)?;
    #[cfg(feature = "charts")]
    draw(verdict, folder)?;
    Ok(())
}

#[cfg(feature = "charts")]
fn draw(verdict: &Verdict, folder: &Path) -> Result<()> {
    use crate::commands::modes;
    use crate::figures;
    use validation::{PublishedScene, scene};
    let sets = [
        ("campbell_4p", PublishedScene::Oh58FourPlanets),
        ("campbell_3p", PublishedScene::Oh58ThreePlanets),
    ];
    for (name, which) in sets {
        let scene = scene(which).map_err(ValidationError::from)?;
        let (_, modes) =
            modes::solve(&scene).map_err(|_| ValidationError::Incomplete("lumped model"))?;
        if let Some(picture) = figures::campbell(&scene, &modes) {
            picture.save(folder, name)?;
        }
    }
    let reference = Reference::load().map_err(ValidationError::from)?;
    if let Some(picture) = figures::fidelities(verdict, &reference.ladder) {
        picture.save(folder, "fidelities")?;
    }
    figures::cost(&reference.ladder).save(folder, "cost")?;
    figures::torque_map(&reference.torque_map, paper_gamma()?).save(folder, "torque_map")?;
    let kept = reference.torque_peaks;
    let mut systems: Vec<&str> = kept.peak.iter().map(|p| p.system.as_str()).collect();
    systems.dedup();
    for system in systems {
        let name = format!("torque_{}", system.replace(' ', "_"));
        figures::torque_peaks(&kept, system).save(folder, &name)?;
    }
    Ok(())
}

#[cfg(feature = "charts")]
/// γ of the published four-planet set, cycles.
fn paper_gamma() -> Result<f64, ValidationError> {
    use gearset::Phasing;
    use validation::{PublishedScene, scene};
    let scene = scene(PublishedScene::Oh58FourPlanets)?;
    let incomplete = || ValidationError::Incomplete("geometry");
    let geometry = scene.tooth_geometry().ok().ok_or_else(incomplete)?;
    Ok(Phasing::new(&geometry, &scene.planets).ok_or_else(incomplete)?.gamma())
}

fn markdown(verdict: &Verdict) -> Result<String> {
    let mut text = String::from("# Verdict\n\n");
    let Verdict { passed, missed, failed, .. } = verdict;
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{passed} passed, {missed} missed, {failed} failed.\n");
    text.push_str(
        "| check | title | expected | actual | unit | difference % | tolerance | verdict |\n",
    );
    text.push_str("|---|---|---:|---:|---|---:|---:|---|\n");
    for check in &verdict.checks {
        let [expected, actual, difference, tolerance] = cells(check);
        let (id, title, unit) = (&check.id, &check.title, &check.unit);
        let word = status_word(check.status);
        let _ = writeln!(
            text,
            "| {id} | {title} | {expected} | {actual} | {unit} | {difference} | {tolerance} | {word} |"
        );
    }
    text.push_str("\n## Misses\n\n");
    let reference = Reference::load().map_err(ValidationError::from)?;
    let missed = verdict.checks.iter().filter(|c| c.status == Status::Miss);
    for check in missed {
        let analysis = reference.misses.iter().find(|m| m.id == check.id);
        let analysis = analysis.map_or("", |m| m.analysis.trim());
        let _ = writeln!(text, "**{}** ({}): {analysis}\n", check.id, check.title);
    }
    text.push_str(
        "## From the printed four-planet frequencies to those of the printed geometry\n\n\
         | change | rotational Hz | translational Hz | planet Hz |\n|---|---|---|---|\n",
    );
    for step in steps()? {
        let list = |f: &[f64]| f.iter().map(|x| format!("{x:.1}")).collect::<Vec<_>>().join(", ");
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} |",
            step.change,
            list(&step.rotational_hz),
            list(&step.translational_hz),
            list(&step.planet_hz)
        );
    }
    text.push_str("\n## Tolerances\n\n");
    text.push_str("| checks | tolerance | reason |\n|---|---|---|\n");
    // One row for neighbours in the list that share tolerance and reason.
    let same = |a: &Check, b: &Check| {
        cells(a)[3] == cells(b)[3] && a.tolerance.reason == b.tolerance.reason
    };
    for group in verdict.checks.chunk_by(same) {
        let (first, last) = (&group[0], &group[group.len() - 1]);
        let ids = match group.len() {
            1 => first.id.clone(),
            n => format!("{} to {} ({n})", first.id, last.id),
        };
        let [.., tolerance] = cells(first);
        let _ = writeln!(text, "| {ids} | {tolerance} | {} |", first.tolerance.reason);
    }
    Ok(text)
}
