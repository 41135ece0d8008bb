//! Too few steps in a mesh cycle: resonances off their place, harmonics taken for one another, and phasing that no
//! longer cancels.
//!
//! Of two meshes half a cycle apart the odd harmonics cancel; sampled, only if S is even.

use std::f64::consts::{PI, TAU};

use dynamics::benchmark_subjects::{Scheme, amplification};
use dynamics::c64;
use lumped::MeshWave;

use super::bisection::bisected;
use super::map::{Map, MapError, MapOf, Point, StabilityMap};

pub(super) const MAP: Map = Map {
    name: "resolution",
    about: "Too few steps in a mesh cycle: place and size of harmonics, and cancellation by phasing",
    meaning: "with fewer steps in a mesh cycle than this a harmonic resonates at the wrong speed, is taken for another, or \
         is not cancelled by planet phasing",
    of: MapOf::Nothing(map),
};

/// Steps of the default.
const STEPS: u32 = 140;

/// Contact ratio whose switches fall on steps of the default.
const CONTACT_RATIO: f64 = 1.6;

/// The first harmonic of the default steps that is more than 1 % too high.
const TOO_HIGH: u32 = 11;

/// Wanted accuracy, 1 %.
const WANTED: f64 = 0.01;

/// Harmonics over steps between which a border is sought.
const SHARES: [f64; 2] = [1e-3, 0.25];

fn map() -> Result<StabilityMap, MapError> {
    let system = "one mesh of rectangular stiffness and one mode at a harmonic of it";
    let mut map = StabilityMap::of(&MAP, system, "harmonic over steps in a mesh cycle");
    let shares = || (1..=STEPS / 4).map(|l| f64::from(l) / f64::from(STEPS));
    let percent = |(x, y): Point| (x, 100.0 * y);
    let beside = |map: &mut StabilityMap, of, measured: Vec<Point>, theory: fn(f64) -> f64| {
        let theory = shares().map(|x| (x, theory(x))).map(percent);
        map.draw_beside("error, %", of, measured.into_iter().map(percent), theory);
    };

    let theory = |share: f64| 1.0 - PI * share / (PI * share).tan();
    let of = "resonance of a harmonic";
    let found = root(|share| Ok(place(share)? - WANTED), SHARES)?;
    let exact = root(|share| Ok(theory(share) - WANTED), SHARES)?;
    map.compare(of, "harmonic over steps at which it is 1 % low", found, exact);
    let measured = shares().map(|share| Ok((share, place(share)?)));
    beside(&mut map, of, measured.collect::<Result<_, MapError>>()?, theory);

    let theory = |share: f64| PI * share / (PI * share).sin() - 1.0;
    let of = "harmonic of a stiffness that switches";
    let [one, other] = [wave(0.0), wave(0.5)];
    let size = |l: u32| one.harmonic(l).norm();
    let error = |l: u32| samples(STEPS, l, |t| one.at(t)).norm() / size(l) - 1.0;
    let (found, exact) = (error(TOO_HIGH), theory(f64::from(TOO_HIGH) / f64::from(STEPS)));
    let quantity = "harmonic 11 of 140 steps too high by";
    map.compare_in("%", of, quantity, 100.0 * found, Some(100.0 * exact));
    // Every fifth harmonic of this wave is 0.
    let measured = (1..).zip(shares()).filter(|(l, _)| size(*l) > 1e-9);
    beside(&mut map, of, measured.map(|(l, share)| (share, error(l))).collect(), theory);

    for steps in [STEPS, STEPS + 1, 4 * STEPS + 1] {
        let of = format!("two meshes half a cycle apart, {steps} steps");
        let quantity = "harmonic 1 left over, of that of one mesh";
        let sum = samples(steps, 1, |t| one.at(t) + other.at(t)).norm();
        map.compare(of, quantity, sum / size(1), Some(aliased(steps)));
    }
    Ok(map)
}

/// By how much the step lowers the speed at which a harmonic meets a mode, as a part: the mode is found whose computed
/// motion advances by 2πl/S a step.
///
/// `[eq:resonance-of-steps]` Average acceleration turns a mode's frequency ω into (2/h) atan(ωh/2). With S steps in a
/// cycle of any length harmonic l has 2πl/S a step, so that it meets the mode at y/tan y of ω, y = πl/S.
/// Source: derived here.
/// Checked by: `tests/all/stability_command.rs::borders_that_have_a_closed_form_are_those_of_theory`.
fn place(share: f64) -> Result<f64, MapError> {
    let wanted = TAU * share;
    let off = |step: f64| -> Result<f64, MapError> {
        let found = amplification(&Scheme::AverageAcceleration, step, 0.0)?;
        // The period is longer by e: the frequency is 1/(1 + e).
        Ok(step / (1.0 + found.period_error.unwrap_or(f64::NAN)) - wanted)
    };
    // Up to 1 of 4, tan(πl/S) is at most 4/π of πl/S.
    let step = root(off, [wanted, 1.3 * wanted])?.unwrap_or(f64::NAN);
    Ok(1.0 - wanted / step)
}

fn wave(phase: f64) -> MeshWave {
    // Switches in the middle between steps: no sample lies on one.
    MeshWave { contact_ratio: CONTACT_RATIO, phase: phase + 0.5 / f64::from(STEPS) }
}

/// `[eq:sampled-harmonic]` ŵ_l^S = Σ_k ŵ_(l+kS) = ŵ_l (πl/S)/sin(πl/S): harmonic l of S samples of a mesh stiffness
/// that switches between two values, at steps.
///
/// Source: derived here.
/// Checked by: `tests/all/stability_command.rs::borders_that_have_a_closed_form_are_those_of_theory`.
fn samples(steps: u32, l: u32, at: impl Fn(f64) -> f64) -> c64 {
    let one = |i: u32| {
        let t = f64::from(i) / f64::from(steps);
        c64::from_polar(at(t), -TAU * f64::from(l) * t)
    };
    (0..steps).map(one).sum::<c64>() / f64::from(steps)
}

/// Σ_k ŵ_(1+kS) of both meshes over ŵ_1, summed to where its terms are 1e-6.
fn aliased(steps: u32) -> f64 {
    let (own, s) = (wave(0.0), i64::from(steps));
    let harmonic = |l: i64| {
        let size = own.harmonic(l.unsigned_abs() as u32);
        let size = if l < 0 { size.conj() } else { size };
        // The second mesh is half a cycle on: e^{πi l}.
        if l % 2 == 0 { 2.0 * size } else { c64::new(0.0, 0.0) }
    };
    let most = 200_000 / s;
    // Pairs ±k together: the sum converges only so.
    let sum: c64 = (1..=most).map(|k| harmonic(1 + k * s) + harmonic(1 - k * s)).sum();
    sum.norm() / own.harmonic(1).norm()
}

/// Where a function that grows from below 0 crosses 0 within bounds, by bisection; `None` if it does not.
fn root(
    of: impl Fn(f64) -> Result<f64, MapError>,
    bounds: [f64; 2],
) -> Result<Option<f64>, MapError> {
    let is_found = |low: f64, high: f64| high - low <= 1e-12;
    let found = bisected(bounds, f64::midpoint, is_found, |x| Ok::<_, MapError>(of(x)? > 0.0))?;
    Ok(found.map(|[low, high]| f64::midpoint(low, high)))
}
