//! `rules SCENE`.

use std::io::Write;

use gearset::{
    DiametricalRule, ExcitationStrengths, Spacing, Table4, diametrical_rule, excitation, table4,
};
use scene::SceneKind;
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{Format, Rules};
use crate::error::CommandError;
use crate::output::{self, share};

use super::scene::degrees;
use super::{read_scene, unfit};

/// `rules --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct RulesOutput {
    planets: usize,
    sun_teeth: u32,
    assumption: String,
    harmonics: Vec<HarmonicRule>,
}

/// One harmonic of mesh frequency.
#[derive(Debug, Serialize, JsonSchema)]
struct HarmonicRule {
    harmonic: u32,
    /// mod(l Z_s, N), for equally spaced planets.
    k: Option<u64>,
    net_torque: f64,
    net_force_plus: f64,
    net_force_minus: f64,
    planet: f64,
    /// Kinds of modes that can be excited.
    excites: Vec<String>,
    /// What the printed table or rule says; null where none applies.
    printed_rule: Option<String>,
}

const ASSUMPTION: &str = "all planets carry the same mesh force, each at its own phase";

pub(crate) fn run(arguments: &Rules, out: &mut dyn Write) -> Result<(), CommandError> {
    let scene = read_scene(&arguments.scene)?;
    let path = &arguments.scene;
    if scene.kind != SceneKind::Planetary {
        return Err(unfit(path, "`kind` is \"gear_pair\": rules need \"planetary\""));
    }
    let sun_teeth = scene.teeth.and_then(|t| t.sun);
    let sun_teeth = sun_teeth
        .ok_or_else(|| unfit(path, "[teeth] is absent: rules need `teeth.sun` and `teeth.ring`"))?;
    let spacing = Spacing::of(&scene.planets, scene.teeth)
        .map_err(|e| unfit(path, format!("`planets`: {e}")))?;
    let harmonics = (1..=arguments.harmonics).map(|l| rule(&spacing, sun_teeth, l)).collect();
    let result = RulesOutput {
        planets: spacing.planets(),
        sun_teeth,
        assumption: ASSUMPTION.into(),
        harmonics,
    };
    if arguments.format == Format::Json {
        return output::json(out, &result);
    }
    writeln!(out, "{}", scene.title)?;
    writeln!(out, "planets at {}, Z_s = {sun_teeth}", degrees(&scene.planets))?;
    let header = ["l", "k", "net torque", "net force +", "net force −", "planets only", "excites"];
    let mut table = output::table(&header, &[0, 1, 2, 3, 4, 5]);
    for h in &result.harmonics {
        table.add_row(vec![
            h.harmonic.to_string(),
            h.k.map_or("–".into(), |k| k.to_string()),
            share(h.net_torque),
            share(h.net_force_plus),
            share(h.net_force_minus),
            share(h.planet),
            h.excites.join(", "),
        ]);
    }
    writeln!(out, "{table}")?;
    writeln!(out, "strengths from 0 (cancels) to 1 (all planets in step); {ASSUMPTION}")?;
    if !spacing.is_balanced() {
        writeln!(
            out,
            "the planets' positions do not balance (Σ e^(iψ) ≠ 0): modes are mixed, and no harmonic is kept from any of them"
        )?;
    }
    Ok(())
}

fn rule(spacing: &Spacing, sun_teeth: u32, harmonic: u32) -> HarmonicRule {
    let strengths: ExcitationStrengths = excitation(spacing, sun_teeth, harmonic);
    let allowed = strengths.allowed();
    let kinds = [
        ("rotational", allowed.rotational),
        ("translational", allowed.translational),
        ("planet", allowed.planet),
    ];
    let excites = kinds.iter().filter(|k| k.1).map(|k| k.0.to_owned()).collect();
    let planets = spacing.planets() as u32;
    let is_equal = spacing.is_equal();
    let printed_rule = if is_equal {
        table4(planets, sun_teeth, harmonic).map(|rule| {
            match rule {
                Table4::RotationalOnly => "rotational only",
                Table4::TranslationalOnly => "translational only",
                Table4::Neither => "neither rotational nor translational",
            }
            .to_owned()
        })
    } else if spacing.is_diametrical() {
        Some(
            match diametrical_rule(sun_teeth, harmonic) {
                DiametricalRule::TranslationalForbidden => "translational forbidden",
                DiametricalRule::RotationalForbidden => "rotational forbidden",
            }
            .to_owned(),
        )
    } else {
        None
    };
    HarmonicRule {
        harmonic,
        k: is_equal.then(|| u64::from(harmonic) * u64::from(sun_teeth) % u64::from(planets.max(1))),
        net_torque: strengths.net_torque,
        net_force_plus: strengths.net_force_plus,
        net_force_minus: strengths.net_force_minus,
        planet: strengths.planet,
        excites,
        printed_rule,
    }
}
