//! Terms of the rotating carrier frame in the equations of the races.

use dynamics::RotatingFrame;
use gearset::Body;
use nalgebra::DMatrix;
use scene::Scene;

use crate::statics::Races;

/// Gyroscopic and centripetal terms of all races, n×n.
#[derive(Debug)]
pub(super) struct GyroscopicTerms {
    /// On velocities, kg/s.
    pub(super) gyroscopic: DMatrix<f64>,
    /// On displacements, N/m.
    pub(super) centripetal: DMatrix<f64>,
}

impl GyroscopicTerms {
    /// Of races with masses (kg) by coordinate, in a carrier frame that turns at `speed` (rad/s).
    ///
    /// `[eq:gyroscopic-races]` Ω G q̇ − Ω² K_Ω q in the equations of the races as rigid bodies, by
    /// `eq:rotating-frame` for each body's translation.
    /// Source: derived here.
    /// Checked by: `fe_contact/tests/gyroscopic.rs::free_bodies_vibrate_in_planes_that_stand_still_in_space`,
    /// `fe_contact/tests/gyroscopic.rs::peaks_of_a_turning_set_are_those_of_its_gyroscopic_modes`,
    /// `fe_contact/tests/vibration.rs::a_mirrored_set_under_reversed_torque_moves_as_the_mirror`.
    pub(super) fn new(races: &Races, mass: &[f64], speed: f64) -> Self {
        let frame = RotatingFrame { speed };
        let n = races.count;
        let (mut g, mut k) = (DMatrix::zeros(n, n), DMatrix::zeros(n, n));
        for body in Body::all(races.planets()) {
            let [x, y, _] = races.places(body);
            for i in [x, y].into_iter().flatten() {
                k[(i, i)] += frame.centripetal(mass[i]);
            }
            if let (Some(x), Some(y)) = (x, y) {
                let [[_, of_y], [of_x, _]] = frame.gyroscopic(mass[x]);
                g[(x, y)] += of_y;
                g[(y, x)] += of_x;
            }
        }
        Self { gyroscopic: g, centripetal: k }
    }
}

/// Speed of the carrier (rad/s) at a mesh frequency (Hz), positive in the sense in which the sun turns relative to the
/// carrier: times d it is that in the frame of counter-clockwise torque, in which the sun turns so relative to the
/// carrier at d times its magnitude.
pub(super) fn carrier_speed(scene: &Scene, mesh_frequency: f64) -> f64 {
    match scene.kinematics() {
        Ok(k) if k.mesh_frequency_hz > 0.0 => {
            let speeds = k.speeds_rad_per_s;
            let sense = (speeds.sun - speeds.carrier).signum();
            sense * speeds.carrier * mesh_frequency / k.mesh_frequency_hz
        }
        _ => 0.0,
    }
}
