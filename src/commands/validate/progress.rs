//! Progress of `validate`: one line per finished suite and, on a terminal, the suite that is running.

use std::io::Write;
use std::sync::{Mutex, PoisonError};

use validation::Progress;

use crate::inputs;

/// Writes the progress of the suites to `err`.
pub(super) struct SuiteProgress<'e> {
    err: Mutex<&'e mut (dyn Write + Send)>,
    running: inputs::Progress,
}

impl<'e> SuiteProgress<'e> {
    pub(super) fn new(err: &'e mut (dyn Write + Send)) -> Self {
        Self {
            err: Mutex::new(err),
            running: inputs::progress("{spinner} {msg} {elapsed}", None, ""),
        }
    }

    pub(super) fn tell(&self, progress: Progress<'_>) {
        match progress {
            Progress::SuiteStarted(name) => {
                self.running.reset_elapsed();
                self.running.set_message(name.to_owned());
            }
            Progress::SuiteEnded { name, seconds, checks } => {
                let plural = if checks == 1 { "" } else { "s" };
                let line = format!("{name}: {checks} check{plural}, {seconds:.1} s");
                // A line that cannot be written is no reason to stop checking.
                self.running.suspend(|| {
                    let mut err = self.err.lock().unwrap_or_else(PoisonError::into_inner);
                    let _ = writeln!(err, "{line}");
                });
            }
        }
    }

    /// Removes the line of the running suite from the terminal.
    pub(super) fn finish(self) {
        self.running.finish_and_clear();
    }
}
