//! Time of one lumped analysis of OH-58 with four planets: assembly of M and K, eigenvalues and
//! vectors, mode types.
//!
//! Purpose: the promise that an analysis costs no more than a bare eigenvalue call elsewhere;
//! `benches/eigen_vs_scipy.py` runs this binary in turns with SciPy. A plain binary rather than a
//! criterion bench, so that the two can be interleaved.
//!
//! ```text
//! eigen_analysis                  medians of a few batches, for reading
//! eigen_analysis --batch COUNT    nanoseconds for one analysis, averaged over COUNT, one number
//! eigen_analysis --dump FOLDER    stiffness.csv, mass.csv, omega_squared.csv
//! ```
//!
//! Noise: 5 % on a quiet machine. Time: under a second.

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use gearset::Scene;
use lumped::{LumpedModel, NaturalModes};

/// Batches and their size when nothing is asked for.
const BATCHES: usize = 9;
const BATCH: u32 = 1000;

type Outcome<T> = Result<T, Box<dyn Error>>;

fn main() -> ExitCode {
    // `cargo bench` adds `--bench`.
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("eigen_analysis: {error}");
            ExitCode::from(2)
        }
    }
}

fn run(arguments: &[&str]) -> Outcome<()> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/oh58_4p.toml");
    let scene = Scene::from_file(&path)?;
    match arguments {
        [] => summary(&scene),
        ["--batch", count] => {
            let count: u32 = count.parse()?;
            println!("{:.1}", nanoseconds(&scene, count.max(1))?);
            Ok(())
        }
        ["--dump", folder] => dump(&scene, Path::new(folder)),
        _ => Err("usage: eigen_analysis [--batch COUNT | --dump FOLDER]".into()),
    }
}

/// The whole analysis, from the scene to frequencies with mode types.
fn analyse(scene: &Scene) -> Outcome<NaturalModes> {
    Ok(NaturalModes::of(&LumpedModel::from_scene(scene)?)?)
}

/// Mean time of one analysis over a batch, ns, the first one left out.
fn nanoseconds(scene: &Scene, count: u32) -> Outcome<f64> {
    black_box(analyse(scene)?);
    let start = Instant::now();
    for _ in 0..count {
        black_box(analyse(black_box(scene))?);
    }
    Ok(start.elapsed().as_nanos() as f64 / f64::from(count))
}

fn summary(scene: &Scene) -> Outcome<()> {
    let mut times = (0..BATCHES).map(|_| nanoseconds(scene, BATCH)).collect::<Outcome<Vec<_>>>()?;
    times.sort_by(f64::total_cmp);
    let [low, median, high] = [BATCHES / 4, BATCHES / 2, 3 * BATCHES / 4].map(|i| times[i] / 1e3);
    println!("{}: {median:.2} µs an analysis [{low:.2}, {high:.2}]", scene.title);
    Ok(())
}

/// Writes K, M and the eigenvalues found, every digit.
fn dump(scene: &Scene, folder: &Path) -> Outcome<()> {
    let model = LumpedModel::from_scene(scene)?;
    let (k, n) = (model.stiffness(), model.mass.len());
    let mass = |i: usize, j: usize| if i == j { model.mass[i] } else { 0.0 };
    std::fs::write(folder.join("stiffness.csv"), csv(n, n, |i, j| k[(i, j)]))?;
    std::fs::write(folder.join("mass.csv"), csv(n, n, mass))?;
    let lambda = NaturalModes::of(&model)?.lambda;
    std::fs::write(folder.join("omega_squared.csv"), csv(lambda.len(), 1, |i, _| lambda[i]))?;
    Ok(())
}

fn csv(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> String {
    let line = |i| (0..columns).map(|j| format!("{:e}", entry(i, j))).collect::<Vec<_>>().join(",");
    (0..rows).map(|i| line(i) + "\n").collect()
}
