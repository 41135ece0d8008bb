//! One speed of a sweep: what the steady state gives, and its rows in the tidy table.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::steady::Steady;
use crate::error::ExperimentError;

/// What a line is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// Carrier.
    Carrier,
    /// Ring.
    Ring,
    /// Sun.
    Sun,
    /// Planet n.
    Planet(usize),
    /// Mesh of the sun with planet n.
    SunMesh(usize),
    /// Mesh of planet n with the ring.
    RingMesh(usize),
}

impl Part {
    /// As tables print it: `planet_0`, `sun_mesh_0`.
    pub fn name(self) -> String {
        match self {
            Self::Carrier => "carrier".into(),
            Self::Ring => "ring".into(),
            Self::Sun => "sun".into(),
            Self::Planet(n) => format!("planet_{n}"),
            Self::SunMesh(n) => format!("sun_mesh_{n}"),
            Self::RingMesh(n) => format!("ring_mesh_{n}"),
        }
    }

    /// Body number k: carrier, ring, sun, planets.
    pub fn body(k: usize) -> Self {
        match k {
            0 => Self::Carrier,
            1 => Self::Ring,
            2 => Self::Sun,
            n => Self::Planet(n - 3),
        }
    }
}

/// Which quantity of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Coordinate {
    /// Displacement towards planet 0, or away from the centre for a planet, m.
    Radial,
    /// Displacement at right angles to it, m.
    Tangential,
    /// Rotation, rad.
    Rotation,
    /// Mesh force, N.
    Force,
    /// Largest share of all sun (ring) meshes' force in the cycle.
    Share,
    /// Part of the cycle without force.
    ContactLoss,
}

impl Coordinate {
    /// The displacements in order.
    pub const DISPLACEMENTS: [Self; 3] = [Self::Radial, Self::Tangential, Self::Rotation];

    /// As tables print it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Radial => "radial",
            Self::Tangential => "tangential",
            Self::Rotation => "rotation",
            Self::Force => "force",
            Self::Share => "share",
            Self::ContactLoss => "contact_loss",
        }
    }

    /// Unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Radial | Self::Tangential => "m",
            Self::Rotation => "rad",
            Self::Force => "N",
            Self::Share | Self::ContactLoss => "1",
        }
    }
}

/// One harmonic of one quantity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Line {
    /// Body or mesh.
    pub part: Part,
    /// Quantity.
    pub coordinate: Coordinate,
    /// Harmonic l of the mesh frequency; 0 is the mean.
    pub harmonic: usize,
    /// Amplitude in the quantity's unit.
    pub amplitude: f64,
    /// Phase φ of A cos(2π l f_m t + φ), t from position 0 of the mesh cycle, rad.
    pub phase_rad: f64,
}

/// A steady state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SweepPoint {
    /// Speed of the input member, rpm.
    pub speed_rpm: f64,
    /// f_m, Hz.
    pub mesh_frequency_hz: f64,
    /// Cycles marched.
    pub cycles: usize,
    /// Change of the last two cycles over the largest peak-to-peak vibration.
    pub residual: f64,
    /// Whether that is within the tolerance.
    pub is_steady: bool,
    /// Energy between mesh harmonics over all vibration.
    pub between: Option<f64>,
    /// Part of the cycle in which back flanks press.
    pub back_contact: f64,
    /// How often the load the tables are made for was doubled.
    pub size: usize,
    /// What approaches of tooth pairs are off their linear form about the mean loaded configuration at
    /// most, m; absent where meshes follow a law.
    pub kinematic_rest_m: Option<f64>,
    /// The same over the sun's largest peak-to-peak motion: x, y, or rotation at the base circle.
    pub kinematic_rest_share: Option<f64>,
    /// Whether that is worth a warning.
    pub is_beyond_linear: bool,
    /// Harmonics of everything.
    pub lines: Vec<Line>,
}

/// One row of the tidy table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TableRow {
    /// Scene.
    pub scene: String,
    /// Fidelity or model.
    pub fidelity: String,
    /// Torque on the sun, N m.
    pub torque_nm: f64,
    /// Speed of the input member, rpm.
    pub speed_rpm: f64,
    /// f_m, Hz.
    pub mesh_frequency_hz: f64,
    /// Chain of the plan, which also says the direction.
    pub chain: String,
    /// Body or mesh.
    pub body: String,
    /// Quantity.
    pub coordinate: String,
    /// Harmonic; 0 is the mean.
    pub harmonic: usize,
    /// Amplitude.
    pub amplitude: f64,
    /// Its unit.
    pub unit: String,
    /// Phase, rad.
    pub phase_rad: f64,
    /// Cycles marched.
    pub cycles: usize,
    /// Change of the last two cycles.
    pub residual: f64,
}

impl SweepPoint {
    /// From a steady state at a speed (rpm) and mesh frequency (Hz).
    ///
    /// # Errors
    /// If the record is not finite.
    pub fn new(
        speed_rpm: f64,
        mesh_frequency_hz: f64,
        found: &Steady,
        settings: &super::SteadySettings,
        size: usize,
    ) -> Result<Self, ExperimentError> {
        let record = &found.record;
        let mut lines = Vec::new();
        let mut add = |part: Part, coordinate, channel| -> Result<(), ExperimentError> {
            let all = record.harmonics(channel, 1, settings.harmonics)?;
            lines.extend(all.into_iter().enumerate().map(|(harmonic, [re, im])| Line {
                part,
                coordinate,
                harmonic,
                amplitude: re.hypot(im),
                phase_rad: im.atan2(re),
            }));
            Ok(())
        };
        for body in 0..record.bodies() {
            for (axis, coordinate) in Coordinate::DISPLACEMENTS.into_iter().enumerate() {
                add(Part::body(body), coordinate, 3 * body + axis)?;
            }
        }
        let planets = record.bodies() - 3;
        let part = |mesh: usize| match mesh < planets {
            true => Part::SunMesh(mesh),
            false => Part::RingMesh(mesh - planets),
        };
        let first = record.displacements();
        for mesh in 0..2 * planets {
            add(part(mesh), Coordinate::Force, first + mesh)?;
        }
        let forces: Vec<Vec<f64>> =
            (0..2 * planets).map(|mesh| record.channel(first + mesh)).collect();
        let steps = record.len().max(1) as f64;
        for side in 0..2 {
            let side = side * planets..(side + 1) * planets;
            let total: Vec<f64> = (0..record.len())
                .map(|k| forces[side.clone()].iter().map(|f| f[k]).sum())
                .collect();
            for mesh in side {
                let share = forces[mesh].iter().zip(&total);
                let share = share.map(|(f, all)| if *all > 0.0 { f / all } else { 0.0 });
                let lost = forces[mesh].iter().filter(|f| **f <= 0.0).count() as f64 / steps;
                let single = |coordinate, amplitude| Line {
                    part: part(mesh),
                    coordinate,
                    harmonic: 0,
                    amplitude,
                    phase_rad: 0.0,
                };
                lines.push(single(Coordinate::Share, share.fold(0.0f64, f64::max)));
                lines.push(single(Coordinate::ContactLoss, lost));
            }
        }
        Ok(Self {
            speed_rpm,
            mesh_frequency_hz,
            cycles: found.cycles,
            residual: found.residual,
            is_steady: found.residual <= settings.tolerance,
            between: found.between,
            back_contact: record.with_backs as f64 / steps,
            size,
            kinematic_rest_m: found.rest.map(|rest| rest.largest),
            kinematic_rest_share: found.rest.and_then(|rest| rest.share),
            is_beyond_linear: found.rest.is_some_and(|rest| rest.is_worth_a_warning()),
            lines,
        })
    }

    /// Amplitude of one harmonic of one quantity; 0 if it is not kept.
    pub fn amplitude(&self, part: Part, coordinate: Coordinate, harmonic: usize) -> f64 {
        self.line(part, coordinate, harmonic).map_or(0.0, |line| line.amplitude)
    }

    /// One harmonic of one quantity.
    pub fn line(&self, part: Part, coordinate: Coordinate, harmonic: usize) -> Option<&Line> {
        self.lines
            .iter()
            .find(|l| l.part == part && l.coordinate == coordinate && l.harmonic == harmonic)
    }
}
