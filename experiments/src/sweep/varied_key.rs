//! Numbers of the scene that branches go over.

use scene::{KeyKind, SceneKey, scene_keys};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Damping, read in every time step.
const DAMPING: &str = "damping.";

/// Supports: stiffness to ground or to the carrier.
const SUPPORTS: [&str; 4] = ["sun.", "ring.", "carrier.", "planet."];

/// Names of stiffnesses of supports.
const STIFFNESSES: [&str; 3] = ["bearing_n_per_m", "torsional_n_per_m", "torsional_nm_per_rad"];

/// Names of masses and inertias of the gears with what is fixed to them.
const MASSES: [&str; 4] = ["mass_kg", "inertia_kg_m2", "added_mass_kg", "added_inertia_kg_m2"];

/// Tables of masses and inertias of the lumped model.
const LUMPED: [&str; 3] =
    ["lumped.mass_kg.", "lumped.inertia_kg_m2.", "lumped.inertia_over_r2_kg."];

/// Which keys are allowed, as a clause.
const ALLOWED: &str = "allowed are damping.*; bearing_n_per_m, torsional_n_per_m, torsional_nm_per_rad, mass_kg, \
                       inertia_kg_m2, added_mass_kg and added_inertia_kg_m2 of sun, ring, carrier and planet; \
                       lumped.mass_kg.*, lumped.inertia_kg_m2.* and lumped.inertia_over_r2_kg.*";

/// A scene key that no branch can go over.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{key}: {reason}")]
pub struct KeyError {
    /// Its path.
    pub key: String,
    /// Why, and what is allowed.
    pub reason: String,
}

/// A number of the scene that a branch can go over: damping, stiffness of a support, mass or inertia. A motion depends
/// on it smoothly, and the finite-element bodies do not depend on it.
#[derive(Debug, Clone, Copy)]
pub struct VariedKey(&'static SceneKey);

impl VariedKey {
    /// The key with this path, as `docs/scene_keys.md` lists it.
    ///
    /// # Errors
    /// With what is allowed.
    pub fn named(path: &str) -> Result<Self, KeyError> {
        let refuse = |reason: &str| {
            let reason = format!("{reason}; {ALLOWED}");
            Err(KeyError { key: path.to_owned(), reason })
        };
        let Some(key) = scene_keys().iter().find(|key| key.path == path) else {
            return refuse("is no key of a scene");
        };
        let reason = match (key.kind, path) {
            (_, "operation.speed_rpm") => "is varied by --over speed",
            (_, "operation.torque_nm") => "is varied by --over torque",
            (KeyKind::Number(_), _) if is_allowed(path) => return Ok(Self(key)),
            (KeyKind::Number(_), _) if path.starts_with("planet_override") => {
                "is of single planets in a list"
            }
            (KeyKind::Number(_), _) if path.starts_with("lumped.") => {
                "does not enter the motion in time, whose mesh forces are tabulated by FE/contact"
            }
            (KeyKind::Number(_), _) => {
                "changes the finite-element bodies or what is laid out on them, on which the motion depends by \
                 jumps: elements and contact cells are counted anew"
            }
            _ => "is not a number that can take any value in a range",
        };
        refuse(reason)
    }

    /// Its path.
    pub fn path(self) -> &'static str {
        &self.0.path
    }

    /// Its unit; empty for a pure number.
    pub fn unit(self) -> &'static str {
        if self.0.unit == "–" { "" } else { self.0.unit }
    }

    /// Whether the loaded configuration, contact tables and mesh laws depend on it: those of stiffness do.
    pub fn enters_statics(self) -> bool {
        self.path().rsplit('.').next().is_some_and(|name| STIFFNESSES.contains(&name))
    }
}

fn is_allowed(path: &str) -> bool {
    let is_of_body = SUPPORTS.iter().any(|table| {
        let name = path.strip_prefix(table);
        name.is_some_and(|name| STIFFNESSES.contains(&name) || MASSES.contains(&name))
    });
    path.starts_with(DAMPING) || is_of_body || LUMPED.iter().any(|table| path.starts_with(table))
}

impl PartialEq for VariedKey {
    fn eq(&self, other: &Self) -> bool {
        self.path() == other.path()
    }
}

impl Eq for VariedKey {}

impl Serialize for VariedKey {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.path())
    }
}

impl<'de> Deserialize<'de> for VariedKey {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let path = String::deserialize(deserializer)?;
        Self::named(&path).map_err(serde::de::Error::custom)
    }
}

impl JsonSchema for VariedKey {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "VariedKey".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        schemars::json_schema!({
            "type": "string",
            "description": "Path of a number of the scene: damping, stiffness of a support, mass or inertia"
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_of_damping_supports_and_masses_are_taken_and_others_are_refused_with_a_reason() {
        for path in [
            "damping.stiffness_proportional_s",
            "sun.bearing_n_per_m",
            "planet.bearing_n_per_m",
            "carrier.torsional_nm_per_rad",
            "planet.added_mass_kg",
            "sun.inertia_kg_m2",
            "lumped.mass_kg.sun",
        ] {
            let key = VariedKey::named(path).unwrap();
            assert_eq!(key.path(), path);
            assert_eq!(
                key.enters_statics(),
                path.contains("n_per_m") || path.contains("nm_per_rad"),
                "{path}"
            );
        }
        for (path, reason) in [
            ("teeth.sun", "not a number that can take any value"),
            ("geometry.rack.module_mm", "finite-element bodies"),
            ("geometry.thickness.sun_planet_backlash_mm", "finite-element bodies"),
            ("material.young_modulus_pa", "finite-element bodies"),
            ("fe_contact.flexibility_factor.sun_planet", "finite-element bodies"),
            ("operation.speed_rpm", "--over speed"),
            ("operation.torque_nm", "--over torque"),
            ("lumped.mesh_n_per_m.sun_planet", "tabulated by FE/contact"),
            ("planet_override.mass_kg", "single planets"),
            ("sun.motion", "not a number"),
            ("damping.friction", "no key of a scene"),
        ] {
            let error = VariedKey::named(path).unwrap_err().to_string();
            assert!(error.contains(path) && error.contains(reason), "{error}");
            assert!(error.contains("allowed are damping.*"), "{error}");
        }
    }
}
