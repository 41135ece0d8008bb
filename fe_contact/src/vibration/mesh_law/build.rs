//! Tables of mesh force, computed from the contact cells.

use gearset::{CurveKey, Facing, FlankSide, MeshCurve, MeshKind, MeshLaw, MeshLawPlan, MeshStart};
use rayon::prelude::*;
use scene::Scene;

use super::deflected_mesh::{Approaches, DeflectedMesh, at, deflection_for, first_contact};
use super::share::damped_share;
use crate::complementarity::ActiveSet;
use crate::contact::{CellSettings, MeshTable, PairCells};
use crate::error::FeError;
use crate::statics::{
    Bodies, Imperfections, NeighbourTables, StaticSet, invariants, missing_mesh, turned,
};

/// Settings of a mesh law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshLawSettings {
    /// Torque on the sun (magnitude) about whose equilibrium the set is to move, N·m.
    pub torque_nm: f64,
    /// Largest tabulated force of a mesh divided by the mean one. Beyond it forces are extrapolated linearly;
    /// sweeps refuse them and take larger tables.
    pub reach: f64,
    /// Steps of each curve from first contact to the largest force.
    pub nodes: usize,
    /// Whether backside flanks are tabulated.
    pub has_backside: bool,
}

/// Steps of the curves of front flanks for one of backside flanks, which rarely touch.
const STEPS_A_BACKSIDE_STEP: usize = 4;

impl MeshLawSettings {
    /// For motion about the equilibrium under a torque (N·m): forces up to three times the mean one, backside
    /// flanks included.
    pub fn at(torque_nm: f64) -> Self {
        Self { torque_nm, reach: 3.0, nodes: 64, has_backside: true }
    }

    /// For forces so many times as large, in steps of the same length.
    pub fn for_times_the_force(self, times: usize) -> Self {
        Self { reach: self.reach * times as f64, nodes: self.nodes * times, ..self }
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
    let mean_force = statics.share(torque);
    let at_rest = at_rest(&statics, steps, mean_force)?;
    let classes = classes(&statics, &at_rest);
    let starts = statics.law_starts(&classes, settings.has_backside);
    let plan = MeshLawPlan::new(&starts, steps)?;
    let job = Job {
        at_rest,
        cells: bodies.cells_in_time(reach * mean_force),
        largest: reach * mean_force,
        mean_force,
        nodes: settings.nodes.max(1),
        statics: &statics,
    };
    let made: Vec<Made> =
        plan.curves.par_iter().map(|key| job.make(key)).collect::<Result<_, _>>()?;
    // Meshes of a kind and class pass through the same cycle, so that one mean share serves all of them.
    let mean = |start: &MeshStart| {
        let is_own = |key: &CurveKey| {
            let of = &starts[key.mesh];
            (of.kind, of.class) == (start.kind, start.class)
        };
        let own = plan.curves.iter().zip(&made).filter(|(key, _)| is_own(key));
        let shares: Vec<f64> = own.filter_map(|(_, made)| made.share).collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    };
    let shares: Vec<f64> = starts.iter().map(mean).collect();
    let sides = made.iter().map(|made| made.side_load).collect();
    let law = plan.law(made.into_iter().map(|made| made.curve).collect())?;
    Ok(law.with_damping_share(&shares)?.with_side_loads(sides)?)
}

/// A mesh in the equilibrium of the set.
struct AtRest {
    phase: f64,
    /// Approach on the path, m.
    deflection: f64,
    /// Approach of each pair, by its number, m.
    approaches: Vec<(i64, f64)>,
}

impl AtRest {
    /// Whether two meshes, or one at two steps, have the same phase but for rounding.
    fn is_at(&self, phase: f64) -> bool {
        let apart = self.phase - phase;
        (apart - apart.round()).abs() < SAME_PHASE
    }
}

/// Every mesh at every step of a cycle, by mesh, then step, at rest under the reference's torque.
fn at_rest(
    statics: &StaticSet<'_>,
    steps: usize,
    mean_force: f64,
) -> Result<Vec<Vec<AtRest>>, FeError> {
    let reference = statics.reference();
    let positions: Vec<f64> = (0..steps).map(|i| i as f64 / steps as f64).collect();
    let tables = statics.tables(mean_force, &positions)?;
    let f = statics.load(reference.torque_nm);
    statics.lay_out_beside(&tables)?;
    let mut list: Vec<Vec<AtRest>> = (0..statics.meshes()).map(|_| Vec::new()).collect();
    let mut start = reference.q.clone();
    for position in positions {
        let mut found = statics.equilibrium(&f, position, &tables, Some(&start), &ActiveSet)?;
        statics.lean_all(&f, &tables, &mut found, &ActiveSet)?;
        for ((placed, pose), list) in found.meshes.iter().zip(&reference.meshes).zip(&mut list) {
            let moved = pose.gradients[0].dot(&(&found.q - &reference.q));
            let deflection = pose.at[0] + moved;
            let own = placed.table.pairs.iter().map(|pair| pair.index);
            let approaches = own.zip(placed.approaches(&found.q)).collect();
            list.push(AtRest { phase: placed.phase, deflection, approaches });
        }
        start = found.q;
    }
    Ok(list)
}

/// Class of each mesh (sun meshes, then ring meshes): those of a kind and class stand alike at the reference, and their
/// pairs approach alike at equal phases. Evenly spaced planets are of one class, of opposed planets each two; a mesh
/// whose phases are those of no other has a class of its own.
fn classes(statics: &StaticSet<'_>, at_rest: &[Vec<AtRest>]) -> Vec<usize> {
    let reference = statics.reference();
    let near = |a: f64, b: f64| (a - b).abs() < ALIKE_M;
    let stand_alike = |one: usize, other: usize| {
        let [a, b] = [one, other].map(|mesh| &reference.meshes[mesh]);
        let [c, d] = [one, other].map(|mesh| &reference.backside[mesh]);
        let length = reference.loaded[a.group].mesh.center_distance;
        (a.kind, a.group) == (b.kind, b.group)
            && near(a.direction * length, b.direction * length)
            && a.at.iter().zip(&b.at).all(|(a, b)| near(*a, *b))
            && near(c.approach, d.approach)
            && near(c.direction * length, d.direction * length)
            && near(c.mesh.center_distance, d.mesh.center_distance)
    };
    let approach_alike = |one: usize, other: usize| {
        let own = &at_rest[one];
        let found =
            own.first().and_then(|at| at_rest[other].iter().position(|o| o.is_at(at.phase)));
        let Some(later) = found else { return false };
        own.iter().zip(at_rest[other].iter().cycle().skip(later)).all(|(a, b)| {
            let pairs = a.approaches.iter().zip(&b.approaches);
            near(a.deflection, b.deflection)
                && a.approaches.len() == b.approaches.len()
                && pairs.into_iter().all(|(a, b)| a.0 == b.0 && near(a.1, b.1))
        })
    };
    let mut classes = Vec::with_capacity(at_rest.len());
    for mesh in 0..at_rest.len() {
        let alike = |other: &usize| stand_alike(mesh, *other) && approach_alike(mesh, *other);
        let class = (0..mesh).find(alike).map_or(mesh, |first| classes[first]);
        classes.push(class);
    }
    classes
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
    /// By mesh, then step.
    at_rest: Vec<Vec<AtRest>>,
    cells: CellSettings,
    /// Largest force, N.
    largest: f64,
    /// Force at rest, N.
    mean_force: f64,
    nodes: usize,
}

/// Phases that differ by less than this are equal but for rounding, cycles.
const SAME_PHASE: f64 = 1e-11;

/// Meshes whose approaches differ by less than this are alike, m: a millionth of a tooth's deflection, above what
/// the iterations for an equilibrium leave.
const ALIKE_M: f64 = 1e-11;

impl Job<'_, '_> {
    fn make(&self, key: &CurveKey) -> Result<Made, FeError> {
        let bodies = self.statics.bodies;
        let pair = bodies.pair(key.kind).ok_or_else(|| missing_mesh(key.kind))?;
        let reference = self.statics.reference();
        let which = key.mesh;
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
                let rest = self.at_rest[which].iter().find(|rest| rest.is_at(key.phase));
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
                let steps = self.nodes.div_ceil(STEPS_A_BACKSIDE_STEP);
                let curve = curve(&table, &along, self.largest, steps)?;
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
            MeshKind::SunPlanet => (first, second, radii[2]),
            MeshKind::RingPlanet => (second, first, radii[1]),
        };
        let [x, y, turn] = central;
        let [zeta, eta, spin] = planet;
        Ok([x, y, turn / radius, zeta, eta, spin / radii[3]])
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
