//! Section 4.2 of any model: its resonant peaks over torque, or the modes and steady states that they are peaks of.

use experiments::NaturalMode;
use experiments::sweep::{Coordinate, Part};
use experiments::torque::{Followed, Series, TorquePeak, lowest_series};
use gearset::Body;
use lumped::ModeType;

use super::sweeps::under;
use super::torque::{
    PARTS, SYSTEMS, System, TORQUES, all_judged, first_judged, first_peaks, first_series,
};
use crate::catalogue::{PublishedScene, scene};
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::suites::lab::of_model;
use crate::suites::{Checks, Models};
use crate::verdict::NotAsked;

/// A peak belongs to a mode if its frequency is within this part of the natural one: the range in which
/// [`experiments::torque::follow`] looks for it.
const NEAR: f64 = 0.075;

/// Torques are the same within this part: 5000 lb-in are 564.92 N m.
const SAME_TORQUE: f64 = 1e-3;

/// What the first peaks are.
const FIRST: &str = "translation in harmonic 1 near the lowest translational mode, rotation in 2 near the lowest rotational one";

/// What all peaks are.
const ALL: &str = "translation in harmonics 1 and 3 near the lowest translational mode and in 3 and 5 near the third, \
                   rotation in 2 and 4 near the lowest rotational mode";

/// Statements on a system, judged part by part on the peaks that are there. The first statements on the default scene
/// are judged on steady states where no peak answers them.
pub(crate) fn asked(
    models: &Models<'_>,
    which: PublishedScene,
    reference: &Reference,
    not_asked: &mut Vec<NotAsked>,
) -> Checks {
    let system = SYSTEMS.into_iter().find(|(.., system)| *system == which);
    let (name, words, _) = system.ok_or(ValidationError::Incomplete("place among systems"))?;
    let scene = scene(which)?;
    let listed = lowest_series(&modes(models, &scene)?);
    let series = listed.clone().unwrap_or_else(|| kept_series(reference, words));
    let system = System { name, words, scene: &scene, series: &series };
    let mut peaks = match models.peaks {
        Some(model) => model.torque_peaks(&scene).map_err(of_model)?,
        None => Vec::new(),
    };
    let turns = under(&scene, TORQUES[0])?.sun_turns;
    peaks.retain(|peak| peak.sun_turns.is_none_or(|given| given == turns));
    let (mut checks, mut lacks) = (Vec::new(), Vec::new());
    let mut lack = |part: &str, statements: &str, peaks: &str| {
        let at = "at 565, 1130, 1695 and 2260 N·m";
        let what = format!("statements on {statements} of the {part} need {peaks}, {at}");
        lacks.push((
            statements == "all peaks",
            format!("torque_peaks.csv of {}: {what}", which.id()),
        ));
    };
    for part in PARTS {
        match followed(&peaks, &first_series(&series), part.1) {
            Some(found) => checks.extend(first_judged(reference, &system, &found, &[part])?),
            None => lack(part.0, "the first peaks", FIRST),
        }
        match followed(&peaks, &series, part.1) {
            Some(found) => checks.extend(all_judged(reference, &system, Some(&found), &[part])?),
            None => lack(part.0, "all peaks", ALL),
        }
    }
    let in_time = models.in_time.filter(|_| checks.is_empty() && name == "default");
    if let (Some(model), Some(_)) = (in_time, listed) {
        match first_peaks(model, &system) {
            Err(error) if error.is_not_recorded() => {}
            found => {
                checks.extend(first_judged(reference, &system, &found?, &PARTS)?);
                lacks.retain(|(is_of_all, _)| *is_of_all);
            }
        }
    }
    // Of a system without any answer the suite says what it needs.
    if !checks.is_empty() {
        let lack = |(_, lacks)| NotAsked { suite: "torque".to_owned(), lacks };
        not_asked.extend(lacks.into_iter().map(lack));
    }
    Ok(checks)
}

/// Natural modes under the torque of the published sweeps; none of a model that does not know them.
fn modes(models: &Models<'_>, set: &scene::Scene) -> Result<Vec<NaturalMode>, ValidationError> {
    let Some(modal) = models.modal else { return Ok(Vec::new()) };
    match modal.natural_modes(set, &under(set, 1130.0)?).map_err(of_model) {
        Err(error) if error.is_not_recorded() => Ok(Vec::new()),
        modes => modes,
    }
}

/// The resonances of a system at the natural frequencies that are kept, by which peaks are told apart where the model
/// says nothing of its modes.
fn kept_series(reference: &Reference, system: &str) -> Vec<Series> {
    let kept = reference.torque_peaks.peak.iter().filter(|peak| peak.system == system);
    let series = kept.map(|peak| Series {
        mode_type: match peak.mode.ends_with("rotational") {
            true => ModeType::Rotational,
            false => ModeType::Translational,
        },
        is_lowest: peak.mode.starts_with("lowest"),
        frequency_hz: peak.frequency_hz,
        harmonic: peak.harmonic as usize,
    });
    series.collect()
}

/// The highest peak near the mode of each series at each torque, in the sun or in planet 0; `None` if one is lacking.
fn followed(peaks: &[TorquePeak], series: &[Series], is_sun: bool) -> Option<Vec<Followed>> {
    let body = if is_sun { Part::SUN } else { Part::Body(Body::Planet(0)) };
    let height = |series: &Series, torque_nm: f64| {
        let coordinate = match series.mode_type {
            ModeType::Rotational => Coordinate::Rotation,
            _ => Coordinate::Translation,
        };
        let is_near = |peak: &&TorquePeak| {
            peak.part == body
                && peak.coordinate == coordinate
                && peak.harmonic == series.harmonic
                && (peak.sun_torque_nm / torque_nm - 1.0).abs() <= SAME_TORQUE
                && (peak.frequency_hz / series.frequency_hz - 1.0).abs() <= NEAR
        };
        peaks.iter().filter(is_near).map(|peak| peak.amplitude).max_by(f64::total_cmp)
    };
    let one = |series: &Series| {
        let heights = TORQUES.iter().map(|torque| height(series, *torque));
        let heights: Vec<f64> = heights.collect::<Option<_>>()?;
        let (sun, planet) = if is_sun { (heights, Vec::new()) } else { (Vec::new(), heights) };
        Some(Followed { series: *series, speeds_rpm: Vec::new(), sun, planet })
    };
    series.iter().map(one).collect()
}
