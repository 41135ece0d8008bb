//! Shared by the benches that are timed in turns with a Python program: a plain binary that prints the time
//! per solution of a batch, or writes the problem as CSV files so that both programs solve the same problem.

use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

pub(crate) type Outcome<T> = Result<T, Box<dyn Error>>;

/// The functions of such a bench.
pub(crate) struct Beside {
    pub(crate) name: &'static str,
    /// Prints medians and quartiles over a few batches.
    pub(crate) summary: fn() -> Outcome<()>,
    /// Nanoseconds per solution, averaged over this number of solutions.
    pub(crate) nanoseconds: fn(u32) -> Outcome<f64>,
    /// Writes the problem and its solution as CSV files into a folder.
    pub(crate) dump: fn(&Path) -> Outcome<()>,
}

impl Beside {
    /// Without arguments prints the summary, with `--batch COUNT` the nanoseconds per solution; `--dump
    /// FOLDER` writes the files; `--test` solves once, as benches do under `cargo bench -- --test`.
    pub(crate) fn main(&self) -> ExitCode {
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
pub(crate) fn quartiles(mut batch: impl FnMut() -> Outcome<f64>) -> Outcome<[f64; 3]> {
    let mut times = (0..9).map(|_| batch()).collect::<Outcome<Vec<f64>>>()?;
    times.sort_by(f64::total_cmp);
    Ok([2, 4, 6].map(|i| times[i]))
}

/// A matrix as CSV with all digits.
pub(crate) fn csv(rows: usize, columns: usize, entry: impl Fn(usize, usize) -> f64) -> String {
    let line = |i| (0..columns).map(|j| format!("{:e}", entry(i, j))).collect::<Vec<_>>().join(",");
    (0..rows).map(|i| line(i) + "\n").collect()
}
