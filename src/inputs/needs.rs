//! What a verb asks of a scene before it starts any work.

use std::io::Write;
use std::path::Path;

use experiments::sweep::SteadySettings;
use scene::{Scene, Verb};

use crate::error::{Result, unfit};

/// Refuses a scene that lacks what the verb needs; `is_given` says whether an argument stands in for a key.
pub(crate) fn require(
    path: &Path,
    scene: &Scene,
    verb: Verb,
    is_given: impl Fn(&str) -> bool,
) -> Result<()> {
    let lacks = scene.lacks(verb);
    let mut open = lacks.iter().filter(|lack| !lack.argument.is_some_and(&is_given)).peekable();
    if open.peek().is_none() {
        return Ok(());
    }
    let each: Vec<_> = open.map(|lack| format!("`{}`: {}", lack.key, lack.why)).collect();
    Err(unfit(path, format!("{} cannot run: {}", verb.name(), each.join("; "))))
}

/// Refuses a ring–planet pair, of which only statics are computed.
pub(crate) fn not_ring_pair(path: &Path, scene: &Scene) -> Result<()> {
    let lacks = scene.lacks(Verb::Modes);
    match lacks.iter().find(|lack| lack.key == "mesh") {
        Some(lack) => Err(unfit(path, format!("`{}`: {}", lack.key, lack.why))),
        None => Ok(()),
    }
}

/// Writes what to know of harmonics that few steps resolve.
pub(crate) fn caution(
    settings: &SteadySettings,
    steps: usize,
    err: &mut dyn Write,
) -> std::io::Result<()> {
    settings.caution(steps).map_or(Ok(()), |words| writeln!(err, "warning: {words}"))
}

/// Writes a scene's warnings, one a line, of keys that the verb reads if one is named. Refuses a folder of figures
/// that cannot be made, and warns of characters in the title that figures cannot show.
pub(crate) fn warn(
    scene: &Scene,
    verb: Option<Verb>,
    figures: Option<&Path>,
    err: &mut dyn Write,
) -> Result<()> {
    let mut warnings =
        scene::warnings(scene).into_iter().filter(|w| verb.is_none_or(|verb| verb.reads(&w.key)));
    warnings.try_for_each(|warning| writeln!(err, "warning: {warning}"))?;
    crate::folder::folder("--figures", figures)?;
    #[cfg(feature = "charts")]
    let lacking = crate::figures::lacking(&scene.title);
    #[cfg(not(feature = "charts"))]
    let lacking: Vec<char> = Vec::new();
    if figures.is_none() || lacking.is_empty() {
        return Ok(());
    }
    let lacking: Vec<String> = lacking.into_iter().map(String::from).collect();
    Ok(writeln!(
        err,
        "warning: `title` has characters that the font of PNG figures lacks ({}): `?` stands for them there, and the SVG \
         figures keep them",
        lacking.join(" ")
    )?)
}
