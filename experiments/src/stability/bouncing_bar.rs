//! Energy over a hundred bounces of the bar, by scheme.

use dynamics::benchmark_subjects::Scheme;
use dynamics::stability::BouncingBar;

use super::map::{Drawn, Map, MapError, MapOf, StabilityMap};

pub(super) const MAP: Map = Map {
    name: "bouncing-bar",
    about: "Energy of a bar bouncing on rigid ground, by scheme",
    meaning: "a scheme that is stable for every linear motion may still gain energy each time a contact opens",
    of: MapOf::Nothing(map),
};

const ELEMENTS: usize = 50;
const COURANT: f64 = 0.5;
const BOUNCES: usize = 100;

fn map() -> Result<StabilityMap, MapError> {
    let system =
        format!("elastic bar, {ELEMENTS} elements, {COURANT} passages of an element a step");
    let mut map = StabilityMap::of(&MAP, system, "bounce");
    let panel = "log₁₀ of energy over the first";
    let inelastic = Scheme::MoreauJean { theta: 0.5, restitution: 0.0 };
    let plain = Scheme::ALL.into_iter().chain([inelastic]).map(|s| (s, false));
    for (scheme, massless) in plain.chain([(Scheme::AverageAcceleration, true)]) {
        let found =
            BouncingBar::PUBLISHED.bounces(&scheme, massless, ELEMENTS, COURANT, BOUNCES)?;
        let of = match massless {
            true => format!("{}, end without mass", scheme.label()),
            false => scheme.label(),
        };
        // Acary (2016): the energy is kept by this scheme, for the others no value is known.
        let is_sound = scheme == Scheme::MoreauJean { theta: 0.5, restitution: 1.0 };
        let kept = is_sound.then_some(1.0);
        let quantity = format!("energy after {BOUNCES} bounces over the first");
        map.compare(&of, quantity, found.energy.last().copied(), kept);
        map.compare(&of, "largest energy over the first", found.largest_energy, kept);
        let quantity = "lower end off the closed form in two bounces, of the height of fall";
        map.compare_in("%", &of, quantity, 100.0 * found.place_error, Some(0.0));
        let points = found.energy.iter().enumerate();
        // On the ground, where the bar comes to rest, the energy is slightly negative (weight).
        let points = points.map(|(i, e)| ((i + 1) as f64, e.max(1e-3).log10()));
        map.draw(Drawn::Measured, panel, &of, points);
    }
    map.draw(Drawn::Theory, panel, "closed form", [(1.0, 0.0), (BOUNCES as f64, 0.0)]);
    Ok(map)
}
