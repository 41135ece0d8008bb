//! The commented scene that `scene new` writes.

use crate::scene::SceneKind;

/// A valid, commented scene to start from.
pub fn template(kind: SceneKind) -> &'static str {
    match kind {
        SceneKind::Planetary => include_str!("planetary.toml"),
        SceneKind::GearPair => include_str!("gear_pair.toml"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Scene;

    #[test]
    fn templates_are_valid_scenes() {
        for kind in [SceneKind::Planetary, SceneKind::GearPair] {
            let scene = Scene::from_toml(template(kind)).unwrap();
            assert_eq!(scene.kind, kind);
        }
    }
}
