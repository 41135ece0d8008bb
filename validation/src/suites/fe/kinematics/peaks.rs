//! Resonant peaks of kinematics linear about the loaded configuration against those of exact kinematics
//! at every step, which are kept.

use fe_contact::statics::{Bodies, Imperfections};

use super::at_most;
use crate::Profile;
use crate::check::Check;
use crate::error::ValidationError;
use crate::own_truth::ExactPeak;
use crate::suites::fe::Lab;
use crate::suites::fe::sweeps::under;
use experiments::sweep::{
    Chain, FeModel, Memory, Part, Plan, Response, SteadySettings, run, top_of_three,
};

/// The torque of the quick profile, N·m.
const TORQUE: f64 = 1130.0;

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let kept = &lab.reference.exact_peaks;
    let mut checks = Vec::new();
    for peak in &kept.peak {
        let is_run = peak.torque_nm == TORQUE || lab.profile == Profile::Full;
        let found = if is_run { Some(differences(lab, peak)?) } else { None };
        let ExactPeak { mode, harmonic, torque_nm, .. } = peak;
        let name = mode.replace("lowest ", "");
        for (which, word) in ["height", "place"].into_iter().enumerate() {
            let id = format!("fe.kinematics.peaks.{word}.{name}.{torque_nm}");
            let title = format!(
                "four planets, {torque_nm} N·m: {word} of the sun's peak in the {mode} mode (l = {harmonic}) against exact kinematics at every step, kept as remade by {}",
                kept.command
            );
            checks.push(at_most(lab, &id, &title, "%", found.map(|found| found[which]))?);
        }
    }
    Ok(checks)
}

/// Height and place of a peak between three speeds against the kept ones, percent.
fn differences(lab: &Lab<'_>, kept: &ExactPeak) -> Result<[f64; 2], ValidationError> {
    let response = match kept.harmonic {
        2 => Response::Rotation(Part::Sun),
        _ => Response::Translation(Part::Sun),
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
    let plan = Plan { steady, chains: vec![Chain { name: "peak".into(), speeds_rpm }] };
    let found = run(&model, &plan, &Memory, &|_| ())?;
    let own = found.states().into_iter();
    let own = top_of_three(own.map(|p| (p.case.speed_rpm, response.amplitude(p, kept.harmonic))));
    let exact = top_of_three(kept.speeds_rpm.into_iter().zip(kept.sun));
    let incomplete = || ValidationError::Incomplete("peak between three speeds");
    let (own, exact) = (own.ok_or_else(incomplete)?, exact.ok_or_else(incomplete)?);
    let off = |own: f64, exact: f64| (100.0 * (own / exact - 1.0)).abs();
    Ok([off(own.1, exact.1), off(own.0, exact.0)])
}
