//! Bodies of a set and their coordinates.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A body, in the order used everywhere: carrier, ring, sun, planets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Body {
    /// Carrier.
    Carrier,
    /// Ring.
    Ring,
    /// Sun.
    Sun,
    /// Planet n.
    Planet(usize),
}

impl Body {
    /// The central members in the body order.
    pub const CENTRAL: [Self; 3] = [Self::Carrier, Self::Ring, Self::Sun];

    /// Place in the body order.
    pub fn index(self) -> usize {
        match self {
            Self::Carrier => 0,
            Self::Ring => 1,
            Self::Sun => 2,
            Self::Planet(n) => 3 + n,
        }
    }

    /// The body at a place in the body order.
    pub fn from_index(index: usize) -> Self {
        let central = Self::CENTRAL.get(index).copied();
        central.unwrap_or_else(|| Self::Planet(index - Self::CENTRAL.len()))
    }

    /// Place in lists of carrier, ring, sun and one planet for all.
    pub fn kind(self) -> usize {
        self.index().min(3)
    }

    /// The bodies of a set with `planets` planets, in order.
    pub fn all(planets: usize) -> impl Iterator<Item = Self> {
        Self::CENTRAL.into_iter().chain((0..planets).map(Self::Planet))
    }

    /// Name of the kind of body, as in scene keys.
    pub fn kind_name(self) -> &'static str {
        ["carrier", "ring", "sun", "planet"][self.kind()]
    }

    /// As tables print it: `sun`, `planet_0`.
    pub fn name(self) -> String {
        match self {
            Self::Planet(n) => format!("planet_{n}"),
            _ => self.kind_name().into(),
        }
    }

    /// The body that tables call so.
    pub fn named(name: &str) -> Option<Self> {
        match name.strip_prefix("planet_") {
            Some(number) => number.parse().ok().map(Self::Planet),
            None => Self::CENTRAL.into_iter().find(|body| body.kind_name() == name),
        }
    }
}

/// As messages call it: `sun`, `planet 0`.
impl fmt::Display for Body {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name().replace('_', " "))
    }
}

/// A coordinate of a body: x, y, u of a central member; ζ (radial), η (tangential), u of a planet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// x or ζ.
    First,
    /// y or η.
    Second,
    /// u = r·θ.
    Rotation,
}

impl Axis {
    /// All three, in order.
    pub const ALL: [Self; 3] = [Self::First, Self::Second, Self::Rotation];

    /// The two translations, in order.
    pub const TRANSLATIONS: [Self; 2] = [Self::First, Self::Second];

    /// The displacement of a body along it, as messages call it.
    pub fn displacement(self, body: Body) -> &'static str {
        match (self, body) {
            (Self::First, Body::Planet(_)) => "radial displacement",
            (Self::First, _) => "x displacement",
            (Self::Second, Body::Planet(_)) => "tangential displacement",
            (Self::Second, _) => "y displacement",
            (Self::Rotation, _) => "rotation",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_those_of_the_body_order() {
        for (index, body) in Body::all(4).enumerate() {
            assert_eq!((body.index(), Body::named(&body.name())), (index, Some(body)));
            assert_eq!(Body::from_index(index), body);
        }
        assert_eq!([Body::Sun, Body::Planet(2)].map(|b| b.to_string()), ["sun", "planet 2"]);
        for bad in ["planet", "planet_", "planet_x", "sun_mesh_0", ""] {
            assert_eq!(Body::named(bad), None, "{bad}");
        }
    }
}
