//! What `branches` prints.

use std::io::Write;

use experiments::branches::{
    Branch, BranchEnd, BranchOrigin, BranchParameter, BranchPoint, BranchPointKind, BranchSettings,
    Branches,
};
use experiments::sweep::Line;
use scene::{LoadCase, Scene};
use schemars::JsonSchema;
use serde::Serialize;

use crate::commands::turning;
use crate::error::Result;
use crate::output::{Notation, Report, Table};

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
pub(crate) struct BranchesOutput {
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
    /// What is held fixed, as titles say it.
    #[serde(skip)]
    fixed: String,
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
            fixed: fixed.words(settings.over),
        }
    }

    /// A value of the parameter in a sentence.
    fn value(&self, value: f64) -> String {
        match self.over {
            BranchParameter::Key(_) => format!("{value:.6e}"),
            _ => format!("{value:.4}"),
        }
    }

    /// One line per point in order along a branch, then why it ends.
    fn write_branch(&self, branch: &Branch, out: &mut dyn Write) -> Result<()> {
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
        let points = branch.points.iter().enumerate();
        let row =
            |(number, point)| Row { result: self, branch, number, point, index: 0, line: None };
        self.table().text(points.map(row), out)?;
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

/// A row of the table: of a point in text, of one of its harmonics in files.
struct Row<'r> {
    result: &'r BranchesOutput,
    branch: &'r Branch,
    /// Number of the branch.
    index: usize,
    /// Number of the point along it.
    number: usize,
    point: &'r BranchPoint,
    line: Option<Line>,
}

impl BranchesOutput {
    fn table<'r>(&self) -> Table<'r, Row<'r>> {
        use Notation::{Fixed, Plain, Power, Share};
        let over = self.over;
        let heading = match (over, over.plain_unit()) {
            (BranchParameter::Damping, _) => "damping",
            (_, "") => "value",
            (_, unit) => unit,
        };
        let table = Table::<Row<'_>>::new()
            .column("scene", "title of the scene", |r| &r.result.scene)
            .column("fidelity", "fidelity or model", |r| &r.branch.fidelity)
            .column("sun_torque_nm", "torque on the sun, N m", |r| r.point.state.case.sun_torque_nm)
            .column("speed_rpm", "speed of the input member, rpm", |r| r.point.state.case.speed_rpm)
            .column("mesh_frequency_hz", "mesh frequency, Hz", |r| {
                r.point.state.case.mesh_frequency_hz
            })
            .column("damping_factor", "factor on every damping of the scene", |r| {
                r.point.damping_factor
            })
            .column("parameter", "", |r| r.point.parameter)
            .shown_as(heading, move |r| match over {
                BranchParameter::Speed => format!("{:.3}", r.point.parameter),
                BranchParameter::Torque | BranchParameter::Damping => {
                    format!("{:.5}", r.point.parameter)
                }
                BranchParameter::Key(_) => format!("{:.5e}", r.point.parameter),
            })
            .key()
            .column("branch", "number of the branch", |r| r.index)
            .column("repeats_after", "mesh cycles after which the motions repeat", |r| {
                r.branch.repeats_after
            })
            .column("point", "number of the point along the branch", |r| r.number)
            .column("kind", "", |r| r.point.kind.name())
            .shown_as("point", |r| match r.point.kind {
                BranchPointKind::Regular => String::new(),
                other => other.name().replace('_', " "),
            })
            .column("is_stable", "", |r| r.point.is_stable)
            .shown("stable", Plain)
            .column(
                "largest_multiplier",
                "size of the largest Floquet multiplier, below 1 if the motion is stable",
                |r| r.point.largest_multiplier(),
            )
            .shown("μ", Fixed(4))
            .words("mode", Plain, |r| {
                r.point.critical.as_ref().map(|critical| critical.mode_type.clone())
            })
            .meaning(
                "type, by kinetic energy, of the perturbation whose multiplier is nearest in \
             size to 1",
            )
            .column("arc", "length along the branch from its start", |r| r.point.arc);
        let table = turning::with_harmonic(table, |r| r.line.as_ref());
        turning::with_strongest(table, |r| (&r.point.state, r.result.harmonics))
            .words("lowest N", Fixed(0), |r: &Row<'_>| r.point.lowest_force_n)
            .meaning("lowest force of any mesh during a cycle, N")
            .words("no contact", Share, |r: &Row<'_>| r.point.contact_loss)
            .meaning("largest part of the time in which a mesh carries nothing; – for never")
            .words("grazing", Fixed(3), |r: &Row<'_>| r.point.grazing_margin)
            .meaning(
                "least of lowest over mean force of the meshes that never part; – where all \
             part",
            )
            .words("residual", Power(0), |r: &Row<'_>| r.point.residual)
    }
}

impl Report for BranchesOutput {
    /// One row for each harmonic of each quantity of each point in order along the branches.
    fn csv(&self, out: &mut dyn Write) -> Result<()> {
        let branches = self.found.branches.iter().enumerate();
        let rows = branches.flat_map(|(index, branch)| {
            branch.points.iter().enumerate().flat_map(move |(number, point)| {
                let lines = point.state.with_translations().into_iter();
                let row = move |line| Row { result: self, branch, index, number, point, line };
                lines.map(move |line| row(Some(line)))
            })
        });
        self.table().csv(rows, out)
    }

    /// One line per point in order along each branch, then why it ends; then a legend.
    fn text(&self, out: &mut dyn Write) -> Result<()> {
        let (scene, fidelity) = (&self.scene, &self.fidelity);
        writeln!(out, "{scene}: {fidelity}, {}\n", self.fixed)?;
        for branch in &self.found.branches {
            self.write_branch(branch, out)?;
        }
        writeln!(out, "points are in order along each branch, which turns back at folds")?;
        self.table().legend(out)?;
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
}
