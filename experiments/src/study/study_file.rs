//! The study file.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use scene::{Scene, read_text};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::error::StudyError;
use super::experiment::Action;
use super::key_types;
use super::quantity::{Quantity, QuantityInput};
use super::setting::{Choices, ContactSolver, Setting, StudyIntegrator, StudyModel, number};
use super::truth::{Route, RouteInput};
use crate::scene_keys::scene_with;
use crate::sweep::SteadyMethod;

/// Longest study file or scene that is read, bytes.
const MOST_BYTES: u64 = 1_000_000;

/// Fewest rounds: a median and quartiles of less mean nothing.
pub(super) const LEAST_ROUNDS: usize = 3;

/// Most rounds.
pub(super) const MOST_ROUNDS: usize = 999;

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
    /// If a file cannot be read, the text is not TOML, a key is unknown, absent or of a value that is not allowed, or
    /// the scene of a setting is not valid.
    pub fn read(path: &Path) -> Result<Self, StudyError> {
        let text = read(path, "FILE")?;
        Self::from_toml(&text, path.parent().unwrap_or(Path::new("")))
    }

    /// The same from text; `folder` is where its relative paths begin.
    ///
    /// # Errors
    /// As [`StudyFile::read`].
    pub fn from_toml(text: &str, folder: &Path) -> Result<Self, StudyError> {
        let input = Input::read(text)?;
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
        sized(&scene, "sun_torque_nm", input.sun_torque_nm)?;
        for own in &quantities {
            let key = format!("quantity {:?}.sun_torque_nm", own.name);
            sized(&scene, &key, own.experiment.sun_torque_nm)?;
            if let Action::PeakRatio { reference_nm, .. } = own.experiment.action {
                let key = format!("quantity {:?}.reference_torque_nm", own.name);
                sized(&scene, &key, Some(reference_nm))?;
            }
        }
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
    if (LEAST_ROUNDS..=MOST_ROUNDS).contains(&rounds) {
        return Ok(());
    }
    let allowed = format!(
        "a whole number from {LEAST_ROUNDS} to {MOST_ROUNDS}: a median and quartiles need that many"
    );
    Err(StudyError::key("rounds", rounds, allowed))
}

/// Refuses a torque on the sun, N m, under which teeth give way by more than a module or less than a millionth of one.
fn sized(scene: &Scene, key: &str, torque_nm: Option<f64>) -> Result<(), StudyError> {
    let Some(torque) = torque_nm else { return Ok(()) };
    let size = scene.size_of_sun_torque(torque);
    match size.and_then(|size| size.refusal(torque, "N·m")) {
        Some(reason) => Err(StudyError::Load { key: key.into(), reason }),
        None => Ok(()),
    }
}

impl Input {
    /// What a text says; misspelt keys, wrong types and absent keys are refused.
    fn read(text: &str) -> Result<Self, StudyError> {
        let syntax = |e: &toml::de::Error| StudyError::Syntax(e.to_string().trim().into());
        let refusal = match toml::from_str(text) {
            Ok(input) => return Ok(input),
            Err(refusal) => refusal,
        };
        // A misspelt key is told with its line; a wrong type or an absent key in the words of scenes.
        if !refusal.message().starts_with("unknown field") {
            key_types::check(&text.parse().map_err(|e| syntax(&e))?)?;
        }
        Err(syntax(&refusal))
    }

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
            series.check(&of)?;
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

impl SeriesInput {
    /// Two values or more; numbers of a series that refines go from coarse to fine, because the guarded error of a
    /// setting is the largest of it and of all finer ones.
    fn check(&self, of: &str) -> Result<(), StudyError> {
        named("series", &self.name)?;
        let refused = |allowed: &str| {
            let shown: Vec<String> = self.values.iter().map(Value::to_string).collect();
            let value = format!("[{}]", shown.join(", "));
            Err(StudyError::key(format!("{of}.values"), value, allowed))
        };
        if self.values.len() < 2 {
            return refused("two values or more");
        }
        let numbers: Option<Vec<f64>> = self.values.iter().map(number).collect();
        let (Some(numbers), true) = (numbers, self.refines.unwrap_or(true)) else {
            return Ok(());
        };
        // A tolerance is finer the smaller it is.
        let is_tolerance = self.key == "steady_tolerance";
        let is_finer = |w: &[f64]| if is_tolerance { w[1] < w[0] } else { w[0] < w[1] };
        match (numbers.windows(2).all(is_finer), is_tolerance) {
            (true, _) => Ok(()),
            (false, true) => refused("descending values, from coarse to fine, or refines = false"),
            (false, false) => refused("ascending values, from coarse to fine, or refines = false"),
        }
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

/// Refuses an empty name.
fn named(of: &str, name: &str) -> Result<(), StudyError> {
    match name.trim().is_empty() {
        true => Err(StudyError::key(
            format!("{of}.name"),
            format!("{name:?}"),
            "a name that is not empty",
        )),
        false => Ok(()),
    }
}

/// Refuses a name that is empty or occurs twice.
fn distinct<'n>(of: &str, names: impl Iterator<Item = &'n str>) -> Result<(), StudyError> {
    let mut seen = HashSet::new();
    for name in names {
        named(of, name)?;
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
