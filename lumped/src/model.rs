//! Assembly of the model from a scene.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DMatrix, DVector};

use gearset::{Axis, Body};
use scene::{Freedom, Scene, Support, Torsional};

use crate::coordinates::Coordinates;
use crate::error::LumpedError;
use crate::springs::{Rows, Spring, SpringId};

/// The Lin–Parker model, or that of a gear pair (six coordinates at most): a diagonal mass matrix and a list of springs
/// on the free coordinates.
///
/// ```
/// use scene::{Scene, SceneKind, template};
/// use lumped::LumpedModel;
///
/// let set = Scene::from_toml(template(SceneKind::Planetary)).unwrap();
/// let model = LumpedModel::from_scene(&set).unwrap();
/// let k = model.stiffness();
/// assert_eq!(k.nrows(), model.mass.len());
/// assert!((&k - k.transpose()).norm() < 1e-12 * k.norm());
/// ```
#[derive(Debug, Clone)]
pub struct LumpedModel {
    /// ψ_n, rad.
    pub psi: Vec<f64>,
    /// Free coordinates.
    pub coordinates: Coordinates,
    /// Diagonal of M, kg (mass, mass, I/r² of each body).
    pub mass: Vec<f64>,
    /// Springs; public so that studies can change single stiffnesses.
    pub springs: Vec<Spring>,
}

/// Keys that no model can be right with a fault of.
const KEYS: [&str; 3] = ["planets.count", "lumped.mass_kg", "lumped.inertia_over_r2_kg"];

impl LumpedModel {
    /// Builds the model of a scene.
    ///
    /// # Errors
    /// If the scene lacks lumped parameters that a free coordinate needs, or has a fault in one
    /// that the model cannot do without ([`Scene::check_keys`]).
    pub fn from_scene(scene: &Scene) -> Result<Self, LumpedError> {
        let lumped = scene.lumped.as_ref().ok_or(LumpedError::NoParameters)?;
        let supports = &scene.supports;
        let psi = scene.planets.psi_rad.clone();
        let count = psi.len();
        if let Some(o) = scene.overrides.iter().find(|o| o.planet >= count) {
            return Err(LumpedError::NoSuchPlanet { planet: o.planet, count });
        }
        // A mirrored set has negative angles.
        let angles = lumped.pressure_angle_rad;
        let angles = [("sun_planet", angles.sun_planet), ("ring_planet", angles.ring_planet)];
        if let Some((mesh, value)) =
            angles.into_iter().find(|(_, a)| a.is_nan() || a.abs() >= FRAC_PI_2)
        {
            return Err(LumpedError::PressureAngle { mesh, value });
        }
        let special = |n: usize| scene.overrides.iter().find(|o| o.planet == n);
        let coordinates = Coordinates::new(count, |body, axis| {
            let motion = support(scene, body).map_or(Freedom::Free, |s| s.motion);
            if axis == Axis::Rotation { motion.rotates() } else { motion.translates() }
        });
        // Added to every planet, also to one with a mass of its own.
        let piece = supports.planet_added;
        let added = |axis: Axis| match (axis, lumped.radius_m.planet) {
            (Axis::First | Axis::Second, _) => Ok(piece.mass_kg),
            _ if piece.inertia_kg_m2 == 0.0 => Ok(0.0),
            (Axis::Rotation, Some(r)) => Ok(piece.inertia_kg_m2 / (r * r)),
            (Axis::Rotation, None) => Err(LumpedError::NoRadius { body: Body::Planet(0) }),
        };
        let inertia = |&(body, axis): &(Body, Axis)| {
            let special = match body {
                Body::Planet(n) => special(n),
                _ => None,
            };
            let (table, own, common) = match axis {
                Axis::Rotation => (
                    "inertia_over_r2_kg",
                    special.and_then(|o| o.inertia_over_r2_kg),
                    lumped.inertia_over_r2_kg.of(body),
                ),
                _ => ("mass_kg", special.and_then(|o| o.mass_kg), lumped.mass_kg.of(body)),
            };
            let bare = own.or(common).ok_or(LumpedError::NoInertia { table, body })?;
            let value = bare + if matches!(body, Body::Planet(_)) { added(axis)? } else { 0.0 };
            // A scene built in memory has not passed the reader's checks.
            match value > 0.0 && value.is_finite() {
                true => Ok(value),
                false => Err(LumpedError::Inertia { table, body, value }),
            }
        };
        let mass =
            coordinates.free().iter().map(inertia).collect::<Result<Vec<f64>, LumpedError>>()?;
        let rows = Rows { coordinates: &coordinates };
        let mut springs = Vec::with_capacity(3 * count + 6);
        for body in [Body::Carrier, Body::Ring, Body::Sun, Body::Planet(0)] {
            let Some(support) = support(scene, body) else { continue };
            if support.motion.translates() && support.bearing_n_per_m != 0.0 {
                let rows = rows.central_bearing(body);
                let id = SpringId::CentralBearing(body);
                springs.push(Spring { id, stiffness: support.bearing_n_per_m, rows });
            }
            if support.motion.rotates() {
                let stiffness = torsional(&support, lumped.radius_m.of(body), body)?;
                if stiffness != 0.0 {
                    let id = SpringId::Torsional(body);
                    springs.push(Spring { id, stiffness, rows: rows.torsion(body) });
                }
            }
        }
        for (n, &psi) in psi.iter().enumerate() {
            let (o, angle) = (special(n), &lumped.pressure_angle_rad);
            let own = |value: Option<f64>, common: f64| value.unwrap_or(common);
            springs.push(Spring {
                id: SpringId::SunMesh(n),
                stiffness: own(o.and_then(|o| o.sun_mesh_n_per_m), lumped.mesh_n_per_m.sun_planet),
                rows: vec![rows.sun_mesh(n, psi, angle.sun_planet)],
            });
            if supports.pair.is_some() {
                continue; // One mesh alone, whose gears have bearings of their own.
            }
            springs.push(Spring {
                id: SpringId::RingMesh(n),
                stiffness: own(
                    o.and_then(|o| o.ring_mesh_n_per_m),
                    lumped.mesh_n_per_m.ring_planet,
                ),
                rows: vec![rows.ring_mesh(n, psi, angle.ring_planet)],
            });
            springs.push(Spring {
                id: SpringId::PlanetBearing(n),
                stiffness: own(o.and_then(|o| o.bearing_n_per_m), supports.planet_bearing_n_per_m),
                rows: rows.planet_bearing(n, psi),
            });
        }
        // A scene built in memory has not passed the reader's checks.
        match springs.iter().find(|s| !(s.stiffness >= 0.0 && s.stiffness.is_finite())) {
            Some(Spring { id, stiffness, .. }) => {
                Err(LumpedError::Stiffness { spring: *id, value: *stiffness })
            }
            None => {
                scene.check_keys(&KEYS)?;
                Ok(Self { psi, coordinates, mass, springs })
            }
        }
    }

    /// The mass matrix M on the same coordinates as [`Self::stiffness`], n×n, kg.
    pub fn mass_matrix(&self) -> DMatrix<f64> {
        DMatrix::from_diagonal(&DVector::from_column_slice(&self.mass))
    }

    /// `[eq:lumped-matrices]` K = Σ k b bᵀ over the rows b of all springs, n×n, N/m; the mass matrix is diagonal, (m,
    /// m, I/r²) of each body.
    ///
    /// Source: Lin & Parker (1999), J. Vib. Acoust. 121, 316–321.
    /// Checked by: `lumped/tests/hand_matrices.rs::stiffness_matrix_of_one_planet_at_zero`, `lin_parker_1999`,
    /// `table2.lumped`, `table3.lumped`.
    pub fn stiffness(&self) -> DMatrix<f64> {
        let n = self.coordinates.count();
        let mut matrix = DMatrix::zeros(n, n);
        for spring in &self.springs {
            for row in &spring.rows {
                for &(i, bi) in row {
                    for &(j, bj) in row {
                        matrix[(i, j)] += spring.stiffness * bi * bj;
                    }
                }
            }
        }
        matrix
    }
}

fn support(scene: &Scene, body: Body) -> Option<Support> {
    match body {
        Body::Carrier => Some(scene.supports.carrier),
        Body::Ring => Some(scene.supports.ring),
        Body::Sun => Some(scene.supports.sun),
        // A planet of a set has a bearing on the carrier only.
        Body::Planet(_) => scene.supports.pair.map(|pair| pair.planet),
    }
}

/// Torsional stiffness per u: k_θ / r².
fn torsional(support: &Support, radius: Option<f64>, body: Body) -> Result<f64, LumpedError> {
    match (support.torsional, radius) {
        (Torsional::PerLength(k), _) => Ok(k),
        (Torsional::PerAngle(0.0), _) => Ok(0.0),
        (Torsional::PerAngle(k), Some(r)) => Ok(k / (r * r)),
        (Torsional::PerAngle(_), None) => Err(LumpedError::NoRadius { body }),
    }
}
