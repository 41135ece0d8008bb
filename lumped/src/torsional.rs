//! The model of rotations alone: every centre is held, the planets' to the carrier.

use gearset::{Axis, Body};

use crate::coordinates::Coordinates;
use crate::model::LumpedModel;
use crate::springs::Spring;

impl LumpedModel {
    /// The limit of rigid bearings: coordinates u of every body that turns, planets carried along by the carrier.
    ///
    /// `[eq:torsional-limit]` x = y = 0 of the central members, ζ_n = 0, η_n = u_c; the planets' masses turn with the
    /// carrier, I_c/r_c² + Σ m_n.
    /// Source: Kahraman (1994), J. Sound Vib. 173, 125–130.
    /// Checked by: `lumped/tests/torsional.rs::rigid_bearings_leave_the_frequencies_of_rotations_alone`,
    /// `lumped_model.limit`.
    pub fn torsional(&self) -> Self {
        let is_free = |body, axis| self.coordinates.of(body, axis).is_some();
        let coordinates = Coordinates::new(self.psi.len(), |body, axis| {
            axis == Axis::Rotation && is_free(body, axis)
        });
        // Where a coordinate of the whole model goes.
        let kept: Vec<Option<usize>> = self
            .coordinates
            .free()
            .iter()
            .map(|&(body, axis)| match (body, axis) {
                (_, Axis::Rotation) => coordinates.of(body, axis),
                (Body::Planet(_), Axis::Second) => coordinates.of(Body::Carrier, Axis::Rotation),
                _ => None,
            })
            .collect();
        let mut mass = vec![0.0; coordinates.count()];
        for (m, to) in self.mass.iter().zip(&kept) {
            if let Some(to) = *to {
                mass[to] += m;
            }
        }
        let spring = |spring: &Spring| {
            let row = |row: &Vec<(usize, f64)>| {
                let mut sums = vec![0.0; coordinates.count()];
                for &(i, b) in row {
                    if let Some(to) = kept[i] {
                        sums[to] += b;
                    }
                }
                let entries: Vec<(usize, f64)> =
                    sums.into_iter().enumerate().filter(|(_, b)| *b != 0.0).collect();
                (!entries.is_empty()).then_some(entries)
            };
            let rows: Vec<_> = spring.rows.iter().filter_map(row).collect();
            (!rows.is_empty()).then_some(Spring { rows, ..spring.clone() })
        };
        let springs = self.springs.iter().filter_map(spring).collect();
        Self { psi: self.psi.clone(), coordinates, mass, springs }
    }
}
