//! Lin & Parker (1999): every frequency, type and multiplicity of the model set, N = 3 and 4.

use experiments::models::Changed;
use experiments::{ModalModel, frequencies_of};
use lumped::ModeType;
use scene::Scene;

use crate::error::ValidationError;
use crate::reference::{Frequencies, Reference};

use super::Checks;
use super::mode_lists::{by_type, signature};
use super::tables::{modes_of, planet_1_heavier};

/// `scenes`: sets of three or four planets.
pub(crate) fn checks(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let published = &reference.lin_parker;
    let mut checks = Vec::new();
    for set in scenes {
        let planets = set.planets.count();
        let (name, expected) = match planets {
            3 => ("three_planets", &published.three_planets),
            _ => ("four_planets", &published.four_planets),
        };
        let modes = modes_of(model, set)?;
        for (mode_type, list) in by_type(expected) {
            let found = frequencies_of(&modes, mode_type);
            for (i, &hz) in list.iter().enumerate() {
                let id = format!("lin_parker_1999.{name}.{}.{}", mode_type.name(), i + 1);
                let title = format!("N = {planets}, {} frequency {}", mode_type.name(), i + 1);
                let about = reference.about(&id, &title)?.source(&published.source);
                checks.push(about.number(hz, found.get(i).copied().unwrap_or(f64::NAN)));
            }
        }
        let id = format!("lin_parker_1999.{name}.types");
        let title = "types and multiplicities, by frequency";
        let about = reference.about(&id, title)?.source(&published.source);
        checks.push(about.equal(expected_signature(expected, planets), signature(&modes)));
    }
    Ok(checks)
}

/// Controls: sun meshes softened, a planet heavier.
pub(crate) fn controls(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let softened = |scene: &mut Scene| {
        if let Some(lumped) = &mut scene.lumped {
            lumped.mesh_n_per_m.sun_planet *= 0.98;
        }
    };
    let control = |what: &str, change: &dyn Fn(&mut Scene)| {
        let judged = checks(&Changed::new(model, change), scenes, reference)?;
        Ok::<_, ValidationError>(
            reference.control(&format!("lin_parker_1999.control.{what}"), &judged)?,
        )
    };
    Ok(vec![control("mesh_softened", &softened)?, control("planet_heavier", &planet_1_heavier)?])
}

/// The published frequencies in order, each with its type and multiplicity.
fn expected_signature(expected: &Frequencies, planets: usize) -> Vec<String> {
    let mut all: Vec<(f64, String)> = Vec::new();
    for (mode_type, list) in by_type(expected) {
        let multiplicity = match mode_type {
            ModeType::Translational => 2,
            ModeType::Planet => planets - 3,
            _ => 1,
        };
        let word = format!("{} ×{multiplicity}", mode_type.name());
        all.extend(list.iter().map(|&hz| (hz, word.clone())));
    }
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all.into_iter().map(|(_, word)| word).collect()
}
