//! Types of modes with one planet heavier.

use gearset::Scene;
use lumped::{LumpedModel, ModeGroup, NaturalModes, tolerances_to};

use super::changed_group::ChangedGroup;
use super::map::{Border, Map, MapCurve, MapError, MapOf, StabilityMap, empty};

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
    let mut map = empty(
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
            modes: &|part| Ok(NaturalModes::of(&model.with_heavier_planet(PLANET, part)?)?),
        };
        let border = group.border()?;
        let quantity = "pure up to a planet heavier by";
        map.borders.push(Border::new(of.clone(), quantity, "", border, Some(t.pure_up_to)));
        // Leading order ends where a planet is heavier by a tenth.
        if t.half_up_to <= 0.1 {
            let quantity =
                format!("half shared with {:.1} Hz by a planet heavier by", t.nearest_hz);
            map.borders.push(Border::new(of.clone(), quantity, "", None, Some(t.half_up_to)));
        }
        let mut measured = Vec::new();
        for k in 0..=20 {
            let part = 10f64.powf(-6.0 + 0.25 * f64::from(k));
            let lost = group.lost(part)?;
            // Below, a share of 1 is rounding.
            if lost > 1e-12 {
                measured.push((part.log10(), lost.log10()));
            }
        }
        let theory = |k: i32| {
            let part = 10f64.powf(-6.0 + 0.25 * f64::from(k));
            (part.log10(), (0.5 * (part / t.half_up_to).powi(2)).log10())
        };
        let theory: Vec<_> = (0..=20).map(theory).filter(|p| p.1 < 0.0 && p.1 > -12.0).collect();
        for (points, is_theory) in [(measured, false), (theory, true)] {
            let panel = "log₁₀ of the share outside the mode's kind".into();
            let (name, is_points) = (of.clone(), !is_theory);
            map.curves.push(MapCurve { panel, name, is_theory, is_points, points });
        }
    }
    Ok(map)
}
