//! Progress of `validate`: one line per finished suite and, on a terminal, the suite that is running.

use std::io::{IsTerminal, Write};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use validation::Progress;

/// How often the seconds on a terminal are redrawn.
const TICK: Duration = Duration::from_millis(200);

/// Writes the progress of the suites to `err`.
pub(super) struct SuiteProgress<'e> {
    err: Mutex<&'e mut (dyn Write + Send)>,
    running: ProgressBar,
}

impl<'e> SuiteProgress<'e> {
    pub(super) fn new(err: &'e mut (dyn Write + Send)) -> Self {
        let is_terminal = std::io::stderr().is_terminal();
        let target = match is_terminal {
            true => ProgressDrawTarget::stderr(),
            false => ProgressDrawTarget::hidden(),
        };
        let running = ProgressBar::with_draw_target(None, target);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
            running.set_style(style);
        }
        if is_terminal {
            running.enable_steady_tick(TICK);
        }
        Self { err: Mutex::new(err), running }
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
