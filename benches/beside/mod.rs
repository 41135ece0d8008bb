//! What the benches that run in turns with a rival in Python have in common: a plain binary that prints
//! one number for a batch, or the problem as CSV, so that both sides solve the same.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

pub type Outcome<T> = Result<T, Box<dyn Error>>;

/// What such a bench does.
pub struct Beside {
    pub name: &'static str,
    /// Medians of a few batches, for reading.
    pub summary: fn() -> Outcome<()>,
    /// Nanoseconds for one solution, averaged over so many.
    pub nanoseconds: fn(u32) -> Outcome<f64>,
    /// The problem and its solution as CSV files in a folder.
    pub dump: fn(&Path) -> Outcome<()>,
}

impl Beside {
    /// `NAME` prints the summary, `--batch COUNT` one number, `--dump FOLDER` writes; `--test` solves
    /// once, as benches do under `cargo bench -- --test`.
    pub fn main(&self) -> ExitCode {
        // `cargo bench` adds `--bench`.
        let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        match self.run(&arguments) {
            Ok(()) => ExitCode::SUCCESS,
            Err(error) => {
                eprintln!("{}: {error}", self.name);
                ExitCode::from(2)
            }
        }
    }

    fn run(&self, arguments: &[&str]) -> Outcome<()> {
        match arguments {
            [] => (self.summary)(),
            ["--test"] => (self.nanoseconds)(1).map(|_| ()),
            ["--batch", count] => {
                println!("{:.2}", (self.nanoseconds)(count.parse::<u32>()?.max(1))?);
                Ok(())
            }
            ["--dump", folder] => (self.dump)(Path::new(folder)),
            _ => {
                Err(format!("usage: {} [--batch COUNT | --dump FOLDER | --test]", self.name).into())
            }
        }
    }
}

/// Lower quartile, median and upper quartile of nine batches.
pub fn quartiles(mut batch: impl FnMut() -> Outcome<f64>) -> Outcome<[f64; 3]> {
    let mut times = (0..9).map(|_| batch()).collect::<Outcome<Vec<f64>>>()?;
    times.sort_by(f64::total_cmp);
    Ok([2, 4, 6].map(|i| times[i]))
}

/// A matrix, every digit.
pub fn csv(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> String {
    let line = |i| (0..columns).map(|j| format!("{:e}", entry(i, j))).collect::<Vec<_>>().join(",");
    (0..rows).map(|i| line(i) + "\n").collect()
}
