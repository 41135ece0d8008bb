//! Bodies, their coordinates and the numbering of the free coordinates.

use serde::Serialize;

/// A body, in the order used everywhere: carrier, ring, sun, planets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
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
    /// Place in the body order.
    pub fn index(self) -> usize {
        match self {
            Self::Carrier => 0,
            Self::Ring => 1,
            Self::Sun => 2,
            Self::Planet(n) => 3 + n,
        }
    }

    /// The bodies of a set with `planets` planets, in order.
    pub fn all(planets: usize) -> impl Iterator<Item = Self> {
        [Self::Carrier, Self::Ring, Self::Sun].into_iter().chain((0..planets).map(Self::Planet))
    }

    /// Name of the kind of body, as in scene keys.
    pub fn kind_name(self) -> &'static str {
        match self {
            Self::Carrier => "carrier",
            Self::Ring => "ring",
            Self::Sun => "sun",
            Self::Planet(_) => "planet",
        }
    }
}

/// A coordinate of a body: x, y, u of a central member; ζ (radial), η (tangential), u of a planet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
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
}

/// Map from (body, axis) to the index of a free coordinate.
#[derive(Debug, Clone)]
pub struct Coordinates {
    index: Vec<Option<usize>>,
    free: Vec<(Body, Axis)>,
}

impl Coordinates {
    /// Numbers the coordinates that `is_free` admits, body by body.
    pub fn new(planets: usize, is_free: impl Fn(Body, Axis) -> bool) -> Self {
        let mut index = Vec::with_capacity(3 * (3 + planets));
        let mut free = Vec::with_capacity(3 * (3 + planets));
        for body in Body::all(planets) {
            for axis in Axis::ALL {
                let number = is_free(body, axis).then_some(free.len());
                if number.is_some() {
                    free.push((body, axis));
                }
                index.push(number);
            }
        }
        Self { index, free }
    }

    /// Index of a coordinate; `None` if it is held or there is no such planet.
    pub fn of(&self, body: Body, axis: Axis) -> Option<usize> {
        self.index.get(3 * body.index() + axis as usize).copied().flatten()
    }

    /// The free coordinates in order.
    pub fn free(&self) -> &[(Body, Axis)] {
        &self.free
    }

    /// Number of free coordinates.
    pub fn count(&self) -> usize {
        self.free.len()
    }
}
