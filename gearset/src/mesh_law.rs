//! The forces of all meshes of a set over deflection, phase and flank, as tables.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::gear::Facing;
use crate::mesh_curve::{CurveError, MeshCurve};
use crate::mesh_kind::MeshKind;
use crate::path_direction::PathDirection;
use crate::phasing::Phasing;

/// Resolution of phases, 1/cycle: phases that round to the same multiple of its inverse count as equal.
const PHASE_RESOLUTION: f64 = 1e12;

/// Which flanks of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FlankSide {
    /// The flanks loaded by the torque.
    Front,
    /// The flanks on the non-driving side, the backlash apart.
    Backside,
}

/// One curve that a law needs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurveKey {
    /// Mesh.
    pub kind: MeshKind,
    /// Flank.
    pub side: FlankSide,
    /// Phase in [0, 1), cycles; of a backside flank, that of the mirrored mesh.
    pub phase: f64,
    /// First mesh of the kind and class; meshes are numbered sun meshes by planet, then ring meshes.
    pub mesh: usize,
}

/// Where one mesh stands in its cycle at position 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshStart {
    /// Mesh.
    pub kind: MeshKind,
    /// Meshes of a kind and class have one relation between force, deflection and phase. Unevenly spaced planets carry
    /// different loads and have classes of their own.
    pub class: usize,
    /// Phase of the front flanks, cycles; it increases with the position.
    pub front: f64,
    /// Phase of the backside flanks, cycles; it decreases with the position. `None` leaves them out.
    pub backside: Option<f64>,
}

impl MeshStart {
    /// Phases of the front flanks of all meshes, sun meshes first, at position 0, where planet 0's sun mesh
    /// starts its cycle, under counter-clockwise torque on the sun; all meshes of a kind are of one class.
    pub fn of_set(phasing: &Phasing<'_>) -> Vec<Self> {
        let phases = phasing.phases(0.0, Facing::CounterClockwise);
        let first = phases.sun_planet.first().copied().unwrap_or(0.0);
        let list = |kind, phases: Vec<f64>| {
            phases.into_iter().map(move |phase| Self {
                kind,
                class: 0,
                front: phase - first,
                backside: None,
            })
        };
        let sun = list(MeshKind::SunPlanet, phases.sun_planet);
        sun.chain(list(MeshKind::RingPlanet, phases.ring_planet)).collect()
    }
}

/// The curves that the meshes of a set need at evenly spaced positions of a mesh cycle; meshes of a kind and class
/// share a curve where their phases are equal.
///
/// Every (mesh, step) has the curve of its exact phase: nothing is interpolated in phase.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshLawPlan {
    /// Distinct curves, in order of first use.
    pub curves: Vec<CurveKey>,
    meshes: usize,
    /// Index of the curve of each front flank, by step, then mesh.
    front: Vec<u32>,
    backside: Vec<u32>,
}

/// Why a mesh law cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MeshLawError {
    /// No meshes or no steps.
    #[error("a mesh law of {meshes} meshes and {steps} steps: each must be at least 1")]
    Empty {
        /// Meshes.
        meshes: usize,
        /// Steps per cycle.
        steps: usize,
    },
    /// Backside flanks of some meshes only.
    #[error("a mesh law holds the backside flanks of all meshes or of none")]
    SomeBackside,
    /// The number of curves is not the number of keys.
    #[error("{got} curves for a mesh law that needs {wanted}")]
    Curves {
        /// Curves given.
        got: usize,
        /// Curves asked for.
        wanted: usize,
    },
    /// A damping share outside 0 to 1.
    #[error("damping share {value} of mesh {mesh} is not in [0, 1]")]
    Share {
        /// Mesh.
        mesh: usize,
        /// Value given.
        value: f64,
    },
    /// Tables whose lengths do not match, or an index without a curve.
    #[error("the tables of a mesh law do not fit each other")]
    Places,
    /// A force under which a mesh has no deflection, or one that is not positive.
    #[error("mesh {mesh} has no positive deflection under {force_n} N at step {step} of its cycle")]
    Deflection {
        /// Mesh.
        mesh: usize,
        /// Step of the mesh cycle.
        step: usize,
        /// Force, N.
        force_n: f64,
    },
    /// A curve that cannot be made.
    #[error(transparent)]
    Curve(#[from] CurveError),
}

impl MeshLawPlan {
    /// Plan for meshes (sun meshes by planet, then ring meshes) at `steps` evenly spaced positions.
    ///
    /// # Errors
    /// Without meshes or steps, or if only some meshes have backside flanks.
    pub fn new(meshes: &[MeshStart], steps: usize) -> Result<Self, MeshLawError> {
        if meshes.is_empty() || steps == 0 {
            return Err(MeshLawError::Empty { meshes: meshes.len(), steps });
        }
        let with_backside = meshes.iter().filter(|m| m.backside.is_some()).count();
        if with_backside != 0 && with_backside != meshes.len() {
            return Err(MeshLawError::SomeBackside);
        }
        let mut plan = Self {
            curves: Vec::new(),
            meshes: meshes.len(),
            front: Vec::new(),
            backside: Vec::new(),
        };
        let mut known = HashMap::new();
        for step in 0..steps {
            let position = step as f64 / steps as f64;
            for mesh in meshes {
                let is_alike = |m: &MeshStart| (m.kind, m.class) == (mesh.kind, mesh.class);
                let first = meshes.iter().position(is_alike).unwrap_or_default();
                let mut place = |side, phase: f64| {
                    let (kind, phase) = (mesh.kind, cycle(phase));
                    let key = (kind, mesh.class, side, (phase * PHASE_RESOLUTION).round() as i64);
                    *known.entry(key).or_insert_with(|| {
                        plan.curves.push(CurveKey { kind, side, phase, mesh: first });
                        plan.curves.len() as u32 - 1
                    })
                };
                plan.front.push(place(FlankSide::Front, mesh.front + position));
                if let Some(backside) = mesh.backside {
                    plan.backside.push(place(FlankSide::Backside, backside - position));
                }
            }
        }
        Ok(plan)
    }

    /// The law, from one curve for each key.
    ///
    /// # Errors
    /// If there are more or fewer curves than keys.
    pub fn law(self, curves: Vec<MeshCurve>) -> Result<MeshLaw, MeshLawError> {
        if curves.len() != self.curves.len() {
            return Err(MeshLawError::Curves { got: curves.len(), wanted: self.curves.len() });
        }
        let Self { meshes, front, backside, .. } = self;
        let (damping_share, side_loads) = (vec![1.0; meshes], Vec::new());
        let direction = PathDirection::Forward;
        Ok(MeshLaw { meshes, curves, front, backside, damping_share, side_loads, direction })
    }
}

/// Phase reduced to [0, 1); a phase that rounds to 1 at the resolution becomes 0.
fn cycle(phase: f64) -> f64 {
    let reduced = phase - phase.floor();
    if reduced * PHASE_RESOLUTION >= PHASE_RESOLUTION - 0.5 { 0.0 } else { reduced }
}

/// Mesh forces of a set over (deflection, step of the mesh cycle, flank). Meshes are numbered sun meshes by
/// planet, then ring meshes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StoredMeshLaw")]
pub struct MeshLaw {
    meshes: usize,
    curves: Vec<MeshCurve>,
    /// Index of the curve of each mesh's front flanks, by step, then mesh.
    front: Vec<u32>,
    /// The same for the backside flanks; empty if they are left out.
    backside: Vec<u32>,
    /// Share of each mesh's flexibility that stiffness-proportional damping acts on.
    damping_share: Vec<f64>,
    /// Side load of each curve, N; empty without side loads.
    side_loads: Vec<[f64; 6]>,
    /// Direction in which steps pass the positions.
    #[serde(skip_serializing_if = "is_forward")]
    direction: PathDirection,
}

fn is_forward(direction: &PathDirection) -> bool {
    *direction == PathDirection::Forward
}

/// A law as stored in files, before its tables are checked.
#[derive(Deserialize)]
struct StoredMeshLaw {
    meshes: usize,
    curves: Vec<MeshCurve>,
    front: Vec<u32>,
    backside: Vec<u32>,
    damping_share: Vec<f64>,
    side_loads: Vec<[f64; 6]>,
    #[serde(default)]
    direction: PathDirection,
}

impl TryFrom<StoredMeshLaw> for MeshLaw {
    type Error = MeshLawError;

    fn try_from(tables: StoredMeshLaw) -> Result<Self, MeshLawError> {
        let StoredMeshLaw { meshes, curves, front, backside, damping_share, side_loads, direction } =
            tables;
        let is_place = |place: &u32| (*place as usize) < curves.len();
        let steps = front.len().checked_div(meshes).unwrap_or(0);
        let fits = steps > 0
            && front.len() == steps * meshes
            && (backside.is_empty() || backside.len() == front.len())
            && front.iter().chain(&backside).all(is_place)
            && damping_share.len() == meshes;
        if !fits {
            return Err(MeshLawError::Places);
        }
        let given = vec![1.0; meshes];
        let none = Vec::new();
        let law = Self {
            meshes,
            curves,
            front,
            backside,
            damping_share: given,
            side_loads: none,
            direction,
        };
        let law = law.with_damping_share(&damping_share)?;
        if side_loads.is_empty() { Ok(law) } else { law.with_side_loads(side_loads) }
    }
}

impl MeshLaw {
    /// The same law with the share of each mesh's flexibility that stiffness-proportional damping acts on.
    /// In a new law every share is 1.
    ///
    /// # Errors
    /// If a share is outside 0 to 1, or the number of shares is not that of meshes.
    pub fn with_damping_share(mut self, share: &[f64]) -> Result<Self, MeshLawError> {
        if share.len() != self.meshes {
            return Err(MeshLawError::Places);
        }
        if let Some(mesh) = share.iter().position(|s| !(0.0..=1.0).contains(s)) {
            return Err(MeshLawError::Share { mesh, value: share[mesh] });
        }
        self.damping_share = share.to_vec();
        Ok(self)
    }

    /// The same law with side loads, one for each curve, N: on the central gear (radial towards the planet,
    /// tangential, u = r θ), then on the planet (ζ, η, u).
    ///
    /// A pair in corner contact presses along another normal than the line of action. The load that the
    /// difference causes under the mean torque is taken as a function of phase alone.
    ///
    /// # Errors
    /// If there is not one finite load for each curve.
    pub fn with_side_loads(mut self, loads: Vec<[f64; 6]>) -> Result<Self, MeshLawError> {
        let is_sound = loads.iter().flatten().all(|f| f.is_finite());
        if loads.len() != self.curves.len() || !is_sound {
            return Err(MeshLawError::Places);
        }
        self.side_loads = loads;
        Ok(self)
    }

    /// The law of a prescribed mesh stiffness: every mesh is a spring whose stiffness depends on the phase
    /// alone. Front flanks that deflect by δ(F̄) under the force F̄ (`force_n`, N) in this law have
    ///
    /// `[eq:prescribed-stiffness]` Force of the front flanks:
    /// ```text
    /// F = k δ for δ > 0, otherwise 0,   k = F̄/δ(F̄)
    /// ```
    /// Source: definition.
    /// Checked by: `gearset/src/mesh_law.rs::prescribed_stiffness_is_the_secant_under_the_given_force`.
    ///
    /// so that each mesh deflects under F̄ as before. Side loads stay; there are no backside flanks.
    ///
    /// # Errors
    /// If a front flank has no positive deflection under the force.
    pub fn with_prescribed_stiffness(&self, force_n: f64) -> Result<Self, MeshLawError> {
        let mut curves = self.curves.clone();
        for (k, place) in self.front.iter().enumerate() {
            let place = *place as usize;
            let (mesh, step) = (k % self.meshes, k / self.meshes);
            let none = MeshLawError::Deflection { mesh, step, force_n };
            let deflection = self.curves[place].deflection(force_n).filter(|d| *d > 0.0);
            let deflection = deflection.ok_or(none)?;
            let stiffness = force_n / deflection;
            curves[place] =
                MeshCurve::new(0.0, deflection, &[0.0, force_n], &[stiffness, stiffness])?;
        }
        Ok(Self { curves, backside: Vec::new(), ..self.clone() })
    }

    /// The law of a set whose meshes run in a direction: with backward ones step k has the tables of position −k/S.
    pub fn in_direction(mut self, direction: PathDirection) -> Self {
        if direction != self.direction {
            self.direction = direction;
            for places in [&mut self.front, &mut self.backside] {
                let steps: Vec<&[u32]> = places.chunks(self.meshes).collect();
                let reversed = steps.iter().take(1).chain(steps.iter().skip(1).rev());
                *places = reversed.flat_map(|step| step.iter().copied()).collect();
            }
        }
        self
    }

    /// The same law with forces along the lines of action alone.
    pub fn without_side_loads(self) -> Self {
        Self { side_loads: Vec::new(), ..self }
    }

    /// Side load of a mesh's front flanks at a step, N; zero if the law has none.
    pub fn side_load(&self, mesh: usize, step_in_cycle: usize) -> [f64; 6] {
        let place = self.front[step_in_cycle * self.meshes + mesh] as usize;
        self.side_loads.get(place).copied().unwrap_or_default()
    }

    /// Number of meshes, two per planet.
    pub fn meshes(&self) -> usize {
        self.meshes
    }

    /// Steps of a mesh cycle.
    pub fn steps(&self) -> usize {
        self.front.len() / self.meshes
    }

    /// Direction in which steps pass the positions.
    pub fn direction(&self) -> PathDirection {
        self.direction
    }

    /// Whether the law includes the backside flanks.
    pub fn has_backside(&self) -> bool {
        !self.backside.is_empty()
    }

    /// Share of a mesh's flexibility that stiffness-proportional damping acts on.
    pub fn damping_share(&self, mesh: usize) -> f64 {
        self.damping_share[mesh]
    }

    /// Distinct curves.
    pub fn curves(&self) -> &[MeshCurve] {
        &self.curves
    }

    /// Curve of a mesh's front flanks at a step of the cycle.
    #[inline]
    pub fn front(&self, mesh: usize, step_in_cycle: usize) -> &MeshCurve {
        &self.curves[self.front[step_in_cycle * self.meshes + mesh] as usize]
    }

    /// Curve of a mesh's backside flanks over their approach; `None` if they are left out.
    #[inline]
    pub fn backside(&self, mesh: usize, step_in_cycle: usize) -> Option<&MeshCurve> {
        let place = self.backside.get(step_in_cycle * self.meshes + mesh)?;
        self.curves.get(*place as usize)
    }

    /// Curve of flank number `flank` at a step of the cycle: the front flanks of all meshes are numbered
    /// first, then the backside flanks. `None` for a backside flank that is left out.
    #[inline]
    pub fn curve(&self, flank: usize, step_in_cycle: usize) -> Option<&MeshCurve> {
        match flank.checked_sub(self.meshes) {
            None => Some(self.front(flank, step_in_cycle)),
            Some(mesh) => self.backside(mesh, step_in_cycle),
        }
    }

    /// Force (N) and tangent (N/m) of a flank, numbered as in [`curve`](Self::curve).
    #[inline]
    pub fn force(&self, flank: usize, step_in_cycle: usize, deflection: f64) -> (f64, f64) {
        self.curve(flank, step_in_cycle).map_or((0.0, 0.0), |curve| curve.force(deflection))
    }

    /// Whether two flanks, numbered as in [`curve`](Self::curve), each at a step, share a curve: those of a kind and
    /// class do where their phases are equal.
    pub fn is_same(&self, first: (usize, usize), second: (usize, usize)) -> bool {
        let place = |(flank, step): (usize, usize)| match flank.checked_sub(self.meshes) {
            None => self.front.get(step * self.meshes + flank),
            Some(mesh) => self.backside.get(step * self.meshes + mesh),
        };
        place(first).is_some() && place(first) == place(second)
    }

    /// Deflection up to which a flank, numbered as in [`curve`](Self::curve), touches at no step, m.
    pub fn silent_up_to_m(&self, flank: usize) -> f64 {
        let (mesh, side) = match flank.checked_sub(self.meshes) {
            None => (flank, FlankSide::Front),
            Some(mesh) => (mesh, FlankSide::Backside),
        };
        self.first_contact_m(mesh, side).unwrap_or(f64::INFINITY)
    }

    /// Least deflection of first contact of a mesh's flanks over the cycle, m; `None` if they are left out.
    pub fn first_contact_m(&self, mesh: usize, side: FlankSide) -> Option<f64> {
        let starts = (0..self.steps()).map(|step| match side {
            FlankSide::Front => Some(self.front(mesh, step).start_m()),
            FlankSide::Backside => self.backside(mesh, step).map(MeshCurve::start_m),
        });
        starts.flatten().reduce(f64::min)
    }

    /// Memory of the tables, bytes.
    pub fn bytes(&self) -> usize {
        let nodes: usize = self.curves.iter().map(|c| c.nodes().len()).sum();
        16 * nodes + 4 * (self.front.len() + self.backside.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn starts(backside: bool) -> Vec<MeshStart> {
        let one = |kind| {
            move |n: u32| MeshStart {
                kind,
                class: 0,
                // Offsets of 3/7 cycle: the meshes share curves where the number of steps is a multiple
                // of 7, and have curves of their own otherwise.
                front: f64::from(n) * 3.0 / 7.0,
                backside: backside.then_some(-f64::from(n) * 3.0 / 7.0),
            }
        };
        let sun = (0..3).map(one(MeshKind::SunPlanet));
        sun.chain((0..3).map(one(MeshKind::RingPlanet))).collect()
    }

    fn law(plan: MeshLawPlan) -> MeshLaw {
        let curve = |key: &CurveKey| MeshCurve::new(key.phase, 1.0, &[0.0, 1.0], &[1.0, 1.0]);
        let curves = plan.curves.iter().map(|key| curve(key).unwrap()).collect();
        plan.law(curves).unwrap()
    }

    /// Hand calculation: curves from first contact at their phase φ on with 1 N/m, so that 0.5 N deflect them by φ +
    /// 0.5 m.
    #[test]
    fn prescribed_stiffness_is_the_secant_under_the_given_force() {
        let tabulated = law(MeshLawPlan::new(&starts(true), 14).unwrap())
            .with_side_loads(vec![[1.0; 6]; 56])
            .unwrap();
        let own = tabulated.with_prescribed_stiffness(0.5).unwrap();
        assert!(!own.has_backside());
        for mesh in 0..6 {
            for step in 0..14 {
                let deflection = tabulated.front(mesh, step).start_m() + 0.5;
                for share in [0.0, 0.2, 1.0, 3.0] {
                    let (force, tangent) = own.force(mesh, step, share * deflection);
                    assert!((force - share * 0.5).abs() < 1e-12);
                    assert!(share == 0.0 || (tangent * deflection - 0.5).abs() < 1e-12);
                }
                assert_eq!(own.force(mesh, step, -1.0), (0.0, 0.0));
                assert_eq!(own.side_load(mesh, step), [1.0; 6]);
            }
        }
        assert_eq!(own.without_side_loads().side_load(0, 0), [0.0; 6]);
        let refused = tabulated.with_prescribed_stiffness(0.0).unwrap_err();
        assert_eq!(refused, MeshLawError::Deflection { mesh: 0, step: 0, force_n: 0.0 });
    }

    #[test]
    fn every_mesh_and_step_has_the_curve_of_its_exact_phase() {
        for (steps, shared) in [(140, true), (141, false)] {
            let plan = MeshLawPlan::new(&starts(true), steps).unwrap();
            let distinct = 4 * steps * if shared { 1 } else { 3 };
            assert_eq!(plan.curves.len(), distinct);
            let law = law(plan);
            for (mesh, start) in starts(true).iter().enumerate() {
                for step in 0..steps {
                    let position = step as f64 / steps as f64;
                    let apart =
                        |found: f64, exact: f64| (found - exact + 0.5).rem_euclid(1.0) - 0.5;
                    let front = law.front(mesh, step).start_m();
                    assert!(apart(front, start.front + position).abs() < 1e-12);
                    let backside = law.backside(mesh, step).unwrap().start_m();
                    assert!(apart(backside, start.backside.unwrap() - position).abs() < 1e-12);
                }
            }
            assert_eq!((law.steps(), law.meshes()), (steps, 6));
        }
    }

    /// Meshes of several classes share no curve, each keeps those of its phase, and a curve names its first mesh.
    #[test]
    fn meshes_of_different_classes_share_no_curve() {
        let mut meshes = starts(true);
        meshes[1].class = 1;
        meshes[4].class = 1;
        let plan = MeshLawPlan::new(&meshes, 140).unwrap();
        assert_eq!(plan.curves.len(), 2 * 4 * 140);
        let own = |mesh: usize| plan.curves.iter().filter(|key| key.mesh == mesh).count();
        assert_eq!([0, 1, 2, 3, 4, 5].map(own), [280, 280, 0, 280, 280, 0]);
        let law = law(plan);
        for step in 0..140 {
            let later = (step + 120) % 140;
            // Mesh 2 is 6/7 of a cycle ahead of mesh 0.
            assert!(law.is_same((2, step), (0, later)) && !law.is_same((1, step), (0, later)));
            let apart = law.front(1, step).start_m() - meshes[1].front - step as f64 / 140.0;
            assert!((apart - apart.round()).abs() < 1e-12);
        }
    }

    #[test]
    fn backward_steps_have_the_curves_of_the_positions_that_they_pass() {
        let forward = law(MeshLawPlan::new(&starts(true), 10).unwrap());
        let backward = forward.clone().in_direction(PathDirection::Backward);
        for (flank, step) in (0..12).flat_map(|flank| (0..10).map(move |step| (flank, step))) {
            let position = (10 - step) % 10;
            assert_eq!(backward.curve(flank, step), forward.curve(flank, position));
        }
        assert_eq!(backward.clone().in_direction(PathDirection::Backward), backward);
        assert_eq!(backward.in_direction(PathDirection::Forward), forward);
    }

    #[test]
    fn what_makes_no_law_is_refused() {
        assert!(MeshLawPlan::new(&[], 10).is_err());
        assert!(MeshLawPlan::new(&starts(false), 0).is_err());
        let mut some = starts(true);
        some[2].backside = None;
        assert_eq!(MeshLawPlan::new(&some, 4), Err(MeshLawError::SomeBackside));
        assert!(MeshLawPlan::new(&starts(false), 4).unwrap().law(Vec::new()).is_err());
        let law = law(MeshLawPlan::new(&starts(false), 4).unwrap());
        assert!(!law.has_backside() && law.backside(0, 0).is_none());
        assert!(law.clone().with_damping_share(&[1.0; 5]).is_err());
        assert!(law.with_damping_share(&[1.0, 0.5, 0.0, 1.5, 1.0, 1.0]).is_err());
    }
}
