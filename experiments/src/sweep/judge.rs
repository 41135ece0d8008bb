//! Judges a sweep from its own data: which harmonics moved what, and where the peaks stand.

use gearset::ExcitationStrengths;
use lumped::ModeType;

use super::peaks::{Peak, Response, peaks};
use super::state::{Part, SteadyState};
use crate::natural_mode::NaturalMode;

/// One kind of the sun's motion in one harmonic, over a whole sweep.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Content {
    /// Harmonic l.
    pub harmonic: usize,
    /// Rotation, or translation.
    pub is_rotation: bool,
    /// Whether planet phasing lets it be.
    pub is_allowed: bool,
    /// Largest amplitude over speed, in parts of the largest of any body and harmonic in the same
    /// kind of coordinate.
    pub share: f64,
}

/// A peak with the natural frequency its harmonic meets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assigned {
    /// Of the sun or of planet 0.
    pub response: Response,
    /// The peak.
    pub peak: Peak,
    /// Nearest natural frequency of a kind that the harmonic may excite.
    pub natural: NaturalMode,
}

impl Assigned {
    /// How far l f_m at the peak is off the natural frequency, percent of it.
    pub fn off_percent(&self) -> f64 {
        100.0 * (self.peak.frequency_hz / self.natural.frequency_hz - 1.0)
    }
}

/// A motion of one kind of one part.
fn response(is_rotation: bool, part: Part) -> Response {
    if is_rotation { Response::Rotation(part) } else { Response::Translation(part) }
}

/// Largest amplitude over speed, m or rad.
fn largest(points: &[&SteadyState], response: Response, harmonic: usize) -> f64 {
    points.iter().fold(0.0f64, |a, p| a.max(response.amplitude(p, harmonic)))
}

/// Largest amplitude of any body and harmonic in rotation or translation.
fn scale(points: &[&SteadyState], is_rotation: bool, harmonics: usize) -> f64 {
    let mut parts: Vec<Part> =
        points.first().map_or(Vec::new(), |p| p.lines.iter().map(|line| line.part).collect());
    parts.dedup();
    parts.retain(|part| !matches!(part, Part::SunMesh(_) | Part::RingMesh(_)));
    let of = |part: &Part| {
        let response = response(is_rotation, *part);
        (1..=harmonics).map(|l| largest(points, response, l)).fold(0.0f64, f64::max)
    };
    parts.iter().map(of).fold(0.0f64, f64::max)
}

/// The sun's rotation and translation in every harmonic.
pub fn contents(points: &[&SteadyState], strengths: &[ExcitationStrengths]) -> Vec<Content> {
    let mut list = Vec::new();
    for is_rotation in [true, false] {
        let scale = scale(points, is_rotation, strengths.len());
        for (strength, harmonic) in strengths.iter().zip(1..) {
            let allowed = strength.allowed();
            let found = largest(points, response(is_rotation, Part::Sun), harmonic);
            list.push(Content {
                harmonic,
                is_rotation,
                is_allowed: if is_rotation { allowed.rotational } else { allowed.translational },
                share: found / scale,
            });
        }
    }
    list
}

/// Peaks of the sun's and planet 0's motion in harmonics 1…`harmonics` that stand out by `least`;
/// rounding has peaks too, so those below 1e-6 of the largest motion of any body do not count.
fn prominent(points: &[&SteadyState], harmonics: usize, least: f64) -> Vec<(Response, Vec<Peak>)> {
    let mut list = Vec::new();
    for is_rotation in [true, false] {
        let scale = scale(points, is_rotation, harmonics);
        for part in [Part::Sun, Part::Planet(0)] {
            let response = response(is_rotation, part);
            let all = (1..=harmonics).flat_map(|l| peaks(points, response, l, least));
            list.push((response, all.filter(|p| p.amplitude > 1e-6 * scale).collect()));
        }
    }
    list
}

/// Speeds about every peak of the sun and of planet 0 that stands out by `least` (ratio), ascending: `count` even
/// ones to either side, up to `span` (parts of the speed). Peaks nearer than that share theirs.
pub fn peak_speeds(
    points: &[&SteadyState],
    harmonics: usize,
    least: f64,
    span: f64,
    count: usize,
) -> Vec<f64> {
    let around = |centre: &f64| {
        let at = |i: usize| 2.0 * i as f64 / (count.max(2) - 1) as f64 - 1.0;
        (0..count).map(|i| centre * (1.0 + span * at(i))).collect::<Vec<f64>>()
    };
    let centres = peak_centres(points, harmonics, least, span);
    let mut speeds: Vec<f64> = centres.iter().flat_map(around).collect();
    speeds.sort_by(f64::total_cmp);
    speeds
}

/// Speeds of those peaks themselves.
pub(super) fn peak_centres(
    points: &[&SteadyState],
    harmonics: usize,
    least: f64,
    span: f64,
) -> Vec<f64> {
    let found = prominent(points, harmonics, least);
    let mut centres: Vec<f64> =
        found.iter().flat_map(|(_, list)| list.iter().map(|p| p.speed_rpm)).collect();
    centres.sort_by(f64::total_cmp);
    centres.dedup_by(|b, a| *b < *a * (1.0 + span));
    centres
}

/// Peaks of the sun and of planet 0 that stand out by `least`, each with the mode its harmonic meets.
///
/// A resonance of one harmonic turns the meshes' stiffness over with the motion it makes and so
/// shows in other harmonics too, at the same speed: of peaks of one quantity within 3 % of speed only
/// that of the harmonic which moves most is kept.
pub fn assigned(
    points: &[&SteadyState],
    strengths: &[ExcitationStrengths],
    naturals: &[NaturalMode],
    least: f64,
) -> Vec<Assigned> {
    let mut list: Vec<Assigned> = Vec::new();
    for (response, own) in prominent(points, strengths.len(), least) {
        let is_strongest = |peak: &Peak| {
            own.iter().all(|other| {
                other.amplitude <= peak.amplitude
                    || (other.speed_rpm / peak.speed_rpm - 1.0).abs() > 0.03
            })
        };
        for peak in own.iter().filter(|p| is_strongest(p)) {
            let allowed = strengths[peak.harmonic - 1].allowed();
            let is_met = |n: &&NaturalMode| match n.mode_type {
                ModeType::Rotational => allowed.rotational,
                ModeType::Translational => allowed.translational,
                ModeType::Planet => allowed.planet,
                ModeType::Mixed => true,
            };
            let distance = |n: &NaturalMode| (n.frequency_hz / peak.frequency_hz).ln().abs();
            let nearest =
                naturals.iter().filter(is_met).min_by(|a, b| distance(a).total_cmp(&distance(b)));
            if let Some(natural) = nearest {
                list.push(Assigned { response, peak: *peak, natural: *natural });
            }
        }
    }
    list
}
