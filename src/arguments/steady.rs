//! The command line of steady states: over speed, and along branches.

use std::path::PathBuf;

use clap::builder::TypedValueParser;
use clap::{Args, ValueEnum};
use experiments::branches::BranchParameter;
use experiments::sweep::SteadyMethod;

use super::Format;
use super::values::{DAMPING_FACTORS, number, numbers, one_of, over, speeds, whole};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Model {
    /// FE/contact, at the fidelity of the scene.
    FeContact,
    /// Lumped, its mesh forces tabulated over deflection and phase by FE/contact.
    Lumped,
}

/// A range that `branches` takes.
const SPAN: &str = "two numbers as FROM:TO";

/// Both methods with their help.
fn methods() -> impl TypedValueParser<Value = SteadyMethod> {
    one_of([
        (
            "shooting",
            "Newton's method for the periodic motion, with its stability; marched where none is found or it is unstable",
            SteadyMethod::Shooting,
        ),
        (
            "marching",
            "Time integration until mesh cycles repeat, with the multipliers of the motion at its end",
            SteadyMethod::Marching,
        ),
    ])
}

#[derive(Debug, Args)]
pub(crate) struct Sweep {
    /// Scene file of a whole set, or a sun–planet gear pair; its `[dynamics]` gives fidelity and steps per mesh cycle.
    pub scene: PathBuf,
    /// Speeds of the input member, rpm: first, last and step, or one alone.
    #[arg(long, value_name = "FROM:TO:STEP", default_value = "100:2500:25", allow_negative_numbers = true,
          value_parser = speeds)]
    pub speeds_rpm: [f64; 3],
    /// Torque on the sun, N·m; negative is clockwise. The operating torque if left out.
    #[arg(long, value_name = "NM", allow_negative_numbers = true)]
    pub sun_torque_nm: Option<f64>,
    /// Model whose motion is integrated.
    #[arg(long, value_enum, default_value_t = Model::FeContact)]
    pub model: Model,
    /// Also sweep towards lower speeds.
    #[arg(long)]
    pub both_ways: bool,
    /// Also search every speed from N random starts, which lists further motions that attract; not for models without
    /// derivative of their steps (fidelity full, exact kinematics).
    #[arg(long, value_name = "N", default_value_t = 0,
          value_parser = whole::<0, 99>, allow_negative_numbers = true)]
    pub random_starts: u32,
    /// Number of further speeds about each peak, 0 for none.
    #[arg(long, value_name = "N", default_value_t = 0,
          value_parser = whole::<0, 1000>, allow_negative_numbers = true)]
    pub refine: u32,
    /// How steady states are found.
    #[arg(long, value_name = "METHOD", default_value = "shooting", value_parser = methods())]
    pub method: SteadyMethod,
    /// Shoot over whole mesh cycles also where a set is itself again, with its planets renumbered, after a part of one:
    /// motions that break this symmetry are then found, and what planet phasing forbids is computed, not put in.
    #[arg(long)]
    pub whole_cycles: bool,
    /// Highest harmonic of the mesh frequency: up to 5, up to 10 with at least 560 steps in a cycle.
    #[arg(long, default_value_t = 5, value_parser = whole::<1, 10>, allow_negative_numbers = true)]
    pub harmonics: u32,
    /// Largest change of a steady state from cycle to cycle, over its peak-to-peak vibration.
    #[arg(long, default_value_t = 1e-9, allow_negative_numbers = true,
          value_parser = number(1e-12..=0.1, "a number from 1e-12 to 0.1"))]
    pub tolerance: f64,
    /// Cycles after which a march is given up; the motion is then recorded as it is, flagged as not shown to attract.
    #[arg(long, default_value_t = 2000, value_parser = whole::<2, 1_000_000>, allow_negative_numbers = true)]
    pub most_cycles: u32,
    /// Cycles over which the energy between harmonics of a marched motion is measured, 0 for none; of a motion
    /// found by shooting it is measured over the last two.
    #[arg(long, default_value_t = 16, value_parser = whole::<0, 10_000>, allow_negative_numbers = true)]
    pub between_cycles: u32,
    /// Compute also what by estimate takes more than 2 GiB of memory or a day on one core.
    #[arg(long)]
    pub large: bool,
    /// Folder for finished points, then the table (CSV) and a sidecar (JSON); the same command resumes from
    /// the points in it. A folder with anything else that would be overwritten is refused.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Also draw figures into this folder (SVG, PNG): waterfalls, frequencies, harmonics_* of each quantity and,
    /// of a model with derivative, multipliers.
    #[cfg_attr(feature = "charts", arg(long, value_name = "DIR"))]
    #[cfg_attr(not(feature = "charts"), arg(skip))]
    pub figures: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct Branches {
    /// Scene file of a whole set, or a sun–planet gear pair; its `[dynamics]` gives fidelity and steps per mesh cycle.
    pub scene: PathBuf,
    /// What is varied along the branch: speed (of the input member), torque (on the sun), damping (a factor on every
    /// damping of the scene), or a scene key of damping, of the stiffness of a support, or of a mass or inertia, as
    /// planet.bearing_n_per_m.
    #[arg(long, value_name = "WHAT", default_value = "speed", value_parser = over)]
    pub over: BranchParameter,
    /// Least and greatest speed of the input member, rpm; with --over speed, which needs it.
    #[arg(long, value_name = "FROM:TO", value_parser = numbers::<2>(SPAN), allow_hyphen_values = true)]
    pub speeds_rpm: Option<[f64; 2]>,
    /// Least and greatest torque on the sun, N·m, both of one sign; with --over torque, which needs it.
    #[arg(long, value_name = "FROM:TO", value_parser = numbers::<2>(SPAN), allow_hyphen_values = true)]
    pub torques_nm: Option<[f64; 2]>,
    /// Least and greatest factor on every damping of the scene; with --over damping, which needs it.
    #[arg(long, value_name = "FROM:TO", value_parser = numbers::<2>(SPAN), allow_hyphen_values = true)]
    pub damping_factors: Option<[f64; 2]>,
    /// Least value of the key, in its unit; with --over KEY, which needs it.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub from: Option<f64>,
    /// Greatest value of the key, in its unit; with --over KEY, which needs it.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub to: Option<f64>,
    /// Speed (rpm), torque (N·m), factor or value of the key at which the branch begins, with the motion found from
    /// rest; the greatest if left out.
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub start: Option<f64>,
    /// Speed of the input member, rpm; not with --over speed. The operating speed if left out.
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    pub rpm: Option<f64>,
    /// Torque on the sun, N·m; negative is clockwise. The operating torque if left out. With --over torque the one
    /// under which the model is set up, the middle of the range if left out.
    #[arg(long, value_name = "NM", allow_negative_numbers = true)]
    pub sun_torque_nm: Option<f64>,
    /// Model whose motion is followed.
    #[arg(long, value_enum, default_value_t = Model::FeContact)]
    pub model: Model,
    /// Factor on every damping of the scene; not with --over damping.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true,
          value_parser = number(DAMPING_FACTORS, "a number from 1e-6 to 100"))]
    pub damping_factor: f64,
    /// Also follow the branches that leave at period doublings and branch points.
    #[arg(long)]
    pub switch: bool,
    /// Most points each way from the start.
    #[arg(long, value_name = "N", default_value_t = 500,
          value_parser = whole::<2, 100_000>, allow_negative_numbers = true)]
    pub max_points: u32,
    /// Compute also what by estimate takes more than 2 GiB of memory or a day on one core.
    #[arg(long)]
    pub large: bool,
    /// Folder for finished steps, then the table (CSV) and everything (JSON); the same command resumes from the steps
    /// in it. A folder with anything else that would be overwritten is refused.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Also draw the strongest motions of the sun into this folder (SVG, PNG), stable solid, unstable dashed:
    /// branch_sun_rotation, branch_sun_translation.
    #[cfg_attr(feature = "charts", arg(long, value_name = "DIR"))]
    #[cfg_attr(not(feature = "charts"), arg(skip))]
    pub figures: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}
