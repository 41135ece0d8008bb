//! Every check is declared once, in `checks/registry.toml`: suite by suite with kind of reference, unit,
//! tolerance with its reason, profile and the negative controls that show that the suite can fail.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Profile;
use crate::check::{ReferenceKind, Tolerance};
use crate::glob::matches;
use crate::model_kind::ModelKind;
use crate::reference_file::{ReferenceError, embedded, parse};

/// What a suite asks of a model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Asks {
    /// Natural modes: anybody's model can be asked.
    NaturalModes,
    /// A mesh cycle at rest: anybody's model can be asked.
    MeshCycle,
    /// Mesh stiffness over a mesh cycle: anybody's model can be asked.
    MeshStiffness,
    /// Steady states over speed: anybody's model can be asked.
    SteadyStates,
    /// Kinds of modes that harmonics can excite: anybody's model can be asked.
    ExcitationRules,
    /// About the numerics of this project's own models.
    OwnNumerics,
}

/// `checks/registry.toml`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Registry {
    /// Suites in the order of the report.
    pub suite: Vec<SuiteEntry>,
}

/// A suite: checks whose ids begin alike.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SuiteEntry {
    /// What all its ids begin with, without the last dot.
    pub name: String,
    /// What is compared with what, in a few words.
    pub about: String,
    /// What it asks of a model.
    pub asks: Asks,
    /// Kinds of model that it judges; results of another kind are shown beside the reference. None where it asks
    /// about this project's own models.
    #[serde(default)]
    pub models: Vec<ModelKind>,
    /// Its checks.
    pub check: Vec<CheckEntry>,
    /// Its negative controls.
    pub control: Vec<ControlEntry>,
}

/// Checks that share kind, unit and tolerance.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CheckEntry {
    /// An id, or a pattern in which `*` stands for any characters; the longest that matches counts.
    pub ids: String,
    /// Kind of reference.
    pub kind: ReferenceKind,
    /// Unit of both values.
    #[serde(default)]
    pub unit: String,
    /// What the expectation follows from, where it is not a citation given beside the value.
    pub source: Option<String>,
    /// Largest |actual − expected|, in the unit.
    pub absolute: Option<f64>,
    /// The same in percent of the expected value.
    pub percent: Option<f64>,
    /// Largest |actual − expected| of another program's tables, in the unit, where `absolute` rests on how far this
    /// project's solvers converge.
    pub tables_absolute: Option<f64>,
    /// Reason for that.
    #[serde(default)]
    pub tables_reason: String,
    /// The range of actual − expected that unknown parameters explain, from `kept/parameter_bands.toml`.
    #[serde(default)]
    pub parameter_band: bool,
    /// Reason for the tolerance; a statement or a count needs none.
    #[serde(default)]
    pub reason: String,
    /// The lowest profile that runs them.
    #[serde(default)]
    pub profile: Profile,
    /// Ids of these checks that the quick profile runs nevertheless.
    #[serde(default)]
    pub quick: Vec<String>,
}

/// A model or record that is spoilt on purpose, which a named check must notice.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlEntry {
    /// Id.
    pub id: String,
    /// What is wrong, in words.
    pub spoils: String,
    /// Id of the check that must fail.
    pub breaks: String,
    /// Whether what is spoilt is the time grid, which tables of another program do not show.
    #[serde(default)]
    pub time_grid_only: bool,
}

impl Registry {
    /// As kept in the repository.
    ///
    /// # Errors
    /// If the file does not hold what the code expects.
    pub fn load() -> Result<Self, ReferenceError> {
        parse("checks/registry.toml", embedded!("checks/registry.toml"))
    }

    /// The suite that an id belongs to.
    pub fn suite_of(&self, id: &str) -> Option<&SuiteEntry> {
        let is_own = |s: &&SuiteEntry| {
            id.strip_prefix(s.name.as_str()).is_some_and(|rest| rest.starts_with('.'))
        };
        self.suite.iter().filter(is_own).max_by_key(|s| s.name.len())
    }

    /// Declaration of a check.
    ///
    /// # Errors
    /// [`ReferenceError::Undeclared`] if there is none.
    pub fn check(&self, id: &str) -> Result<&CheckEntry, ReferenceError> {
        let suite = self.suite_of(id);
        let own = suite.iter().flat_map(|s| &s.check).filter(|c| matches(&c.ids, id));
        own.max_by_key(|c| c.ids.len()).ok_or_else(|| ReferenceError::Undeclared(id.to_owned()))
    }

    /// Whether a check judges models of a kind.
    pub fn judges(&self, id: &str, kind: ModelKind) -> bool {
        self.suite_of(id).is_some_and(|suite| suite.models.contains(&kind))
    }

    /// Declaration of a negative control.
    ///
    /// # Errors
    /// [`ReferenceError::Undeclared`] if there is none.
    pub fn control(&self, id: &str) -> Result<&ControlEntry, ReferenceError> {
        let mut all = self.suite.iter().flat_map(|s| &s.control);
        all.find(|c| c.id == id).ok_or_else(|| ReferenceError::Undeclared(id.to_owned()))
    }

    /// Whether a profile runs a check.
    ///
    /// # Errors
    /// [`ReferenceError::Undeclared`] if the check is not declared.
    pub fn runs(&self, id: &str, profile: Profile) -> Result<bool, ReferenceError> {
        let entry = self.check(id)?;
        let is_quick =
            entry.profile == Profile::Quick || entry.quick.iter().any(|q| matches(q, id));
        Ok(is_quick || profile == Profile::Full)
    }
}

impl CheckEntry {
    /// Tolerance for an expected value.
    pub fn tolerance(&self, expected: f64) -> Tolerance {
        let of_percent = self.percent.map(|p| 0.01 * p * expected.abs());
        let absolute = self.absolute.or(of_percent).unwrap_or(0.0);
        let reason = match (absolute, self.reason.as_str()) {
            (0.0, "") => Tolerance::exact().reason,
            (_, reason) => reason.to_owned(),
        };
        Tolerance { absolute, band: None, reason }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_suite_has_a_control_that_breaks_one_of_its_own_checks() {
        let registry = Registry::load().unwrap();
        for suite in &registry.suite {
            assert!(!suite.control.is_empty(), "{} has no negative control", suite.name);
            for control in &suite.control {
                let own = format!("{}.control.", suite.name);
                assert!(control.id.starts_with(&own), "{} does not begin with {own}", control.id);
                let broken = registry.suite_of(&control.breaks).map(|s| s.name.as_str());
                assert_eq!(broken, Some(suite.name.as_str()), "{}", control.id);
                registry.check(&control.breaks).unwrap();
            }
        }
    }

    #[test]
    fn every_suite_that_asks_a_model_says_which_kinds_it_judges() {
        for suite in Registry::load().unwrap().suite {
            assert_eq!(suite.models.is_empty(), suite.asks == Asks::OwnNumerics, "{}", suite.name);
        }
    }

    #[test]
    fn every_declaration_belongs_to_its_suite_and_says_why() {
        let registry = Registry::load().unwrap();
        let mut names: Vec<&str> = registry.suite.iter().map(|s| s.name.as_str()).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), registry.suite.len());
        for suite in &registry.suite {
            for check in &suite.check {
                assert!(check.ids.starts_with(&suite.name), "{} in {}", check.ids, suite.name);
                let is_exact = check.absolute.is_none() && check.percent.is_none();
                assert!(is_exact || !check.reason.is_empty(), "{} gives no reason", check.ids);
                assert!(check.absolute.is_none() || check.percent.is_none(), "{}", check.ids);
            }
        }
    }
}
