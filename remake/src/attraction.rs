//! Motions of drawn sets and gear pairs at drawn operating points, pushed: those called attracting have to come
//! back, where none was found random starts have to find none.

use std::io::Write;

use experiments::sweep::{
    FeModel, Marching, MeshLawModel, Record, SteadySettings, SweepModel, SweepPoint,
    push_at_random, steady, vibration,
};
use fe_contact::statics::{Bodies, Imperfections};
use rayon::prelude::*;
use scene::{Fidelity, LoadCase, Scene};

use super::Outcome;

/// Seeds, one an operating point.
const SEEDS: std::ops::Range<u64> = 30_001..30_201;

/// Scenes with the range of the mesh frequency (Hz) that is drawn from: resonances and tongues of parametric
/// instability.
const SCENES: [(&str, [f64; 2]); 4] = [
    ("scenes/oh58_3p.toml", [300.0, 2400.0]),
    ("scenes/oh58_4p.toml", [300.0, 2400.0]),
    ("scenes/five_planets.toml", [300.0, 2400.0]),
    ("scenes/pair_50_50.toml", [1200.0, 6800.0]),
];

/// Factors on the default damping of 2 %.
const DAMPING: [f64; 3] = [1.0, 0.25, 0.05];

/// Cycles of plain marching after a push.
const CYCLES: usize = 2000;

/// Random starts where no motion that repeats with the mesh cycle was found.
const STARTS: usize = 10;

/// Displacement of the small push, m; of the large one, of the vibration.
const SMALL: f64 = 1e-9;
const LARGE: f64 = 1e-2;

/// Deviations of this share of the vibration from one of the motions listed are that motion.
const SAME: f64 = 1e-3;

pub(super) fn remake() -> Outcome {
    let rows: Vec<String> = SEEDS
        .into_par_iter()
        .map(|seed| row(seed).unwrap_or_else(|error| format!("{seed},,,,,,,,,,,failed: {error}")))
        .inspect(|row| eprintln!("{row}"))
        .collect();
    let mut out = std::io::stdout().lock();
    writeln!(
        out,
        "seed,scene,fidelity,torque_nm,damping_factor,speed_rpm,repeats_after,attracts,multiplier,small_push_left,large_push,verdict"
    )?;
    for row in rows {
        writeln!(out, "{row}")?;
    }
    Ok(())
}

/// One operating point.
fn row(seed: u64) -> Result<String, Box<dyn std::error::Error + Send + Sync>> {
    let mut random = fastrand::Rng::with_seed(seed);
    let (path, [low, high]) = SCENES[random.usize(..SCENES.len())];
    let mut scene = Scene::from_file(path.as_ref())?;
    let damping = DAMPING[random.usize(..DAMPING.len())];
    scene.damping = scene.damping.times(damping);
    let case = LoadCase::of_scene(&scene)?;
    // Light to full torque, evenly in its logarithm.
    let torque = case.sun_torque_nm * 0.03f64.powf(random.f64());
    let hz = low + (high - low) * random.f64();
    let case = case.with_sun_torque(torque);
    let case = case.at_speed(hz / case.mesh_frequency_per_rpm_hz());
    let fidelity = match scene.lumped {
        Some(_) => random.usize(..3),
        None => random.usize(..2),
    };
    scene.dynamics.fidelity = Fidelity::QuasiStatic;
    let bodies = Bodies::new(&scene)?;
    let model: Box<dyn SweepModel + '_> = match fidelity {
        0 => Box::new(FeModel::new(&scene, &bodies, Imperfections::default(), case)),
        1 => Box::new(MeshLawModel::new(&scene, &bodies, case)?),
        _ => Box::new(MeshLawModel::new(&scene, &bodies, case)?.lumped()),
    };
    let head =
        format!("{seed},{path},{},{torque:.2},{damping},{:.2}", model.name(), case.speed_rpm);
    // Tables grow as in a sweep.
    let mut last = None;
    for size in 0..5 {
        match (Pushed { model: model.as_ref(), case, size }).judged(&mut random) {
            Ok(tail) => return Ok(format!("{head},{tail}")),
            Err(error) => last = Some(error),
        }
    }
    let reason = last.map_or_else(String::new, |e| e.to_string().replace([',', '\n'], ";"));
    Ok(format!("{head},,,,,,failed: {reason}"))
}

/// A set at one operating point.
struct Pushed<'m> {
    model: &'m dyn SweepModel,
    case: LoadCase,
    size: usize,
}

type Failure = Box<dyn std::error::Error + Send + Sync>;

impl<'m> Pushed<'m> {
    fn set(&self) -> Result<Box<dyn Marching + 'm>, Failure> {
        Ok(self.model.turning(&self.case, self.size)?)
    }

    fn search(&self, set: &mut dyn Marching) -> Result<SweepPoint, Failure> {
        let settings = SteadySettings { between_cycles: 0, ..SteadySettings::default() };
        let (shape, psi, steps) =
            (self.model.shape(), self.model.first_planet_rad(), self.model.steps_per_cycle());
        let found = steady(set, shape, psi, steps, &settings)?;
        Ok(SweepPoint::new(self.case, &found, &settings, self.size)?)
    }

    /// `count` cycles from the present state, the last recorded.
    fn march(&self, set: &mut dyn Marching, count: usize) -> Result<Record, Failure> {
        let (psi, steps) = (self.model.first_planet_rad(), self.model.steps_per_cycle());
        let mut record = Record::new(self.model.shape());
        for _ in 0..count {
            record.march(set, psi, steps)?;
        }
        Ok(record)
    }

    /// Repeats, attracts, multiplier, what is left of a small push, where a large one led, and the verdict.
    fn judged(&self, random: &mut fastrand::Rng) -> Result<String, Failure> {
        let mut set = self.set()?;
        set.rest()?;
        let point = self.search(set.as_mut())?;
        let state = set.state();
        let size = self.march(set.as_mut(), 8).map(|record| vibration(&record))?;
        set.restore(&state)?;
        let repeats = point.repeats_after.map_or_else(|| "none".into(), |n| n.to_string());
        let multiplier = point.largest_multiplier();
        let head = format!(
            "{repeats},{},{}",
            point.attracts.name(),
            multiplier.map_or_else(String::new, |m| format!("{m:.6}"))
        );
        let starts = match point.repeats_after {
            Some(1) => Vec::new(),
            _ => self.random_starts(size, random)?,
        };
        if !point.attracts.is_shown() {
            let others = starts.iter().filter(|p| p.attracts.is_shown()).count();
            let verdict = if others == 0 {
                "agrees".into()
            } else {
                format!("{others} of {STARTS} starts find one")
            };
            return Ok(format!("{head},,,{verdict}"));
        }
        let count = point.repeats_after.unwrap_or(1);
        let cycles = CYCLES / count * count;
        let mut ends = Vec::new();
        for push in [0.0, SMALL, LARGE * size] {
            set.restore(&state)?;
            push_at_random(set.as_mut(), self.model.planets(), push, random)?;
            let first = self.march(set.as_mut(), count)?;
            let end = self.march(set.as_mut(), cycles - count)?;
            ends.push((first, end));
        }
        let [(still, still_end), (small, small_end), (_, large_end)] = &ends[..] else {
            return Err("three marches".into());
        };
        let left = small_end.change_from(still_end) / small.change_from(still);
        let as_multiplier = multiplier.unwrap_or(0.0).powf((cycles / count) as f64);
        // A transient of several modes may first grow; what rounding leaves is 1e-12 of the vibration.
        let is_gone =
            left < 0.1_f64.max(10.0 * as_multiplier) || small_end.change_from(still_end) < 1e-11;
        let distance = large_end.change_from(still_end);
        let returns = distance < SAME.max(10.0 * LARGE * as_multiplier);
        let arrives = match returns {
            true => "returns".to_owned(),
            false => {
                let other = self.search(set.as_mut())?;
                format!(
                    "leads to another: repeats {:?} {}",
                    other.repeats_after,
                    other.attracts.name()
                )
            }
        };
        let disagree = starts.iter().filter(|p| !p.attracts.is_shown()).count();
        let verdict = match (is_gone, returns) {
            (false, _) => "push stays".to_owned(),
            (true, false) => "pushed away".to_owned(),
            _ if disagree > 0 => format!("{disagree} of {STARTS} starts find none"),
            _ => "agrees".into(),
        };
        Ok(format!("{head},{left:.2e},{arrives},{verdict}"))
    }

    /// Motions from random starts, up to three times the vibration off the motion at rest.
    fn random_starts(
        &self,
        size: f64,
        random: &mut fastrand::Rng,
    ) -> Result<Vec<SweepPoint>, Failure> {
        let mut all = Vec::new();
        for _ in 0..STARTS {
            let mut set = self.set()?;
            set.rest()?;
            let times = 3.0 * random.f64();
            push_at_random(set.as_mut(), self.model.planets(), times * size, random)?;
            all.push(self.search(set.as_mut())?);
        }
        Ok(all)
    }
}
