//! One key of a scene file.

use crate::keys::bound::Bound;

/// One key of a scene file.
#[derive(Debug, Clone, PartialEq)]
pub struct SceneKey {
    /// Full dotted path; keys of an array of tables stand below its name.
    pub path: String,
    /// What it holds.
    pub kind: KeyKind,
    /// Its unit.
    pub unit: &'static str,
    /// Whether it must be there.
    pub presence: Presence,
    /// What it says.
    pub meaning: String,
    /// Why a value is refused, where that is not the first clause of the meaning.
    pub(crate) reason_given: Option<&'static str>,
    /// Verbs that do nothing without it; `–` if none.
    pub needed_by: &'static str,
    /// Verbs whose results it changes; empty of a table, `–` of a key that changes none.
    pub changes: &'static str,
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

/// A key that may be left out and that no verb needs, until more is said of it.
pub(crate) fn key(
    path: impl Into<String>,
    kind: KeyKind,
    unit: &'static str,
    meaning: impl Into<String>,
) -> SceneKey {
    SceneKey {
        path: path.into(),
        kind,
        unit,
        presence: Presence::Optional(""),
        meaning: meaning.into(),
        reason_given: None,
        needed_by: "–",
        changes: "",
    }
}

impl KeyKind {
    /// What is allowed, in the words of the reader's faults.
    pub fn words(self) -> String {
        match self {
            Self::Table => "a table".into(),
            Self::Tables => "an array of tables".into(),
            Self::Number(bound) => bound.words(),
            Self::Integer(low, high) => format!("a whole number from {low} to {high}"),
            Self::Text => "a string of one line in quotes, without control characters".into(),
            Self::Choice(words) => {
                let quoted: Vec<_> = words.iter().map(|word| format!("\"{word}\"")).collect();
                quoted.join(", ")
            }
            Self::Numbers => "a list of finite numbers".into(),
            Self::Integers => "a list of whole numbers".into(),
        }
    }
}

impl SceneKey {
    /// Why a value is refused.
    pub(crate) fn reason(&self) -> &str {
        let clause = self.meaning.split([';', ':']).next();
        self.reason_given.or(clause).unwrap_or(&self.meaning)
    }

    /// The value that holds where the key is left out, if that is a value.
    pub(crate) fn default(&self) -> Option<&'static str> {
        match self.presence {
            Presence::Default(value) => Some(value),
            _ => None,
        }
    }

    /// The default as a scene file would hold it.
    pub(crate) fn default_as_written(&self) -> Option<String> {
        let value = self.default()?;
        Some(match self.kind {
            KeyKind::Choice(_) | KeyKind::Text => format!("\"{value}\""),
            _ => value.to_owned(),
        })
    }

    /// A number of this key in SI units.
    pub(crate) fn to_si(&self, x: f64) -> f64 {
        match self.unit {
            "mm" => x * 1e-3,
            "µm" => x * 1e-6,
            "°" => x.to_radians(),
            _ => x,
        }
    }

    /// The default of a number in SI units.
    pub(crate) fn default_si(&self) -> Option<f64> {
        Some(self.to_si(self.default()?.parse().ok()?))
    }

    /// Whether it is a table or an array of tables.
    pub(crate) fn is_table(&self) -> bool {
        matches!(self.kind, KeyKind::Table | KeyKind::Tables)
    }

    /// The path of its table, empty at the top of the file, and its name there.
    pub(crate) fn table_and_name(&self) -> (&str, &str) {
        self.path.rsplit_once('.').unwrap_or(("", &self.path))
    }

    /// It must be there wherever its table is.
    pub(crate) fn required(self) -> Self {
        Self { presence: Presence::Required, ..self }
    }

    /// The value that holds where it is left out.
    pub(crate) fn default_is(self, value: &'static str) -> Self {
        Self { presence: Presence::Default(value), ..self }
    }

    /// What holds where it is left out, or when it must be there.
    pub(crate) fn left_out(self, otherwise: &'static str) -> Self {
        Self { presence: Presence::Optional(otherwise), ..self }
    }

    /// The reason that a fault gives.
    pub(crate) fn why(self, reason: &'static str) -> Self {
        Self { reason_given: Some(reason), ..self }
    }

    /// Verbs that do nothing without it.
    pub(crate) fn needed_by(self, verbs: &'static str) -> Self {
        Self { needed_by: verbs, ..self }
    }

    /// Verbs whose results it changes.
    pub(crate) fn changes(self, verbs: &'static str) -> Self {
        Self { changes: verbs, ..self }
    }
}
