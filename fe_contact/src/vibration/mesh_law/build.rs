//! Tables of mesh force from the cells.

use gearset::{CurveKey, Facing, FlankSide, LawPlan, MeshCurve, MeshKind, MeshLaw, Scene};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::share::damped_share;
use crate::complementarity::ActiveSet;
use crate::contact::{CellSettings, MeshTable, PairCells, PairFrame};
use crate::error::FeError;
use crate::statics::{Bodies, Imperfections, SUN, StaticSet, missing_mesh};

/// What a law is made for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawSettings {
    /// Torque on the sun (magnitude) about whose equilibrium the set is to move, N·m.
    pub torque_nm: f64,
    /// Largest force of a mesh that the tables hold over the mean one; beyond, forces go straight on.
    pub reach: f64,
    /// Steps of each curve from first contact to the largest force.
    pub nodes: usize,
    /// Whether back flanks are tabulated.
    pub has_backs: bool,
}

/// Steps of the curves of back flanks, which rarely touch.
const BACK_NODES: usize = 16;

/// Positions of the mesh cycle at which equilibrium is found.
const REST_POSITIONS: usize = 14;

impl LawSettings {
    /// For motion about the equilibrium under a torque (N·m): forces up to three times the mean one, back
    /// flanks included.
    pub fn at(torque_nm: f64) -> Self {
        Self { torque_nm, reach: 3.0, nodes: 64, has_backs: true }
    }
}

/// The law of a whole set under a torque on the sun of the given sense, at even steps of a mesh cycle;
/// deterministic, on all threads.
///
/// A mesh's deflection is its approach on the path of contact. A pair that touches with a corner
/// approaches otherwise: by its own arms where the deflection changes, and by what the set's displacements
/// at rest make of its other row. Under load those are ten times the deflection, most of which cancels
/// on the path.
///
/// # Errors
/// If the scene is no whole set, contact cannot be solved, or the settings are unfit.
pub fn mesh_law(
    scene: &Scene,
    bodies: &Bodies,
    sense: Facing,
    steps: usize,
    settings: &LawSettings,
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
    let statics = StaticSet::new(scene, bodies, sense, Imperfections::default())?;
    let planets = statics.races.planets();
    let mean_force = torque / statics.races.radii[SUN] / planets as f64;
    let plan = LawPlan::new(&statics.law_starts(settings.has_backs), steps)?;
    let job = Job {
        rest: mean_rest(&statics, torque, mean_force)?,
        cells: bodies.cells(reach * mean_force),
        nominal: mean_force,
        largest: reach * mean_force,
        nodes: settings.nodes.max(1),
        statics: &statics,
    };
    let made: Vec<(MeshCurve, Option<f64>)> =
        plan.curves.par_iter().map(|key| job.make(key)).collect::<Result<_, _>>()?;
    // Every mesh of a kind goes through the same cycle.
    let mean = |kind: MeshKind| {
        let own = plan.curves.iter().zip(&made).filter(|(key, _)| key.kind == kind);
        let shares: Vec<f64> = own.filter_map(|(_, (_, share))| *share).collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    };
    let (sun, ring) = (mean(MeshKind::SunPlanet), mean(MeshKind::RingPlanet));
    let shares: Vec<f64> = (0..2 * planets).map(|m| if m < planets { sun } else { ring }).collect();
    let law = plan.law(made.into_iter().map(|(curve, _)| curve).collect())?;
    Ok(law.with_damping_share(&shares)?)
}

/// Displacements at rest under a torque, mean over the mesh cycle.
fn mean_rest(
    statics: &StaticSet<'_>,
    torque: f64,
    mean_force: f64,
) -> Result<DVector<f64>, FeError> {
    let positions: Vec<f64> =
        (0..REST_POSITIONS).map(|i| i as f64 / REST_POSITIONS as f64).collect();
    let tables = statics.tables(mean_force, &positions)?;
    let mut mean = DVector::zeros(statics.races.count);
    let mut start = None;
    for position in positions {
        let found = statics.equilibrium(torque, position, &tables, start.as_ref(), &ActiveSet)?;
        mean += &found.q / REST_POSITIONS as f64;
        start = Some(found.q);
    }
    Ok(mean)
}

/// Approaches of a mesh's pairs over its deflection δ: a δ + o each.
#[derive(Debug, Clone)]
pub(super) struct Approaches {
    /// a.
    pub(super) arms: Vec<f64>,
    /// o, m.
    extra: Vec<f64>,
}

/// What all curves of a law are made with.
struct Job<'j, 's> {
    statics: &'j StaticSet<'s>,
    rest: DVector<f64>,
    cells: CellSettings,
    /// Mean and largest force, N.
    nominal: f64,
    largest: f64,
    nodes: usize,
}

impl Job<'_, '_> {
    /// One curve, and of front flanks the damped share of the flexibility.
    fn make(&self, key: &CurveKey) -> Result<(MeshCurve, Option<f64>), FeError> {
        let bodies = self.statics.bodies;
        let (mesh, pair) = bodies.joined(key.kind)?;
        let table = MeshTable::new(mesh, pair, key.phase, &self.cells)?;
        let on_path = PairFrame::new(mesh, 0.3, 0).ok_or_else(|| missing_mesh(key.kind))?;
        let mut along = Approaches::of_arms(&table, &on_path.approach_row());
        match key.side {
            FlankSide::Front => {
                self.displace(key.kind, &table, &on_path.approach_row(), &mut along);
                let curve = curve(&table, &along, self.largest, self.nodes)?;
                let share = damped_share(self.statics, key, &table, &along, self.nominal)?;
                Ok((curve, Some(share)))
            }
            FlankSide::Back => {
                let backlash = bodies.geometry.normal_backlash(key.kind).unwrap_or(0.0);
                let curve = curve(&table, &along, self.largest, BACK_NODES)?;
                Ok((curve.moved(backlash), None))
            }
        }
    }

    /// What the displacements at rest add to the approaches of pairs off the path, mean over the planets.
    fn displace(
        &self,
        kind: MeshKind,
        table: &MeshTable,
        on_path: &[f64; 6],
        along: &mut Approaches,
    ) {
        let races = &self.statics.races;
        let planets = races.planets();
        let of = |planet, row: &[f64; 6]| -> f64 {
            let row = races.approach(kind, planet, row);
            row.iter().zip(self.rest.iter()).map(|(b, q)| b * q).sum()
        };
        for (k, pair) in table.pairs.iter().enumerate() {
            let arm = along.arms[k];
            let one = |planet| of(planet, &pair.row) - arm * of(planet, on_path);
            along.extra[k] = (0..planets).map(one).sum::<f64>() / planets as f64;
        }
    }
}

impl Approaches {
    /// 1 on the path; at a corner, whose normal and arms differ, the mean of what turning either gear
    /// gives.
    fn of_arms(table: &MeshTable, on_path: &[f64; 6]) -> Self {
        let one = |row: &[f64; 6]| 0.5 * (row[2] / on_path[2] + row[5] / on_path[5]);
        let arms: Vec<f64> = table.pairs.iter().map(|pair| one(&pair.row)).collect();
        Self { extra: vec![0.0; arms.len()], arms }
    }

    fn at(&self, deflection: f64) -> Vec<f64> {
        self.arms.iter().zip(&self.extra).map(|(a, o)| a * deflection + o).collect()
    }
}

/// Force (N) and tangent (N/m) at a deflection, F = Σ a P so that it is a potential's slope, with the
/// cells in contact.
pub(super) fn at(
    table: &MeshTable,
    along: &Approaches,
    deflection: f64,
    warm: &mut Option<Vec<bool>>,
) -> Result<(f64, f64, Vec<f64>, DMatrix<f64>), FeError> {
    let (approaches, arms) = (along.at(deflection), &along.arms);
    let none = vec![0.0; arms.len()];
    let answer = table.answer(&approaches, &none, &ActiveSet, warm.as_deref())?;
    let force = answer.pair_forces.iter().zip(arms).map(|(p, a)| p * a).sum();
    let mut tangent = 0.0;
    for (k, a) in arms.iter().enumerate() {
        for (l, b) in arms.iter().enumerate() {
            tangent += a * answer.tangent[(k, l)] * b;
        }
    }
    *warm = Some(answer.active);
    Ok((force, tangent, answer.pair_forces, answer.tangent))
}

/// Deflection at which a mesh carries a force at least, and at most some percent more, m.
pub(super) fn deflection_for(
    table: &MeshTable,
    along: &Approaches,
    force: f64,
) -> Result<f64, FeError> {
    let start = first_contact(table, along);
    let mut warm = None;
    // About one pair of steel teeth.
    let mut delta = start + force / (2.0e9 * table.face_width * 10.0);
    for _ in 0..60 {
        let (found, tangent, ..) = at(table, along, delta, &mut warm)?;
        if found >= force && found <= 1.02 * force {
            return Ok(delta);
        }
        let reach = delta - start;
        let change = if tangent > 0.0 { (1.005 * force - found) / tangent } else { reach };
        delta += change.clamp(-0.5 * reach, 2.0 * reach);
    }
    Err(FeError::NoEquilibrium(format!(
        "no deflection gives {force:.0} N at mesh phase {:.4}",
        table.phase
    )))
}

/// Deflection at which the first cell touches, m.
fn first_contact(table: &MeshTable, along: &Approaches) -> f64 {
    let of = |(k, pair): (usize, &PairCells)| {
        let own = &table.gaps[pair.first..pair.first + pair.x.len()];
        (own.iter().fold(f64::INFINITY, |a, g| a.min(*g)) - along.extra[k]) / along.arms[k]
    };
    table.pairs.iter().enumerate().map(of).fold(f64::INFINITY, f64::min)
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
        let (force, tangent, ..) = at(table, along, start + i as f64 * step, &mut warm)?;
        (forces[i], tangents[i]) = (force, tangent);
    }
    // Just after first contact one cell carries.
    let (_, tangent, ..) = at(table, along, start + 1e-6 * step, &mut None)?;
    tangents[0] = tangent;
    MeshCurve::new(start, step, &forces, &tangents)
        .map_err(|cause| FeError::Curve { phase: table.phase, cause })
}
