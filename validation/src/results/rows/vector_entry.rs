//! Titles of the columns that hold vectors of modes.

use gearset::Body;

use super::MOST;

/// One coordinate of the vector of a mode: a column `carrier_x`, `sun_u`, `planet_0_radial` and so on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VectorEntry {
    /// The body.
    pub body: Body,
    /// Along what it moves.
    pub axis: VectorAxis,
    /// The number, in the unit of the author's coordinate times any factor of the vector.
    pub value: f64,
}

/// Along what a body moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VectorAxis {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Of a planet: outwards.
    Radial,
    /// Of a planet: along (−sin ψ, cos ψ).
    Tangential,
    /// A rotation, in the coordinate that `[convention]` of `results.toml` says.
    Rotation,
}

impl VectorAxis {
    const ALL: [Self; 5] = [Self::X, Self::Y, Self::Radial, Self::Tangential, Self::Rotation];

    /// End of the title of its column.
    fn name(self) -> &'static str {
        match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Radial => "radial",
            Self::Tangential => "tangential",
            Self::Rotation => "u",
        }
    }

    /// Title of the column: `planet_0_radial`.
    pub(in crate::results) fn title(self, body: Body) -> String {
        format!("{}_{}", body.name(), self.name())
    }
}

/// Body and axis of a column with that title, in lower case with words joined by `_`.
pub(super) fn vector_column(title: &str) -> Option<(Body, VectorAxis)> {
    let (body, axis) = title.rsplit_once('_')?;
    let body = Body::named(body)?;
    let axis = VectorAxis::ALL.into_iter().find(|known| known.name() == axis)?;
    let is_planet = matches!(body, Body::Planet(n) if n < MOST);
    let is_of_planets = matches!(axis, VectorAxis::Radial | VectorAxis::Tangential);
    (is_planet || (body.index() < 3 && !is_of_planets)).then_some((body, axis))
}
