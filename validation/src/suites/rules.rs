//! Table 4 and the diametrical rule, from the phasor sums.

use std::num::NonZeroU32;

use gearset::{
    AllowedKinds, DiametricalRule, ExcitationStrengths, Spacing, diametrical_rule, excitation,
    table4,
};
use scene::{Scene, excitation_of_scene};

use crate::check::Check;
use crate::error::ValidationError;
use crate::reference::Reference;
use crate::worst::worst;

use super::{Checks, Lab};

const HARMONICS: u32 = 5;

pub(crate) fn checks(lab: &Lab<'_>) -> Checks {
    let mut checks = judged(lab.reference, &lab.three, &lab.four)?;
    let mut moved = lab.four.clone();
    let steps = moved.planets.steps.as_mut().and_then(|s| s.get_mut(1));
    *steps.ok_or(ValidationError::Incomplete("assembly steps"))? += 1;
    let (sun, ring) =
        moved.teeth.and_then(|t| t.sun_ring()).ok_or(ValidationError::Incomplete("teeth"))?;
    moved.planets.psi_rad[1] += std::f64::consts::TAU / f64::from(sun + ring);
    let spoilt = judged(lab.reference, &lab.three, &moved)?;
    checks.push(lab.reference.control("rules.control.one_planet_moved", &spoilt)?);
    Ok(checks)
}

/// The rules for a set of three planets and one of four.
fn judged(reference: &Reference, three: &Scene, four: &Scene) -> Checks {
    let paper = reference.parker.source.as_str();
    let (three, four) = (strengths(three)?, strengths(four)?);
    let mut checks = Vec::new();

    let title = "three planets, 27 sun teeth: harmonics 1 to 5 excite (k = 0 throughout)";
    let expected = vec!["rotational"; HARMONICS as usize];
    let found: Vec<String> = three.iter().map(|s| kinds(s.allowed())).collect();
    let about = reference.about("rules.table4.three_planets", title)?.source(paper);
    checks.push(about.equal(expected, found));

    let title = "four planets in diametrical pairs, 27 sun teeth: harmonics 1 to 5 do not excite";
    let expected: Vec<&str> = (1..=HARMONICS).map(|l| forbidden_by_rule(27, l)).collect();
    let found: Vec<String> = four.iter().map(|s| forbidden(s.allowed())).collect();
    let about = reference.about("rules.diametrical.four_planets", title)?.source(paper);
    checks.push(about.equal(expected, found));

    let printed = &reference.parker.excitation.net_torque_strength;
    for (l, expected) in printed.rows() {
        let id = format!("rules.strength.four_planets.{l}");
        let title = format!("four planets: net torque strength of harmonic {l}");
        let actual = four.iter().find(|s| s.harmonic == l).map_or(f64::NAN, |s| s.net_torque);
        checks.push(reference.about(&id, &title)?.number(expected, actual));
    }

    let title = "four planets: largest strength of what the diametrical rule forbids";
    let strengths = four.iter().map(|s| match diametrical_rule(27, s.harmonic) {
        DiametricalRule::TranslationalForbidden => s.net_force_plus.max(s.net_force_minus),
        DiametricalRule::RotationalForbidden => s.net_torque,
    });
    let about = reference.about("rules.forbidden.four_planets", title)?;
    checks.push(about.at_most(worst(strengths)));

    let title = "Table 4 against phasor sums, Zs 12–60, N 3–8, l 1–12: disagreements";
    checks.push(reference.about("rules.table4.all", title)?.equal(0.0, disagreements()));

    let title = "N = 4, Zs = 30, l = 1: Table 4 and the phasors excite no rotation, though the diametrical rule as printed would";
    let net_torque = excitation(&equal(4), 30, 1).net_torque;
    let rule = diametrical_rule(30, 1) == DiametricalRule::TranslationalForbidden;
    let expected = vec!["the rule leaves rotation open", "the phasors forbid it"];
    let found = vec![
        if rule { "the rule leaves rotation open" } else { "the rule forbids rotation" },
        if net_torque < 1e-12 { "the phasors forbid it" } else { "the phasors allow it" },
    ];
    checks.push(reference.about("rules.diametrical.only_forbids", title)?.equal(expected, found));
    Ok(checks)
}

/// Listed rules of the scene with that id: kinds of modes that each harmonic can excite. A model of rotations alone has
/// no translational modes; the N − 1 modes of its planets against one another follow from every harmonic whose mesh
/// forces are not all in step.
pub(crate) fn beside(
    id: &str,
    scene: &Scene,
    listed: &[(usize, AllowedKinds)],
    is_torsional: bool,
    reference: &Reference,
) -> Checks {
    let highest = listed.iter().map(|(harmonic, _)| *harmonic).max().unwrap_or(0);
    // A set without teeth has no phases, and nothing to ask.
    let Some(sums) = excitation_of_scene(scene, highest as u32) else { return Ok(Vec::new()) };
    let expected = |sums: &ExcitationStrengths| match is_torsional {
        true => AllowedKinds {
            translational: false,
            planet: sums.net_torque < 1.0 - IN_STEP,
            ..sums.allowed()
        },
        false => sums.allowed(),
    };
    let words = |allowed: AllowedKinds| match kinds(allowed) {
        none if none.is_empty() => "none".to_owned(),
        some => some,
    };
    let row = |(harmonic, found): &(usize, AllowedKinds)| -> Result<Check, ValidationError> {
        let check = format!("rules.excites.{id}.{harmonic}");
        let title = format!("{}: kinds of modes that harmonic {harmonic} can excite", scene.title);
        let expected = words(expected(&sums[harmonic - 1]));
        Ok(reference.about(&check, &title)?.equal(expected, words(*found)))
    };
    listed.iter().map(row).collect()
}

/// Mesh forces whose net torque falls short of that in step by less than this part are in step.
const IN_STEP: f64 = 1e-9;

fn strengths(scene: &Scene) -> Result<Vec<ExcitationStrengths>, ValidationError> {
    excitation_of_scene(scene, HARMONICS).ok_or(ValidationError::Incomplete("teeth"))
}

fn equal(planets: u32) -> Spacing {
    Spacing::equal(NonZeroU32::new(planets).unwrap_or(NonZeroU32::MIN))
}

fn kinds(allowed: AllowedKinds) -> String {
    let all = [
        ("rotational", allowed.rotational),
        ("translational", allowed.translational),
        ("planet", allowed.planet),
    ];
    all.iter().filter(|k| k.1).map(|k| k.0).collect::<Vec<_>>().join(", ")
}

fn forbidden(allowed: AllowedKinds) -> String {
    let all = [("rotational", allowed.rotational), ("translational", allowed.translational)];
    all.iter().filter(|k| !k.1).map(|k| k.0).collect::<Vec<_>>().join(", ")
}

fn forbidden_by_rule(sun_teeth: u32, harmonic: u32) -> &'static str {
    match diametrical_rule(sun_teeth, harmonic) {
        DiametricalRule::TranslationalForbidden => "translational",
        DiametricalRule::RotationalForbidden => "rotational",
    }
}

/// Number of cases in which Table 4 and the phasor sums disagree.
fn disagreements() -> f64 {
    let mut count = 0;
    for planets in 3..=8 {
        let spacing = equal(planets);
        for sun_teeth in 12..=60 {
            for harmonic in 1..=12 {
                let by_phasors = excitation(&spacing, sun_teeth, harmonic).allowed();
                let by_table = table4(planets, sun_teeth, harmonic).map(|rule| rule.allowed());
                count += usize::from(by_table != Some(by_phasors));
            }
        }
    }
    count as f64
}
