//! A steady state: harmonics of all bodies and mesh forces at one speed and load, whichever model it is of.

use gearset::Body;
use scene::LoadCase;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::peaks::Response;

/// What a line is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// Mesh of the sun with planet n.
    SunMesh(usize),
    /// Mesh of planet n with the ring.
    RingMesh(usize),
    /// A body.
    #[serde(untagged)]
    Body(Body),
}

impl Part {
    /// The carrier.
    pub const CARRIER: Self = Self::Body(Body::Carrier);
    /// The ring.
    pub const RING: Self = Self::Body(Body::Ring);
    /// The sun.
    pub const SUN: Self = Self::Body(Body::Sun);

    /// As tables print it: `planet_0`, `sun_mesh_0`.
    pub fn name(self) -> String {
        match self {
            Self::Body(body) => body.name(),
            Self::SunMesh(n) => format!("sun_mesh_{n}"),
            Self::RingMesh(n) => format!("ring_mesh_{n}"),
        }
    }

    /// The part that tables call so.
    pub fn named(name: &str) -> Option<Self> {
        let numbered = |prefix: &str| name.strip_prefix(prefix)?.parse::<usize>().ok();
        Body::named(name)
            .map(Self::Body)
            .or_else(|| numbered("sun_mesh_").map(Self::SunMesh))
            .or_else(|| numbered("ring_mesh_").map(Self::RingMesh))
    }

    /// Number of the planet it belongs to.
    pub fn planet(self) -> Option<usize> {
        match self {
            Self::Body(Body::Planet(n)) | Self::SunMesh(n) | Self::RingMesh(n) => Some(n),
            Self::Body(_) => None,
        }
    }
}

/// Which quantity of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
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
    /// Part of the cycle without force, 0 to 1.
    ContactLoss,
    /// Lowest mesh force over the cycle, N.
    LowestForce,
    /// Part of the cycle in which backside flanks of the mesh press, 0 to 1; absent for a model without
    /// backside flanks.
    BacksideContact,
    /// √(R² + T²) of the amplitudes R and T of the radial and the tangential displacement in the same
    /// harmonic, m; it has no phase. Written to the tidy table only; for motion along a straight line it is
    /// the amplitude of that motion, for a circular orbit √2 times the radius.
    Translation,
}

impl Coordinate {
    /// All of them.
    const ALL: [Self; 9] = [
        Self::Radial,
        Self::Tangential,
        Self::Rotation,
        Self::Force,
        Self::Share,
        Self::ContactLoss,
        Self::LowestForce,
        Self::BacksideContact,
        Self::Translation,
    ];

    /// The quantity that tables call so.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|c| c.name() == name)
    }

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
            Self::LowestForce => "lowest_force",
            Self::BacksideContact => "backside_contact",
            Self::Translation => "translation",
        }
    }

    /// Unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Radial | Self::Tangential | Self::Translation => "m",
            Self::Rotation => "rad",
            Self::Force | Self::LowestForce => "N",
            Self::Share | Self::ContactLoss | Self::BacksideContact => "1",
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

/// A steady state, periodic in the mesh cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SteadyState {
    /// Speed and load.
    #[serde(flatten)]
    pub case: LoadCase,
    /// Harmonics of everything that is kept.
    pub lines: Vec<Line>,
}

impl SteadyState {
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

    /// The central member whose motion stands for that of the set: the sun, or where that does not turn, because
    /// it is held, the ring or the carrier.
    pub fn turning_member(&self) -> Part {
        let turns = |part: &Part| {
            let rotates = |l: &&Line| l.part == *part && l.coordinate == Coordinate::Rotation;
            self.lines.iter().filter(rotates).any(|l| l.harmonic > 0 && l.amplitude > 0.0)
        };
        [Part::SUN, Part::RING, Part::CARRIER].into_iter().find(turns).unwrap_or(Part::SUN)
    }

    /// The lines with those of each body's [`Coordinate::Translation`] after its rotation, in every harmonic
    /// of vibration (from 1).
    pub fn with_translations(&self) -> Vec<Line> {
        let mut all = Vec::with_capacity(self.lines.len());
        for (i, line) in self.lines.iter().enumerate() {
            all.push(line.clone());
            let next = self.lines.get(i + 1).map(|l| (l.part, l.coordinate));
            let is_last = next != Some((line.part, line.coordinate));
            if line.coordinate != Coordinate::Rotation || !is_last {
                continue;
            }
            let translation = |harmonic: usize| Line {
                coordinate: Coordinate::Translation,
                harmonic,
                amplitude: Response::Translation(line.part).amplitude(self, harmonic),
                phase_rad: 0.0,
                ..line.clone()
            };
            all.extend((1..=line.harmonic).map(translation));
        }
        all
    }
}
