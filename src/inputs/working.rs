//! What a verb is doing: on a terminal all the time, elsewhere a line every ten seconds.

use std::borrow::Cow;
use std::io::{IsTerminal, Write};
use std::ops::Deref;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How often a terminal is redrawn.
const TICK: Duration = Duration::from_millis(120);

/// How often a line is written where there is no terminal.
const LINE: Duration = Duration::from_secs(10);

/// Progress on standard error; it goes when it is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    lines: Option<Lines>,
}

/// Progress that begins with some words; `template`: how a terminal shows it; `length`: number of steps, where it
/// is known.
pub(crate) fn progress(template: &str, length: Option<u64>, words: &'static str) -> Progress {
    let is_terminal = std::io::stderr().is_terminal();
    let target =
        if is_terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(length, target).with_message(words);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if is_terminal {
        // The first step may take minutes.
        bar.enable_steady_tick(TICK);
        return Progress { bar, lines: None };
    }
    let lines = Lines::new(bar.clone(), LINE, std::io::stderr());
    Progress { bar, lines: Some(lines) }
}

impl Deref for Progress {
    type Target = ProgressBar;

    fn deref(&self) -> &ProgressBar {
        &self.bar
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.lines = None;
        self.bar.finish_and_clear();
    }
}

/// Writes a line of progress at even intervals until it is dropped.
struct Lines {
    stop: Option<Sender<()>>,
    writer: Option<JoinHandle<()>>,
}

impl Lines {
    fn new(bar: ProgressBar, every: Duration, mut out: impl Write + Send + 'static) -> Self {
        let (stop, stopped) = channel();
        let writer = std::thread::spawn(move || {
            while stopped.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                // A line that cannot be written is no reason to stop computing.
                let _ = writeln!(out, "{}", line(&bar));
            }
        });
        Self { stop: Some(stop), writer: Some(writer) }
    }
}

impl Drop for Lines {
    fn drop(&mut self) {
        self.stop = None;
        if let Some(writer) = self.writer.take() {
            let _ = writer.join();
        }
    }
}

/// What is done, of how many, for how long, and an estimate of what is left.
fn line(bar: &ProgressBar) -> String {
    let (words, seconds) = (bar.message(), bar.elapsed().as_secs());
    match (bar.length(), bar.position()) {
        (None, _) => format!("{words}, {seconds} s"),
        (Some(all), 0) => format!("0 of {all} {words}, {seconds} s"),
        (Some(all), done) => {
            let left = bar.eta().as_secs();
            format!("{done} of {all} {words}, {seconds} s, about {left} s to go")
        }
    }
}

/// A spinner with words; it goes when it is dropped.
pub(crate) struct Working(Progress);

impl Working {
    pub(crate) fn new(words: &'static str) -> Self {
        Self(progress("{spinner} {msg}, {elapsed}", None, words))
    }

    /// Goes on to something else.
    pub(crate) fn now(&self, words: impl Into<Cow<'static, str>>) {
        self.0.set_message(words);
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, Mutex};

    use super::*;

    #[derive(Clone, Default)]
    struct Shared(Arc<Mutex<Vec<u8>>>);

    impl Write for Shared {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    /// Lines come at intervals, say what is done, and end with the work.
    #[test]
    fn lines_say_what_is_done_until_it_ends() {
        let out = Shared::default();
        let text = || String::from_utf8(out.0.lock().unwrap().clone()).unwrap();
        let bar = ProgressBar::hidden().with_message("speeds");
        bar.set_length(5);
        let every = Duration::from_millis(10);
        let lines = Lines::new(bar.clone(), every, out.clone());
        // However long a busy machine takes for a line, the seconds in it may be any.
        while !text().contains("0 of 5 speeds, ") {
            std::thread::sleep(every);
        }
        bar.inc(2);
        while !text().contains("2 of 5 speeds, ") || !text().contains(" s to go\n") {
            std::thread::sleep(every);
        }
        drop(lines);
        let ended = text();
        std::thread::sleep(5 * every);
        assert_eq!(text(), ended);
    }

    #[test]
    fn what_is_over_at_once_writes_nothing() {
        let out = Shared::default();
        drop(Lines::new(ProgressBar::hidden(), LINE, out.clone()));
        assert!(out.0.lock().unwrap().is_empty());
    }
}
