//! A prescribed mesh stiffness of which only some harmonics are kept.
//!
//! k = k̄ (1 + ε w) with the rectangular wave w of one mesh, high while one more pair carries. Cut off after harmonic
//! H it is k̄ (1 + ε w_H). Near the hand-over w_H overshoots by 8.95 % of the jump however many harmonics are kept
//! (Gibbs).

use std::f64::consts::TAU;

use dynamics::c64;
use lumped::MeshWave;

use super::map::{Drawn, Map, MapError, MapOf, StabilityMap, fine_from};

pub(super) const MAP: Map = Map {
    name: "truncated-stiffness",
    about: "Mesh stiffness cut off after some harmonics",
    meaning: "a mesh stiffness of some harmonics only has no hand-over between tooth pairs: resonances of the harmonics \
         left out are missing",
    of: MapOf::Nothing(map),
};

/// A contact ratio of which no harmonic up to [`MOST`] vanishes.
const WAVE: MeshWave = MeshWave { contact_ratio: 1.618, phase: 0.0 };

/// Half of the peak-to-peak variation over the mean stiffness: that of spur gears, and one at which theory holds.
const VARIATION: f64 = 0.2;
const SMALL: f64 = 0.01;

/// Harmonics of the deflection, and most harmonics of the stiffness.
const OF_DEFLECTION: [u32; 4] = [1, 2, 3, 5];
const MOST: u32 = 40;

/// Samples of a cycle: 1/(1 + ε w_H) is smooth and its harmonics beyond 1,000 are rounding.
const SAMPLES: u32 = 1 << 12;

/// An error of a harmonic that counts, 1 %.
const WANTED: f64 = 0.01;

fn map() -> Result<StabilityMap, MapError> {
    let system = format!(
        "one mesh of rectangular stiffness, contact ratio {}, variation ε = {VARIATION}",
        WAVE.contact_ratio
    );
    let axis = "harmonics of the stiffness that are kept";
    let mut map = StabilityMap::of(&MAP, system, axis);
    for l in OF_DEFLECTION {
        let of = format!("harmonic {l} of the deflection");
        let errors = (0..=MOST).map(|h| (f64::from(h), error(l, h, VARIATION)));
        let errors: Vec<_> = errors.collect();
        let quantity = "harmonics of the stiffness from which on it is within 1 %";
        map.measure(&of, quantity, fine_from(&errors, WANTED));
        for (kept, what) in [(l - 1, "one fewer than it"), (l, "as many")] {
            let quantity = format!("part of it that is missing with {what}, ε = {SMALL}");
            map.compare(&of, quantity, error(l, kept, SMALL), Some(first_order(l, kept, SMALL)));
        }
        let points = errors.into_iter().map(|(h, off)| (h, off.max(1e-8).log10()));
        let panel = "log₁₀ of the part of a harmonic of the deflection that is wrong";
        map.draw(Drawn::Measured, panel, &of, points);
    }
    let (of, quantity) = ("hand-over between pairs", "overshoot of the stiffness, of its jump");
    map.compare(of, quantity, overshoot(), Some(GIBBS));
    Ok(map)
}

/// Overshoot of a Fourier series beside a jump, of the jump: ∫₀^π sin x/x dx/π − ½.
const GIBBS: f64 = 0.089_489_872_236_083_6;

/// w_H at a time, cycles.
fn cut_off(kept: u32, time: f64) -> f64 {
    let one =
        |l: u32| 2.0 * (WAVE.harmonic(l) * c64::from_polar(1.0, TAU * f64::from(l) * time)).re;
    (1..=kept).map(one).sum()
}

/// Harmonic l of the deflection with the stiffness cut off, less the exact one, over the exact one.
///
/// `[eq:truncated-stiffness]` 1/(1 + ε w_H) = 1 − ε w_H + ε² w_H² − …: harmonic l of what a constant force deflects
/// is all but missing for l > H; to first order in ε nothing is left, to second order ε |(w_H²)_l/ŵ_l| of it.
/// Source: derived here.
/// Checked by: `tests/all/stability_command.rs::borders_that_have_a_closed_form_are_those_of_theory`,
/// `experiments/src/stability/truncated_stiffness.rs::the_overshoot_is_that_of_the_sine_integral`.
fn error(l: u32, kept: u32, epsilon: f64) -> f64 {
    // 1/(1 + ε w) takes two values, so that it is linear in w: its harmonics are those of w times the slope.
    let (high, low) = (2.0 * (1.0 - WAVE.high_part()), -2.0 * WAVE.high_part());
    let at = |w: f64| 1.0 / (1.0 + epsilon * w);
    let exact = WAVE.harmonic(l) * ((at(high) - at(low)) / (high - low));
    let one = |i: u32| {
        let time = f64::from(i) / f64::from(SAMPLES);
        c64::from_polar(at(cut_off(kept, time)), -TAU * f64::from(l) * time)
    };
    let found = (0..SAMPLES).map(one).sum::<c64>() / f64::from(SAMPLES);
    (found - exact).norm() / exact.norm()
}

/// The same to first order in ε: what is left out of −ε w + ε² w², with w² linear in w as it takes two values.
fn first_order(l: u32, kept: u32, epsilon: f64) -> f64 {
    let harmonic = |m: i64| {
        let size = WAVE.harmonic(m.unsigned_abs() as u32);
        if m < 0 { size.conj() } else { size }
    };
    let (l, kept) = (i64::from(l), i64::from(kept));
    let is_kept = |m: i64| m != 0 && m.abs() <= kept;
    let squared: c64 = (-kept..=kept)
        .filter(|m| is_kept(*m) && is_kept(l - m))
        .map(|m| harmonic(m) * harmonic(l - m))
        .sum();
    let linear = if l <= kept { harmonic(l) } else { c64::new(0.0, 0.0) };
    // w² = (w_high + w_low) w − w_high w_low
    let sum = 2.0 * (1.0 - WAVE.high_part()) - 2.0 * WAVE.high_part();
    let exact = harmonic(l) * (epsilon * sum - 1.0);
    (squared * epsilon - linear - exact).norm() / exact.norm()
}

/// Largest excess of the wave cut off after many harmonics over its high value, of the jump of 2.
fn overshoot() -> f64 {
    let kept = 2000;
    // The first maximum lies 1/(2H) beyond the switch.
    let at = |k: u32| cut_off(kept, f64::from(k) / 100.0 / f64::from(kept));
    let highest = (1..150).map(at).fold(f64::NEG_INFINITY, f64::max);
    (highest - 2.0 * (1.0 - WAVE.high_part())) / 2.0
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// Si(π) by the midpoint rule.
    #[test]
    fn the_overshoot_is_that_of_the_sine_integral() {
        let n = 100_000;
        let step = PI / f64::from(n);
        let si: f64 = (0..n).map(|i| (f64::from(i) + 0.5) * step).map(|x| x.sin() / x * step).sum();
        assert!((si / PI - 0.5 - GIBBS).abs() < 1e-9);
    }
}
