//! A drawing that leaves as SVG and as PNG.

use std::path::Path;

use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::render::Scene;

use super::{save, save_bytes};
use crate::error::CommandError;

/// Pixels of a PNG for one of the SVG.
const SCALE: f32 = 2.0;

/// A drawing.
pub(super) struct Picture(Scene);

impl Picture {
    pub(super) fn new(scene: Scene) -> Self {
        Self(scene)
    }

    /// As text.
    pub(super) fn svg(&self) -> String {
        SvgBackend::default().render_scene(&self.0)
    }

    /// Writes `NAME.svg` and `NAME.png` into a folder, which is made if need be.
    pub(super) fn save(&self, folder: &Path, name: &str) -> Result<(), CommandError> {
        save(&folder.join(format!("{name}.svg")), &self.svg())?;
        let path = folder.join(format!("{name}.png"));
        let png = PngBackend::new().with_scale(SCALE).render_scene(&self.0);
        let failed = |why: String| CommandError::File {
            what: "cannot draw",
            path: path.clone(),
            source: std::io::Error::other(why),
        };
        save_bytes(&path, &png.map_err(failed)?)
    }
}
