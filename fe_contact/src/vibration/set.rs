//! A set in time: Newmark's method with contact solved inside every step.
//!
//! The nominal rotation is exact kinematics; the vibration about it is computed, in the carrier
//! frame. Within a step everything but contact is linear ([`VibratingSet::step`]). The set of touching cells is changed
//! until all complementarity conditions hold.

use std::sync::Arc;

use dynamics::Motion;
use gearset::{Facing, Symmetry};
use nalgebra::DVector;
use scene::Scene;

use super::build;
use super::clock::Clock;
use super::contact_tables::ContactTables;
use super::damping::Proportional;
use super::flexible_bodies::FlexibleBodies;
use super::frame_pattern::FramePatterns;
use super::frames::Frames;
use super::gyroscopic::carrier_speed;
use super::lag::{LagRule, PairMemory};
use super::pair_forces::PairForces;
use super::prepared::{Loading, Prepared};
use super::race_dynamics::RaceDynamics;
use super::rotation::NominalRotation;
use super::tooth_shift::ToothShift;
use super::workspace::Workspace;
use crate::error::FeError;
use crate::statics::{Bodies, Imperfections, Races, ReferenceConfiguration, StaticSet};

/// A set in time.
#[derive(Debug)]
pub struct VibratingSet<'s> {
    pub(super) statics: StaticSet<'s>,
    pub(super) clock: Clock,
    pub(super) bodies: FlexibleBodies<'s>,
    pub(super) race_dynamics: RaceDynamics,
    pub(super) contact: ContactTables,
    pub(super) patterns: Arc<FramePatterns>,
    pub(super) frames: Frames,
    pub(super) pairs: PairForces,
    pub(super) work: Workspace,
    /// Shift of the bodies' modes by one tooth, by body; empty until it is needed.
    pub(super) tooth_shifts: Vec<Option<ToothShift>>,
    /// Symmetry after a part of the cycle; `None` until it is asked for.
    pub(super) symmetry: Option<Option<Symmetry>>,
    /// External forces on the races' coordinates at the end of the step, n, N.
    pub external: DVector<f64>,
    /// Counts of operations so far.
    pub counts: Counts,
}

/// Counts of operations of a run.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Steps.
    pub steps: u64,
    /// Solutions of the linear system of all pairs.
    pub solutions: u64,
    /// Combinations of contact sets that occurred for the first time, or again after they had been
    /// replaced by others.
    pub combinations: u64,
    /// Steps in which backside flanks took part.
    pub with_backside: u64,
}

impl<'s> VibratingSet<'s> {
    /// A set for a torque on the sun of the given sense, linearised about its mean configuration under
    /// that torque; it stands there without motion until [`VibratingSet::rest`] finds its equilibrium.
    ///
    /// # Errors
    /// If the scene lacks what the bodies need, or a mesh, a factor or a table cannot be computed.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        sense: Facing,
        imperfections: Imperfections,
        rotation: NominalRotation,
        loading: Loading,
    ) -> Result<Self, FeError> {
        let prepared = Prepared::new(scene, bodies, sense, imperfections, rotation, loading)?;
        Self::assemble(scene, prepared, rotation)
    }

    /// A set as from [`VibratingSet::new`], with data prepared for the same scene.
    ///
    /// # Errors
    /// As [`VibratingSet::new`], and if the data were prepared for other steps in the cycle.
    pub fn on(
        scene: &Scene,
        prepared: &Prepared<'s>,
        rotation: NominalRotation,
    ) -> Result<Self, FeError> {
        prepared.check(scene, &rotation)?;
        Self::assemble(scene, prepared.clone(), rotation)
    }

    fn assemble(
        scene: &Scene,
        prepared: Prepared<'s>,
        rotation: NominalRotation,
    ) -> Result<Self, FeError> {
        let patterns = prepared.patterns_for(&rotation);
        let Prepared { statics, tables, leaning, is_exact, .. } = prepared;
        build::one_flexibility(scene, statics.bodies)?;
        let clock = Clock::new(rotation)?;
        let rule = clock.rule;
        let damping = Proportional {
            alpha: scene.damping.mass_proportional_per_s,
            beta: scene.damping.stiffness_proportional_s,
        };
        let settings = build::Settings { fidelity: scene.dynamics.fidelity, damping, rule };
        let start = || build::start_angles(&statics, &tables, rotation.start());
        let gears = build::gears(&statics, scene, patterns.start_angles(start)?, &settings)?;
        let (carrier, ports, flexibility) = build::carrier(&statics, scene, &settings)?;
        let bodies = FlexibleBodies::new(carrier, gears);
        let speed = match rotation {
            NominalRotation::Turning { mesh_frequency, direction, .. }
                if scene.dynamics.gyroscopic =>
            {
                Some(direction.sign() * carrier_speed(scene, mesh_frequency))
            }
            _ => None,
        };
        let seats = (ports, flexibility);
        let race_dynamics = RaceDynamics::new(&statics, scene, &rule, &bodies, seats, speed)?;
        let (n, meshes) = (statics.races.count, statics.meshes());
        let count = rotation.count();
        // Meshes whose phase passes 0 from the step before: it is less than there, or greater in backward direction.
        let direction = rotation.direction();
        let restarts = |step: usize| {
            let phase = |mesh: usize, step: usize| statics.phase(mesh, clock.position(step));
            let change = |mesh: usize| phase(mesh, step) - phase(mesh, clock.before(step));
            let starts = |mesh: &usize| direction.sign() * change(*mesh) < 0.0;
            (0..meshes).filter(starts).collect()
        };
        let restarts = patterns.restarts(|| (0..count).map(restarts).collect());
        Ok(Self {
            pairs: PairForces::new(
                LagRule::new(damping.beta, &rule),
                meshes,
                n,
                (restarts, direction),
            ),
            clock,
            bodies,
            race_dynamics,
            contact: ContactTables::new(tables, leaning, is_exact),
            patterns,
            frames: Frames::new(count),
            work: Workspace::new(n),
            tooth_shifts: Vec::new(),
            symmetry: None,
            external: DVector::zeros(n),
            counts: Counts::default(),
            statics,
        })
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.clock.time()
    }

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad; carrier frame) and of the planets
    /// (ζ, η, θ), counter-clockwise.
    pub fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.statics.displacements(&DVector::from_column_slice(&self.race_dynamics.motion.x))
    }

    /// Displacements, velocities and accelerations of the races' free coordinates, m and s.
    pub fn motion(&self) -> &Motion {
        &self.race_dynamics.motion
    }

    /// The races' coordinates.
    pub fn races(&self) -> &Races {
        &self.statics.races
    }

    /// The configuration the set is linearised about.
    pub fn reference(&self) -> &ReferenceConfiguration {
        self.statics.reference()
    }

    /// Masses of the races' coordinates with rigid bodies, kg.
    pub fn masses(&self) -> &[f64] {
        &self.race_dynamics.mass
    }

    /// Force of each mesh: sun meshes, ring meshes, and backside flanks if they took part, N.
    pub fn mesh_forces(&self, out: &mut Vec<f64>) {
        out.clear();
        match self.frames.current(self.clock.step_in_cycle) {
            Some(frame) => out.extend(self.pairs.of_meshes(frame)),
            // A set that continues from a state has no frame before its first step.
            None => out.extend(self.pairs.memory.iter().map(PairMemory::total)),
        }
    }

    /// Degrees of freedom beside the races'.
    pub fn elastic_unknowns(&self) -> usize {
        self.bodies.unknowns()
    }

    /// Memory of tables, contact maps and frames, bytes.
    pub fn bytes(&self) -> [usize; 3] {
        let [tables, maps] = self.contact.bytes();
        [tables, maps, self.frames.bytes()]
    }

    /// Contact problems solved so far, and maps kept.
    pub fn contact_counts(&self) -> [usize; 2] {
        self.contact.counts()
    }
}
