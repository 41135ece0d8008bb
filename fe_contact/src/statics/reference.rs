//! The configuration a set is linearised about: the mean one under the torque at hand.
//!
//! Under load the bearings deflect about twenty times as much as the teeth (windup). Its effect on
//! a mesh is computed by exact kinematics ([`gearset::DisplacedMesh`]): approach δ, roll length σ
//! and centre distance a' of every mesh are those of the displaced gears, and the contact tables
//! are laid out for them. Only displacements about this configuration, as they occur within a mesh
//! cycle, enter linearly ([`ReferenceConfiguration`]).

use gearset::{DisplacedMesh, Displacements, Mesh, MeshGradients, MeshKind};
use nalgebra::{DMatrix, DVector};

use super::bodies::{Bodies, missing_mesh};
use super::imperfection::Imperfections;
use super::mesh_rows::mirrored;
use super::nominal_mesh::NominalMesh;
use super::races::Races;

use crate::error::FeError;
use crate::short_row::ShortRow;

/// Meshes of a kind share tables if the load has changed their phases by amounts that differ by
/// less than the first value (cycles), and their centre distances differ by less than the second
/// (m). The differences are accounted for to first order, with an error quadratic in them: a hundred times as far apart
/// (a thousandth of a cycle) it makes up to 2e-4 of a harmonic on a set of which no two planets carry the same load.
/// Planets of evenly spaced and opposed sets are nearer than this.
const SHARED: [f64; 2] = [1e-5, 5e-8];

/// A mesh at the mean loaded centre distance of all meshes that share its tables.
#[derive(Debug, Clone)]
pub(crate) struct LoadedMesh {
    pub(crate) mesh: Mesh,
    /// Mean change of these meshes' phases by the load, cycles.
    pub(crate) shift: f64,
    /// Gradients of δ, σ and a' in the displaced frame, whose x axis is the line of centres.
    pub(crate) gradients: MeshGradients,
}

/// One mesh at the reference.
#[derive(Debug, Clone)]
pub(crate) struct MeshPose {
    pub(crate) kind: MeshKind,
    pub(crate) planet: usize,
    /// Index in [`ReferenceConfiguration::loaded`].
    pub(crate) group: usize,
    /// Direction λ of the line of centres from the nominal one, rad.
    pub(crate) direction: f64,
    /// δ, σ and a' less those of the group's tables, m.
    pub(crate) at: [f64; 3],
    /// ∂δ, ∂σ, ∂a' on the races' coordinates.
    pub(crate) gradients: [DVector<f64>; 3],
}

/// Backside flanks of one mesh at the reference, mirrored at its line of centres.
#[derive(Debug, Clone)]
pub(crate) struct BacksidePose {
    pub(crate) mesh: Mesh,
    /// Change of the phase of the mirrored mesh by the load, cycles.
    pub(crate) shift: f64,
    /// λ of the mirrored mesh, rad.
    pub(crate) direction: f64,
    pub(crate) gradients: MeshGradients,
    /// δ less the backlash, m.
    pub(crate) approach: f64,
    /// ∂δ on the races' coordinates.
    pub(crate) row: ShortRow,
    /// Product of the row with the displacements from which on the flanks touch, m.
    met_at: f64,
}

impl BacksidePose {
    /// Whether the flanks touch with the races at q (m).
    pub(crate) fn is_met(&self, q: &[f64]) -> bool {
        self.row.dot(q) >= self.met_at
    }
}

/// The configuration about which a set is linearised.
///
/// `[eq:loaded-linearisation]` With the pair's own derivatives A_k (1, 0, 0 on the path) and the slope κ of the
/// deformed flanks (`eq:flank-slopes`):
/// ```text
/// approach of pair k = A_k·(δ, σ, a') at the reference + b_kᵀ (q − q_ref),
/// b_k = A_δ ∂δ + (A_σ − κ_σ) ∂σ + (A_a − κ_a) ∂a';
/// the turning of the mean mesh forces F̄ with their lines of action adds the stiffness Σ F̄ ∂²δ.
/// ```
/// Source: derived here.
/// Checked by: `fe.kinematics.turned`, `fe.kinematics.exact`.
#[derive(Debug, Clone)]
pub struct ReferenceConfiguration {
    /// Torque on the sun (magnitude) under which it is the mean configuration, N·m.
    pub torque_nm: f64,
    /// Displacements of the races, n, m.
    pub q: DVector<f64>,
    /// Sun meshes, then ring meshes.
    pub(crate) meshes: Vec<MeshPose>,
    pub(crate) backside: Vec<BacksidePose>,
    pub(crate) loaded: Vec<LoadedMesh>,
    /// Σ F̄ ∂²δ, n×n, N/m.
    pub(crate) stiffness: DMatrix<f64>,
}

/// Everything that a reference is computed from.
pub(super) struct ReferenceInputs<'g> {
    pub(super) bodies: &'g Bodies,
    pub(super) races: &'g Races,
    pub(super) nominal: &'g [NominalMesh],
    pub(super) imperfections: &'g Imperfections,
}

impl ReferenceInputs<'_> {
    /// Pose and displacements of a mesh with the races at q (m), from phase 0 of the unloaded mesh;
    /// mirrored at the line of centres with `sign` −1.
    pub(super) fn displaced(
        &self,
        of: &NominalMesh,
        q: &DVector<f64>,
        sign: f64,
    ) -> Result<(DisplacedMesh, Displacements), FeError> {
        let (mesh, _) = self.bodies.joined(of.kind)?;
        let mut x = self.races.mesh_displacements(of.kind, of.planet, q.as_slice());
        self.imperfections.displace(of.kind, of.planet, &mut x);
        if sign < 0.0 {
            x = mirrored(&x);
        }
        let found = mesh.displaced(0.0, &x).map_err(|cause| {
            FeError::NoEquilibrium(format!(
                "planet {} is displaced until its gears no longer mesh: {cause}",
                of.planet
            ))
        })?;
        Ok((found, x))
    }
}

impl ReferenceConfiguration {
    /// Reference at displacements q (m) of the races; `forces` (N) are the mean forces of the
    /// meshes.
    pub(super) fn new(
        inputs: &ReferenceInputs<'_>,
        torque_nm: f64,
        q: DVector<f64>,
        forces: &[f64],
    ) -> Result<Self, FeError> {
        let races = inputs.races;
        let n = races.count;
        let found: Vec<DisplacedMesh> = inputs
            .nominal
            .iter()
            .map(|of| inputs.displaced(of, &q, 1.0).map(|d| d.0))
            .collect::<Result<_, _>>()?;
        let loaded = share(inputs, &found)?;
        let mut meshes = Vec::with_capacity(found.len());
        let mut stiffness = DMatrix::zeros(n, n);
        for (which, (of, displaced)) in inputs.nominal.iter().zip(&found).enumerate() {
            let onto =
                |row: &[f64; 6]| -> DVector<f64> { races.approach(of.kind, of.planet, row).into() };
            let belongs = |group: &&(LoadedMesh, Vec<usize>)| group.1.contains(&which);
            let group = loaded.iter().position(|group| belongs(&group)).unwrap_or(0);
            let own = &loaded[group].0;
            let roll_length = |mesh: &Mesh, shift: f64| mesh.path_start + shift * mesh.base_pitch;
            let gradients = displaced.gradients();
            meshes.push(MeshPose {
                kind: of.kind,
                planet: of.planet,
                group,
                direction: displaced.line_of_centres,
                at: [
                    displaced.approach,
                    displaced.touching_roll_length() - roll_length(&own.mesh, own.shift),
                    displaced.center_distance - own.mesh.center_distance,
                ],
                gradients: [
                    onto(&gradients.approach),
                    onto(&gradients.roll_length),
                    onto(&gradients.center_distance),
                ],
            });
            let force = forces.get(which).copied().unwrap_or(0.0);
            if force != 0.0 {
                let turning = displaced.hessians().approach;
                let onto_mesh = races.mesh_matrix(of.kind, of.planet);
                let turning = DMatrix::from_fn(6, 6, |i, j| force * turning[i][j]);
                stiffness += onto_mesh.transpose() * turning * &onto_mesh;
            }
        }
        let backside = inputs
            .nominal
            .iter()
            .map(|of| {
                let backlash = inputs.bodies.geometry.normal_backlash(of.kind).unwrap_or(0.0);
                let (displaced, _) = inputs.displaced(of, &q, -1.0)?;
                let mesh = moved(inputs.bodies, of.kind, displaced.center_distance)?;
                let gradients = at_rest(&mesh)?;
                let row = mirrored(&displaced.gradients().approach);
                let row = races.approach(of.kind, of.planet, &row);
                let row = ShortRow::new(row.into_iter()).ok_or_else(|| {
                    FeError::NoEquilibrium("a mesh has more than two bodies".into())
                })?;
                let approach = displaced.approach - backlash;
                Ok(BacksidePose {
                    shift: displaced.phase(),
                    direction: displaced.line_of_centres,
                    approach,
                    met_at: row.dot(q.as_slice()) - approach,
                    row,
                    gradients,
                    mesh,
                })
            })
            .collect::<Result<_, FeError>>()?;
        let loaded = loaded.into_iter().map(|group| group.0).collect();
        Ok(Self { torque_nm, q, meshes, backside, loaded, stiffness })
    }

    /// Change of the phase of planet 0's sun mesh by the load, cycles. Positions count from phase 0
    /// of that mesh under load.
    pub fn lead(&self) -> f64 {
        self.meshes.first().map_or(0.0, |pose| self.loaded[pose.group].shift)
    }

    /// Angle between the line of action and the normal to the nominal line of centres of each mesh
    /// (sun meshes, then ring meshes): the pressure angle that a model with fixed centres needs for
    /// the loaded set, rad.
    pub fn pressure_angles(&self) -> Vec<f64> {
        let of = |pose: &MeshPose| {
            let alpha = self.loaded[pose.group].mesh.pressure_angle;
            match pose.kind {
                MeshKind::SunPlanet => alpha - pose.direction,
                MeshKind::RingPlanet => alpha + pose.direction,
            }
        };
        self.meshes.iter().map(of).collect()
    }

    /// Largest change of any mesh's phase (cycles) from another reference.
    pub(super) fn moved_from(&self, other: &Self) -> f64 {
        let phase = |r: &Self, k: usize| {
            let own = &r.loaded[r.meshes[k].group];
            own.shift + r.meshes[k].at[1] / own.mesh.base_pitch
        };
        let change = |k| (phase(self, k) - phase(other, k)).abs();
        (0..self.meshes.len()).map(change).fold(0.0, f64::max)
    }
}

/// A mesh of a kind at another centre distance.
pub(super) fn moved(bodies: &Bodies, kind: MeshKind, distance: f64) -> Result<Mesh, FeError> {
    let mesh = bodies.geometry.mesh(kind).ok_or_else(|| missing_mesh(kind))?;
    mesh.at_center_distance(distance).map_err(|cause| FeError::NoEquilibrium(cause.to_string()))
}

/// Gradients of a mesh at its own centre distance, line of centres along x.
pub(super) fn at_rest(mesh: &Mesh) -> Result<MeshGradients, FeError> {
    let still = mesh.displaced(0.0, &[0.0; 6]);
    Ok(still.map_err(|cause| FeError::NoEquilibrium(cause.to_string()))?.gradients())
}

/// Groups of meshes that share tables, each with the indices of its meshes.
fn share(
    inputs: &ReferenceInputs<'_>,
    found: &[DisplacedMesh],
) -> Result<Vec<(LoadedMesh, Vec<usize>)>, FeError> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (k, displaced) in found.iter().enumerate() {
        let near = |group: &&mut Vec<usize>| {
            let first = &found[group[0]];
            inputs.nominal[group[0]].kind == inputs.nominal[k].kind
                && (first.phase() - displaced.phase()).abs() < SHARED[0]
                && (first.center_distance - displaced.center_distance).abs() < SHARED[1]
        };
        match groups.iter_mut().find(near) {
            Some(group) => group.push(k),
            None => groups.push(vec![k]),
        }
    }
    let one = |members: Vec<usize>| {
        let mean = |of: fn(&DisplacedMesh) -> f64| {
            members.iter().map(|k| of(&found[*k])).sum::<f64>() / members.len() as f64
        };
        let kind = inputs.nominal[members[0]].kind;
        let mesh = moved(inputs.bodies, kind, mean(|d| d.center_distance))?;
        let gradients = at_rest(&mesh)?;
        Ok((LoadedMesh { mesh, shift: mean(DisplacedMesh::phase), gradients }, members))
    };
    groups.into_iter().map(one).collect()
}
