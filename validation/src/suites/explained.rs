//! Why the printed four-planet frequencies differ from those of the printed geometry: first the
//! pressure angles are put right, then the spacing.

use gearset::PlanetPositions;
use lumped::ModeType;
use serde::Serialize;

use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::Reference;

use super::modes_of::{frequencies, modes_of};

/// One step from the published parameters to consistent geometry.
#[derive(Debug, Clone, Serialize)]
pub struct Step {
    /// What was changed.
    pub change: &'static str,
    /// Rotational frequencies, Hz, lowest two.
    pub rotational_hz: Vec<f64>,
    /// Translational frequencies, Hz, lowest three pairs (six where split).
    pub translational_hz: Vec<f64>,
    /// Lowest planet frequency, Hz.
    pub planet_hz: Vec<f64>,
}

/// The three steps of the four-planet set.
///
/// # Errors
/// If a scene or model cannot be used.
pub fn steps() -> Result<[Step; 3], ValidationError> {
    let published = scene(PublishedScene::Oh58FourPlanetsAsPublished)?;
    let consistent = scene(PublishedScene::Oh58FourPlanets)?;
    let mut equal = consistent.clone();
    equal.planets = PlanetPositions::equally_spaced(4);
    let step = |change, scene| -> Result<Step, ValidationError> {
        let (_, modes) = modes_of(scene)?;
        let lowest = |mode_type, count: usize| {
            let mut list = frequencies(&modes, mode_type);
            list.truncate(count);
            list
        };
        let is_split = modes.of_type(ModeType::Translational).all(|g| g.multiplicity == 1);
        Ok(Step {
            change,
            rotational_hz: lowest(ModeType::Rotational, 2),
            translational_hz: lowest(ModeType::Translational, if is_split { 6 } else { 3 }),
            planet_hz: lowest(ModeType::Planet, 1),
        })
    };
    Ok([
        step("as published: 24.6° twice, equal spacing", &published)?,
        step("operating angles of Table 1: 24.60° and 20.19°", &equal)?,
        step("spacing that can be assembled: 0, -31, 63, 32 steps", &consistent)?,
    ])
}

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let [_, angles, spacing] = steps()?;
    let source = "Lin & Parker (2000): diametrical pairs keep rotational and planet modes";
    let same = |a: &[f64], b: &[f64]| {
        a.iter().zip(b).map(|(x, y)| (x / y - 1.0).abs()).fold(0.0, f64::max)
    };
    let id = "table3.explained.rotational_and_planet";
    let subject = Subject {
        id,
        title: "unequal diametrical spacing leaves rotational and planet frequencies alone",
        kind: ReferenceKind::Analytic,
        source,
        unit: "relative",
    };
    let moved = same(&angles.rotational_hz, &spacing.rotational_hz)
        .max(same(&angles.planet_hz, &spacing.planet_hz));
    let mut checks = vec![Check::number(subject, 0.0, moved, reference.tolerance(id, 0.0)?)];
    for (i, &pair) in angles.translational_hz.iter().enumerate() {
        let id = format!("table3.explained.translational_mean.{}", i + 1);
        let title = format!("unequal spacing splits translational pair {} about its place", i + 1);
        let split = spacing.translational_hz.get(2 * i..2 * i + 2);
        let mean = split.map_or(f64::NAN, |s| 0.5 * (s[0] + s[1]));
        let subject = Subject {
            id: &id,
            title: &title,
            kind: ReferenceKind::Analytic,
            source: "first-order perturbation of a double eigenvalue: opposite shifts",
            unit: "Hz",
        };
        checks.push(Check::number(subject, pair, mean, reference.tolerance(&id, pair)?));
    }
    Ok(checks)
}
