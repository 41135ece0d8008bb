//! Which member a torque acts on, and whether it can load the meshes.

use gearset::{Member, MeshKind, Operation};

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
    /// The central member that the torque of the operating point acts on; the other two react, held or sprung.
    ///
    /// `[eq:torque-balance]` T_s + T_r + T_c = 0 with every share other than 0, so that two of the three rotations
    /// must be held or sprung and the third must be able to turn: it is the one without support.
    /// Source: derived here.
    /// Checked by: `scene/src/load/torque_path.rs::the_torque_acts_on_the_member_without_support`,
    /// `experiments/tests/direction.rs::statics_are_the_same_whichever_member_turns`.
    ///
    /// Where all are supported it is the sun, if it can turn, else the driven member or the one that can. Natural
    /// modes need none of this. Of a gear pair it is the sun: a planet that turns freely carries the torque that
    /// balances the sun's, and one that is held or sprung passes it to its support.
    ///
    /// # Errors
    /// [`NoTorquePath`] with the first support that lets no torque pass.
    pub fn loaded_member(&self) -> Result<Member, NoTorquePath> {
        let supports = &self.supports;
        let is_pair = self.kind == SceneKind::GearPair;
        if is_pair && self.pair == Some(MeshKind::RingPlanet) {
            return Ok(Member::Sun); // Loaded by a normal force only.
        }
        if is_pair {
            return match supports.sun.motion.rotates() {
                true => Ok(Member::Sun),
                false => Err(NoTorquePath {
                    key: "sun.motion",
                    value: word(supports.sun.motion),
                    allowed: "\"free\"",
                    why: "the torque acts on the sun: one that cannot turn passes it to its support, and no tooth is loaded",
                }),
            };
        }
        let all = [
            (Member::Sun, supports.sun, "sun.motion"),
            (Member::Ring, supports.ring, "ring.motion"),
            (Member::Carrier, supports.carrier, "carrier.motion"),
        ];
        let free: Vec<_> = all.iter().filter(|(_, support, _)| support.turns_freely()).collect();
        if let [_, (_, support, key), ..] = free[..] {
            return Err(NoTorquePath {
                key,
                value: word(support.motion),
                allowed: "\"rotation_held\", \"held\", or \"free\" with a torsional stiffness",
                why: "the torque on one member is shared by the other two: if one of these turns freely, the gears turn \
                      without load",
            });
        }
        let driven = self.operation.map(|operation| operation.input);
        let turning = || all.iter().filter(|(_, support, _)| support.motion.rotates());
        let sun_or_driven = || {
            let mut sun_first = turning().filter(|(member, ..)| *member == Member::Sun);
            sun_first.next().or_else(|| turning().find(|(member, ..)| Some(*member) == driven))
        };
        let loaded = free.first().copied().or_else(sun_or_driven).or_else(|| turning().next());
        let Some((loaded, ..)) = loaded else {
            return Err(NoTorquePath {
                key: "sun.motion",
                value: word(supports.sun.motion),
                allowed: "\"free\", or \"free\" of the ring or the carrier",
                why: "the torque acts on a member that can turn: here all three pass it to their supports, and no tooth is loaded",
            });
        };
        Ok(*loaded)
    }

    /// Whether a torque on the [loaded member](Self::loaded_member) loads the meshes, and whether the operating
    /// point agrees with the supports about the member that stands still.
    ///
    /// # Errors
    /// As [`loaded_member`](Self::loaded_member), or if the operating point holds the member that the torque would
    /// turn.
    pub fn torque_path(&self) -> Result<(), NoTorquePath> {
        let loaded = self.loaded_member()?;
        let holds_it = |operation: Operation| operation.fixed == loaded;
        if self.kind == SceneKind::Planetary && self.operation.is_some_and(holds_it) {
            return Err(NoTorquePath {
                key: "operation.fixed",
                value: loaded.name(),
                allowed: "another member, or this one with `motion` \"rotation_held\" or \"held\" or a torsional stiffness",
                why: "it names the member that stands still and gives the speeds; the supports (`motion`) leave this one \
                      alone free to turn, so that the torque would turn it",
            });
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
    use crate::templates::template;

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
        scene.loaded_member().err().map(|e| e.key)
    }

    #[test]
    fn a_torque_needs_one_member_that_turns_and_two_reactions() {
        use Freedom::{Free, Held, RotationHeld};
        assert_eq!(key_at_fault(Free, Held, RotationHeld, 0.0), None);
        assert_eq!(key_at_fault(Free, RotationHeld, Held, 0.0), None);
        assert_eq!(key_at_fault(RotationHeld, Held, RotationHeld, 0.0), Some("sun.motion"));
        assert_eq!(key_at_fault(Held, Held, Free, 1e6), None);
        assert_eq!(key_at_fault(Held, Held, Free, 0.0), None);
        assert_eq!(key_at_fault(Free, Held, Free, 0.0), Some("carrier.motion"));
        assert_eq!(key_at_fault(Free, Held, Free, 1e6), None);
        assert_eq!(key_at_fault(Free, Free, Held, 0.0), Some("ring.motion"));
    }

    #[test]
    fn the_torque_acts_on_the_member_without_support() {
        use Freedom::{Free, Held};
        let loaded = |sun, ring, carrier, [fixed, input]: [Member; 2]| {
            let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
            scene.supports.sun.motion = sun;
            scene.supports.ring.motion = ring;
            scene.supports.carrier.motion = carrier;
            let operation = scene.operation.as_mut().unwrap();
            (operation.fixed, operation.input) = (fixed, input);
            scene.torque_path().and_then(|()| scene.loaded_member()).map_err(|e| e.key)
        };
        use Member::{Carrier, Ring, Sun};
        assert_eq!(loaded(Free, Held, Held, [Ring, Sun]), Ok(Sun));
        assert_eq!(loaded(Held, Free, Held, [Sun, Ring]), Ok(Ring));
        assert_eq!(loaded(Held, Held, Free, [Sun, Carrier]), Ok(Carrier));
        // Supports rule the vibrations, the operating point the speeds: a wind turbine's sun may be the one that turns.
        assert_eq!(loaded(Free, Held, Held, [Ring, Carrier]), Ok(Sun));
        assert_eq!(loaded(Free, Held, Held, [Sun, Ring]), Err("operation.fixed"));
    }

    #[test]
    fn of_a_pair_only_the_sun_must_turn() {
        let mut scene = Scene::from_toml(template(SceneKind::GearPair)).unwrap();
        assert_eq!(scene.loaded_member(), Ok(Member::Sun));
        scene.supports.sun.motion = Freedom::Held;
        assert_eq!(scene.loaded_member().unwrap_err().key, "sun.motion");
    }
}
