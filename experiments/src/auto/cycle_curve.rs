//! The transmission error of a set over its period at rest, at even positions and refined about its extremes: over a mesh cycle, or
//! over the part of one in which it repeats itself.

use std::collections::BTreeMap;

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, SetCycle, StaticSet};
use gearset::{LoadCase, Scene};

use crate::error::ExperimentError;

/// Largest rise above the extremes, over their distance, for which no positions are added.
const LEAST_RISE: f64 = 5e-5;

/// Least part of an interval to either side of a position that is added in it, where a corner may lie.
const INSIDE: f64 = 0.125;

/// A set with the positions that were computed.
#[derive(Debug)]
pub(super) struct Curve<'b> {
    set: StaticSet<'b>,
    /// Torque on the sun, N·m.
    torque_nm: f64,
    /// Base radius of the sun, m.
    radius: f64,
    /// Periods in a mesh cycle.
    periods: u32,
    /// Positions into which a period is divided at the finest.
    finest: u32,
    /// r_b θ of the sun by position, in parts of the finest division, m.
    known: BTreeMap<u32, f64>,
    /// The set there, in the order in which it was computed.
    cycle: Option<SetCycle>,
}

impl<'b> Curve<'b> {
    /// A set about its mean configuration under the load, with no positions yet: `periods` in a mesh cycle, each divided into
    /// `finest` positions.
    ///
    /// # Errors
    /// If FE/contact refuses the scene.
    pub(super) fn new(
        scene: &Scene,
        bodies: &'b Bodies,
        case: &LoadCase,
        (periods, finest): (u32, u32),
    ) -> Result<Self, ExperimentError> {
        let sun = bodies.geometry.sun.as_ref().ok_or(ExperimentError::Incomplete("sun"))?;
        let torque_nm = case.sun_load_nm();
        let set = StaticSet::new(scene, bodies, case.sense(), Imperfections::default())?;
        let (set, radius) = (set.under(torque_nm)?, sun.base_radius);
        Ok(Self { set, torque_nm, radius, periods, finest, known: BTreeMap::new(), cycle: None })
    }

    /// Another mesh about the mean configuration of this one, with no positions yet.
    pub(super) fn on_bodies<'t>(&self, bodies: &'t Bodies) -> Curve<'t> {
        let Self { torque_nm, radius, periods, finest, .. } = *self;
        let (set, known) = (self.set.on_bodies(bodies), BTreeMap::new());
        Curve { set, torque_nm, radius, periods, finest, known, cycle: None }
    }

    /// Values at some positions, in parts of the finest division, m.
    ///
    /// # Errors
    /// If contact cannot be solved, or with the first positions if displacements are too large for linear kinematics.
    pub(super) fn at(&mut self, positions: &[u32]) -> Result<Vec<f64>, ExperimentError> {
        let list: Vec<u32> =
            positions.iter().copied().filter(|x| !self.known.contains_key(x)).collect();
        if !list.is_empty() {
            let in_cycle = f64::from(self.finest) * f64::from(self.periods);
            let cycles = list.iter().map(|x| f64::from(*x) / in_cycle);
            let cycles: Vec<f64> = cycles.collect();
            let found = self.set.at_positions(self.torque_nm, &cycles, &ActiveSet)?;
            // A single position has no peak-to-peak motion to compare with.
            if self.known.is_empty() && list.len() > 1 {
                found.kinematic_rest(self.radius).check()?;
            }
            let values = found.states.iter().map(|s| s.transmission_error(self.radius));
            self.known.extend(list.into_iter().zip(values));
            match &mut self.cycle {
                Some(cycle) => cycle.states.extend(found.states),
                None => self.cycle = Some(found),
            }
        }
        Ok(positions.iter().map(|x| self.known[x]).collect())
    }

    /// Even positions, in parts of the finest division.
    pub(super) fn even(&self, count: u32) -> Vec<u32> {
        (0..count).map(|i| i * (self.finest / count)).collect()
    }

    /// Adds positions about the extremes to `count` even ones, until none is missing at the spacing of `about`: one in every interval
    /// in which a corner may reach beyond the extremes.
    ///
    /// # Errors
    /// As [`at`](Self::at).
    pub(super) fn refine(&mut self, count: u32, about: u32) -> Result<(), ExperimentError> {
        self.at(&self.even(count))?;
        loop {
            let wanted = missing(&self.points(), self.finest, about);
            if wanted.is_empty() {
                return Ok(());
            }
            self.at(&wanted)?;
        }
    }

    /// The set at all positions that were computed, ascending; `None` if none was.
    pub(super) fn into_cycle(self) -> Option<SetCycle> {
        let mut cycle = self.cycle?;
        cycle.states.sort_by(|a, b| a.position.total_cmp(&b.position));
        Some(cycle)
    }

    /// Position (periods) and value (m) of all that were computed, ascending.
    pub(super) fn points(&self) -> Vec<[f64; 2]> {
        let finest = f64::from(self.finest);
        self.known.iter().map(|(x, y)| [f64::from(*x) / finest, *y]).collect()
    }

    /// Values by position, in parts of the finest division, m.
    pub(super) fn known(&self) -> &BTreeMap<u32, f64> {
        &self.known
    }

    /// Positions into which a period is divided at the finest.
    pub(super) fn finest(&self) -> u32 {
        self.finest
    }
}

/// Positions that are missing about the extremes of a periodic curve at the spacing of `about`, in parts of the finest division:
/// where the corner may lie in every wider interval in which one may reach beyond the extremes.
pub(super) fn missing(points: &[[f64; 2]], finest: u32, about: u32) -> Vec<u32> {
    let least = finest / about;
    let mirrored: Vec<[f64; 2]> = points.iter().map(|[x, y]| [*x, -y]).collect();
    let [high, low] = [points, &mirrored].map(highest);
    let rise = LEAST_RISE * (high + low);
    let keys: Vec<u32> =
        points.iter().map(|[x, _]| (x * f64::from(finest)).round() as u32).collect();
    let n = keys.len();
    let wanted = (0..n).filter_map(|k| {
        let (left, right) = (keys[(k + 1) % n], keys[(k + 2) % n]);
        let width = (right + finest - left) % finest;
        let above = top(points, k).filter(|[_, y]| *y > high + rise);
        let corner = above.or_else(|| top(&mirrored, k).filter(|[_, y]| *y > low + rise));
        let steps = width / least;
        let place = (corner?[0] / f64::from(least) * f64::from(finest)).round() as u32;
        let inside = (INSIDE * f64::from(steps)).ceil() as u32;
        (steps > 1).then(|| (left + least * place.clamp(inside, steps - inside)) % finest)
    });
    let mut wanted: Vec<u32> = wanted.collect();
    wanted.sort_unstable();
    wanted
}

fn highest(points: &[[f64; 2]]) -> f64 {
    points.iter().fold(f64::NEG_INFINITY, |a, [_, y]| a.max(*y))
}

/// Largest less smallest value.
pub(super) fn range(points: &[[f64; 2]]) -> f64 {
    highest(points) - points.iter().fold(f64::INFINITY, |a, [_, y]| a.min(*y))
}

/// Mean value of the points of a curve.
pub(super) fn mean(points: &[[f64; 2]]) -> f64 {
    points.iter().map(|[_, y]| y).sum::<f64>() / points.len() as f64
}

/// How high a periodic curve may reach between the points k + 1 and k + 2, towards which it rises from either side, and how far from the first;
/// `None` where it does not.
///
/// With the values b and c there, the interval w and the slopes s_l and s_r that the curve has towards it from the left and from the right,
/// a corner between straight lines lies where these meet:
///
/// ```text
/// b + s_l t = c − s_r (w − t)   at 0 ≤ t ≤ w
/// ```
///
/// Where two teeth begin to touch, the curve falls from its corner the less steeply the farther it goes. The slopes are therefore those that the two
/// intervals on that side have in their middles, extrapolated to the middle of this one where it is the steeper. A curve that falls from b more
/// steeply still, by s < −s_r, has its corner so close to b that its own slope is extrapolated, s_r' = −2 s − s_r; in the other direction likewise.
fn top(points: &[[f64; 2]], k: usize) -> Option<[f64; 2]> {
    let n = points.len();
    let [z, a, b, c, d, e] = [n - 1, 0, 1, 2, 3, 4].map(|i| points[(k + i) % n]);
    let width = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).rem_euclid(1.0);
    let slope = |p: [f64; 2], q: [f64; 2]| (q[1] - p[1]) / width(p, q);
    let w = width(b, c);
    // From an interval and the one behind it, at the middle of [b, c].
    let steepest = |near: f64, far: f64, [own, behind]: [f64; 2]| {
        near + (near - far).max(0.0) * (w + own) / (own + behind)
    };
    let rise = steepest(slope(a, b), slope(z, a), [width(a, b), width(z, a)]);
    let fall = steepest(-slope(c, d), -slope(d, e), [width(c, d), width(d, e)]);
    let across = slope(b, c);
    // Of a line through b that rises by `rise` and one through c that falls by `fall`.
    let meeting = |rise: f64, fall: f64| {
        let t = (c[1] + fall * w - b[1]) / (rise + fall);
        (rise > 0.0 && fall > 0.0 && (0.0..=w).contains(&t)).then(|| [t, b[1] + rise * t])
    };
    if -across > fall.max(0.0) {
        meeting(rise, -2.0 * across - fall)
    } else if across > rise.max(0.0) {
        meeting(2.0 * across - rise, fall)
    } else {
        meeting(rise, fall)
    }
}

/// What the corners that may lie between the points of a periodic curve exceed its highest point by, at least 0.
pub(super) fn overshoot(points: &[[f64; 2]]) -> f64 {
    let high = highest(points);
    let tops = (0..points.len()).filter_map(|k| top(points, k));
    tops.fold(high, |most, [_, y]| most.max(y)) - high
}

/// The same of the lowest point.
pub(super) fn undershoot(points: &[[f64; 2]]) -> f64 {
    let mirrored: Vec<[f64; 2]> = points.iter().map(|[x, y]| [*x, -y]).collect();
    overshoot(&mirrored)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn samples(n: usize, of: impl Fn(f64) -> f64) -> Vec<[f64; 2]> {
        (0..n).map(|i| i as f64 / n as f64).map(|x| [x, of(x)]).collect()
    }

    /// The top of a corner wherever it lies between positions, exactly, at any spacing; of a sine at least what the positions
    /// miss, and of second order.
    #[test]
    fn what_positions_miss_is_bounded_at_corners_and_where_the_curve_is_smooth() {
        for place in [0.21, 0.2345, 0.249] {
            let corner = |x: f64| 1.0 - (x - place).abs();
            let mut curve = samples(40, corner);
            curve.insert(9, [0.219, corner(0.219)]);
            let missed = 1.0 - highest(&curve);
            assert!((overshoot(&curve) - missed).abs() < 1e-12, "{place}");
        }
        let sine = |n: usize| samples(n, |x| (std::f64::consts::TAU * (x - 0.2341)).sin());
        let parts = [30, 60, 120].map(|n| {
            let curve = sine(n);
            let missed = 1.0 - highest(&curve);
            let part = overshoot(&curve);
            assert!(part >= missed, "{n}: {part} {missed}");
            part
        });
        assert!(parts[0] > 3.0 * parts[1] && parts[1] > 3.0 * parts[2], "{parts:?}");
        assert_eq!(overshoot(&samples(8, |_| 2.0)), 0.0);
    }

    /// As where two teeth begin to touch, the curve falls steeply from its corner and less so farther on: straight lines meet beyond the
    /// point before it. The corner is found from either side.
    #[test]
    fn corners_are_found_from_which_a_curve_falls_the_less_the_farther_it_goes() {
        for place in [0.4001, 0.404, 0.41, 0.4167, 0.423] {
            let curve = move |x: f64| match x < place {
                true => 0.3 * (x - place) / place,
                false => {
                    (-(x - place) / 0.06).exp() - 1.0 + 0.7 * ((x - place) / (1.0 - place)).powi(8)
                }
            };
            for of in [&curve as &dyn Fn(f64) -> f64, &|x| curve(1.0 - x)] {
                let mut points = samples(40, of);
                let finest = 40 << 5;
                let missed = [40, 80, 160, 320, 640, 1280].map(|about| {
                    loop {
                        let wanted = missing(&points, finest, about);
                        if wanted.is_empty() {
                            break;
                        }
                        let added = wanted.iter().map(|x| f64::from(*x) / f64::from(finest));
                        points.extend(added.map(|x| [x, of(x)]));
                        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                    }
                    (-highest(&points), overshoot(&points))
                });
                println!("{place}: {missed:?} with {}", points.len());
                // Half of it where the curve bends within an interval by as much as the corner is off its end; closer all but what a corner
                // right beside a position exceeds that by, of a range of 1.
                let is_within =
                    |factor: f64, (missed, bound): &(f64, f64)| *missed <= factor * bound + 1e-4;
                assert!(is_within(2.0, &missed[0]), "{place}: {missed:?}");
                assert!(missed[1..].iter().all(|own| is_within(1.25, own)), "{place}: {missed:?}");
                assert!(
                    missed[5].0 < 1e-3 && points.len() <= 40 + 3 * 5,
                    "{place}: {}",
                    points.len()
                );
            }
        }
    }
}
