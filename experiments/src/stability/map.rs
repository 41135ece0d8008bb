//! What a stability map is, and which there are.

use gearset::{Scene, SceneKind};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    bouncing_bar, contact_cells, contact_loss, explicit_step, hammering, integrators, lag,
    linear_kinematics, locking, mode_types, parametric, resolution, spacing, transients,
    truncated_stiffness,
};

/// The maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum MapName {
    /// Spectral radius, period error and numerical damping over ω Δt.
    Integrators,
    /// Central difference at Δt·ω_max = 2.
    ExplicitStep,
    /// A bar that bounces on rigid ground.
    BouncingBar,
    /// Tongues of parametric instability.
    Parametric,
    /// Types of modes with one planet heavier.
    ModeTypes,
    /// A gear pair that hammers under a light torque.
    Hammering,
    /// Loss of contact over torque and damping.
    ContactLoss,
    /// Contact cells and contact solvers on Hertz's problem.
    ContactCells,
    /// Locking of quadrilaterals in bending.
    Locking,
    /// Too few steps in a mesh cycle.
    Resolution,
    /// Unfinished transients that pass for steady states.
    Transients,
    /// Mesh stiffness cut off after some harmonics.
    TruncatedStiffness,
    /// The lag of damped flexibility without inertia, by rule of integration.
    Lag,
    /// Kinematics linear about the unloaded and the loaded configuration, over windup.
    LinearKinematics,
    /// Splits and types of modes with planets displaced in angle.
    Spacing,
}

impl MapName {
    /// All of them.
    pub const ALL: [Self; 15] = [
        Self::Integrators,
        Self::ExplicitStep,
        Self::BouncingBar,
        Self::Parametric,
        Self::ModeTypes,
        Self::Hammering,
        Self::ContactLoss,
        Self::ContactCells,
        Self::Locking,
        Self::Resolution,
        Self::Transients,
        Self::TruncatedStiffness,
        Self::Lag,
        Self::LinearKinematics,
        Self::Spacing,
    ];

    /// As on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Integrators => "integrators",
            Self::ExplicitStep => "explicit-step",
            Self::BouncingBar => "bouncing-bar",
            Self::Parametric => "parametric",
            Self::ModeTypes => "mode-types",
            Self::Hammering => "hammering",
            Self::ContactLoss => "contact-loss",
            Self::ContactCells => "contact-cells",
            Self::Locking => "locking",
            Self::Resolution => "resolution",
            Self::Transients => "transients",
            Self::TruncatedStiffness => "truncated-stiffness",
            Self::Lag => "lag",
            Self::LinearKinematics => "linear-kinematics",
            Self::Spacing => "spacing",
        }
    }

    /// What its border means.
    pub fn meaning(self) -> &'static str {
        match self {
            Self::Integrators => {
                "what one time step does to an oscillation: above a spectral radius of 1 it grows without cause, and below 1 it \
                 is damped without cause"
            }
            Self::ExplicitStep => {
                "beyond Δt·ω_max = 2 the explicit central difference grows without bound, however small the motion at the \
                 highest frequency"
            }
            Self::BouncingBar => {
                "a scheme that is stable for every linear motion may still gain energy each time a contact opens"
            }
            Self::Parametric => {
                "between the borders of a tongue the varying mesh stiffness feeds a vibration that grows from nothing"
            }
            Self::ModeTypes => {
                "with one planet heavier than this a mode has lost its type: it is listed as mixed, and further on it is \
                 shared by kinds"
            }
            Self::Hammering => {
                "teeth that part and meet again: with fewer steps in a contact than this the motion gains or loses energy \
                 that no damping and no torque accounts for"
            }
            Self::ContactLoss => {
                "with less damping than this teeth part at the resonance, then several motions are possible at one speed, \
                 then the backside flanks touch"
            }
            Self::ContactCells => {
                "with fewer contact cells in the loaded half-width than this pressures are those of the grid; solvers are \
                 held against one another where they could cycle or lose accuracy"
            }
            Self::Locking => {
                "bilinear elements resist bending by a shear that is not there: teeth come out too stiff, the more the \
                 longer the elements"
            }
            Self::Resolution => {
                "with fewer steps in a mesh cycle than this a harmonic resonates at the wrong speed, is taken for another, or \
                 is not cancelled by planet phasing"
            }
            Self::Transients => {
                "a march that ends when cycles change by less than a tolerance may be off by far more than that: by up to \
                 1/(2πζl) times as much at a resonance of harmonic l"
            }
            Self::TruncatedStiffness => {
                "a mesh stiffness of some harmonics only has no hand-over between tooth pairs: resonances of the harmonics \
                 left out are missing"
            }
            Self::Lag => {
                "flexibility without inertia follows its load within microseconds: with steps longer than that the \
                 trapezoidal rule makes it ring"
            }
            Self::LinearKinematics => {
                "bearings give way under the load by far more than teeth: beyond this windup, kinematics linear about the \
                 unloaded set, or about the loaded one, are more than 1 % off in harmonics at rest and natural frequencies"
            }
            Self::Spacing => {
                "with a planet displaced in angle by this a mode has lost its type, and modes of equal frequency have split to \
                 first or second order by the pattern of the displacement"
            }
        }
    }

    /// Whether it is computed for a scene.
    pub fn is_of_a_scene(self) -> bool {
        matches!(
            self,
            Self::ExplicitStep
                | Self::Parametric
                | Self::ModeTypes
                | Self::ContactLoss
                | Self::Transients
                | Self::LinearKinematics
                | Self::Spacing
        )
    }
}

/// One border, or one number along it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Border {
    /// Of what: scheme, modes or tongue.
    pub of: String,
    /// What was measured.
    pub quantity: String,
    /// Unit; empty for a ratio.
    pub unit: String,
    /// From the program's own steps or solutions; absent where nothing could be found.
    pub measured: Option<f64>,
    /// From theory; absent where there is none.
    pub theory: Option<f64>,
    /// 100 (measured − theory)/theory; absent without both, or where theory is 0.
    pub difference_percent: Option<f64>,
}

impl Border {
    pub(super) fn new(
        of: impl Into<String>,
        quantity: impl Into<String>,
        unit: &str,
        measured: Option<f64>,
        theory: Option<f64>,
    ) -> Self {
        let difference_percent =
            measured.zip(theory).filter(|(_, t)| *t != 0.0).map(|(m, t)| 100.0 * (m - t) / t);
        let (of, quantity, unit) = (of.into(), quantity.into(), unit.into());
        Self { of, quantity, unit, measured, theory, difference_percent }
    }
}

/// A curve of the map's figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapCurve {
    /// Panel of the figure it belongs to.
    pub panel: String,
    /// What it shows.
    pub name: String,
    /// Whether it is theory rather than measured.
    pub is_theory: bool,
    /// Whether it is drawn as unconnected points.
    pub is_points: bool,
    /// (x, y).
    pub points: Vec<(f64, f64)>,
}

/// A map: its borders and the curves of its figure.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StabilityMap {
    /// Name as on the command line.
    pub map: String,
    /// One sentence: what the border means.
    pub meaning: String,
    /// System it was computed for.
    pub system: String,
    /// Title of the x axis.
    pub x_axis: String,
    /// Borders.
    pub borders: Vec<Border>,
    /// Curves.
    pub curves: Vec<MapCurve>,
}

/// Why a map cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// A step in time.
    #[error(transparent)]
    Integrator(#[from] dynamics::integrators::IntegratorError),
    /// The lumped set of the scene.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
    /// Steady states and branches of them.
    #[error(transparent)]
    Experiment(#[from] crate::error::ExperimentError),
    /// The scene that `scene new` writes, changed for a guard.
    #[error("the template of scenes: {0}")]
    Template(String),
    /// A scene without operating point.
    #[error("[operation] is absent: steps per mesh cycle need a mesh frequency")]
    NoOperation,
    /// A gear pair where the map is of a planetary set.
    #[error("`kind` is \"gear_pair\": the map {0} is of planetary sets, \"planetary\" is needed")]
    NotPlanetary(&'static str),
}

/// Computes a map; `scene` is used by those for which [`MapName::is_of_a_scene`] holds.
///
/// # Errors
/// If the scene lacks what the map needs, or a step or an eigenproblem fails.
pub fn stability_map(which: MapName, scene: &Scene) -> Result<StabilityMap, MapError> {
    let is_of_planets = matches!(
        which,
        MapName::Parametric | MapName::ModeTypes | MapName::LinearKinematics | MapName::Spacing
    );
    if is_of_planets && scene.kind == SceneKind::GearPair {
        return Err(MapError::NotPlanetary(which.name()));
    }
    match which {
        MapName::Integrators => integrators::map(),
        MapName::ExplicitStep => explicit_step::map(scene),
        MapName::BouncingBar => bouncing_bar::map(),
        MapName::Parametric => parametric::map(scene),
        MapName::ModeTypes => mode_types::map(scene),
        MapName::Hammering => hammering::map(),
        MapName::ContactLoss => contact_loss::map(scene),
        MapName::ContactCells => contact_cells::map(),
        MapName::Locking => locking::map(),
        MapName::Resolution => resolution::map(),
        MapName::Transients => transients::map(scene),
        MapName::TruncatedStiffness => truncated_stiffness::map(),
        MapName::Lag => lag::map(),
        MapName::LinearKinematics => linear_kinematics::map(scene),
        MapName::Spacing => spacing::map(scene),
    }
}

/// Several maps side by side, in the order in which they are named.
///
/// # Errors
/// As [`stability_map`].
pub fn stability_maps(which: &[MapName], scene: &Scene) -> Result<Vec<StabilityMap>, MapError> {
    which.par_iter().map(|own| stability_map(*own, scene)).collect()
}

/// A map without borders and curves.
pub(super) fn empty(which: MapName, system: impl Into<String>, x_axis: &str) -> StabilityMap {
    StabilityMap {
        map: which.name().into(),
        meaning: which.meaning().into(),
        system: system.into(),
        x_axis: x_axis.into(),
        borders: Vec::new(),
        curves: Vec::new(),
    }
}
