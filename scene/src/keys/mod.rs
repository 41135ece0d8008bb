//! What the keys of a scene file are, as a JSON schema for editors and as a page for people.

pub(crate) mod bound;
mod list;

use std::fmt::Write as _;

use serde_json::{Map, Value, json};

use crate::keys::bound::Bound;
use crate::keys::list::KEYS;
use crate::read::document::{INTEGERS, NUMBERS, TABLE, TABLES, TEXT, whole_number};

/// One key of a scene file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SceneKey {
    /// Full dotted path; keys of an array of tables stand below its name.
    pub path: &'static str,
    /// What it holds.
    pub kind: KeyKind,
    /// Its unit.
    pub unit: &'static str,
    /// Whether it must be there.
    pub presence: Presence,
    /// What it says.
    pub meaning: &'static str,
    /// Verbs that do nothing without it; `–` if none.
    pub needed_by: &'static str,
}

/// What a key holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum KeyKind {
    /// A table.
    Table,
    /// An array of tables.
    Tables,
    /// A number within limits.
    Number(Bound),
    /// A whole number between two limits, both allowed.
    Integer(i64, i64),
    /// A string of one line.
    Text,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// A list of numbers.
    Numbers,
    /// A list of whole numbers.
    Integers,
}

/// Whether a key must be there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Presence {
    /// It must be there wherever its table is.
    Required,
    /// It may be left out for this value.
    Default(&'static str),
    /// It may be left out; the text says what then holds, or when it must be there.
    Optional(&'static str),
}

impl KeyKind {
    /// What is allowed, in the words of the reader's faults.
    pub fn words(self) -> String {
        match self {
            Self::Table => TABLE.into(),
            Self::Tables => TABLES.into(),
            Self::Number(bound) => bound.words(),
            Self::Integer(low, high) => whole_number(low, high),
            Self::Text => TEXT.into(),
            Self::Choice(words) => {
                let quoted: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
                quoted.join(", ")
            }
            Self::Numbers => NUMBERS.into(),
            Self::Integers => INTEGERS.into(),
        }
    }

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

/// Every key of a scene file, each table before its keys.
pub fn scene_keys() -> &'static [SceneKey] {
    KEYS
}

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
    for key in KEYS {
        let (parent, name) = key.path.rsplit_once('.').unwrap_or(("", key.path));
        if parent != table {
            continue;
        }
        let mut own = match key.kind {
            KeyKind::Table => table_schema(key.path),
            kind => kind.schema(),
        };
        if key.kind == KeyKind::Tables {
            own.insert("items".into(), Value::Object(table_schema(key.path)));
        }
        own.insert("description".into(), description(key).into());
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
    let mut text = key.meaning.to_owned();
    if key.unit != "–" {
        text += &format!(" [{}]", key.unit);
    }
    if let Presence::Optional(otherwise) = key.presence {
        text += &format!("; left out: {otherwise}");
    }
    text
}

/// The page of all keys in Markdown, one section for each table.
pub fn scene_key_page() -> String {
    let mut text = String::from(HEAD);
    let tables = [""].into_iter().chain(KEYS.iter().filter(|k| is_table(k)).map(|k| k.path));
    for table in tables {
        let own: Vec<&SceneKey> = KEYS
            .iter()
            .filter(|k| !is_table(k) && k.path.rsplit_once('.').map_or("", |p| p.0) == table)
            .collect();
        if own.is_empty() && table.is_empty() {
            continue;
        }
        // Writing to a string cannot fail.
        let _ = match KEYS.iter().find(|k| k.path == table) {
            None => writeln!(text, "\n## Top of the file\n"),
            Some(k) => {
                let name = if k.kind == KeyKind::Tables {
                    format!("[[{table}]]")
                } else {
                    format!("[{table}]")
                };
                writeln!(text, "\n## {name}\n\n{}. {}.\n", capital(k.meaning), left_out(k))
            }
        };
        if own.is_empty() {
            continue;
        }
        text.push_str("| key | unit | allowed | left out | meaning | needed by |\n|---|---|---|---|---|---|\n");
        for key in own {
            let name = key.path.rsplit_once('.').map_or(key.path, |p| p.1);
            let _ = writeln!(
                text,
                "| `{name}` | {} | {} | {} | {} | {} |",
                key.unit,
                key.kind.words(),
                left_out(key),
                key.meaning,
                key.needed_by
            );
        }
    }
    text
}

fn is_table(key: &SceneKey) -> bool {
    matches!(key.kind, KeyKind::Table | KeyKind::Tables)
}

fn left_out(key: &SceneKey) -> String {
    match key.presence {
        Presence::Required => "must be there".into(),
        Presence::Default(value) => value.into(),
        Presence::Optional(otherwise) => {
            if is_table(key) {
                format!("Left out: {otherwise}")
            } else {
                otherwise.into()
            }
        }
    }
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or(String::new(), |first| first.to_uppercase().chain(chars).collect())
}

const HEAD: &str = "\
# Keys of a scene file

A scene is a TOML file. Lengths are in mm, angles in degrees, everything else in SI units; the unit is part of each key.
`epicyclic scene new FILE` writes a commented scene, `epicyclic scene check FILE` lists every fault of a file or what
follows from it, and what each verb still lacks.

This page and the JSON schema come from one list in the program (`scene/src/keys/list.rs`). `epicyclic scene schema`
prints the schema. Written beside a scene, with

```sh
epicyclic scene schema > scene.schema.json
```

it is found without a network through the first line of the scene, which the template has:

```toml
#:schema ./scene.schema.json
```

Editors that use taplo (VS Code with Even Better TOML, Helix, Neovim, Zed) then complete the keys and underline misspelt
ones and wrong types; `taplo check scene.toml` does so in a shell. In this repository the same schema is
`schemas/scene.json`.

`[lumped]` is optional. FE/contact needs nothing of it but the carrier's mass where `[geometry.carrier]` is left out.
Without it, or with `from = \"geometry\"` alone in it, `epicyclic modes` and `epicyclic compare` take masses, inertias and
stiffnesses of a planetary set from its geometry in closed form (`docs/closed_forms.md`); `epicyclic modes --parameters`
prints them as this table. `epicyclic mesh` prints masses and moments of inertia of the meshed bodies, and
`epicyclic static` the mean mesh stiffnesses.

A key *needed by* a verb must be there for it to run, as far as the column *left out* says so; `–` is a key that changes
results and is never needed.
";

#[cfg(test)]
mod tests;
