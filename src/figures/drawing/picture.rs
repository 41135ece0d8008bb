//! A finished drawing, written as SVG and as PNG.

use std::path::{Path, PathBuf};

use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;

use super::glyphs::with_stand_ins;

/// Pixels of the PNG per pixel of the SVG.
const SCALE: f32 = 2.0;

/// A finished drawing.
pub struct Picture(Scene);

/// Why a figure could not be saved.
#[derive(Debug, thiserror::Error)]
#[error("{what} `{}`: {source}", path.display())]
pub struct FigureError {
    what: &'static str,
    path: PathBuf,
    source: std::io::Error,
}

impl Picture {
    pub(crate) fn new(scene: Scene) -> Self {
        Self(scene)
    }

    /// The text of an SVG file.
    pub fn svg(&self) -> String {
        SvgBackend::default().render_scene(&self.0)
    }

    /// Writes `NAME.svg` and `NAME.png`, the latter with twice the resolution, into a folder, which is
    /// created if necessary. In the PNG `?` stands for characters that its font lacks.
    ///
    /// # Errors
    /// If a file cannot be written, or the PNG cannot be drawn.
    pub fn save(&self, folder: &Path, name: &str) -> Result<(), FigureError> {
        write(&folder.join(format!("{name}.svg")), self.svg().as_bytes())?;
        let path = folder.join(format!("{name}.png"));
        let png = PngBackend::new().with_scale(SCALE).render_scene(&with_stand_ins(&self.0));
        let failed = |why: String| FigureError {
            what: "cannot draw",
            path: path.clone(),
            source: std::io::Error::other(why),
        };
        write(&path, &png.map_err(failed)?)
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), FigureError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let written = std::fs::create_dir_all(folder).and_then(|()| std::fs::write(path, bytes));
    written.map_err(|source| FigureError { what: "cannot write", path: path.into(), source })
}
