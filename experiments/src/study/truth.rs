//! The truth of a quantity: its first route, and how far the others are from it.

use std::path::{Path, PathBuf};

use dynamics::extrapolate;
use serde::Deserialize;
use toml::{Table, Value};

use super::error::StudyError;
use super::quantity::Quantity;
use super::result::{RouteResult, TruthResult};
use super::setting::{Choices, ContactSolver, Setting, StudyIntegrator, StudyModel, number};
use super::study_file::{read, with_choices};
use crate::scene_keys::at;
use crate::sweep::SteadyMethod;

/// Kinds of routes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum RouteKind {
    /// Richardson extrapolation over `values` of `key`.
    Extrapolated,
    /// One setting; its uncertainty comes from the other routes.
    Setting,
    /// A number kept in a file.
    Kept,
}

with_choices! {
    /// `[[truth]]`.
    struct RouteInput {
        name: String,
        kind: RouteKind,
        quantities: Option<Vec<String>>,
        key: Option<String>,
        values: Option<Vec<Value>>,
        order: Option<f64>,
        file: Option<PathBuf>,
        value_key: Option<String>,
        uncertainty_percent: Option<f64>,
        uncertainty_percent_key: Option<String>,
    }
}

/// A route to the truth of some quantities.
#[derive(Debug, Clone)]
pub(super) struct Route {
    pub(super) name: String,
    /// Places of its quantities in the study.
    quantities: Vec<usize>,
    pub(super) way: Way,
}

/// How a route gets its value.
#[derive(Debug, Clone)]
pub(super) enum Way {
    /// From settings: refinement of each (empty for one setting alone), formal order.
    Settings { settings: Vec<Setting>, refinements: Vec<f64>, order: Option<f64> },
    /// A kept value and its uncertainty, in percent.
    Kept { value: f64, uncertainty_percent: f64 },
}

impl Route {
    /// Whether it leads to the truth of a quantity.
    pub(super) fn is_for(&self, quantity: usize) -> bool {
        self.quantities.contains(&quantity)
    }

    /// Value, uncertainty and order from the values of its settings.
    pub(super) fn result(&self, values: &[f64]) -> RouteResult {
        let name = self.name.clone();
        match &self.way {
            Way::Kept { value, uncertainty_percent } => RouteResult {
                name,
                value: *value,
                uncertainty: 0.01 * uncertainty_percent * value.abs(),
                order: None,
                values: Vec::new(),
            },
            Way::Settings { refinements, order, .. } => {
                let values = values.to_vec();
                let own = match refinements.is_empty() {
                    true => None,
                    false => Some(extrapolate(&values, refinements, *order)),
                };
                let alone = values.first().copied().unwrap_or(f64::NAN);
                RouteResult {
                    name,
                    value: own.map_or(alone, |e| e.value),
                    uncertainty: own.map_or(0.0, |e| e.uncertainty),
                    order: own.and_then(|e| e.order),
                    values,
                }
            }
        }
    }
}

/// The truth by the first of the routes, with U the largest of its own uncertainty and its distances to the others.
///
/// # Errors
/// The reason why there is none: it is not finite, is 0, so that no error has a size in percent, or nothing gives it an
/// uncertainty.
pub(super) fn truth(routes: Vec<RouteResult>) -> Result<TruthResult, String> {
    let (value, own) = routes.first().map_or((f64::NAN, f64::NAN), |r| (r.value, r.uncertainty));
    let distances = routes.iter().skip(1).map(|r| (r.value - value).abs());
    // NaN is kept.
    let larger = |a: f64, b: f64| if a.is_nan() || a >= b { a } else { b };
    let uncertainty = distances.fold(own, larger);
    let problem = if !(value.is_finite() && uncertainty.is_finite()) {
        Some("its value or its uncertainty is not finite")
    } else if value == 0.0 {
        Some("it is 0, and errors are given in percent of it")
    } else if uncertainty == 0.0 {
        Some("its uncertainty is 0: name a second route, or a sequence to be extrapolated")
    } else {
        None
    };
    match problem {
        Some(reason) => Err(reason.into()),
        None => {
            let uncertainty_percent = 100.0 * uncertainty / value.abs();
            Ok(TruthResult { value, uncertainty, uncertainty_percent, routes })
        }
    }
}

impl RouteInput {
    pub(super) fn route(
        &self,
        all: &[Quantity],
        tables: (&Table, &Table),
        folder: &Path,
    ) -> Result<Route, StudyError> {
        let of = format!("truth {:?}", self.name);
        let place = |name: &String| {
            let names = all.iter().map(|q| q.name.as_str()).collect::<Vec<_>>().join(", ");
            all.iter().position(|q| q.name == *name).ok_or_else(|| {
                let allowed = format!("names of quantities: {names}");
                StudyError::key(format!("{of}.quantities"), format!("{name:?}"), allowed)
            })
        };
        let quantities = match &self.quantities {
            Some(names) => names.iter().map(place).collect::<Result<Vec<_>, _>>()?,
            None => (0..all.len()).collect(),
        };
        self.has_keys(&of)?;
        let way = match self.kind {
            RouteKind::Kept => {
                if quantities.len() != 1 {
                    let allowed = "one quantity: a kept number is that of one";
                    let key = format!("{of}.quantities");
                    return Err(StudyError::key(key, quantities.len(), allowed));
                }
                self.kept(&of, folder)?
            }
            RouteKind::Setting => {
                let named = (self.name.clone(), String::new(), None);
                let settings = vec![Setting::new(named, self.choices(), tables)?];
                Way::Settings { settings, refinements: Vec::new(), order: None }
            }
            RouteKind::Extrapolated => self.sequence(&of, tables)?,
        };
        Ok(Route { name: self.name.clone(), quantities, way })
    }

    fn sequence(&self, of: &str, tables: (&Table, &Table)) -> Result<Way, StudyError> {
        let (key, values) =
            (self.key.as_deref().unwrap_or(""), self.values.as_deref().unwrap_or(&[]));
        let refused = || {
            let allowed =
                "three numbers or more, ascending: refinements, with errors that fall as they grow";
            let shown: Vec<String> = values.iter().map(Value::to_string).collect();
            StudyError::key(format!("{of}.values"), format!("[{}]", shown.join(", ")), allowed)
        };
        let refinements: Vec<f64> =
            values.iter().map(number).collect::<Option<_>>().ok_or_else(refused)?;
        let is_ascending = refinements.windows(2).all(|w| w[0] < w[1]);
        if refinements.len() < 3 || refinements[0] <= 0.0 || !is_ascending {
            return Err(refused());
        }
        if let Some(order) = self.order.filter(|p| !(0.5..=6.0).contains(p)) {
            return Err(StudyError::key(format!("{of}.order"), order, "from 0.5 to 6"));
        }
        let one = |value: &Value| {
            let choices = self.choices().with(key, value, of)?;
            let named = (format!("{}: {value}", self.name), String::new(), None);
            Setting::new(named, choices, tables)
        };
        let settings = values.iter().map(one).collect::<Result<_, _>>()?;
        Ok(Way::Settings { settings, refinements, order: self.order })
    }

    fn kept(&self, of: &str, folder: &Path) -> Result<Way, StudyError> {
        let path = folder.join(self.file.as_deref().unwrap_or(Path::new("")));
        let text = read(&path, &format!("{of}.file"))?;
        let table: Table =
            text.parse().map_err(|e: toml::de::Error| StudyError::Syntax(e.to_string()))?;
        let get = |name: &str, path: &str| {
            let allowed = "a key of the file that holds a number; dots lead into tables and lists";
            at(&table, path).and_then(number).ok_or_else(|| {
                StudyError::key(format!("{of}.{name}"), format!("{path:?}"), allowed)
            })
        };
        let value = get("value_key", self.value_key.as_deref().unwrap_or(""))?;
        let uncertainty_percent = match (&self.uncertainty_percent_key, self.uncertainty_percent) {
            (Some(path), None) => get("uncertainty_percent_key", path)?,
            (None, Some(percent)) => percent,
            _ => {
                let allowed = "one of uncertainty_percent and uncertainty_percent_key";
                return Err(StudyError::key(of, "without its uncertainty, or with two", allowed));
            }
        };
        if !(uncertainty_percent > 0.0 && uncertainty_percent.is_finite()) {
            let key = format!("{of}.uncertainty_percent");
            return Err(StudyError::key(key, uncertainty_percent, "a number above 0"));
        }
        Ok(Way::Kept { value, uncertainty_percent })
    }

    /// Refuses keys that the kind lacks or does not have.
    fn has_keys(&self, of: &str) -> Result<(), StudyError> {
        let given = [
            ("key", self.key.is_some(), RouteKind::Extrapolated),
            ("values", self.values.is_some(), RouteKind::Extrapolated),
            ("file", self.file.is_some(), RouteKind::Kept),
            ("value_key", self.value_key.is_some(), RouteKind::Kept),
        ];
        for (key, is_given, kind) in given {
            if is_given != (self.kind == kind) {
                let value = if is_given { "given" } else { "absent" };
                let allowed = match kind {
                    RouteKind::Kept => "file and value_key with kind = \"kept\", and only there",
                    _ => "key and values with kind = \"extrapolated\", and only there",
                };
                return Err(StudyError::key(format!("{of}.{key}"), value, allowed));
            }
        }
        if self.kind == RouteKind::Kept && self.choices() != Choices::default() {
            let allowed =
                "no keys of settings with kind = \"kept\": the number is what the file says";
            return Err(StudyError::key(of, "with keys of settings", allowed));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::{Candidate, judge};

    fn route(value: f64, uncertainty: f64) -> RouteResult {
        RouteResult { name: String::new(), value, uncertainty, order: None, values: Vec::new() }
    }

    #[test]
    fn the_uncertainty_reaches_to_the_farthest_route() {
        let found = truth(vec![route(100.0, 0.1), route(100.05, 9.0)]).unwrap();
        assert_eq!((found.value, found.uncertainty), (100.0, 0.1));
        let found = truth(vec![route(100.0, 0.1), route(101.0, 0.0), route(99.5, 0.0)]).unwrap();
        assert_eq!((found.uncertainty, found.uncertainty_percent), (1.0, 1.0));
        for none in [
            vec![route(0.0, 1.0)],
            vec![route(1.0, 0.0)],
            vec![route(1.0, 0.0), route(1.0, 5.0)],
            vec![route(f64::NAN, 1.0)],
            vec![route(1.0, 0.1), route(f64::NAN, 1.0)],
            vec![],
        ] {
            assert!(truth(none).is_err());
        }
    }

    /// All settings and the extrapolated truth share a bias that a second, independent route does not have: the
    /// family alone would rank its own finest setting first without doubt.
    #[test]
    fn a_bias_that_a_family_shares_is_seen_by_a_second_route() {
        let n = [10.0, 20.0, 40.0, 80.0, 160.0];
        let of = |n: f64, bias: f64| 1.0 + bias + n.powi(-2);
        let family: Vec<f64> = n[2..].iter().map(|n| of(*n, 0.01)).collect();
        let own = extrapolate(&family, &n[2..], None);
        let first = RouteResult {
            name: "family".into(),
            value: own.value,
            uncertainty: own.uncertainty,
            order: own.order,
            values: family,
        };
        let mut list: Vec<Candidate> = n[..3]
            .iter()
            .map(|n| Candidate { value: of(*n, 0.01), cost: *n, place: None })
            .collect();
        // Of another family, without the bias.
        list.push(Candidate { value: of(30.0, 0.0), cost: 30.0, place: None });
        let alone = truth(vec![first.clone()]).unwrap();
        let blind = judge(alone.value, alone.uncertainty, &list);
        assert!(blind.iter().all(|j| !j.is_rank_uncertain()) && blind[2].rank == 1, "{blind:?}");
        let both = truth(vec![first, route(1.0, 1e-6)]).unwrap();
        assert!((both.uncertainty - 0.01).abs() < 1e-4, "{both:?}");
        let seen = judge(both.value, both.uncertainty, &list);
        assert!(seen[2].is_rank_uncertain() && seen[3].is_rank_uncertain(), "{seen:?}");
    }
}
