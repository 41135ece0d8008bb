//! Section 4.2: growth of resonant peaks with torque, statement by statement, on the default scene, on
//! the one with meshes as soft as published, and on the second system.

use fe_contact::statics::Bodies;
use gearset::Scene;

use super::Lab;
use super::sweeps::under;
use crate::Profile;
use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject, Tolerance};
use crate::error::ValidationError;
use crate::suites::statements::judge;
use experiments::sweep::{Part, naturals};
use experiments::torque::{Followed, Series, follow, lowest_series, static_growth};

/// N·m: 5000 to 20000 lb-in.
const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];

const PARTS: [(&str, bool); 2] = [("sun", true), ("planet", false)];

/// A set with the resonances that are followed.
struct System<'s> {
    name: &'s str,
    /// For people.
    words: &'s str,
    scene: &'s Scene,
    bodies: &'s Bodies,
    series: &'s [Series],
}

fn systems() -> Result<[(&'static str, &'static str, Scene); 3], ValidationError> {
    Ok([
        ("default", "default scene", scene(PublishedScene::Oh58FourPlanets)?),
        (
            "published_stiffness",
            "meshes as soft as published",
            scene(PublishedScene::Oh58FourPlanetsPublishedStiffness)?,
        ),
        ("second_system", "second system", scene(PublishedScene::Oh58SecondSystem)?),
    ])
}

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let mut checks = Vec::new();
    for (name, words, scene) in systems()? {
        let bodies = Bodies::new(&scene)?;
        let missing = ValidationError::Incomplete("modes of the kinds followed");
        let series =
            lowest_series(&naturals(&scene, &bodies, under(&scene, 1130.0)?)?).ok_or(missing)?;
        let system = System { name, words, scene: &scene, bodies: &bodies, series: &series };
        checks.extend(first_peaks(lab, &system)?);
        checks.extend(all_peaks(lab, &system)?);
    }
    Ok(checks)
}

/// The lowest translational mode in l = 1 and the lowest rotational one in l = 2.
fn first_peaks(lab: &Lab<'_>, system: &System<'_>) -> Result<Vec<Check>, ValidationError> {
    let System { name, words, scene, bodies, series } = *system;
    let mut checks = Vec::new();
    let first = [series[0], series[2]];
    let found = follow(scene, bodies, &TORQUES, &first, &[Part::Sun], 1e-5)?;
    for (part, is_sun) in PARTS {
        for statement in judge(&found, is_sun).iter().filter(|s| s.asked > 0) {
            let id = format!("torque.{}.{name}.{part}", statement.name);
            let about = if statement.name == "monotonic" {
                "peaks of the lowest translational mode (l = 1) and the lowest rotational one (l = 2) grow from torque to torque"
            } else {
                "the rotational peak (l = 2) has grown more than the translational one (l = 1) since 565 N·m"
            };
            let title = format!("{words}, {part}: comparisons in which {about}");
            checks.push(counted(lab, &id, &title, statement.asked, Some(statement.holding)));
        }
    }
    let still = static_growth(scene, bodies, &TORQUES)?;
    let grown = |k: usize, kind: usize, l: usize| still[k][kind][l] / still[0][kind][l];
    let dynamic = |f: &Followed, k: usize| f.sun[k] / f.sun[0];
    let agree = (1..TORQUES.len()).filter(|k| {
        (grown(*k, 0, 2) > grown(*k, 1, 1)) == (dynamic(&found[1], *k) > dynamic(&found[0], *k))
    });
    let id = format!("torque.static_follows_dynamic.{name}");
    let title = format!(
        "{words}: torques at which the static harmonics (rotation l = 2, translation l = 1) stand in the same order of growth as the resonant peaks"
    );
    checks.push(counted(lab, &id, &title, 3, Some(agree.count())));
    Ok(checks)
}

/// Every followed resonance, in the full profile.
fn all_peaks(lab: &Lab<'_>, system: &System<'_>) -> Result<Vec<Check>, ValidationError> {
    let System { name, words, scene, bodies, series } = *system;
    let both = [Part::Sun, Part::Planet(0)];
    let found = match lab.profile {
        Profile::Quick => None,
        Profile::Full => Some(follow(scene, bodies, &TORQUES, series, &both, 1e-6)?),
    };
    let mut checks = Vec::new();
    for (part, is_sun) in PARTS {
        let asked =
            [("monotonic", 18), ("rotation_above_translation", 6), ("third_below_rotation", 6)];
        let judged = found.as_ref().map(|f| judge(f, is_sun));
        for (k, (statement, asked)) in asked.into_iter().enumerate() {
            let id = format!("torque.all.{statement}.{name}.{part}");
            let about = match k {
                0 => {
                    "six peaks (lowest translational l = 1, 3; lowest rotational l = 2, 4; third translational l = 3, 5) grow from torque to torque"
                }
                1 => {
                    "rotational peaks (l = 2, 4) have grown more than the lowest translational ones (l = 1, 3)"
                }
                _ => {
                    "third translational peaks (l = 3, 5) have grown less than the rotational ones (l = 2, 4)"
                }
            };
            let title = format!("{words}, {part}: comparisons in which {about}");
            let holding = judged.as_ref().map(|list| list[k].holding);
            checks.push(counted(lab, &id, &title, asked, holding));
        }
    }
    Ok(checks)
}

/// A published statement by the number of comparisons in which it holds.
fn counted(lab: &Lab<'_>, id: &str, title: &str, asked: usize, holding: Option<usize>) -> Check {
    let source = format!("{}, section 4.2", lab.reference.parker.source);
    let subject = Subject { id, title, kind: ReferenceKind::Published, source: &source, unit: "" };
    match holding {
        Some(holding) => Check::equal(subject, asked as f64, holding as f64),
        None => Check::not_run(subject, asked as f64, Tolerance::exact()),
    }
}
