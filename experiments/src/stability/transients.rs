//! Marches that end before their transient has died out, and pose as steady states.
//!
//! Near a periodic motion each part of a deviation is multiplied by its Floquet multiplier μ in every cycle. If
//! cycles change by c, what is left of the deviation afterwards is at most c times `eq:transient-left`: at a
//! resonance, where μ ≈ e^(−2πζl) is real, about 1/(2πζl) times the change.

use fe_contact::statics::Bodies;
use scene::{LoadCase, Scene};

use super::map::{Map, MapError, MapOf, Point, StabilityMap, logarithms};
use super::resonance::{from_rest, slowest};
use crate::sweep::{
    MeshLawModel, Record, SteadyMethod, SteadySettings, SweepModel, left_of_transient,
};

pub(super) const MAP: Map = Map {
    name: "transients",
    about: "Marches that end before their transient has died out, over the tolerance and damping",
    meaning: "a march that ends when cycles change by less than a tolerance may be off by far more than that: by up to \
         1/(2πζl) times as much at a resonance of harmonic l",
    of: MapOf::Scene(map),
};

/// A march whose last cycle is off by this many times what the multipliers let expect has ended on another motion.
const OTHER: f64 = 100.0;

/// Factors on every damping of the scene.
const FACTORS: [f64; 3] = [1.0, 0.25, 0.1];

/// A deviation of the recorded cycle from the steady one that counts, of the vibration.
const WANTED: f64 = 0.01;

/// A change from cycle to cycle at which a march may be ended.
const CHANGE: f64 = 1e-3;

/// Changes from cycle to cycle down to which the march is followed.
const LEAST_CHANGE: f64 = 1e-8;
const MOST_CYCLES: usize = 4000;

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let case = LoadCase::of_scene(scene).map_err(|_| MapError::NoOperation)?;
    let bodies = Bodies::new(scene)?;
    let model = MeshLawModel::new(scene, &bodies, case)?;
    let case = case.at_speed(slowest(&model)?);
    let system =
        format!("{}, mesh_law, {:.0} Hz, marched from rest", scene.title, case.mesh_frequency_hz);
    let axis = "log₁₀ of the change from cycle to cycle, of the vibration";
    let mut map = StabilityMap::of(&MAP, system, axis);
    for factor in FACTORS {
        let of = format!("damping times {factor}");
        let Some(March { changes, factor_left, last_left }) = March::of(&model, &case, factor)?
        else {
            map.measure(of, "no stable periodic motion was found", None);
            continue;
        };
        if changes.last().is_some_and(|(change, off)| *off > OTHER * last_left * change) {
            let quantity = "the march ended on another motion than the one shooting found";
            map.measure(of, quantity, None);
            continue;
        }
        // Below the least change with which a cycle is off by more than what counts, none is.
        let off = changes.iter().filter(|(_, off)| *off > WANTED);
        let border = off.map(|(change, _)| *change).fold(f64::INFINITY, f64::min);
        let within = changes.iter().filter(|(change, _)| *change <= CHANGE).map(|(_, off)| *off);
        let largest = within.fold(0.0, f64::max);
        for (quantity, found) in [
            ("change from cycle to cycle below which the motion was within 1 %", border),
            ("change below which its multipliers let that be expected", WANTED / factor_left),
            ("largest deviation at a change of 0.001 or less", largest),
            ("deviation that its multipliers let expect", CHANGE * factor_left),
        ] {
            map.measure(&of, quantity, found);
        }
        let at_end = changes.last().map(|(change, off)| off / change);
        let quantity = "deviation over change when only the slowest part is left";
        map.compare(&of, quantity, at_end, Some(last_left));
        // Drawn is each with a change less than nine tenths of the one before.
        let mut drawn: Vec<Point> = Vec::new();
        for point in changes {
            if drawn.last().is_none_or(|last| point.0 < 0.9 * last.0) {
                drawn.push(point);
            }
        }
        let theory: Vec<_> = drawn.iter().map(|(c, _)| (*c, c * factor_left)).collect();
        let panel = "log₁₀ of the deviation from the steady motion, of the vibration";
        map.draw_beside(panel, &of, logarithms(drawn, 0.0), logarithms(theory, 0.0));
    }
    Ok(map)
}

/// Cycles marched from rest.
struct March {
    /// Change from the cycle before, and deviation from the steady cycle, cycle by cycle.
    changes: Vec<(f64, f64)>,
    /// max |μ|/|μ − 1| at the steady motion.
    factor_left: f64,
    /// The same of the multiplier of greatest size alone.
    last_left: f64,
}

impl March {
    /// `None` if shooting finds no stable motion.
    fn of(model: &dyn SweepModel, case: &LoadCase, factor: f64) -> Result<Option<Self>, MapError> {
        let settings = SteadySettings {
            between_cycles: 0,
            whole_cycles: true,
            tolerance: 1e-11,
            ..SteadySettings::default()
        };
        let found = from_rest(model, case, factor, &settings)?;
        if found.method != SteadyMethod::Shooting {
            return Ok(None);
        }
        let factor_left = left_of_transient(&found.multipliers);
        let last_left = left_of_transient(found.multipliers.get(..1).unwrap_or_default());
        let mut set = model.turning_damped(case, factor, 0)?;
        set.rest()?;
        let (mut now, mut before) = (Record::new(model.shape()), Record::new(model.shape()));
        let mut changes = Vec::new();
        for _ in 0..MOST_CYCLES {
            std::mem::swap(&mut now, &mut before);
            now.march(set.as_mut(), model.first_planet_rad(), model.steps_per_cycle())?;
            let change = now.change_from(&before);
            if change.is_finite() {
                changes.push((change, now.change_from(&found.record)));
            }
            if change < LEAST_CHANGE {
                break;
            }
        }
        Ok(Some(Self { changes, factor_left, last_left }))
    }
}
