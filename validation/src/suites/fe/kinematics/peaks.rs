//! Resonant peaks of kinematics linear about the loaded configuration against those of exact kinematics
//! at every step, which are kept.

use fe_contact::statics::{Bodies, Imperfections};

use crate::error::ValidationError;
use crate::own_truth::ExactPeak;
use crate::suites::fe::sweeps::under;
use crate::suites::{Checks, Lab};
use experiments::sweep::{
    Chain, FeModel, Memory, Part, Plan, Response, SteadySettings, run, top_of_three,
};

/// The torque of the control, N·m.
const TORQUE: f64 = 1130.0;

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let kept = &lab.reference.exact_peaks;
    let mut checks = Vec::new();
    for peak in &kept.peak {
        let name = peak.mode.replace("lowest ", "");
        let is_run = lab.runs(&id("height", &name, peak))?;
        let own = if is_run { Some(top(lab, peak)?) } else { None };
        checks.extend(judged(lab, &name, peak, own)?);
        if let Some(own) = own.filter(|_| name == "translational" && peak.torque_nm == TORQUE) {
            let mut shifted = peak.clone();
            shifted.sun.iter_mut().for_each(|a| *a *= 1.02);
            let spoilt = judged(lab, &name, &shifted, Some(own))?;
            let control = "fe.kinematics.peaks.control.record_shifted";
            checks.push(lab.reference.control(control, &spoilt)?);
        }
    }
    Ok(checks)
}

fn id(word: &str, name: &str, peak: &ExactPeak) -> String {
    format!("fe.kinematics.peaks.{word}.{name}.{}", peak.torque_nm)
}

/// Place and height of our peak, if it was run, against the kept ones.
fn judged(lab: &Lab<'_>, name: &str, kept: &ExactPeak, own: Option<(f64, f64)>) -> Checks {
    let incomplete = || ValidationError::Incomplete("peak between three speeds");
    let exact = top_of_three(kept.speeds_rpm.into_iter().zip(kept.sun)).ok_or_else(incomplete)?;
    let off = |own: f64, exact: f64| (100.0 * (own / exact - 1.0)).abs();
    let found = own.map(|own| [off(own.1, exact.1), off(own.0, exact.0)]);
    let ExactPeak { mode, harmonic, torque_nm, .. } = kept;
    let mut checks = Vec::new();
    for (which, word) in ["height", "place"].into_iter().enumerate() {
        let id = id(word, name, kept);
        let title = format!(
            "four planets, {torque_nm} N·m: {word} of the sun's peak in the {mode} mode (l = {harmonic}) against exact kinematics at every step"
        );
        checks.push(lab.about(&id, &title)?.at_most_if_run(found.map(|found| found[which])));
    }
    Ok(checks)
}

/// Place (rpm) and height of a peak between three speeds.
fn top(lab: &Lab<'_>, kept: &ExactPeak) -> Result<(f64, f64), ValidationError> {
    let response = match kept.harmonic {
        2 => Response::Rotation(Part::SUN),
        _ => Response::Translation(Part::SUN),
    };
    let bodies: &Bodies = &lab.bodies;
    let model = FeModel::new(
        &lab.four,
        bodies,
        Imperfections::default(),
        under(&lab.four, kept.torque_nm)?,
    );
    let steady = SteadySettings { tolerance: 1e-7, between_cycles: 0, ..SteadySettings::default() };
    let speeds_rpm = kept.speeds_rpm.to_vec();
    let plan = Plan {
        steady,
        chains: vec![Chain { name: "peak".into(), speeds_rpm, random_start: None }],
    };
    let found = run(&model, &plan, &Memory, &|_| ())?.complete()?;
    let own = found.states().into_iter();
    let own = top_of_three(own.map(|p| (p.case.speed_rpm, response.amplitude(p, kept.harmonic))));
    own.ok_or(ValidationError::Incomplete("peak between three speeds"))
}
