//! The Lin–Parker model with parameters from the geometry of a scene, all in closed form: what FE/contact computes from
//! meshes of the bodies, at the price of the lumped model.
//!
//! Masses and inertias are those of the outlines; every mesh has the stiffness of its own phase under the operating
//! torque (`mesh.rs`, `tooth.rs`); the planet bearings stand on pin seats of an elastic carrier (`carrier.rs`); and
//! mesh forces turn with their lines of action: by the distance L = a sin α between the points where it touches both
//! base circles, a line of action turns with the displacement across it of the one centre against the other, which adds
//! −F/L of a strut pressed by F to sun meshes and +F/L to ring meshes, whose force pulls the two points together.
//!
//! Which approximations that makes, and how good they are, is on `docs/closed_forms.md`.

mod accelerated;
mod carrier;
mod cycle;
mod inertia;
mod line;
mod mesh;
mod plane;
mod stated_error;
mod tooth;
mod torsion;

use gearset::{Geometry, Mesh, MeshMember, MeshPhases, Phasing};
use nalgebra::DMatrix;
use scene::{Freedom, LoadCase, LumpedInput, PerBody, PerMesh, Scene, SceneKind};

use crate::error::LumpedError;
use crate::model::LumpedModel;
use crate::modes::NaturalModes;
use crate::springs::SpringId;
use carrier::seat_flexibility;
pub use cycle::{AnalyticCycle, AnalyticRest};
use inertia::ElasticBodies;
use line::Line;
use mesh::{MeshTangent, mesh_tangent};
use plane::Plane;
pub use stated_error::StatedError;

/// A planetary set with parameters from its geometry, linearised about the operating torque.
#[derive(Debug, Clone)]
pub struct AnalyticSet {
    /// Masses, and springs of supports, bearings and meshes; a planet bearing has the stiffness of itself and its own
    /// pin seat in series.
    pub model: LumpedModel,
    /// K with flexibility between the pin seats and mesh forces that turn, n×n, N/m.
    pub stiffness: DMatrix<f64>,
    /// ln of the factor on the stiffness of a mesh if a pair that nearly touches does, or one that hardly carries does
    /// not: sun meshes, then ring meshes; 0 where there is no such pair.
    pub hand_overs: Vec<f64>,
    /// Flexibility of the pin seats, 2N×2N, m/N: radial and tangential of each planet in turn; empty if the carrier is
    /// rigid.
    pub seats: DMatrix<f64>,
    /// Masses, I/r², radii and pressure angles of a `[lumped]` table, and of the stiffness of sun and of ring meshes
    /// the mean over the planets at this position: to first order the frequencies of modes that planets share alike
    /// are those of their own stiffnesses.
    pub parameters: LumpedInput,
    bodies: ElasticBodies,
    /// What the pin seats have of K: half of its quadratic form is their strain energy, n×n, N/m.
    seat_stiffness: DMatrix<f64>,
    /// Mean force of a mesh over the sun's base radius, N/m.
    turning: f64,
    /// Mean deflection of a mesh over the base pitch.
    slope: f64,
}

impl AnalyticSet {
    /// The set of a scene where planet 0's sun mesh is `position` mesh cycles past the start of its path.
    ///
    /// # Errors
    /// [`LumpedError::NotAnalytic`] for scenes and teeth that the closed forms do not hold for.
    pub fn new(scene: &Scene, case: &LoadCase, position: f64) -> Result<Self, LumpedError> {
        let SetParts { geometry, plane, mut parameters, mut model, seats, force, phases, .. } =
            SetParts::new(scene, case)?;
        let [sun_mesh, ring_mesh] = &geometry.meshes;
        let count = phases.sun_planet.len();
        let shift = position - phases.sun_planet[0];
        let of = |mesh: &Mesh, phases: &[f64]| -> Option<Vec<MeshTangent>> {
            let mut known: Vec<(f64, MeshTangent)> = Vec::with_capacity(count);
            let one = |phase: &f64| {
                let phase = (phase + shift).rem_euclid(1.0);
                let is_same = |(other, _): &&(f64, MeshTangent)| (other - phase).abs() < 1e-9;
                if let Some((_, own)) = known.iter().find(is_same) {
                    return Some(*own);
                }
                let own = mesh_tangent(mesh, phase, force, &plane)?;
                known.push((phase, own));
                Some(own)
            };
            phases.iter().map(one).collect()
        };
        let suns = of(sun_mesh, &phases.sun_planet).ok_or(NOT_HELD)?;
        let rings = of(ring_mesh, &phases.ring_planet).ok_or(NOT_HELD)?;
        for spring in &mut model.springs {
            match spring.id {
                SpringId::SunMesh(n) => spring.stiffness = suns[n].stiffness,
                SpringId::RingMesh(n) => spring.stiffness = rings[n].stiffness,
                _ => (),
            }
        }
        let lines: Vec<Line> = Line::of_set(&model, [sun_mesh, ring_mesh]);
        for (line, mesh) in lines.iter().zip(suns.iter().chain(&rings)) {
            line.lean(&mut model, mesh.slopes);
        }
        let mut stiffness = model.stiffness();
        let seat_stiffness =
            stand_on_seats(&mut stiffness, &model, &seats, scene.supports.planet_bearing_n_per_m)?;
        for (line, mesh) in lines.iter().zip(suns.iter().chain(&rings)) {
            line.turn(&mut stiffness, force, mesh.rolling);
        }
        let mean = |meshes: &[MeshTangent]| {
            meshes.iter().map(|mesh| mesh.stiffness).sum::<f64>() / meshes.len() as f64
        };
        parameters.mesh_n_per_m = PerMesh { sun_planet: mean(&suns), ring_planet: mean(&rings) };
        let hand_overs = suns.iter().chain(&rings).map(|mesh| mesh.hand_over).collect();
        let bodies = ElasticBodies::new(scene, &geometry.of_scene, &plane, &seats);
        let deflections = suns.iter().chain(&rings).map(|mesh| force / mesh.stiffness);
        let deflection = deflections.sum::<f64>() / (2 * count) as f64;
        Ok(Self {
            model,
            stiffness,
            hand_overs,
            seats,
            parameters,
            bodies,
            seat_stiffness,
            turning: force / sun_mesh.gear(MeshMember::Driver).base_radius,
            slope: deflection / sun_mesh.base_pitch,
        })
    }

    /// Share of the stretch of planet n's bearing and pin seat that is the seat's.
    pub fn seat_share(&self, planet: usize) -> f64 {
        let bearing = self.model.springs.iter().find(|s| s.id == SpringId::PlanetBearing(planet));
        match self.seats.is_empty() {
            true => 0.0,
            false => bearing.map_or(0.0, |b| b.stiffness * mean_seat(&self.seats, planet)),
        }
    }

    /// Natural modes, undamped and without rotation of the carrier.
    ///
    /// # Errors
    /// If the eigenproblem cannot be solved.
    pub fn modes(&self) -> Result<NaturalModes, LumpedError> {
        NaturalModes::with_stiffness(&self.model, &self.stiffness)
    }
}

/// Why teeth are none that the closed forms hold for.
const NOT_HELD: LumpedError = LumpedError::NotAnalytic(
    "a rim is thinner or thicker, or more tooth pairs are near, than the closed forms hold for",
);

/// Gears of a planetary set with both its meshes.
struct SetGeometry {
    of_scene: Geometry,
    /// Sun mesh, ring mesh.
    meshes: [Mesh; 2],
}

/// What closed forms of a set have in common, whatever its meshes do.
struct SetParts {
    geometry: SetGeometry,
    plane: Plane,
    /// Without stiffness of the meshes.
    parameters: LumpedInput,
    /// Springs without the stiffness of the meshes; a planet bearing has that of itself and its own pin seat in series.
    /// The set is mirrored if the torque on the sun is clockwise.
    model: LumpedModel,
    /// Flexibility of the pin seats, 2N×2N, m/N; empty if the carrier is rigid.
    seats: DMatrix<f64>,
    /// Torque on the sun over its base radius, N, and the part of one planet.
    load: f64,
    force: f64,
    /// Phases of the meshes with the sun's tooth 0 at angle 0, cycles.
    phases: MeshPhases,
}

impl SetParts {
    fn new(scene: &Scene, case: &LoadCase) -> Result<Self, LumpedError> {
        let none = |why: &'static str| LumpedError::NotAnalytic(why);
        if scene.kind != SceneKind::Planetary {
            return Err(none("the scene is no planetary set"));
        }
        if !scene.overrides.is_empty() {
            return Err(none("planets differ from each other"));
        }
        let PerMesh { sun_planet, ring_planet } = scene.fe_contact.flexibility_factor;
        if sun_planet != 1.0 || ring_planet != 1.0 {
            return Err(none("`fe_contact.flexibility_factor` is not 1"));
        }
        let geometry = scene.tooth_geometry().map_err(|_| none("there are no teeth"))?;
        let meshes = geometry.sun_planet.clone().zip(geometry.ring_planet.clone());
        let meshes = meshes.map(|(sun, ring)| [sun, ring]).ok_or(none("a mesh is missing"))?;
        let sun = geometry.sun.as_ref().ok_or(none("there is no sun"))?;
        let plane = Plane::new(scene, geometry.face_width);
        // Computed with counter-clockwise torque on the sun: the set is mirrored for the other.
        let mut seen = scene.clone();
        for psi in &mut seen.planets.psi_rad {
            *psi *= case.sense().sign();
        }
        let load = case.sun_load_nm() / sun.base_radius;
        let force = load / seen.planets.psi_rad.len() as f64;
        if force.is_nan() || force <= 0.0 {
            return Err(none("there is no torque"));
        }
        let phases = Phasing::new(&geometry, &scene.planets)
            .ok_or(none("a mesh is missing"))?
            .phases(0.0, case.sense());
        let input = scene.geometry.as_ref().and_then(|g| g.carrier).filter(|c| !c.is_rigid);
        let psi = &seen.planets.psi_rad;
        let seats = match input {
            Some(carrier) => seat_flexibility(&carrier, geometry.center_distance, psi, &plane)
                .ok_or(none("a pin seat of the carrier is too near an edge or another seat"))?,
            None => DMatrix::zeros(0, 0),
        };
        let parameters = parameters(scene, &geometry).ok_or(none("a bore or rim is missing"))?;
        seen.lumped = Some(parameters.clone());
        let mut model = LumpedModel::from_scene(&seen)?;
        for spring in &mut model.springs {
            if let (SpringId::PlanetBearing(n), false) = (spring.id, seats.is_empty()) {
                spring.stiffness = 1.0 / (1.0 / spring.stiffness + mean_seat(&seats, n));
            }
        }
        let geometry = SetGeometry { of_scene: geometry, meshes };
        Ok(Self { geometry, plane, parameters, model, seats, load, force, phases })
    }
}

/// Flexibility of planet n's seat, mean of its two directions, m/N.
fn mean_seat(seats: &DMatrix<f64>, n: usize) -> f64 {
    0.5 * (seats[(2 * n, 2 * n)] + seats[(2 * n + 1, 2 * n + 1)])
}

/// Masses and inertias of the bodies' outlines; mesh stiffnesses are set one by one.
fn parameters(scene: &Scene, geometry: &Geometry) -> Option<LumpedInput> {
    let per_area = scene.material.density_kg_per_m3 * geometry.face_width;
    let supports = &scene.supports;
    let moved = |freedom: Freedom| freedom.translates() || freedom.rotates();
    let gear = |gear: &gearset::Gear| -> Option<(f64, f64)> {
        let (area, polar) = gear.section_moments()?;
        Some((per_area * area, per_area * polar / gear.base_radius.powi(2)))
    };
    let (sun, planet) = (gear(geometry.sun.as_ref()?)?, gear(&geometry.planet)?);
    let ring_gear = geometry.ring.as_ref()?;
    let ring = if moved(supports.ring.motion) { Some(gear(ring_gear)?) } else { None };
    let carrier = match scene.geometry.as_ref()?.carrier {
        // The seats are filled with material.
        Some(c) if moved(supports.carrier.motion) => {
            let [inner, outer] = [c.bore_radius_m, c.outer_radius_m];
            let mass = per_area * std::f64::consts::PI * (outer.powi(2) - inner.powi(2));
            let polar = 0.5 * mass * (outer.powi(2) + inner.powi(2));
            Some((mass, polar / geometry.center_distance.powi(2)))
        }
        None if moved(supports.carrier.motion) => return None,
        _ => None,
    };
    let per_body = |read: fn((f64, f64)) -> f64| PerBody {
        carrier: carrier.map(read),
        ring: ring.map(read),
        sun: Some(read(sun)),
        planet: Some(read(planet)),
    };
    let (sun_mesh, ring_mesh) = (geometry.sun_planet.as_ref()?, geometry.ring_planet.as_ref()?);
    Some(LumpedInput {
        mass_kg: per_body(|(mass, _)| mass),
        inertia_over_r2_kg: per_body(|(_, inertia)| inertia),
        radius_m: PerBody {
            carrier: Some(geometry.center_distance),
            ring: Some(ring_gear.base_radius),
            sun: geometry.sun.as_ref().map(|gear| gear.base_radius),
            planet: Some(geometry.planet.base_radius),
        },
        mesh_n_per_m: PerMesh { sun_planet: 0.0, ring_planet: 0.0 },
        pressure_angle_rad: PerMesh {
            sun_planet: sun_mesh.pressure_angle,
            ring_planet: ring_mesh.pressure_angle,
        },
    })
}

/// Replaces the springs of the planet bearings by those in series with the flexibility A of all pin seats:
/// K ← K − Σ k̃ B BᵀB + BᵀJB, J = (I/k + A)⁻¹. Returns what the seats have of it, Bᵀ J A J B, N/m: half of its
/// quadratic form is their strain energy.
fn stand_on_seats(
    stiffness: &mut DMatrix<f64>,
    model: &LumpedModel,
    seats: &DMatrix<f64>,
    bearing: f64,
) -> Result<DMatrix<f64>, LumpedError> {
    let mut of_seats = DMatrix::zeros(stiffness.nrows(), stiffness.nrows());
    if seats.is_empty() || bearing == 0.0 {
        return Ok(of_seats);
    }
    let own = model.springs.iter().filter(|s| matches!(s.id, SpringId::PlanetBearing(_)));
    let own: Vec<_> = own.flat_map(|s| s.rows.iter().map(move |row| (s.stiffness, row))).collect();
    let series = DMatrix::identity(seats.nrows(), seats.nrows()) / bearing + seats;
    let joint = series
        .cholesky()
        .ok_or(LumpedError::NotAnalytic("pin seats are no stable support"))?
        .inverse();
    let yielding = &joint * seats * &joint;
    for (p, (k, row)) in own.iter().enumerate() {
        for (q, (_, other)) in own.iter().enumerate() {
            let factor = joint[(p, q)] - if p == q { *k } else { 0.0 };
            for &(i, bi) in row.iter() {
                for &(j, bj) in other.iter() {
                    stiffness[(i, j)] += factor * bi * bj;
                    of_seats[(i, j)] += yielding[(p, q)] * bi * bj;
                }
            }
        }
    }
    Ok(of_seats)
}
