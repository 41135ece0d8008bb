//! Lines of action that turn as the centres move, and flanks that lean as they are deformed.
//!
//! Let n be the direction of the force on the driven gear, m that direction turned counter-clockwise by a quarter,
//! and L = a sin α the distance between the points where the line of action touches both base circles. It stays
//! tangent to both: if the planet's centre moves by d against the other centre, the line turns by m·d/L
//! ([`Line::turn`]). A sun mesh is a strut that is pressed; the force of a ring mesh pulls the points of contact with
//! the base circles together.
//!
//! The force of a mesh depends on its approach δ = bᵀq and on where along its path it touches, the driver's roll length
//! σ = κᵀq. Under a constant force the approach changes by s = ∂δ/∂σ ([`Line::lean`]), and with the centre distance
//! a' = ζᵀq by s_a = ∂δ/∂a'. In modes that hardly press a mesh, this is a good part of what does.

use gearset::{Axis, Body, Mesh, MeshMember};
use nalgebra::DMatrix;

use crate::model::LumpedModel;
use crate::springs::SpringId;

/// Rows of one mesh besides that of its approach.
#[derive(Debug, Clone)]
pub(super) struct Line {
    id: SpringId,
    /// t.
    across: Vec<(usize, f64)>,
    /// κ, m/m.
    roll: Vec<(usize, f64)>,
    /// ζ, m/m.
    apart: Vec<(usize, f64)>,
    /// −1/L of a sun mesh, 1/L of a ring mesh, 1/m.
    strut: f64,
}

impl Line {
    /// Sun meshes, then ring meshes.
    pub(super) fn of_set(model: &LumpedModel, [sun, ring]: [&Mesh; 2]) -> Vec<Self> {
        let suns = model.springs.iter().filter(|s| matches!(s.id, SpringId::SunMesh(_)));
        let rings = model.springs.iter().filter(|s| matches!(s.id, SpringId::RingMesh(_)));
        suns.map(|s| (s, sun))
            .chain(rings.map(|s| (s, ring)))
            .filter_map(|(spring, mesh)| {
                let (central, driver, n, sign) = match spring.id {
                    SpringId::SunMesh(n) => (Body::Sun, Body::Sun, n, 1.0),
                    SpringId::RingMesh(n) => (Body::Ring, Body::Planet(n), n, -1.0),
                    _ => return None,
                };
                let of = |body: Body, axis: Axis| {
                    let i = model.coordinates.of(body, axis)?;
                    let b = spring.rows[0].iter().find(|(j, _)| *j == i).map_or(0.0, |(_, b)| *b);
                    Some((i, b))
                };
                // The row along the line of action with each translation turned by a quarter.
                let mut across = Vec::with_capacity(4);
                for body in [central, Body::Planet(n)] {
                    if let (Some((i, x)), Some((j, y))) =
                        (of(body, Axis::First), of(body, Axis::Second))
                    {
                        across.extend([(i, y), (j, -x)]);
                    }
                }
                let length = mesh.center_distance * mesh.pressure_angle.sin();
                let turned = -mesh.gear(MeshMember::Driver).base_radius / length;
                let mut roll: Vec<_> = across.iter().map(|(i, t)| (*i, turned * t)).collect();
                roll.extend(of(driver, Axis::Rotation).map(|(i, _)| (i, sign)));
                let (sin, cos) = model.psi[n].sin_cos();
                let places = [
                    (Body::Planet(n), Axis::First, 1.0),
                    (central, Axis::First, -cos),
                    (central, Axis::Second, -sin),
                ];
                let place = |(body, axis, value)| Some((model.coordinates.of(body, axis)?, value));
                let apart = places.into_iter().filter_map(place).collect();
                Some(Self { id: spring.id, across, roll, apart, strut: -sign / length })
            })
            .collect()
    }

    /// Leans the row of the mesh by slopes s and s_a.
    ///
    /// `[eq:leaning-flanks]` ∂F/∂q = k (b − s κ − s_a ζ), K = k (b − sκ)(b − sκ)ᵀ + c κκᵀ, σ = ±u − r_b m·d/L (+ sun,
    /// which drives; a planet drives the ring the other way round).
    /// Source: derived here.
    /// Checked by: `validation/tests/closed_forms.rs::modes_hardly_pressed_follow_the_load`,
    /// `validation/tests/closed_forms.rs::closed_forms_hold_on_shipped_sets`.
    pub(super) fn lean(&self, model: &mut LumpedModel, slopes: [f64; 2]) {
        let Some(spring) = model.springs.iter_mut().find(|s| s.id == self.id) else { return };
        for (row, slope) in [&self.roll, &self.apart].into_iter().zip(slopes) {
            for (i, along) in row {
                match spring.rows[0].iter_mut().find(|(j, _)| j == i) {
                    Some((_, b)) => *b -= slope * along,
                    None => spring.rows[0].push((*i, -slope * along)),
                }
            }
        }
    }

    /// κ.
    pub(super) fn into_roll(self) -> Vec<(usize, f64)> {
        self.roll
    }

    /// Adds what a force (N) that turns with its line of action does to a stiffness, and the stiffness c against
    /// rolling on, N/m.
    ///
    /// `[eq:turning-line-of-action]` K = ∓F/L t tᵀ (− sun mesh, + ring mesh), L = a sin α, with the row t of m·d for
    /// a sun mesh and −m·d for a ring mesh.
    /// Source: derived here.
    /// Checked by: `lumped/tests/analytic.rs::turning_lines_of_action_have_the_second_derivatives_of_the_approach`.
    pub(super) fn turn(&self, stiffness: &mut DMatrix<f64>, force: f64, rolling: f64) {
        for (factor, row) in [(self.strut * force, &self.across), (rolling, &self.roll)] {
            for (i, a) in row {
                for (j, b) in row {
                    stiffness[(*i, *j)] += factor * a * b;
                }
            }
        }
    }
}
