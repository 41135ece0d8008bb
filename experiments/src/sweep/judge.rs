//! Evaluation of a sweep: the sun's motion by harmonic, and resonant peaks with their natural frequencies.

use gearset::{Body, ExcitationStrengths};
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
    /// Whether planet phasing allows it.
    pub is_allowed: bool,
    /// Largest amplitude over speed, relative to the largest of any body and harmonic in the same kind of
    /// coordinate.
    pub share: f64,
}

/// A peak with the natural frequency that its harmonic excites.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Assigned {
    /// Response of the sun or of planet 0.
    pub response: Response,
    /// The peak.
    pub peak: Peak,
    /// Nearest natural frequency of a kind that the harmonic may excite.
    pub natural: NaturalMode,
}

impl Assigned {
    /// Deviation of l f_m at the peak from the natural frequency, percent of the latter.
    pub fn off_percent(&self) -> f64 {
        100.0 * (self.peak.frequency_hz / self.natural.frequency_hz - 1.0)
    }
}

/// Rotation or translation of one part.
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
            let found = largest(points, response(is_rotation, Part::SUN), harmonic);
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

/// Peaks of the sun's and planet 0's motion in harmonics 1…`harmonics` with a prominence of at least `least`.
/// Peaks below 1e-6 of the largest motion of any body are rounding and are left out.
fn prominent(points: &[&SteadyState], harmonics: usize, least: f64) -> Vec<(Response, Vec<Peak>)> {
    let mut list = Vec::new();
    for is_rotation in [true, false] {
        let scale = scale(points, is_rotation, harmonics);
        for part in [Part::SUN, Part::Body(Body::Planet(0))] {
            let response = response(is_rotation, part);
            let all = (1..=harmonics).flat_map(|l| peaks(points, response, l, least));
            list.push((response, all.filter(|p| p.amplitude > 1e-6 * scale).collect()));
        }
    }
    list
}

/// Speeds about every peak of the sun and of planet 0 with a prominence of at least `least`, ascending, rpm:
/// `count` evenly spaced ones within ±`span` (relative) of the peak. Of peaks that are nearer than `span` to
/// each other only the first is used.
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

/// Speeds of the peaks used by [`peak_speeds`], rpm.
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

/// Peaks of the sun and of planet 0 with a prominence of at least `least`, each with the mode that its
/// harmonic excites.
///
/// The large motion at a resonance of one harmonic modulates the mesh stiffness, so that other harmonics peak
/// at the same speed: of the peaks of one quantity within 3 % of speed only the one of largest amplitude is
/// kept.
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
