//! The fidelities of the ladder against bodies with every degree of freedom, whose transients are kept.

use fe_contact::statics::Bodies;
use gearset::{Fidelity, LoadCase};

use super::Lab;
use crate::Profile;
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::own_truth::FullImpulseSet;
use experiments::modal::{ImpulseSettings, impulse_test};

pub(crate) fn checks(lab: &Lab<'_>) -> Result<Vec<Check>, ValidationError> {
    let kept = &lab.reference.full_impulse;
    let mut checks = Vec::new();
    for set in &kept.set {
        let (name, scene) = match set.scene.as_str() {
            "oh58_3p" => ("three", &lab.three),
            _ => ("four", &lab.four),
        };
        let mut scene = scene.clone();
        scene.fe_contact.flank_elements = kept.flank_elements;
        let bodies = Bodies::new(&scene)?;
        let settings = ImpulseSettings::short(LoadCase::standing(kept.torque_nm), kept.position);
        let fidelities = [
            ("quasi_static", Fidelity::QuasiStatic),
            ("modal_1", Fidelity::Modal(1)),
            ("modal_4", Fidelity::Modal(4)),
            ("modal_12", Fidelity::Modal(12)),
            ("modal_30", Fidelity::Modal(30)),
        ];
        for (fidelity_name, fidelity) in fidelities {
            let titles = [
                (
                    "frequency",
                    format!(
                        "{name} planets, {fidelity_name}: natural frequencies against full, largest difference"
                    ),
                ),
                (
                    "damping",
                    format!(
                        "{name} planets, {fidelity_name}: damping ratios against full, largest difference"
                    ),
                ),
            ];
            let found = if fidelity == Fidelity::QuasiStatic || lab.profile == Profile::Full {
                scene.dynamics.fidelity = fidelity;
                let test = impulse_test(&scene, &bodies, &settings)?;
                let list: Vec<(f64, f64)> =
                    test.modes.iter().map(|m| (m.frequency_hz, m.damping_ratio)).collect();
                Some(differences(set, &list))
            } else {
                None
            };
            for (k, (what, title)) in titles.iter().enumerate() {
                let id = format!("fe.fidelity.{what}.{fidelity_name}.{name}");
                let source = format!("{}; remade by {}", kept.source, kept.command);
                let subject = Subject {
                    id: &id,
                    title,
                    kind: ReferenceKind::OwnRegression,
                    source: &source,
                    unit: "%",
                };
                let tolerance = lab.reference.tolerance(&id, 0.0)?;
                checks.push(match found {
                    Some(found) => Check::number(subject, 0.0, found[k], tolerance),
                    None => Check::not_run(subject, 0.0, tolerance),
                });
            }
        }
    }
    Ok(checks)
}

/// Largest differences in frequency and damping, percent; not a number if modes are missing.
fn differences(set: &FullImpulseSet, found: &[(f64, f64)]) -> [f64; 2] {
    if found.len() != set.frequencies_hz.len() {
        return [f64::NAN; 2];
    }
    let mut worst = [0.0f64; 2];
    for ((f, z), (full_f, full_z)) in
        found.iter().zip(set.frequencies_hz.iter().zip(&set.damping_ratios))
    {
        worst[0] = worst[0].max(100.0 * (f / full_f - 1.0).abs());
        worst[1] = worst[1].max(100.0 * (z / full_z - 1.0).abs());
    }
    worst
}
