//! What a verb is doing, on a terminal.

use std::borrow::Cow;
use std::io::IsTerminal;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// How often what has no length is redrawn.
const TICK: Duration = Duration::from_millis(120);

/// Progress on a terminal, nothing elsewhere, beginning with some words; `length`: number of steps, where it is known.
pub(crate) fn progress(template: &str, length: Option<u64>, words: &'static str) -> ProgressBar {
    let is_terminal = std::io::stderr().is_terminal();
    let target =
        if is_terminal { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(length, target).with_message(words);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    if is_terminal && length.is_none() {
        bar.enable_steady_tick(TICK);
    }
    bar
}

/// A spinner with words; it goes when it is dropped.
pub(crate) struct Working(ProgressBar);

impl Working {
    pub(crate) fn new(words: &'static str) -> Self {
        Self(progress("{spinner} {msg}, {elapsed}", None, words))
    }

    /// Goes on to something else.
    pub(crate) fn now(&self, words: impl Into<Cow<'static, str>>) {
        self.0.set_message(words);
    }
}

impl Drop for Working {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}
