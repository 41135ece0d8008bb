//! Characters for which the font of PNG files has no glyph. The font is in the program and the same on every machine;
//! SVG files leave the choice of fonts to the viewer.

use kuva::backend::png::PngBackend;
use kuva::render::render::{Primitive, Scene, TextAnchor};

/// Stands in a PNG for a character without a glyph.
const STAND_IN: &str = "?";

/// No character of any script, so that the font draws the box that it has for what is missing.
const NONE: char = '\u{10FFFF}';

/// The characters of a text without a glyph, each once, in the order of the text.
pub(in crate::figures) fn missing(text: &str) -> Vec<char> {
    let mut found = Vec::new();
    // Every font has ASCII.
    for c in text.chars().filter(|c| !c.is_ascii()) {
        if !found.contains(&c) && drawn(c) == drawn(NONE) {
            found.push(c);
        }
    }
    found
}

/// A picture of one character; `None` if it cannot be drawn, which happens to all or to none.
fn drawn(c: char) -> Option<Vec<u8>> {
    let mut scene = Scene::new(24.0, 24.0);
    scene.add(Primitive::Text {
        x: 2.0,
        y: 18.0,
        content: c.to_string(),
        size: 16,
        anchor: TextAnchor::Start,
        rotate: None,
        bold: false,
        color: None,
    });
    PngBackend::new().with_scale(1.0).render_scene(&scene).ok()
}

/// A copy of what is drawn in which `?` stands for every character without a glyph.
pub(super) fn with_stand_ins(scene: &Scene) -> Scene {
    let shown = |text: &mut String| {
        for c in missing(text) {
            *text = text.replace(c, STAND_IN);
        }
    };
    let mut elements = scene.elements.clone();
    for element in &mut elements {
        match element {
            Primitive::Text { content, .. } => shown(content),
            Primitive::RichText { spans, .. } => {
                spans.iter_mut().for_each(|span| shown(&mut span.text));
            }
            _ => {}
        }
    }
    Scene {
        background_color: scene.background_color.clone(),
        text_color: scene.text_color.clone(),
        font_family: scene.font_family.clone(),
        defs: scene.defs.clone(),
        elements,
        ..Scene::new(scene.width, scene.height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figures::drawing::Canvas;

    #[test]
    fn letters_of_units_and_of_europe_have_glyphs_and_those_of_china_have_none() {
        assert!(missing("γ Ω µm · – ² ₁ é ü Ł Ж").is_empty());
        assert_eq!(missing("行星 gears 行"), ['行', '星']);
        assert!(missing("plain").is_empty());
    }

    #[test]
    fn a_png_shows_what_an_svg_says_or_a_question_mark() {
        let picture = |title: &str| {
            let mut canvas = Canvas::new([200.0, 60.0]);
            canvas.head([title, "γ"]);
            canvas.picture()
        };
        let folder = tempfile::tempdir().unwrap();
        let png = |name: &str, title: &str| {
            picture(title).save(folder.path(), name).unwrap();
            std::fs::read(folder.path().join(format!("{name}.png"))).unwrap()
        };
        assert_eq!(png("a", "行星 γ"), png("b", "?? γ"));
        assert_ne!(png("a", "行星 γ"), png("b", "?? é"));
        let svg = std::fs::read_to_string(folder.path().join("a.svg")).unwrap();
        assert!(svg.contains("行星"), "{svg}");
    }
}
