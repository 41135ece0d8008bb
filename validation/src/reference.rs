//! Published numbers, tolerances and listed misses, as kept in `reference/`, `kept/` and `checks/`.

use serde::Deserialize;

use crate::check::Tolerance;
use crate::own_truth::{ExactPeaks, FullImpulse, FullSweep, Ladder, TorqueMap, TorquePeaks};

/// Why the reference data could not be used.
#[derive(Debug, thiserror::Error)]
pub enum ReferenceError {
    /// A file of `reference/`, `kept/` or `checks/` is not what the code expects.
    #[error("{file} cannot be read: {cause}")]
    Unreadable {
        /// File name.
        file: &'static str,
        /// What the TOML reader said.
        #[source]
        cause: Box<toml::de::Error>,
    },
    /// A check has no tolerance.
    #[error("checks/tolerances.toml has no entry for the check `{0}`")]
    NoTolerance(String),
}

/// All reference data.
#[derive(Debug)]
pub struct Reference {
    /// Lin & Parker (1999).
    pub lin_parker: LinParker,
    /// Parker, Agashe & Vijayakar (2000).
    pub parker: Parker2000,
    /// One mesh by CalculiX.
    pub calculix: Calculix,
    /// Impulse tests with every degree of freedom.
    pub full_impulse: FullImpulse,
    /// Resonant peaks over torque.
    pub torque_peaks: TorquePeaks,
    /// Resonant peaks with exact kinematics.
    pub exact_peaks: ExactPeaks,
    /// Section 4.2 over mesh compliance and γ.
    pub torque_map: TorqueMap,
    /// Steady states with every degree of freedom.
    pub full_sweep: FullSweep,
    /// Fidelities by error and cost.
    pub ladder: Ladder,
    /// Listed misses.
    pub misses: Vec<Miss>,
    tolerances: Vec<ToleranceEntry>,
}

/// Frequencies by type, Hz.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Frequencies {
    /// Rotational modes, each once.
    pub rotational_hz: Vec<f64>,
    /// Translational modes: one entry a pair, or both where the pair is split.
    pub translational_hz: Vec<f64>,
    /// Planet modes, N − 3 times each.
    #[serde(default)]
    pub planet_hz: Vec<f64>,
}

/// `lin_parker_1999.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinParker {
    /// Citation.
    pub source: String,
    /// N = 3.
    pub three_planets: Frequencies,
    /// N = 4.
    pub four_planets: Frequencies,
}

/// `parker_2000.toml`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Parker2000 {
    /// Citation.
    pub source: String,
    /// Table 1.
    pub table1: Table1,
    /// What follows from Table 1.
    pub derived: Derived,
    /// Table 2.
    pub table2: ModeTable,
    /// Table 3.
    pub table3: ModeTable,
    /// Recomputed with consistent geometry.
    pub recomputed: Recomputed,
    /// Excitation strengths.
    pub excitation: Excitation,
}

/// Printed gear data.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct Table1 {
    pub sun_base_diameter_mm: f64,
    pub ring_base_diameter_mm: f64,
    pub planet_base_diameter_mm: f64,
    pub sun_planet_pressure_angle_deg: f64,
    pub ring_planet_pressure_angle_deg: f64,
    pub sun_planet_module_mm: f64,
    pub ring_planet_module_mm: f64,
}

/// Numbers derived from Table 1.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct Derived {
    pub center_distance_mm: f64,
    pub base_pitch_mm: f64,
    pub contact_ratio_sun_planet: f64,
    pub contact_ratio_ring_planet: f64,
    pub mesh_frequency_at_2500_rpm_hz: f64,
}

/// Table 2 or 3.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ModeTable {
    /// Mode type of each row.
    pub mode_type: Vec<String>,
    /// Lumped frequencies, Hz.
    pub lumped_hz: Vec<f64>,
    /// FE/contact frequencies, Hz.
    pub fe_contact_hz: Vec<f64>,
}

/// Frequencies with consistent geometry.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Recomputed {
    /// N = 3.
    pub three_planets: Frequencies,
    /// N = 4.
    pub four_planets: Frequencies,
}

/// Excitation strengths of the four-planet set.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Excitation {
    /// Net torque strength at some harmonics.
    pub net_torque_strength: Strengths,
}

/// Strength by harmonic.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Strengths {
    /// Harmonics of mesh frequency.
    pub harmonics: Vec<u32>,
    /// Strengths, 0 to 1.
    pub values: Vec<f64>,
}

/// `calculix_2_20.toml`; what the checks use of it.
#[derive(Debug, Deserialize)]
pub struct Calculix {
    /// Program, version, where it comes from.
    pub source: String,
    /// Solved cases.
    pub case: Vec<CalculixCase>,
}

/// One mesh at one phase and approach.
#[derive(Debug, Deserialize)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct CalculixCase {
    pub id: String,
    pub scene: String,
    pub what: String,
    pub phase: f64,
    pub approach_um: f64,
    /// Moment on the driving race over its base radius, extrapolated to a hard contact.
    pub force_n: f64,
    pub pair: Vec<CalculixPair>,
}

/// One tooth pair of it.
#[derive(Debug, Deserialize)]
#[allow(missing_docs)] // the keys say it all, units included
pub struct CalculixPair {
    pub index: i64,
    /// Of the ellipse fitted to the faces' mean pressures; absent at corners.
    pub peak_pressure_mpa: Option<f64>,
}

/// One listed miss.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Miss {
    /// Id of the check.
    pub id: String,
    /// What the model gives.
    pub value: f64,
    /// How far it may drift from that.
    pub tolerance: f64,
    /// Why the published value is not reproduced.
    pub analysis: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ToleranceEntry {
    checks: String,
    absolute: Option<f64>,
    percent: Option<f64>,
    reason: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ToleranceFile {
    tolerance: Vec<ToleranceEntry>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct MissFile {
    miss: Vec<Miss>,
}

pub(crate) fn parse<T: serde::de::DeserializeOwned>(
    file: &'static str,
    text: &str,
) -> Result<T, ReferenceError> {
    toml::from_str(text)
        .map_err(|cause| ReferenceError::Unreadable { file, cause: Box::new(cause) })
}

impl Reference {
    /// The data as kept in the repository, built into the program.
    ///
    /// # Errors
    /// If a file does not hold what the code expects.
    pub fn load() -> Result<Self, ReferenceError> {
        macro_rules! file {
            ($name:literal) => {
                parse($name, include_str!(concat!("../", $name)))?
            };
        }
        let tolerances: ToleranceFile = file!("checks/tolerances.toml");
        let misses: MissFile = file!("checks/misses.toml");
        Ok(Self {
            lin_parker: file!("reference/lin_parker_1999.toml"),
            parker: file!("reference/parker_2000.toml"),
            calculix: file!("reference/calculix_2_20.toml"),
            full_impulse: file!("kept/full_impulse.toml"),
            torque_peaks: file!("kept/torque_peaks.toml"),
            exact_peaks: file!("kept/exact_peaks.toml"),
            torque_map: file!("kept/torque_map.toml"),
            full_sweep: FullSweep::load()?,
            ladder: file!("kept/ladder.toml"),
            misses: misses.miss,
            tolerances: tolerances.tolerance,
        })
    }

    /// Tolerance of the check `id`, whose expected value is `expected`.
    ///
    /// # Errors
    /// If no entry matches.
    pub fn tolerance(&self, id: &str, expected: f64) -> Result<Tolerance, ReferenceError> {
        let matches = |entry: &&ToleranceEntry| match entry.checks.strip_suffix('*') {
            Some(prefix) => id.starts_with(prefix),
            None => id == entry.checks,
        };
        let entry = self
            .tolerances
            .iter()
            .filter(matches)
            .max_by_key(|entry| entry.checks.len())
            .ok_or_else(|| ReferenceError::NoTolerance(id.to_owned()))?;
        let of_percent = entry.percent.map(|p| 0.01 * p * expected.abs());
        let absolute = entry.absolute.or(of_percent).unwrap_or(0.0);
        Ok(Tolerance { absolute, reason: entry.reason.clone() })
    }
}
