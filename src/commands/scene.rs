//! `scene new`, `scene check` and `scene schema`.

use std::io::Write;
use std::path::Path;

use gearset::PlanetPositions;
use scene::{SceneKind, template};

use crate::arguments::{Format, SceneVerb};
use crate::error::CommandError;
use crate::output;

use super::read_scene;
use super::scene_summary::SceneSummary;

pub(crate) fn run(verb: &SceneVerb, out: &mut dyn Write) -> Result<(), CommandError> {
    match verb {
        SceneVerb::New { path, kind } => new(path, *kind, out),
        SceneVerb::Check { scene, format } => {
            let summary = SceneSummary::of(&read_scene(scene)?);
            match format {
                Format::Json => output::json(out, &summary),
                Format::Text => Ok(super::scene_text::text(&summary, out)?),
            }
        }
        SceneVerb::Schema => output::json(out, &scene::scene_schema()),
    }
}

fn new(path: &Path, kind: SceneKind, out: &mut dyn Write) -> Result<(), CommandError> {
    let text = template(kind);
    if path == Path::new("-") {
        return Ok(out.write_all(text.as_bytes())?);
    }
    let failed = |source| CommandError::File { what: "cannot write", path: path.into(), source };
    let mut file = std::fs::File::create_new(path).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    writeln!(out, "wrote {}; try: epicyclic scene check {}", path.display(), path.display())?;
    Ok(())
}

/// Positions for people, `0°, -88.57°, …`.
pub(crate) fn degrees(positions: &PlanetPositions) -> String {
    let each: Vec<_> =
        positions.psi_rad.iter().map(|psi| format!("{:.2}°", psi.to_degrees())).collect();
    each.join(", ")
}
