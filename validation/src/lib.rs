#![doc = include_str!("../README.md")]

mod catalogue;
pub mod certified;
mod check;
mod compare;
mod drawn_set;
pub mod effects;
mod error;
mod glob;
mod judged;
mod kept_charts;
mod ledger;
mod likely_unit;
mod mode_type;
mod model_kind;
mod nearest;
mod own_truth;
pub mod parameter_bands;
mod progress;
mod published_table;
mod reference;
mod reference_file;
mod registry;
pub mod results;
mod selection;
mod suites;
pub mod variants;
mod verdict;
mod worst;

use results::Accepted;

pub use catalogue::{PublishedScene, scene};
pub use check::{Check, ReferenceKind, Status, Subject, Tolerance, Value};
pub use compare::{Comparison, ListedMode, Match, ModelMode, compare};
pub use drawn_set::drawn_set;
pub use error::ValidationError;
pub use judged::Judged;
pub use kept_charts::{KeptStudy, kept_maps, kept_studies};
pub use ledger::{Assumption, Figure, Ledger};
pub use likely_unit::LikelyUnit;
pub use model_kind::ModelKind;
pub use own_truth::{
    ExactPeak, ExactPeaks, FullSweep, FullSweepPoint, Ladder, LadderFidelity, MapCell,
    RotationalPeak, TorqueMap, TorquePeak, TorquePeaks,
};
pub use progress::Progress;
pub use published_table::Table;
pub use reference::{Frequencies, Miss, ModeTable, Reference};
pub use reference_file::ReferenceError;
pub use registry::{Asks, CheckEntry, ControlEntry, Registry, SuiteEntry};
pub use selection::Selection;
pub use suites::Models;
pub use suites::explained::{Step, steps};
pub use suites::fe::iso6336::iso6336_mean_stiffness;
pub use suites::statements::{Statement, judge};
pub use verdict::{NotAsked, Verdict};
pub use worst::{paired, peak_to_peak, worst};

/// How much to run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Profile {
    /// What a minute or two allows; the other checks are listed as not run.
    #[default]
    Quick,
    /// Everything.
    Full,
}

/// Runs the checks whose ids start with `only`, or all of them if it is empty.
///
/// # Errors
/// [`ValidationError::NoSuchCheck`] if no check's id starts so. Otherwise if the reference data, a scene of the
/// catalogue or a model cannot be used: a defect of the program, not a failed check.
pub fn validate(profile: Profile, only: impl Into<Selection>) -> Result<Verdict, ValidationError> {
    validate_with(profile, &only.into(), &|_| ())
}

/// The same; `progress` hears of every suite that is begun and finished.
///
/// # Errors
/// As [`validate`].
pub fn validate_with(
    profile: Profile,
    only: &Selection,
    progress: &(dyn Fn(Progress<'_>) + Sync),
) -> Result<Verdict, ValidationError> {
    let reference = Reference::load()?;
    only.check(&reference.registry)?;
    let checks = suites::all(&reference, profile, only, progress)?;
    let concerned: Vec<Miss> =
        reference.misses.iter().filter(|m| only.holds(&m.id)).cloned().collect();
    Ok(Verdict::new(checks, &concerned))
}

/// Asks a foreign model every question of the suites that it can answer, and judges the answers as our own: by the
/// same functions, reference data, tolerances and listed misses. Checks whose reference is of another kind of model
/// are shown and not judged; suites that could not be asked are listed with what they need.
///
/// # Errors
/// [`ValidationError::NoModel`] without a model, [`ValidationError::NoSuchCheck`] if no check's id starts as `only`
/// has it, [`ValidationError::NothingAsked`] if no suite could be asked, and [`ValidationError::Model`] with the
/// model's own error if it fails at a question that it takes.
pub fn judge_model(
    models: &Models<'_>,
    only: impl Into<Selection>,
) -> Result<Verdict, ValidationError> {
    judge_with(models, &only.into(), &Accepted::default(), false, &|_, _| Ok(Vec::new()))
}

/// The same with `further` checks, which may say more of what suites lack; `accepted` are rows that this model is known
/// to miss, beside those that are listed for the models of this project, and thresholds. Of tables (`are_tables`) what
/// is exact is asked to printed digits.
///
/// # Errors
/// As [`judge_model`].
pub(crate) fn judge_with(
    models: &Models<'_>,
    only: &Selection,
    accepted: &Accepted,
    are_tables: bool,
    further: &dyn Fn(&Reference, &mut Vec<NotAsked>) -> suites::Checks,
) -> Result<Verdict, ValidationError> {
    if models.is_empty() {
        return Err(ValidationError::NoModel);
    }
    let reference = Reference::load()?;
    only.check(&reference.registry)?;
    let (mut checks, mut not_asked) = suites::foreign(&reference, models, only)?;
    let more = further(&reference, &mut not_asked)?;
    checks.extend(more.into_iter().filter(|check| only.holds(&check.id)));
    not_asked.retain(|lack| only.concerns(&lack.suite));
    if checks.is_empty() {
        return Err(ValidationError::NothingAsked(not_asked));
    }
    let judges = |id: &str| models.kind.is_none_or(|kind| reference.registry.judges(id, kind));
    if are_tables {
        for check in &mut checks {
            if let Some(judged) = reference.as_table(check)? {
                *check = judged;
            }
        }
    }
    checks.iter_mut().for_each(|check| accepted.judge(check));
    let misses = [&accepted.misses[..], &reference.misses].concat();
    Ok(Verdict::of_results(checks, &misses, judges, not_asked))
}
