//! Which checks are asked for.

use crate::error::ValidationError;
use crate::nearest::did_you_mean;
use crate::registry::Registry;

/// Checks by the fronts of their ids; every check where no front is given.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Selection(Vec<String>);

impl<S: AsRef<str>> FromIterator<S> for Selection {
    fn from_iter<I: IntoIterator<Item = S>>(fronts: I) -> Self {
        let given = fronts.into_iter().map(|front| front.as_ref().to_owned());
        Self(given.filter(|front| !front.is_empty()).collect())
    }
}

impl From<&str> for Selection {
    /// One front; all checks if it is empty.
    fn from(front: &str) -> Self {
        [front].into_iter().collect()
    }
}

impl From<&[String]> for Selection {
    fn from(fronts: &[String]) -> Self {
        fronts.iter().collect()
    }
}

impl Selection {
    /// Whether every check is asked for.
    pub fn is_everything(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a check is asked for.
    pub(crate) fn holds(&self, id: &str) -> bool {
        self.is_everything() || self.0.iter().any(|front| id.starts_with(front.as_str()))
    }

    /// Whether a check of a suite may be asked for.
    pub(crate) fn concerns(&self, suite: &str) -> bool {
        let prefix = format!("{suite}.");
        let concerns =
            |front: &String| prefix.starts_with(front.as_str()) || front.starts_with(&prefix);
        self.is_everything() || self.0.iter().any(concerns)
    }

    /// That every front begins the id of a check.
    ///
    /// # Errors
    /// [`ValidationError::NoSuchCheck`] for the first that does not.
    pub(crate) fn check(&self, registry: &Registry) -> Result<(), ValidationError> {
        for front in &self.0 {
            let one = Self(vec![front.clone()]);
            if !registry.suite.iter().any(|suite| one.concerns(&suite.name)) {
                let names = registry.suite.iter().map(|suite| suite.name.as_str());
                let hint = did_you_mean(front, names);
                return Err(ValidationError::NoSuchCheck { front: front.clone(), hint });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fronts_choose_suites_and_checks() {
        let some: Selection = ["table3.lumped", "fe.sets.mirror"].into_iter().collect();
        assert!(
            some.holds("table3.lumped.2") && some.holds("fe.sets.mirror") && !some.holds("fe.sets")
        );
        assert!(some.concerns("fe.sets") && some.concerns("table3.lumped"));
        assert!(!some.concerns("table2.lumped"));
        assert!(
            Selection::from("").is_everything() && Selection::from("").holds("sweep.order.five")
        );
        let registry = Registry::load().unwrap();
        some.check(&registry).unwrap();
        let slip = Selection::from("table3.lumpd").check(&registry).unwrap_err().to_string();
        assert_eq!(slip, "`table3.lumpd`: no check's id starts so; did you mean `table3.lumped`?");
    }
}
