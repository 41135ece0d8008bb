//! What the contents of a folder were computed from, and how two such descriptions differ.

use serde::Serialize;
use serde_json::Value;

use crate::error::Result;

/// Name of the manifest in a folder.
pub(crate) const PLAN: &str = "plan.json";

/// Longest part of a line of the scene that a message repeats, characters.
const LONGEST: usize = 60;

/// Runs of one verb that keep finished parts in a folder.
#[derive(Debug)]
pub(crate) struct RunKind {
    /// What is run, with its article.
    pub(crate) run: &'static str,
    /// Version of the parts and of the manifest; another one is refused.
    pub(crate) format: u32,
    /// Key of the manifest that only these runs have.
    pub(crate) key: &'static str,
    /// Where the manifest holds a setting (JSON pointer), and what gives it.
    pub(crate) settings: &'static [(&'static str, &'static str)],
    /// The same for what is too long to be repeated: what a message says of it.
    pub(crate) contents: fn(&Value) -> String,
    /// Results that the end of a run writes.
    pub(crate) results: &'static [&'static str],
    /// What else it writes.
    pub(crate) others: &'static [&'static str],
    /// Folder of finished parts.
    pub(crate) parts: &'static str,
    /// Held by the process that writes into the folder.
    pub(crate) lock: &'static str,
}

/// What a run is computed from.
#[derive(Debug, Serialize)]
pub(crate) struct Subject<'s, S> {
    /// Version of the parts.
    format: u32,
    /// Version of the program.
    version: &'static str,
    /// The scene file's text.
    scene: &'s str,
    /// Name of the fidelity or model.
    fidelity: &'s str,
    /// Torque on the sun, N m.
    sun_torque_nm: f64,
    #[serde(flatten)]
    settings: &'s S,
}

/// What the contents of a folder are computed from.
#[derive(Debug)]
pub(crate) struct Manifest {
    pub(super) kind: &'static RunKind,
    /// As the folder holds it.
    pub(crate) text: String,
    value: Value,
}

impl Manifest {
    /// Of this version of the program.
    pub(crate) fn new<S: Serialize>(
        kind: &'static RunKind,
        (scene, fidelity, sun_torque_nm): (&str, &str, f64),
        settings: &S,
    ) -> Result<Self> {
        let (format, version) = (kind.format, env!("CARGO_PKG_VERSION"));
        let subject = Subject { format, version, scene, fidelity, sun_torque_nm, settings };
        let text = serde_json::to_string_pretty(&subject)?;
        Ok(Self { kind, value: serde_json::from_str(&text)?, text })
    }

    /// The first difference of a manifest read from a folder from this one, as a clause about the folder; `None` if
    /// they are the same.
    pub(crate) fn difference(&self, text: &str) -> Option<String> {
        let Ok(found) = serde_json::from_str::<Value>(text) else {
            return Some("its manifest is no JSON".into());
        };
        let kind = self.kind;
        if found.get(kind.key).is_none() {
            return Some(format!("it is of something else, not of {}", kind.run));
        }
        let common = [
            ("/format", "format"),
            ("/version", "version"),
            ("/scene", ""),
            ("/fidelity", "the model (--model)"),
            ("/sun_torque_nm", "--sun-torque-nm"),
        ];
        for (pointer, giver) in common.iter().chain(kind.settings) {
            let values = [&found, &self.value].map(|manifest| manifest.pointer(pointer));
            let [theirs, ours] = values;
            if theirs == ours {
                continue;
            }
            if let ("/scene", [Some(theirs), Some(ours)]) =
                (*pointer, values.map(|value| value.and_then(Value::as_str)))
            {
                return Some(of_scenes(theirs, ours));
            }
            let [theirs, ours] = values.map(words);
            return Some(format!("computed with {giver} {theirs}, not {ours}"));
        }
        let [theirs, ours] = [&found, &self.value].map(kind.contents);
        match theirs == ours {
            false => Some(format!("of {theirs}, not {ours}")),
            true => (found != self.value).then(|| format!("of other {theirs}")),
        }
    }
}

/// A setting in words.
fn words(value: Option<&Value>) -> String {
    match value {
        None | Some(Value::Null) => "nothing".into(),
        Some(Value::Bool(is)) => if *is { "yes" } else { "no" }.into(),
        Some(Value::String(text)) => text.clone(),
        Some(Value::Array(list)) => {
            list.iter().map(|entry| words(Some(entry))).collect::<Vec<_>>().join(":")
        }
        Some(other) => other.to_string().trim_end_matches(".0").to_owned(),
    }
}

/// The first line in which scene files differ.
fn of_scenes(found: &str, wanted: &str) -> String {
    let shown = |line: Option<&str>| match line {
        Some(line) if line.chars().count() > LONGEST => {
            format!("`{}…`", line.chars().take(LONGEST).collect::<String>())
        }
        Some(line) => format!("`{line}`"),
        None => "absent".into(),
    };
    let (mut theirs, mut ours) = (found.lines(), wanted.lines());
    for number in 1.. {
        match (theirs.next(), ours.next()) {
            (None, None) => break,
            (theirs, ours) if theirs != ours => {
                let (was, is) = (shown(theirs), shown(ours));
                return format!(
                    "the scene file has another text: line {number} was {was} and is {is}"
                );
            }
            _ => {}
        }
    }
    "the scene file has other ends of lines".into()
}
