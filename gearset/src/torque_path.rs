//! Whether a torque on the sun can load the meshes.

use crate::mesh_kind::MeshKind;
use crate::scene::{Freedom, Scene, SceneKind};

/// The supports let no torque pass from the sun through the meshes.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{key}` is \"{value}\": allowed is {allowed}, because {why}")]
pub struct NoTorquePath {
    /// Key of the support at fault.
    pub key: &'static str,
    /// Its value.
    pub value: &'static str,
    /// What is allowed.
    pub allowed: &'static str,
    /// The mechanics behind it.
    pub why: &'static str,
}

impl Scene {
    /// Whether a torque on the sun loads the meshes: T_s + T_r + T_c = 0 with every share ≠ 0, so that the sun
    /// must be able to turn and the rotations of ring and carrier must both be held or sprung. Natural modes need
    /// none of this. Of a gear pair only the sun must be able to turn: a planet that turns freely carries the torque
    /// that balances the sun's, and one that is held or sprung passes it to its support.
    ///
    /// # Errors
    /// [`NoTorquePath`] with the first support that lets no torque pass.
    pub fn torque_path(&self) -> Result<(), NoTorquePath> {
        let supports = &self.supports;
        let is_pair = self.kind == SceneKind::GearPair;
        if is_pair && self.pair == Some(MeshKind::RingPlanet) {
            return Ok(()); // Loaded by a normal force only.
        }
        if !supports.sun.motion.rotates() {
            return Err(NoTorquePath {
                key: "sun.motion",
                value: word(supports.sun.motion),
                allowed: "\"free\"",
                why: "the torque acts on the sun: a sun that cannot turn passes it to its support, and no \
                      tooth is loaded; a set with a fixed sun is loaded alike with a free sun and both other \
                      members held",
            });
        }
        if is_pair {
            return Ok(());
        }
        for (key, support) in [("ring.motion", supports.ring), ("carrier.motion", supports.carrier)]
        {
            if support.turns_freely() {
                return Err(NoTorquePath {
                    key,
                    value: word(support.motion),
                    allowed: "\"rotation_held\", \"held\", or \"free\" with a torsional stiffness",
                    why: "the sun's torque is shared by ring and carrier: if one of them turns freely, the \
                          gears turn without load",
                });
            }
        }
        Ok(())
    }
}

fn word(motion: Freedom) -> &'static str {
    match motion {
        Freedom::Free => "free",
        // The centre of a pair's gear is held by leaving its bearing out.
        Freedom::CentreHeld => "free",
        Freedom::RotationHeld => "rotation_held",
        Freedom::Held => "held",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Torsional;
    use crate::template::template;

    fn key_at_fault(
        sun: Freedom,
        ring: Freedom,
        carrier: Freedom,
        spring: f64,
    ) -> Option<&'static str> {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        scene.supports.sun.motion = sun;
        scene.supports.ring.motion = ring;
        scene.supports.carrier.motion = carrier;
        scene.supports.carrier.torsional = Torsional::PerAngle(spring);
        scene.torque_path().err().map(|e| e.key)
    }

    #[test]
    fn a_torque_on_the_sun_needs_a_free_sun_and_two_reactions() {
        use Freedom::{Free, Held, RotationHeld};
        assert_eq!(key_at_fault(Free, Held, RotationHeld, 0.0), None);
        assert_eq!(key_at_fault(Free, RotationHeld, Held, 0.0), None);
        assert_eq!(key_at_fault(RotationHeld, Held, RotationHeld, 0.0), Some("sun.motion"));
        assert_eq!(key_at_fault(Held, Held, Free, 1e6), Some("sun.motion"));
        assert_eq!(key_at_fault(Free, Held, Free, 0.0), Some("carrier.motion"));
        assert_eq!(key_at_fault(Free, Held, Free, 1e6), None);
        assert_eq!(key_at_fault(Free, Free, Held, 0.0), Some("ring.motion"));
    }

    #[test]
    fn of_a_pair_only_the_sun_must_turn() {
        let mut scene = Scene::from_toml(template(SceneKind::GearPair)).unwrap();
        assert_eq!(scene.torque_path(), Ok(()));
        scene.supports.sun.motion = Freedom::Held;
        assert_eq!(scene.torque_path().unwrap_err().key, "sun.motion");
    }
}
