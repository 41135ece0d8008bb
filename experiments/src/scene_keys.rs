//! A scene with some of its keys replaced, by the text of the file: what results is read and validated as any scene is.

use scene::{Scene, SceneError};
use toml::{Table, Value};

/// The scene with `keys` laid over it, one after the other; tables are merged, other values replaced.
///
/// # Errors
/// All faults of what results, by key.
pub(crate) fn scene_with(base: &Table, keys: &[&Table]) -> Result<Scene, SceneError> {
    let mut whole = base.clone();
    keys.iter().for_each(|own| merge(&mut whole, own));
    // What was read as TOML can be written as TOML.
    Scene::from_toml(&toml::to_string(&whole).unwrap_or_default())
}

pub(crate) fn merge(onto: &mut Table, own: &Table) {
    for (key, value) in own {
        match (onto.get_mut(key), value) {
            (Some(Value::Table(below)), Value::Table(own)) => merge(below, own),
            _ => {
                onto.insert(key.clone(), value.clone());
            }
        }
    }
}

/// `a.b.c = value` as nested tables.
pub(crate) fn nested(path: &str, value: Value) -> Table {
    let mut parts: Vec<&str> = path.split('.').collect();
    let last = parts.pop().unwrap_or_default();
    let mut table = Table::from_iter([(last.to_owned(), value)]);
    for part in parts.into_iter().rev() {
        table = Table::from_iter([(part.to_owned(), Value::Table(table))]);
    }
    table
}

/// Keys with dots and their values, as text in order.
pub(crate) fn flat(table: &Table) -> Vec<String> {
    let mut list = Vec::new();
    for (key, value) in table {
        match value {
            Value::Table(own) => list.extend(flat(own).into_iter().map(|k| format!("{key}.{k}"))),
            value => list.push(format!("{key} = {value}")),
        }
    }
    list
}

/// The value at `a.b.0.c`: names of tables and places in lists.
pub(crate) fn at<'t>(table: &'t Table, path: &str) -> Option<&'t Value> {
    let mut parts = path.split('.');
    let first = table.get(parts.next()?)?;
    parts.try_fold(first, |value, part| match value {
        Value::Table(own) => own.get(part),
        Value::Array(list) => list.get(part.parse::<usize>().ok()?),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{Fidelity, SceneKind, template};

    fn table(text: &str) -> Table {
        text.parse().unwrap()
    }

    #[test]
    fn later_keys_replace_earlier_ones_and_leave_the_rest() {
        let base: Table = table(template(SceneKind::Planetary));
        let plain = scene_with(&base, &[]).unwrap();
        let own = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        assert_eq!(format!("{plain:?}"), format!("{own:?}"));
        let coarse = table("fe_contact.flank_elements = 8\ndynamics.steps_per_cycle = 70");
        let modal = nested("dynamics.steps_per_cycle", Value::Integer(280));
        let found = scene_with(&base, &[&coarse, &modal]).unwrap();
        assert_eq!(found.fe_contact.flank_elements, 8);
        assert_eq!(found.dynamics.steps_per_cycle, 280);
        assert_eq!(found.dynamics.fidelity, Fidelity::QuasiStatic);
        assert_eq!(format!("{:?}", found.geometry), format!("{:?}", plain.geometry));
    }

    #[test]
    fn faults_name_the_key() {
        let base: Table = table(template(SceneKind::Planetary));
        for (keys, named) in [
            ("fe_contact.contact_cels = 8", "fe_contact.contact_cels"),
            ("fe_contact.contact_cells = 2", "fe_contact.contact_cells"),
            ("dynamics.fidelity = \"best\"", "dynamics.fidelity"),
        ] {
            let error = scene_with(&base, &[&table(keys)]).unwrap_err().to_string();
            assert!(error.contains(named), "{error}");
        }
    }

    #[test]
    fn values_are_found_by_path() {
        let own = table("a = [ { b = 1.5 }, { b = 2.5 } ]\nc.d = 3");
        assert_eq!(at(&own, "a.1.b").and_then(Value::as_float), Some(2.5));
        assert_eq!(at(&own, "c.d").and_then(Value::as_integer), Some(3));
        for dead in ["a.2.b", "a.b", "c", "c.d.e", "x"] {
            assert!(at(&own, dead).is_none_or(Value::is_table), "{dead}");
        }
        assert_eq!(flat(&own), ["a = [{ b = 1.5 }, { b = 2.5 }]", "c.d = 3"]);
    }
}
