//! A set in time: Newmark's method with contact solved inside every step.
//!
//! The nominal turning is exact kinematics; what is computed is vibration about it, in the carrier
//! frame. Within a step everything but contact is linear, so the approaches of all tooth pairs are
//!
//! ```text
//! δ = b − Y P,   P = S δ + P₀ on the cells that touch
//! ```
//!
//! with b from the state at the step's beginning. Cells that turn out wrong are changed until all
//! complementarity conditions hold.

use dynamics::{AverageAcceleration, Motion};
use gearset::{Kinematics, Scene};
use nalgebra::{DMatrix, DVector};

use super::bearings::Bearings;
use super::body::{Port, RaceMotion, VibratingBody};
use super::build;
use super::damping::Proportional;
use super::exact::GridTables;
use super::frame::Frame;
use super::gear::Gear;
use super::lag::{LagRule, PairMemory};
use super::leaning::Leaning;
use super::packed::Packed;
use super::prepared::Prepared;
use crate::contact::ContactMaps;
use crate::error::FeError;
use crate::statics::{CARRIER, PLANETS, Races, Reference, SetTables, StaticSet, planet_bearing};

/// How a set moves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motive {
    /// Standing at a position of the mesh cycle (cycles), in steps of a given length (s).
    Standing {
        /// Position, cycles.
        position: f64,
        /// Step, s.
        step: f64,
    },
    /// Turning from position 0.
    Turning {
        /// Mesh frequency, Hz.
        mesh_frequency: f64,
        /// Steps in a mesh cycle.
        steps_per_cycle: usize,
    },
}

impl Motive {
    /// Positions of the mesh cycle at which steps end, cycles.
    pub fn positions(&self) -> Vec<f64> {
        match *self {
            Self::Standing { position, .. } => vec![position],
            Self::Turning { steps_per_cycle: count, .. } => {
                (0..count).map(|i| i as f64 / count as f64).collect()
            }
        }
    }
}

/// A set in time.
#[derive(Debug)]
pub struct VibratingSet<'s> {
    pub(super) statics: StaticSet<'s>,
    pub(super) tables: SetTables,
    /// By step in the cycle.
    pub(super) leaning: Vec<Leaning>,
    pub(super) maps: Vec<ContactMaps>,
    pub(super) rule: AverageAcceleration,
    pub(super) motive: Motive,
    pub(super) lag: LagRule,
    pub(super) damping: Proportional,
    /// Dashpots over stiffness, s.
    pub(super) bearing_ratio: f64,
    /// Masses of the races' coordinates, rigid bodies, kg.
    pub(super) mass: Vec<f64>,
    pub(super) carrier: Box<dyn VibratingBody>,
    pub(super) bearings: Bearings,
    /// Stiffness of the central members' supports, n, N/m.
    pub(super) supports: DVector<f64>,
    /// (I/k + A)⁻¹ with the carrier's whole static flexibility.
    pub(super) seat_stiffness: DMatrix<f64>,
    /// Ring, sun, planets.
    pub(super) gears: Vec<Gear<'s>>,
    /// A⁻¹, and as every step multiplies by it.
    pub(super) inverse: DMatrix<f64>,
    pub(super) packed_inverse: Packed,
    /// Gyroscopic and centripetal terms, n×n: G (kg/s) and −mΩ² (N/m).
    pub(super) gyroscopic: Option<[DMatrix<f64>; 2]>,
    /// Tables on a grid of phases, where kinematics are exact at every step.
    pub(super) grid: Option<GridTables>,
    /// By step in the cycle.
    pub(super) frames: Vec<Option<Box<Frame>>>,
    pub(super) frames_with_backs: Vec<Option<Box<Frame>>>,
    /// By step in the cycle: meshes whose phase starts anew at it.
    pub(super) restarts: Vec<Vec<usize>>,
    /// Step in the cycle, cycles gone by, steps taken.
    pub(super) step_in_cycle: usize,
    pub(super) cycles: i64,
    pub(super) steps: u64,
    /// External forces on the races' coordinates at the end of the step, n, N.
    pub external: DVector<f64>,
    pub(super) motion: Motion,
    pub(super) memory: Vec<PairMemory>,
    /// Forces of the pairs of the current frame, N.
    pub(super) forces: DVector<f64>,
    /// Approaches of the pairs, less gap offsets, m.
    pub(super) approaches: DVector<f64>,
    /// What the bends of gaps at corners put on the races in the last step, n, N.
    pub(super) bent: DVector<f64>,
    pub(super) touched_back: bool,
    /// Whether bodies are worth a thread each.
    pub(super) is_large: bool,
    pub(super) work: Work,
    /// What it took so far.
    pub counts: Counts,
}

/// What a run took.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Counts {
    /// Steps.
    pub steps: u64,
    /// Solutions of the linear system of all pairs.
    pub solutions: u64,
    /// Combinations of contact sets that were met for the first time, or again after they gave way.
    pub combinations: u64,
    /// Steps in which back flanks took part.
    pub with_backs: u64,
}

/// Ports of one gear and what presses on each, N.
pub(super) type Loads = (Vec<Port>, Vec<f64>);

#[derive(Debug, Default)]
pub(super) struct Work {
    pub(super) load: DVector<f64>,
    /// What of it the tooth pairs leave to the races.
    pub(super) left: DVector<f64>,
    pub(super) free: DVector<f64>,
    /// Where the races are expected at the end of the step, m.
    pub(super) expected: Vec<f64>,
    pub(super) b: DVector<f64>,
    pub(super) x: DVector<f64>,
    pub(super) history: Vec<f64>,
    pub(super) ids: Vec<u64>,
    /// Motion of each gear's race at the start of the step, and the load it answers with.
    pub(super) started: Vec<(RaceMotion, [f64; 3])>,
    /// Ports and forces of each gear.
    pub(super) ports: Vec<Loads>,
}

/// Degrees of freedom of all bodies from which each gets a thread of its own.
const LARGE: usize = 10_000;

impl<'s> VibratingSet<'s> {
    pub(super) fn assemble(
        scene: &Scene,
        prepared: Prepared<'s>,
        motive: Motive,
    ) -> Result<Self, FeError> {
        let Prepared { statics, tables, leaning } = prepared;
        build::one_flexibility(scene, statics.bodies)?;
        let (step, count, start) = match motive {
            Motive::Standing { position, step } => (step, 1, position),
            Motive::Turning { mesh_frequency, steps_per_cycle } => {
                (1.0 / (mesh_frequency * steps_per_cycle as f64), steps_per_cycle, 0.0)
            }
        };
        let rule = AverageAcceleration::new(step).map_err(|e| FeError::Unfit {
            key: "step".into(),
            value: format!("{} s", e.0),
            allowed: "a positive length of time".into(),
            why: "speed and steps a cycle, or the step itself, give none".into(),
        })?;
        let maps = tables.list.iter().map(|_| ContactMaps::new(&tables.settings)).collect();
        let damping = Proportional {
            alpha: scene.damping.mass_proportional_per_s,
            beta: scene.damping.stiffness_proportional_s,
        };
        let races = &statics.races;
        let settings = build::Settings { fidelity: scene.dynamics.fidelity, damping, rule };
        let gears = build::gears(&statics, scene, &tables, &settings, start)?;
        let (carrier, ports, flexibility) = build::carrier(&statics, scene, &settings)?;
        let of_bearings: Vec<f64> =
            (0..races.planets()).map(|n| planet_bearing(scene, n)).collect();
        let ratio = scene.damping.bearing_s;
        let bearings =
            Bearings::new(races, &of_bearings, ports, &flexibility, carrier.as_ref(), ratio);
        let mut whole = flexibility;
        for i in 0..whole.nrows() {
            whole[(i, i)] += 1.0 / of_bearings[i / 2];
        }
        let unstable = || FeError::NoEquilibrium("the carrier is not stable".into());
        let seat_stiffness = whole.cholesky().ok_or_else(unstable)?.inverse();
        let n = races.count;
        let mut mass = vec![0.0; n];
        let mut supports = DVector::zeros(n);
        for body in 0..PLANETS + races.planets() {
            let own = build::body_mass(&statics, scene, body)?;
            for (axis, m) in own.into_iter().enumerate() {
                if let Some(i) = races.of(body, axis) {
                    mass[i] = m;
                    if body < PLANETS {
                        supports[i] = races.support(scene, body, axis);
                    }
                }
            }
        }
        let gyroscopic = match (scene.dynamics.gyroscopic, motive) {
            (true, Motive::Turning { mesh_frequency, .. }) => {
                let speed = carrier_speed(scene, mesh_frequency);
                Some(build::gyroscopic_terms(races, &mass, speed))
            }
            _ => None,
        };
        let planets = races.planets();
        let mut resting = Motion::at_rest(n);
        resting.x.copy_from_slice(statics.reference().q.as_slice());
        let mut set = Self {
            tables,
            leaning,
            maps,
            rule,
            motive,
            lag: LagRule::new(damping.beta, &rule),
            damping,
            bearing_ratio: ratio,
            mass,
            carrier,
            bearings,
            supports,
            seat_stiffness,
            gears,
            inverse: DMatrix::zeros(n, n),
            packed_inverse: Packed::default(),
            gyroscopic,
            grid: None,
            frames: (0..count).map(|_| None).collect(),
            frames_with_backs: (0..count).map(|_| None).collect(),
            restarts: Vec::new(),
            step_in_cycle: 0,
            cycles: 0,
            steps: 0,
            external: DVector::zeros(n),
            motion: resting,
            memory: vec![PairMemory::default(); 2 * planets],
            forces: DVector::zeros(0),
            approaches: DVector::zeros(0),
            bent: DVector::zeros(n),
            touched_back: false,
            is_large: false,
            work: Work::default(),
            counts: Counts::default(),
            statics,
        };
        set.factorise()?;
        set.restarts = (0..count).map(|step| set.restarting(step)).collect();
        set.work.load = DVector::zeros(n);
        set.work.left = DVector::zeros(n);
        set.work.free = DVector::zeros(n);
        set.work.x = DVector::zeros(n);
        set.work.history = vec![0.0; n];
        set.work.expected = vec![0.0; n];
        set.is_large = set.elastic_unknowns() > LARGE;
        set.work.started = vec![Default::default(); set.gears.len()];
        set.work.ports = set.gears.iter().map(|_| Default::default()).collect();
        Ok(set)
    }

    pub(super) fn rule(&self) -> AverageAcceleration {
        self.rule
    }

    /// Time since the start, s.
    pub fn time(&self) -> f64 {
        self.steps as f64 * self.rule.step()
    }

    /// A of the races and its inverse.
    fn factorise(&mut self) -> Result<(), FeError> {
        let races = &self.statics.races;
        let n = races.count;
        let mut a = self.bearings.prepare(&self.rule, races, self.carrier.as_ref())?;
        let bodies = std::iter::once((CARRIER, self.carrier.as_ref()))
            .chain(self.gears.iter().enumerate().map(|(k, g)| (k + 1, g.vibrating.as_ref())));
        for (body, vibrating) in bodies {
            let own = vibrating.race_stiffness();
            for (i, row) in own.iter().enumerate() {
                for (k, value) in row.iter().enumerate() {
                    if let (Some(i), Some(k)) = (races.of(body, i), races.of(body, k)) {
                        a[(i, k)] += value;
                    }
                }
            }
        }
        for i in 0..n {
            a[(i, i)] += self.supports[i] * (1.0 + self.bearing_ratio * self.rule.damping());
        }
        if let Some([g, k]) = &self.gyroscopic {
            a += g * self.rule.damping() + k;
        }
        // The meshes' forces turn with their lines of action.
        a += &self.statics.reference().stiffness;
        let singular = || FeError::NoEquilibrium("the races have no inertia".into());
        self.inverse = a.try_inverse().ok_or_else(singular)?;
        self.packed_inverse = Packed::new(&self.inverse);
        Ok(())
    }

    /// Position of a step in the cycle, cycles.
    pub(super) fn position(&self, step_in_cycle: usize) -> f64 {
        match self.motive {
            Motive::Standing { position, .. } => position,
            Motive::Turning { steps_per_cycle, .. } => {
                step_in_cycle as f64 / steps_per_cycle as f64
            }
        }
    }

    /// Meshes whose phase is less at a step of the cycle than at the one before.
    fn restarting(&self, step: usize) -> Vec<usize> {
        let before = (step + self.frames.len() - 1) % self.frames.len();
        let phase = |mesh: usize, step: usize| self.statics.phase(mesh, self.position(step));
        let starts = |mesh: &usize| phase(*mesh, step) < phase(*mesh, before);
        (0..self.memory.len()).filter(starts).collect()
    }

    /// Mesh cycles since the start, as an angle knows them.
    pub(super) fn turned(&self) -> f64 {
        match self.motive {
            Motive::Standing { .. } => 0.0,
            Motive::Turning { .. } => self.cycles as f64 + self.position(self.step_in_cycle),
        }
    }

    /// A frame without back flanks.
    pub(super) fn frame_at(&self, step_in_cycle: usize) -> Option<&Frame> {
        self.frames[step_in_cycle].as_deref()
    }

    /// Steps in the cycle of the state before the last step and of the present one.
    pub(super) fn last_two_steps(&self) -> (usize, usize) {
        let count = self.frames.len();
        ((self.step_in_cycle + count - 1) % count, self.step_in_cycle)
    }

    /// The frame of the last step.
    pub(super) fn current_frame(&self) -> Option<&Frame> {
        let list = if self.touched_back { &self.frames_with_backs } else { &self.frames };
        list[self.step_in_cycle].as_deref()
    }

    /// Displacements of carrier, ring, sun (x, y, m; θ, rad; carrier frame) and of the planets
    /// (ζ, η, θ), counter-clockwise.
    pub fn displacements(&self) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        self.statics.displacements(&DVector::from_column_slice(&self.motion.x))
    }

    /// Displacements, velocities and accelerations of the races' free coordinates, m and s.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The races' coordinates.
    pub fn races(&self) -> &Races {
        &self.statics.races
    }

    /// The configuration the set is linearised about.
    pub fn reference(&self) -> &Reference {
        self.statics.reference()
    }

    /// Masses of the races' coordinates with rigid bodies, kg.
    pub fn masses(&self) -> &[f64] {
        &self.mass
    }

    /// Force of each mesh: sun meshes, ring meshes, and back flanks if they took part, N.
    pub fn mesh_forces(&self, out: &mut Vec<f64>) {
        out.clear();
        if let Some(frame) = self.current_frame() {
            out.extend(frame.meshes.iter().map(|mesh| {
                self.forces.as_slice()[mesh.first..mesh.first + mesh.count].iter().sum::<f64>()
            }));
        }
    }

    /// Degrees of freedom beside the races'.
    pub fn elastic_unknowns(&self) -> usize {
        self.gears.iter().map(|g| g.vibrating.unknowns()).sum::<usize>() + self.carrier.unknowns()
    }

    /// Memory of tables, contact maps and frames, bytes.
    pub fn bytes(&self) -> [usize; 3] {
        let frames = self.frames.iter().chain(&self.frames_with_backs).flatten();
        let maps = self.maps.iter().map(ContactMaps::bytes).sum();
        [self.tables.bytes(), maps, frames.map(|frame| frame.bytes()).sum()]
    }

    /// Contact problems solved so far, and maps kept.
    pub fn contact_counts(&self) -> [usize; 2] {
        [self.maps.iter().map(|m| m.solved).sum(), self.maps.iter().map(ContactMaps::count).sum()]
    }
}

/// Speed of the carrier (rad/s) at a mesh frequency (Hz), seen so that the sun turns counter-clockwise
/// against it, as positions in the mesh cycle count in either sense of torque.
pub(super) fn carrier_speed(scene: &Scene, mesh_frequency: f64) -> f64 {
    match Kinematics::from_scene(scene) {
        Ok(k) if k.mesh_frequency_hz > 0.0 => {
            let speeds = k.speeds_rad_per_s;
            let sense = (speeds.sun - speeds.carrier).signum();
            sense * speeds.carrier * mesh_frequency / k.mesh_frequency_hz
        }
        _ => 0.0,
    }
}
