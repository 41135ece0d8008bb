//! Motions that attract at one speed, each listed once.

use schemars::JsonSchema;
use serde::Serialize;

use super::point::SweepPoint;
use super::run::Sweep;
use super::state::Coordinate;

/// Motions are different if any harmonic of a displacement differs by more than this share of the largest of its
/// kind: steady states are found to 1e-9 of the vibration or better.
const DIFFERENT: f64 = 1e-3;

/// Speeds within this share of each other are the same.
const SAME: f64 = 1e-12;

/// A motion that attracts, and the searches that ended on it.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AttractingMotion {
    /// Mesh cycles after which it repeats.
    pub repeats_after: usize,
    /// Chains whose search at the speed ended on it.
    pub chains: Vec<String>,
}

/// Motions that attract at one speed.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Attractors {
    /// Speed of the input member, rpm.
    pub speed_rpm: f64,
    /// The motions, in the order of the chains that found them first.
    pub motions: Vec<AttractingMotion>,
}

impl Sweep {
    /// Speeds, ascending, that several searches reached, with the different motions that attract on which these ended.
    pub fn attractors(&self) -> Vec<Attractors> {
        let points = self.by_speed();
        let is_same = |(_, a): &(_, &SweepPoint), (_, b): &(_, &SweepPoint)| {
            let [low, high] = [a, b].map(|p| p.state.case.speed_rpm);
            high - low <= SAME * high
        };
        let shared = points.chunk_by(is_same).filter(|here| here.len() > 1);
        shared
            .map(|here| {
                let mut found: Vec<(&SweepPoint, AttractingMotion)> = Vec::new();
                for (chain, point) in here {
                    let Some(repeats_after) = point.repeats_after else { continue };
                    if !point.attracts.is_shown() {
                        continue;
                    }
                    match found.iter_mut().find(|(other, _)| !differ(other, point)) {
                        Some((_, motion)) => motion.chains.push((*chain).into()),
                        None => {
                            let chains = vec![(*chain).into()];
                            found.push((point, AttractingMotion { repeats_after, chains }));
                        }
                    }
                }
                let motions = found.into_iter().map(|(_, motion)| motion).collect();
                Attractors { speed_rpm: here[0].1.state.case.speed_rpm, motions }
            })
            .collect()
    }

    /// Speeds (rpm, ascending) at which searches ended on different motions that attract.
    pub fn coexisting_rpm(&self) -> Vec<f64> {
        let several = self.attractors().into_iter().filter(|here| here.motions.len() > 1);
        several.map(|here| here.speed_rpm).collect()
    }
}

/// Whether two motions are different. (One that repeats after several mesh cycles and the same one a cycle later
/// have the same harmonics.)
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
