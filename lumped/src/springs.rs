//! The springs of the model and their deflections: the one place that defines signs.

use gearset::{Axis, Body};
use serde::Serialize;

use crate::coordinates::Coordinates;

/// What a spring is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SpringId {
    /// Sun–planet mesh of planet n.
    SunMesh(usize),
    /// Ring–planet mesh of planet n.
    RingMesh(usize),
    /// Bearing between planet n and the carrier, both directions.
    PlanetBearing(usize),
    /// Bearing of a central member, both directions.
    CentralBearing(Body),
    /// Torsional support of a central member.
    Torsional(Body),
}

impl SpringId {
    /// Name of the family this spring belongs to.
    pub fn family(self) -> String {
        match self {
            Self::SunMesh(_) => "sun_mesh".into(),
            Self::RingMesh(_) => "ring_mesh".into(),
            Self::PlanetBearing(_) => "planet_bearing".into(),
            Self::CentralBearing(body) => format!("{}_bearing", body.kind_name()),
            Self::Torsional(body) => format!("{}_torsion", body.kind_name()),
        }
    }
}

/// A spring: potential energy ½ k Σ (bᵀ q)² over its rows b.
#[derive(Debug, Clone)]
pub struct Spring {
    /// What it is.
    pub id: SpringId,
    /// k, N/m.
    pub stiffness: f64,
    /// Rows b as (free coordinate, coefficient).
    pub rows: Vec<Vec<(usize, f64)>>,
}

impl Spring {
    /// Deflection of row `row` for displacements `q`.
    pub fn deflection(&self, row: usize, q: impl Fn(usize) -> f64) -> f64 {
        self.rows[row].iter().map(|&(i, b)| b * q(i)).sum()
    }
}

/// Builds rows on the free coordinates.
pub(crate) struct Rows<'c> {
    pub(crate) coordinates: &'c Coordinates,
}

impl Rows<'_> {
    fn row(&self, entries: &[(Body, Axis, f64)]) -> Vec<(usize, f64)> {
        let on_free =
            |&(body, axis, b): &(Body, Axis, f64)| Some((self.coordinates.of(body, axis)?, b));
        entries.iter().filter_map(on_free).collect()
    }

    /// `[eq:sun-mesh]` δ_sn = −x_s sin ψ_sn + y_s cos ψ_sn + u_s − ζ_n sin α_s − η_n cos α_s + u_n, sun mesh of
    /// planet n at ψ with the operating pressure angle α_s and ψ_sn = ψ_n − α_s.
    ///
    /// Source: Lin & Parker (1999), J. Vib. Acoust. 121, 316–321.
    /// Checked by: `lumped/tests/hand_matrices.rs::mesh_deflections_are_what_the_material_points_do`,
    /// `lin_parker_1999`, `table2.lumped`, `table3.lumped`.
    pub(crate) fn sun_mesh(&self, n: usize, psi: f64, alpha: f64) -> Vec<(usize, f64)> {
        let (sin, cos) = (psi - alpha).sin_cos();
        let planet = Body::Planet(n);
        self.row(&[
            (Body::Sun, Axis::First, -sin),
            (Body::Sun, Axis::Second, cos),
            (Body::Sun, Axis::Rotation, 1.0),
            (planet, Axis::First, -alpha.sin()),
            (planet, Axis::Second, -alpha.cos()),
            (planet, Axis::Rotation, 1.0),
        ])
    }

    /// `[eq:ring-mesh]` δ_rn = −x_r sin ψ_rn + y_r cos ψ_rn + u_r + ζ_n sin α_r − η_n cos α_r − u_n, ring mesh of
    /// planet n at ψ with the operating pressure angle α_r and ψ_rn = ψ_n + α_r.
    ///
    /// Source: Lin & Parker (1999), J. Vib. Acoust. 121, 316–321.
    /// Checked by: `lumped/tests/hand_matrices.rs::mesh_deflections_are_what_the_material_points_do`,
    /// `lin_parker_1999`, `table2.lumped`, `table3.lumped`.
    pub(crate) fn ring_mesh(&self, n: usize, psi: f64, alpha: f64) -> Vec<(usize, f64)> {
        let (sin, cos) = (psi + alpha).sin_cos();
        let planet = Body::Planet(n);
        self.row(&[
            (Body::Ring, Axis::First, -sin),
            (Body::Ring, Axis::Second, cos),
            (Body::Ring, Axis::Rotation, 1.0),
            (planet, Axis::First, alpha.sin()),
            (planet, Axis::Second, -alpha.cos()),
            (planet, Axis::Rotation, -1.0),
        ])
    }

    /// Approach of the backside flanks of a sun mesh: that of the mesh mirrored about the line of centres,
    /// for which tangential displacements and u change sign.
    pub(crate) fn sun_backside(&self, n: usize, psi: f64, alpha: f64) -> Vec<(usize, f64)> {
        turned(self.sun_mesh(n, psi, -alpha))
    }

    /// The same for a ring mesh.
    pub(crate) fn ring_backside(&self, n: usize, psi: f64, alpha: f64) -> Vec<(usize, f64)> {
        turned(self.ring_mesh(n, psi, -alpha))
    }

    /// `[eq:planet-bearing]` Deflection of planet n's bearing: radial x_c cos ψ_n + y_c sin ψ_n − ζ_n, tangential
    /// −x_c sin ψ_n + y_c cos ψ_n + u_c − η_n.
    ///
    /// Source: Lin & Parker (1999), J. Vib. Acoust. 121, 316–321.
    /// Checked by: `lumped/tests/hand_matrices.rs::stiffness_matrix_of_one_planet_at_zero`, `table2.lumped`,
    /// `table3.lumped`.
    pub(crate) fn planet_bearing(&self, n: usize, psi: f64) -> Vec<Vec<(usize, f64)>> {
        let (sin, cos) = psi.sin_cos();
        let planet = Body::Planet(n);
        let radial = self.row(&[
            (Body::Carrier, Axis::First, cos),
            (Body::Carrier, Axis::Second, sin),
            (planet, Axis::First, -1.0),
        ]);
        let tangential = self.row(&[
            (Body::Carrier, Axis::First, -sin),
            (Body::Carrier, Axis::Second, cos),
            (Body::Carrier, Axis::Rotation, 1.0),
            (planet, Axis::Second, -1.0),
        ]);
        vec![radial, tangential]
    }

    /// Translation of a central member.
    pub(crate) fn central_bearing(&self, body: Body) -> Vec<Vec<(usize, f64)>> {
        let one = |axis| self.row(&[(body, axis, 1.0)]);
        vec![one(Axis::First), one(Axis::Second)]
    }

    /// Rotation of a central member.
    pub(crate) fn torsion(&self, body: Body) -> Vec<Vec<(usize, f64)>> {
        vec![self.row(&[(body, Axis::Rotation, 1.0)])]
    }
}

fn turned(row: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    row.into_iter().map(|(i, b)| (i, -b)).collect()
}
