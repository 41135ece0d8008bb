//! `rules SCENE`.

use std::io::Write;

use gearset::{ExcitationStrengths, Spacing, Table4, diametrical_rule, excitation, table4};
use scene::SceneKind;
use schemars::JsonSchema;
use serde::Serialize;

use super::scene::degrees;
use crate::arguments::Rules;
use crate::error::{Result, unfit};
use crate::inputs::read_scene;
use crate::output::{self, Notation, Report, Table, word};

/// `rules --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct RulesOutput {
    planets: usize,
    sun_teeth: u32,
    assumption: String,
    harmonics: Vec<HarmonicRule>,
    /// Title and positions of the set.
    #[serde(skip)]
    heading: String,
    /// Whether the positions balance: Σ e^(iψ) = 0.
    #[serde(skip)]
    is_balanced: bool,
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

pub(crate) fn run(arguments: &Rules, out: &mut dyn Write, err: &mut dyn Write) -> Result<()> {
    let scene = read_scene(&arguments.scene, err)?;
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
        heading: format!(
            "{}\nplanets at {}, Z_s = {sun_teeth}",
            scene.title,
            degrees(&scene.planets)
        ),
        is_balanced: spacing.is_balanced(),
    };
    output::show(arguments.format, &result, out)
}

fn table<'r>() -> Table<'r, &'r HarmonicRule> {
    use Notation::{Plain, Share};
    Table::<&HarmonicRule>::new()
        .column("harmonic", "", |h| h.harmonic)
        .shown("l", Plain)
        .column("k", "", |h| h.k.map(|k| k as i64))
        .shown("k", Plain)
        .column("net_torque", "", |h| h.net_torque)
        .shown("net torque", Share)
        .column("net_force_plus", "", |h| h.net_force_plus)
        .shown("net force +", Share)
        .column("net_force_minus", "", |h| h.net_force_minus)
        .shown("net force −", Share)
        .column("planet", "", |h| h.planet)
        .shown("planets only", Share)
        .column("excites", "", |h| h.excites.join(" "))
        .shown_as("excites", |h| h.excites.join(", "))
        .column("printed_rule", "", |h| h.printed_rule.clone())
}

impl Report for RulesOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        table().csv(&self.harmonics, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        writeln!(out, "{}", self.heading)?;
        table().text(&self.harmonics, out)?;
        writeln!(out, "strengths from 0 (cancels) to 1 (all planets in step); {ASSUMPTION}")?;
        if !self.is_balanced {
            writeln!(
                out,
                "the planets' positions do not balance (Σ e^(iψ) ≠ 0): modes are mixed, and no harmonic is kept from any of them"
            )?;
        }
        Ok(())
    }
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
    let spoken = |rule: String| rule.replace('_', " ");
    let printed_rule = if is_equal {
        table4(planets, sun_teeth, harmonic).map(|rule| match rule {
            Table4::Neither => "neither rotational nor translational".to_owned(),
            other => spoken(word(&other)),
        })
    } else {
        spacing.is_diametrical().then(|| spoken(word(&diametrical_rule(sun_teeth, harmonic))))
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
