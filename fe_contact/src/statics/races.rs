//! The rigid races of a set: coordinates, bearings, and the approach of tooth pairs on the
//! coordinates.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use gearset::{Axis, Body, Displacements, Member, MeshKind};
use scene::{Freedom, GivenInertia, Scene, Support, Torsional};

use super::bodies::Bodies;
use crate::body::CarrierBody;
use crate::error::FeError;

/// Coordinates of the races in the carrier frame: carrier, ring and sun (x, y, u), then each planet
/// (ζ, η, u); u = r θ with the base radius, for the carrier the centre distance. Held ones are left
/// out.
#[derive(Debug, Clone)]
pub struct Races {
    /// ψ_n, rad.
    pub psi: Vec<f64>,
    /// Index of each of the 3(3 + N) coordinates.
    index: Vec<Option<usize>>,
    /// Radii r in u = r θ: carrier, ring, sun, planet, m. Of a pair whose gears both turn freely, r_b over the
    /// gear's share of the relative rotation (see [`Races::new`]).
    pub radii: [f64; 4],
    /// Centre distance, base radii of ring, sun and planet, m.
    pub base_radii: [f64; 4],
    /// Stiffness of all bearings and torsional supports, the carrier's flexibility included, n×n,
    /// N/m.
    pub stiffness: DMatrix<f64>,
    /// The flexible carrier, where the scene gives its shape; shared by all sets of a scene.
    pub carrier: Option<Arc<CarrierBody>>,
    /// Number n of free coordinates.
    pub count: usize,
    /// Elongations of the planet bearings (radial, tangential of each) on the coordinates, 2N×n, and
    /// their stiffness in series with the carrier, 2N×2N, N/m.
    seats: [DMatrix<f64>; 2],
    /// Number of planets on the carrier: all of a set, none of a pair.
    pub(crate) seated: usize,
    /// Supports to ground: carrier, ring, sun; of a pair its planet, too.
    supports: Vec<Support>,
    /// External torques under a unit torque on the sun, by body: on the member that turns without support, and on
    /// a planet of a pair that turns freely the one that balances it. The first body is the loaded one.
    torques: Vec<(Body, f64)>,
}

impl Races {
    /// Races of a set with its bearings.
    ///
    /// The gears of a pair have supports to ground, and no seats. If both turn freely, the motion without relative
    /// rotation has no stiffness; balanced torques and a force along the line of action do not excite it
    /// (m_s u_s = m_p u_p at all times, m = J/r_b²). Both rotations are then one coordinate w.
    ///
    /// `[eq:pair-rotation]` w = u_s + u_p of mass m_s m_p/(m_s + m_p), u_s = a_s w, u_p = a_p w,
    /// a_s = m_p/(m_s + m_p), a_p = m_s/(m_s + m_p).
    /// Source: derived here.
    /// Checked by: `experiments/tests/gear_pair_modes.rs::rigid_bearings_leave_the_frequency_of_the_effective_mass`,
    /// `experiments/tests/gear_pair.rs::at_a_low_speed_the_transmission_error_is_the_static_one`.
    ///
    /// # Errors
    /// If the carrier's mesh fails or a radius is not known.
    pub fn new(scene: &Scene, bodies: &Bodies, psi: &[f64]) -> Result<Self, FeError> {
        let geometry = &bodies.geometry;
        let n = psi.len();
        let base = |gear: Option<&gearset::Gear>| gear.map_or(0.0, |g| g.base_radius);
        let radii = [
            geometry.center_distance,
            base(geometry.ring.as_ref()),
            base(geometry.sun.as_ref()),
            geometry.planet.base_radius,
        ];
        let pair = scene.supports.pair;
        let mut supports = vec![scene.supports.carrier, scene.supports.ring, scene.supports.sun];
        supports.extend(pair.map(|pair| pair.planet));
        let mut next = 0;
        let mut index: Vec<Option<usize>> = Vec::with_capacity(3 * (3 + n));
        for body in Body::all(n) {
            for axis in Axis::ALL {
                let motion = supports.get(body.index()).map_or(Freedom::Free, |s| s.motion);
                let turns = axis == Axis::Rotation;
                let free = if turns { motion.rotates() } else { motion.translates() };
                if scene.is_free_pair() && body == Body::Planet(0) && turns {
                    index.push(index[3 * Body::Sun.index() + 2]);
                    continue;
                }
                index.push(free.then(|| {
                    next += 1;
                    next - 1
                }));
            }
        }
        let base_radii = radii;
        let [carrier, ring, mut r_sun, mut r_planet] = radii;
        if let (true, Some(pair), Some(sun)) = (scene.is_free_pair(), pair, &bodies.sun) {
            let over_r2 = |given: GivenInertia, inertia: f64, radius: f64| {
                given.inertia_kg_m2.unwrap_or(inertia) / (radius * radius)
            };
            let m_s = over_r2(pair.sun_inertia, sun.inertia, r_sun);
            let m_p = over_r2(pair.planet_inertia, bodies.planet.inertia, r_planet);
            r_sun *= (m_s + m_p) / m_p;
            r_planet *= (m_s + m_p) / m_s;
        }
        let radii = [carrier, ring, r_sun, r_planet];
        // T_s : T_r : T_c = r_s : r_r : −(r_s + r_r) of base radii, which are as the numbers of teeth.
        let [_, ring, sun, planet] = base_radii;
        let mut torques = vec![match scene.loaded_member() {
            Ok(Member::Ring) => (Body::Ring, ring / sun),
            Ok(Member::Carrier) => (Body::Carrier, -(sun + ring) / sun),
            // Supports under which a torque has no path are refused before, or by the equilibrium.
            Ok(Member::Sun) | Err(_) => (Body::Sun, 1.0),
        }];
        if pair.is_some_and(|pair| pair.planet.turns_freely()) {
            torques.push((Body::Planet(0), planet / sun));
        }
        let seated = if pair.is_some() { 0 } else { n };
        let shape = scene.geometry.as_ref().and_then(|g| g.carrier);
        let (a, width) = (geometry.center_distance, geometry.face_width);
        let carrier = shape
            .map(|input| CarrierBody::new(&input, a, psi, &bodies.material, width))
            .transpose()?
            .map(Arc::new);
        let mut races = Self {
            psi: psi.to_vec(),
            index,
            radii,
            base_radii,
            seated,
            supports,
            torques,
            stiffness: DMatrix::zeros(next, next),
            carrier,
            count: next,
            seats: [DMatrix::zeros(0, 0), DMatrix::zeros(0, 0)],
        };
        for body in Body::all(n).take(races.supports.len()) {
            for axis in Axis::ALL {
                if let Some(i) = races.of(body, axis) {
                    races.stiffness[(i, i)] += races.support(body, axis);
                }
            }
        }
        races.planet_bearings(scene)?;
        Ok(races)
    }

    /// Index of a coordinate, `None` if it is held.
    pub fn of(&self, body: Body, axis: Axis) -> Option<usize> {
        self.index[3 * body.index() + axis as usize]
    }

    /// Indices of a body's three coordinates, `None` where it is held.
    pub fn places(&self, body: Body) -> [Option<usize>; 3] {
        Axis::ALL.map(|axis| self.of(body, axis))
    }

    /// Adds `own` on a body's three coordinates to a list over all coordinates; what is on held ones is left out.
    pub(crate) fn add(&self, body: Body, own: [f64; 3], sum: &mut [f64]) {
        for (place, value) in self.places(body).into_iter().zip(own) {
            if let Some(i) = place {
                sum[i] += value;
            }
        }
    }

    /// Inertias of carrier, ring, sun and planets along their displacements (x, y or ζ, η: kg; θ: kg m²; 0 where held),
    /// from the masses of the coordinates (n, kg).
    pub fn inertias(&self, mass: &[f64]) -> Vec<[f64; 3]> {
        let of = |body: Body| {
            let [first, second, u] = self.places(body).map(|i| i.map_or(0.0, |i| mass[i]));
            // A coordinate of rotation is u = r θ.
            [first, second, u * self.radii[body.kind()].powi(2)]
        };
        Body::all(self.planets()).map(of).collect()
    }

    /// Displacements of one body's race from those of all, x (n, m); 0 for held coordinates.
    pub(crate) fn displaced(&self, x: &DVector<f64>, body: Body) -> [f64; 3] {
        self.places(body).map(|i| i.map_or(0.0, |i| x[i]))
    }

    /// Stiffness of a body's own support to ground on one of its coordinates, N/m; 0 for a planet on a carrier.
    pub(crate) fn support(&self, body: Body, axis: Axis) -> f64 {
        let Some(support) = self.supports.get(body.index()) else { return 0.0 };
        match axis {
            Axis::First | Axis::Second => support.bearing_n_per_m,
            Axis::Rotation => torsional(support, self.radii[body.kind()]),
        }
    }

    /// Generalised load where the torque on the sun is `torque_nm` (N m, magnitude), which acts on the loaded member in
    /// proportion, with the torque on a planet that balances it, N.
    pub(crate) fn load(&self, torque_nm: f64) -> DVector<f64> {
        let mut f = DVector::zeros(self.count);
        for (body, share) in &self.torques {
            if let Some(i) = self.of(*body, Axis::Rotation) {
                f[i] += share * torque_nm / self.radii[body.kind()];
            }
        }
        f
    }

    /// The body that the torque acts on, and its torque under a unit torque on the sun.
    pub fn loaded(&self) -> (Body, f64) {
        self.torques.first().copied().unwrap_or((Body::Sun, 1.0))
    }

    /// The error for a motion whose coordinate of this index has the displacement `value` (m) at `time_s` (s).
    #[cold]
    pub(crate) fn diverged(&self, time_s: f64, coordinate: usize, value: f64) -> FeError {
        let all = |body| Axis::ALL.into_iter().map(move |axis| (body, axis));
        let mut all = Body::all(self.planets()).flat_map(all);
        let found = all.find(|(body, axis)| self.of(*body, *axis) == Some(coordinate));
        let (body, axis) = found.unwrap_or((Body::Carrier, Axis::First));
        FeError::Diverged { time_s, body, axis, value }
    }

    /// Whether these are the two gears of a pair, which have supports to ground.
    pub fn is_pair(&self) -> bool {
        self.seated == 0
    }

    /// Number of planets.
    pub fn planets(&self) -> usize {
        self.psi.len()
    }

    /// `[eq:bearings-on-a-flexible-carrier]` (I/k + A)⁻¹: planet bearings in series with the carrier, on the
    /// elongations planet race − rigid seat, radial and tangential.
    ///
    /// Source: derived here.
    /// Checked by: `fe_contact/tests/fidelity.rs::a_ring_on_springs_and_a_rigid_carrier`,
    /// `fe_contact/tests/fidelity.rs::full_bodies_turn_as_quasi_static_ones`.
    fn planet_bearings(&mut self, scene: &Scene) -> Result<(), FeError> {
        let n = self.seated;
        let rigid = || DMatrix::zeros(2 * n, 2 * n);
        let mut compliance = self.carrier.as_ref().map_or_else(rigid, |c| c.flexibility.clone());
        for planet in 0..n {
            let k = planet_bearing(scene, planet);
            if k <= 0.0 {
                return Err(FeError::NoEquilibrium(format!(
                    "`planet.bearing_n_per_m` is {k}: planet {planet} is held by nothing else"
                )));
            }
            for axis in 0..2 {
                compliance[(2 * planet + axis, 2 * planet + axis)] += 1.0 / k;
            }
        }
        let stiffness = compliance
            .cholesky()
            .ok_or_else(|| FeError::NoEquilibrium("the carrier is not stable".into()))?
            .inverse();
        // Elongations as rows on the coordinates.
        let mut rows = DMatrix::<f64>::zeros(2 * n, self.count);
        for planet in 0..n {
            let (sin, cos) = self.psi[planet].sin_cos();
            let carrier = [[cos, sin, 0.0], [-sin, cos, 1.0]];
            for (axis, seat) in Axis::TRANSLATIONS.into_iter().zip(carrier) {
                let row = 2 * planet + axis as usize;
                if let Some(i) = self.of(Body::Planet(planet), axis) {
                    rows[(row, i)] += 1.0;
                }
                for (i, share) in self.places(Body::Carrier).into_iter().zip(seat) {
                    if let Some(i) = i {
                        rows[(row, i)] -= share;
                    }
                }
            }
        }
        self.stiffness += rows.transpose() * &stiffness * &rows;
        self.seats = [rows, stiffness];
        Ok(())
    }

    /// A pair's approach on the coordinates, from its row on driver and driven in the mesh frame
    /// of planet n.
    pub fn approach(&self, kind: MeshKind, planet: usize, row: &[f64; 6]) -> Vec<f64> {
        let mut b = vec![0.0; self.count];
        for (body, entries) in self.approach_of_bodies(kind, planet, row) {
            self.add(body, entries, &mut b);
        }
        b
    }

    /// Torque of the planet bearings on the carrier at coordinates q, N·m.
    pub(crate) fn carrier_torque(&self, q: &DVector<f64>) -> f64 {
        let [rows, stiffness] = &self.seats;
        let forces = stiffness * (rows * q);
        (0..self.seated).map(|n| forces[2 * n + 1] * self.radii[0]).sum()
    }

    /// Matrix from the races' coordinates to displacements (x, y, m; θ, rad) of driver and driven
    /// in the mesh frame of planet n, 6×n.
    pub(crate) fn mesh_matrix(&self, kind: MeshKind, planet: usize) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(6, self.count);
        for i in 0..6 {
            let mut unit = [0.0; 6];
            unit[i] = 1.0;
            let row = self.approach(kind, planet, &unit);
            row.iter().enumerate().for_each(|(j, value)| matrix[(i, j)] = *value);
        }
        matrix
    }

    /// Displacements (x, y, m; θ, rad) of driver and driven in the mesh frame of planet n at
    /// coordinates q (m). [`Races::approach`] is the transpose of this map.
    pub fn mesh_displacements(&self, kind: MeshKind, planet: usize, q: &[f64]) -> Displacements {
        let (sin, cos) = self.psi[planet].sin_cos();
        let of = |body| self.places(body).map(|i| i.map_or(0.0, |i| q[i]));
        let (central, radius) = match kind {
            MeshKind::SunPlanet => (Body::Sun, self.radii[2]),
            MeshKind::RingPlanet => (Body::Ring, self.radii[1]),
        };
        let [x, y, u] = of(central);
        let first = [cos * x + sin * y, cos * y - sin * x, u / radius];
        let [zeta, eta, v] = of(Body::Planet(planet));
        let second = [zeta, eta, v / self.radii[3]];
        let [driver, driven] = match kind {
            MeshKind::SunPlanet => [first, second],
            MeshKind::RingPlanet => [second, first],
        };
        [driver[0], driver[1], driver[2], driven[0], driven[1], driven[2]]
    }

    /// A pair's approach as in [`Races::approach`], body by body: the central gear, then the
    /// planet, on (x, y, u) of each.
    pub fn approach_of_bodies(
        &self,
        kind: MeshKind,
        planet: usize,
        row: &[f64; 6],
    ) -> [(Body, [f64; 3]); 2] {
        let (sin, cos) = self.psi[planet].sin_cos();
        let [first, second] = [[row[0], row[1], row[2]], [row[3], row[4], row[5]]];
        let (central, central_row, planet_row, radius) = match kind {
            MeshKind::SunPlanet => (Body::Sun, first, second, self.radii[2]),
            MeshKind::RingPlanet => (Body::Ring, second, first, self.radii[1]),
        };
        // The mesh frame is turned by ψ_n from the carrier frame; its axes are the planet's ζ and
        // η.
        let [p, q, arm] = central_row;
        let turned = [cos * p - sin * q, sin * p + cos * q, arm / radius];
        let own = [planet_row[0], planet_row[1], planet_row[2] / self.radii[3]];
        [(central, turned), (Body::Planet(planet), own)]
    }
}

/// Stiffness of one planet's bearing, N/m.
pub(crate) fn planet_bearing(scene: &Scene, planet: usize) -> f64 {
    let special = scene.overrides.iter().find(|o| o.planet == planet);
    special.and_then(|o| o.bearing_n_per_m).unwrap_or(scene.supports.planet_bearing_n_per_m)
}

fn torsional(support: &Support, radius: f64) -> f64 {
    match support.torsional {
        Torsional::PerLength(k) => k,
        // k_θ / r²
        Torsional::PerAngle(k) if radius > 0.0 => k / (radius * radius),
        Torsional::PerAngle(_) => 0.0,
    }
}
