//! The flexible gears of a scene.

use gearset::{FeContactInput, Gear, Geometry, MeshKind, MeshMember, Scene};

use crate::body::GearBody;
use crate::contact::{CellSettings, Matching};
use crate::error::FeError;
use crate::material::Elastic;
use crate::mesh::GearMesh;

/// Settings of a run, worked out from the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeSettings {
    /// Choices of the scene.
    pub input: FeContactInput,
    /// Where half-plane and FE are matched.
    pub matching: Matching,
}

/// Default matching depth in base pitches.
const DEPTH_IN_BASE_PITCHES: f64 = 0.07;

/// Gears of a scene with their flexibility.
#[derive(Debug, Clone)]
pub struct Bodies {
    /// Tooth geometry.
    pub geometry: Geometry,
    /// Settings.
    pub settings: FeSettings,
    /// Material.
    pub material: Elastic,
    /// Sun, if the scene needs it.
    pub sun: Option<GearBody>,
    /// Planet.
    pub planet: GearBody,
    /// Ring, if the scene needs it.
    pub ring: Option<GearBody>,
}

impl Bodies {
    /// Meshes and factorises the gears a scene needs: all of a set, two of a pair.
    ///
    /// # Errors
    /// If the scene has no tooth geometry, or a mesh cannot be had.
    pub fn new(scene: &Scene) -> Result<Self, FeError> {
        let missing = FeError::Missing {
            key: "geometry".into(),
            why: "teeth are needed to mesh and to touch",
        };
        let geometry = Geometry::from_scene(scene).and_then(Result::ok).ok_or(missing)?;
        let input = scene.fe_contact;
        let material = Elastic::new(&scene.material, input.plane);
        let depth = input.matching_depth.unwrap_or(DEPTH_IN_BASE_PITCHES * geometry.base_pitch);
        let points = input.matching_points as usize;
        let settings = FeSettings { input, matching: Matching { depth, points } };
        let make = |name: &'static str, gear: &Gear| -> Result<GearBody, FeError> {
            let mesh = GearMesh::new(name, gear, input.element, input.flank_elements as usize)?;
            GearBody::new(mesh, material, geometry.face_width)
        };
        let wanted = |kind: MeshKind| scene.pair.is_none_or(|pair| pair == kind);
        let (sun_gear, ring_gear) = (
            geometry.sun.as_ref().filter(|_| wanted(MeshKind::SunPlanet)),
            geometry.ring.as_ref().filter(|_| wanted(MeshKind::RingPlanet)),
        );
        // The gears are independent of each other: one thread each, whatever the machine.
        let (sun, planet, ring) = std::thread::scope(|scope| {
            let ring = scope.spawn(|| ring_gear.map(|g| make("ring", g)).transpose());
            let sun = sun_gear.map(|g| make("sun", g)).transpose();
            let planet = make("planet", &geometry.planet);
            (sun, planet, ring.join())
        });
        let ring = match ring {
            Ok(ring) => ring?,
            Err(panic) => std::panic::resume_unwind(panic),
        };
        let (sun, planet) = (sun?, planet?);
        Ok(Self { geometry, settings, material, sun, planet, ring })
    }

    /// The body of one member of a mesh.
    pub fn body(&self, kind: MeshKind, member: MeshMember) -> Option<&GearBody> {
        match (kind, member) {
            (MeshKind::SunPlanet, MeshMember::Driver) => self.sun.as_ref(),
            (MeshKind::RingPlanet, MeshMember::Driven) => self.ring.as_ref(),
            _ => Some(&self.planet),
        }
    }

    /// Both bodies of a mesh, driver first.
    pub fn pair(&self, kind: MeshKind) -> Option<[&GearBody; 2]> {
        Some([self.body(kind, MeshMember::Driver)?, self.body(kind, MeshMember::Driven)?])
    }

    /// Cells for meshes that carry up to `force` (N).
    ///
    /// The window for tip contact is the deflection of a mesh six times softer than a pair of steel
    /// teeth usually is (E b/13 of one pair): no corner that could touch is left out, and what was
    /// left out is checked against the deflection found.
    pub fn cells(&self, force: f64) -> CellSettings {
        let stiffness = self.material.young * self.geometry.face_width / 80.0;
        CellSettings {
            cells: self.settings.input.contact_cells as usize,
            matching: self.settings.matching,
            force,
            window: force / stiffness,
        }
    }
}
