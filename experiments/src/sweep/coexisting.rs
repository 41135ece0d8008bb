//! Speeds at which more than one motion that attracts was found.

use super::point::SweepPoint;
use super::run::Sweep;
use super::state::Coordinate;

/// Motions are different if any harmonic of a displacement differs by more than this share of the largest of its
/// kind: steady states are found to 1e-9 of the vibration or better.
const DIFFERENT: f64 = 1e-3;

/// Speeds within this share of each other are the same.
const SAME: f64 = 1e-12;

impl Sweep {
    /// Speeds (rpm, ascending) at which chains arrived at different motions that attract.
    pub fn coexisting_rpm(&self) -> Vec<f64> {
        let points = self.points();
        let mut speeds: Vec<f64> = Vec::new();
        for pair in points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let [low, high] = [a, b].map(|p| p.state.case.speed_rpm);
            let is_new = speeds.last().is_none_or(|last| low - last > SAME * low);
            let attract = [a, b].iter().all(|p| p.repeats_after.is_some() && p.attracts.is_shown());
            if high - low <= SAME * high && attract && is_new && differ(a, b) {
                speeds.push(low);
            }
        }
        speeds
    }
}

/// Whether two motions are different. (One that repeats after several mesh cycles and the same one a cycle later have the
/// same harmonics.)
fn differ(a: &SweepPoint, b: &SweepPoint) -> bool {
    if a.repeats_after != b.repeats_after {
        return true;
    }
    // Translations, rotations: (largest difference, largest amplitude) of any harmonic from 1.
    let mut kinds = [(0.0f64, 0.0f64); 2];
    for line in &a.state.lines {
        if !Coordinate::DISPLACEMENTS.contains(&line.coordinate) || line.harmonic == 0 {
            continue;
        }
        let Some(other) = b.state.line(line.part, line.coordinate, line.harmonic) else { continue };
        let [ours, theirs] = [line, other].map(|l| {
            let (sin, cos) = l.phase_rad.sin_cos();
            [l.amplitude * cos, l.amplitude * sin]
        });
        let kind = &mut kinds[usize::from(line.coordinate == Coordinate::Rotation)];
        kind.0 = kind.0.max((ours[0] - theirs[0]).hypot(ours[1] - theirs[1]));
        kind.1 = kind.1.max(line.amplitude).max(other.amplitude);
    }
    kinds.iter().any(|(difference, largest)| *difference > DIFFERENT * largest)
}
