//! Types of modes with one planet heavier.

use lumped::{LumpedModel, ModeGroup, NaturalModes, tolerances_to};
use scene::Scene;

use super::changed_group::ChangedGroup;
use super::map::{Map, MapError, MapOf, StabilityMap, logarithms};

pub(super) const MAP: Map = Map {
    name: "mode-types",
    about: "Types of modes when one planet is heavier",
    meaning: "with one planet heavier than this a mode has lost its type: it is listed as mixed, and further on it is \
         shared by kinds",
    of: MapOf::Planets(map),
};

/// The planet that is made heavier.
const PLANET: usize = 0;

fn map(scene: &Scene) -> Result<StabilityMap, MapError> {
    let mut map = StabilityMap::of(
        &MAP,
        format!("{}, planet {PLANET} heavier", scene.title),
        "log₁₀ of the part by which a planet is heavier",
    );
    let model = LumpedModel::from_scene(scene)?;
    let modes = NaturalModes::of(&model)?;
    for t in tolerances_to(&model, &modes, PLANET) {
        let own = |g: &&ModeGroup| g.frequency_hz == t.frequency_hz && g.mode_type == t.mode_type;
        let count = modes.groups.iter().find(own).map_or(1, |g| g.multiplicity);
        let of = format!("{:.1} Hz ({})", t.frequency_hz, t.mode_type.name());
        // Modes that no heavier planet moves keep their type.
        if !t.pure_up_to.is_finite() || t.pure_up_to > 0.1 || t.pure_up_to < 1e-9 {
            continue;
        }
        let group = ChangedGroup {
            frequency_hz: t.frequency_hz,
            mode_type: t.mode_type,
            multiplicity: count,
            pure_up_to: t.pure_up_to,
            modes: |part| Ok(NaturalModes::of(&model.with_heavier_planet(PLANET, part)?)?),
        };
        map.compare(&of, "pure up to a planet heavier by", group.border()?, Some(t.pure_up_to));
        // Leading order ends where a planet is heavier by a tenth.
        if t.half_up_to <= 0.1 {
            let quantity =
                format!("half shared with {:.1} Hz by a planet heavier by", t.nearest_hz);
            map.compare(&of, quantity, None, Some(t.half_up_to));
        }
        let parts = || (0..=20).map(|k| 10f64.powf(-6.0 + 0.25 * f64::from(k)));
        let measured = parts().map(|part| Ok((part, group.lost(part)?)));
        let measured = measured.collect::<Result<Vec<_>, MapError>>()?;
        // Below, a share of 1 is rounding.
        let measured = measured.into_iter().filter(|(_, lost)| *lost > 1e-12);
        let theory = parts().map(|part| (part, 0.5 * (part / t.half_up_to).powi(2)));
        let theory = logarithms(theory, 0.0).filter(|(_, lost)| *lost < 0.0 && *lost > -12.0);
        let panel = "log₁₀ of the share outside the mode's kind";
        map.draw_beside(panel, &of, logarithms(measured, 0.0), theory);
    }
    Ok(map)
}
