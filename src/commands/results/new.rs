//! `results new`: a results folder ready to be filled.

use std::io::Write;
use std::path::Path;

use validation::ModelKind;
use validation::results::{SceneFile, Template};

use crate::error::{CommandError, refused, unwritten};
use crate::folder::must_be_empty;

pub(super) fn run(
    name: &str,
    folder: &Path,
    kind: ModelKind,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let scenes = scenes(name, kind)?;
    let template = Template::new(&scenes, kind)?;
    if template.suites.is_empty() {
        let reason = format!(
            "no suite judges results of kind {} on `{name}`: allowed is a scene with numbers in [lumped], numbers of \
             teeth or tooth geometry, as the kind needs (docs/results.md)",
            kind.name()
        );
        return Err(refused("SCENE", reason));
    }
    must_be_empty(folder)?;
    std::fs::create_dir_all(folder).map_err(unwritten(folder))?;
    for (name, text) in &template.files {
        let path = folder.join(name);
        let mut file = std::fs::File::create_new(&path).map_err(unwritten(&path))?;
        file.write_all(text.as_bytes()).map_err(unwritten(&path))?;
    }
    let names: Vec<&str> = template.files.iter().map(|(name, _)| name.as_str()).collect();
    writeln!(out, "wrote into {}: {}", folder.display(), names.join(", "))?;
    writeln!(out, "suites that ask: {}", template.suites.join(", "))?;
    writeln!(out, "fill in the tables; then: epicyclic results check {}", folder.display())?;
    Ok(())
}

fn scenes(name: &str, kind: ModelKind) -> Result<Vec<SceneFile>, CommandError> {
    let path = Path::new(name);
    if name == "all" {
        return Ok(SceneFile::asked_about(kind)?);
    }
    if !path.is_file() {
        let shipped = SceneFile::shipped(name);
        let refuse = |hint| {
            refused(
                "SCENE",
                format!(
                    "`{name}`: allowed is `all`, a scene file, or the id of a shipped scene{hint}"
                ),
            )
        };
        return Ok(vec![shipped.map_err(|unknown| refuse(unknown.hint))?]);
    }
    let file = SceneFile::read(path)?;
    if file.id == "results" {
        let reason =
            "results.toml is what the folder keeps beside the tables: rename the scene file";
        return Err(refused("SCENE", reason));
    }
    Ok(vec![file])
}
