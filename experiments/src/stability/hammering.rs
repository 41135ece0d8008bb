//! Energy and place of a pair that hammers, by scheme and number of steps in a contact.

use dynamics::integrators::{IntegratorError, Scheme};
use dynamics::stability::{Hammering, HammeringPair};

use super::map::{Border, MapCurve, MapError, MapName, StabilityMap, empty};

/// The largest force is 4.2 times the static one.
const PAIR: HammeringPair = HammeringPair { landing_speed: 3.0 };
const BOUNCES: usize = 100;

/// Steps in a contact, coarse to fine. Where in a step the flanks part is a matter of chance: each number is taken at
/// [`CHANCES`] values up to the next, and the worst counts.
const STEPS: [f64; 10] = [5.0, 7.0, 10.0, 14.0, 20.0, 28.0, 40.0, 56.0, 80.0, 112.0];
const CHANCES: u32 = 12;

/// Wanted accuracy of energy and place, 1 %.
const WANTED: f64 = 0.01;

pub(super) fn map() -> Result<StabilityMap, MapError> {
    let system = format!("mass on a tooth spring, {BOUNCES} bounces, no damping");
    let mut map = empty(MapName::Hammering, system, "log₁₀ of the number of steps in a contact");
    for scheme in Scheme::ALL {
        let of = scheme.label();
        let found = STEPS.iter().map(|steps| worst(&scheme, *steps)).collect();
        let Some(worst): Option<Vec<[f64; 2]>> = takes_no_mass(found)? else {
            let quantity = "steps in a contact; it needs mass at the flank";
            map.borders.push(Border::new(of, quantity, "", None, None));
            continue;
        };
        for (which, what, panel) in [
            (0, "energy within 1 % after 100 bounces", "log₁₀ of |energy after 100 bounces − 1|"),
            (
                1,
                "place within 1 % of the height of flight over two bounces",
                "log₁₀ of the place off the closed form, of the height of flight",
            ),
        ] {
            let quantity = format!("fewest steps in a contact: {what}");
            let least = fewest(worst.iter().map(|w| w[which]));
            map.borders.push(Border::new(of.clone(), quantity, "", least, None));
            let points = STEPS.iter().zip(&worst);
            let points =
                points.map(|(n, w)| (n.log10(), w[which].max(1e-12).log10())).collect::<Vec<_>>();
            let (panel, name) = (panel.into(), of.clone());
            map.curves.push(MapCurve { panel, name, is_theory: false, is_points: false, points });
        }
        let order = order(&worst);
        let quantity = "order of convergence of the place";
        map.borders.push(Border::new(of, quantity, "", order, Some(2.0)));
    }
    Ok(map)
}

/// Largest error of the energy after all bounces and of the place over the first two.
fn worst(scheme: &Scheme, steps: f64) -> Result<[f64; 2], IntegratorError> {
    let mut worst = [0.0f64; 2];
    for chance in 0..CHANCES {
        let steps = steps * 1.4f64.powf(f64::from(chance) / f64::from(CHANCES));
        let Hammering { energy, place_error } = PAIR.hammer(scheme, steps, BOUNCES)?;
        let energy = energy.last().map_or(f64::NAN, |e| (e - 1.0).abs());
        worst = [worst[0].max(energy), worst[1].max(place_error)];
    }
    Ok(worst)
}

/// `None` for a scheme that refuses a coordinate without mass.
fn takes_no_mass<T>(found: Result<T, IntegratorError>) -> Result<Option<T>, IntegratorError> {
    match found {
        Ok(found) => Ok(Some(found)),
        Err(IntegratorError::Indefinite { .. }) => Ok(None),
        Err(other) => Err(other),
    }
}

/// The fewest steps from which on all errors are within what is wanted; `None` if the finest are not.
fn fewest(errors: impl DoubleEndedIterator<Item = f64>) -> Option<f64> {
    let fine = errors.rev().take_while(|e| *e <= WANTED).count();
    (fine > 0).then(|| STEPS[STEPS.len() - fine])
}

/// Slope of the place's error over the last five numbers of steps.
fn order(worst: &[[f64; 2]]) -> Option<f64> {
    let from = STEPS.len() - 5;
    let last = STEPS.len() - 1;
    let drop = worst[from][1] / worst[last][1];
    (drop > 0.0).then(|| drop.ln() / (STEPS[last] / STEPS[from]).ln())
}
