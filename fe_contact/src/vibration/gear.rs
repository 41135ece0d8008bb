//! One gear of a vibrating set.

use std::sync::Arc;

use super::body::VibratingBody;
use crate::body::GearBody;

/// One gear that vibrates.
#[derive(Debug)]
pub(super) struct VibratingGear<'s> {
    pub(super) body: &'s GearBody,
    pub(super) vibrating: Box<dyn VibratingBody>,
    /// Degree of freedom of each node of its mesh.
    pub(super) unknown_of: Arc<Vec<usize>>,
    /// Angle of tooth 0 at the start, rad.
    pub(super) start: f64,
    /// Angle by which it turns relative to the carrier in a mesh cycle, rad.
    pub(super) rate: f64,
}

impl VibratingGear<'_> {
    /// Angle of tooth 0 in the race's frame after some mesh cycles, rad.
    pub(super) fn angle(&self, turned: f64) -> f64 {
        self.start + self.rate * turned
    }

    /// Number of the tooth whose axis stands at an angle, rad.
    pub(super) fn tooth_at(&self, axis: f64, turned: f64) -> i64 {
        let pitch = self.body.mesh.outline.gear().pitch_angle();
        ((axis - self.angle(turned)) / pitch).round() as i64
    }

    /// Change of the number of the tooth at a given position from one mesh cycle to the next.
    pub(super) fn teeth_per_cycle(&self) -> i64 {
        -self.rate.signum() as i64
    }
}
