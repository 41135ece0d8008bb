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
    use crate::keys::KEYS;

    #[test]
    fn templates_are_valid_scenes() {
        for kind in [SceneKind::Planetary, SceneKind::GearPair] {
            let scene = Scene::from_toml(template(kind)).unwrap();
            assert_eq!(scene.kind, kind);
        }
    }

    #[test]
    fn every_key_stands_in_a_template() {
        let both = [SceneKind::Planetary, SceneKind::GearPair].map(template).concat();
        let words: Vec<&str> = both.split(|c: char| !c.is_alphanumeric() && c != '_').collect();
        for key in KEYS.iter() {
            let name = key.table_and_name().1;
            assert!(words.contains(&name), "{}", key.path);
        }
    }

    /// The tables whose comment says that they hold the defaults, and what is commented out with its value there.
    #[test]
    fn defaults_in_templates_are_those_of_the_keys() {
        for kind in [SceneKind::Planetary, SceneKind::GearPair] {
            let document: toml::Table = template(kind).parse().unwrap();
            for table in ["damping", "fe_contact", "dynamics"] {
                let Some(values) = document.get(table).and_then(toml::Value::as_table) else {
                    continue;
                };
                for (name, value) in values {
                    let path = format!("{table}.{name}");
                    let key = KEYS.iter().find(|key| key.path == path).unwrap();
                    let Some(default) = key.default_as_written() else { continue };
                    let default: toml::Value = default.parse().unwrap();
                    let same = match (
                        default.as_float().or(default.as_integer().map(|i| i as f64)),
                        value.as_float(),
                    ) {
                        (Some(a), Some(b)) => a == b,
                        _ => default == *value,
                    };
                    assert!(same, "{path}: {value} in the template, {default} by default");
                }
            }
        }
    }
}
