//! Tables of mesh force from the cells.

use gearset::{CurveKey, Facing, FlankSide, LawPlan, MeshCurve, MeshKind, MeshLaw, Scene};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::share::damped_share;
use crate::complementarity::ActiveSet;
use crate::contact::{CellSettings, MeshAnswer, MeshTable, PairCells, PairFrame};
use crate::error::FeError;
use crate::statics::{Bodies, Imperfections, PLANETS, RING, SUN, StaticSet, missing_mesh};

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
    let row = |kind| -> Result<[f64; 6], FeError> {
        let frame = PairFrame::new(bodies.joined(kind)?.0, 0.3, 0);
        Ok(frame.ok_or_else(|| missing_mesh(kind))?.approach_row())
    };
    let job = Job {
        rest: mean_rest(&statics, torque, mean_force)?,
        cells: bodies.cells(reach * mean_force),
        nominal: mean_force,
        largest: reach * mean_force,
        nodes: settings.nodes.max(1),
        on_path: [row(MeshKind::SunPlanet)?, row(MeshKind::RingPlanet)?],
        statics: &statics,
    };
    let made: Vec<Made> =
        plan.curves.par_iter().map(|key| job.make(key)).collect::<Result<_, _>>()?;
    // Every mesh of a kind goes through the same cycle.
    let mean = |kind: MeshKind| {
        let own = plan.curves.iter().zip(&made).filter(|(key, _)| key.kind == kind);
        let shares: Vec<f64> = own.filter_map(|(_, made)| made.share).collect();
        shares.iter().sum::<f64>() / shares.len().max(1) as f64
    };
    let (sun, ring) = (mean(MeshKind::SunPlanet), mean(MeshKind::RingPlanet));
    let shares: Vec<f64> = (0..2 * planets).map(|m| if m < planets { sun } else { ring }).collect();
    let sides = made.iter().map(|made| made.side_load).collect();
    let law = plan.law(made.into_iter().map(|made| made.curve).collect())?;
    Ok(law.with_damping_share(&shares)?.with_side_loads(sides)?)
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

/// One curve; of front flanks, the damped share of the flexibility and the load beside the line of
/// action under the mean force.
struct Made {
    curve: MeshCurve,
    share: Option<f64>,
    side_load: [f64; 6],
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
    /// Approach rows on the path, sun mesh and ring mesh.
    on_path: [[f64; 6]; 2],
}

impl Job<'_, '_> {
    fn make(&self, key: &CurveKey) -> Result<Made, FeError> {
        let bodies = self.statics.bodies;
        let (mesh, pair) = bodies.joined(key.kind)?;
        let table = MeshTable::new(mesh, pair, key.phase, &self.cells)?;
        let on_path = self.on_path(key.kind);
        let mut along = Approaches::of_arms(&table, &on_path);
        match key.side {
            FlankSide::Front => {
                self.displace(key.kind, &table, &on_path, &mut along);
                let curve = curve(&table, &along, self.largest, self.nodes)?;
                let deflection = deflection_for(&table, &along, self.nominal)?;
                let found = at(&table, &along, deflection, &mut None)?;
                let share = Some(damped_share(self.statics, key, &table, &along, &found)?);
                let side_load = self.side_load(key.kind, &table, &along, &found);
                Ok(Made { curve, share, side_load })
            }
            FlankSide::Back => {
                let backlash = bodies.geometry.normal_backlash(key.kind).unwrap_or(0.0);
                let curve = curve(&table, &along, self.largest, BACK_NODES)?;
                let (curve, side_load) = (curve.moved(backlash), [0.0; 6]);
                Ok(Made { curve, share: None, side_load })
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

impl Job<'_, '_> {
    /// −Σ P (b − a b₀) over the pairs of a mesh, b₀ the row on the path: on the central gear's (radial,
    /// tangential, u), then the planet's (ζ, η, u), N.
    fn side_load(
        &self,
        kind: MeshKind,
        table: &MeshTable,
        along: &Approaches,
        found: &Found,
    ) -> [f64; 6] {
        let mut sum = [0.0; 6];
        let pairs = table.pairs.iter().zip(&along.arms).zip(&found.pair_forces);
        for ((pair, arm), force) in pairs {
            for ((sum, b), on_path) in sum.iter_mut().zip(pair.row).zip(self.on_path(kind)) {
                *sum -= force * (b - arm * on_path);
            }
        }
        let radii = &self.statics.races.radii;
        let [first, second] = [[sum[0], sum[1], sum[2]], [sum[3], sum[4], sum[5]]];
        let (central, planet, radius) = match kind {
            MeshKind::SunPlanet => (first, second, radii[SUN]),
            MeshKind::RingPlanet => (second, first, radii[RING]),
        };
        let [x, y, turn] = central;
        let [zeta, eta, spin] = planet;
        [x, y, turn / radius, zeta, eta, spin / radii[PLANETS]]
    }

    /// Approach row of pairs on the path.
    fn on_path(&self, kind: MeshKind) -> [f64; 6] {
        self.on_path[usize::from(kind == MeshKind::RingPlanet)]
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

/// A mesh at a deflection.
pub(super) struct Found {
    /// F = Σ a P, the slope of a potential, N.
    pub(super) force: f64,
    /// dF/dδ, N/m.
    pub(super) stiffness: f64,
    /// P, N.
    pub(super) pair_forces: Vec<f64>,
    /// Tangent between the pairs, N/m.
    pub(super) tangent: DMatrix<f64>,
}

/// A mesh at a deflection; `warm` takes the cells in contact.
pub(super) fn at(
    table: &MeshTable,
    along: &Approaches,
    deflection: f64,
    warm: &mut Option<Vec<bool>>,
) -> Result<Found, FeError> {
    let (approaches, arms) = (along.at(deflection), &along.arms);
    let none = vec![0.0; arms.len()];
    let answer = table.answer(&approaches, &none, &ActiveSet, warm.as_deref())?;
    let force = answer.pair_forces.iter().zip(arms).map(|(p, a)| p * a).sum();
    let mut stiffness = 0.0;
    for (k, a) in arms.iter().enumerate() {
        for (l, b) in arms.iter().enumerate() {
            stiffness += a * answer.tangent[(k, l)] * b;
        }
    }
    *warm = Some(answer.active.clone());
    let MeshAnswer { pair_forces, tangent, .. } = answer;
    Ok(Found { force, stiffness, pair_forces, tangent })
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
        let found = at(table, along, delta, &mut warm)?;
        if found.force >= force && found.force <= 1.02 * force {
            return Ok(delta);
        }
        let (reach, k) = (delta - start, found.stiffness);
        let change = if k > 0.0 { (1.005 * force - found.force) / k } else { reach };
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
        let found = at(table, along, start + i as f64 * step, &mut warm)?;
        (forces[i], tangents[i]) = (found.force, found.stiffness);
    }
    // Just after first contact one cell carries.
    tangents[0] = at(table, along, start + 1e-6 * step, &mut None)?.stiffness;
    MeshCurve::new(start, step, &forces, &tangents)
        .map_err(|cause| FeError::Curve { phase: table.phase, cause })
}
