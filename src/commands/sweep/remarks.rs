//! What the text of a sweep says below its table.

use std::io::Write;

use experiments::sweep::{
    Attraction, InertiaError, MOST_REPEATS, SearchStart, StepError, SweepPoint,
};

use super::result::SweepOutput;
use crate::error::Result;

impl SweepOutput {
    /// What is worth saying of some of the speeds.
    pub(super) fn remarks(&self, out: &mut dyn Write) -> Result<()> {
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
    fn warnings(&self, out: &mut dyn Write) -> Result<()> {
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
    pub(super) fn write_failed(&self, out: &mut dyn Write) -> Result<()> {
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
