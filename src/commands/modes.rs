//! `modes SCENE`.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::io::Write;

use experiments::auto::{AutoModel, Choice, FrequencyQuestion, choose_frequency};
use lumped::{
    AnalyticSet, LumpedError, LumpedModel, ModeGroup, NaturalModes, Parameter, campbell,
    kinetic_energy, sensitivities, strain_energy,
};
use scene::{AutoQuantity, LoadCase, Scene, SceneKind, Verb};
use schemars::JsonSchema;
use serde::Serialize;

use crate::arguments::{Format, Modes};
use crate::error::CommandError;
use crate::output::{self, share};

use super::closed_form::{self, ClosedForm, ClosedParameters, StatedErrorEntry};
use super::working::Working;
use super::{auto_choice, needs, read_scene, refused, unfit};

/// `modes --format json`.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ModesOutput {
    /// One entry for each distinct frequency of the lumped model (and type, should two types coincide); with `auto`
    /// that with parameters in closed form. Empty where `auto` chose another model.
    pub(crate) modes: Vec<ModeEntry>,
    /// With `--carrier-speeds-rpm`: frequencies with gyroscopic terms.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    campbell: Vec<CampbellEntry>,
    /// With `fidelity = "auto"`: the settings chosen, why, and the frequency with its estimated error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    auto: Option<Choice>,
    /// Of a set with parameters in closed form from its geometry: these parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    parameters: Option<ClosedParameters>,
}

/// One distinct frequency.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ModeEntry {
    pub(crate) frequency_hz: f64,
    /// What rounding may have changed of it, Hz; above 0.005 Hz the text output shows it.
    uncertainty_hz: f64,
    /// With parameters in closed form: stated error beside FE/contact; absent for given parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    stated_error: Option<StatedErrorEntry>,
    /// rotational, translational, planet or mixed.
    pub(crate) mode_type: String,
    pub(crate) multiplicity: usize,
    participation: Shares,
    /// Kinetic energy share by kind of body.
    kinetic_energy: BTreeMap<String, f64>,
    /// Strain energy share by family of springs.
    strain_energy: BTreeMap<String, f64>,
    /// ∂ln f/∂ln p by family of stiffnesses and inertias.
    sensitivity: BTreeMap<String, f64>,
}

/// Shares of the kinds of modes.
#[derive(Debug, Serialize, JsonSchema)]
struct Shares {
    rotational: f64,
    translational: f64,
    planet: f64,
}

/// Frequencies at one carrier speed.
#[derive(Debug, Serialize, JsonSchema)]
struct CampbellEntry {
    carrier_speed_rpm: f64,
    frequency_hz: Vec<f64>,
    /// What rounding may have changed of each, Hz.
    uncertainty_hz: Vec<f64>,
    /// Largest growth rate of any mode, 1/s.
    largest_growth_per_s: f64,
    /// Whether that is above rounding.
    is_unstable: bool,
    /// Frequency of the mode that grows fastest, Hz: 0 where it does not oscillate, as the common rotation of a set
    /// that turns freely, which grows only because the equations leave out the preload of planet bearings by
    /// centrifugal forces; absent if none grows.
    #[serde(skip_serializing_if = "Option::is_none")]
    growing_hz: Option<f64>,
}

pub(crate) fn run(
    arguments: &Modes,
    out: &mut dyn Write,
    err: &mut dyn Write,
) -> Result<(), CommandError> {
    let scene = read_scene(&arguments.scene)?;
    needs::warn(&scene, err)?;
    let most = scene::SPEEDS_RPM[1];
    // Not `abs() > most`: what is no number is within nothing.
    if let Some(bad) = arguments.carrier_speeds_rpm.iter().find(|s| !(-most..=most).contains(*s)) {
        let reason = format!("{bad:?} is not a finite speed from {:e} to {most:e} rpm", -most);
        return Err(CommandError::Argument { argument: "--carrier-speeds-rpm", reason });
    }
    if arguments.details && arguments.format == Format::Json {
        let reason =
            "JSON holds the sensitivities anyway: leave it out, or take --format text".into();
        return Err(CommandError::Argument { argument: "--details", reason });
    }
    if scene.kind == SceneKind::GearPair && !arguments.carrier_speeds_rpm.is_empty() {
        let reason = "a gear pair has no carrier: leave it out".into();
        return Err(CommandError::Argument { argument: "--carrier-speeds-rpm", reason });
    }
    if arguments.parameters {
        let bare = closed_form::without_numbers(&scene);
        return in_closed_form(arguments, &bare, out);
    }
    if let Some(wanted) = scene.dynamics.auto {
        needs::require(&arguments.scene, &scene, Verb::Modes, |_| false)?;
        // No other quantity is given by this verb, which the line above refuses.
        if let AutoQuantity::NaturalFrequency { mode_type, number } = wanted.quantity {
            let case = LoadCase::of_scene(&scene);
            let case = case.map_err(|e| unfit(&arguments.scene, e.to_string()))?;
            let question = FrequencyQuestion::new(&scene, &case, mode_type, number);
            return chosen(arguments, &question, wanted.tolerance_percent, out);
        }
    }
    if scene.has_closed_forms() {
        return in_closed_form(arguments, &scene, out);
    }
    let (model, modes) = solve(&scene).map_err(|reason| unfit(&arguments.scene, reason))?;
    for warning in lumped::type_warnings(&model, &modes) {
        writeln!(err, "warning: {warning}")?;
    }
    let mut result = describe(&model, &modes);
    if !arguments.carrier_speeds_rpm.is_empty() {
        let speeds: Vec<f64> =
            arguments.carrier_speeds_rpm.iter().map(|rpm| rpm / 60.0 * TAU).collect();
        let found =
            campbell(&model, &speeds).map_err(|e| unfit(&arguments.scene, e.to_string()))?;
        let entry = |(rpm, at): (&f64, &lumped::SpeedModes)| CampbellEntry {
            carrier_speed_rpm: *rpm,
            frequency_hz: at.modes.iter().map(|m| m.frequency_hz).collect(),
            uncertainty_hz: at.modes.iter().map(|m| m.uncertainty_hz).collect(),
            largest_growth_per_s: at.largest_growth_per_s(),
            is_unstable: at.is_unstable(),
            growing_hz: at.growing_hz(),
        };
        result.campbell = arguments.carrier_speeds_rpm.iter().zip(&found).map(entry).collect();
    }
    if arguments.format == Format::Json {
        return output::json(out, &result);
    }
    writeln!(out, "{}: lumped model, {} coordinates", scene.title, model.mass.len())?;
    Ok(write_text(&result, arguments.details, out)?)
}

/// Model and modes of a scene, or why there are none.
pub(crate) fn solve(scene: &Scene) -> Result<(LumpedModel, NaturalModes), String> {
    if let Some(lack) = scene.lacks(Verb::Modes).first().filter(|lack| lack.key == "mesh") {
        return Err(format!("`{}`: {}", lack.key, lack.why));
    }
    if scene.has_closed_forms() {
        return ClosedForm::of(scene).map(|closed| (closed.set.model, closed.modes));
    }
    let model = LumpedModel::from_scene(scene).map_err(|e| e.to_string())?;
    let modes = NaturalModes::of(&model).map_err(|e| e.to_string())?;
    Ok((model, modes))
}

/// Everything about the modes, ready for output.
pub(crate) fn describe(model: &LumpedModel, modes: &NaturalModes) -> ModesOutput {
    ModesOutput {
        modes: modes.groups.iter().map(|group| entry(model, group)).collect(),
        campbell: Vec::new(),
        auto: None,
        parameters: None,
    }
}

/// The frequency that the scene names, with the cheapest settings within its tolerance; all modes of the lumped model
/// if that is chosen.
fn chosen(
    arguments: &Modes,
    question: &FrequencyQuestion<'_>,
    tolerance_percent: f64,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    let (path, scene) = (&arguments.scene, question.scene);
    if !arguments.carrier_speeds_rpm.is_empty() {
        let reason = "`dynamics.fidelity` = \"auto\" chooses settings for a set without gyroscopic terms: leave it out";
        return Err(refused("--carrier-speeds-rpm", reason));
    }
    let working = Working::new("choosing settings");
    let choice = choose_frequency(question, tolerance_percent)
        .map_err(|e| unfit(path, format!("`dynamics.fidelity` = \"auto\": {e}")))?;
    drop(working);
    let is_lumped = choice.settings.model == AutoModel::Lumped;
    let listed = is_lumped.then(|| of_auto(scene, question.case)).transpose();
    let listed = listed.map_err(|e| unfit(path, e.to_string()))?;
    let mut result = match &listed {
        Some((model, modes)) => describe(model, modes),
        None => {
            ModesOutput { modes: Vec::new(), campbell: Vec::new(), auto: None, parameters: None }
        }
    };
    if arguments.format == Format::Json {
        result.auto = Some(choice);
        return output::json(out, &result);
    }
    writeln!(out, "{}", scene.title)?;
    auto_choice::write(&choice, out)?;
    match listed {
        Some(_) => Ok(write_text(&result, arguments.details, out)?),
        None => Ok(()),
    }
}

/// Modes of a set with parameters in closed form, or these parameters.
fn in_closed_form(
    arguments: &Modes,
    scene: &Scene,
    out: &mut dyn Write,
) -> Result<(), CommandError> {
    if !arguments.carrier_speeds_rpm.is_empty() {
        let reason = "with parameters in closed form there are no gyroscopic terms: leave it out, or give numbers in [lumped], which \
                      --parameters prints";
        return Err(refused("--carrier-speeds-rpm", reason));
    }
    needs::require(&arguments.scene, scene, Verb::Modes, |_| false)?;
    let closed = ClosedForm::of(scene).map_err(|reason| unfit(&arguments.scene, reason))?;
    let parameters = closed.parameters();
    let is_text = arguments.format == Format::Text;
    if is_text && arguments.parameters {
        return Ok(parameters.write(&scene.title, out)?);
    }
    let mut result = describe(&closed.set.model, &closed.modes);
    for (mode, errors) in result.modes.iter_mut().zip(&closed.errors) {
        mode.stated_error = StatedErrorEntry::of(errors);
    }
    result.parameters = Some(parameters);
    if !is_text {
        return output::json(out, &result);
    }
    let count = closed.set.model.mass.len();
    let title = &scene.title;
    writeln!(out, "{title}: lumped model, {}, {count} coordinates", closed_form::PARAMETERS)?;
    write_text(&result, arguments.details, out)?;
    Ok(writeln!(
        out,
        "error: stated beside FE/contact with the inertia of the bodies, at most; – where there is no bound"
    )?)
}

/// The set whose parameters `auto` takes from the geometry, its modes with the inertia of the bodies behind the teeth.
fn of_auto(scene: &Scene, case: &LoadCase) -> Result<(LumpedModel, NaturalModes), LumpedError> {
    let set = AnalyticSet::new(scene, case, 0.0)?;
    let mut modes = set.modes()?;
    modes.groups.iter_mut().for_each(|group| closed_form::complete(&set, group));
    Ok((set.model, modes))
}

fn entry(model: &LumpedModel, group: &ModeGroup) -> ModeEntry {
    let mut kinetic: BTreeMap<String, f64> = BTreeMap::new();
    for energy in kinetic_energy(model, group) {
        *kinetic.entry(energy.of.kind_name().to_owned()).or_default() += energy.share;
    }
    let mut strain: BTreeMap<String, f64> = BTreeMap::new();
    for energy in strain_energy(model, group) {
        *strain.entry(energy.of.family()).or_default() += energy.share;
    }
    let sensitivity = sensitivities(model, group).into_iter().filter_map(|s| match s.parameter {
        Parameter::StiffnessFamily(name) | Parameter::InertiaFamily(name) => {
            Some((name, s.logarithmic))
        }
        _ => None,
    });
    let p = group.participation;
    ModeEntry {
        frequency_hz: group.frequency_hz,
        uncertainty_hz: group.uncertainty * group.frequency_hz,
        stated_error: None,
        mode_type: group.mode_type.name().to_owned(),
        multiplicity: group.multiplicity,
        participation: Shares {
            rotational: p.rotational,
            translational: p.translational,
            planet: p.planet,
        },
        kinetic_energy: kinetic,
        strain_energy: strain,
        sensitivity: sensitivity.collect(),
    }
}

fn write_text(result: &ModesOutput, details: bool, out: &mut dyn Write) -> std::io::Result<()> {
    let is_mixed = result.modes.iter().any(|m| m.mode_type == "mixed");
    let is_stated = result.modes.iter().any(|m| m.stated_error.is_some());
    let mut header = vec!["Hz", "type", "times"];
    let mut right = vec![0, 2];
    if is_stated {
        header.insert(1, "error %");
        right = vec![0, 1, 3];
    }
    if is_mixed {
        right.extend(header.len()..header.len() + 3);
        header.extend(["rotational", "translational", "planet"]);
    }
    header.extend(["moves most", "strained most"]);
    let mut table = output::table(&header, &right);
    for m in &result.modes {
        let mut row = vec![frequency(m), m.mode_type.clone(), m.multiplicity.to_string()];
        if is_stated {
            let percent = m.stated_error.as_ref().and_then(|stated| stated.percent);
            row.insert(1, percent.map_or("–".into(), |percent| format!("{percent:.2}")));
        }
        if is_mixed {
            let p = &m.participation;
            row.extend([p.rotational, p.translational, p.planet].map(share));
        }
        row.push(largest(&m.kinetic_energy));
        row.push(largest(&m.strain_energy));
        table.add_row(row);
    }
    writeln!(out, "{table}")?;
    if details {
        writeln!(out, "∂ln f/∂ln p: what each frequency depends on")?;
        let names: Vec<&str> = result
            .modes
            .first()
            .map(|m| m.sensitivity.keys().map(String::as_str).collect())
            .unwrap_or_default();
        let mut header = vec!["Hz"];
        header.extend(&names);
        let mut table = output::table(&header, &(0..header.len()).collect::<Vec<_>>());
        for m in &result.modes {
            let mut row = vec![frequency(m)];
            row.extend(names.iter().map(|n| format!("{:.3}", plain_zero(m.sensitivity[*n]))));
            table.add_row(row);
        }
        writeln!(out, "{table}")?;
    }
    for c in &result.campbell {
        let both = c.frequency_hz.iter().zip(&c.uncertainty_hz);
        let list: Vec<_> = both.map(|(f, u)| shown_hz(*f, *u)).collect();
        let rpm = match c.carrier_speed_rpm {
            tiny if tiny != 0.0 && tiny.abs() < 1e-3 => format!("{tiny:e}"),
            rpm => format!("{rpm}"),
        };
        writeln!(out, "carrier at {rpm} rpm: {} Hz", list.join(", "))?;
        if c.is_unstable {
            let growth = c.largest_growth_per_s;
            writeln!(out, "  unstable: a mode grows by e every {:.3} s", 1.0 / growth)?;
            if c.growing_hz == Some(0.0) {
                writeln!(
                    out,
                    "  it does not oscillate: it is the common rotation of a set that turns freely, and grows in these equations \
                     because they leave out the preload of planet bearings by centrifugal forces"
                )?;
            }
        }
    }
    let unsure = |u: &f64| *u > SHOWN_HZ;
    let mut turning = result.campbell.iter().flat_map(|c| &c.uncertainty_hz);
    if result.modes.iter().any(|m| unsure(&m.uncertainty_hz)) || turning.any(unsure) {
        let why =
            "stiffnesses and masses are spread so widely that rounding reaches the digits shown";
        writeln!(
            out,
            "± and <: {why}; a rigid support (`motion`) says what a huge stiffness is to say"
        )?;
    }
    Ok(())
}

/// Half a unit of the last digit that is printed of a frequency, Hz.
const SHOWN_HZ: f64 = 0.005;

/// The frequency of a mode as far as it is known, Hz.
fn frequency(m: &ModeEntry) -> String {
    if m.frequency_hz == 0.0 {
        "0 (rigid)".into()
    } else {
        shown_hz(m.frequency_hz, m.uncertainty_hz)
    }
}

/// A frequency as far as it is known, Hz.
fn shown_hz(f: f64, unsure: f64) -> String {
    match (f, unsure) {
        (_, u) if u <= SHOWN_HZ && f < SHOWN_HZ && u > 0.1 * f => "0.00".into(),
        (_, u) if u > 0.1 * f => format!("< {:.1e}", f + u),
        (_, u) if u > SHOWN_HZ => format!("{f:.2} ± {u:.2}"),
        (f, _) if f < 1.0 => format!("{f:.2e}"),
        _ => format!("{f:.2}"),
    }
}

/// What rounds to zero in three digits, without a sign.
fn plain_zero(x: f64) -> f64 {
    if x.abs() < 5e-4 { 0.0 } else { x }
}

/// The largest share, as `planet 62 %`.
fn largest(shares: &BTreeMap<String, f64>) -> String {
    match shares.iter().max_by(|a, b| a.1.total_cmp(b.1)) {
        Some((name, share)) if *share > 0.0 => format!("{name} {:.0} %", 100.0 * share),
        _ => "–".into(),
    }
}
