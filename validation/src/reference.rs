//! Published numbers, tolerances and listed misses, as kept in `reference/`, `kept/` and `checks/`.

use serde::Deserialize;

use crate::check::{Check, ReferenceKind, Status, Subject, Tolerance, Value};
use crate::judged::Judged;
use crate::own_truth::{ExactPeaks, FullImpulse, FullSweep, Ladder, TorqueMap, TorquePeaks};
use crate::parameter_bands::ParameterBands;
use crate::reference_file::{ReferenceError, embedded, parse};
use crate::registry::{ControlEntry, Registry};

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
    /// How far open parameters move what is held against the paper.
    pub parameter_bands: ParameterBands,
    /// Every check, declared once.
    pub registry: Registry,
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
#[derive(Debug, Clone, Deserialize)]
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
#[derive(Debug, Clone, Deserialize)]
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
struct MissFile {
    miss: Vec<Miss>,
}

impl Reference {
    /// The data as kept in the repository, built into the program.
    ///
    /// # Errors
    /// If a file does not hold what the code expects.
    pub fn load() -> Result<Self, ReferenceError> {
        macro_rules! file {
            ($name:literal) => {
                parse($name, embedded!($name))?
            };
        }
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
            parameter_bands: ParameterBands::load()?,
            registry: Registry::load()?,
        })
    }

    /// A check that is about to be judged.
    ///
    /// # Errors
    /// [`ReferenceError::Undeclared`] if the registry does not declare it, [`ReferenceError::NoBand`] if it is to
    /// be judged by a band that is not kept.
    pub fn about<'a>(&'a self, id: &'a str, title: &'a str) -> Result<Judged<'a>, ReferenceError> {
        let entry = self.registry.check(id)?;
        let band = match entry.parameter_band {
            true => {
                let undeclared = || ReferenceError::NoBand(id.to_owned());
                Some(self.parameter_bands.band(id).ok_or_else(undeclared)?)
            }
            false => None,
        };
        Ok(Judged::new(entry, band, id, title))
    }

    /// Tolerance of a check, whose expected value is `expected`.
    ///
    /// # Errors
    /// [`ReferenceError::Undeclared`] if the registry does not declare it.
    pub fn tolerance(&self, id: &str, expected: f64) -> Result<Tolerance, ReferenceError> {
        Ok(self.registry.check(id)?.tolerance(expected))
    }

    /// A negative control: passes if, of the checks that were run on what it spoils, the one it names failed.
    ///
    /// # Errors
    /// [`ReferenceError::Undeclared`] if the registry does not declare it.
    pub fn control(&self, id: &str, judged: &[Check]) -> Result<Check, ReferenceError> {
        let ControlEntry { spoils, breaks, time_grid_only, .. } = self.registry.control(id)?;
        let broken = judged.iter().find(|c| c.id == *breaks);
        let in_tables = match broken {
            Some(check) if !time_grid_only => self.as_table(check)?,
            _ => None,
        };
        let word = match broken.map(|c| c.status) {
            Some(Status::Fail) if in_tables.is_some_and(|c| c.status == Status::Pass) => {
                "passes as a table"
            }
            Some(Status::Fail) => "fails",
            Some(_) => "passes",
            None => "is not there",
        };
        let title = format!("{spoils}: {breaks} must fail");
        let subject = Subject {
            id,
            title: &title,
            kind: ReferenceKind::Consistency,
            source: "a check that cannot fail shows nothing",
            unit: "",
        };
        Ok(Check::equal(subject, "fails", word))
    }
}

impl Reference {
    /// A check by the tolerance for tables of another program; `None` where it has no such.
    pub(crate) fn as_table(&self, check: &Check) -> Result<Option<Check>, ReferenceError> {
        let entry = self.registry.check(&check.id)?;
        let (Some(absolute), Value::Number(expected), Some(Value::Number(actual))) =
            (entry.tables_absolute, &check.expected, &check.actual)
        else {
            return Ok(None);
        };
        let tolerance = Tolerance { absolute, band: None, reason: entry.tables_reason.clone() };
        let status = match tolerance.allows(actual - expected) {
            true => Status::Pass,
            false => Status::Fail,
        };
        Ok(Some(Check { tolerance, status, ..check.clone() }))
    }
}

impl ModeTable {
    /// Type and lumped frequency (Hz) of each row; rows without either compare nothing.
    pub fn lumped_rows(&self) -> impl Iterator<Item = (&str, &f64)> {
        self.rows(&self.lumped_hz)
    }

    /// Type and FE/contact frequency (Hz) of each row.
    pub fn fe_contact_rows(&self) -> impl Iterator<Item = (&str, &f64)> {
        self.rows(&self.fe_contact_hz)
    }

    fn rows<'t>(&'t self, column: &'t [f64]) -> impl Iterator<Item = (&'t str, &'t f64)> {
        // A column that is too short must not shorten the table.
        let padded = column.iter().chain(std::iter::repeat(&f64::NAN));
        self.mode_type.iter().map(String::as_str).zip(padded)
    }
}

impl Strengths {
    /// Harmonic and strength.
    pub fn rows(&self) -> impl Iterator<Item = (u32, f64)> {
        let padded = self.values.iter().copied().chain(std::iter::repeat(f64::NAN));
        self.harmonics.iter().copied().zip(padded)
    }
}
