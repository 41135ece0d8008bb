//! The loaded transmission error of a set in closed form: rigid bodies on bearings and pin seats, and meshes whose
//! tooth pairs touch or not.
//!
//! At every position of the mesh cycle every mesh has an approach δ_i = b_iᵀq and a force F_i(δ_i) at its own phase
//! (`mesh.rs`), which [`AnalyticCycle::equilibrium`] balances. K: bearings, pin seats and supports; G: mesh forces
//! that turn with their lines of action (`line.rs`) about the mean configuration q̄; R = −∂Ψ/∂σ: what the energy Ψ of
//! the pairs changes by as they roll on by σ = κᵀq at the same approach, since flanks lean under load; f: the torque
//! on the sun. Newton's method from q̄. In the mean configuration gears mesh at other centre distances, and elsewhere
//! on their paths ([`gearset::DisplacedMesh`]); phases count from where planet 0's sun mesh starts its path there, as
//! in FE/contact.

use std::collections::BTreeMap;

use gearset::{Axis, Body, DisplacedMesh, Displacements, Mesh, MeshKind, MeshMember};
use nalgebra::{DMatrix, DVector};
use scene::{LoadCase, Scene};

use super::line::Line;
use super::mesh::PressedMesh;
use super::plane::Plane;
use super::stated_error::{MESHES, SEATS, StatedError};
use super::{NOT_HELD, SetParts, stand_on_seats};
use crate::error::LumpedError;
use crate::model::LumpedModel;
use crate::springs::SpringId;

/// Positions over which the mean approach of a mesh is taken.
const MEAN_OVER: usize = 8;

/// Parts of a cycle in which phases are told apart.
const RESOLUTION: f64 = 1e9;

/// Most iterations for one position, and the imbalance over the load at which they end.
const MOST: usize = 40;
const BALANCED: f64 = 1e-9;

/// Why a mean configuration is none.
const NOT_MESHING: LumpedError =
    LumpedError::NotAnalytic("gears displaced by the load do not mesh");

/// A row of a matrix: coordinate and coefficient.
type Row = Vec<(usize, f64)>;

/// A set whose displacements are found position by position.
#[derive(Debug, Clone)]
pub struct AnalyticCycle {
    /// What the pin seats have of K: half of its quadratic form is their strain energy, N/m.
    of_seats: DMatrix<f64>,
    /// Largest angle by which a line of action turns from unloaded to mean configuration, rad.
    turned: f64,
    /// K + G, N/m.
    stiffness: DMatrix<f64>,
    /// f + G q̄, N.
    load: DVector<f64>,
    /// q̄, m.
    mean: DVector<f64>,
    /// b of sun meshes, then of ring meshes.
    rows: Vec<Row>,
    /// κ of the same.
    rolls: Vec<Row>,
    /// Phase of each mesh at position 0, cycles.
    offsets: Vec<f64>,
    /// Sun mesh, ring mesh.
    meshes: [Mesh; 2],
    plane: Plane,
    /// Mean force of a mesh, N.
    force: f64,
    /// Coordinate of the sun's rotation.
    sun: usize,
}

/// A set in equilibrium at one position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnalyticRest {
    /// r_b θ of the sun, m.
    pub transmission_error: f64,
    /// Σ F δ of the sun meshes and of the ring meshes, J.
    pub mesh_work: [f64; 2],
    /// The same of the pin seats.
    pub seat_work: f64,
}

impl AnalyticCycle {
    /// The set of a scene about its mean configuration under the torque.
    ///
    /// # Errors
    /// [`LumpedError::NotAnalytic`] for scenes and teeth that the closed forms do not hold for, or sets that nothing
    /// holds.
    pub fn new(scene: &Scene, case: &LoadCase) -> Result<Self, LumpedError> {
        let SetParts { geometry, plane, mut model, seats, load, force, phases, .. } =
            SetParts::new(scene, case)?;
        let meshes = geometry.meshes;
        let sun = model.coordinates.of(Body::Sun, Axis::Rotation);
        let sun = sun.ok_or(LumpedError::NotAnalytic("the sun does not turn"))?;
        let lines = Line::of_set(&model, [&meshes[0], &meshes[1]]);
        // Mean stiffness F/δ of the meshes of each kind.
        let mut approaches = [0.0; 2];
        for (mean, mesh) in approaches.iter_mut().zip(&meshes) {
            for i in 0..MEAN_OVER {
                let phase = i as f64 / MEAN_OVER as f64;
                let own = PressedMesh::new(mesh, phase, force, &plane).ok_or(NOT_HELD)?;
                *mean += own.mean_approach().ok_or(NOT_HELD)? / MEAN_OVER as f64;
            }
        }
        let mut rows: [Vec<Row>; 2] = [Vec::new(), Vec::new()];
        for spring in &mut model.springs {
            let kind = match spring.id {
                SpringId::SunMesh(_) => 0,
                SpringId::RingMesh(_) => 1,
                _ => continue,
            };
            spring.stiffness = force / approaches[kind];
            rows[kind].push(spring.rows[0].clone());
        }
        let mut f = DVector::zeros(model.coordinates.count());
        f[sun] = load;
        let unstable = || LumpedError::NotAnalytic("nothing holds the set");
        let mut stiffness = model.stiffness();
        let of_seats =
            stand_on_seats(&mut stiffness, &model, &seats, scene.supports.planet_bearing_n_per_m)?;
        let mean = stiffness.clone().cholesky().ok_or_else(unstable)?.solve(&f);
        let [suns, rings] = rows;
        let count = suns.len();
        // Without the mean springs of the meshes, and with forces that turn.
        for (kind, rows) in [&suns, &rings].into_iter().enumerate() {
            rows.iter().for_each(|row| add(&mut stiffness, -force / approaches[kind], row));
        }
        let without = stiffness.clone();
        lines.iter().for_each(|line| line.turn(&mut stiffness, force, 0.0));
        let load = f + (&stiffness - without) * &mean;
        let psi = |n: usize| case.sense().sign() * scene.planets.psi_rad[n];
        let poses = |kind: usize| -> Result<Vec<DisplacedMesh>, LumpedError> {
            let mesh = &meshes[kind];
            let one =
                |n: usize| mesh.displaced(0.0, &displacements(&model, mesh, n, psi(n), &mean));
            (0..count).map(one).collect::<Result<_, _>>().map_err(|_| NOT_MESHING)
        };
        let [suns_at, rings_at] = [poses(0)?, poses(1)?];
        let lead = phases.sun_planet[0] + suns_at[0].phase();
        let of = |poses: &[DisplacedMesh], phases: &[f64]| -> Vec<f64> {
            poses.iter().zip(phases).map(|(pose, phase)| phase + pose.phase() - lead).collect()
        };
        let mut offsets = of(&suns_at, &phases.sun_planet);
        offsets.extend(of(&rings_at, &phases.ring_planet));
        let turned = |kind: usize, pose: &DisplacedMesh| {
            let opened = pose.pressure_angle - meshes[kind].pressure_angle;
            pose.line_of_centres.abs() + opened.abs()
        };
        let suns_turned = suns_at.iter().map(|pose| turned(0, pose));
        let turned = suns_turned.chain(rings_at.iter().map(|pose| turned(1, pose)));
        let turned = turned.fold(0.0, f64::max);
        let opened = |kind: usize, poses: &[DisplacedMesh]| {
            let distance =
                poses.iter().map(|pose| pose.center_distance).sum::<f64>() / count as f64;
            meshes[kind].at_center_distance(distance).map_err(|_| NOT_MESHING)
        };
        let meshes = [opened(0, &suns_at)?, opened(1, &rings_at)?];
        let rows = suns.into_iter().chain(rings).collect();
        let rolls = lines.into_iter().map(Line::into_roll).collect();
        Ok(Self {
            of_seats,
            turned,
            stiffness,
            load,
            mean,
            rows,
            rolls,
            offsets,
            meshes,
            plane,
            force,
            sun,
        })
    }

    /// Stated errors of the mean transmission error over evenly spaced positions, shares of it that add: what the
    /// stiffness of meshes and pin seats may be off, by the work Σ F δ of their forces over that of the torque, and
    /// the lines of action of the unloaded set.
    pub fn mean_errors(&self, rest: &[AnalyticRest]) -> Vec<StatedError> {
        let sum = |of: &dyn Fn(&AnalyticRest) -> f64| rest.iter().map(of).sum::<f64>();
        let work = self.load() * sum(&|own| own.transmission_error);
        let share = |kind: usize| MESHES[kind] * sum(&|own| own.mesh_work[kind]) / work;
        let seats = SEATS * sum(&|own| own.seat_work) / work;
        vec![
            StatedError { source: "mesh stiffness in closed form", share: share(0) + share(1) },
            StatedError { source: "pin seats in closed form", share: seats },
            StatedError { source: "lines of action of the unloaded set", share: self.turned },
        ]
    }

    /// The set at some positions (cycles).
    ///
    /// # Errors
    /// As [`new`](Self::new), or if a position has no equilibrium.
    pub fn at_rest(&self, positions: &[f64]) -> Result<Vec<AnalyticRest>, LumpedError> {
        let count = self.rows.len();
        let mut known: BTreeMap<(usize, i64), PressedMesh> = BTreeMap::new();
        let mut start = self.mean.clone();
        let mut found = Vec::with_capacity(positions.len());
        for position in positions {
            let key = |i: usize| {
                let phase = (position + self.offsets[i]).rem_euclid(1.0);
                (2 * i / count, (phase * RESOLUTION).round() as i64)
            };
            let keys: Vec<(usize, i64)> = (0..count).map(key).collect();
            for key in &keys {
                if !known.contains_key(key) {
                    let phase = key.1 as f64 / RESOLUTION;
                    let own = PressedMesh::new(&self.meshes[key.0], phase, self.force, &self.plane);
                    known.insert(*key, own.ok_or(NOT_HELD)?);
                }
            }
            let meshes: Vec<&PressedMesh> = keys.iter().filter_map(|key| known.get(key)).collect();
            start = self.equilibrium(&meshes, start)?;
            let q = &start;
            let mut mesh_work = [0.0; 2];
            for (i, (mesh, row)) in meshes.iter().zip(&self.rows).enumerate() {
                let approach = row.iter().map(|(i, b)| b * q[*i]).sum();
                let [force, ..] = mesh.forces_at(approach).ok_or(NOT_HELD)?;
                mesh_work[2 * i / count] += force * approach;
            }
            found.push(AnalyticRest {
                transmission_error: q[self.sun],
                mesh_work,
                seat_work: (&self.of_seats * q).dot(q),
            });
        }
        Ok(found)
    }

    /// Torque on the sun over its base radius, N.
    pub fn load(&self) -> f64 {
        self.force * (self.rows.len() / 2) as f64
    }

    /// `[eq:loaded-transmission-error]` Displacements q of the loaded set:
    /// ```text
    /// (K + G) q + Σ [b_i F_i(b_iᵀ q) − κ_i R_i(b_iᵀ q)] = f + G q̄.
    /// ```
    ///
    /// Source: derived here.
    /// Checked by: `validation/tests/closed_forms.rs::mean_transmission_errors_hold_on_shipped_sets`,
    /// `lumped/tests/analytic.rs::a_set_of_twice_the_width_yields_as_much_under_twice_the_torque`.
    fn equilibrium(
        &self,
        meshes: &[&PressedMesh],
        mut q: DVector<f64>,
    ) -> Result<DVector<f64>, LumpedError> {
        let size = self.load.amax();
        for _ in 0..MOST {
            let mut left = &self.load - &self.stiffness * &q;
            let mut tangent = self.stiffness.clone();
            for ((mesh, row), roll) in meshes.iter().zip(&self.rows).zip(&self.rolls) {
                let approach = row.iter().map(|(i, b)| b * q[*i]).sum();
                let [force, stiffness, rolling] = mesh.forces_at(approach).ok_or(NOT_HELD)?;
                row.iter().for_each(|(i, b)| left[*i] -= b * force);
                roll.iter().for_each(|(i, along)| left[*i] += along * rolling);
                add(&mut tangent, stiffness, row);
            }
            if left.amax() < BALANCED * size {
                return Ok(q);
            }
            let step = tangent.lu().solve(&left);
            q += step.ok_or(LumpedError::NotAnalytic("a mesh lost contact"))?;
        }
        Err(LumpedError::NotAnalytic("tooth pairs find no equilibrium"))
    }
}

/// Displacements (x, y, m; θ, rad) of driver and driven in the mesh frame of planet n, which is at ψ (rad), under those
/// of the model's coordinates.
fn displacements(
    model: &LumpedModel,
    mesh: &Mesh,
    n: usize,
    psi: f64,
    q: &DVector<f64>,
) -> Displacements {
    let of = |body: Body, axis: Axis| model.coordinates.of(body, axis).map_or(0.0, |i| q[i]);
    let all = |body: Body, radius: f64| {
        let [x, y, u] = Axis::ALL.map(|axis| of(body, axis));
        [x, y, u / radius]
    };
    let (body, member, planet) = match mesh.kind {
        MeshKind::SunPlanet => (Body::Sun, MeshMember::Driver, MeshMember::Driven),
        MeshKind::RingPlanet => (Body::Ring, MeshMember::Driven, MeshMember::Driver),
    };
    let [x, y, central] = all(body, mesh.gear(member).base_radius);
    let (sin, cos) = psi.sin_cos();
    let first = [cos * x + sin * y, cos * y - sin * x, central];
    let second = all(Body::Planet(n), mesh.gear(planet).base_radius);
    let [driver, driven] = match mesh.kind {
        MeshKind::SunPlanet => [first, second],
        MeshKind::RingPlanet => [second, first],
    };
    [driver[0], driver[1], driver[2], driven[0], driven[1], driven[2]]
}

/// Adds k b bᵀ.
fn add(stiffness: &mut DMatrix<f64>, k: f64, row: &Row) {
    for (i, a) in row {
        for (j, b) in row {
            stiffness[(*i, *j)] += k * a * b;
        }
    }
}
