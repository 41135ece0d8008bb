//! Keys of a scene whose values no verb that runs on it uses.

use gearset::MeshKind;

use crate::keys::{KEYS, without_indices};
use crate::needs::Verb;
use crate::scene::{Freedom, Scene};

/// Of what modes with given parameters have no use: they are what others compute these from.
const BEHIND_PARAMETERS: [&str; 3] = ["material", "operation", "fe_contact"];
/// Keys of motion in time and of loaded sets, which one mesh at rest has no use for.
const NOT_OF_A_RESTING_PAIR: [&str; 2] = ["fe_contact.cell_layout", "fe_contact.mean_positions"];

impl Scene {
    /// Those of the keys written whose values no verb that runs uses; none where no verb runs.
    pub(crate) fn idle_keys(&self, mut written: Vec<String>) -> Vec<String> {
        let runs = |verb: &Verb| self.lacks(*verb).iter().all(|lack| lack.argument.is_some());
        let running: Vec<Verb> = Verb::ALL.into_iter().filter(runs).collect();
        written.retain(|path| {
            let key = without_indices(path);
            let of_values = KEYS.iter().any(|k| k.path == key && !k.is_table() && k.changes != "–");
            of_values && !running.is_empty() && !running.iter().any(|verb| self.uses(*verb, &key))
        });
        written
    }

    /// Whether a verb that reads a key has a use for it in this scene.
    fn uses(&self, verb: Verb, key: &str) -> bool {
        if key == "dynamics.fidelity" && self.dynamics.auto.is_some() {
            return true; // "auto" is what makes a verb choose settings.
        }
        let table = key.split('.').next().unwrap_or_default();
        verb.reads(key)
            && !self.is_of_other_gear(key)
            && match verb {
                Verb::Modes | Verb::Compare if self.lumped.is_some() => {
                    !BEHIND_PARAMETERS.contains(&table) && !self.is_of_held_body(key)
                }
                Verb::Modes | Verb::Compare | Verb::Rules | Verb::Mesh => true,
                Verb::Static => self.pair.is_none() || !NOT_OF_A_RESTING_PAIR.contains(&key),
                _ if table == "lumped" => {
                    let has_shape = self.geometry.as_ref().is_some_and(|g| g.carrier.is_some());
                    !has_shape && !self.is_of_held_body(key)
                }
                _ => true,
            }
    }

    /// Whether the key is of the circles of the gear that a pair does not have; its teeth and backlash share in the
    /// thickness of the planet's teeth.
    fn is_of_other_gear(&self, key: &str) -> bool {
        match self.pair {
            None => false,
            Some(MeshKind::SunPlanet) => key.starts_with("geometry.ring."),
            Some(MeshKind::RingPlanet) => key.starts_with("geometry.sun."),
        }
    }

    /// Whether the key is a mass of a body that is held, or an inertia or radius of one whose rotation is.
    fn is_of_held_body(&self, key: &str) -> bool {
        let mut steps = key.split('.').skip(1);
        let (Some(table), Some(body)) = (steps.next(), steps.next()) else { return false };
        let motion = match body {
            "sun" => self.supports.sun.motion,
            "ring" => self.supports.ring.motion,
            "carrier" => self.supports.carrier.motion,
            _ => self.supports.pair.map_or(Freedom::Free, |pair| pair.planet.motion),
        };
        match table {
            "mass_kg" => !motion.translates(),
            "inertia_kg_m2" | "inertia_over_r2_kg" | "radius_mm" => !motion.rotates(),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::templates::template;
    use crate::{Scene, SceneKind};

    fn idle(text: &str) -> Vec<String> {
        Scene::with_remarks(text).unwrap().1.idle
    }

    /// Parameters alone: modes use nothing of material and time steps.
    #[test]
    fn parameters_have_no_use_for_material_and_steps() {
        let text = "format = 1\nkind = \"planetary\"\ntitle = \"t\"\nplanets.count = 3\nplanet.bearing_n_per_m = 1e8\n\
            ring.motion = \"held\"\ncarrier.motion = \"rotation_held\"\nmaterial.density_kg_per_m3 = 7800\n\
            dynamics.steps_per_cycle = 120\n[lumped]\nmass_kg = { sun = 0.4, planet = 0.7, carrier = 5 }\n\
            inertia_over_r2_kg = { sun = 0.4, planet = 0.6, carrier = 6 }\n\
            mesh_n_per_m = { sun_planet = 5e8, ring_planet = 5e8 }\n\
            pressure_angle_deg = { sun_planet = 24, ring_planet = 20 }\n";
        let expected = [
            "dynamics.steps_per_cycle",
            "lumped.inertia_over_r2_kg.carrier",
            "material.density_kg_per_m3",
        ];
        assert_eq!(idle(text), expected);
        assert!(idle(&text.replace("\"rotation_held\"", "\"free\"")).len() == 2);
    }

    /// A ring–planet pair stands still and has no sun; of the sun–planet pair nothing is idle but the ring.
    #[test]
    fn a_pair_has_no_use_for_the_other_gear() {
        let text = template(SceneKind::GearPair);
        let of_ring = |keys: Vec<String>| keys.iter().all(|key| key.contains("ring"));
        assert!(of_ring(idle(text)), "{:?}", idle(text));
    }
}
