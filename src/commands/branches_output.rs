//! What `branches` prints.

use std::io::Write;

use experiments::branches::{
    Branch, BranchEnd, BranchOrigin, BranchParameter, BranchPointKind, BranchSettings, Branches,
};
use scene::{LoadCase, Scene};
use schemars::JsonSchema;
use serde::Serialize;

use crate::error::CommandError;
use crate::output;

use super::turning::{OF_MEMBER, of_member};

/// What is held fixed along branches, apart from the parameter.
pub(super) struct Fixed {
    /// Speed and torque; over torque, the torque under which the model is set up.
    pub(super) case: LoadCase,
    /// Factor on every damping of the scene.
    pub(super) damping_factor: f64,
}

impl Fixed {
    /// As titles say it.
    pub(super) fn words(&self, over: BranchParameter) -> String {
        let (torque, speed) = (self.case.sun_torque_nm, self.case.speed_rpm);
        let damping = match self.damping_factor {
            1.0 => String::new(),
            factor => format!(", damping × {factor}"),
        };
        match over {
            BranchParameter::Speed => format!("{torque} N·m on the sun{damping}"),
            BranchParameter::Torque => {
                format!("{speed} rpm, set up under {torque} N·m on the sun{damping}")
            }
            BranchParameter::Damping => format!("{speed} rpm, {torque} N·m on the sun"),
            BranchParameter::Key(_) => format!("{speed} rpm, {torque} N·m on the sun{damping}"),
        }
    }
}

/// Branches as JSON.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct BranchesOutput {
    /// Scene.
    scene: String,
    /// Version of the program.
    version: String,
    /// Fidelity or model.
    fidelity: String,
    /// What is varied.
    over: BranchParameter,
    /// Its least and greatest value: rpm, N·m, the factor on the damping, or a number of the scene in the unit of its
    /// key.
    range: [f64; 2],
    /// Its value at which the first branch was begun.
    start: f64,
    /// Torque on the sun, N·m; over torque, the one about whose loaded configuration the model is set up.
    sun_torque_nm: f64,
    /// Speed of the input member, rpm; absent over speed.
    speed_rpm: Option<f64>,
    /// Factor on every damping of the scene; absent over damping.
    damping_factor: Option<f64>,
    /// Steps in a mesh cycle.
    steps_per_cycle: u32,
    /// Highest harmonic.
    harmonics: usize,
    /// Values of the parameter at the folds of the first branch in order along it.
    folds: Vec<f64>,
    /// Ranges of the parameter in which more than one stable motion was found.
    coexisting: Vec<[f64; 2]>,
    #[serde(flatten)]
    found: Branches,
}

impl BranchesOutput {
    pub(super) fn new(
        scene: &Scene,
        fixed: &Fixed,
        settings: &BranchSettings,
        found: Branches,
    ) -> Self {
        let first = found.branches.first();
        let unless = |over, value| (settings.over != over).then_some(value);
        Self {
            scene: scene.title.clone(),
            version: env!("CARGO_PKG_VERSION").into(),
            fidelity: first.map(|b| b.fidelity.clone()).unwrap_or_default(),
            over: settings.over,
            range: settings.range,
            start: settings.start,
            sun_torque_nm: fixed.case.sun_torque_nm,
            speed_rpm: unless(BranchParameter::Speed, fixed.case.speed_rpm),
            damping_factor: unless(BranchParameter::Damping, fixed.damping_factor),
            steps_per_cycle: scene.dynamics.steps_per_cycle,
            harmonics: settings.harmonics,
            folds: first.into_iter().flat_map(|b| b.folds().map(|p| p.parameter)).collect(),
            coexisting: found.coexisting(),
            found,
        }
    }

    /// The tidy table.
    pub(super) fn write_csv(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let mut writer = csv::Writer::from_writer(out);
        for (index, branch) in self.found.branches.iter().enumerate() {
            for row in branch.rows(&self.scene, index) {
                writer.serialize(row)?;
            }
        }
        Ok(writer.flush()?)
    }

    /// One line per point in order along each branch, then why it ends; then a legend.
    pub(super) fn text(&self, fixed: &Fixed, out: &mut dyn Write) -> Result<(), CommandError> {
        let (scene, fidelity) = (&self.scene, &self.fidelity);
        writeln!(out, "{scene}: {fidelity}, {}\n", fixed.words(self.over))?;
        for branch in &self.found.branches {
            self.write_branch(branch, out)?;
        }
        writeln!(out, "{LEGEND}")?;
        let unit = self.over.unit();
        for [from, to] in &self.coexisting {
            writeln!(
                out,
                "More than one stable motion was found from {} to {}{unit}.",
                self.value(*from),
                self.value(*to)
            )?;
        }
        for lost in &self.found.not_followed {
            let (at, kind, reason) = (self.value(lost.parameter), lost.kind.name(), &lost.reason);
            let kind = kind.replace('_', " ");
            writeln!(out, "No branch was found off the {kind} at {at}{unit}: {reason}.")?;
        }
        Ok(())
    }

    /// A value of the parameter in a sentence.
    fn value(&self, value: f64) -> String {
        match self.over {
            BranchParameter::Key(_) => format!("{value:.6e}"),
            _ => format!("{value:.4}"),
        }
    }

    fn write_branch(&self, branch: &Branch, out: &mut dyn Write) -> Result<(), CommandError> {
        let unit = self.over.unit();
        let origin = match branch.origin {
            BranchOrigin::Start(_) => None,
            BranchOrigin::PeriodDoubling(at) => Some(("period doubling", at)),
            BranchOrigin::BranchPoint(at) => Some(("branch point", at)),
        };
        if let Some((kind, at)) = origin {
            let cycles = match branch.repeats_after {
                1 => "every mesh cycle".to_owned(),
                cycles => format!("after {cycles} mesh cycles"),
            };
            writeln!(out, "Off the {kind} at {}{unit}, repeating {cycles}:", self.value(at))?;
        }
        let header = [
            match (self.over, self.over.plain_unit()) {
                (BranchParameter::Damping, _) => "damping",
                (_, "") => "value",
                (_, unit) => unit,
            },
            "point",
            "stable",
            "μ",
            "mode",
            OF_MEMBER[0],
            OF_MEMBER[1],
            OF_MEMBER[2],
            OF_MEMBER[3],
            "lowest N",
            "no contact",
            "grazing",
            "residual",
        ];
        let mut table = output::table(&header, &[0, 3, 5, 6, 7, 8, 9, 10, 11, 12]);
        for p in &branch.points {
            let [rotation, l, translation, of_translation] = of_member(&p.state, self.harmonics);
            table.add_row([
                match self.over {
                    BranchParameter::Speed => format!("{:.3}", p.parameter),
                    BranchParameter::Torque | BranchParameter::Damping => {
                        format!("{:.5}", p.parameter)
                    }
                    BranchParameter::Key(_) => format!("{:.5e}", p.parameter),
                },
                match p.kind {
                    BranchPointKind::Regular => String::new(),
                    other => other.name().replace('_', " "),
                },
                if p.is_stable { "yes".into() } else { "no".into() },
                format!("{:.4}", p.largest_multiplier()),
                p.critical.as_ref().map_or("–".into(), |own| own.mode_type.clone()),
                rotation,
                l,
                translation,
                of_translation,
                format!("{:.0}", p.lowest_force_n),
                output::share(p.contact_loss),
                p.grazing_margin.map_or("–".into(), |margin| format!("{margin:.3}")),
                format!("{:.0e}", p.residual),
            ]);
        }
        writeln!(out, "{table}")?;
        for (end, words) in branch.ends.iter().zip(["first", "last"]) {
            match end {
                BranchEnd::Bound | BranchEnd::Origin => {}
                BranchEnd::Closed => writeln!(out, "The branch is closed.")?,
                BranchEnd::MostPoints => {
                    writeln!(
                        out,
                        "It goes on beyond its {words} point: --max-points was reached."
                    )?;
                }
                BranchEnd::Stuck(why) => {
                    writeln!(out, "It could not be followed beyond its {words} point: {why}.")?;
                }
            }
        }
        writeln!(out)?;
        Ok(())
    }
}

/// Below the table: what each column is.
const LEGEND: &str = "\
points are in order along each branch, which turns back at folds
μ: size of the largest Floquet multiplier, below 1 if the motion is stable
mode: type, by kinetic energy, of the perturbation whose multiplier is nearest in size to 1
rotation, translation: strongest harmonic of the sun, of a held sun that of the ring or carrier that turns, and its number l as a multiple of the mesh frequency
lowest N: lowest force of any mesh during a cycle, N
no contact: largest part of the time in which a mesh carries nothing; – for never
grazing: least of lowest over mean force of the meshes that never part; – where all part";
