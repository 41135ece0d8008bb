//! How a set is driven and loaded. The sense of the load, the sign of the torque on every member, the mesh
//! frequency at a speed and the direction in which meshes run are defined only here.
//!
//! ```text
//! τ = sign T_s              which flanks press; a set with τ = −1 is computed as its mirror image
//! σ = sign(ω_s − ω_c)       sense in which the sun turns relative to the carrier
//! d = σ τ                   sign of the sun's power relative to the carrier, T_s (ω_s − ω_c)
//! ```
//!
//! In the frame in which the torque on the sun is counter-clockwise all mesh phases advance at d f_m: pairs run
//! from the start of the path of contact to its end with d = +1, from its end to its start with d = −1, in sun and
//! ring meshes alike. Driving through the sun is d = +1; so is every set whose sun drives relative to the carrier.
//! Braking flips d, reversing speeds and torques together does not.

use gearset::{Facing, KinematicsError, Member, Operation, PathDirection};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::{Scene, SceneKind};

/// One operating condition of a set. Torques are counter-clockwise positive; speeds are magnitudes in the sense of
/// rotation that `sun_turns` gives.
///
/// ```
/// use scene::{LoadCase, Scene, template, SceneKind};
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
    /// Magnitude of the speed of the driven member, rpm; 0 for a standing set.
    pub speed_rpm: f64,
    /// Sense in which the sun turns relative to the carrier, σ; of a standing set that of its torque.
    /// Counter-clockwise if left out.
    #[serde(default = "counter_clockwise", skip_serializing_if = "is_counter_clockwise")]
    pub sun_turns: Facing,
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
        let kinematics = at_one.kinematics()?;
        // The sign of ω_s − ω_c is that of −(ω_p − ω_c), which is no difference of speeds.
        let of_one = -kinematics.speeds_rpm.planet_relative_to_carrier;
        let case = Self {
            driven: operation.input,
            held: Some(operation.fixed),
            input_torque_nm: 0.0,
            sun_torque_nm: 0.0,
            speed_rpm: 0.0,
            // At a standstill as with a positive speed.
            sun_turns: sense(of_one * if operation.speed_rpm < 0.0 { -1.0 } else { 1.0 }),
            mesh_frequency_hz: 0.0,
            // T_s = T_in z_s/z_in, linear in T_in
            sun_torque_ratio: kinematics.torques_nm(1.0).sun,
            mesh_frequency_per_rpm_hz: kinematics.mesh_frequency_hz,
        };
        Ok(case.with_input_torque(operation.torque_nm).at_speed(operation.speed_rpm))
    }

    /// `[eq:pair-mesh-frequency]` f_m = Z_s n_s / 60 with the speed n_s of the sun in rpm.
    ///
    /// Source: definition.
    /// Checked by: `scene/tests/gear_pair.rs::the_mesh_frequency_is_that_of_the_sun`.
    fn of_pair(scene: &Scene, operation: &Operation) -> Result<Self, KinematicsError> {
        let teeth = scene.teeth.and_then(|teeth| teeth.sun);
        let teeth = teeth.ok_or(KinematicsError::Absent("teeth.sun"))?;
        let case = Self {
            held: Some(operation.fixed),
            mesh_frequency_per_rpm_hz: f64::from(teeth) / 60.0,
            sun_turns: sense(operation.speed_rpm),
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
            sun_turns: sense(sun_torque_nm),
            mesh_frequency_hz: 0.0,
            sun_torque_ratio: 1.0,
            mesh_frequency_per_rpm_hz: 0.0,
        }
    }

    /// A set driven at its sun with known torque (N m), speed (rpm) and mesh frequency (Hz), as for results
    /// read from a table; meshes run forward.
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

    /// The same at another speed of the driven member in the same sense of rotation; the magnitude counts, rpm.
    pub fn at_speed(self, speed_rpm: f64) -> Self {
        let speed_rpm = speed_rpm.abs();
        let mesh_frequency_hz = self.mesh_frequency_per_rpm_hz * speed_rpm;
        Self { speed_rpm, mesh_frequency_hz, ..self }
    }

    /// The same with meshes that run in a direction, under the same torque.
    pub fn in_direction(self, direction: PathDirection) -> Self {
        Self { sun_turns: sense(self.sense().sign() * direction.sign()), ..self }
    }

    /// `[eq:path-direction]` Direction in which pairs run along the path of the loaded flanks: d = σ τ with τ = sign
    /// T_s and σ = sign(ω_s − ω_c).
    ///
    /// Source: derived here.
    /// Checked by: `scene/src/load/case.rs::pairs_run_the_way_the_power_of_the_sun_relative_to_the_carrier_flows`,
    /// `experiments/tests/direction.rs`, `sweep.order`.
    pub fn direction(&self) -> PathDirection {
        match self.sun_turns == self.sense() {
            true => PathDirection::Forward,
            false => PathDirection::Backward,
        }
    }

    /// Sense of the torque on the sun, which decides which flanks are loaded: counter-clockwise for a torque
    /// above or equal to 0.
    pub fn sense(&self) -> Facing {
        sense(self.sun_torque_nm)
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

/// Counter-clockwise for what is above or equal to 0.
fn sense(value: f64) -> Facing {
    if value < 0.0 { Facing::Clockwise } else { Facing::CounterClockwise }
}

fn counter_clockwise() -> Facing {
    Facing::CounterClockwise
}

fn is_counter_clockwise(own: &Facing) -> bool {
    *own == Facing::CounterClockwise
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::templates::template;

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
            let kinematics = scene.kinematics().unwrap();
            assert!((case.sun_torque_nm - kinematics.torques_nm(-300.0).sun).abs() < 1e-9);
            assert!((case.mesh_frequency_hz - kinematics.mesh_frequency_hz).abs() < 1e-9);
            let back = case.with_sun_torque(case.sun_torque_nm);
            assert!((back.input_torque_nm + 300.0).abs() < 1e-9);
        }
    }

    /// The direction of the path for every driven and held member, in both senses of rotation, driving and
    /// braking; it is that of the sun's power relative to the carrier.
    #[test]
    fn pairs_run_the_way_the_power_of_the_sun_relative_to_the_carrier_flows() {
        use Member::{Carrier, Ring, Sun};
        use PathDirection::{Backward, Forward};
        let table = [
            (Sun, Ring, Forward),
            (Sun, Carrier, Forward),
            (Carrier, Ring, Backward),
            (Carrier, Sun, Forward),
            (Ring, Carrier, Backward),
            (Ring, Sun, Backward),
        ];
        for (driver, held, driving) in table {
            for speed in [-700.0, 700.0] {
                for torque in [-300.0, 300.0] {
                    let mut scene = scene();
                    let operation = scene.operation.as_mut().unwrap();
                    (operation.input, operation.fixed) = (driver, held);
                    (operation.speed_rpm, operation.torque_nm) = (speed, torque);
                    let case = LoadCase::of_scene(&scene).unwrap();
                    let braking = match driving {
                        Forward => Backward,
                        Backward => Forward,
                    };
                    let expected = if speed * torque > 0.0 { driving } else { braking };
                    assert_eq!(
                        case.direction(),
                        expected,
                        "{driver:?}, {held:?} held: {speed}, {torque}"
                    );
                    let kinematics = scene.kinematics().unwrap();
                    let speeds = kinematics.speeds_rpm;
                    let power = kinematics.torques_nm(torque).sun * (speeds.sun - speeds.carrier);
                    assert_eq!(case.direction().sign(), power.signum());
                    assert_eq!(case.speed_rpm, 700.0);
                    let braked = case.with_input_torque(-torque);
                    assert_ne!(braked.direction(), case.direction());
                    assert_eq!(case.at_speed(100.0).direction(), case.direction());
                }
            }
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
