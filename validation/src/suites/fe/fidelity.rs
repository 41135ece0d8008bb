//! The fidelities against bodies with every degree of freedom, whose impulse tests are kept.

use experiments::modal::{FeMode, ImpulseSettings, impulse_test};
use scene::{Fidelity, LoadCase};

use crate::own_truth::FullImpulseSet;
use crate::published_table::Table;
use crate::suites::{Checks, Lab};
use crate::worst::{paired, worst};

/// Natural frequencies (Hz) and damping ratios that one test identified.
type Found = Vec<(f64, f64)>;

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let kept = &lab.reference.full_impulse;
    let mut checks = Vec::new();
    for set in &kept.set {
        let scene = match set.scene.as_str() {
            "oh58_3p" => &lab.three,
            _ => &lab.four,
        };
        let name = Table::of_planets(scene.planets.count()).planets();
        let mut scene = scene.clone();
        scene.fe_contact.flank_elements = kept.flank_elements;
        let settings = ImpulseSettings::short(LoadCase::standing(kept.torque_nm), kept.position);
        let fidelities = [
            ("quasi_static", Fidelity::QuasiStatic),
            ("modal_1", Fidelity::Modal(1)),
            ("modal_4", Fidelity::Modal(4)),
            ("modal_12", Fidelity::Modal(12)),
            ("modal_30", Fidelity::Modal(30)),
        ];
        for (fidelity_name, fidelity) in fidelities {
            let word = format!("{fidelity_name}.{name}");
            let mut found = None;
            if lab.runs(&format!("fe.fidelity.frequency.{word}"))? {
                scene.dynamics.fidelity = fidelity;
                let test = impulse_test(&scene, &*lab.gears.of(&scene)?, &settings)?;
                let of = |m: &FeMode| (m.frequency_hz, m.damping_ratio);
                found = Some(test.modes.iter().map(of).collect::<Found>());
            }
            checks.extend(judged(lab, &word, set, found.as_ref())?);
            if let Some(found) = found.filter(|_| word == "quasi_static.four") {
                let mut shifted = set.clone();
                shifted.frequencies_hz.iter_mut().for_each(|f| *f *= 1.01);
                let spoilt = judged(lab, &word, &shifted, Some(&found))?;
                let id = "fe.fidelity.control.record_shifted";
                checks.push(lab.reference.control(id, &spoilt)?);
            }
        }
    }
    lab.gears.drop_unused();
    Ok(checks)
}

/// Frequencies and damping ratios, if they were found, against the kept ones of full bodies.
fn judged(lab: &Lab<'_>, word: &str, full: &FullImpulseSet, found: Option<&Found>) -> Checks {
    let kept = &lab.reference.full_impulse;
    let source = format!("{}; remade by {}", kept.source, kept.command);
    let off = |own: fn(&(f64, f64)) -> f64, full: &[f64]| {
        found.map(|found| {
            let own: Vec<f64> = found.iter().map(own).collect();
            worst(paired(&own, full).map(|(own, full)| 100.0 * (own / full - 1.0)))
        })
    };
    let mut checks = Vec::new();
    for (what, words, off) in [
        ("frequency", "natural frequencies", off(|m| m.0, &full.frequencies_hz)),
        ("damping", "damping ratios", off(|m| m.1, &full.damping_ratios)),
    ] {
        let id = format!("fe.fidelity.{what}.{word}");
        let (fidelity, planets) = word.rsplit_once('.').unwrap_or((word, ""));
        let title =
            format!("{planets} planets, {fidelity}: {words} against full, largest difference");
        checks.push(lab.about(&id, &title)?.source(&source).at_most_if_run(off));
    }
    Ok(checks)
}
