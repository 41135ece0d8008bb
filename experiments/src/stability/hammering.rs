//! Energy and place of a pair that hammers, by scheme and number of steps in a contact.

use dynamics::benchmark_subjects::{IntegratorError, Scheme};
use dynamics::stability::{Hammering, HammeringPair};
use rayon::prelude::*;

use super::map::{Drawn, Map, MapError, MapOf, StabilityMap, fine_from, logarithms};

pub(super) const MAP: Map = Map {
    name: "hammering",
    about: "Energy and place of a pair that hammers under a light torque, by scheme and steps in a contact",
    meaning: "teeth that part and meet again: with fewer steps in a contact than this the motion gains or loses energy \
         that no damping and no torque accounts for",
    of: MapOf::Nothing(map),
};

/// The largest force is 4.2 times the static one.
const PAIR: HammeringPair = HammeringPair { landing_speed: 3.0 };
const BOUNCES: usize = 100;

/// Steps in a contact, coarse to fine. Errors oscillate with where in a step the flanks meet and part: each number
/// is taken at [`CHANCES`] values up to the next, and the worst counts. With a quarter of them the worst is missed
/// by a half.
const STEPS: [f64; 10] = [5.0, 7.0, 10.0, 14.0, 20.0, 28.0, 40.0, 56.0, 80.0, 112.0];
const CHANCES: u32 = 400;

/// Wanted accuracy of energy and place, 1 %.
const WANTED: f64 = 0.01;

fn map() -> Result<StabilityMap, MapError> {
    let system = format!("mass on a tooth spring, {BOUNCES} bounces, no damping");
    let mut map = StabilityMap::of(&MAP, system, "log₁₀ of the number of steps in a contact");
    for scheme in Scheme::ALL {
        let of = scheme.label();
        let found = STEPS.iter().map(|steps| worst(&scheme, *steps)).collect();
        let worst: Vec<[f64; 2]> = match found {
            // The scheme refuses a coordinate without mass.
            Err(IntegratorError::Indefinite { .. }) => {
                map.measure(of, "steps in a contact; it needs mass at the flank", None);
                continue;
            }
            found => found?,
        };
        for (which, what, panel) in [
            (
                0,
                "energy within 1 % over 100 bounces",
                "log₁₀ of the largest |energy − 1| over 100 bounces",
            ),
            (
                1,
                "place within 1 % of the height of flight over two bounces",
                "log₁₀ of the place off the closed form, of the height of flight",
            ),
        ] {
            let quantity = format!("fewest steps in a contact: {what}");
            let errors: Vec<_> = STEPS.into_iter().zip(worst.iter().map(|w| w[which])).collect();
            map.measure(&of, quantity, fine_from(&errors, WANTED));
            map.draw(Drawn::Measured, panel, &of, logarithms(errors, 1e-12));
        }
        // Slope of the place's error over the last five numbers of steps.
        let [from, last] = [STEPS.len() - 5, STEPS.len() - 1];
        let drop = worst[from][1] / worst[last][1];
        let order = (drop > 0.0).then(|| drop.ln() / (STEPS[last] / STEPS[from]).ln());
        map.compare(of, "order of convergence of the place", order, Some(2.0));
    }
    Ok(map)
}

/// Largest error of the energy over all bounces and of the place over the first two.
fn worst(scheme: &Scheme, steps: f64) -> Result<[f64; 2], IntegratorError> {
    let chance = |chance: u32| {
        let steps = steps * 1.4f64.powf(f64::from(chance) / f64::from(CHANCES));
        let Hammering { energy, place_error } = PAIR.hammer(scheme, steps, BOUNCES)?;
        // NaN is the largest of all.
        let errors = energy.iter().map(|e| (e - 1.0).abs());
        Ok([errors.max_by(f64::total_cmp).unwrap_or(f64::NAN), place_error])
    };
    let larger = |a: [f64; 2], b: [f64; 2]| {
        [0, 1].map(|i| if a[i].total_cmp(&b[i]).is_lt() { b[i] } else { a[i] })
    };
    (0..CHANCES).into_par_iter().map(chance).try_reduce(|| [0.0; 2], |a, b| Ok(larger(a, b)))
}
