//! How far a run is, on standard error: a bar on a terminal, plain lines elsewhere.

use std::io::{self, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::text::clean;

/// Tells how far a run is.
pub struct Progress {
    bar: ProgressBar,
    plain: bool,
}

impl Progress {
    /// On standard error.
    pub fn new() -> Self {
        let dumb = std::env::var("TERM").is_ok_and(|t| t == "dumb");
        let plain = dumb || !io::stderr().is_terminal();
        let bar = match plain {
            true => ProgressBar::hidden(),
            false => ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr()),
        };
        bar.set_style(
            ProgressStyle::with_template("{bar:24} {pos}/{len} {elapsed} {wide_msg}")
                .expect("a sound template"),
        );
        Self { bar, plain }
    }

    /// Something of so many steps begins.
    pub fn begin(&self, what: &str, steps: u32) {
        let what = clean(what);
        self.bar.set_length(steps.into());
        self.bar.set_position(0);
        self.bar.set_message(what.clone().into_owned());
        if self.plain {
            // If nobody listens there, the run goes on all the same.
            let _ = writeln!(io::stderr(), "{what}");
        }
    }

    /// One step is done.
    pub fn step(&self) {
        self.bar.inc(1);
    }

    /// All is done.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

impl Default for Progress {
    fn default() -> Self {
        Self::new()
    }
}
