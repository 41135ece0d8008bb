//! Why the printed four-planet frequencies differ from those of the printed geometry: first the pressure
//! angles are corrected, then the spacing.

use experiments::models::{Changed, Lumped};
use experiments::{ModalModel, NaturalMode, distinct, frequencies_of};
use gearset::PlanetPositions;
use lumped::ModeType;
use scene::Scene;
use serde::Serialize;

use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::worst::{paired, worst};

use super::Checks;
use super::tables::modes_of;

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

impl Step {
    fn new(change: &'static str, modes: &[NaturalMode]) -> Self {
        let lowest = |mode_type, count: usize| {
            let mut list = frequencies_of(modes, mode_type);
            list.truncate(count);
            list
        };
        let is_split = distinct(modes)
            .iter()
            .filter(|d| d.mode_type == ModeType::Translational)
            .all(|d| d.multiplicity == 1);
        Self {
            change,
            rotational_hz: lowest(ModeType::Rotational, 2),
            translational_hz: lowest(ModeType::Translational, if is_split { 6 } else { 3 }),
            planet_hz: lowest(ModeType::Planet, 1),
        }
    }
}

fn equally_spaced(set: &Scene) -> Scene {
    let mut equal = set.variant("equally spaced");
    equal.planets = PlanetPositions::equally_spaced(set.planets.count());
    equal
}

/// The three steps of the four-planet set.
///
/// # Errors
/// If a scene or model cannot be used.
pub fn steps() -> Result<[Step; 3], ValidationError> {
    let model = Lumped::default();
    let published = scene(PublishedScene::Oh58FourPlanetsAsPublished)?;
    let consistent = scene(PublishedScene::Oh58FourPlanets)?;
    let step = |change, scene: &Scene| {
        Ok::<_, ValidationError>(Step::new(change, &modes_of(&model, scene)?))
    };
    Ok([
        step("as published: 24.6° twice, equal spacing", &published)?,
        step("operating angles of Table 1: 24.60° and 20.19°", &equally_spaced(&consistent))?,
        step("spacing that can be assembled: 0, -31, 63, 32 steps", &consistent)?,
    ])
}

/// `scenes`: sets of diametrical pairs that are not equally spaced.
pub(crate) fn checks(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let mut checks = Vec::new();
    for set in scenes {
        let equal = Step::new("equal spacing", &modes_of(model, &equally_spaced(set))?);
        let spaced = Step::new("as it is", &modes_of(model, set)?);
        let off = |a: &[f64], b: &[f64]| worst(paired(a, b).map(|(a, b)| a / b - 1.0));
        let title = "unequal diametrical spacing leaves rotational and planet frequencies alone";
        let source = "Lin & Parker (2000): diametrical pairs keep rotational and planet modes";
        let id = "table3.explained.rotational_and_planet";
        let moved = [
            off(&equal.rotational_hz, &spaced.rotational_hz),
            off(&equal.planet_hz, &spaced.planet_hz),
        ];
        checks.push(reference.about(id, title)?.source(source).at_most(worst(moved)));
        for (i, &pair) in equal.translational_hz.iter().enumerate() {
            let id = format!("table3.explained.translational_mean.{}", i + 1);
            let title =
                format!("unequal spacing splits translational pair {} about its place", i + 1);
            let split = spaced.translational_hz.get(2 * i..2 * i + 2);
            let mean = split.map_or(f64::NAN, |s| 0.5 * (s[0] + s[1]));
            let source = "first-order perturbation of a double eigenvalue: opposite shifts";
            checks.push(reference.about(&id, &title)?.source(source).number(pair, mean));
        }
    }
    Ok(checks)
}

/// Control: a planet moved without its opposite.
pub(crate) fn controls(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let moved = |scene: &mut Scene| {
        let is_equal = scene.planets.steps.is_none();
        if let Some(psi) = scene.planets.psi_rad.get_mut(1).filter(|_| !is_equal) {
            *psi += 0.025;
        }
    };
    let judged = checks(&Changed::new(model, moved), scenes, reference)?;
    Ok(vec![reference.control("table3.explained.control.one_planet_moved", &judged)?])
}
