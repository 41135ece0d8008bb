//! The flexible gears of a scene.

use gearset::{Gear, Geometry, Mesh, MeshKind, MeshMember, assembly};
use scene::{FeContactInput, Scene};

use crate::body::GearBody;
use crate::contact::{CellSettings, Matching};
use crate::error::FeError;
use crate::fe_mesh::{Elements, FeGearMesh, Outline};
use crate::material::Elastic;

/// Settings of a run, derived from the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeSettings {
    /// Choices of the scene.
    pub input: FeContactInput,
    /// Where half-plane and FE are matched.
    pub matching: Matching,
}

/// Default matching depth in base pitches, if the elements are small enough for it.
const DEPTH_IN_BASE_PITCHES: f64 = 0.07;

/// Least matching depth of the default in flank elements, unless the scene names another, and of any setting: nearer to
/// the load the FE field depends on the elements. The check `fe.convergence.depth` shows that results do not depend on
/// the depth in the allowed range. On six and ten elements amplitudes are 0.8 % too small with 0.85.
const DEPTH_IN_ELEMENTS: [f64; 2] = [0.85, 0.7];

/// Greatest depth of a matching point in tooth thicknesses at mid-flank: beyond the middle of the
/// tooth the half-plane does not represent it.
const DEEPEST_IN_THICKNESSES: f64 = 0.5;

/// Greatest depth of a matching point as a fraction of the length within the tooth of the normal at
/// its tip corner.
const WITHIN_TIP: f64 = 0.9;

/// Matching depth and number of points; refuses a depth outside the range in which results do not
/// depend on it.
pub(super) fn matching<'o>(
    input: &FeContactInput,
    base_pitch: f64,
    outlines: impl Iterator<Item = &'o Outline>,
) -> Result<Matching, FeError> {
    let (mut element, mut thickness, mut at_tip) = (0.0f64, f64::INFINITY, f64::INFINITY);
    for outline in outlines {
        let length = outline.flank_length();
        element = element.max(length / f64::from(input.elements_on_flank()));
        thickness = thickness.min(2.0 * outline.flank_point(0.5 * length)[1]);
        at_tip = at_tip.min(outline.depth_at_tip());
    }
    let in_elements = input.matching_depth_elements.unwrap_or(DEPTH_IN_ELEMENTS[0]);
    let default = (DEPTH_IN_BASE_PITCHES * base_pitch).max(in_elements * element);
    let points = input.matching_points as usize;
    // The deepest point must stay in the tooth even below its tip corner.
    let deepest = (DEEPEST_IN_THICKNESSES * thickness).min(WITHIN_TIP * at_tip);
    let (low, high) = (DEPTH_IN_ELEMENTS[1] * element, deepest / points.max(1) as f64);
    let depth = input.matching_depth_m.unwrap_or(default.min(high));
    if low > high && input.matching_depth_m.is_none() {
        return Err(FeError::Unfit {
            key: "fe_contact.flank_elements".into(),
            value: input.flank_elements.to_string(),
            allowed: "more elements along the flank".into(),
            why: format!(
                "elements of this size resolve the load below {:.4} mm only, where a tooth this thin is no half-plane \
                 any more (above {:.4} mm): no matching depth suits both",
                low * 1e3,
                high * 1e3
            ),
        });
    }
    if depth < low && input.matching_depth_m.is_none() {
        return Err(FeError::Unfit {
            key: "fe_contact.matching_depth_elements".into(),
            value: format!("{in_elements}"),
            allowed: format!("{} and more", DEPTH_IN_ELEMENTS[1]),
            why: "nearer to the load the elements do not resolve it".into(),
        });
    }
    if depth < low || depth > high {
        return Err(FeError::Unfit {
            key: "fe_contact.matching_depth_mm".into(),
            value: format!("{:.4}", depth * 1e3),
            allowed: format!("{:.4} to {:.4}", low * 1e3, high * 1e3),
            why: "the elements do not resolve the load above it, nor is the tooth a half-plane \
                  below it; more `fe_contact.flank_elements` lower the first limit"
                .into(),
        });
    }
    Ok(Matching { depth, points })
}

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

/// Keys that no bodies can be right with a fault of.
const KEYS: [&str; 5] = [
    "planets.count",
    "material",
    "fe_contact.flank_elements",
    "fe_contact.contact_cells",
    "fe_contact.matching_points",
];

/// Refuses planets whose tip circles overlap.
fn planets_apart(scene: &Scene, geometry: &Geometry) -> Result<(), FeError> {
    let (psi, tip) = (&scene.planets.psi_rad, geometry.planet.tip_radius);
    let clearances = assembly::planet_clearances(psi, geometry.center_distance, tip);
    match clearances.into_iter().find(|(_, _, clearance)| clearance.is_nan() || *clearance <= 0.0) {
        None => Ok(()),
        Some((p, q, _)) => Err(FeError::Unfit {
            key: "planets.positions_deg".into(),
            value: format!("{psi:?} rad"),
            allowed: "planets whose tip circles stay clear of each other".into(),
            why: format!("planets {p} and {q} overlap"),
        }),
    }
}

impl Bodies {
    /// Meshes the gears a scene needs and solves for their flexibility: all of a set, two of a pair.
    ///
    /// # Errors
    /// If the scene has no tooth geometry or has a fault ([`Scene::check_keys`]), a gear cannot be meshed or solved, or
    /// the bodies would need more than [`super::MOST_BYTES`] of memory.
    pub fn new(scene: &Scene) -> Result<Self, FeError> {
        super::estimate::within_memory(scene)?;
        Self::of_any_size(scene)
    }

    /// As [`Bodies::new`], however much memory they need.
    ///
    /// # Errors
    /// Those of [`Bodies::new`], but for memory.
    pub fn of_any_size(scene: &Scene) -> Result<Self, FeError> {
        super::estimate::estimate(scene)?;
        let geometry = geometry(scene)?;
        scene.check_keys(&KEYS)?;
        planets_apart(scene, &geometry)?;
        let input = scene.fe_contact;
        let material = Elastic::new(&scene.material, input.plane);
        let make = |name: &'static str, gear: &Gear| -> Result<GearBody, FeError> {
            let elements = Elements::of(&input, input.flank_elements as usize);
            let mesh = FeGearMesh::new(name, gear, elements)?;
            GearBody::new(mesh, material, geometry.face_width)
        };
        let [ring_gear, sun_gear] = wanted(scene, &geometry);
        // One after the other, so that only one is being solved at a time.
        let ring = ring_gear.map(|g| make("ring", g)).transpose()?;
        let sun = sun_gear.map(|g| make("sun", g)).transpose()?;
        let planet = make("planet", &geometry.planet)?;
        let all = [sun.as_ref(), Some(&planet), ring.as_ref()];
        let outlines = all.into_iter().flatten().map(|body| &body.mesh.outline);
        let matching = matching(&input, geometry.base_pitch, outlines)?;
        let settings = FeSettings { input, matching };
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

    /// A mesh with both its bodies, driver first.
    ///
    /// # Errors
    /// If the scene has no such mesh.
    pub fn joined(&self, kind: MeshKind) -> Result<(&Mesh, [&GearBody; 2]), FeError> {
        let found = self.geometry.mesh(kind).zip(self.pair(kind));
        found.ok_or_else(|| missing_mesh(kind))
    }

    /// Both bodies of a mesh, driver first.
    pub fn pair(&self, kind: MeshKind) -> Option<[&GearBody; 2]> {
        Some([self.body(kind, MeshMember::Driver)?, self.body(kind, MeshMember::Driven)?])
    }

    /// Factor on the FE part of a mesh's flexibility.
    pub fn flexibility_factor(&self, kind: MeshKind) -> f64 {
        self.settings.input.flexibility_factor.of(kind)
    }

    /// Cells at rest for meshes that carry up to `force` (N), in the layout of the scene
    /// (`fe_contact.cell_layout_at_rest`).
    ///
    /// The window for corner contact is the deflection of a mesh (E b/80) six times softer than one
    /// pair of steel teeth usually is (E b/13), so that no corner that could touch is left out. The
    /// smallest gap left out is compared with the deflection found.
    pub fn cells(&self, force: f64) -> CellSettings {
        let stiffness = self.material.young * self.geometry.face_width / 80.0;
        CellSettings {
            cells: self.settings.input.contact_cells as usize,
            layout: self.settings.input.cell_layout_at_rest,
            matching: self.settings.matching,
            force,
            window: force / stiffness,
            flexibility_factor: self.settings.input.flexibility_factor,
        }
    }

    /// The same in time, where forces and their slopes are asked and no pressures (`fe_contact.cell_layout`).
    pub fn cells_in_time(&self, force: f64) -> CellSettings {
        CellSettings { layout: self.settings.input.cell_layout, ..self.cells(force) }
    }
}

/// Tooth geometry of a scene.
pub(super) fn geometry(scene: &Scene) -> Result<Geometry, FeError> {
    let why = "teeth are needed to mesh and to touch";
    let missing = FeError::Missing { key: "geometry".into(), why };
    scene.tooth_geometry().ok().ok_or(missing)
}

/// Ring and sun, if the scene needs them: both of a set, one of a pair.
pub(super) fn wanted<'g>(scene: &Scene, geometry: &'g Geometry) -> [Option<&'g Gear>; 2] {
    let is_wanted = |kind: MeshKind| scene.pair.is_none_or(|pair| pair == kind);
    [
        geometry.ring.as_ref().filter(|_| is_wanted(MeshKind::RingPlanet)),
        geometry.sun.as_ref().filter(|_| is_wanted(MeshKind::SunPlanet)),
    ]
}

/// Key of the factors on the FE part of the meshes' flexibility.
pub(crate) const FLEXIBILITY_FACTOR: &str = "fe_contact.flexibility_factor";

/// Refuses factors that are not positive and finite: scenes can be built in memory, without the
/// checks of the parser.
pub(super) fn fit(input: &FeContactInput) -> Result<(), FeError> {
    for kind in [MeshKind::SunPlanet, MeshKind::RingPlanet] {
        let factor = input.flexibility_factor.of(kind);
        if !(factor > 0.0 && factor.is_finite()) {
            return Err(FeError::Unfit {
                key: format!("{FLEXIBILITY_FACTOR}.{}", kind.name()),
                value: format!("{factor}"),
                allowed: "a finite number above 0".into(),
                why: "teeth give way under load, and not without end".into(),
            });
        }
    }
    Ok(())
}

/// The error for a mesh that the scene does not have.
pub(crate) fn missing_mesh(kind: MeshKind) -> FeError {
    let key = match kind {
        MeshKind::SunPlanet => "geometry.sun",
        MeshKind::RingPlanet => "geometry.ring",
    };
    FeError::Missing { key: key.into(), why: "its mesh with the planet is asked for" }
}
