//! Errors of the lumped model and its modes.

use gearset::{Axis, Body};

use crate::springs::SpringId;

/// Why a scene has no lumped model, or its modes or motion could not be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LumpedError {
    /// The scene has no lumped parameters.
    #[error("[lumped] is absent: a lumped model needs masses, inertias and mesh stiffnesses")]
    NoParameters,
    /// A scene that its file could not hold, by the faults that the reader would find.
    #[error(transparent)]
    Scene(#[from] scene::SceneFaults),
    /// An operating pressure angle of a right angle or more, as of degrees that are taken for radians.
    #[error("`lumped.pressure_angle_deg.{mesh}` is {} °: allowed: below 90 ° either way", value.to_degrees())]
    PressureAngle {
        /// Mesh.
        mesh: &'static str,
        /// Its angle, rad.
        value: f64,
    },
    /// A scene whose parameters have no closed form.
    #[error("no parameters in closed form: {0}")]
    NotAnalytic(&'static str),
    /// A coordinate can move and has no inertia.
    #[error("`lumped.{table}.{0}` is absent, and the {0} can move", body.kind_name())]
    NoInertia {
        /// Table of the scene, `mass_kg` or `inertia_over_r2_kg`.
        table: &'static str,
        /// Body.
        body: Body,
    },
    /// A mass or inertia that is not positive and finite.
    #[error("`lumped.{table}` of the {body} is {value}: it must be positive and finite")]
    Inertia {
        /// Table of the scene, as above.
        table: &'static str,
        /// Body.
        body: Body,
        /// Its mass or I/r² with what is fixed to it, kg.
        value: f64,
    },
    /// A torsional stiffness per angle or an added inertia, without the radius r that converts it to
    /// u = r·θ.
    #[error(
        "`lumped.radius_mm.{}` is absent: the torsional stiffness or added inertia needs it",
        body.kind_name()
    )]
    NoRadius {
        /// Body.
        body: Body,
    },
    /// A stiffness that is negative or not finite.
    #[error("the {} stiffness is {value} N/m: it must be finite and not negative", spring.family())]
    Stiffness {
        /// Spring.
        spring: SpringId,
        /// Its stiffness, N/m.
        value: f64,
    },
    /// An override for a planet that does not exist.
    #[error("`planet_override` names planet {planet}, and there are {count}")]
    NoSuchPlanet {
        /// Index given.
        planet: usize,
        /// Number of planets.
        count: usize,
    },
    /// No radius r of a body that can rotate, to convert between u = r·θ and torque or angle.
    #[error("`lumped.radius_mm.{}` is absent: torque and rotation in time need it", body.kind_name())]
    NoRotation {
        /// Body.
        body: Body,
    },
    /// A damping that is negative or not finite.
    #[error("`damping.{key}` is {value}: it must be finite and not negative")]
    Damping {
        /// Key.
        key: &'static str,
        /// Its value.
        value: f64,
    },
    /// A mesh law with another number of meshes than the set.
    #[error("a mesh law of {got} meshes does not go with {wanted}")]
    Law {
        /// Meshes of the law.
        got: usize,
        /// Meshes of the set.
        wanted: usize,
    },
    /// A mesh frequency that gives no time step.
    #[error("mesh frequency {0} Hz: it must be positive and finite")]
    Frequency(f64),
    /// Damping of the meshes where a scheme steps undamped ones.
    #[error(
        "`damping.stiffness_proportional_s` is {0}: schemes step meshes without damping, so that it must be 0"
    )]
    MeshDamping(f64),
    /// Steps of a law that are no whole number of steps of a scheme.
    #[error(
        "a law of {0} steps in a cycle: a scheme takes two of them in a step, so that they must be even"
    )]
    LawSteps(usize),
    /// Numbers that are not the state of a set.
    #[error("a state of {got} numbers for a set that has {wanted}")]
    State {
        /// Numbers given.
        got: usize,
        /// Numbers of a state.
        wanted: usize,
    },
    /// A scheme or one of its steps.
    #[error(transparent)]
    Integrator(#[from] dynamics::benchmark_subjects::IntegratorError),
    /// A planet whose mass would not be positive and finite.
    #[error(
        "a planet heavier by a part {part} has no positive mass: allowed is a finite part above -1"
    )]
    Heavier {
        /// The part.
        part: f64,
    },
    /// Displacements of planets in angle that are not one finite number for each planet.
    #[error(
        "{given} displacements for {count} planets: allowed is one finite number for each planet"
    )]
    Displaced {
        /// Planets.
        count: usize,
        /// Displacements given.
        given: usize,
    },
    /// Teeth are needed for contact ratios and mesh phases, and the scene has none.
    #[error("[teeth] and [geometry] are absent: contact ratios and mesh phases come from them")]
    NoTeeth,
    /// A variation of mesh stiffness that makes it negative.
    #[error(
        "a stiffness variation of ε = {epsilon} leaves {lowest:.4} of the mean mesh stiffness at the lowest: ε must be \
         finite and not negative, and leave a stiffness that is not negative"
    )]
    Variation {
        /// ε.
        epsilon: f64,
        /// Lowest stiffness over the mean.
        lowest: f64,
    },
    /// A displacement is not a number or exceeds the bound for a vibration.
    #[error(
        "the motion diverges: at {time_s:e} s the {} of the {body} is {value:e} m",
        axis.displacement(*body)
    )]
    Diverged {
        /// Time, s.
        time_s: f64,
        /// Body.
        body: Body,
        /// Coordinate, in the frame of counter-clockwise torque on the sun.
        axis: Axis,
        /// Displacement, m; u = r·θ of a rotation.
        value: f64,
    },
    /// The steps in time failed.
    #[error(transparent)]
    Coupled(#[from] dynamics::CoupledError),
    /// Harmonic balance failed.
    #[error(transparent)]
    Balance(#[from] dynamics::harmonic_balance::BalanceError),
    /// The eigenproblem failed.
    #[error(transparent)]
    Eigen(#[from] dynamics::EigenError),
}
