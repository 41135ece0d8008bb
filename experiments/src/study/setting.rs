//! Settings: scene keys, model, and how answers are found.

use dynamics::benchmark_subjects::Scheme;
use fe_contact::complementarity::{ActiveSet, ComplementaritySolver, Lemke};
use scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::error::StudyError;
use crate::scene_keys::{flat, merge, nested, scene_with};
use crate::sweep::SteadyMethod;

/// The model that answers.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StudyModel {
    /// FE/contact at the fidelity of the scene.
    #[default]
    FeContact,
    /// The lumped model: constant mesh stiffness for natural frequencies, mesh forces tabulated by FE/contact in time.
    Lumped,
    /// The lumped model whose mesh stiffness in time is prescribed: at each phase the secant that FE/contact has under
    /// the even share of the load, whatever the vibration, and forces act along the lines of action. For natural
    /// frequencies the same as
    /// `lumped`.
    LumpedPrescribed,
    /// The same with the side loads of the tabulated forces: what corner contacts and the slopes of deformed flanks
    /// press beside the lines of action under the mean torque, by phase.
    LumpedPrescribedSideLoads,
    /// The lumped model's steady states by harmonic balance, without a time step: resonant peaks of rotations.
    HarmonicBalance,
}

impl StudyModel {
    /// Whether it is a lumped model in time.
    pub(super) fn is_lumped(self) -> bool {
        matches!(self, Self::Lumped | Self::LumpedPrescribed | Self::LumpedPrescribedSideLoads)
    }
}

/// The rule by which the lumped model is stepped, with the parameters of [`Scheme::ALL`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StudyIntegrator {
    /// Newmark's method with γ = ½, β = ¼.
    AverageAcceleration,
    /// HHT-α with α = −0.1.
    HhtAlpha,
    /// Generalised-α with ρ∞ = 0.8.
    GeneralisedAlpha,
    /// Bathe's composite scheme.
    Bathe,
    /// Contact-stabilised Newmark; the same rule as average acceleration where no obstacle is touched.
    ContactStabilised,
    /// Moreau–Jean with θ = ½; likewise.
    MoreauJean,
    /// Explicit central difference.
    CentralDifference,
}

impl StudyIntegrator {
    pub(super) fn scheme(self) -> Scheme {
        let [average, hht, generalised, bathe, stabilised, moreau, central] = Scheme::ALL;
        match self {
            Self::AverageAcceleration => average,
            Self::HhtAlpha => hht,
            Self::GeneralisedAlpha => generalised,
            Self::Bathe => bathe,
            Self::ContactStabilised => stabilised,
            Self::MoreauJean => moreau,
            Self::CentralDifference => central,
        }
    }
}

/// The solver of contact at rest.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ContactSolver {
    /// Warm-started active set.
    #[default]
    ActiveSet,
    /// Lemke's complementary pivoting.
    Lemke,
    /// Interior-point method.
    #[cfg(feature = "interior_point")]
    InteriorPoint,
}

impl ContactSolver {
    pub(super) fn solver(self) -> &'static (dyn ComplementaritySolver + Sync) {
        match self {
            Self::ActiveSet => &ActiveSet,
            Self::Lemke => &Lemke,
            #[cfg(feature = "interior_point")]
            Self::InteriorPoint => &fe_contact::complementarity::InteriorPoint,
        }
    }
}

/// What a setting, a series or a route to the truth says beside its name.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Choices {
    /// Model.
    #[serde(default)]
    pub(super) model: StudyModel,
    /// Scene keys laid over those of the study.
    #[serde(default)]
    pub(super) keys: Table,
    /// How steady states are found.
    #[serde(default)]
    pub(super) steady_method: SteadyMethod,
    /// Largest change from cycle to cycle of a steady state over its vibration.
    pub(super) steady_tolerance: Option<f64>,
    /// How often contact tables in time are laid out for twice the load.
    pub(super) table_size: Option<usize>,
    /// Solver of contact at rest.
    #[serde(default)]
    pub(super) contact_solver: ContactSolver,
    /// Rule by which the lumped model is stepped; its own average acceleration if left out.
    pub(super) integrator: Option<StudyIntegrator>,
}

/// Keys of a series that are no scene keys.
const OWN_KEYS: [&str; 2] = ["steady_tolerance", "table_size"];

impl Choices {
    /// The same with one key more: a scene key with dots, `steady_tolerance` or `table_size`. `of` names the table that
    /// the values are in.
    pub(super) fn with(&self, key: &str, value: &Value, of: &str) -> Result<Self, StudyError> {
        let mut own = self.clone();
        let refused = |allowed: &str| StudyError::key(format!("{of}.values"), value, allowed);
        match key {
            "steady_tolerance" => {
                own.steady_tolerance = Some(number(value).ok_or_else(|| refused("numbers"))?);
            }
            "table_size" => {
                let size = value.as_integer().and_then(|n| usize::try_from(n).ok());
                own.table_size = Some(size.ok_or_else(|| refused("whole numbers from 0"))?);
            }
            path if path.contains('.') => merge(&mut own.keys, &nested(path, value.clone())),
            other => {
                let allowed = format!(
                    "a scene key with its table, as fe_contact.contact_cells, or one of {}",
                    OWN_KEYS.join(", ")
                );
                return Err(StudyError::key(format!("{of}.key"), format!("{other:?}"), allowed));
            }
        }
        Ok(own)
    }

    /// Checks what is not a matter of the scene; `of` names the table.
    pub(super) fn check(&self, of: &str) -> Result<(), StudyError> {
        let tolerance = self.tolerance();
        if !(1e-12..=0.1).contains(&tolerance) {
            let allowed = "a number from 1e-12 to 0.1";
            return Err(StudyError::key(format!("{of}.steady_tolerance"), tolerance, allowed));
        }
        if self.integrator.is_some() && self.model != StudyModel::Lumped {
            let allowed = "only with model = \"lumped\": FE/contact has one rule of its own";
            return Err(StudyError::key(format!("{of}.integrator"), "given", allowed));
        }
        let size = self.size();
        if size >= crate::SIZES {
            let allowed = format!("a whole number from 0 to {}", crate::SIZES - 1);
            return Err(StudyError::key(format!("{of}.table_size"), size, allowed));
        }
        Ok(())
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.steady_tolerance.unwrap_or(TOLERANCE)
    }

    pub(super) fn size(&self) -> usize {
        self.table_size.unwrap_or(0)
    }

    /// What is chosen, as text: what is left out has its default.
    pub(super) fn described(&self) -> Vec<String> {
        let mut list = flat(&self.keys);
        let with = |name: &str, value: String| format!("{name} = {value}");
        match self.model {
            StudyModel::FeContact => {}
            StudyModel::Lumped => list.push(with("model", "\"lumped\"".into())),
            StudyModel::LumpedPrescribed => {
                list.push(with("model", "\"lumped_prescribed\"".into()));
            }
            StudyModel::LumpedPrescribedSideLoads => {
                list.push(with("model", "\"lumped_prescribed_side_loads\"".into()));
            }
            StudyModel::HarmonicBalance => {
                list.push(with("model", "\"harmonic_balance\"".into()));
            }
        }
        list.extend(self.integrator.map(|own| with("integrator", own.scheme().label())));
        if self.steady_method == SteadyMethod::Marching {
            list.push(with("steady_method", "\"marching\"".into()));
        }
        list.extend(self.steady_tolerance.map(|t| with("steady_tolerance", format!("{t:e}"))));
        list.extend(self.table_size.map(|n| with("table_size", n.to_string())));
        if self.contact_solver != ContactSolver::ActiveSet {
            list.push(with("contact_solver", format!("{:?}", self.contact_solver)));
        }
        list
    }
}

/// Tolerance of steady states unless a setting says otherwise.
const TOLERANCE: f64 = 1e-9;

/// A number, whole or not.
pub(super) fn number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64)).filter(|x| x.is_finite())
}

/// A setting that can be run.
#[derive(Debug, Clone)]
pub(super) struct Setting {
    pub(super) name: String,
    pub(super) group: String,
    /// Number of its series and place in it, coarse to fine.
    pub(super) place: Option<(usize, usize)>,
    pub(super) choices: Choices,
    pub(super) scene: Scene,
}

impl Setting {
    /// With the scene that results, or its faults.
    pub(super) fn new(
        (name, group, place): (String, String, Option<(usize, usize)>),
        choices: Choices,
        (base, study): (&Table, &Table),
    ) -> Result<Self, StudyError> {
        choices.check(&format!("setting {name}"))?;
        let scene = scene_with(base, &[study, &choices.keys])
            .map_err(|source| StudyError::Scene { of: format!("setting `{name}`"), source })?;
        if scene.dynamics.auto.is_some() {
            let allowed =
                "a fidelity by name: a study compares settings, and \"auto\" chooses them";
            let key = format!("dynamics.fidelity of setting `{name}`");
            return Err(StudyError::key(key, "\"auto\"", allowed));
        }
        Ok(Self { name, group, place, choices, scene })
    }
}
