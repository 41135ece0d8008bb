//! What a results folder can be asked.

use serde::Serialize;

use crate::error::ValidationError;
use crate::model_kind::ModelKind;
use crate::reference::Reference;
use crate::results::folder::ResultsFolder;
use crate::selection::Selection;
use crate::suites;
use crate::verdict::NotAsked;

/// Suites that tables answer, and what the others lack.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Questions {
    /// In the order of the report.
    pub asked: Vec<AskedSuite>,
    /// Suites that cannot be asked, one entry for each scene or pair of scenes.
    pub not_asked: Vec<NotAsked>,
}

/// A suite that tables answer.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, schemars::JsonSchema)]
pub struct AskedSuite {
    /// Its name in the registry.
    pub suite: String,
    /// Number of its checks that can be asked.
    pub checks: usize,
    /// Whether it judges that kind of model; if not, its rows are shown and cannot fail.
    pub judged: bool,
}

impl ResultsFolder {
    /// Suites that the tables answer, and what the others lack; `kind` as in [`Self::kind`].
    ///
    /// # Errors
    /// As [`crate::judge_model`], but for results that no suite can be asked of: then there is no suite in `asked`.
    pub fn questions(&self, kind: Option<ModelKind>) -> Result<Questions, ValidationError> {
        let reference = Reference::load()?;
        let kind = self.kind(kind);
        let modes = self.completed_modes(kind)?;
        let tables = self.recorded_with(&modes);
        let models = suites::Models {
            kind: Some(kind),
            modal: Some(&tables),
            at_rest: Some(&tables),
            in_time: Some(&tables),
            stiffness: Some(&tables),
            peaks: Some(&tables),
        };
        let (mut checks, mut not_asked) =
            suites::foreign(&reference, &models, &Selection::default())?;
        checks.extend(self.beside(kind, &modes, &tables, &reference, &mut not_asked)?);
        let mut asked: Vec<AskedSuite> = Vec::new();
        for check in &checks {
            let suite = reference.registry.suite_of(&check.id).map_or("", |s| s.name.as_str());
            match asked.iter_mut().find(|asked| asked.suite == suite) {
                Some(asked) => asked.checks += 1,
                None => asked.push(AskedSuite {
                    suite: suite.to_owned(),
                    checks: 1,
                    judged: reference.registry.judges(&check.id, kind),
                }),
            }
        }
        Ok(Questions { asked, not_asked })
    }
}
