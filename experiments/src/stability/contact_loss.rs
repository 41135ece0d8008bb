//! Where meshes lose contact, over torque and damping: borders found on branches of periodic motions.
//!
//! Below the first loss of contact the motion is nearly linear, and what a resonance adds to the lowest mesh force
//! grows as the inverse of the damping: with the deficit a = 1 − F_min/F̄ of the worst mesh at the two least dampings
//! without loss, each twice the next,
//!
//! ```text
//! a(d) = s + r/d,   contact is first lost at   d = r/(1 − s)
//! ```

use fe_contact::statics::Bodies;
use rayon::prelude::*;
use scene::{LoadCase, Scene};

use super::map::{Drawn, Map, MapError, MapOf, StabilityMap};
use super::resonance::strongest;
use crate::branches::{
    Branch, BranchEnd, BranchError, BranchPoint, BranchSettings, Branches, branch,
};
use crate::sweep::{DampedModel, MeshLawModel, SweepModel};

pub(super) const MAP: Map = Map {
    name: "contact-loss",
    about: "Where meshes lose contact and motions coexist at the strongest resonance, over torque and damping",
    meaning: "with less damping than this teeth part at the resonance, then several motions are possible at one speed, \
         then the backside flanks touch",
    of: MapOf::Scene(map),
};

const LOST: &str = "contact is lost below";
const COEXIST: &str = "more than one motion is stable below";
const BACKSIDE: &str = "backside flanks touch below";

/// Torques as shares of the operating one.
const SHARES: [f64; 4] = [0.05, 0.2, 0.5, 1.0];

/// The branch reaches this part of the resonant speed to either side.
const REACH: f64 = 0.12;

/// Factors on the damping from which borders are sought, and how often the bracket is halved: within 5 %.
const FACTORS: [f64; 7] = [4.0, 2.0, 1.0, 0.5, 0.25, 0.125, 0.0625];
const HALVINGS: usize = 3;

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let case = LoadCase::of_scene(scene).map_err(|_| MapError::NoOperation)?;
    let bodies = Bodies::new(scene)?;
    let model = MeshLawModel::new(scene, &bodies, case)?;
    let resonance = strongest(&model)?;
    let frequency = case.at_speed(resonance).mesh_frequency_hz;
    let system = format!("{}, {frequency:.0} Hz", scene.title);
    let mut map = StabilityMap::of(&MAP, system, "torque on the sun, N·m");
    let range = [(1.0 - REACH) * resonance, (1.0 + REACH) * resonance];
    let range = [range[0].min(range[1]), range[0].max(range[1])];
    let at = |share: &f64| -> Result<Borders, MapError> {
        let case = case.with_sun_torque(share * case.sun_torque_nm);
        let model = MeshLawModel::new(scene, &bodies, case)?;
        Borders::find(&model, range)
    };
    let all: Vec<Borders> = SHARES.par_iter().map(at).collect::<Result<_, _>>()?;
    let torques = SHARES.map(|share| (share * case.sun_torque_nm).abs());
    for (torque, own) in torques.iter().zip(&all) {
        let of = format!("{torque:.1} N·m on the sun");
        for (quantity, measured, theory) in [
            ("contact is lost below a factor on the damping of", own.lost, own.lost_by_scaling),
            (COEXIST, own.coexist, None),
            (BACKSIDE, own.backside, None),
        ] {
            map.compare(&of, quantity, measured, theory);
        }
        if own.lowest.is_some() {
            map.measure(&of, "no periodic motion was found to begin with at", own.lowest);
        }
        if own.stuck > 0 {
            let quantity = "branches that could not be followed to both ends of the speed range";
            map.measure(of, quantity, own.stuck as f64);
        }
    }
    for (name, drawn, of) in [
        (LOST, Drawn::Measured, (|b| b.lost) as fn(&Borders) -> Option<f64>),
        (LOST, Drawn::Theory, |b| b.lost_by_scaling),
        (COEXIST, Drawn::Measured, |b| b.coexist),
        (BACKSIDE, Drawn::Measured, |b| b.backside),
    ] {
        let points = torques.iter().zip(&all);
        let points = points.filter_map(|(t, b)| Some((*t, of(b)?.log10())));
        map.draw(drawn, "log₁₀ of the factor on every damping of the scene", name, points);
    }
    Ok(map)
}

/// What a branch over a resonance shows.
struct Seen {
    /// Largest a = 1 − F_min/F̄.
    deficit: f64,
    is_lost: bool,
    coexist: bool,
    backside: bool,
    is_stuck: bool,
}

impl Seen {
    /// `None` if no periodic motion is found to begin with at either end of the speeds.
    fn of(model: &dyn SweepModel, range: [f64; 2], factor: f64) -> Result<Option<Self>, MapError> {
        let model = DampedModel { model, factor };
        let Some(found) = followed(&model, [range[1], range[0]], range)? else {
            return Ok(None);
        };
        let parts = |branch: &Branch| branch.points.iter().any(|p| p.contact_loss > 0.0);
        let is_needed = parts(&found) && found.folds().count() < 2;
        let mut branches = vec![found];
        if is_needed {
            // A branch may leave the range on one of two motions: the other one is found from the other end.
            branches.extend(followed(&model, range, range)?);
        }
        let all = Branches { branches, not_followed: Vec::new() };
        let points = || all.branches.iter().flat_map(|branch| &branch.points);
        let any = |is: fn(&BranchPoint) -> bool| points().any(is);
        let deficits = points().map(|p| 1.0 - p.grazing_margin.unwrap_or(0.0));
        Ok(Some(Self {
            deficit: deficits.fold(0.0, f64::max),
            is_lost: any(|p| p.contact_loss > 0.0),
            coexist: !all.coexisting().is_empty(),
            backside: any(|p| p.backside_contact.is_some_and(|part| part > 0.0)),
            is_stuck: all.branches[0].ends.iter().any(|end| !matches!(end, BranchEnd::Bound)),
        }))
    }
}

/// The branch over a range of speeds, begun at the first of two ends or, where no motion is found there, at the other.
fn followed(
    model: &dyn SweepModel,
    ends: [f64; 2],
    range: [f64; 2],
) -> Result<Option<Branch>, MapError> {
    for start in ends {
        match branch(model, &BranchSettings { start, ..BranchSettings::over(range) }) {
            Ok(found) => return Ok(Some(found)),
            Err(BranchError::NoStart { .. }) => {}
            Err(other) => return Err(other.into()),
        }
    }
    Ok(None)
}

/// Borders at one torque, factors on the damping; `None` where not found among [`FACTORS`].
struct Borders {
    lost: Option<f64>,
    lost_by_scaling: Option<f64>,
    coexist: Option<f64>,
    backside: Option<f64>,
    /// Branches that ended before the bounds of the speeds.
    stuck: usize,
    /// The first factor at which no motion was found to begin with; below, nothing was sought.
    lowest: Option<f64>,
}

impl Borders {
    fn find(model: &dyn SweepModel, range: [f64; 2]) -> Result<Self, MapError> {
        let (mut seen, mut lowest) = (Vec::<(f64, Seen)>::new(), None);
        for factor in FACTORS {
            let Some(own) = Seen::of(model, range, factor)? else {
                lowest = Some(factor);
                break;
            };
            let is_all = own.is_lost && own.coexist && own.backside;
            seen.push((factor, own));
            if is_all {
                break;
            }
        }
        let mut stuck = seen.iter().filter(|(_, s)| s.is_stuck).count();
        let mut border = |is: fn(&Seen) -> bool| -> Result<Option<f64>, MapError> {
            let Some(k) = seen.iter().position(|(_, s)| is(s)).filter(|k| *k > 0) else {
                return Ok(None);
            };
            let (mut high, mut low) = (seen[k - 1].0, seen[k].0);
            for _ in 0..HALVINGS {
                let middle = (high * low).sqrt();
                let Some(own) = Seen::of(model, range, middle)? else { return Ok(None) };
                stuck += usize::from(own.is_stuck);
                if is(&own) { low = middle } else { high = middle }
            }
            Ok(Some((high * low).sqrt()))
        };
        let lost = border(|s| s.is_lost)?;
        let coexist = border(|s| s.coexist)?;
        let backside = border(|s| s.backside)?;
        Ok(Self { lost, lost_by_scaling: scaled(&seen), coexist, backside, stuck, lowest })
    }
}

/// Where contact would be lost if all of the deficit that a resonance adds grew as the inverse of the damping.
fn scaled(seen: &[(f64, Seen)]) -> Option<f64> {
    let kept = seen.iter().position(|(_, s)| s.is_lost)?;
    let [(d1, first), (d2, second)] = seen[..kept].last_chunk()?;
    // a = s + r/d at two dampings
    let r = (second.deficit - first.deficit) / (1.0 / d2 - 1.0 / d1);
    let s = first.deficit - r / d1;
    (r > 0.0 && s < 1.0).then(|| r / (1.0 - s))
}
