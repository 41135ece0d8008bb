//! Time of one step of the lumped time-varying model: OH-58 with four planets, 17 coordinates, eight
//! meshes whose forces are read from tables, 140 steps per mesh cycle.
//!
//! Purpose: to check the claim that a step costs about a microsecond. `benches/lumped_step_vs_numba.py` runs
//! this binary and the same steps compiled by Numba in turns. It is a plain binary instead of a criterion
//! bench so that the two can be interleaved; its arguments are described in `beside/mod.rs`.
//!
//! Noise: 5 % on a quiet machine. Time: some seconds.

mod beside;

use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use beside::{Beside, Outcome, csv, quartiles};
use gearset::{
    Axis, Body, Facing, MeshCurve, MeshLaw, MeshLawPlan, MeshStart, PairSprings, Phasing,
};
use lumped::{LumpedModel, SpringId, TimeVarying};
use scene::Scene;

/// Steps of a batch of the summary.
const BATCH: u32 = 100_000;

const STEPS: usize = 140;
const DUMPED_CYCLES: usize = 20;
const FREQUENCY_HZ: f64 = 565.714;
const TORQUE_NM: f64 = 1413.0;

/// Pair stiffness, contact ratio and gaps beyond the path, typical of this set.
const TEETH: PairSprings =
    PairSprings { stiffness: 2.2e8, contact_ratio: 1.62, gap_at_tenth: 4e-6 };

/// Largest deflection in the tables (m), and their number of steps.
const REACH: f64 = 60e-6;
const NODES: usize = 64;

/// Gap of the backside flanks, m.
const BACKLASH: f64 = 90e-6;

fn main() -> ExitCode {
    let nanoseconds = |count| Ok(marched(false, count)?.0);
    Beside { name: "lumped_step", summary, nanoseconds, dump }.main()
}

fn scene() -> Outcome<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    Ok(Scene::from_file(&path)?)
}

fn law(scene: &Scene, backside: bool) -> Outcome<MeshLaw> {
    let geometry = scene.tooth_geometry().map_err(|e| e.to_string())?;
    let phasing = Phasing::new(&geometry, &scene.planets).ok_or("no whole set")?;
    let mut starts = MeshStart::of_set(&phasing);
    for start in &mut starts {
        start.backside = backside.then_some(-start.front);
    }
    let plan = MeshLawPlan::new(&starts, STEPS)?;
    let curve = |key: &gearset::CurveKey| -> Outcome<MeshCurve> {
        let curve = TEETH.curve(key.phase, REACH, NODES)?;
        Ok(if key.side == gearset::FlankSide::Backside { curve.moved(BACKLASH) } else { curve })
    };
    let curves = plan.curves.iter().map(curve).collect::<Outcome<Vec<_>>>()?;
    Ok(plan.law(curves)?)
}

fn set(scene: &Scene, backside: bool) -> Outcome<TimeVarying> {
    let law = law(scene, backside)?;
    let mut set = TimeVarying::new(scene, Facing::CounterClockwise, law, FREQUENCY_HZ)?;
    set.rest(TORQUE_NM)?;
    Ok(set)
}

/// Mean time per step over a batch after the first cycles, ns, and mean number of iterations per step.
fn marched(backside: bool, count: u32) -> Outcome<(f64, f64)> {
    let mut set = set(&scene()?, backside)?;
    for _ in 0..DUMPED_CYCLES * STEPS {
        set.step()?;
    }
    let start = Instant::now();
    for _ in 0..count {
        black_box(&mut set).step()?;
    }
    Ok((start.elapsed().as_nanos() as f64 / f64::from(count), set.counts().0))
}

fn summary() -> Outcome<()> {
    for backside in [false, true] {
        let mut iterations = 0.0;
        let [low, median, high] = quartiles(|| {
            let (time, counted) = marched(backside, BATCH)?;
            iterations = counted;
            Ok(time)
        })?;
        let with = if backside { "with backside flanks in reach" } else { "front flanks" };
        println!(
            "{with}: {median:.0} ns a step [{low:.0}, {high:.0}], {iterations:.2} iterations each"
        );
    }
    Ok(())
}

/// Writes the problem and its solution with all digits: diagonal of M, C, K, the meshes' rows, f, the
/// displacements at rest, curves (start, step, then nodes as force and tangent), index of the curve of each
/// step and mesh, time step, β and number of steps; displacements, velocities and mesh forces after the last
/// step.
fn dump(folder: &Path) -> Outcome<()> {
    let scene = &scene()?;
    let model = LumpedModel::from_scene(scene)?;
    let law = law(scene, false)?;
    let n = model.coordinates.count();
    let mut k = vec![0.0; n * n];
    let mut rows = vec![0.0; law.meshes() * n];
    for spring in &model.springs {
        let mesh = match spring.id {
            SpringId::SunMesh(planet) => Some(planet),
            SpringId::RingMesh(planet) => Some(law.meshes() / 2 + planet),
            _ => None,
        };
        for row in &spring.rows {
            for &(i, bi) in row {
                match mesh {
                    Some(mesh) => rows[mesh * n + i] += bi,
                    None => {
                        row.iter().for_each(|&(j, b)| k[i * n + j] += spring.stiffness * bi * b)
                    }
                }
            }
        }
    }
    let d = scene.damping;
    let c = |i: usize, j: usize| {
        let own = if i == j { d.mass_proportional_per_s * model.mass[i] } else { 0.0 };
        own + d.bearing_s * k[i * n + j]
    };
    let mut f = vec![0.0; n];
    let radius =
        scene.lumped.as_ref().and_then(|l| l.radius_m.sun).ok_or("no radius of the sun")?;
    let sun = model.coordinates.of(Body::Sun, Axis::Rotation).ok_or("the sun does not turn")?;
    f[sun] = TORQUE_NM / radius;
    let mut set = set(scene, false)?;
    let rest = set.motion();
    for _ in 0..DUMPED_CYCLES * STEPS {
        set.step()?;
    }
    let (end, mut forces) = (set.motion(), Vec::new());
    set.mesh_forces(&mut forces);
    let nodes: Vec<Vec<f64>> = law
        .curves()
        .iter()
        .map(|curve| {
            let head = [curve.start_m(), curve.step_m()];
            head.into_iter().chain(curve.nodes().flat_map(|(f, t)| [f, t])).collect()
        })
        .collect();
    let place = |step: usize, mesh: usize| {
        let curve = law.front(mesh, step);
        law.curves().iter().position(|c| std::ptr::eq(c, curve)).unwrap_or(usize::MAX) as f64
    };
    let write = |name: &str, text: String| std::fs::write(folder.join(name), text);
    write("mass.csv", csv(n, 1, |i, _| model.mass[i]))?;
    write("damping.csv", csv(n, n, c))?;
    write("stiffness.csv", csv(n, n, |i, j| k[i * n + j]))?;
    write("rows.csv", csv(law.meshes(), n, |i, j| rows[i * n + j]))?;
    write("load.csv", csv(n, 1, |i, _| f[i]))?;
    write("rest.csv", csv(n, 1, |i, _| rest.x[i]))?;
    write("curves.csv", csv(nodes.len(), nodes[0].len(), |i, j| nodes[i][j]))?;
    write("places.csv", csv(STEPS, law.meshes(), place))?;
    write("end.csv", csv(n, 2, |i, j| if j == 0 { end.x[i] } else { end.v[i] }))?;
    write("forces.csv", csv(law.meshes(), 1, |i, _| forces[i]))?;
    let lag = d.stiffness_proportional_s;
    let numbers = [1.0 / (FREQUENCY_HZ * STEPS as f64), lag, (DUMPED_CYCLES * STEPS) as f64];
    write("numbers.csv", csv(3, 1, |i, _| numbers[i]))?;
    Ok(())
}
