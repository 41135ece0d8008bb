//! Tables of mesh force, computed from the contact cells.

use gearset::{CurveKey, Facing, FlankSide, MeshCurve, MeshKind, MeshLaw, MeshLawPlan, Scene};
use rayon::prelude::*;

use super::deflected_mesh::{Approaches, DeflectedMesh, at, deflection_for, first_contact};
use super::share::damped_share;
use crate::complementarity::ActiveSet;
use crate::contact::{CellSettings, MeshTable, PairCells};
use crate::error::FeError;
use crate::statics::{
    Bodies, Imperfections, NeighbourTables, PLANETS, RING, SUN, StaticSet, invariants,
    missing_mesh, turned,
};

/// Settings of a mesh law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshLawSettings {
    /// Torque on the sun (magnitude) about whose equilibrium the set is to move, N·m.
    pub torque_nm: f64,
    /// Largest tabulated force of a mesh divided by the mean one; beyond it forces are extrapolated
    /// linearly.
    pub reach: f64,
    /// Steps of each curve from first contact to the largest force.
    pub nodes: usize,
    /// Whether backside flanks are tabulated.
    pub has_backside: bool,
}

/// Steps of the curves of backside flanks, which rarely touch.
const BACK_NODES: usize = 16;

impl MeshLawSettings {
    /// For motion about the equilibrium under a torque (N·m): forces up to three times the mean one, backside
    /// flanks included.
    pub fn at(torque_nm: f64) -> Self {
        Self { torque_nm, reach: 3.0, nodes: 64, has_backside: true }
    }
}

/// The law of a whole set under a torque on the sun of the given sense, at evenly spaced steps of a
/// mesh cycle. It is computed on all threads; their number does not change the result.
///
/// The set is linearised about its mean configuration under the torque: phases and centre distances
/// are those of the loaded gears. A mesh's deflection is its approach on the path of contact. A
/// pair in corner contact approaches with its own moment arms. The forces beside the line of
/// action, from corner contacts and from the slopes of the deformed flanks, are the side load, a
/// function of phase with the pair forces of the equilibrium there.
///
/// # Errors
/// If the scene is neither a whole set nor a sun–planet pair, contact cannot be solved, or the settings are unfit.
pub fn mesh_law(
    scene: &Scene,
    bodies: &Bodies,
    sense: Facing,
    steps: usize,
    settings: &MeshLawSettings,
) -> Result<MeshLaw, FeError> {
    let unfit = |key: &str, value: f64, allowed: &str| FeError::Unfit {
        key: key.into(),
        value: format!("{value}"),
        allowed: allowed.into(),
        why: "the tables of a mesh law are made about an equilibrium under load".into(),
    };
    let (torque, reach) = (settings.torque_nm, settings.reach);
    if !(torque > 0.0 && torque.is_finite()) {
        return Err(unfit("operation.torque_nm", torque, "a finite torque other than 0"));
    }
    if !(reach >= 1.0 && reach.is_finite()) {
        return Err(unfit("reach", reach, "a finite number, at least 1"));
    }
    let statics = StaticSet::new(scene, bodies, sense, Imperfections::default())?.under(torque)?;
    let planets = statics.races.planets();
    let mean_force = statics.share(torque);
    let plan = MeshLawPlan::new(&statics.law_starts(settings.has_backside), steps)?;
    let job = Job {
        at_rest: at_rest(&statics, steps, mean_force)?,
        cells: bodies.cells_in_time(reach * mean_force),
        largest: reach * mean_force,
        mean_force,
        nodes: settings.nodes.max(1),
        statics: &statics,
    };
    let made: Vec<Made> =
        plan.curves.par_iter().map(|key| job.make(key)).collect::<Result<_, _>>()?;
    // All meshes of a kind pass through the same cycle, so that one mean share serves all of them.
    let mean = |kind: MeshKind| {
        let own = plan.curves.iter().zip(&made).filter(|(key, _)| key.kind == kind);
        let shares: Vec<f64> = own.filter_map(|(_, made)| made.share).collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    };
    let (sun, ring) = (mean(MeshKind::SunPlanet), mean(MeshKind::RingPlanet));
    let shares: Vec<f64> =
        (0..statics.meshes()).map(|m| if m < planets { sun } else { ring }).collect();
    let sides = made.iter().map(|made| made.side_load).collect();
    let law = plan.law(made.into_iter().map(|made| made.curve).collect())?;
    Ok(law.with_damping_share(&shares)?.with_side_loads(sides)?)
}

/// A mesh in the equilibrium of the set.
struct AtRest {
    kind: MeshKind,
    phase: f64,
    /// Approach on the path, m.
    deflection: f64,
    /// Approach of each pair, by its number, m.
    approaches: Vec<(i64, f64)>,
}

/// Every mesh at every step of a cycle, at rest under the reference's torque.
fn at_rest(statics: &StaticSet<'_>, steps: usize, mean_force: f64) -> Result<Vec<AtRest>, FeError> {
    let reference = statics.reference();
    let positions: Vec<f64> = (0..steps).map(|i| i as f64 / steps as f64).collect();
    let tables = statics.tables(mean_force, &positions)?;
    let f = statics.load(reference.torque_nm);
    statics.lay_out_beside(&tables)?;
    let mut list = Vec::new();
    let mut start = reference.q.clone();
    for position in positions {
        let mut found = statics.equilibrium(&f, position, &tables, Some(&start), &ActiveSet)?;
        statics.lean_all(&f, &tables, &mut found, &ActiveSet)?;
        for (placed, pose) in found.meshes.iter().zip(&reference.meshes) {
            let moved = pose.gradients[0].dot(&(&found.q - &reference.q));
            let deflection = pose.at[0] + moved;
            let own = placed.table.pairs.iter().map(|pair| pair.index);
            let approaches = own.zip(placed.approaches(&found.q)).collect();
            list.push(AtRest { kind: placed.kind, phase: placed.phase, deflection, approaches });
        }
        start = found.q;
    }
    Ok(list)
}

/// One curve; for front flanks with the damped share of the flexibility and the side load, both in
/// the equilibrium at its phase.
struct Made {
    curve: MeshCurve,
    share: Option<f64>,
    side_load: [f64; 6],
}

/// Everything that the curves of a law have in common.
struct Job<'j, 's> {
    statics: &'j StaticSet<'s>,
    at_rest: Vec<AtRest>,
    cells: CellSettings,
    /// Largest force, N.
    largest: f64,
    /// Force at rest, N.
    mean_force: f64,
    nodes: usize,
}

/// Phases that differ by less than this are equal but for rounding, cycles.
const SAME_PHASE: f64 = 1e-11;

impl Job<'_, '_> {
    fn make(&self, key: &CurveKey) -> Result<Made, FeError> {
        let bodies = self.statics.bodies;
        let pair = bodies.pair(key.kind).ok_or_else(|| missing_mesh(key.kind))?;
        let reference = self.statics.reference();
        let which = reference.meshes.iter().position(|pose| pose.kind == key.kind);
        let which = which.ok_or_else(|| missing_mesh(key.kind))?;
        let (mesh, gradients) = match key.side {
            FlankSide::Front => {
                let own = &reference.loaded[reference.meshes[which].group];
                (&own.mesh, &own.gradients)
            }
            FlankSide::Backside => {
                (&reference.backside[which].mesh, &reference.backside[which].gradients)
            }
        };
        let table = MeshTable::new(mesh, pair, key.phase, &self.cells)?;
        let arm = |p: &PairCells| invariants(key.kind, gradients, &p.row)[0];
        let arms: Vec<f64> = table.pairs.iter().map(arm).collect();
        let mut along = Approaches { extra: vec![0.0; arms.len()], arms };
        match key.side {
            FlankSide::Front => {
                let is_here = |rest: &&AtRest| {
                    let apart = rest.phase - key.phase;
                    rest.kind == key.kind && (apart - apart.round()).abs() < SAME_PHASE
                };
                let rest = self.at_rest.iter().find(is_here);
                let rest = rest.ok_or_else(|| missing_mesh(key.kind))?;
                // At the deflection of the equilibrium the pairs have the approaches of the
                // equilibrium.
                for (k, pair) in table.pairs.iter().enumerate() {
                    if let Some((_, own)) = rest.approaches.iter().find(|a| a.0 == pair.index) {
                        along.extra[k] = own - along.arms[k] * rest.deflection;
                    }
                }
                let curve = curve(&table, &along, self.largest, self.nodes)?;
                let found = at(&table, &along, rest.deflection, &mut None)?;
                let share = Some(damped_share(bodies, mesh, &table, &along, &found));
                let side_load = self.side_load(which, &table, &found)?;
                Ok(Made { curve, share, side_load })
            }
            FlankSide::Backside => {
                let backlash = bodies.geometry.normal_backlash(key.kind).unwrap_or(0.0);
                let curve = curve(&table, &along, self.largest, BACK_NODES)?;
                let (curve, side_load) = (curve.moved(backlash), [0.0; 6]);
                Ok(Made { curve, share: None, side_load })
            }
        }
    }

    /// Side load of a mesh on its gears: with pair forces P and the derivatives A of the pairs'
    /// approaches,
    ///
    /// ```text
    /// −Σ P (A_σ − κ_σ) ∂σ − Σ P (A_a − κ_a) ∂a' + (∂W/∂σ − κᵀP) ∂σ + …
    /// ```
    ///
    /// on the central gear's (radial, tangential, u), then the planet's (ζ, η, u), N.
    fn side_load(
        &self,
        which: usize,
        table: &MeshTable,
        found: &DeflectedMesh,
    ) -> Result<[f64; 6], FeError> {
        let statics = self.statics;
        let pose = &statics.reference().meshes[which];
        let own = &statics.reference().loaded[pose.group];
        let (bodies, mesh, phase) = (statics.bodies, &own.mesh, table.phase);
        let near = NeighbourTables::nearest(bodies, mesh, phase, &self.cells, self.mean_force)?;
        let slopes = match near.slopes_of(table, &found.pair_forces, &ActiveSet)? {
            Some(slopes) => slopes,
            None => NeighbourTables::coarse(bodies, mesh, phase, &self.cells)?.slopes(
                table,
                &found.pair_forces,
                &ActiveSet,
            )?,
        };
        let mut along = slopes.rest;
        for ((pair, force), kappa) in
            table.pairs.iter().zip(&found.pair_forces).zip(&slopes.of_pairs)
        {
            let by = invariants(pose.kind, &own.gradients, &pair.row);
            along[0] -= force * (by[1] - kappa[0]);
            along[1] -= force * (by[2] - kappa[1]);
        }
        let gradients = [&own.gradients.roll_length, &own.gradients.center_distance];
        let mut sum = [0.0; 6];
        for (gradient, force) in gradients.into_iter().zip(along) {
            let row = turned(gradient, pose.direction);
            sum.iter_mut().zip(row).for_each(|(sum, row)| *sum += force * row);
        }
        let radii = &statics.races.base_radii;
        let [first, second] = [[sum[0], sum[1], sum[2]], [sum[3], sum[4], sum[5]]];
        let (central, planet, radius) = match pose.kind {
            MeshKind::SunPlanet => (first, second, radii[SUN]),
            MeshKind::RingPlanet => (second, first, radii[RING]),
        };
        let [x, y, turn] = central;
        let [zeta, eta, spin] = planet;
        Ok([x, y, turn / radius, zeta, eta, spin / radii[PLANETS]])
    }
}

fn curve(
    table: &MeshTable,
    along: &Approaches,
    largest: f64,
    steps: usize,
) -> Result<MeshCurve, FeError> {
    let start = first_contact(table, along);
    let end = deflection_for(table, along, largest)?;
    if end >= table.next_gap {
        return Err(FeError::NoEquilibrium(format!(
            "at mesh phase {:.4} a force of {largest:.0} N takes {:.1} µm, beyond the window for tip \
             contact of {:.1} µm",
            table.phase,
            end * 1e6,
            table.next_gap * 1e6
        )));
    }
    let step = (end - start) / steps as f64;
    let (mut forces, mut tangents) = (vec![0.0; steps + 1], vec![0.0; steps + 1]);
    let mut warm = None;
    for i in (1..=steps).rev() {
        let found = at(table, along, start + i as f64 * step, &mut warm)?;
        (forces[i], tangents[i]) = (found.force, found.stiffness);
    }
    // Tangent just after first contact, where one cell carries the force.
    tangents[0] = at(table, along, start + 1e-6 * step, &mut None)?.stiffness;
    MeshCurve::new(start, step, &forces, &tangents)
        .map_err(|cause| FeError::Curve { phase: table.phase, cause })
}
