//! Types of the keys of a study file, refused in the words of scene files; what their values may be is checked where
//! they are used.

use scene::{Bound, KeyKind};
use toml::{Table, Value};

use super::error::StudyError;
use super::study_file::{LEAST_ROUNDS, MOST_ROUNDS};

/// What a key holds.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// As keys of scenes do.
    Scene(KeyKind),
    /// A whole number from this on.
    From(i64),
    /// A path or a name.
    Text,
    /// A list of strings.
    Texts,
    /// A list of values of another key.
    Values,
    /// True or false.
    Switch,
}

const NUMBER: Kind = Kind::Scene(KeyKind::Number(Bound::Finite));
const TABLE: Kind = Kind::Scene(KeyKind::Table);
const TABLES: Kind = Kind::Scene(KeyKind::Tables);

/// Keys at the top of the file with what they hold, and whether they must be there.
const TOP: [(&str, Kind, bool); 12] = [
    ("format", Kind::Scene(KeyKind::Integer(1, 1)), true),
    ("title", Kind::Text, true),
    ("scene", Kind::Text, true),
    ("sun_torque_nm", NUMBER, false),
    ("tolerance_percent", NUMBER, true),
    ("rounds", Kind::Scene(KeyKind::Integer(LEAST_ROUNDS as i64, MOST_ROUNDS as i64)), false),
    ("cost", Kind::Text, false),
    ("keys", TABLE, false),
    ("quantity", TABLES, true),
    ("truth", TABLES, true),
    ("setting", TABLES, false),
    ("series", TABLES, false),
];

/// Keys of `[[quantity]]`.
const QUANTITY: [(&str, Kind, bool); 16] = [
    ("name", Kind::Text, true),
    ("kind", Kind::Text, true),
    ("mode_type", Kind::Text, false),
    ("number", Kind::From(1), false),
    ("positions", Kind::From(1), false),
    ("harmonic", Kind::From(1), false),
    ("mesh", Kind::Text, false),
    ("phase", NUMBER, false),
    ("part", Kind::Text, false),
    ("motion", Kind::Text, false),
    ("speed_rpm", NUMBER, false),
    ("speeds_rpm", Kind::Scene(KeyKind::Numbers), false),
    ("refine", Kind::Switch, false),
    ("sun_torque_nm", NUMBER, false),
    ("reference_torque_nm", NUMBER, false),
    ("work", Kind::Text, false),
];

/// Keys of `[[truth]]` beside the choices.
const TRUTH: [(&str, Kind, bool); 10] = [
    ("name", Kind::Text, true),
    ("kind", Kind::Text, true),
    ("quantities", Kind::Texts, false),
    ("key", Kind::Text, false),
    ("values", Kind::Values, false),
    ("order", NUMBER, false),
    ("file", Kind::Text, false),
    ("value_key", Kind::Text, false),
    ("uncertainty_percent", NUMBER, false),
    ("uncertainty_percent_key", Kind::Text, false),
];

/// Keys of `[[setting]]` beside the choices.
const SETTING: [(&str, Kind, bool); 2] = [("name", Kind::Text, true), ("group", Kind::Text, false)];

/// Keys of `[[series]]` beside the choices.
const SERIES: [(&str, Kind, bool); 4] = [
    ("name", Kind::Text, true),
    ("key", Kind::Text, true),
    ("values", Kind::Values, true),
    ("refines", Kind::Switch, false),
];

/// Choices of settings, series and truths.
const CHOICES: [(&str, Kind, bool); 7] = [
    ("model", Kind::Text, false),
    ("keys", TABLE, false),
    ("steady_method", Kind::Text, false),
    ("steady_tolerance", NUMBER, false),
    ("table_size", Kind::From(0), false),
    ("contact_solver", Kind::Text, false),
    ("integrator", Kind::Text, false),
];

/// Refuses a key of a wrong type, and the absence of one that must be there.
pub(super) fn check(file: &Table) -> Result<(), StudyError> {
    of_table(file, "", &TOP)?;
    let tables: [(&str, &[_], &[_]); 4] = [
        ("quantity", &QUANTITY, &[]),
        ("truth", &TRUTH, &CHOICES),
        ("setting", &SETTING, &CHOICES),
        ("series", &SERIES, &CHOICES),
    ];
    for (name, own, choices) in tables {
        let list = file.get(name).and_then(Value::as_array).into_iter().flatten();
        for (number, table) in list.enumerate() {
            let Some(table) = table.as_table() else { continue };
            let path = match table.get("name").and_then(Value::as_str) {
                Some(given) => format!("{name} {given:?}."),
                None => format!("{name}.{number}."),
            };
            of_table(table, &path, own)?;
            of_table(table, &path, choices)?;
        }
    }
    Ok(())
}

fn of_table(table: &Table, path: &str, keys: &[(&str, Kind, bool)]) -> Result<(), StudyError> {
    for (key, kind, must_be) in keys {
        let refused =
            |value: String| Err(StudyError::key(format!("{path}{key}"), value, kind.words()));
        match table.get(*key) {
            None if *must_be => return refused("absent".into()),
            Some(value) if !kind.is(value) => {
                return refused(match value {
                    Value::Table(_) => "a table".into(),
                    other => other.to_string(),
                });
            }
            _ => {}
        }
    }
    Ok(())
}

impl Kind {
    fn is(self, value: &Value) -> bool {
        let all = |is: fn(&Value) -> bool| value.as_array().is_some_and(|list| list.iter().all(is));
        match self {
            Self::Text => value.is_str(),
            Self::Texts => all(Value::is_str),
            Self::Values => value.is_array(),
            Self::Switch => value.is_bool(),
            Self::From(low) => value.as_integer().is_some_and(|n| n >= low),
            Self::Scene(KeyKind::Integer(low, high)) => {
                value.as_integer().is_some_and(|n| (low..=high).contains(&n))
            }
            Self::Scene(KeyKind::Numbers) => all(is_number),
            Self::Scene(KeyKind::Table) => value.is_table(),
            Self::Scene(KeyKind::Tables) => all(Value::is_table),
            // Whether it is finite, and of what size, is checked where it is used.
            Self::Scene(_) => is_number(value),
        }
    }

    fn words(self) -> String {
        match self {
            Self::Scene(KeyKind::Integer(low, high)) if low == high => low.to_string(),
            Self::Scene(kind) => kind.words(),
            Self::From(low) => format!("a whole number from {low}"),
            Self::Text => KeyKind::Text.words(),
            Self::Texts => "a list of strings in quotes".into(),
            Self::Values => "a list of values".into(),
            Self::Switch => "true, false".into(),
        }
    }
}

fn is_number(value: &Value) -> bool {
    value.is_float() || value.is_integer()
}
