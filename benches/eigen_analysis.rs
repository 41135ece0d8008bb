//! Time of one lumped analysis of OH-58 with four planets: assembly of M and K, eigenvalues and
//! vectors, mode types.
//!
//! Purpose: to check the claim that an analysis takes no longer than an eigenvalue call alone in SciPy.
//! `benches/eigen_vs_scipy.py` runs this binary and SciPy in turns. It is a plain binary instead of a
//! criterion bench so that the two can be interleaved; its arguments are described in `beside/mod.rs`.
//!
//! Noise: 5 % on a quiet machine. Time: under a second.

mod beside;

use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use beside::{Beside, Outcome, csv, quartiles};
use lumped::{LumpedModel, NaturalModes};
use scene::Scene;

/// Analyses of a batch of the summary.
const BATCH: u32 = 1000;

fn main() -> ExitCode {
    Beside { name: "eigen_analysis", summary, nanoseconds, dump }.main()
}

fn scene() -> Outcome<Scene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    Ok(Scene::from_file(&path)?)
}

/// The whole analysis, from the scene to frequencies with mode types.
fn analyse(scene: &Scene) -> Outcome<NaturalModes> {
    Ok(NaturalModes::of(&LumpedModel::from_scene(scene)?)?)
}

/// Mean time of one analysis over a batch, ns, after one analysis that is not timed.
fn nanoseconds(count: u32) -> Outcome<f64> {
    let scene = scene()?;
    black_box(analyse(&scene)?);
    let start = Instant::now();
    for _ in 0..count {
        black_box(analyse(black_box(&scene))?);
    }
    Ok(start.elapsed().as_nanos() as f64 / f64::from(count))
}

fn summary() -> Outcome<()> {
    let [low, median, high] = quartiles(|| nanoseconds(BATCH))?.map(|t| t / 1e3);
    println!("{}: {median:.2} µs an analysis [{low:.2}, {high:.2}]", scene()?.title);
    Ok(())
}

/// Writes K, M and the computed eigenvalues with all digits.
fn dump(folder: &Path) -> Outcome<()> {
    let model = LumpedModel::from_scene(&scene()?)?;
    let (k, n) = (model.stiffness(), model.mass.len());
    let mass = |i: usize, j: usize| if i == j { model.mass[i] } else { 0.0 };
    std::fs::write(folder.join("stiffness.csv"), csv(n, n, |i, j| k[(i, j)]))?;
    std::fs::write(folder.join("mass.csv"), csv(n, n, mass))?;
    let lambda = NaturalModes::of(&model)?.lambda;
    std::fs::write(folder.join("omega_squared.csv"), csv(lambda.len(), 1, |i, _| lambda[i]))?;
    Ok(())
}
