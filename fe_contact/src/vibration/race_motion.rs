//! One body's part in the motion of all races.

use dynamics::Motion;
use gearset::Body;

use super::body::RaceMotion;
use crate::statics::Races;

/// Motion of one body's race; 0 for held coordinates.
pub(super) fn race_motion(races: &Races, motion: &Motion, body: Body) -> RaceMotion {
    let mut race = RaceMotion::default();
    for (axis, place) in races.places(body).into_iter().enumerate() {
        if let Some(i) = place {
            race.x[axis] = motion.x[i];
            race.v[axis] = motion.v[i];
            race.a[axis] = motion.a[i];
        }
    }
    race
}
