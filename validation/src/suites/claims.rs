//! Statements of the paper about its lumped frequencies.

use lumped::ModeType;

use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::Reference;

use super::modes_of::{frequencies, modes_of};

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let (_, three) = modes_of(&scene(PublishedScene::Oh58ThreePlanetsAsPublished)?)?;
    let (_, four) = modes_of(&scene(PublishedScene::Oh58FourPlanetsAsPublished)?)?;
    let mut largest = 0.0f64;
    for (mode_type, rows) in [(ModeType::Translational, 3), (ModeType::Rotational, 2)] {
        let (a, b) = (frequencies(&three, mode_type), frequencies(&four, mode_type));
        for (x, y) in a.iter().zip(&b).take(rows) {
            largest = largest.max(100.0 * (y / x - 1.0).abs());
        }
    }
    let subject = |id, title, unit| Subject {
        id,
        title,
        kind: ReferenceKind::Published,
        source: &reference.parker.source,
        unit,
    };
    let id = "claims.almost_equal";
    let title = "translational and rotational frequencies of Tables 2 and 3 are almost the same";
    let tolerance = reference.tolerance(id, 0.0)?;
    let almost = Check::number(subject(id, title, "%"), 0.0, largest, tolerance);
    let count = |modes| frequencies(modes, ModeType::Planet).len() as f64;
    let title = "planet modes occur only with four or more planets: frequencies for N = 3 and 4";
    let planet = Check::equal(
        subject("claims.planet_modes", title, ""),
        vec![0.0, 3.0],
        vec![count(&three), count(&four)],
    );
    Ok(vec![almost, planet])
}
