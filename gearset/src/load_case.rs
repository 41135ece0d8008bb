//! How a set is driven and loaded. The sense of the load, the sign of the torque on every member and the mesh
//! frequency at a speed are defined only here.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::gear::Facing;
use crate::kinematics::{Kinematics, KinematicsError};
use crate::scene::{Member, Operation, Scene, SceneKind};

/// One operating condition of a set. Torques and speeds are counter-clockwise positive.
///
/// ```
/// use gearset::{LoadCase, Scene, template, SceneKind};
///
/// let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
/// let case = LoadCase::of_scene(&scene).unwrap().with_sun_torque(1130.0).at_speed(1600.0);
/// assert!((case.mesh_frequency_hz - 565.71).abs() < 0.01);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LoadCase {
    /// Member whose speed and torque are given.
    pub driven: Member,
    /// Member that stands still; `None` where the scene gives no operating point.
    pub held: Option<Member>,
    /// External torque on the driven member, N m.
    pub input_torque_nm: f64,
    /// External torque on the sun, N m.
    pub sun_torque_nm: f64,
    /// Speed of the driven member, rpm; 0 for a standing set.
    pub speed_rpm: f64,
    /// Mesh frequency f_m at that speed, Hz.
    pub mesh_frequency_hz: f64,
    /// T_s/T_in by numbers of teeth.
    sun_torque_ratio: f64,
    /// f_m of one rpm of the driven member, Hz.
    mesh_frequency_per_rpm_hz: f64,
}

impl LoadCase {
    /// The scene's operating point.
    ///
    /// # Errors
    /// [`KinematicsError`] if the scene has no operating point or no numbers of teeth.
    pub fn of_scene(scene: &Scene) -> Result<Self, KinematicsError> {
        let operation = scene.operation.ok_or(KinematicsError::Absent("[operation]"))?;
        if scene.kind == SceneKind::GearPair {
            return Self::of_pair(scene, &operation);
        }
        let mut at_one = scene.clone();
        if let Some(operation) = &mut at_one.operation {
            operation.speed_rpm = 1.0;
        }
        let kinematics = Kinematics::from_scene(&at_one)?;
        let case = Self {
            driven: operation.input,
            held: Some(operation.fixed),
            input_torque_nm: 0.0,
            sun_torque_nm: 0.0,
            speed_rpm: 0.0,
            mesh_frequency_hz: 0.0,
            // T_s = T_in z_s/z_in, linear in T_in
            sun_torque_ratio: kinematics.torques_nm(1.0).sun,
            mesh_frequency_per_rpm_hz: kinematics.mesh_frequency_hz,
        };
        Ok(case.with_input_torque(operation.torque_nm).at_speed(operation.speed_rpm))
    }

    /// f_m = Z_s n_s / 60 with the speed n_s of the sun in rpm.
    fn of_pair(scene: &Scene, operation: &Operation) -> Result<Self, KinematicsError> {
        let teeth = scene.teeth.and_then(|teeth| teeth.sun);
        let teeth = teeth.ok_or(KinematicsError::Absent("teeth.sun"))?;
        let case = Self {
            held: Some(operation.fixed),
            mesh_frequency_per_rpm_hz: f64::from(teeth) / 60.0,
            ..Self::standing(operation.torque_nm)
        };
        Ok(case.at_speed(operation.speed_rpm))
    }

    /// A standing set under a torque on its sun, N m. No member is named as held: that follows from the
    /// scene's supports.
    pub fn standing(sun_torque_nm: f64) -> Self {
        Self {
            driven: Member::Sun,
            held: None,
            input_torque_nm: sun_torque_nm,
            sun_torque_nm,
            speed_rpm: 0.0,
            mesh_frequency_hz: 0.0,
            sun_torque_ratio: 1.0,
            mesh_frequency_per_rpm_hz: 0.0,
        }
    }

    /// A set driven at its sun with known torque (N m), speed (rpm) and mesh frequency (Hz), as for results
    /// read from a table.
    pub fn turning(sun_torque_nm: f64, speed_rpm: f64, mesh_frequency_hz: f64) -> Self {
        let mesh_frequency_per_rpm_hz = mesh_frequency_hz / speed_rpm;
        let standing = Self::standing(sun_torque_nm);
        Self { speed_rpm, mesh_frequency_hz, mesh_frequency_per_rpm_hz, ..standing }
    }

    /// The same under another torque on the driven member, N m.
    pub fn with_input_torque(self, input_torque_nm: f64) -> Self {
        let sun_torque_nm = self.sun_torque_ratio * input_torque_nm;
        Self { input_torque_nm, sun_torque_nm, ..self }
    }

    /// The same under the torque on the driven member that loads the sun with `sun_torque_nm`, N m.
    pub fn with_sun_torque(self, sun_torque_nm: f64) -> Self {
        Self { input_torque_nm: sun_torque_nm / self.sun_torque_ratio, sun_torque_nm, ..self }
    }

    /// The same at another speed of the driven member, rpm.
    pub fn at_speed(self, speed_rpm: f64) -> Self {
        let mesh_frequency_hz = (self.mesh_frequency_per_rpm_hz * speed_rpm).abs();
        Self { speed_rpm, mesh_frequency_hz, ..self }
    }

    /// Sense of the torque on the sun, which decides which flanks are loaded: counter-clockwise for a torque
    /// above or equal to 0.
    pub fn sense(&self) -> Facing {
        if self.sun_torque_nm < 0.0 { Facing::Clockwise } else { Facing::CounterClockwise }
    }

    /// Magnitude of the torque on the sun, N m; it acts in the direction of [`sense`](Self::sense).
    pub fn sun_load_nm(&self) -> f64 {
        self.sun_torque_nm.abs()
    }

    /// Mesh frequency of one rpm of the driven member, Hz.
    pub fn mesh_frequency_per_rpm_hz(&self) -> f64 {
        self.mesh_frequency_per_rpm_hz
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::template::template;

    fn scene() -> Scene {
        Scene::from_toml(template(SceneKind::Planetary)).unwrap()
    }

    #[test]
    fn torque_and_speed_follow_the_numbers_of_teeth_for_every_driven_member() {
        for (driven, held) in [
            (Member::Sun, Member::Ring),
            (Member::Carrier, Member::Ring),
            (Member::Ring, Member::Carrier),
        ] {
            let mut scene = scene();
            let operation = scene.operation.as_mut().unwrap();
            (operation.input, operation.fixed) = (driven, held);
            (operation.speed_rpm, operation.torque_nm) = (-700.0, -300.0);
            let case = LoadCase::of_scene(&scene).unwrap();
            let kinematics = Kinematics::from_scene(&scene).unwrap();
            assert!((case.sun_torque_nm - kinematics.torques_nm(-300.0).sun).abs() < 1e-9);
            assert!((case.mesh_frequency_hz - kinematics.mesh_frequency_hz).abs() < 1e-9);
            let back = case.with_sun_torque(case.sun_torque_nm);
            assert!((back.input_torque_nm + 300.0).abs() < 1e-9);
        }
    }

    #[test]
    fn one_rule_for_the_sense_nil_included() {
        let sense = |torque| LoadCase::standing(torque).sense();
        assert_eq!(sense(5.0), Facing::CounterClockwise);
        assert_eq!(sense(0.0), Facing::CounterClockwise);
        assert_eq!(sense(-0.0), Facing::CounterClockwise);
        assert_eq!(sense(-5.0), Facing::Clockwise);
        assert_eq!(LoadCase::standing(-5.0).sun_load_nm(), 5.0);
    }

    #[test]
    fn a_scene_without_an_operating_point_is_refused_by_key() {
        let mut scene = scene();
        scene.operation = None;
        let refusal = LoadCase::of_scene(&scene).unwrap_err();
        assert!(refusal.to_string().contains("[operation]"), "{refusal}");
    }
}
