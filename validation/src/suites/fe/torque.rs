//! Section 4.2: growth of resonant peaks with torque, statement by statement, on the default scene, on
//! the one with meshes as soft as published, and on the second system.

use experiments::sweep::Part;
use experiments::torque::{Followed, Series, follow, lowest_series, static_growth};
use experiments::{ModalModel, SteadyStateModel};
use gearset::Body;
use scene::Scene;

use super::sweeps::under;
use crate::catalogue::{PublishedScene, scene};
use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::lab::of_model;
use crate::suites::statements::judge;
use crate::suites::{Checks, Lab};

/// N·m: 5000 to 20000 lb-in.
pub(crate) const TORQUES: [f64; 4] = [565.0, 1130.0, 1695.0, 2260.0];

/// Statements about the first peaks: name, comparisons, what is compared.
const FIRST: [(&str, usize, &str); 2] = [
    (
        "monotonic",
        6,
        "peaks of the lowest translational mode (l = 1) and the lowest rotational one (l = 2) grow from torque to torque",
    ),
    (
        "rotation_above_translation",
        3,
        "the rotational peak (l = 2) has grown more than the translational one (l = 1) since 565 N·m",
    ),
];

/// Statements about every followed peak.
const ALL: [(&str, usize, &str); 3] = [
    (
        "monotonic",
        18,
        "six peaks (lowest translational l = 1, 3; lowest rotational l = 2, 4; third translational l = 3, 5) grow from torque to torque",
    ),
    (
        "rotation_above_translation",
        6,
        "rotational peaks (l = 2, 4) have grown more than the lowest translational ones (l = 1, 3)",
    ),
    (
        "third_below_rotation",
        6,
        "third translational peaks (l = 3, 5) have grown less than the rotational ones (l = 2, 4)",
    ),
];

/// The comparison of growth at rest with that of the peaks.
const STATIC: &str = "torques at which the static harmonics (rotation l = 2, translation l = 1) stand in the same order of growth as the resonant peaks";

/// Parts by name in ids, and whether they are the sun.
pub(super) const PARTS: [(&str, bool); 2] = [("sun", true), ("planet", false)];

/// A set with the resonances that are followed.
pub(super) struct System<'s> {
    pub(super) name: &'s str,
    /// For people.
    pub(super) words: &'s str,
    pub(super) scene: &'s Scene,
    pub(super) series: &'s [Series],
}

/// Systems by their names in ids and for people.
pub(super) const SYSTEMS: [(&str, &str, PublishedScene); 3] = [
    ("default", "default scene", PublishedScene::Oh58FourPlanets),
    (
        "published_stiffness",
        "meshes as soft as published",
        PublishedScene::Oh58FourPlanetsPublishedStiffness,
    ),
    ("second_system", "second system", PublishedScene::Oh58SecondSystem),
];

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = Vec::new();
    for (name, words, which) in SYSTEMS {
        let scene = scene(which)?;
        if !lab.runs(&format!("torque.monotonic.{name}.sun"))? {
            checks.extend(not_run(lab, name, words)?);
            continue;
        }
        let missing = ValidationError::Incomplete("modes of the kinds followed");
        let modes = lab.fe.natural_modes(&scene, &under(&scene, 1130.0)?).map_err(of_model)?;
        let series = lowest_series(&modes).ok_or(missing)?;
        let system = System { name, words, scene: &scene, series: &series };
        let found = first_peaks(&lab.fe, &system)?;
        checks.extend(first_judged(lab.reference, &system, &found, &PARTS)?);
        if name == "default" {
            let falling: Vec<Followed> = found.iter().map(reversed).collect();
            let spoilt = first_judged(lab.reference, &system, &falling, &PARTS)?;
            checks.push(lab.reference.control("torque.control.reversed", &spoilt)?);
        }
        checks.push(static_judged(lab, &system, &found)?);
        checks.extend(all_peaks(lab, &system)?);
        lab.gears.drop_unused();
    }
    Ok(checks)
}

/// The same peaks with the torques in falling order.
fn reversed(followed: &Followed) -> Followed {
    let back = |list: &[f64]| list.iter().rev().copied().collect();
    Followed {
        series: followed.series,
        speeds_rpm: back(&followed.speeds_rpm),
        sun: back(&followed.sun),
        planet: back(&followed.planet),
    }
}

/// The lowest translational mode in l = 1 and the lowest rotational one in l = 2.
pub(super) fn first_peaks(
    model: &dyn SteadyStateModel,
    system: &System<'_>,
) -> Result<Vec<Followed>, ValidationError> {
    let first = first_series(system.series);
    Ok(follow(model, system.scene, &TORQUES, &first, &[Part::SUN], 1e-5)?)
}

/// The resonances of the first peaks.
pub(super) fn first_series(series: &[Series]) -> Vec<Series> {
    series.iter().filter(|s| s.is_lowest && s.harmonic < 3).copied().collect()
}

/// Statements about the first peaks of some parts.
pub(super) fn first_judged(
    reference: &Reference,
    system: &System<'_>,
    found: &[Followed],
    parts: &[(&str, bool)],
) -> Checks {
    let System { name, words, .. } = *system;
    let mut checks = Vec::new();
    for (part, is_sun) in parts {
        for statement in judge(found, *is_sun).iter().filter(|s| s.asked > 0) {
            let id = format!("torque.{}.{name}.{part}", statement.name);
            let known = FIRST.iter().find(|f| f.0 == statement.name);
            let about = known.map_or(statement.words, |f| f.2);
            let title = format!("{words}, {part}: comparisons in which {about}");
            checks.push(counted(reference, &id, &title, statement.asked, Some(statement.holding))?);
        }
    }
    Ok(checks)
}

/// Growth of the static deflection's harmonics against that of the peaks.
fn static_judged(
    lab: &Lab<'_>,
    system: &System<'_>,
    found: &[Followed],
) -> Result<Check, ValidationError> {
    let System { name, words, scene, .. } = *system;
    let still = static_growth(scene, &*lab.gears.of(scene)?, &TORQUES)?;
    let grown = |k: usize, kind: usize, l: usize| still[k][kind][l] / still[0][kind][l];
    let dynamic = |f: &Followed, k: usize| f.sun[k] / f.sun[0];
    let agree = (1..TORQUES.len()).filter(|k| {
        (grown(*k, 0, 2) > grown(*k, 1, 1)) == (dynamic(&found[1], *k) > dynamic(&found[0], *k))
    });
    let id = format!("torque.static_follows_dynamic.{name}");
    let title = format!("{words}: {STATIC}");
    counted(lab.reference, &id, &title, 3, Some(agree.count()))
}

/// Every followed resonance, in the full profile.
fn all_peaks(lab: &Lab<'_>, system: &System<'_>) -> Checks {
    let System { name, scene, series, .. } = *system;
    let both = [Part::SUN, Part::Body(Body::Planet(0))];
    let is_run = lab.runs(&format!("torque.all.monotonic.{name}.sun"))?;
    let found =
        if is_run { Some(follow(&lab.fe, scene, &TORQUES, series, &both, 1e-6)?) } else { None };
    all_judged(lab.reference, system, found.as_deref(), &PARTS)
}

/// Statements about every followed peak of some parts; not run without peaks.
pub(super) fn all_judged(
    reference: &Reference,
    system: &System<'_>,
    found: Option<&[Followed]>,
    parts: &[(&str, bool)],
) -> Checks {
    let System { name, words, .. } = *system;
    let mut checks = Vec::new();
    for (part, is_sun) in parts {
        let judged = found.map(|f| judge(f, *is_sun));
        for (statement, asked, about) in ALL {
            let id = format!("torque.all.{statement}.{name}.{part}");
            let title = format!("{words}, {part}: comparisons in which {about}");
            let own = judged.as_ref().map(|list| list.iter().find(|s| s.name == statement));
            // A statement that was not judged counts as holding in no comparison.
            let holding = own.map(|s| s.map_or(0, |s| s.holding));
            checks.push(counted(reference, &id, &title, asked, holding)?);
        }
    }
    Ok(checks)
}

/// Checks of a system that the profile leaves out.
fn not_run(lab: &Lab<'_>, name: &str, words: &str) -> Checks {
    let mut list = Vec::new();
    for (part, _) in PARTS {
        for (statement, asked, about) in FIRST {
            let id = format!("torque.{statement}.{name}.{part}");
            list.push((id, format!("{words}, {part}: comparisons in which {about}"), asked));
        }
    }
    let id = format!("torque.static_follows_dynamic.{name}");
    list.push((id, format!("{words}: {STATIC}"), 3));
    for (part, _) in PARTS {
        for (statement, asked, about) in ALL {
            let id = format!("torque.all.{statement}.{name}.{part}");
            list.push((id, format!("{words}, {part}: comparisons in which {about}"), asked));
        }
    }
    list.iter().map(|(id, title, asked)| counted(lab.reference, id, title, *asked, None)).collect()
}

/// A published statement by the number of comparisons in which it holds.
fn counted(
    reference: &Reference,
    id: &str,
    title: &str,
    asked: usize,
    holding: Option<usize>,
) -> Result<Check, ValidationError> {
    let source = format!("{}, section 4.2", reference.parker.source);
    let about = reference.about(id, title)?.source(source);
    Ok(about.equal_if_run(asked as f64, holding.map(|h| h as f64)))
}
