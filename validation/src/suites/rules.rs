//! Table 4 and the diametrical rule, from the phasor sums.

use std::num::NonZeroU32;

use gearset::{
    AllowedKinds, DiametricalRule, ExcitationStrengths, Scene, Spacing, diametrical_rule,
    excitation, excitation_of_scene, table4,
};

use crate::catalogue::{PublishedScene, scene};
use crate::check::{Check, ReferenceKind, Subject};
use crate::error::ValidationError;
use crate::reference::Reference;

const HARMONICS: u32 = 5;

pub(crate) fn checks(reference: &Reference) -> Result<Vec<Check>, ValidationError> {
    let paper = reference.parker.source.as_str();
    let three = strengths(&scene(PublishedScene::Oh58ThreePlanets)?)?;
    let four = strengths(&scene(PublishedScene::Oh58FourPlanets)?)?;
    let mut checks = Vec::new();
    let (published, analytic) = (ReferenceKind::Published, ReferenceKind::Analytic);

    let id = "rules.table4.three_planets";
    let title = "three planets, 27 sun teeth: harmonics 1 to 5 excite (k = 0 throughout)";
    let expected = vec!["rotational"; HARMONICS as usize];
    let found: Vec<String> = three.iter().map(|s| kinds(s.allowed())).collect();
    checks.push(Check::equal(subject(id, title, published, paper), expected, found));

    let id = "rules.diametrical.four_planets";
    let title = "four planets in diametrical pairs, 27 sun teeth: harmonics 1 to 5 do not excite";
    let expected: Vec<&str> = (1..=HARMONICS).map(|l| forbidden_by_rule(27, l)).collect();
    let found: Vec<String> = four.iter().map(|s| forbidden(s.allowed())).collect();
    checks.push(Check::equal(subject(id, title, published, paper), expected, found));

    let printed = &reference.parker.excitation.net_torque_strength;
    for (&l, &expected) in printed.harmonics.iter().zip(&printed.values) {
        let id = format!("rules.strength.four_planets.{l}");
        let title = format!("four planets: net torque strength of harmonic {l}");
        let source = "an independent phasor sum (reference/parker_2000.toml)";
        let actual = four.iter().find(|s| s.harmonic == l).map_or(f64::NAN, |s| s.net_torque);
        let tolerance = reference.tolerance(&id, expected)?;
        let subject = subject(&id, &title, ReferenceKind::OtherCode, source);
        checks.push(Check::number(subject, expected, actual, tolerance));
    }

    let id = "rules.forbidden.four_planets";
    let title = "four planets: largest strength of what the diametrical rule forbids";
    let largest = four
        .iter()
        .map(|s| match diametrical_rule(27, s.harmonic) {
            DiametricalRule::TranslationalForbidden => s.net_force_plus.max(s.net_force_minus),
            DiametricalRule::RotationalForbidden => s.net_torque,
        })
        .fold(0.0, f64::max);
    let source = "e^{i l Zs (ψ+π)} = (−1)^{l Zs} e^{i l Zs ψ}";
    let tolerance = reference.tolerance(id, 0.0)?;
    checks.push(Check::number(subject(id, title, analytic, source), 0.0, largest, tolerance));

    let id = "rules.table4.all";
    let title = "Table 4 against phasor sums, Zs 12–60, N 3–8, l 1–12: disagreements";
    let source = "geometric series of unit phasors";
    let subject_all = subject(id, title, analytic, source);
    checks.push(Check::equal(subject_all, 0.0, disagreements()));

    let id = "rules.diametrical.only_forbids";
    let title = "N = 4, Zs = 30, l = 1: Table 4 and the phasors excite no rotation, though the diametrical rule as printed would";
    let net_torque = excitation(&equal(4), 30, 1).net_torque;
    let rule = diametrical_rule(30, 1) == DiametricalRule::TranslationalForbidden;
    let expected = vec!["the rule leaves rotation open", "the phasors forbid it"];
    let found = vec![
        if rule { "the rule leaves rotation open" } else { "the rule forbids rotation" },
        if net_torque < 1e-12 { "the phasors forbid it" } else { "the phasors allow it" },
    ];
    let subject_only = subject(id, title, analytic, source);
    checks.push(Check::equal(subject_only, expected, found));
    Ok(checks)
}

fn subject<'a>(id: &'a str, title: &'a str, kind: ReferenceKind, source: &'a str) -> Subject<'a> {
    Subject { id, title, kind, source, unit: "" }
}

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

/// How often Table 4 and the phasor sums say different things.
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
