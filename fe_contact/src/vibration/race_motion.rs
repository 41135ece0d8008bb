//! One body's part in the motion of all races and in the load on them.

use dynamics::Motion;
use nalgebra::DVector;

use super::body::RaceMotion;
use crate::statics::Races;

/// Motion of one body's race; 0 for held coordinates.
pub(super) fn race_motion(races: &Races, motion: &Motion, body: usize) -> RaceMotion {
    let mut race = RaceMotion::default();
    for axis in 0..3 {
        if let Some(i) = races.of(body, axis) {
            race.x[axis] = motion.x[i];
            race.v[axis] = motion.v[i];
            race.a[axis] = motion.a[i];
        }
    }
    race
}

/// Adds the load of one body's race to that of all, n, N.
pub(super) fn add_to_race(races: &Races, body: usize, own: [f64; 3], load: &mut DVector<f64>) {
    for (axis, value) in own.into_iter().enumerate() {
        if let Some(i) = races.of(body, axis) {
            load[i] += value;
        }
    }
}
