//! The transmission error of a set over its period at rest, at even positions and refined about its extremes: over a mesh cycle, or
//! over the part of one in which it repeats itself.

use std::collections::BTreeMap;

use fe_contact::complementarity::ActiveSet;
use fe_contact::statics::{Bodies, Imperfections, StaticSet};
use gearset::{LoadCase, Scene};

use crate::error::ExperimentError;

/// Smallest rise above the extremes, over their distance, for which positions are added: below it are rounding errors.
const LEAST_RISE: f64 = 1e-9;

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
        let (set, known) = (set.under(torque_nm)?, BTreeMap::new());
        Ok(Self { set, torque_nm, radius: sun.base_radius, periods, finest, known })
    }

    /// Another mesh about the mean configuration of this one, with no positions yet.
    pub(super) fn on_bodies<'t>(&self, bodies: &'t Bodies) -> Curve<'t> {
        let Self { torque_nm, radius, periods, finest, .. } = *self;
        let (set, known) = (self.set.on_bodies(bodies), BTreeMap::new());
        Curve { set, torque_nm, radius, periods, finest, known }
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
        }
        Ok(positions.iter().map(|x| self.known[x]).collect())
    }

    /// Even positions, in parts of the finest division.
    pub(super) fn even(&self, count: u32) -> Vec<u32> {
        (0..count).map(|i| i * (self.finest / count)).collect()
    }

    /// Adds positions about the extremes to `count` even ones, until none is missing at the spacing of `about`: every interval
    /// is halved whose lines on either side meet beyond the extremes.
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
/// the middle of every wider interval whose lines on either side meet beyond the extremes.
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
        let rises = top(points, k).is_some_and(|y| y > high + rise)
            || top(&mirrored, k).is_some_and(|y| y > low + rise);
        (rises && width > least).then(|| (left + width / 2) % finest)
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

/// Where the lines through the points k and k + 1 and through k + 2 and k + 3 of a periodic curve meet, if that is above the
/// interval between k + 1 and k + 2.
fn top(points: &[[f64; 2]], k: usize) -> Option<f64> {
    let n = points.len();
    let [a, b, c, d] = [0, 1, 2, 3].map(|i| points[(k + i) % n]);
    let width = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).rem_euclid(1.0);
    // y = y_b + rise t from the left, y = y_c + fall (w − t) from the right
    let (rise, fall) = ((b[1] - a[1]) / width(a, b), (c[1] - d[1]) / width(c, d));
    let w = width(b, c);
    let t = (c[1] + fall * w - b[1]) / (rise + fall);
    (rise > 0.0 && fall > 0.0 && (0.0..=w).contains(&t)).then(|| b[1] + rise * t)
}

/// What the lines that a periodic curve follows on either side of its intervals exceed its highest point by where they meet,
/// at least 0.
pub(super) fn overshoot(points: &[[f64; 2]]) -> f64 {
    let high = highest(points);
    (0..points.len()).filter_map(|k| top(points, k)).fold(high, f64::max) - high
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
}
