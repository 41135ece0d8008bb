//! What `sweep` prints and writes.

use std::io::Write;

use experiments::auto::Choice;
use experiments::sweep::{
    Attraction, Attractors, FailedPoint, InertiaError, LargestMultiplier, Line, MOST_REPEATS,
    SearchStart, SteadyMethod, SteadySettings, StepError, Sweep, SweepPoint,
};
use scene::Scene;
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::{auto_choice, turning};
use crate::error::CommandError;
use crate::output::{Notation, Report, Table};

/// A sweep as JSON.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct SweepOutput {
    /// Scene.
    scene: String,
    /// Name of the fidelity or model.
    fidelity: String,
    /// Version of the program.
    version: String,
    /// Torque on the sun, N·m.
    sun_torque_nm: f64,
    /// Steps in a mesh cycle.
    steps_per_cycle: u32,
    /// How steady states were to be found.
    method: SteadyMethod,
    /// Largest change of a steady state from cycle to cycle, over its peak-to-peak vibration.
    tolerance: f64,
    /// Largest number of mesh cycles integrated at one speed.
    most_cycles: usize,
    /// Highest harmonic.
    harmonics: usize,
    /// Cycles over which energy between harmonics is measured.
    between_cycles: usize,
    /// Points by speed, at one speed in the order of their chains. The translation that tables and figures show
    /// is √(R² + T²) of the amplitudes R and T of `radial` and `tangential` in one harmonic.
    points: Vec<ChainPoint>,
    /// Speeds (rpm) at which chains arrived at different motions that attract.
    coexisting_rpm: Vec<f64>,
    /// Speeds that several chains reached, with the motions that attract on which these ended; empty if there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    attractors: Vec<Attractors>,
    /// Speeds at which nothing could be computed, by speed.
    failed: Vec<FailedPoint>,
    /// With `fidelity = "auto"`: the settings chosen, why, and the amplitude with its estimated error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    auto: Option<Choice>,
}

/// A point with the chain that it belongs to.
#[derive(Debug, Serialize, JsonSchema)]
struct ChainPoint {
    /// Chain of the plan: `up_00`, `down_00`, `peak_00`, `random_01_00` and so on.
    chain: String,
    #[serde(flatten)]
    point: SweepPoint,
}

impl SweepOutput {
    pub(super) fn new(
        scene: &Scene,
        sun_torque_nm: f64,
        settings: &SteadySettings,
        sweep: &Sweep,
    ) -> Self {
        let point = |(chain, point): (&str, &SweepPoint)| ChainPoint {
            chain: chain.to_owned(),
            point: point.clone(),
        };
        Self {
            scene: scene.title.clone(),
            fidelity: sweep.fidelity.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            sun_torque_nm,
            steps_per_cycle: scene.dynamics.steps_per_cycle,
            tolerance: settings.tolerance,
            method: settings.method,
            most_cycles: settings.most_cycles,
            coexisting_rpm: sweep.coexisting_rpm(),
            attractors: sweep.attractors(),
            harmonics: settings.harmonics,
            between_cycles: settings.between_cycles,
            points: sweep.by_speed().into_iter().map(point).collect(),
            failed: sweep.failed_by_speed().into_iter().cloned().collect(),
            auto: None,
        }
    }

    /// The same with what `fidelity = "auto"` chose.
    pub(super) fn chosen_by(self, choice: Choice) -> Self {
        Self { auto: Some(choice), ..self }
    }

    /// The JSON file beside the table: the result without the harmonics, which the table has, and what its columns are.
    pub(super) fn sidecar(&self, scene_file: &str) -> Result<Vec<u8>, CommandError> {
        let mut value = serde_json::to_value(self)?;
        for point in value["points"].as_array_mut().into_iter().flatten() {
            if let Some(point) = point.as_object_mut() {
                point.remove("lines");
            }
        }
        value["scene_file"] = scene_file.into();
        value["columns"] = serde_json::to_value(table().list())?;
        Ok(serde_json::to_vec_pretty(&value)?)
    }

    #[cfg(feature = "parquet")]
    pub(super) fn parquet(&self) -> Result<Vec<u8>, CommandError> {
        let bytes = table().parquet("sweep", &self.harmonics());
        bytes.map_err(|e| CommandError::Output(std::io::Error::other(e)))
    }

    /// One row for each point.
    fn points(&self) -> impl Iterator<Item = Row<'_>> {
        self.points.iter().map(|ChainPoint { chain, point }| Row {
            result: self,
            chain,
            point,
            line: None,
        })
    }

    /// One row for each harmonic of each quantity; those of each body's radial, tangential and rotational displacement
    /// are followed by those of its translation.
    pub(super) fn harmonics(&self) -> Vec<Row<'_>> {
        let mut rows = Vec::new();
        for row in self.points() {
            let lines = row.point.state.with_translations().into_iter();
            rows.extend(lines.map(|line| Row { line: Some(line), ..row }));
        }
        rows
    }
}

/// A row of the table: of a point in text, of one of its harmonics in files.
pub(super) struct Row<'r> {
    result: &'r SweepOutput,
    chain: &'r str,
    point: &'r SweepPoint,
    line: Option<Line>,
}

/// The table of a sweep.
pub(super) fn table<'r>() -> Table<'r, Row<'r>> {
    use Notation::{Fixed, Plain, Power, Share};
    let case = |r: &Row<'_>| r.point.state.case;
    let line = |r: &Row<'_>| r.line.clone();
    let largest = |r: &Row<'_>| r.point.largest_multiplier.clone();
    let table = Table::new()
        .column("scene", "title of the scene", |r: &Row<'_>| &r.result.scene)
        .column("fidelity", "fidelity of the fidelity ladder", |r| &r.result.fidelity)
        .column("sun_torque_nm", "torque on the sun, N m", move |r| case(r).sun_torque_nm)
        .column("speed_rpm", "speed of the input member, rpm", move |r| case(r).speed_rpm)
        .shown("rpm", Fixed(1))
        .key()
        .column("mesh_frequency_hz", "mesh frequency, Hz", move |r| case(r).mesh_frequency_hz)
        .shown("f_m Hz", Fixed(1))
        .column("chain", "chain of the plan: up, down, about a peak, or from a random start", |r| {
            r.chain
        })
        .shown("chain", Plain)
        .key()
        .column("body", "carrier, ring, sun, planet_n, sun_mesh_n, ring_mesh_n", move |r| {
            line(r).map(|l| l.part.name())
        })
        .column("coordinate", COORDINATE, move |r| line(r).map(|l| l.coordinate.name()))
        .column(
            "harmonic",
            "harmonic of the mesh frequency; 0 is the mean, and stands beside quantities \
             without harmonics",
            move |r| line(r).map(|l| l.harmonic),
        )
        .column("amplitude", "amplitude in the unit of the next column", move |r| {
            line(r).map(|l| l.amplitude)
        })
        .column("unit", "unit", move |r| line(r).map(|l| l.coordinate.unit()))
        .column(
            "phase_rad",
            "phase of A cos(2 pi l f_m t + phase), t from position 0, rad; 0 for \
             quantities without phase",
            move |r| line(r).map(|l| l.phase_rad),
        );
    turning::with_strongest(table, |r| (&r.point.state, r.result.harmonics))
        .words("lowest N", Fixed(0), |r: &Row<'_>| r.point.lowest_force_n)
        .meaning("lowest force of any mesh during a cycle, N")
        .words("no contact", Share, |r: &Row<'_>| r.point.contact_loss)
        .meaning("largest part of the time in which a mesh carries nothing; – for never")
        .words("backside", Plain, |r: &Row<'_>| {
            r.point.backside_contact.map_or("n/a".into(), |part| Share.number(part))
        })
        .right()
        .meaning(
            "part of the time in which backside flanks of any mesh press; n/a for a model \
             without backside flanks",
        )
        .words("grazing", Fixed(3), |r: &Row<'_>| r.point.grazing_margin)
        .meaning(
            "least of lowest over mean force of the meshes that never part, near 0 of \
             which μ loses its meaning; – where all part",
        )
        .column("cycles", "mesh cycles marched", |r| r.point.cycles)
        .shown("cycles", Plain)
        .column(
            "residual",
            "change of the last two periods, with shooting from the last to the next one, \
             over the largest peak-to-peak vibration",
            |r| r.point.residual,
        )
        .shown("residual", Power(0))
        .column(
            "repeats_after",
            "mesh cycles after which the motion repeats; none up to 8: not periodic, or \
             not settled yet",
            |r| r.point.repeats_after,
        )
        .shown("repeats", Plain)
        .column(
            "attracts",
            "by_multipliers (yes), by_decay (decay, as changes were seen to fall), \
             repels (no), neutral (a multiplier of size 1), not_shown (–)",
            |r| r.point.attracts.name(),
        )
        .shown_as("attracts", |r| attracts(r.point.attracts).into())
        .column(
            "multiplier",
            "size of the largest Floquet multiplier of one period, below 1 if the motion \
             attracts; none without multipliers",
            |r| r.point.largest_multiplier(),
        )
        .shown("μ", Fixed(3))
        .column(
            "multiplier_kind",
            "fold (+1), period_doubling (−1), neimark_sacker (a complex pair): how stability \
             is lost where it becomes 1 in size, and the type of the motion that it multiplies",
            move |r| largest(r).map_or(String::new(), |m| m.kind),
        )
        .shown_as("loses it", move |r| largest(r).map_or("–".into(), |m| loses(&m)))
        .column(
            "mode_type",
            "type of the motion that it multiplies: rotational, translational, planet, \
             mixed",
            move |r| largest(r).and_then(|m| m.mode_type).unwrap_or_default(),
        )
        .column(
            "start",
            "where the search began: rest, the speed before, an unstable motion, pushed, \
             or a random start",
            |r| r.point.start.to_string(),
        )
        .column("sun_turns", "sense in which the sun turns relative to the carrier", move |r| {
            case(r).sun_turns.name()
        })
        .column("frequency_hz", "frequency of the harmonic, l f_m, Hz", move |r| {
            line(r).map(|l| l.harmonic as f64 * case(r).mesh_frequency_hz)
        })
}

/// What the column of coordinates holds.
const COORDINATE: &str = "radial, tangential (m; central bodies: towards planet 0), rotation (rad), \
             translation (m; square root of the sum of the squared amplitudes of radial \
             and tangential), force (N); with harmonic 0 alone: share (largest load share \
             of the mesh), contact_loss (part of the time without force), \
             backside_contact (part of the time in which backside flanks press), \
             lowest_force (N)";

impl Report for SweepOutput {
    fn csv(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        table().csv(self.harmonics(), out)
    }

    /// One line per speed: strongest harmonics of the sun's motion, contact, cycles and residual; then a legend,
    /// warnings, and the speeds that could not be computed.
    fn text(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let (scene, fidelity, torque) = (&self.scene, &self.fidelity, self.sun_torque_nm);
        writeln!(out, "{scene}: {fidelity}, {torque} N·m on the sun\n")?;
        if let Some(choice) = &self.auto {
            auto_choice::write(choice, out)?;
            writeln!(out)?;
        }
        table().text(self.points(), out)?;
        table().legend(out)?;
        self.remarks(out)
    }
}

impl SweepOutput {
    /// What is worth saying of some of the speeds.
    fn remarks(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let points = || self.points.iter().map(|chained| &chained.point);
        let count = |is: fn(&SweepPoint) -> bool| points().filter(|p| is(p)).count();
        let usual = self.steps_per_cycle as usize;
        let at_speeds = [
            (
                count(|p| p.contact_loss > 0.0),
                "teeth part: a mesh carries nothing for part of the time".into(),
            ),
            (
                count(|p| p.repeats_after.is_some_and(|cycles| cycles > 1)),
                format!(
                    "the motion is subharmonic: it repeats only after 2 to {MOST_REPEATS} mesh \
                     cycles, and the harmonics are those of the mean one"
                ),
            ),
            (
                count(|p| p.why_marched.is_some()),
                "shooting found no motion that attracts from the state before, or the model has \
                 no derivative of its steps: the set was marched; JSON has the reasons"
                    .into(),
            ),
            (
                count(|p| p.start == SearchStart::Unstable),
                "the march began at an unstable motion, pushed: none that attracts was found from \
                 the state before"
                    .into(),
            ),
            (
                count(|p| !p.attracts.is_shown() && p.attracts != Attraction::Neutral),
                format!(
                    "no motion that repeats after 1 to {MOST_REPEATS} mesh cycles and attracts was \
                     found within {} cycles from any start: the motion is not periodic or has not \
                     settled; see its residual",
                    self.most_cycles
                ),
            ),
            (
                points().filter(|p| p.steps_per_cycle > usual).count(),
                format!(
                    "the vibrations of the set need more than {usual} steps in a mesh cycle, and \
                     as many were taken"
                ),
            ),
            (
                count(|p| p.attracts == Attraction::Neutral),
                "motions near the one found neither come to it nor leave it, as without damping"
                    .into(),
            ),
        ];
        for (count, words) in at_speeds.into_iter().filter(|(count, _)| *count > 0) {
            writeln!(out, "At {count} of these speeds {words}.")?;
        }
        for here in self.attractors.iter().filter(|here| here.motions.len() > 1) {
            let motions = here.motions.iter().map(|motion| motion.chains.join(" "));
            let motions: Vec<String> = motions.collect();
            let (rpm, count) = (here.speed_rpm, motions.len());
            let chains = motions.join("; ");
            writeln!(
                out,
                "At {rpm:.1} rpm {count} motions attract, reached in the chains: {chains}."
            )?;
        }
        let mut faster = points().filter_map(|p| p.computed_at_rpm);
        if let Some(rpm) = faster.next() {
            writeln!(
                out,
                "At {} of these speeds, below {rpm:.1} rpm, inertia has no part in the motion: it \
                 is that at {rpm:.1} rpm, the mesh cycle at rest to the square of the highest \
                 harmonic over the lowest natural frequency.",
                1 + faster.count()
            )?;
        }
        self.warnings(out)
    }

    /// What may be wrong at some of the speeds.
    fn warnings(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let points = || self.points.iter().map(|chained| &chained.point);
        let beyond = points().filter(|p| p.is_beyond_linear).count();
        if beyond > 0 {
            writeln!(
                out,
                "Warning: at {beyond} of these speeds approaches of tooth pairs are off their \
                 linear form about the mean loaded configuration by more than 1 % of the sun's \
                 motion; `dynamics.kinematics` = \"exact\" sweeps without it, slowly."
            )?;
        }
        let limited = points().filter_map(|p| Some((p, p.step_error?)));
        let largest = limited.clone().max_by(|(_, a), (_, b)| a.share.total_cmp(&b.share));
        if let Some((point, StepError { harmonic, natural_hz, share, steps })) = largest {
            writeln!(
                out,
                "At {} of these speeds the length of the steps may change the sun's strong \
                 harmonics by more than 1 %, most at {:.1} rpm: harmonic {harmonic} beside \
                 {natural_hz:.0} Hz by up to {:.1} % (1 % with {steps} steps in a mesh cycle, \
                 `dynamics.steps_per_cycle`).",
                limited.count(),
                point.state.case.speed_rpm,
                100.0 * share,
            )?;
        }
        let unsure = points().filter_map(|p| Some((p, p.inertia_error?)));
        // Where no share is known it may be any.
        let size = |error: &InertiaError| error.share.unwrap_or(f64::INFINITY);
        let largest = unsure.clone().max_by(|(_, a), (_, b)| size(a).total_cmp(&size(b)));
        if let Some((point, InertiaError { harmonic, natural_hz, share })) = largest {
            let (count, rpm) = (unsure.count(), point.state.case.speed_rpm);
            let near = match share {
                Some(share) => {
                    format!("beside the set's {natural_hz:.0} Hz by up to {:.0} %", 100.0 * share)
                }
                None => format!("which is near or above the first {natural_hz:.0} Hz of a body"),
            };
            writeln!(
                out,
                "Warning: at {count} of these speeds the inertia of the bodies behind the teeth, \
                 which quasi_static lacks, may change the sun's strong harmonics by more than \
                 5 %, most at {rpm:.1} rpm: harmonic {harmonic} {near}; `dynamics.fidelity` = \
                 \"modal\" has it."
            )?;
        }
        let mut cautions = points().filter_map(SweepPoint::caution);
        if let Some(first) = cautions.next() {
            let others = match cautions.count() {
                0 => String::new(),
                n => format!("; so at {n} further speeds"),
            };
            writeln!(out, "Warning: {first}{others}.")?;
        }
        self.write_failed(out)
    }

    /// Speeds that could not be computed, each with its reason; nothing if there are none.
    pub(super) fn write_failed(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        if self.failed.is_empty() {
            return Ok(());
        }
        let (failed, all) = (self.failed.len(), self.points.len() + self.failed.len());
        writeln!(out, "{failed} of {all} speeds could not be computed:")?;
        for point in &self.failed {
            writeln!(out, "  {:.1} rpm ({}): {}", point.case.speed_rpm, point.chain, point.reason)?;
        }
        Ok(())
    }
}

/// Whether a motion attracts, in a word.
fn attracts(attraction: Attraction) -> &'static str {
    match attraction {
        Attraction::ByMultipliers => "yes",
        Attraction::ByDecay => "decay",
        Attraction::Repels => "no",
        Attraction::Neutral => "neutral",
        Attraction::NotShown => "–",
    }
}

/// How stability is lost where the largest multiplier becomes 1 in size, and in which type of motion.
fn loses(largest: &LargestMultiplier) -> String {
    let kind = match largest.kind.as_str() {
        "period_doubling" => "doubling",
        "neimark_sacker" => "pair",
        other => other,
    };
    match &largest.mode_type {
        Some(mode_type) => format!("{kind}, {mode_type}"),
        None => kind.into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use experiments::sweep::{Coordinate, MultipliersOf, SteadyState};
    use scene::LoadCase;

    /// A sweep of three chains: two speeds found, the first in the second chain, and one that failed.
    fn sweep() -> Sweep {
        let case = |rpm: f64| LoadCase::turning(1130.0, rpm, 0.35 * rpm);
        let point = |rpm: f64, repeats_after: Option<usize>| {
            let line = |coordinate, amplitude| Line {
                part: experiments::sweep::Part::Sun,
                coordinate,
                harmonic: 1,
                amplitude,
                phase_rad: 0.0,
            };
            let lines = vec![
                line(Coordinate::Radial, 3e-6),
                line(Coordinate::Tangential, 4e-6),
                line(Coordinate::Rotation, 1e-6),
            ];
            SweepPoint {
                state: SteadyState { case: case(rpm), lines },
                method: SteadyMethod::Marching,
                why_marched: None,
                steps_per_cycle: 140,
                computed_at_rpm: None,
                cycles: 40,
                derivatives: 0,
                start: SearchStart::Rest,
                attracts: match repeats_after {
                    Some(_) => Attraction::ByDecay,
                    None => Attraction::NotShown,
                },
                multipliers: Vec::new(),
                multipliers_of: MultipliersOf::Steps,
                largest_multiplier: None,
                critical: None,
                residual: 1e-10,
                is_steady: repeats_after == Some(1),
                transient: None,
                step_error: None,
                inertia_error: None,
                between: None,
                repeats_after,
                lowest_force_n: 0.0,
                contact_loss: 0.25,
                backside_contact: None,
                grazing_margin: None,
                size: 0,
                kinematic_rest_m: None,
                kinematic_rest_share: None,
                is_beyond_linear: false,
            }
        };
        let failed = FailedPoint {
            chain: "up_00".into(),
            case: case(1600.0),
            reason: "the motion diverges".into(),
            error: None,
        };
        let chains = vec![
            ("up_00".to_owned(), vec![point(1700.0, Some(2))]),
            ("peak_00".to_owned(), vec![point(1500.0, None)]),
        ];
        Sweep { fidelity: "quasi-static".into(), chains, failed: vec![failed] }
    }

    fn result() -> SweepOutput {
        let scene = scene::template(scene::SceneKind::Planetary);
        let scene = Scene::from_toml(scene).unwrap();
        SweepOutput::new(&scene, 1130.0, &SteadySettings::default(), &sweep())
    }

    fn text() -> String {
        let mut out = Vec::new();
        Report::text(&result(), &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn a_failed_speed_is_in_every_output() {
        let last = "1 of 3 speeds could not be computed:\n  1600.0 rpm (up_00): the motion \
             diverges\n";
        assert!(text().ends_with(last), "{}", text());
        let json = serde_json::to_value(result()).unwrap();
        assert_eq!(json["failed"][0]["speed_rpm"], 1600.0);
        assert_eq!(json["failed"][0]["reason"], "the motion diverges");
        let sidecar: serde_json::Value =
            serde_json::from_slice(&result().sidecar("").unwrap()).unwrap();
        assert_eq!(sidecar["failed"], json["failed"]);
        assert_eq!(sidecar["sun_torque_nm"], 1130.0);
        let mut table = Vec::new();
        result().csv(&mut table).unwrap();
        let table = String::from_utf8(table).unwrap();
        assert!(!table.contains("1600") && table.contains("sun,translation,1,"), "{table}");
        // The sidecar says what every column of the table is.
        let columns = sidecar["columns"].as_array().unwrap().iter();
        let names: Vec<&str> = columns.map(|column| column[0].as_str().unwrap()).collect();
        assert_eq!(table.lines().next().unwrap(), names.join(","));
    }

    #[test]
    fn the_text_is_by_speed_and_explains_its_columns() {
        let text = text();
        assert!(text.find("1500.0").unwrap() < text.find("1700.0").unwrap(), "{text}");
        for column in ["lowest N", "no contact", "backside", "repeats", "residual"] {
            assert!(text.contains(&format!("\n{column}:")), "{column} is not explained: {text}");
        }
        for words in [
            "At 2 of these speeds teeth part",
            "At 1 of these speeds the motion is subharmonic",
            "At 1 of these speeds no motion that repeats after 1 to 8 mesh cycles and \
             attracts was found",
            "n/a",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
    }
}
