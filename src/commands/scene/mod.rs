//! `scene new`, `scene check` and `scene schema`.

mod motion;
mod summary;
mod text;

pub(crate) use summary::SceneSummary;

use std::io::Write;
use std::path::Path;

use gearset::PlanetPositions;
use scene::{SceneKind, template};

use crate::arguments::SceneVerb;
use crate::error::{Result, unwritten};
use crate::inputs::scene_with_remarks;
use crate::output;

pub(crate) fn run(verb: &SceneVerb, out: &mut dyn Write) -> Result<()> {
    match verb {
        SceneVerb::New { path, kind } => new(path, *kind, out),
        SceneVerb::Check { scene, format } => {
            let (scene, remarks) = scene_with_remarks(scene)?;
            output::show(*format, &SceneSummary::new(&scene, remarks), out)
        }
        SceneVerb::Schema => output::json(out, &scene::scene_schema()),
    }
}

fn new(path: &Path, kind: SceneKind, out: &mut dyn Write) -> Result<()> {
    let text = template(kind);
    if path == Path::new("-") {
        return Ok(out.write_all(text.as_bytes())?);
    }
    let mut file = std::fs::File::create_new(path).map_err(unwritten(path))?;
    file.write_all(text.as_bytes()).map_err(unwritten(path))?;
    writeln!(out, "wrote {}; try: epicyclic scene check {}", path.display(), path.display())?;
    Ok(())
}

/// Positions for people, `0°, -88.57°, …`.
pub(crate) fn degrees(positions: &PlanetPositions) -> String {
    let each: Vec<_> =
        positions.psi_rad.iter().map(|psi| format!("{:.2}°", psi.to_degrees())).collect();
    each.join(", ")
}
