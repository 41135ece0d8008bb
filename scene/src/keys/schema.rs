//! The JSON schema of scene files.

use serde_json::{Map, Value, json};

use crate::keys::bound::Bound;
use crate::keys::{KEYS, KeyKind, Presence, SceneKey};

/// JSON schema of a scene file, by which editors complete and check it while it is written. Faults that depend on
/// several keys are found only by [`Scene::from_toml`](crate::Scene::from_toml).
pub fn scene_schema() -> Value {
    let mut root = table_schema("");
    root.insert("$schema".into(), "https://json-schema.org/draft/2020-12/schema".into());
    root.insert("title".into(), "A scene of epicyclic".into());
    Value::Object(root)
}

/// Schema of the table at a path, the empty one for the whole file, with all its keys.
fn table_schema(table: &str) -> Map<String, Value> {
    let mut schema = KeyKind::Table.schema();
    let (mut properties, mut required) = (Map::new(), Vec::new());
    for key in KEYS.iter() {
        let (parent, name) = key.table_and_name();
        if parent != table {
            continue;
        }
        let mut own = match key.kind {
            KeyKind::Table => table_schema(&key.path),
            kind => kind.schema(),
        };
        if key.kind == KeyKind::Tables {
            own.insert("items".into(), Value::Object(table_schema(&key.path)));
        }
        own.insert("description".into(), description(key).into());
        if !key.is_table() {
            let verbs = key.changes.split(", ").filter(|verb| *verb != "–");
            own.insert("x-changes".into(), verbs.collect::<Vec<_>>().into());
        }
        match key.presence {
            Presence::Required => required.push(Value::from(name)),
            Presence::Default(text) => {
                // Words are no JSON by themselves.
                let value = serde_json::from_str(text).unwrap_or_else(|_| Value::from(text));
                own.insert("default".into(), value);
            }
            Presence::Optional(_) => {}
        }
        properties.insert(name.into(), Value::Object(own));
    }
    schema.insert("properties".into(), Value::Object(properties));
    if !required.is_empty() {
        schema.insert("required".into(), Value::Array(required));
    }
    schema
}

fn description(key: &SceneKey) -> String {
    let mut text = key.meaning.clone();
    if key.unit != "–" {
        text += &format!(" [{}]", key.unit);
    }
    if let Presence::Optional(otherwise) = key.presence {
        text += &format!("; left out: {otherwise}");
    }
    text
}

impl KeyKind {
    /// The JSON schema of a value without keys of its own.
    fn schema(self) -> Map<String, Value> {
        let value = match self {
            Self::Table => json!({"type": "object", "additionalProperties": false}),
            Self::Tables => json!({"type": "array"}),
            Self::Number(Bound::Positive) => json!({"type": "number", "exclusiveMinimum": 0}),
            Self::Number(Bound::NonNegative) => json!({"type": "number", "minimum": 0}),
            Self::Number(Bound::Finite) => json!({"type": "number"}),
            Self::Number(Bound::Between(low, high)) => {
                json!({"type": "number", "exclusiveMinimum": low, "exclusiveMaximum": high})
            }
            Self::Integer(low, high) => {
                json!({"type": "integer", "minimum": low, "maximum": high})
            }
            Self::Text => {
                json!({"type": "string", "pattern": "^[^\\u0000-\\u001f\\u007f-\\u009f]*$"})
            }
            Self::Choice(words) => json!({"enum": words}),
            Self::Numbers => json!({"type": "array", "items": {"type": "number"}}),
            Self::Integers => json!({"type": "array", "items": {"type": "integer"}}),
        };
        match value {
            Value::Object(map) => map,
            _ => Map::new(),
        }
    }
}
