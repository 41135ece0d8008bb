//! The study file.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use gearset::{Scene, read_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::error::StudyError;
use super::quantity::{Quantity, QuantityInput};
use super::setting::{Choices, ContactSolver, Setting, StudyIntegrator, StudyModel};
use super::truth::{Route, RouteInput};
use crate::scene_keys::scene_with;
use crate::sweep::SteadyMethod;

/// Longest study file or scene that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

/// Fewest rounds: a median and quartiles of less mean nothing.
const LEAST_ROUNDS: usize = 3;

/// Which part of the time of a setting is its cost.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum CostKind {
    /// From the scene to the number: meshing and solving the gears, contact tables, and the experiment.
    #[default]
    Whole,
    /// The experiment alone, gears and tables being there: what each further load or speed costs.
    Solution,
}

/// A struct with the fields of [`Choices`] beside its own, since serde cannot flatten and refuse unknown keys at once.
macro_rules! with_choices {
    ($(#[$doc:meta])* struct $name:ident { $($field:ident: $type:ty,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, PartialEq, Deserialize)]
        #[serde(deny_unknown_fields)]
        pub(super) struct $name {
            $(pub(super) $field: $type,)*
            #[serde(default)]
            model: StudyModel,
            #[serde(default)]
            keys: Table,
            #[serde(default)]
            steady_method: SteadyMethod,
            steady_tolerance: Option<f64>,
            table_size: Option<usize>,
            #[serde(default)]
            contact_solver: ContactSolver,
            integrator: Option<StudyIntegrator>,
        }

        impl $name {
            pub(super) fn choices(&self) -> Choices {
                Choices {
                    model: self.model,
                    keys: self.keys.clone(),
                    steady_method: self.steady_method,
                    steady_tolerance: self.steady_tolerance,
                    table_size: self.table_size,
                    contact_solver: self.contact_solver,
                    integrator: self.integrator,
                }
            }
        }
    };
}
pub(super) use with_choices;

with_choices! {
    /// `[[setting]]`.
    struct SettingInput {
        name: String,
        group: Option<String>,
    }
}

with_choices! {
    /// `[[series]]`: one setting for each value of one key, coarse to fine unless it says `refines = false`.
    struct SeriesInput {
        name: String,
        key: String,
        values: Vec<Value>,
        refines: Option<bool>,
    }
}

/// What a study file says.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Input {
    format: u32,
    title: String,
    scene: PathBuf,
    sun_torque_nm: Option<f64>,
    tolerance_percent: f64,
    rounds: Option<usize>,
    #[serde(default)]
    cost: CostKind,
    #[serde(default)]
    keys: Table,
    quantity: Vec<QuantityInput>,
    truth: Vec<RouteInput>,
    #[serde(default)]
    setting: Vec<SettingInput>,
    #[serde(default)]
    series: Vec<SeriesInput>,
}

/// A study, read and checked: every setting has a valid scene.
#[derive(Debug, Clone)]
pub struct StudyFile {
    pub(super) title: String,
    pub(super) sun_torque_nm: Option<f64>,
    pub(super) tolerance_percent: f64,
    pub(super) rounds: usize,
    pub(super) cost: CostKind,
    /// The scene with the keys of the study.
    pub(super) scene: Scene,
    pub(super) keys: Table,
    pub(super) quantities: Vec<Quantity>,
    pub(super) routes: Vec<Route>,
    pub(super) settings: Vec<Setting>,
}

impl StudyFile {
    /// Reads a study file; paths in it are relative to its folder.
    ///
    /// # Errors
    /// If a file cannot be read, the text is not TOML, a key is unknown, absent or of a value that is not allowed, or the
    /// scene of a setting is not valid.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = read(path, "FILE")?;
        Self::from_toml(&text, path.parent().unwrap_or(Path::new("")))
    }

    /// The same from text; `folder` is where its relative paths begin.
    ///
    /// # Errors
    /// As [`StudyFile::read`].
    pub fn from_toml(text: &str, folder: &Path) -> Result<Self, StudyError> {
        let input: Input =
            toml::from_str(text).map_err(|e| StudyError::Syntax(e.to_string().trim().into()))?;
        input.check()?;
        let quantities: Vec<Quantity> =
            input.quantity.iter().map(QuantityInput::quantity).collect::<Result<_, _>>()?;
        distinct("quantity", quantities.iter().map(|q| q.name.as_str()))?;
        let text = read(&folder.join(&input.scene), "scene")?;
        let base: Table =
            text.parse().map_err(|e: toml::de::Error| StudyError::Syntax(e.to_string()))?;
        let of = || "the study".to_owned();
        let scene = scene_with(&base, &[&input.keys])
            .map_err(|source| StudyError::Scene { of: of(), source })?;
        let settings = input.settings(&base)?;
        distinct("setting", settings.iter().map(|s| s.name.as_str()))?;
        let route = |route: &RouteInput| route.route(&quantities, (&base, &input.keys), folder);
        let routes = input.truth.iter().map(route).collect::<Result<Vec<_>, _>>()?;
        distinct("truth", routes.iter().map(|r| r.name.as_str()))?;
        for (k, quantity) in quantities.iter().enumerate() {
            if !routes.iter().any(|route| route.is_for(k)) {
                let allowed = format!("a route to the truth of quantity {:?}", quantity.name);
                return Err(StudyError::key("truth", "absent", allowed));
            }
        }
        Ok(Self {
            title: input.title,
            sun_torque_nm: input.sun_torque_nm,
            tolerance_percent: input.tolerance_percent,
            rounds: input.rounds.unwrap_or(ROUNDS),
            cost: input.cost,
            scene,
            keys: input.keys,
            quantities,
            routes,
            settings,
        })
    }

    /// The same with another number of rounds.
    ///
    /// # Errors
    /// If they are fewer than three.
    pub fn with_rounds(self, rounds: usize) -> Result<Self, StudyError> {
        rounds_within(rounds)?;
        Ok(Self { rounds, ..self })
    }
}

/// Rounds unless the file says otherwise.
const ROUNDS: usize = 5;

fn rounds_within(rounds: usize) -> Result<(), StudyError> {
    if (LEAST_ROUNDS..=999).contains(&rounds) {
        return Ok(());
    }
    let allowed = format!("from {LEAST_ROUNDS} to 999, a median and quartiles need that many");
    Err(StudyError::key("rounds", rounds, allowed))
}

impl Input {
    fn check(&self) -> Result<(), StudyError> {
        if self.format != 1 {
            return Err(StudyError::key("format", self.format, "1"));
        }
        if !(self.tolerance_percent > 0.0 && self.tolerance_percent <= 100.0) {
            let allowed = "a number above 0, at most 100";
            return Err(StudyError::key("tolerance_percent", self.tolerance_percent, allowed));
        }
        if let Some(torque) = self.sun_torque_nm.filter(|t| !t.is_finite() || *t == 0.0) {
            return Err(StudyError::key("sun_torque_nm", torque, "a finite number other than 0"));
        }
        rounds_within(self.rounds.unwrap_or(ROUNDS))?;
        let entries = [("quantity", self.quantity.len()), ("truth", self.truth.len())];
        for (key, count) in entries {
            if count == 0 {
                return Err(StudyError::key(key, "empty", format!("one [[{key}]] or more")));
            }
        }
        if self.setting.is_empty() && self.series.is_empty() {
            let allowed = "[[setting]] or [[series]], settings to be compared";
            return Err(StudyError::key("setting", "absent", allowed));
        }
        Ok(())
    }

    fn settings(&self, base: &Table) -> Result<Vec<Setting>, StudyError> {
        let mut list = Vec::new();
        for own in &self.setting {
            let group = own.group.clone().unwrap_or_else(|| "settings".into());
            let named = (own.name.clone(), group, None);
            list.push(Setting::new(named, own.choices(), (base, &self.keys))?);
        }
        for (number, series) in self.series.iter().enumerate() {
            let of = format!("series {:?}", series.name);
            if series.values.len() < 2 {
                let key = format!("{of}.values");
                return Err(StudyError::key(key, series.values.len(), "two values or more"));
            }
            for (place, value) in series.values.iter().enumerate() {
                let choices = series.choices().with(&series.key, value, &of)?;
                let shown = shown(value);
                let name = format!("{}: {shown}", series.name);
                let place = series.refines.unwrap_or(true).then_some((number, place));
                let named = (name, series.name.clone(), place);
                list.push(Setting::new(named, choices, (base, &self.keys))?);
            }
        }
        Ok(list)
    }
}

/// A value in the name of a setting.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Float(x) if x.abs() < 1e-2 => format!("{x:e}"),
        other => other.to_string(),
    }
}

/// Refuses a name that occurs twice.
fn distinct<'n>(of: &str, names: impl Iterator<Item = &'n str>) -> Result<(), StudyError> {
    let mut seen = HashSet::new();
    for name in names {
        if !seen.insert(name) {
            let allowed = "names that differ from one another";
            return Err(StudyError::key(format!("{of}.name"), format!("{name:?} twice"), allowed));
        }
    }
    Ok(())
}

/// Text of a file; `key` names it.
pub(super) fn read(path: &Path, key: &str) -> Result<String, StudyError> {
    read_text(path, MOST_BYTES).map_err(|cause| StudyError::File {
        key: key.into(),
        path: path.to_owned(),
        cause,
    })
}
