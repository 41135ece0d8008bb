//! Statements of the paper about its lumped frequencies of three and four planets.

use experiments::models::Changed;
use experiments::{ModalModel, frequencies_of};
use lumped::ModeType;
use scene::Scene;

use crate::error::ValidationError;
use crate::reference::Reference;
use crate::worst::{paired, worst};

use super::Checks;
use super::tables::modes_of;

/// Modes that both Table 2 and Table 3 list: type and number of rows.
const ROWS: [(ModeType, usize); 2] = [(ModeType::Translational, 3), (ModeType::Rotational, 2)];

/// `scenes`: three planets, four planets.
pub(crate) fn checks(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let [three, four] = scenes else {
        return Err(ValidationError::Incomplete("pair of scenes with three and four planets"));
    };
    let (three, four) = (modes_of(model, three)?, modes_of(model, four)?);
    let lowest = |modes, (mode_type, rows): (ModeType, usize)| {
        let mut list = frequencies_of(modes, mode_type);
        list.truncate(rows);
        list
    };
    let mut off = Vec::new();
    for row in ROWS {
        let (a, b) = (lowest(&three, row), lowest(&four, row));
        off.extend(paired(&a, &b).map(|(a, b)| 100.0 * (b / a - 1.0)));
    }
    let source = &reference.parker.source;
    let title = "translational and rotational frequencies of Tables 2 and 3 are almost the same";
    let almost = reference.about("claims.almost_equal", title)?.source(source);
    let count = |modes| frequencies_of(modes, ModeType::Planet).len() as f64;
    let title = "planet modes occur only with four or more planets: frequencies for N = 3 and 4";
    let planet = reference.about("claims.planet_modes", title)?.source(source);
    Ok(vec![
        almost.at_most(worst(off)),
        planet.equal(vec![0.0, 3.0], vec![count(&three), count(&four)]),
    ])
}

/// Control: sets of four planets with stiffer meshes.
pub(crate) fn controls(model: &dyn ModalModel, scenes: &[Scene], reference: &Reference) -> Checks {
    let stiffer = |scene: &mut Scene| {
        if let Some(lumped) = scene.lumped.as_mut().filter(|_| scene.planets.count() == 4) {
            lumped.mesh_n_per_m.sun_planet *= 2.0;
            lumped.mesh_n_per_m.ring_planet *= 2.0;
        }
    };
    let judged = checks(&Changed::new(model, stiffer), scenes, reference)?;
    Ok(vec![reference.control("claims.control.four_planets_stiffer", &judged)?])
}
