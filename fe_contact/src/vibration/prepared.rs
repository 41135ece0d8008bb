//! Checks before a set can move, and the data that sets of one scene share.

use std::sync::Arc;

use gearset::{Facing, PathDirection};
use scene::{Fidelity, MeshKinematics, Scene};

use super::frame_pattern::FramePatterns;
use super::leaning::Leaning;
use super::rotation::NominalRotation;
use crate::error::FeError;
use crate::statics::{Bodies, Imperfections, SetTables, StaticSet};

/// Fewest steps of a mesh cycle.
const LEAST_STEPS: usize = 16;

/// Load about which a set vibrates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Loading {
    /// Torque on the sun (magnitude) about whose mean configuration the set is linearised, N·m.
    pub torque_nm: f64,
    /// Force of a mesh that its tables are laid out for, N.
    pub mesh_force: f64,
}

/// Data that sets of one scene share at any speed: the loaded configuration with the races'
/// stiffness, contact tables, and slopes of the flanks.
#[derive(Debug, Clone)]
pub struct Prepared<'s> {
    pub(super) statics: StaticSet<'s>,
    pub(super) tables: SetTables,
    pub(super) leaning: Arc<[Leaning]>,
    /// Whether kinematics are exact at every step.
    pub(super) is_exact: bool,
    /// Patterns of the frames of the rotation it was made for, shared by its sets.
    patterns: Arc<FramePatterns>,
    /// Direction in which that rotation turns; `None` if it stands.
    turns: Option<PathDirection>,
}

impl<'s> Prepared<'s> {
    /// Computes the data that sets of one scene, loading and number of steps share at any speed.
    /// Where the scene asks for exact kinematics (`dynamics.kinematics`) and the set turns, they
    /// are exact at every step; a standing set is linearised about its mean configuration in either
    /// case.
    ///
    /// # Errors
    /// If the scene lacks what the bodies need, or a mesh or a table cannot be computed.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        sense: Facing,
        imperfections: Imperfections,
        rotation: NominalRotation,
        loading: Loading,
    ) -> Result<Self, FeError> {
        solves_contact(scene)?;
        fit(scene, &rotation)?;
        let is_exact =
            rotation.turns().is_some() && scene.dynamics.kinematics == MeshKinematics::Exact;
        let statics = StaticSet::new(scene, bodies, sense, imperfections)?;
        let statics = statics.under(loading.torque_nm)?;
        Self::of(statics, is_exact, &rotation, loading.mesh_force, None)
    }

    /// Data of a set about its mean configuration, its tables laid out for a mesh force, N. What `known` has of them,
    /// which is of the same gears about the same configuration, is not computed again.
    fn of(
        mut statics: StaticSet<'s>,
        is_exact: bool,
        rotation: &NominalRotation,
        mesh_force: f64,
        known: Option<&Self>,
    ) -> Result<Self, FeError> {
        let turns = rotation.turns();
        let positions = rotation.positions();
        let patterns = Arc::new(FramePatterns::new(positions.len()));
        let cells = statics.bodies.cells_in_time(mesh_force);
        if is_exact {
            // The actual lines of action are used, so that the linearised turning of mesh forces is
            // dropped; tables are laid out in the run, at the phases that occur.
            statics.reference.stiffness.fill(0.0);
            let tables = statics.tables_of(cells, &positions[..1], None)?;
            let leaning = vec![Leaning::none(&statics); positions.len()].into();
            return Ok(Self { statics, tables, leaning, is_exact, patterns, turns });
        }
        let tables = statics.tables_of(cells, &positions, known.map(|own| &own.tables))?;
        // Of positions that are even divisions of the cycle those of fewer are among those of more.
        let every = |own: &Self| positions.len() / own.leaning.len().max(1);
        let known = known.filter(|own| own.turns == turns && own.tables.settings == cells);
        let known = known
            .filter(|own| turns.is_some() && every(own) * own.leaning.len() == positions.len());
        let known = |k: usize| {
            let own = known.filter(|own| k.is_multiple_of(every(own)))?;
            own.leaning.get(k / every(own))
        };
        let leaning = Leaning::at(&statics, &tables, &positions, &known)?.into();
        Ok(Self { statics, tables, leaning, is_exact, patterns, turns })
    }

    /// Data of the same scene for another number of steps: the mean configuration is not found anew, nor are tables and
    /// slopes at positions that both have.
    ///
    /// # Errors
    /// As [`Prepared::new`].
    pub fn with_steps(&self, scene: &Scene, mesh_force: f64) -> Result<Self, FeError> {
        let steps_per_cycle = scene.dynamics.steps_per_cycle as usize;
        let direction = self.turns.unwrap_or_default();
        let rotation = NominalRotation::Turning { mesh_frequency: 1.0, steps_per_cycle, direction };
        solves_contact(scene)?;
        fit(scene, &rotation)?;
        Self::of(self.statics.clone(), self.is_exact, &rotation, mesh_force, Some(self))
    }

    /// The shared patterns, or none yet for another rotation: a standing set has its teeth numbered from its own
    /// position.
    pub(super) fn patterns_for(&self, rotation: &NominalRotation) -> Arc<FramePatterns> {
        if self.has_positions_of(rotation) {
            return Arc::clone(&self.patterns);
        }
        Arc::new(FramePatterns::new(rotation.count()))
    }

    /// Whether a rotation passes the very positions that the data were prepared for.
    fn has_positions_of(&self, rotation: &NominalRotation) -> bool {
        let turns = rotation.turns();
        turns.is_some() && turns == self.turns && rotation.count() == self.patterns.count()
    }

    /// Refuses a scene or a rotation for which the data were not prepared.
    pub(super) fn check(&self, scene: &Scene, rotation: &NominalRotation) -> Result<(), FeError> {
        solves_contact(scene)?;
        fit(scene, rotation)?;
        let Self { statics, tables, .. } = self;
        let is_covered = match self.is_exact {
            true => rotation.count() == self.leaning.len(),
            false if self.has_positions_of(rotation) => true,
            false => rotation.positions().iter().all(|p| statics.is_covered(*p, tables)),
        };
        if is_covered {
            return Ok(());
        }
        Err(FeError::Unfit {
            key: "tables".into(),
            value: format!("{} tables", tables.list.len()),
            allowed: "tables of the same steps in a cycle".into(),
            why: "phases of the mesh cycle are never interpolated".into(),
        })
    }
}

/// Refuses fidelity `mesh_law`, which does not solve contact, and `auto`, for which no settings have been chosen yet.
fn solves_contact(scene: &Scene) -> Result<(), FeError> {
    if scene.dynamics.auto.is_some() {
        return Err(FeError::Unfit {
            key: "dynamics.fidelity".into(),
            value: "\"auto\"".into(),
            allowed: "a fidelity by name".into(),
            why: "no settings have been chosen for this scene yet".into(),
        });
    }
    match scene.dynamics.fidelity {
        Fidelity::MeshLaw => Err(FeError::NoContact),
        _ => Ok(()),
    }
}

/// Refuses damping that is negative or not finite, fewer than 16 steps per mesh cycle, and a mesh
/// frequency that is not positive: scenes can be built in memory, without the checks of the parser.
pub(super) fn fit(scene: &Scene, rotation: &NominalRotation) -> Result<(), FeError> {
    let refuse = |key: &str, value: f64, allowed: &str, why: &str| {
        let (key, value) = (key.to_owned(), format!("{value}"));
        Err(FeError::Unfit { key, value, allowed: allowed.into(), why: why.into() })
    };
    let d = &scene.damping;
    let values = [
        ("damping.mass_proportional_per_s", d.mass_proportional_per_s),
        ("damping.stiffness_proportional_s", d.stiffness_proportional_s),
        ("damping.bearing_s", d.bearing_s),
    ];
    for (key, value) in values {
        if !(value >= 0.0 && value.is_finite()) {
            let why = "negative damping feeds the motion, and what is no number ends it";
            return refuse(key, value, "a finite number, at least 0", why);
        }
    }
    if let NominalRotation::Turning { mesh_frequency, steps_per_cycle, .. } = *rotation {
        if steps_per_cycle < LEAST_STEPS {
            let why = "fewer steps see neither the second tooth pair nor a harmonic";
            let value = steps_per_cycle as f64;
            return refuse("dynamics.steps_per_cycle", value, "at least 16", why);
        }
        if !(mesh_frequency > 0.0 && mesh_frequency.is_finite()) {
            let why = "a set that stands still has its own kind of run";
            return refuse("operation.speed_rpm", mesh_frequency, "a speed above 0", why);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use scene::{LoadCase, SceneKind, template};

    use super::*;

    /// Tables at positions that both numbers of steps have are the same ones, and what is found at all others is what a
    /// set finds that is prepared for the larger number alone.
    #[test]
    fn more_steps_keep_the_tables_of_fewer() {
        let mut scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
        scene.fe_contact.flank_elements = 8;
        scene.fe_contact.contact_cells = 20;
        let case = LoadCase::of_scene(&scene).unwrap();
        let bodies = Bodies::new(&scene).unwrap();
        let loading = Loading { torque_nm: case.sun_load_nm(), mesh_force: 2e4 };
        let made = |scene: &Scene| {
            let steps_per_cycle = scene.dynamics.steps_per_cycle as usize;
            let direction = case.direction();
            let rotation =
                NominalRotation::Turning { mesh_frequency: 1.0, steps_per_cycle, direction };
            let own = Imperfections::default();
            Prepared::new(scene, &bodies, case.sense(), own, rotation, loading).unwrap()
        };
        scene.dynamics.steps_per_cycle = 20;
        let few = made(&scene);
        scene.dynamics.steps_per_cycle = 40;
        let (more, alone) = (few.with_steps(&scene, loading.mesh_force).unwrap(), made(&scene));
        let is_known = |table| few.tables.list.iter().any(|own| Arc::ptr_eq(own, table));
        let kept = more.tables.list.iter().filter(|table| is_known(table)).count();
        assert_eq!(kept, few.tables.list.len());
        assert_eq!(more.tables.list.len(), alone.tables.list.len());
        assert!(kept < more.tables.list.len());
        let scale = alone.leaning.iter().map(|own| own.load.amax()).fold(0.0, f64::max);
        for (own, other) in more.leaning.iter().zip(alone.leaning.iter()) {
            let off = (&own.load - &other.load).amax();
            assert!(off < 1e-8 * scale, "{off:e} of {scale:e}");
        }
        // Of another load nothing can be kept.
        let other = few.with_steps(&scene, 2.0 * loading.mesh_force).unwrap();
        assert!(!other.tables.list.iter().any(is_known));
    }
}
