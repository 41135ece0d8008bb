//! Natural modes of the lumped model as `modes` prints them.

use std::collections::BTreeMap;
use std::io::Write;

use experiments::auto::Choice;
use lumped::{
    LumpedModel, NamedModes, NaturalModes, Parameter, Participation, SpeedModes, kinetic_energy,
    sensitivities, strain_energy,
};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use super::closed_form::{ClosedParameters, PARAMETERS, StatedErrorEntry};
use crate::commands::auto_choice;
use crate::error::Result;
use crate::output::{Notation, Report, Table};

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
    pub(super) auto: Option<Choice>,
    /// Of a set with parameters in closed form from its geometry: these parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) parameters: Option<ClosedParameters>,
    #[serde(skip)]
    title: String,
    /// Of the lumped model.
    #[serde(skip)]
    coordinates: usize,
    /// Whether text lists sensitivities.
    #[serde(skip)]
    details: bool,
}

/// One distinct frequency.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct ModeEntry {
    pub(crate) frequency_hz: f64,
    /// What rounding may have changed of it, Hz; above 0.005 Hz the text output shows it.
    uncertainty_hz: f64,
    /// With parameters in closed form: stated error beside FE/contact; absent for given parameters.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(super) stated_error: Option<StatedErrorEntry>,
    /// rotational, translational, planet or mixed; of a gear pair rotational, translational or coupled.
    pub(crate) mode_type: String,
    /// Its first group of modes of the model.
    #[serde(skip)]
    pub(super) group: usize,
    pub(crate) multiplicity: usize,
    participation: KindShares,
    /// Kinetic energy share by kind of body.
    kinetic_energy: BTreeMap<String, f64>,
    /// Strain energy share by family of springs.
    strain_energy: BTreeMap<String, f64>,
    /// ∂ln f/∂ln p by family of stiffnesses and inertias.
    sensitivity: BTreeMap<String, f64>,
}

/// Shares of a mode's kinetic energy by kind of motion.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct KindShares {
    pub(crate) rotational: f64,
    pub(crate) translational: f64,
    pub(crate) planet: f64,
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

impl ModesOutput {
    /// Modes of a model, none where there is none; with `details` text lists sensitivities.
    pub(crate) fn new(
        scene: &Scene,
        found: Option<(&LumpedModel, &NaturalModes)>,
        details: bool,
    ) -> Self {
        let entries = |(model, modes): (&LumpedModel, &NaturalModes)| {
            modes.named(model).iter().map(|named| entry(model, named)).collect()
        };
        Self {
            modes: found.map(entries).unwrap_or_default(),
            campbell: Vec::new(),
            auto: None,
            parameters: None,
            title: scene.title.clone(),
            coordinates: found.map_or(0, |(model, _)| model.mass.len()),
            details,
        }
    }

    /// The same with frequencies at carrier speeds, rpm.
    pub(super) fn with_campbell(self, speeds_rpm: &[f64], found: &[SpeedModes]) -> Self {
        let entry = |(rpm, at): (&f64, &SpeedModes)| CampbellEntry {
            carrier_speed_rpm: *rpm,
            frequency_hz: at.modes.iter().map(|m| m.frequency_hz).collect(),
            uncertainty_hz: at.modes.iter().map(|m| m.uncertainty_hz).collect(),
            largest_growth_per_s: at.largest_growth_per_s(),
            is_unstable: at.is_unstable(),
            growing_hz: at.growing_hz(),
        };
        Self { campbell: speeds_rpm.iter().zip(found).map(entry).collect(), ..self }
    }

    fn table<'r>(&self) -> Table<'r, &'r ModeEntry> {
        use Notation::{Fixed, Plain, Share};
        let is_mixed = self.modes.iter().any(|m| m.mode_type == "mixed");
        let is_stated = self.modes.iter().any(|m| m.stated_error.is_some());
        Table::<&ModeEntry>::new()
            .column("frequency_hz", "", |m| m.frequency_hz)
            .shown_as("Hz", |m| frequency(m))
            .key()
            .column(
                "stated_error_percent",
                "stated beside FE/contact with the inertia of the bodies, at most; – where there is no bound",
                |m| m.stated_error.as_ref().and_then(|stated| stated.percent),
            )
            .shown_if(is_stated, "error %", Fixed(2))
            .column("uncertainty_hz", "", |m| m.uncertainty_hz)
            .column("mode_type", "", |m| &m.mode_type)
            .shown("type", Plain)
            .column("multiplicity", "", |m| m.multiplicity)
            .shown("times", Plain)
            .column("rotational", "", |m| m.participation.rotational)
            .shown_if(is_mixed, "rotational", Share)
            .column("translational", "", |m| m.participation.translational)
            .shown_if(is_mixed, "translational", Share)
            .column("planet", "", |m| m.participation.planet)
            .shown_if(is_mixed, "planet", Share)
            .words("moves most", Plain, |m| largest(&m.kinetic_energy))
            .words("strained most", Plain, |m| largest(&m.strain_energy))
    }

    /// Sensitivities of each frequency by family of parameters.
    fn sensitivities(&self, out: &mut dyn Write) -> std::io::Result<()> {
        writeln!(out, "∂ln f/∂ln p: what each frequency depends on")?;
        let mut table =
            Table::<&ModeEntry>::new().words("Hz", Notation::Plain, |m| frequency(m)).right().key();
        for family in self.modes.first().into_iter().flat_map(|m| m.sensitivity.keys()) {
            let value = move |m: &&ModeEntry| m.sensitivity.get(family).copied().map(plain_zero);
            table = table.words(family, Notation::Fixed(3), value);
        }
        table.text(&self.modes, out)
    }

    /// Frequencies at carrier speeds, and how far frequencies are known.
    fn speeds(&self, out: &mut dyn Write) -> std::io::Result<()> {
        for c in &self.campbell {
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
        let mut turning = self.campbell.iter().flat_map(|c| &c.uncertainty_hz);
        if self.modes.iter().any(|m| unsure(&m.uncertainty_hz)) || turning.any(unsure) {
            let why = "stiffnesses and masses are spread so widely that rounding reaches the digits shown";
            writeln!(
                out,
                "± and <: {why}; a rigid support (`motion`) says what a huge stiffness is to say"
            )?;
        }
        Ok(())
    }
}

impl Report for ModesOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        self.table().csv(&self.modes, out)
    }

    fn text(&self, out: &mut dyn Write) -> Result<()> {
        let (title, count) = (&self.title, self.coordinates);
        match (&self.auto, &self.parameters) {
            (Some(choice), _) => {
                writeln!(out, "{title}")?;
                auto_choice::write(choice, out)?;
            }
            (None, Some(_)) => {
                writeln!(out, "{title}: lumped model, {PARAMETERS}, {count} coordinates")?
            }
            (None, None) => writeln!(out, "{title}: lumped model, {count} coordinates")?,
        }
        if self.modes.is_empty() {
            return Ok(());
        }
        self.table().text(&self.modes, out)?;
        if self.details {
            self.sensitivities(out)?;
        }
        self.speeds(out)?;
        Ok(self.table().legend(out)?)
    }
}

fn entry(model: &LumpedModel, NamedModes { name, group, first }: &NamedModes) -> ModeEntry {
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
    let Participation { rotational, translational, planet } = group.participation;
    ModeEntry {
        frequency_hz: group.frequency_hz,
        uncertainty_hz: group.uncertainty * group.frequency_hz,
        stated_error: None,
        mode_type: (*name).to_owned(),
        group: *first,
        multiplicity: group.multiplicity,
        participation: KindShares { rotational, translational, planet },
        kinetic_energy: kinetic,
        strain_energy: strain,
        sensitivity: sensitivity.collect(),
    }
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
