//! What a run takes of memory and time, before any of it is computed.

use std::io::Write;
use std::path::Path;

use experiments::sweep::{SteadyMethod, SteadySettings};
use fe_contact::FeError;
use fe_contact::statics::{Bodies, MOST_BYTES, cycle_bytes, estimate, within_memory};
use scene::{Fidelity, MeshKinematics, Scene, SceneKind};

use crate::arguments::Model;
use crate::error::{Result, unfit};

/// Longest that a run may take by estimate on one core, s: a day.
const MOST_SECONDS: f64 = 86_400.0;

/// A run that takes longer by estimate says so as it begins, s.
const WORTH_SAYING: f64 = 60.0;

// Seconds a unit of work, fitted on one core of a busy cloud server (x86-64, two cores) to runs of the shipped four
// planets. Runs at or near the speeds of the shipped scenes are then within a factor of 2, full bodies perhaps 3; other
// machines come on top. Nothing bounds what is unknown beforehand: searches that fail march up to `--most-cycles`, and
// outgrown tables are made again. The wind turbine at 50 times its speed takes over 50 times its estimate.

/// Bodies, a byte of the memory in which they are made.
const BODIES: f64 = 1.5e-9;

/// Contact of a mesh at a position, and what the square and the cube of its cells add.
const CONTACT: [f64; 3] = [0.2e-3, 1.5e-7, 1.5e-9];

/// Tables of a mesh law, which are curves of force, over tables of contact.
const LAW: f64 = 4.0;

/// A set of elastic bodies, an unknown: the factors of its matrices, and what each mode of a body adds.
const SET: [f64; 2] = [3.5e-5, 2.6e-6];

/// A step on tables, a mesh, and what a pair of its cells and a pair of coordinates of the set add.
const STEP: [f64; 3] = [1e-7, 6e-10, 2e-9];

/// A step of finite-element bodies, an unknown: between 3e-7 in the modal tests of `benches/full_impulse.rs` and 2e-6
/// in a sweep over one speed with the default elements.
const ELASTIC_STEP: f64 = 1e-6;

/// Cycles of steps that take as long as to shoot a motion from the one before, a point of a branch, and a motion from a
/// random start.
const SHOT: [f64; 3] = [5.0, 40.0, 100.0];

/// Sets of elastic bodies that a modal test makes after its first.
const SETS_OF_DECAYS: f64 = 2.0;

/// Mesh cycles in which a march loses a transient to a factor e.
const LOSING: f64 = 7.0;

/// What a step computes.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Step {
    /// Rigid or modal bodies on tables of contact.
    OnTables,
    /// The contact of every mesh.
    Contact,
    /// Every unknown of the finite elements.
    Elastic,
}

/// A run by the numbers that make it large or long.
#[derive(Debug, Clone)]
pub(crate) struct Run {
    scene: Scene,
    step: Step,
    /// Positions in a mesh cycle.
    positions: usize,
    /// How often the contact of all meshes is solved at each of them, by active sets.
    solutions: f64,
    /// Speeds, points of a branch, pulses.
    motions: usize,
    /// Further searches at each speed.
    random_starts: usize,
    /// Marched at each of them.
    cycles: f64,
    /// How often elastic bodies are made for a motion.
    sets: f64,
    /// Whether contact is solved for every motion again.
    is_of_each_motion: bool,
    /// Time in which the finite-element bodies are made, s.
    bodies_s: f64,
    /// Unknowns of the different bodies, and of all that move.
    unknowns: [f64; 2],
    dials: Vec<Dial>,
}

/// A number of a run that an argument or a key sets.
#[derive(Debug, Clone, Copy)]
struct Dial {
    /// What it counts, and its argument or key.
    words: [&'static str; 2],
    value: usize,
    /// Least that is allowed.
    least: usize,
    set: fn(&mut Run, usize),
}

/// Memory of contact cells, bytes, and time on one core, s.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cost {
    bytes: u64,
    seconds: f64,
}

impl Cost {
    fn is_usual(self) -> bool {
        self.bytes <= MOST_BYTES && self.seconds <= MOST_SECONDS
    }
}

impl Run {
    /// A mesh cycle at rest under so many torques; `slowness`: of the contact solver, over active sets.
    pub(crate) fn at_rest(scene: &Scene, positions: usize, torques: usize, slowness: f64) -> Self {
        let solutions = slowness * torques as f64;
        let run = Self::new(scene, positions).with_dial(
            ["positions", "--positions"],
            positions,
            1,
            |run, n| run.positions = n,
        );
        Self { solutions, ..run }
    }

    /// Free decays of so many steps each after so many pulses.
    pub(crate) fn decays(scene: &Scene, pulses: usize, steps: usize) -> Self {
        let run = Self::new(scene, 1).with_dial(
            ["steps of a decay", "--duration-ms"],
            steps,
            1,
            |run, n| run.cycles = n as f64,
        );
        let sets = SETS_OF_DECAYS / pulses.max(1) as f64;
        Self { motions: pulses, cycles: steps as f64, sets, ..run }
    }

    /// Motions that repeat, of the lumped model or at the fidelity of the scene; `dial`: what they are and what sets
    /// their number.
    pub(crate) fn motions(
        scene: &Scene,
        model: Model,
        steady: &SteadySettings,
        dial: [&'static str; 2],
        motions: usize,
    ) -> Self {
        let mut own = scene.clone();
        if model == Model::Lumped {
            own.dynamics.fidelity = Fidelity::MeshLaw;
        }
        let steps = own.dynamics.steps_per_cycle as usize;
        let run = Self::new(&own, steps)
            .with_dial(["steps", "`dynamics.steps_per_cycle`"], steps, 16, |run, n| {
                run.positions = n;
            })
            .with_dial(dial, motions, 1, |run, n| run.motions = n);
        let run = match own.dynamics.fidelity {
            Fidelity::MeshLaw => Self { solutions: LAW, ..run },
            _ => run,
        };
        let is_shot = steady.method == SteadyMethod::Shooting && run.step == Step::OnTables;
        if is_shot {
            return Self { motions, cycles: SHOT[0], ..run };
        }
        let marched = (LOSING * (1.0 / steady.tolerance).ln()).min(steady.most_cycles as f64);
        Self { motions, cycles: marched + steady.between_cycles as f64, ..run }
    }

    /// With so many searches of each speed from random starts.
    pub(crate) fn with_random_starts(self, random_starts: usize) -> Self {
        let run =
            self.with_dial(["random starts", "--random-starts"], random_starts, 0, |run, n| {
                run.random_starts = n;
            });
        Self { random_starts, ..run }
    }

    /// That are points of a branch.
    pub(crate) fn followed(self) -> Self {
        Self { cycles: SHOT[1], ..self }
    }

    /// Of a key on which the configuration under load depends: contact is solved again for every motion.
    pub(crate) fn with_tables_of_each_motion(self) -> Self {
        Self { is_of_each_motion: true, ..self }
    }

    /// Refuses a run that would take more than [`MOST_BYTES`] or [`MOST_SECONDS`], unless that is asked for
    /// (`--large`); says how long it takes where that is long.
    pub(crate) fn admit(&self, path: &Path, is_large: bool, err: &mut dyn Write) -> Result<()> {
        let cost = self.cost();
        if !is_large && !cost.is_usual() {
            return Err(unfit(path, self.refusal(cost)));
        }
        if cost.seconds > WORTH_SAYING {
            writeln!(err, "by estimate about {} on one core", duration(cost.seconds))?;
        }
        Ok(())
    }

    fn new(scene: &Scene, positions: usize) -> Self {
        // A scene without bodies is refused where they are made.
        let (bytes, bodies) = estimate(scene).map_or((0, Vec::new()), |e| (e.peak_bytes, e.bodies));
        let planets = scene.planets.count() as f64;
        let count = |name| if name == "planet" { planets } else { 1.0 };
        let unknowns = bodies.iter().map(|b| (b.unknowns as f64, count(b.name)));
        let unknowns = unknowns.fold([0.0, 0.0], |[a, b], (n, count)| [a + n, b + count * n]);
        let is_exact = scene.dynamics.kinematics == MeshKinematics::Exact;
        let step = match scene.dynamics.fidelity {
            Fidelity::Full => Step::Elastic,
            _ if is_exact => Step::Contact,
            _ => Step::OnTables,
        };
        let cells = scene.fe_contact.contact_cells as usize;
        let run = Self {
            scene: scene.clone(),
            step,
            positions,
            solutions: 1.0,
            motions: 0,
            random_starts: 0,
            cycles: 0.0,
            sets: 1.0,
            is_of_each_motion: false,
            bodies_s: BODIES * bytes as f64,
            unknowns,
            dials: Vec::new(),
        };
        run.with_dial(["cells", "`fe_contact.contact_cells`"], cells, 8, |run, n| {
            run.scene.fe_contact.contact_cells = n as u32;
        })
    }

    fn with_dial(
        mut self,
        words: [&'static str; 2],
        value: usize,
        least: usize,
        set: fn(&mut Self, usize),
    ) -> Self {
        self.dials.push(Dial { words, value, least, set });
        self
    }

    fn cost(&self) -> Cost {
        let planets = self.scene.planets.count() as f64;
        let (meshes, bodies) = match self.scene.kind {
            SceneKind::Planetary => (2.0 * planets, planets + 2.0),
            SceneKind::GearPair => (1.0, 2.0),
        };
        let cells = f64::from(self.scene.fe_contact.contact_cells);
        let contact = meshes * (CONTACT[0] + cells * cells * (CONTACT[1] + CONTACT[2] * cells));
        let motions = self.motions as f64;
        let modes = match self.scene.dynamics.fidelity {
            Fidelity::Modal(modes) => f64::from(modes),
            _ => 0.0,
        };
        let tables = match self.is_of_each_motion {
            true => self.solutions * motions,
            false => self.solutions,
        };
        let coordinates = bodies * (3.0 + modes);
        let step = match self.step {
            Step::OnTables => {
                let of_cells = meshes * (STEP[0] + STEP[1] * cells * cells);
                of_cells + STEP[2] * coordinates * coordinates
            }
            Step::Contact => contact,
            Step::Elastic => ELASTIC_STEP * self.unknowns[1],
        };
        let set = match self.scene.dynamics.fidelity {
            Fidelity::Modal(_) | Fidelity::Full => self.unknowns[0] * (SET[0] + SET[1] * modes),
            _ => 0.0,
        };
        let searches = 1.0 + self.random_starts as f64;
        let steps = self.cycles + self.random_starts as f64 * SHOT[2].max(self.cycles);
        let positions = self.positions as f64;
        let of_motion = searches * self.sets * set + steps * positions * step;
        let before = if self.motions == 0 { 0.0 } else { set };
        let solved = tables * positions * contact;
        let seconds = self.bodies_s + before + solved + motions * of_motion;
        Cost { bytes: cycle_bytes(&self.scene, self.positions), seconds }
    }

    /// The most that a dial may say for the run to be usual, if it alone can make it so.
    fn most(&self, dial: &Dial) -> Option<usize> {
        let is_usual = |value: usize| {
            let mut run = self.clone();
            (dial.set)(&mut run, value);
            run.cost().is_usual()
        };
        let (mut fits, mut exceeds) = (dial.least, dial.value);
        if fits >= exceeds || !is_usual(fits) {
            return None;
        }
        while exceeds - fits > 1 {
            let middle = fits + (exceeds - fits) / 2;
            match is_usual(middle) {
                true => fits = middle,
                false => exceeds = middle,
            }
        }
        Some(fits)
    }

    fn refusal(&self, cost: Cost) -> String {
        let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
        let given =
            self.dials.iter().map(|d| format!("{} {} ({})", d.value, d.words[0], d.words[1]));
        let fitting = self
            .dials
            .iter()
            .filter_map(|dial| Some(format!("{} {}", self.most(dial)?, dial.words[0])));
        let (given, fitting): (Vec<_>, Vec<_>) = (given.collect(), fitting.collect());
        let fitting = match fitting.is_empty() {
            true => "no one of them alone makes it so little".into(),
            false => format!("one alone makes it so little: {}", fitting.join(", or ")),
        };
        format!(
            "{}: by estimate these take {:.1} GiB of memory and {} on one core; up to {:.0} GiB and {} \
             are taken, and more with --large; {fitting}",
            given.join(", "),
            gib(cost.bytes),
            duration(cost.seconds),
            gib(MOST_BYTES),
            duration(MOST_SECONDS),
        )
    }
}

/// A time in the largest unit of which it is two or more.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.0} h", s / 3600.0),
    }
}

/// The finite-element bodies of a scene, refused where they would take more than [`MOST_BYTES`], unless that is asked
/// for (`--large`).
pub(crate) fn bodies(path: &Path, scene: &Scene, is_large: bool) -> Result<Bodies> {
    let refused = |e: FeError| match estimate(scene) {
        Ok(_) => unfit(path, format!("{e}, and more with --large")),
        Err(e) => unfit(path, e),
    };
    if !is_large {
        within_memory(scene).map_err(refused)?;
    }
    Bodies::of_any_size(scene).map_err(|e| unfit(path, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shipped(name: &str) -> Scene {
        let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        Scene::from_file(path.as_ref()).unwrap()
    }

    fn scene(change: impl Fn(&mut Scene)) -> Scene {
        let mut scene = shipped("oh58_4p");
        change(&mut scene);
        scene
    }

    fn sweep(scene: &Scene, motions: usize, change: impl Fn(&mut SteadySettings)) -> Run {
        let mut steady = SteadySettings::default();
        change(&mut steady);
        Run::motions(scene, Model::FeContact, &steady, ["motions", "--speeds-rpm"], motions)
    }

    /// More of what any dial sets takes more time, and no less memory.
    #[test]
    fn every_dial_makes_a_run_longer() {
        let plain = scene(|_| {});
        let march = |s: &mut SteadySettings| s.method = SteadyMethod::Marching;
        for run in [
            Run::at_rest(&plain, 140, 1, 1.0),
            sweep(&plain, 97, |_| {}).with_random_starts(2),
            sweep(&plain, 97, march).with_random_starts(2),
            sweep(&scene(|s| s.dynamics.fidelity = Fidelity::Modal(10)), 97, |_| {}),
            sweep(&scene(|s| s.dynamics.fidelity = Fidelity::Full), 97, |_| {}),
            sweep(&plain, 97, |_| {}).followed().with_tables_of_each_motion(),
            Run::decays(&plain, 8, 8000),
        ] {
            let cost = run.cost();
            for dial in &run.dials {
                let mut more = run.clone();
                (dial.set)(&mut more, 2 * dial.value);
                let more = more.cost();
                let name = dial.words[0];
                assert!(more.bytes >= cost.bytes, "{name}: {more:?} after {cost:?}");
                // Where no contact is solved in a step, its tables are read.
                assert!(more.seconds >= cost.seconds, "{name}: {more:?} after {cost:?}");
            }
        }
        let seconds = |change: fn(&mut Scene)| sweep(&scene(change), 97, march).cost().seconds;
        let usual = seconds(|_| {});
        for change in [
            (|s| s.fe_contact.flank_elements = 28) as fn(&mut Scene),
            |s| s.dynamics.fidelity = Fidelity::MeshLaw,
            |s| s.dynamics.fidelity = Fidelity::Modal(2),
            |s| s.dynamics.fidelity = Fidelity::Full,
            |s| s.dynamics.kinematics = MeshKinematics::Exact,
        ] {
            assert!(seconds(change) > usual);
        }
        let cycles = |most: usize, between: usize| {
            let change = |s: &mut SteadySettings| {
                march(s);
                (s.most_cycles, s.between_cycles) = (most, between);
            };
            sweep(&plain, 97, change).cost().seconds
        };
        assert!(cycles(10, 0) < cycles(100, 0) && cycles(100, 0) < cycles(100, 1000));
    }

    /// Time on one core, s, measured on the machine of the constants; those follow from the runs of four planets alone.
    #[test]
    fn times_are_within_a_factor_of_three_of_those_measured() {
        let cells = |n| scene(move |s: &mut Scene| s.fe_contact.contact_cells = n);
        let steps = |n| scene(move |s: &mut Scene| s.dynamics.steps_per_cycle = n);
        let flanks = |n| scene(move |s: &mut Scene| s.fe_contact.flank_elements = n);
        let modes = |n| scene(move |s: &mut Scene| s.dynamics.fidelity = Fidelity::Modal(n));
        let (plain, usual) = (scene(|_| {}), |_: &mut SteadySettings| {});
        let exact = scene(|s| s.dynamics.kinematics = MeshKinematics::Exact);
        let of_twenty = |s: &mut SteadySettings| (s.most_cycles, s.between_cycles) = (20, 0);
        let (three, wind) = (shipped("oh58_3p"), shipped("wind_turbine_stage"));
        let (automatic, pair) = (shipped("automatic_transmission_set"), shipped("pair_50_50"));
        let law = |scene: &Scene| {
            let steady = SteadySettings::default();
            Run::motions(scene, Model::Lumped, &steady, ["motions", "--speeds-rpm"], 1)
        };
        for (what, run, measured) in [
            ("static", Run::at_rest(&plain, 140, 1, 1.0), 0.71),
            ("1400 positions", Run::at_rest(&plain, 1400, 1, 1.0), 4.93),
            ("160 cells", Run::at_rest(&cells(160), 140, 1, 1.0), 6.04),
            ("400 cells, 14 positions", Run::at_rest(&cells(400), 14, 1, 1.0), 14.9),
            ("40 flank elements", Run::at_rest(&flanks(40), 140, 1, 1.0), 2.53),
            ("interior point", Run::at_rest(&plain, 14, 1, 160.0), 9.11),
            ("sweep", sweep(&plain, 97, usual), 1.32),
            ("1400 steps", sweep(&steps(1400), 1, usual), 6.43),
            ("24 speeds, 160 cells", sweep(&cells(160), 24, usual), 14.9),
            ("8 random starts", sweep(&plain, 11, usual).with_random_starts(8), 15.4),
            ("2 modes", sweep(&modes(2), 2, usual), 34.4),
            ("30 modes", sweep(&modes(30), 1, usual), 65.0),
            ("lumped", law(&plain), 2.84),
            ("lumped, 1400 steps", law(&steps(1400)), 25.2),
            ("lumped, 160 cells", law(&cells(160)), 36.8),
            ("decays of 400 ms", Run::decays(&plain, 8, 80_000), 8.54),
            ("branch, 25 points", sweep(&plain, 25, usual).followed(), 2.04),
            ("exact", sweep(&exact, 1, of_twenty), 12.8),
            ("three planets, static", Run::at_rest(&three, 140, 1, 1.0), 0.54),
            ("three planets, sweep", sweep(&three, 21, usual), 0.84),
            ("wind turbine, static", Run::at_rest(&wind, 140, 1, 1.0), 0.56),
            ("wind turbine, sweep", sweep(&wind, 11, usual), 0.53),
            ("automatic transmission, static", Run::at_rest(&automatic, 140, 1, 1.0), 0.55),
            ("automatic transmission, sweep", sweep(&automatic, 21, usual), 0.82),
            ("pair, static", Run::at_rest(&pair, 140, 1, 1.0), 0.42),
            ("pair, sweep", sweep(&pair, 21, usual), 0.60),
            ("decays, 30 modes", Run::decays(&modes(30), 8, 8000), 77.6),
        ] {
            let ratio = run.cost().seconds / measured;
            println!("{what}: {ratio:.2}");
            assert!((1.0 / 3.0..3.0).contains(&ratio), "{what}: {ratio}");
        }
    }

    /// What a refusal says would do is usual, and the next is not.
    #[test]
    fn what_would_do_does() {
        let run = sweep(&scene(|_| {}), 100_000, |_| {}).with_random_starts(99);
        assert!(!run.cost().is_usual());
        for dial in &run.dials {
            let Some(most) = run.most(dial) else { continue };
            let with = |value| {
                let mut run = run.clone();
                (dial.set)(&mut run, value);
                run.cost().is_usual()
            };
            assert!(with(most) && !with(most + 1), "{dial:?}");
        }
        assert!(run.refusal(run.cost()).contains(" h on one core"));
    }
}
