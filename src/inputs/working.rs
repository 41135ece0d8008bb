//! What a verb is doing, on a terminal.

use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A spinner with words on a terminal, nothing elsewhere; it goes when it is dropped.
pub(crate) struct Working(ProgressBar);

impl Working {
    pub(crate) fn new(words: &'static str) -> Self {
        let is_terminal = std::io::stderr().is_terminal();
        let target =
            if is_terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
        let bar = ProgressBar::with_draw_target(None, target).with_message(words);
        let bar = match ProgressStyle::with_template("{spinner} {msg}, {elapsed}") {
            Ok(style) => bar.with_style(style),
            Err(_) => bar,
        };
        if is_terminal {
            bar.enable_steady_tick(Duration::from_millis(120));
        }
        Self(bar)
    }

    /// Goes on to something else.
    pub(crate) fn now(&self, words: &'static str) {
        self.0.set_message(words);
    }

    /// The same with words put together as the work goes on.
    pub(crate) fn say(&self, words: &str) {
        self.0.set_message(words.to_owned());
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
