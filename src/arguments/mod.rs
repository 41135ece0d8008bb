//! The command line.

mod dataset;
mod results;
mod steady;
mod values;

use std::path::PathBuf;

use clap::builder::TypedValueParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use experiments::stability::Map;
use scene::SceneKind;
use validation::{ModelKind, Profile};

pub(crate) use dataset::{DataSet, DataSetVerb, Snapshot};
pub(crate) use results::Results;
pub(crate) use steady::{Branches, Model, Sweep};
pub(crate) use values::DAMPING_FACTORS;
use values::{map, number, numbers, one_of, whole};

/// Verification and benchmark suite for planetary gear dynamics (2-D, spur, single stage).
#[derive(Debug, Parser)]
#[command(version, about, max_term_width = 100)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub verb: Verb,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    /// Judge the models against published tables and theorems.
    Validate(Validate),
    /// Natural frequencies and mode types of a scene's lumped model.
    Modes(Modes),
    /// Which mesh harmonics excite which kinds of modes, and how strongly.
    Rules(Rules),
    /// One mesh cycle at rest: transmission error, mesh stiffness, load sharing, pressure.
    Static(Static),
    /// Virtual modal test: pulses on the preloaded FE/contact set, modes from its free decay.
    Impulse(Impulse),
    /// Steady states over speed: harmonics of every body and mesh; can be interrupted and resumed.
    Sweep(Sweep),
    /// Periodic motions over speed, stable or not, through the folds at which sweeps jump.
    Branches(Branches),
    /// Methods and sets pushed until they fail: borders of stability, measured, with theory beside them.
    Stability(Stability),
    /// Error against cost: what many settings give for quantities of interest, beside a truth with its uncertainty.
    Study(Study),
    /// Finite-element meshes of a scene: quality, mass properties, flexibility, pictures.
    Mesh(MeshVerb),
    /// Write or explain a scene file.
    #[command(subcommand)]
    Scene(SceneVerb),
    /// Write or check a results folder: tables of any model that `validate --recorded` judges.
    #[command(subcommand)]
    Results(Results),
    /// Write the data set of certified values, or say whether a copy was altered.
    Dataset(DataSet),
    /// Store somebody's results as a baseline, or say what moved since, towards or away from the data set.
    Snapshot(Snapshot),
    /// Compare a list of natural frequencies with those of a scene's lumped model.
    Compare(Compare),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// A table for people.
    Text,
    /// Stable keys for programs; schemas in `schemas/`.
    Json,
    /// The table: one row per mode (`modes`, `impulse`, `compare`), harmonic (`rules`), position and tooth pair
    /// (`static`), speed, quantity and harmonic (`sweep`), point, quantity and harmonic (`branches`), border
    /// (`stability`; without a map, one row per map), quantity and setting (`study`), body (`mesh`), verb
    /// (`scene check`), suite (`results check`), value that moved (`snapshot`), or check (`validate`).
    Csv,
}

#[derive(Debug, Args)]
pub(crate) struct Validate {
    /// Also write the verdict and the mode tables to this folder (Markdown, JSON) and draw figures; with --recorded
    /// Markdown, JSON, JUnit XML and one HTML page about the judged results.
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// List every check instead of one line per suite.
    #[arg(long)]
    pub details: bool,
    /// List the suites with what they ask of a model and their negative controls; run nothing.
    #[arg(long, conflicts_with_all = ["report", "details", "profile", "recorded"])]
    pub controls: bool,
    /// Judge tables of results instead of this project's models: a results folder (docs/results.md).
    #[arg(long, value_name = "DIR", conflicts_with = "profile")]
    pub recorded: Option<PathBuf>,
    /// What kind of model the results come from, instead of what results.toml says.
    #[arg(long = "as", value_name = "KIND", requires = "recorded", value_parser = model_kinds())]
    pub kind: Option<ModelKind>,
    /// What the results are known to miss, and thresholds: a TOML file of [[miss]] and [[threshold]] (docs/results.md).
    #[arg(long, value_name = "FILE", requires = "recorded")]
    pub accept: Option<PathBuf>,
    /// How much to run; checks left out are listed as not run.
    #[arg(long, default_value = "quick", value_parser = profiles())]
    pub profile: Profile,
    /// Only checks whose ids start so, e.g. `table3.` or `fe.hertz,fe.sets`; may be repeated.
    #[arg(long, value_name = "PREFIX,…", value_delimiter = ',')]
    pub only: Vec<String>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

fn model_kinds() -> impl TypedValueParser<Value = ModelKind> {
    one_of([
        ("lumped", "Rigid bodies on springs that move in the plane", ModelKind::Lumped),
        ("fe_contact", "Elastic teeth in contact", ModelKind::FeContact),
        ("torsional", "Rigid bodies on springs that only turn", ModelKind::Torsional),
        ("measured", "A test rig: compared, never failed", ModelKind::Measured),
    ])
}

fn profiles() -> impl TypedValueParser<Value = Profile> {
    one_of([
        ("quick", "The checks that run within minutes", Profile::Quick),
        ("full", "Every check", Profile::Full),
    ])
}

#[derive(Debug, Args)]
pub(crate) struct Modes {
    /// Scene file.
    pub scene: PathBuf,
    /// Also list each mode's energy shares and the sensitivities of its frequency.
    #[arg(long)]
    pub details: bool,
    /// The `[lumped]` table of parameters in closed form, to paste into a scene, whatever the scene has there; in JSON
    /// beside the modes that they give.
    #[arg(long, conflicts_with_all = ["details", "carrier_speeds_rpm"])]
    pub parameters: bool,
    /// Frequencies with gyroscopic terms at these carrier speeds, rpm (Campbell data).
    #[arg(long, value_name = "RPM,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub carrier_speeds_rpm: Vec<f64>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct Rules {
    /// Scene file.
    pub scene: PathBuf,
    /// Highest harmonic of mesh frequency.
    #[arg(long, default_value_t = 10, value_parser = whole::<1, 1000>,
          allow_negative_numbers = true)]
    pub harmonics: u32,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ContactSolver {
    /// Warm-started active set.
    ActiveSet,
    /// Lemke's complementary pivoting.
    Lemke,
    /// Interior-point method with a tolerance of 1e-12; slow.
    #[cfg(feature = "interior_point")]
    InteriorPoint,
}

#[derive(Debug, Args)]
pub(crate) struct Static {
    /// Scene file: a whole set, or one mesh (`kind = "gear_pair"`).
    pub scene: PathBuf,
    /// Torques on the sun, N·m; negative is clockwise. If left out, what a set's operating point loads the sun with.
    #[arg(long, value_name = "NM,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub sun_torque_nm: Vec<f64>,
    /// Normal force of a gear pair, N. If left out, |T|/r_b of a sun–planet pair's `operation.torque_nm`.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub normal_force_n: Option<f64>,
    /// Number of evenly spaced positions in the mesh cycle, from phase 0 [default: 140].
    #[arg(long, value_parser = whole::<1, 100_000>,
          conflicts_with = "approach_um", allow_negative_numbers = true)]
    pub positions: Option<u32>,
    /// Compute also what by estimate takes more than 2 GiB of memory or a day on one core.
    #[arg(long)]
    pub large: bool,
    /// Solver of the contact problem.
    #[arg(long, value_enum, default_value_t = ContactSolver::ActiveSet)]
    pub solver: ContactSolver,
    /// Also draw figures into this folder (SVG, PNG): transmission_error, load_sharing, mesh_stiffness; of one mesh
    /// pressure, of several torques rms_against_torque. Not with --approach-um.
    #[cfg_attr(feature = "charts", arg(long, value_name = "DIR", conflicts_with = "approach_um"))]
    #[cfg_attr(not(feature = "charts"), arg(skip))]
    pub figures: Option<PathBuf>,
    /// Gear pair only: instead of loading the driving gear, rotate its race by this approach divided by its
    /// base radius, at one phase; µm.
    #[arg(long, value_name = "UM", conflicts_with_all = ["normal_force_n", "sun_torque_nm"],
          allow_negative_numbers = true)]
    pub approach_um: Option<f64>,
    /// Phase of that approach, cycles.
    #[arg(long, value_name = "CYCLES", requires = "approach_um", allow_negative_numbers = true)]
    pub phase: Option<f64>,
    /// Write the same problem as a CalculiX input deck.
    #[arg(long, value_name = "FILE", requires = "approach_um")]
    pub export_inp: Option<PathBuf>,
    /// Elements per half-width of the contact in that deck [default: 12].
    #[arg(long, value_name = "N", requires = "export_inp",
          value_parser = number(1.0..=100.0, "a number from 1 to 100"))]
    pub export_per_half_width: Option<f64>,
    /// Elements along the other flanks in that deck [default: 12].
    #[arg(long, value_name = "N", requires = "export_inp",
          value_parser = whole::<3, 64>, allow_negative_numbers = true)]
    pub export_flank_elements: Option<u32>,
    /// Teeth kept on either side of the loaded ones in that deck; whole gears if left out.
    #[arg(long, value_name = "N", requires = "export_inp",
          value_parser = whole::<0, 10_000>, allow_negative_numbers = true)]
    pub export_teeth: Option<u32>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

/// Positions of a mesh cycle where the command line names none.
const POSITIONS: u32 = 140;

impl Static {
    /// Number of positions in the mesh cycle.
    pub(crate) fn position_count(&self) -> usize {
        self.positions.unwrap_or(POSITIONS) as usize
    }

    /// The first of the options that only a gear pair turned by an approach has, if it is not turned by one.
    pub(crate) fn without_approach(&self) -> Option<&'static str> {
        // The parser lets a `requires` pass where what is required conflicts with an option that is there.
        let given = [
            ("--phase", self.phase.is_some()),
            ("--export-inp", self.export_inp.is_some()),
            ("--export-per-half-width", self.export_per_half_width.is_some()),
            ("--export-flank-elements", self.export_flank_elements.is_some()),
            ("--export-teeth", self.export_teeth.is_some()),
        ];
        let first = given.into_iter().find(|(_, is_given)| *is_given).map(|(name, _)| name);
        first.filter(|_| self.approach_um.is_none())
    }
}

#[derive(Debug, Args)]
pub(crate) struct Impulse {
    /// Scene file of a whole set, or a sun–planet gear pair.
    pub scene: PathBuf,
    /// Torque on the sun, N·m; negative is clockwise. If left out, what the operating point loads the sun with.
    #[arg(long, value_name = "NM", allow_negative_numbers = true)]
    pub sun_torque_nm: Option<f64>,
    /// Position in the mesh cycle where the set stands, 0 to 1.
    #[arg(long, value_name = "CYCLES", default_value_t = 0.0, allow_negative_numbers = true)]
    pub position: f64,
    /// Time step, µs; 67 steps in the period of the band's upper end if left out.
    #[arg(long, value_name = "US", allow_negative_numbers = true)]
    pub step_us: Option<f64>,
    /// Length of each free decay, ms; 40 or, if longer, 30 periods of the lowest mode if left out.
    #[arg(long, value_name = "MS", allow_negative_numbers = true)]
    pub duration_ms: Option<f64>,
    /// Frequencies in which modes are identified, Hz; if left out, the lower half of the linearised modes and on
    /// to the next gap. Linearised modes outside the band are listed.
    #[arg(long, value_name = "LOW:HIGH", allow_negative_numbers = true,
          value_parser = numbers::<2>("two frequencies as LOW:HIGH, in Hz"))]
    pub band_hz: Option<[f64; 2]>,
    /// Compute also what by estimate takes more than 2 GiB of memory or a day on one core.
    #[arg(long)]
    pub large: bool,
    /// Also linearise over the mesh cycle at half, once and one and a half times the torque.
    #[arg(long)]
    pub band: bool,
    /// Also draw figures into this folder (SVG, PNG): spectrum, stabilisation, mode_shapes; with --band also band.
    #[cfg_attr(feature = "charts", arg(long, value_name = "DIR"))]
    #[cfg_attr(not(feature = "charts"), arg(skip))]
    pub figures: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct Stability {
    /// The map; without it, the maps are listed.
    #[arg(value_parser = map())]
    pub map: Option<&'static Map>,
    /// List the guards of the program: what it says on either side of each border.
    #[arg(long, conflicts_with_all = ["map", "scene", "out"])]
    pub guards: bool,
    /// Set for which the map is computed (explicit-step, parametric, mode-types, contact-loss, transients,
    /// linear-kinematics, spacing); five equally spaced planets if left out.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Also write table (CSV), result (JSON) and figure (SVG, PNG) into this folder.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct Study {
    /// Study file: quantities, routes to their truth, settings (docs/studies.md).
    pub(crate) file: PathBuf,
    /// Rounds in which every setting is run; those of the file if left out.
    #[arg(long, value_name = "N", value_parser = whole::<3, 999>,
          allow_negative_numbers = true)]
    pub(crate) rounds: Option<u32>,
    /// Also write table (CSV), result (JSON) and figure (SVG, PNG) into this folder.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct MeshVerb {
    /// Scene file.
    pub scene: PathBuf,
    /// Mesh also bodies that by estimate take more than 2 GiB of memory.
    #[arg(long)]
    pub large: bool,
    /// Draw the assembled meshes into this file (SVG).
    #[cfg(feature = "charts")]
    #[arg(long, value_name = "FILE")]
    pub svg: Option<PathBuf>,
    /// Write each body's mesh into this folder (VTU, for ParaView).
    #[arg(long, value_name = "DIR")]
    pub vtu: Option<PathBuf>,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}

#[derive(Debug, Subcommand)]
pub(crate) enum SceneVerb {
    /// Write a commented scene file to start from.
    New {
        /// File to write; `-` for standard output. An existing file is never overwritten.
        path: PathBuf,
        /// What the scene describes.
        #[arg(long, default_value = "planetary", value_parser = kinds())]
        kind: SceneKind,
    },
    /// Read a scene, report every fault, explain what it says, warn of unlikely values, list what verbs lack.
    Check {
        /// Scene file.
        scene: PathBuf,
        #[arg(long, value_enum, default_value_t = Format::Text)]
        format: Format,
    },
    /// Print the JSON schema of scene files, by which editors complete and check them.
    Schema,
}

fn kinds() -> impl TypedValueParser<Value = SceneKind> {
    one_of([
        ("planetary", "A whole planetary set", SceneKind::Planetary),
        ("gear-pair", "One mesh alone", SceneKind::GearPair),
    ])
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// CSV file with a `frequency_hz` column and, optionally, `mode_type` and `multiplicity`.
    pub modes: PathBuf,
    /// Scene the frequencies belong to.
    #[arg(long)]
    pub scene: PathBuf,
    /// Largest difference that counts as agreement, percent.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true,
          value_parser = number(f64::MIN_POSITIVE..=100.0, "a number above 0, at most 100"))]
    pub tolerance_percent: f64,
    /// Demand every mode of the model: without it, modes above the list's highest frequency may be absent.
    #[arg(long)]
    pub whole: bool,
    #[arg(long, value_enum, default_value_t = Format::Text)]
    pub format: Format,
}
