//! Why there is no FE/contact result.

use gearset::{Axis, Body};

use crate::complementarity::ComplementarityError;
use crate::element::DistortedElement;

/// Why a mesh, a body, an equilibrium or a time step could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FeError {
    /// The scene lacks something FE/contact needs.
    #[error("`{key}` is absent: {why}")]
    Missing {
        /// Scene key.
        key: String,
        /// What needs it.
        why: &'static str,
    },
    /// A scene that its file could not hold, by the faults that the reader would find.
    #[error(transparent)]
    Scene(#[from] scene::SceneFaults),
    /// A scene value FE/contact cannot work with.
    #[error("`{key}` is {value}: allowed is {allowed}, because {why}")]
    Unfit {
        /// Scene key.
        key: String,
        /// Its value.
        value: String,
        /// What is allowed.
        allowed: String,
        /// Cause and remedy.
        why: String,
    },
    /// An element is turned inside out: det J ≤ 0 at an integration point.
    #[error(
        "the mesh of the {body} folds over itself in tooth element {element}: {cause}; a smaller fillet or another `fe_contact.flank_elements` may mend it"
    )]
    Distorted {
        /// Body.
        body: &'static str,
        /// Element within the tooth's sector.
        element: usize,
        /// Integration point and det J.
        cause: DistortedElement,
    },
    /// The iteration for the mean loaded configuration did not converge.
    #[error(
        "no mean configuration under {torque_nm} N·m is found: phases still change by {change:.4} cycles; stiffer bearings or a smaller torque keep the gears nearer their places"
    )]
    NoReference {
        /// Torque on the sun, N·m.
        torque_nm: f64,
        /// Largest change of a mesh phase in the last iteration, cycles.
        change: f64,
    },
    /// Displacements too large for linear kinematics.
    #[error(
        "approaches of tooth pairs are up to {rest_um:.3} µm off their linear form about the mean loaded configuration{}: displacements are too large for it; `dynamics.kinematics` = \"exact\" in a sweep, stiffer bearings or a smaller torque are within it",
        share.map_or(String::new(), |share| format!(", {:.0} % of the sun's peak-to-peak motion", 100.0 * share))
    )]
    BeyondLinear {
        /// Largest difference, µm.
        rest_um: f64,
        /// The same divided by the sun's peak-to-peak motion; `None` if that is 0.
        share: Option<f64>,
    },
    /// The factorisation broke down.
    #[error("the stiffness of the {body} is not positive definite: {cause}")]
    Factorisation {
        /// Body.
        body: &'static str,
        /// Cause, as the solver reports it.
        cause: String,
    },
    /// The modes of a body with its race held could not be computed.
    #[error("the modes of the {body} with its race held: {cause}")]
    Modes {
        /// Body.
        body: &'static str,
        /// Why.
        cause: dynamics::EigenError,
    },
    /// A displacement is not a number or exceeds the bound for a vibration.
    #[error(
        "the motion diverges: at {time_s:e} s the {} of the {body} is {value:e}; a smaller step (`dynamics.steps_per_cycle`) or more damping may hold it",
        axis.displacement(*body)
    )]
    Diverged {
        /// Time, s.
        time_s: f64,
        /// Body.
        body: Body,
        /// Which of its displacements.
        axis: Axis,
        /// Its value, m.
        value: f64,
    },
    /// A matching point lies outside its tooth.
    #[error(
        "at mesh phase {phase:.4} the matching point {depth_mm:.3} mm below the {body}'s flank lies outside its tooth: choose a smaller `fe_contact.matching_depth_mm`"
    )]
    DepthOutside {
        /// Body.
        body: &'static str,
        /// Mesh phase, cycles.
        phase: f64,
        /// Depth, mm.
        depth_mm: f64,
    },
    /// A loaded patch reaches an end of its grid of contact cells where the flanks continue.
    #[error(
        "at mesh phase {phase:.4} the contact patch of pair {pair} reaches the end of its grid of ±{reach_mm:.3} mm under {force_n:.0} N; a smaller torque (`operation.torque_nm`), or a gentler `tip_relief` (a smaller `amount_um`, a `start_diameter_mm` farther from the tip), keeps it inside"
    )]
    GridOverflow {
        /// Mesh phase, cycles.
        phase: f64,
        /// Pair.
        pair: i64,
        /// Half the length of the grid, mm.
        reach_mm: f64,
        /// Force of the pair, N.
        force_n: f64,
    },
    /// A mesh force beyond the tables of mesh force.
    #[error(
        "a mesh presses with {force_n:.0} N, and its tables of mesh force end at {largest_n:.0} N"
    )]
    TableExceeded {
        /// The force, extrapolated, N.
        force_n: f64,
        /// Largest force of the tables, N.
        largest_n: f64,
    },
    /// Too few cells carry the load.
    #[error(
        "the grid is too coarse for the load: only {loaded} cells of pair {pair} carry {force_n:.3} N, at least {least} must; raise `fe_contact.contact_cells` above {cells}"
    )]
    GridTooCoarse {
        /// Pair.
        pair: i64,
        /// Force of the pair, N.
        force_n: f64,
        /// Cells in contact.
        loaded: usize,
        /// Fewest allowed.
        least: usize,
        /// Cells of the grid.
        cells: usize,
    },
    /// A contact problem could not be solved.
    #[error("contact at mesh phase {phase:.4}: {cause}")]
    Contact {
        /// Mesh phase, cycles.
        phase: f64,
        /// Why.
        cause: ComplementarityError,
    },
    /// A tabulated curve of mesh force cannot be used.
    #[error("mesh law at mesh phase {phase:.4}: {cause}")]
    Curve {
        /// Mesh phase, cycles.
        phase: f64,
        /// Why.
        cause: gearset::CurveError,
    },
    /// The curves of mesh force do not form a mesh law.
    #[error(transparent)]
    Law(#[from] gearset::MeshLawError),
    /// The time integration of a set with tabulated mesh forces failed.
    #[error(transparent)]
    Coupled(#[from] dynamics::CoupledError),
    /// The scene asks for tabulated mesh forces where contact is to be solved.
    #[error(
        "`dynamics.fidelity` = \"mesh_law\" looks mesh forces up in tables and solves no contact: this needs \"quasi_static\", \"modal\" or \"full\""
    )]
    NoContact,
    /// An iteration at one position of a mesh cycle did not converge.
    #[error("{torque_nm:?} N·m on the sun, position {position:.4} of the mesh cycle: {cause}")]
    AtPosition {
        /// Magnitude of the torque on the sun, N·m.
        torque_nm: f64,
        /// Position, cycles.
        position: f64,
        /// Which iteration ended how.
        cause: Box<FeError>,
    },
    /// There is no equilibrium, or a matrix that must be definite is not; the text names the cause.
    #[error("no equilibrium: {0}")]
    NoEquilibrium(String),
    /// An iteration for equilibrium or for a time step did not converge.
    #[error(
        "equilibrium not reached in {iterations} iterations: residual {residual:e} of the load"
    )]
    NotConverged {
        /// Iterations.
        iterations: usize,
        /// Largest residual relative to the load; with exact kinematics and in a time step the last
        /// change of displacements or approaches, m.
        residual: f64,
    },
}

impl FeError {
    /// The same with the position (cycles) and the torque on the sun (N·m) at which an iteration did not converge.
    pub(crate) fn at_position(self, torque_nm: f64, position: f64) -> FeError {
        match self {
            cause @ FeError::NotConverged { .. } => {
                FeError::AtPosition { torque_nm, position, cause: Box::new(cause) }
            }
            other => other,
        }
    }
}
