//! The scenes that results can be about: those that are shipped, and files in the results folder.

use std::sync::{Arc, LazyLock};

use scene::Scene;

use crate::nearest::did_you_mean;
use crate::variants::{mirrored, renumbered};

/// End of the id of a variant, and how it is made.
type Variant = (&'static str, fn(&Scene) -> Scene);

/// The scene of which suites ask variants too, and these.
const VARIED: &str = "oh58_4p";
const VARIANTS: [Variant; 2] = [("mirrored", mirrored), ("renumbered", renumbered)];

/// A scene with the names that tables may call it by.
#[derive(Debug, Clone, PartialEq)]
pub struct KnownScene {
    /// Stem of its file: `oh58_4p`. No two scenes share one.
    pub id: String,
    /// The scene.
    pub scene: Scene,
}

/// All of them.
#[derive(Debug, Clone, Default)]
pub struct KnownScenes(Vec<Arc<KnownScene>>);

/// A name that no scene has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("an id or a title of a shipped scene, or a scene file in the folder{hint}")]
pub struct UnknownScene {
    /// `; did you mean …`, if a name is near.
    pub hint: String,
}

impl KnownScenes {
    /// The scenes that the program holds and the variants of them that suites ask about; one that it cannot read is
    /// left out, which a test excludes.
    pub fn shipped() -> Self {
        static SHIPPED: LazyLock<Vec<Arc<KnownScene>>> = LazyLock::new(|| {
            let one = |(path, text): &(&str, &str)| {
                let id = path.strip_prefix("scenes/")?.strip_suffix(".toml")?.to_owned();
                Some(Arc::new(KnownScene { id, scene: Scene::from_toml(text).ok()? }))
            };
            let mut all: Vec<_> = epicyclic_data::FILES.iter().filter_map(one).collect();
            if let Some(set) = all.iter().find(|known| known.id == VARIED).cloned() {
                all.extend(VARIANTS.map(|(name, variant)| {
                    let (id, scene) = (format!("{VARIED}_{name}"), variant(&set.scene));
                    Arc::new(KnownScene { id, scene })
                }));
            }
            all
        });
        Self(SHIPPED.clone())
    }

    /// Adds a scene, which comes before a shipped one of the same name.
    pub fn add(&mut self, id: String, scene: Scene) {
        self.0.insert(0, Arc::new(KnownScene { id, scene }));
    }

    /// All of them, those added first.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<KnownScene>> {
        self.0.iter()
    }

    /// The scene with that id, file name or title, in any case.
    ///
    /// # Errors
    /// [`UnknownScene`] with the nearest name.
    pub fn find(&self, name: &str) -> Result<Arc<KnownScene>, UnknownScene> {
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let stem = file.strip_suffix(".toml").unwrap_or(file);
        let is_called = |known: &&Arc<KnownScene>| {
            known.id.eq_ignore_ascii_case(stem) || known.scene.title.eq_ignore_ascii_case(name)
        };
        let names = || self.0.iter().flat_map(|known| [known.id.as_str(), &known.scene.title]);
        let found = self.0.iter().find(is_called).cloned();
        found.ok_or_else(|| UnknownScene { hint: did_you_mean(name, names()) })
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn every_shipped_scene_is_read_and_has_an_id_and_a_title_of_its_own() {
        let known = KnownScenes::shipped();
        let files = epicyclic_data::FILES.iter().filter(|(path, _)| path.starts_with("scenes/"));
        assert_eq!(known.0.len(), files.count() + VARIANTS.len());
        let ids: BTreeSet<&str> = known.0.iter().map(|k| k.id.as_str()).collect();
        let titles: BTreeSet<&str> = known.0.iter().map(|k| k.scene.title.as_str()).collect();
        assert_eq!((ids.len(), titles.len()), (known.0.len(), known.0.len()));
    }

    #[test]
    fn a_scene_goes_by_its_id_its_file_or_its_title() {
        let known = KnownScenes::shipped();
        for name in [
            "oh58_4p",
            "OH58_4P.toml",
            "scenes/oh58_4p.toml",
            "Army OH-58 main rotor reduction, four planets",
        ] {
            assert_eq!(known.find(name).unwrap().id, "oh58_4p");
        }
        let refusal = |name: &str| known.find(name).unwrap_err().hint;
        assert_eq!(refusal("oh85_4p"), "; did you mean `oh58_4p`?");
        assert_eq!(
            refusal("Lin and Parker 1999 model set, four planets"),
            "; did you mean `Lin & Parker 1999 model set, four planets`?"
        );
        assert_eq!(refusal("my gearbox"), "");
    }
}
