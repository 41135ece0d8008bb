//! Lin & Parker (1999): every frequency, type and multiplicity of the model set, N = 3 and 4.

use lumped::ModeType;

use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::{Frequencies, Reference};

use super::modes_of::{by_type, frequencies, modes_of, signature};

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let published = &reference.lin_parker;
    let sets = [
        ("three_planets", 3, PublishedScene::LinParkerThreePlanets, &published.three_planets),
        ("four_planets", 4, PublishedScene::LinParkerFourPlanets, &published.four_planets),
    ];
    let mut checks = Vec::new();
    for (name, planets, which, expected) in sets {
        let (_, modes) = modes_of(&scene(which)?)?;
        for (mode_type, list) in by_type(expected) {
            let found = frequencies(&modes, mode_type);
            for (i, &hz) in list.iter().enumerate() {
                let id = format!("lin_parker_1999.{name}.{}.{}", mode_type.name(), i + 1);
                let title = format!("N = {planets}, {} frequency {}", mode_type.name(), i + 1);
                let subject = Subject {
                    id: &id,
                    title: &title,
                    kind: ReferenceKind::Published,
                    source: &published.source,
                    unit: "Hz",
                };
                let actual = found.get(i).copied().unwrap_or(f64::NAN);
                checks.push(Check::number(subject, hz, actual, reference.tolerance(&id, hz)?));
            }
        }
        let id = format!("lin_parker_1999.{name}.types");
        let subject = Subject {
            id: &id,
            title: "types and multiplicities, by frequency",
            kind: ReferenceKind::Published,
            source: &published.source,
            unit: "",
        };
        checks.push(Check::equal(
            subject,
            expected_signature(expected, planets),
            signature(&modes),
        ));
    }
    Ok(checks)
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
