//! Rough estimates of a set's masses, stiffnesses and deflections, by which slips of unit are found.

use std::f64::consts::PI;

use gearset::{Geometry, Member, Mesh};

use crate::load::case::LoadCase;
use crate::scene::{Freedom, PerBody, PerMesh, Scene, SceneKind, Support, Torsional};

/// One pair of steel teeth in mesh has about E b/13: 14 N/(mm µm) for steel, as in ISO 6336-1.
pub(crate) const PAIR_STIFFNESS_DIVISOR: f64 = 13.0;

/// An annulus that stands for a body.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Disc {
    pub(crate) inner: f64,
    pub(crate) outer: f64,
    /// Outermost radius of the body, tips and rim included, m.
    pub(crate) outermost: f64,
    /// kg.
    pub(crate) mass: f64,
}

impl Disc {
    /// Polar inertia ½ m (r_i² + r_o²), kg m².
    pub(crate) fn inertia(&self) -> f64 {
        0.5 * self.mass * (self.inner.powi(2) + self.outer.powi(2))
    }
}

/// Names of the bodies in the order of [`discs`].
pub(crate) const BODIES: [&str; 4] = ["sun", "planet", "ring", "carrier"];

/// Discs of sun, planet, ring and carrier, with half of each tooth height filled; `None` where the scene does not
/// give both circles.
pub(crate) fn discs(scene: &Scene) -> [Option<Disc>; 4] {
    let Some(geometry) = &scene.geometry else { return [None; 4] };
    let per_area = scene.material.density_kg_per_m3 * geometry.face_width_m;
    let disc = |inner: f64, outer: f64, outermost: f64| Disc {
        inner,
        outer,
        outermost,
        mass: PI * (outer * outer - inner * inner) * per_area,
    };
    let gear = |gear: &gearset::GearInput| {
        let (middle, body) = (0.5 * (gear.tip_radius_m + gear.root_radius_m), gear.body_radius_m?);
        let (inner, outer) = (middle.min(body), middle.max(body));
        Some(disc(inner, outer, gear.tip_radius_m.max(body)))
    };
    let carrier =
        geometry.carrier.map(|c| disc(c.bore_radius_m, c.outer_radius_m, c.outer_radius_m));
    [
        geometry.sun.as_ref().and_then(gear),
        gear(&geometry.planet),
        geometry.ring.as_ref().and_then(gear),
        carrier,
    ]
}

/// Stiffness of one mesh, N/m: as given, or E b/13.
pub(crate) fn mesh_stiffness(scene: &Scene) -> Option<f64> {
    let softer = |mesh: &PerMesh| match scene.kind {
        SceneKind::Planetary => mesh.sun_planet.min(mesh.ring_planet),
        SceneKind::GearPair => mesh.sun_planet,
    };
    let given = scene.lumped.as_ref().map(|l| softer(&l.mesh_n_per_m));
    given.or_else(|| pair_stiffness(scene))
}

/// Mean stiffness of one mesh from face width and modulus, N/m: E b/13.
pub(crate) fn pair_stiffness(scene: &Scene) -> Option<f64> {
    let width = scene.geometry.as_ref()?.face_width_m;
    Some(scene.material.young_modulus_pa * width / PAIR_STIFFNESS_DIVISOR)
}

/// Estimate of the mean stiffness of a mesh, N/m: that of one pair, E b/13, times 0.75 ε + 0.25 with the contact
/// ratio ε (ISO 6336-1, c_γ from c').
pub fn estimated_mesh_stiffness(scene: &Scene, mesh: &Mesh) -> Option<f64> {
    Some(pair_stiffness(scene)? * (0.75 * mesh.contact_ratio + 0.25))
}

/// Estimates of masses (kg) and polar inertias (kg m²) of the bodies from annuli with half of each tooth height filled;
/// `None` where the scene does not give both circles of a body.
pub fn estimated_inertias(scene: &Scene) -> (PerBody, PerBody) {
    let [sun, planet, ring, carrier] = discs(scene);
    let of = |read: fn(&Disc) -> f64| PerBody {
        carrier: carrier.as_ref().map(read),
        ring: ring.as_ref().map(read),
        sun: sun.as_ref().map(read),
        planet: planet.as_ref().map(read),
    };
    (of(|disc| disc.mass), of(Disc::inertia))
}

/// Mean force of one mesh at the operating point, N: |T_s|/(r_b N).
pub(crate) fn mesh_force(scene: &Scene, geometry: &Geometry) -> Option<f64> {
    let radius = geometry.sun.as_ref()?.base_radius;
    let torque = LoadCase::of_scene(scene).ok()?.sun_load_nm();
    Some(torque / radius / scene.planets.count() as f64)
}

/// How far the teeth give way at the operating point, m: both meshes, the planet bearing and the torsional
/// supports of the members that react in series; of a pair, its mesh. `None` without a torque, or where it has no
/// path through the meshes.
pub(crate) fn deflection(scene: &Scene, geometry: &Geometry) -> Option<f64> {
    way_under(scene, geometry, mesh_force(scene, geometry)?)
}

/// The same under a mean force of one mesh, N, whatever the scene's torque; `None` of a set without a ring.
pub(crate) fn way_under(scene: &Scene, geometry: &Geometry, force: f64) -> Option<f64> {
    if scene.kind == SceneKind::GearPair {
        return Some(force / pair_stiffness(scene)?);
    }
    let loaded = scene.loaded_member().ok()?;
    let planets = scene.planets.count() as f64;
    // A pin carries the forces of both meshes.
    let mut length =
        2.0 * force / pair_stiffness(scene)? + 2.0 * force / scene.supports.planet_bearing_n_per_m;
    let (sun, ring) = (geometry.sun.as_ref()?.base_radius, geometry.ring.as_ref()?.base_radius);
    let supports = &scene.supports;
    let members = [
        (Member::Ring, supports.ring, ring, planets * force),
        (Member::Carrier, supports.carrier, geometry.center_distance, 2.0 * planets * force),
        (Member::Sun, supports.sun, sun, planets * force),
    ];
    for (member, support, radius, load) in members {
        if member != loaded && support.motion == Freedom::Free {
            length += load / per_length(&support, radius);
        }
    }
    Some(length)
}

/// Torsional stiffness per u = r θ, N/m.
pub(crate) fn per_length(support: &Support, radius: f64) -> f64 {
    match support.torsional {
        Torsional::PerLength(k) => k,
        Torsional::PerAngle(k) => k / (radius * radius),
    }
}

/// Operating module, m, of the mesh the scene has.
pub(crate) fn module(geometry: &Geometry) -> Option<f64> {
    let mesh = geometry.sun_planet.as_ref().or(geometry.ring_planet.as_ref());
    mesh.map(|mesh| mesh.operating_module)
}

/// About the highest natural frequency of the rigid bodies on their meshes and bearings, rad/s: of the body that is
/// stiffest for its inertia, all others held.
pub(crate) fn highest_frequency(scene: &Scene) -> Option<f64> {
    let mesh = mesh_stiffness(scene)?;
    let planets = scene.planets.count() as f64;
    let discs = discs(scene);
    let lumped = scene.lumped.as_ref();
    let mass = |given: Option<f64>, i: usize| given.or(discs[i].map(|d| d.mass));
    let sun = mass(lumped.and_then(|l| l.mass_kg.sun), 0).map(|m| (planets * mesh, m));
    let planet = mass(lumped.and_then(|l| l.mass_kg.planet), 1);
    let planet = planet.map(|m| (2.0 * mesh + scene.supports.planet_bearing_n_per_m, m));
    let squares = [sun, planet].into_iter().flatten().map(|(k, m)| k / m);
    squares.reduce(f64::max).map(f64::sqrt)
}
