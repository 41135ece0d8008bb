//! Speeds and torques at the operating point.

use std::io::Write;

use gearset::{Kinematics, Member, MemberSpeeds, MemberTorques, PathDirection};
use scene::{LoadCase, Scene};
use schemars::JsonSchema;
use serde::Serialize;

use crate::output::{Notation, Table};

/// Speeds and torques of a whole set at its operating point, counter-clockwise positive.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct MotionSummary {
    /// Member that stands still.
    pub(super) fixed: Member,
    /// Member whose speed and torque are given.
    pub(super) input: Member,
    pub(super) output: Member,
    /// Whether power goes in at the input member; otherwise it is braked.
    pub(super) drives: bool,
    /// Speed of the output member over that of the input member.
    pub(super) speed_ratio: f64,
    pub(super) speeds_rpm: MemberSpeeds,
    /// External torques that hold the members in steady motion, without friction.
    pub(super) torques_nm: MemberTorques,
    /// Direction in which tooth pairs run along the path of contact: forward, from its start to its end, where the
    /// sun's power relative to the carrier is positive.
    pub(super) pairs_run: PathDirection,
    /// Member that the torque acts on in experiments, because it turns without support; null if it has no path.
    pub(super) torque_acts_on: Option<Member>,
}

impl MotionSummary {
    pub(super) fn new(scene: &Scene) -> Option<Self> {
        let kinematics = scene.kinematics().ok()?;
        let case = LoadCase::of_scene(scene).ok()?;
        let operation = scene.operation?;
        let Kinematics { fixed, input, output, speed_ratio, speeds_rpm, .. } = kinematics;
        Some(Self {
            fixed,
            input,
            output,
            drives: operation.speed_rpm * operation.torque_nm >= 0.0,
            speed_ratio,
            speeds_rpm,
            torques_nm: kinematics.torques_nm(operation.torque_nm),
            pairs_run: case.direction(),
            torque_acts_on: scene.loaded_member().ok(),
        })
    }
}

/// Speeds and torques of all members.
pub(super) fn write_motion(motion: &MotionSummary, out: &mut dyn Write) -> std::io::Result<()> {
    let MotionSummary { speeds_rpm: speeds, torques_nm: torques, .. } = motion;
    writeln!(
        out,
        "the {} {}, the {} stands still; ratio of the {}'s speed to it {:.5}",
        motion.input.name(),
        if motion.drives { "drives" } else { "is braked" },
        motion.fixed.name(),
        motion.output.name(),
        motion.speed_ratio
    )?;
    let members = [Member::Sun, Member::Ring, Member::Carrier];
    let members = members.map(|m| (m.name(), speeds.of(m), Some(torques.of(m))));
    let on_pin = speeds.planet_relative_to_carrier;
    let planets = [("planet", speeds.planet, None), ("planet on its pin", on_pin, None)];
    type Row = (&'static str, f64, Option<f64>);
    let table = Table::<Row>::new()
        .words("member", Notation::Plain, |r| r.0)
        .words("rpm", Notation::Fixed(4), |r| r.1)
        .words("torque N·m", Notation::Fixed(1), |r| r.2);
    table.text(members.into_iter().chain(planets), out)?;
    let (from, to, sign) = match motion.pairs_run {
        PathDirection::Forward => ("start", "end", "positive"),
        PathDirection::Backward => ("end", "start", "negative"),
    };
    write!(
        out,
        "tooth pairs run from the {from} of the path of contact to its {to}: the sun's power relative to the carrier is {sign}"
    )?;
    match motion.torque_acts_on {
        Some(member) => writeln!(out, "; in experiments the torque acts on the {}", member.name()),
        None => writeln!(out),
    }
}
