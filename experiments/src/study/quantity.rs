//! Quantities of interest: what is asked of every setting.

use gearset::MeshKind;
use lumped::ModeType;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::error::StudyError;
use super::experiment::{Action, Experiment};
use crate::sweep::{Part, Response};

/// Kinds of quantities.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum QuantityKind {
    /// Natural frequency: `mode_type`, and `number` among the distinct frequencies of that type, from 1; Hz.
    NaturalFrequency,
    /// Mean of the transmission error r_b θ of the sun over a mesh cycle at rest; `positions`; m.
    TransmissionErrorMean,
    /// Its largest less its smallest value; `positions`; m.
    TransmissionErrorPeakToPeak,
    /// Amplitude of one `harmonic` of it; `positions`; m.
    TransmissionErrorHarmonic,
    /// Largest share that one mesh takes of the force of all meshes of its kind over a mesh cycle at rest; `mesh`,
    /// `positions`.
    LoadShare,
    /// Mean of force over approach of the meshes of a kind over a mesh cycle at rest; `mesh`, `positions`; N/m.
    MeshStiffness,
    /// Largest cell pressure of a mesh alone, under the even share of the load at one `phase`, of pairs on the path of
    /// contact: pressure at a tip corner is singular; `mesh`; Pa.
    PeakPressure,
    /// Height of the resonant peak of one `harmonic` of the `motion` of a `part` over `speeds_rpm`; m or rad.
    ResonantAmplitude,
    /// Speed of the input member at that peak; rpm.
    ResonantSpeed,
    /// Height of that peak under `sun_torque_nm` over its height under `reference_torque_nm` on the sun, each about its
    /// own loaded configuration.
    TorqueRatio,
    /// Amplitude of one `harmonic` of the `motion` of a `part` at one `speed_rpm`; m or rad.
    Amplitude,
    /// Size of the largest Floquet multiplier of the steady state at one `speed_rpm`.
    LargestMultiplier,
}

/// Counted work that can stand in the place of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum WorkKind {
    /// Time steps.
    Steps,
    /// Time steps times the coordinates that are stepped.
    StepCoordinates,
    /// Solutions for the forces of all meshes.
    ContactSolutions,
    /// Iterations of equilibrium and contact at rest.
    Iterations,
    /// Derivatives of mesh cycles.
    Derivatives,
    /// Degrees of freedom of the finite elements of all gears.
    FeUnknowns,
    /// Contact cells of one tooth pair.
    ContactCells,
    /// Memory of gears, contact tables, maps and frames.
    Bytes,
}

/// What can be varied: translation or rotation of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Motion {
    Rotation,
    Translation,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Type {
    Rotational,
    Translational,
    Planet,
    Mixed,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Mesh {
    SunPlanet,
    RingPlanet,
}

impl From<Mesh> for MeshKind {
    fn from(mesh: Mesh) -> Self {
        match mesh {
            Mesh::SunPlanet => Self::SunPlanet,
            Mesh::RingPlanet => Self::RingPlanet,
        }
    }
}

/// `[[quantity]]` of a study file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct QuantityInput {
    pub(super) name: String,
    kind: QuantityKind,
    mode_type: Option<Type>,
    number: Option<usize>,
    positions: Option<usize>,
    harmonic: Option<usize>,
    mesh: Option<Mesh>,
    phase: Option<f64>,
    part: Option<String>,
    motion: Option<Motion>,
    speed_rpm: Option<f64>,
    speeds_rpm: Option<Vec<f64>>,
    refine: Option<bool>,
    sun_torque_nm: Option<f64>,
    reference_torque_nm: Option<f64>,
    work: Option<WorkKind>,
}

/// How a quantity is read from what an experiment gave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Reading {
    Frequency { mode_type: ModeType, number: usize },
    ErrorMean,
    ErrorPeakToPeak,
    ErrorHarmonic(usize),
    LoadShare(MeshKind),
    Stiffness(MeshKind),
    Pressure,
    PeakHeight,
    PeakSpeed,
    PeakRatio,
    Amplitude { response: Response, harmonic: usize },
    Multiplier,
}

/// A quantity that can be asked for.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quantity {
    pub(super) name: String,
    pub(super) kind: QuantityKind,
    pub(super) experiment: Experiment,
    pub(super) reading: Reading,
    pub(super) work: WorkKind,
    pub(super) unit: &'static str,
}

/// Positions of a mesh cycle unless a quantity says otherwise: a multiple of the denominators of OH-58's phases.
const POSITIONS: usize = 28;

/// Highest harmonic kept of steady states.
pub(super) const HARMONICS: usize = 5;

impl QuantityInput {
    /// The quantity, all its keys checked.
    pub(super) fn quantity(&self) -> Result<Quantity, StudyError> {
        use QuantityKind as K;
        let (wanted, optional): (&[&str], &[&str]) = match self.kind {
            K::NaturalFrequency => (&["mode_type", "number"], &[]),
            K::TransmissionErrorMean | K::TransmissionErrorPeakToPeak => (&[], &["positions"]),
            K::TransmissionErrorHarmonic => (&["harmonic"], &["positions"]),
            K::LoadShare | K::MeshStiffness => (&["mesh"], &["positions"]),
            K::PeakPressure => (&["mesh", "phase"], &[]),
            K::ResonantAmplitude | K::ResonantSpeed => {
                (&["part", "motion", "harmonic", "speeds_rpm"], &["refine"])
            }
            K::TorqueRatio => {
                (&["part", "motion", "harmonic", "speeds_rpm", "reference_torque_nm"], &["refine"])
            }
            K::Amplitude => (&["part", "motion", "harmonic", "speed_rpm"], &[]),
            K::LargestMultiplier => (&["speed_rpm"], &[]),
        };
        self.has_keys(wanted, optional)?;
        let (action, reading, unit, work) = self.parts()?;
        let sun_torque_nm = self.sun_torque_nm;
        let torques =
            [("sun_torque_nm", sun_torque_nm), ("reference_torque_nm", self.reference_torque_nm)];
        for (key, torque) in torques {
            if let Some(torque) = torque.filter(|t| !t.is_finite() || *t == 0.0) {
                let allowed = "a finite number other than 0";
                return Err(StudyError::key(self.at(key), torque, allowed));
            }
        }
        let experiment = Experiment { sun_torque_nm, action };
        Ok(Quantity {
            name: self.name.clone(),
            kind: self.kind,
            experiment,
            reading,
            work: self.work.unwrap_or(work),
            unit,
        })
    }

    fn parts(&self) -> Result<(Action, Reading, &'static str, WorkKind), StudyError> {
        use QuantityKind as K;
        let mesh = MeshKind::from(self.mesh.unwrap_or(Mesh::SunPlanet));
        let number = self.number.unwrap_or(1);
        let harmonic = self.harmonic.unwrap_or(1);
        self.within("number", number as f64, [1.0, 1e3])?;
        self.within("harmonic", harmonic as f64, [1.0, HARMONICS as f64])?;
        let positions = self.positions.unwrap_or(POSITIONS);
        self.within("positions", positions as f64, [4.0, 1e4])?;
        let cycle = Action::MeshCycle { positions };
        let at_rest = |reading, unit| (cycle.clone(), reading, unit, WorkKind::Iterations);
        let speed_rpm = self.speed_rpm.unwrap_or(f64::NAN);
        Ok(match self.kind {
            K::NaturalFrequency => {
                let mode_type = match self.mode_type {
                    Some(Type::Rotational) => ModeType::Rotational,
                    Some(Type::Translational) => ModeType::Translational,
                    Some(Type::Planet) => ModeType::Planet,
                    Some(Type::Mixed) | None => ModeType::Mixed,
                };
                let reading = Reading::Frequency { mode_type, number };
                (Action::Modes, reading, "Hz", WorkKind::FeUnknowns)
            }
            K::TransmissionErrorMean => at_rest(Reading::ErrorMean, "m"),
            K::TransmissionErrorPeakToPeak => at_rest(Reading::ErrorPeakToPeak, "m"),
            K::TransmissionErrorHarmonic => at_rest(Reading::ErrorHarmonic(harmonic), "m"),
            K::LoadShare => at_rest(Reading::LoadShare(mesh), "1"),
            K::MeshStiffness => at_rest(Reading::Stiffness(mesh), "N/m"),
            K::PeakPressure => {
                let phase = self.phase.unwrap_or(0.0);
                self.within("phase", phase, [0.0, 1.0])?;
                (Action::Pressure { mesh, phase }, Reading::Pressure, "Pa", WorkKind::ContactCells)
            }
            K::ResonantAmplitude | K::ResonantSpeed | K::TorqueRatio => {
                let speeds_rpm = self.speeds()?;
                let (response, unit) = self.response()?;
                let is_refined = self.refine.unwrap_or(true);
                let action = Action::Peak { speeds_rpm, response, harmonic, is_refined };
                let (action, reading, unit) = match (self.kind, self.reference_torque_nm) {
                    (K::ResonantSpeed, _) => (action, Reading::PeakSpeed, "rpm"),
                    (K::TorqueRatio, Some(reference_nm)) => {
                        let action = Action::PeakRatio { peak: Box::new(action), reference_nm };
                        (action, Reading::PeakRatio, "1")
                    }
                    _ => (action, Reading::PeakHeight, unit),
                };
                (action, reading, unit, WorkKind::StepCoordinates)
            }
            K::Amplitude => {
                self.speed("speed_rpm", speed_rpm)?;
                let (response, unit) = self.response()?;
                let reading = Reading::Amplitude { response, harmonic };
                (Action::Motion { speed_rpm }, reading, unit, WorkKind::StepCoordinates)
            }
            K::LargestMultiplier => {
                self.speed("speed_rpm", speed_rpm)?;
                (Action::Motion { speed_rpm }, Reading::Multiplier, "1", WorkKind::StepCoordinates)
            }
        })
    }

    fn response(&self) -> Result<(Response, &'static str), StudyError> {
        let name = self.part.as_deref().unwrap_or("");
        let part =
            Part::named(name).filter(|part| !matches!(part, Part::SunMesh(_) | Part::RingMesh(_)));
        let allowed = "carrier, ring, sun, planet_0, planet_1, …";
        let part =
            part.ok_or_else(|| StudyError::key(self.at("part"), format!("{name:?}"), allowed))?;
        Ok(match self.motion {
            Some(Motion::Translation) => (Response::Translation(part), "m"),
            _ => (Response::Rotation(part), "rad"),
        })
    }

    fn speeds(&self) -> Result<Vec<f64>, StudyError> {
        let list = self.speeds_rpm.clone().unwrap_or_default();
        list.iter().try_for_each(|speed| self.speed("speeds_rpm", *speed))?;
        if list.len() < 3 || list.windows(2).any(|w| w[0] >= w[1]) {
            let allowed = "three speeds or more, ascending: a peak lies between two others";
            return Err(StudyError::key(self.at("speeds_rpm"), format!("{list:?}"), allowed));
        }
        Ok(list)
    }

    fn speed(&self, key: &str, speed: f64) -> Result<(), StudyError> {
        if scene::is_speed(speed) {
            return Ok(());
        }
        let [least, most] = scene::SPEEDS_RPM;
        let allowed = format!("from {least} to {most:e} rpm");
        Err(StudyError::key(self.at(key), speed, allowed))
    }

    fn within(&self, key: &str, value: f64, [low, high]: [f64; 2]) -> Result<(), StudyError> {
        match (low..=high).contains(&value) {
            true => Ok(()),
            false => Err(StudyError::key(self.at(key), value, format!("from {low} to {high}"))),
        }
    }

    fn at(&self, key: &str) -> String {
        format!("quantity.{key} of {:?}", self.name)
    }

    /// Refuses keys that the kind lacks or does not have.
    fn has_keys(&self, wanted: &[&str], optional: &[&str]) -> Result<(), StudyError> {
        let given = [
            ("mode_type", self.mode_type.is_some()),
            ("number", self.number.is_some()),
            ("positions", self.positions.is_some()),
            ("harmonic", self.harmonic.is_some()),
            ("mesh", self.mesh.is_some()),
            ("phase", self.phase.is_some()),
            ("part", self.part.is_some()),
            ("motion", self.motion.is_some()),
            ("speed_rpm", self.speed_rpm.is_some()),
            ("speeds_rpm", self.speeds_rpm.is_some()),
            ("refine", self.refine.is_some()),
            ("reference_torque_nm", self.reference_torque_nm.is_some()),
        ];
        let keys = wanted.iter().chain(optional).copied().collect::<Vec<_>>();
        for (key, is_given) in given {
            if wanted.contains(&key) && !is_given {
                let allowed = format!("a quantity of this kind needs {}", wanted.join(", "));
                return Err(StudyError::key(self.at(key), "absent", allowed));
            }
            if is_given && !keys.contains(&key) {
                let allowed = match keys.is_empty() {
                    true => "no key but name, kind, sun_torque_nm and work for this kind".into(),
                    false => format!(
                        "name, kind, sun_torque_nm, work, {} for this kind",
                        keys.join(", ")
                    ),
                };
                return Err(StudyError::key(self.at(key), "given", allowed));
            }
        }
        Ok(())
    }
}
