//! A whole set: races, phases of all meshes, and the loaded configuration it is linearised about.
//!
//! Its methods are in the modules `tables` (contact tables), `placing` (meshes at a position),
//! `equilibrium`, and `cycle` (a mesh cycle, and the loaded configuration).

use gearset::{Axis, Body, Facing, MeshKind, MeshPhases, MeshStart, Phasing, PlanetPositions};
use nalgebra::DVector;
use scene::{Scene, SceneKind};

use super::bodies::{Bodies, missing_mesh};
use super::imperfection::Imperfections;
use super::nominal_mesh::NominalMesh;
use super::phase::cycle;
use super::races::Races;
use super::reference::{ReferenceConfiguration, ReferenceInputs};
use crate::error::FeError;

/// A set with the configuration about which it is linearised.
///
/// ```
/// use fe_contact::complementarity::ActiveSet;
/// use fe_contact::statics::{Bodies, Imperfections, StaticSet};
/// use scene::{LoadCase, Scene, SceneKind, template};
///
/// let scene = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
/// let (bodies, load) = (Bodies::new(&scene).unwrap(), LoadCase::standing(1000.0));
/// let set = StaticSet::new(&scene, &bodies, load.sense(), Imperfections::default()).unwrap();
/// let cycle = set.cycle(load.sun_load_nm(), 4, &ActiveSet).unwrap();
/// // The sun meshes carry the torque between them; pairs at corners press a little off the line of action.
/// let carried: f64 = cycle.states[0].meshes.iter().take(scene.planets.count()).map(|m| m.force).sum();
/// let radius = bodies.geometry.sun.as_ref().unwrap().base_radius;
/// assert!((carried * radius / 1000.0 - 1.0).abs() < 5e-3);
/// ```
#[derive(Debug, Clone)]
pub struct StaticSet<'s> {
    pub(crate) bodies: &'s Bodies,
    pub(crate) races: Races,
    /// −1 if the torque is clockwise, else +1. With −1 everything is mirrored, so that the loaded
    /// flanks are always those of a counter-clockwise torque.
    pub(crate) sign: f64,
    /// All meshes: sun meshes, then ring meshes.
    pub(super) nominal: Vec<NominalMesh>,
    /// Sun's angle (mirrored frame) where planet 0's sun mesh is at phase 0, unloaded, rad.
    pub(super) start_angle: f64,
    pub(super) imperfections: Imperfections,
    pub(crate) reference: ReferenceConfiguration,
}

impl<'s> StaticSet<'s> {
    /// A set for a torque on the sun of the given sense, linearised about the unloaded
    /// configuration; [`StaticSet::under`] linearises it about the mean configuration under a
    /// torque.
    ///
    /// # Errors
    /// If the scene describes neither a whole set nor a sun–planet pair, or the carrier cannot be meshed.
    pub fn new(
        scene: &Scene,
        bodies: &'s Bodies,
        sense: Facing,
        imperfections: Imperfections,
    ) -> Result<Self, FeError> {
        let sign = sense.sign();
        // Mirroring changes the sign of the assembly steps, which stay whole numbers.
        let positions = PlanetPositions {
            psi_rad: scene.planets.psi_rad.iter().map(|psi| sign * psi).collect(),
            steps: scene
                .planets
                .steps
                .as_ref()
                .map(|steps| steps.iter().map(|s| if sign < 0.0 { -s } else { *s }).collect()),
        };
        let (mesh, _) = bodies.joined(MeshKind::SunPlanet)?;
        let phases = |sun_angle: f64, loaded: Facing| match scene.kind {
            SceneKind::Planetary => {
                let phasing = Phasing::new(&bodies.geometry, &positions)
                    .ok_or_else(|| missing_mesh(MeshKind::RingPlanet))?;
                Ok(phasing.phases(sun_angle, loaded))
            }
            SceneKind::GearPair => {
                let own = cycle(mesh.sun_mesh_phase(sun_angle, loaded));
                Ok::<_, FeError>(MeshPhases { sun_planet: vec![own], ring_planet: Vec::new() })
            }
        };
        let at_zero = phases(0.0, Facing::CounterClockwise)?;
        let first = at_zero.sun_planet[0];
        // Phases of the backside flanks at the same sun angle. The planets stand where the front
        // flanks of the sun meshes touch, one sun-mesh backlash ahead of where the backside flanks
        // would touch.
        let at_backside = phases(-first * pitch_angle(bodies), Facing::Clockwise)?;
        let normal = bodies.geometry.normal_backlash(MeshKind::SunPlanet).unwrap_or(0.0);
        let ahead = normal / bodies.geometry.base_pitch;
        let list = |kind, front: &[f64], backside: &[f64], ahead: f64| -> Vec<NominalMesh> {
            let one = |(planet, (front, backside)): (usize, (&f64, &f64))| NominalMesh {
                kind,
                planet,
                offset: front - first,
                backside_offset: backside + ahead,
            };
            front.iter().zip(backside).enumerate().map(one).collect()
        };
        let mut nominal =
            list(MeshKind::SunPlanet, &at_zero.sun_planet, &at_backside.sun_planet, 0.0);
        nominal.extend(list(
            MeshKind::RingPlanet,
            &at_zero.ring_planet,
            &at_backside.ring_planet,
            ahead,
        ));
        let races = Races::new(scene, bodies, &positions.psi_rad)?;
        let imperfections = imperfections.mirrored(sign);
        let unloaded = DVector::zeros(races.count);
        let inputs = ReferenceInputs {
            bodies,
            races: &races,
            nominal: &nominal,
            imperfections: &imperfections,
        };
        let reference = ReferenceConfiguration::new(&inputs, 0.0, unloaded, &[])?;
        let start_angle = -first * pitch_angle(bodies);
        Ok(Self { bodies, races, sign, nominal, start_angle, imperfections, reference })
    }

    pub(super) fn reference_at(
        &self,
        torque_nm: f64,
        q: DVector<f64>,
        forces: &[f64],
    ) -> Result<ReferenceConfiguration, FeError> {
        ReferenceConfiguration::new(&self.inputs(), torque_nm, q, forces)
    }

    pub(super) fn inputs(&self) -> ReferenceInputs<'_> {
        ReferenceInputs {
            bodies: self.bodies,
            races: &self.races,
            nominal: &self.nominal,
            imperfections: &self.imperfections,
        }
    }

    /// The configuration the set is linearised about.
    pub fn reference(&self) -> &ReferenceConfiguration {
        &self.reference
    }

    /// −1 if the set is computed as its mirror image, otherwise 1.
    pub(crate) fn sign(&self) -> f64 {
        self.sign
    }

    /// The races' coordinates.
    pub fn races(&self) -> &Races {
        &self.races
    }

    /// Generalised load of a torque on the sun (N m, magnitude) on the races' coordinates, N.
    pub(crate) fn load(&self, torque_nm: f64) -> DVector<f64> {
        self.races.load(torque_nm)
    }

    /// Number of meshes: two for each planet of a set, one of a pair.
    pub(crate) fn meshes(&self) -> usize {
        self.nominal.len()
    }

    /// Angle of the sun's tooth 0 (mirrored frame) at a position, with the sun's rotation at the
    /// reference, rad.
    pub(super) fn sun_angle(&self, position: f64) -> f64 {
        let unloaded = position - self.reference.lead();
        let wound = self.races.of(Body::Sun, Axis::Rotation).map_or(0.0, |i| self.reference.q[i]);
        self.start_angle + unloaded * pitch_angle(self.bodies) + wound / self.races.radii[2]
    }

    /// Whether sun teeth have pitch errors, which make gap offsets differ from one mesh cycle to
    /// the next.
    pub(crate) fn has_tooth_errors(&self) -> bool {
        !self.imperfections.pitch_errors.is_empty()
    }

    /// Phase of a front mesh (sun meshes, then ring meshes) at a position, cycles in [0, 1).
    ///
    /// Positions count from where planet 0's sun mesh starts its path under the reference's load,
    /// so that a windup common to all meshes only shifts the time.
    pub(crate) fn phase(&self, mesh: usize, position: f64) -> f64 {
        cycle(position + self.offset(mesh))
    }

    /// Phase of a front mesh at position 0, not reduced, cycles.
    pub(super) fn offset(&self, mesh: usize) -> f64 {
        let pose = &self.reference.meshes[mesh];
        let shift = self.reference.loaded[pose.group].shift;
        self.nominal[mesh].offset + (shift - self.reference.lead())
    }

    /// Phase of the mirrored mesh of backside flanks at position 0, cycles.
    pub(super) fn backside_offset(&self, mesh: usize) -> f64 {
        let shift = self.reference.backside[mesh].shift;
        self.nominal[mesh].backside_offset + shift + self.reference.lead()
    }

    /// Phases of all meshes at position 0, sun meshes, then ring meshes; `classes` gives the class of each.
    pub(crate) fn law_starts(&self, classes: &[usize], has_backside: bool) -> Vec<MeshStart> {
        let one = |(mesh, of): (usize, &NominalMesh)| MeshStart {
            kind: of.kind,
            class: classes[mesh],
            front: self.offset(mesh),
            backside: has_backside.then(|| self.backside_offset(mesh)),
        };
        self.nominal.iter().enumerate().map(one).collect()
    }

    /// Displacements (m, m, rad) of carrier, ring, sun and of the planets in the frame of the scene.
    pub(crate) fn displacements(&self, q: &DVector<f64>) -> ([[f64; 3]; 3], Vec<[f64; 3]>) {
        let radii = self.races.radii;
        let of = |body: Body| {
            let [first, second, u] = self.races.displaced(q, body);
            // Mirrored back: y and θ change sign.
            // A gear that the set does not have has no radius, and does not turn.
            let turned = if u == 0.0 { 0.0 } else { u / radii[body.kind()] };
            [first, self.sign * second, self.sign * turned]
        };
        (Body::CENTRAL.map(of), (0..self.races.planets()).map(Body::Planet).map(of).collect())
    }
}

/// Angle between the sun's teeth, rad.
pub(super) fn pitch_angle(bodies: &Bodies) -> f64 {
    bodies.geometry.sun.as_ref().map_or(0.0, gearset::Gear::pitch_angle)
}
