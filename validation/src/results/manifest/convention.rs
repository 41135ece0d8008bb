//! The coordinates in which an author writes vectors and matrices: `[convention]` of `results.toml`.

use gearset::Facing;
use serde::Serialize;

/// Order of bodies in vectors and matrices where none is given.
pub(in crate::results) const ORDER: [&str; 4] = ["carrier", "ring", "sun", "planets"];

/// How vectors and matrices are to be read.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Convention {
    /// Order of the bodies.
    pub order: Vec<String>,
    /// Translations of planets.
    pub planets: PlanetTranslations,
    /// What stands for a rotation.
    pub rotation: RotationCoordinate,
    /// The radius in u = r θ.
    pub radius: Radius,
    /// Positive sense of rotations.
    pub sense: Facing,
}

/// The two coordinates of a planet's translation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlanetTranslations {
    /// Radial ζ_n, outwards along (cos ψ_n, sin ψ_n), and tangential η_n, along (−sin ψ_n, cos ψ_n).
    RadialTangential,
    /// Along the axes x and y of the central members.
    #[serde(rename = "x_y")]
    XY,
}

/// The coordinate of a rotation θ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RotationCoordinate {
    /// u = r θ, m.
    Arc,
    /// θ, rad.
    Angle,
}

/// The radius in u = r θ of a gear; of the carrier it is the centre distance, of an angle there is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Radius {
    /// Base radius.
    Base,
    /// Operating pitch radius r_b/cos α; of a planet that of its sun mesh.
    Pitch,
}

impl Default for Convention {
    fn default() -> Self {
        Self {
            order: ORDER.map(str::to_owned).to_vec(),
            planets: PlanetTranslations::RadialTangential,
            rotation: RotationCoordinate::Arc,
            radius: Radius::Base,
            sense: Facing::CounterClockwise,
        }
    }
}

impl Convention {
    /// Every other convention, those that differ in fewer keys first.
    pub(in crate::results) fn others(&self) -> Vec<Self> {
        let mut all = Vec::new();
        let planets = [PlanetTranslations::RadialTangential, PlanetTranslations::XY];
        // The radius counts for arcs alone.
        let rotations = [
            (RotationCoordinate::Arc, Radius::Base),
            (RotationCoordinate::Arc, Radius::Pitch),
            (RotationCoordinate::Angle, self.radius),
        ];
        for order in orders() {
            for planets in planets {
                for (rotation, radius) in rotations {
                    for sense in [Facing::CounterClockwise, Facing::Clockwise] {
                        let order = order.map(str::to_owned).to_vec();
                        all.push(Self { order, planets, rotation, radius, sense });
                    }
                }
            }
        }
        all.retain(|other| other != self);
        all.sort_by_key(|other| other.differences(self).len());
        all
    }

    /// Keys in which it differs from another, as `results.toml` has them.
    pub(in crate::results) fn differences(&self, other: &Self) -> Vec<String> {
        let mut keys = Vec::new();
        if self.order != other.order {
            let order: Vec<String> = self.order.iter().map(|body| format!("\"{body}\"")).collect();
            keys.push(format!("order = [{}]", order.join(", ")));
        }
        let mut differ = |key: &str, is_same: bool, word: &str| {
            if !is_same {
                keys.push(format!("{key} = \"{word}\""));
            }
        };
        let planets = match self.planets {
            PlanetTranslations::RadialTangential => "radial_tangential",
            PlanetTranslations::XY => "x_y",
        };
        differ("planets", self.planets == other.planets, planets);
        let rotation = match self.rotation {
            RotationCoordinate::Arc => "arc",
            RotationCoordinate::Angle => "angle",
        };
        differ("rotation", self.rotation == other.rotation, rotation);
        let radius = match self.radius {
            Radius::Base => "base",
            Radius::Pitch => "pitch",
        };
        differ("radius", self.radius == other.radius, radius);
        let sense = match self.sense {
            Facing::CounterClockwise => "counter_clockwise",
            Facing::Clockwise => "clockwise",
        };
        differ("sense", self.sense == other.sense, sense);
        keys
    }
}

/// All orders of the bodies.
fn orders() -> Vec<[&'static str; 4]> {
    let mut all = vec![];
    for a in 0..4 {
        for b in (0..4).filter(|b| *b != a) {
            for c in (0..4).filter(|c| *c != a && *c != b) {
                all.push([a, b, c, 6 - a - b - c].map(|k| ORDER[k]));
            }
        }
    }
    all
}
