//! What a stability map is, and which there are.

use rayon::prelude::*;
use scene::{Scene, SceneKind};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    bouncing_bar, contact_cells, contact_loss, explicit_step, hammering, integrators, lag,
    linear_kinematics, locking, mode_types, parametric, resolution, spacing, transients,
    truncated_stiffness,
};

/// A map: what it is called, what it is about, and what computes it.
#[derive(Debug)]
pub struct Map {
    /// As on the command line.
    pub name: &'static str,
    /// What it shows, in a line.
    pub about: &'static str,
    /// What its border means.
    pub meaning: &'static str,
    pub(super) of: MapOf,
}

/// What a map is computed for.
#[derive(Debug)]
pub(super) enum MapOf {
    /// A system of its own.
    Nothing(fn() -> Result<StabilityMap, MapError>),
    /// A scene.
    Scene(fn(&Scene) -> Result<StabilityMap, MapError>),
    /// A scene of a planetary set.
    Planets(fn(&Scene) -> Result<StabilityMap, MapError>),
}

/// The maps that there are.
pub static MAPS: [&Map; 15] = [
    &integrators::MAP,
    &explicit_step::MAP,
    &bouncing_bar::MAP,
    &parametric::MAP,
    &mode_types::MAP,
    &hammering::MAP,
    &contact_loss::MAP,
    &contact_cells::MAP,
    &locking::MAP,
    &resolution::MAP,
    &transients::MAP,
    &truncated_stiffness::MAP,
    &lag::MAP,
    &linear_kinematics::MAP,
    &spacing::MAP,
];

impl Map {
    /// The map of that name.
    pub fn named(name: &str) -> Option<&'static Self> {
        MAPS.into_iter().find(|map| map.name == name)
    }

    /// Whether it is computed for a scene.
    pub fn is_of_a_scene(&self) -> bool {
        !matches!(self.of, MapOf::Nothing(_))
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

impl StabilityMap {
    /// A map without borders and curves.
    pub(super) fn of(which: &Map, system: impl Into<String>, x_axis: &str) -> Self {
        Self {
            map: which.name.into(),
            meaning: which.meaning.into(),
            system: system.into(),
            x_axis: x_axis.into(),
            borders: Vec::new(),
            curves: Vec::new(),
        }
    }

    /// Adds a border, or one number along it, of no unit, for which there is no theory.
    pub(super) fn measure(
        &mut self,
        of: impl Into<String>,
        quantity: impl Into<String>,
        measured: impl Into<Option<f64>>,
    ) {
        self.compare(of, quantity, measured, None);
    }

    /// The same with theory beside it.
    pub(super) fn compare(
        &mut self,
        of: impl Into<String>,
        quantity: impl Into<String>,
        measured: impl Into<Option<f64>>,
        theory: Option<f64>,
    ) {
        self.compare_in("", of, quantity, measured, theory);
    }

    /// The same in a unit.
    pub(super) fn compare_in(
        &mut self,
        unit: &str,
        of: impl Into<String>,
        quantity: impl Into<String>,
        measured: impl Into<Option<f64>>,
        theory: Option<f64>,
    ) {
        let measured = measured.into();
        let difference_percent =
            measured.zip(theory).filter(|(_, t)| *t != 0.0).map(|(m, t)| 100.0 * (m - t) / t);
        let (of, quantity, unit) = (of.into(), quantity.into(), unit.into());
        self.borders.push(Border { of, quantity, unit, measured, theory, difference_percent });
    }

    /// Draws what was measured as unconnected points, and theory as a line.
    pub(super) fn draw_beside(
        &mut self,
        panel: &str,
        name: &str,
        measured: impl IntoIterator<Item = Point>,
        theory: impl IntoIterator<Item = Point>,
    ) {
        self.draw(Drawn::Points, panel, name, measured);
        self.draw(Drawn::Theory, panel, name, theory);
    }

    /// Draws one curve.
    pub(super) fn draw(
        &mut self,
        drawn: Drawn,
        panel: &str,
        name: &str,
        points: impl IntoIterator<Item = Point>,
    ) {
        let (is_theory, is_points) = (drawn == Drawn::Theory, drawn == Drawn::Points);
        let (panel, name, points) = (panel.into(), name.into(), points.into_iter().collect());
        self.curves.push(MapCurve { panel, name, is_theory, is_points, points });
    }
}

/// What a curve shows, and how.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Drawn {
    /// What was measured, as a line.
    Measured,
    /// What was measured, as unconnected points.
    Points,
    /// Theory, as a line.
    Theory,
}

/// (x, y) of a curve.
pub(super) type Point = (f64, f64);

/// Points by the logarithms of both numbers, y at least `least`.
pub(super) fn logarithms(
    points: impl IntoIterator<Item = Point>,
    least: f64,
) -> impl Iterator<Item = Point> {
    points.into_iter().map(move |(x, y)| (x.log10(), y.max(least).log10()))
}

/// Why a map cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum MapError {
    /// A step in time.
    #[error(transparent)]
    Integrator(#[from] dynamics::benchmark_subjects::IntegratorError),
    /// The lumped set of the scene.
    #[error(transparent)]
    Lumped(#[from] lumped::LumpedError),
    /// The FE/contact model.
    #[error(transparent)]
    Fe(#[from] fe_contact::FeError),
    /// An eigenproblem.
    #[error(transparent)]
    Eigen(#[from] dynamics::EigenError),
    /// A spectrum.
    #[error(transparent)]
    Spectrum(#[from] dynamics::SpectrumError),
    /// Modes of a linearised set.
    #[error(transparent)]
    Modal(#[from] crate::modal::ModalError),
    /// Steady states.
    #[error(transparent)]
    Sweep(#[from] crate::sweep::SweepError),
    /// Branches of steady states.
    #[error(transparent)]
    Branch(#[from] crate::branches::BranchError),
    /// The scene lacks something the map needs.
    #[error("the scene has no {0}")]
    Incomplete(&'static str),
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

/// Computes a map; `scene` is used by those for which [`Map::is_of_a_scene`] holds.
///
/// # Errors
/// If the scene lacks what the map needs, or a step or an eigenproblem fails.
pub fn stability_map(which: &Map, scene: &Scene) -> Result<StabilityMap, MapError> {
    match which.of {
        MapOf::Nothing(map) => map(),
        MapOf::Planets(_) if scene.kind == SceneKind::GearPair => {
            Err(MapError::NotPlanetary(which.name))
        }
        MapOf::Scene(map) | MapOf::Planets(map) => map(scene),
    }
}

/// Several maps side by side, in the order in which they are named.
///
/// # Errors
/// As [`stability_map`].
pub fn stability_maps(which: &[&Map], scene: &Scene) -> Result<Vec<StabilityMap>, MapError> {
    which.par_iter().map(|own| stability_map(own, scene)).collect()
}

/// The least x from which on all errors y, listed coarse to fine, are within what is wanted; `None` if the finest is
/// not.
pub(super) fn fine_from(errors: &[Point], wanted: f64) -> Option<f64> {
    errors.iter().rev().take_while(|(_, off)| *off <= wanted).last().map(|(x, _)| *x)
}
