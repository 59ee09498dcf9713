//! Progress and the table of results on the terminal.
//!
//! On a terminal: colours (unless `NO_COLOR` is set), a table as wide as the
//! window, and a progress bar. Elsewhere: the same table as plain lines, without
//! escape codes, [`PLAIN_WIDTH`] wide.

mod explain;
mod ink;
mod layout;
mod table;
mod totals;

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::time::Duration;

use console::Term;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::again::Again;
use crate::output;
use crate::row::{Row, Summary};
use crate::text::clean;
use table::Table;

/// Width of the table where there is no terminal to ask.
pub const PLAIN_WIDTH: usize = 120;

/// A scene that was replayed.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneResult {
    /// `family/case`.
    pub name: String,
    /// What selects it on the command line: its name, or its file outside the corpus.
    pub argument: String,
    /// What the scene is for, from its file.
    pub purpose: String,
    /// Its rows.
    pub rows: Vec<Row>,
}

/// Reports a run as it goes.
pub struct Reporter {
    out: Box<dyn Write + Send>,
    table: Table,
    bar: ProgressBar,
    running: Vec<String>,
}

impl Reporter {
    /// A reporter on standard output, for a run of so many scenes; the progress
    /// bar is on standard error, if that is a terminal.
    pub fn new(total: usize) -> Self {
        let terminal = Term::stdout();
        let dumb = std::env::var("TERM").is_ok_and(|t| t == "dumb");
        let no_colour = std::env::var_os("NO_COLOR").is_some_and(|v| !v.is_empty());
        let width = match terminal.size_checked() {
            Some((_, columns)) if terminal.is_term() => usize::from(columns),
            _ => PLAIN_WIDTH,
        };
        let colour = io::stdout().is_terminal() && !dumb && !no_colour;
        let target = match dumb {
            true => ProgressDrawTarget::hidden(),
            false => ProgressDrawTarget::stderr(),
        };
        let bar = ProgressBar::with_draw_target(Some(total as u64), target);
        bar.set_style(style(colour));
        bar.enable_steady_tick(Duration::from_millis(200));
        Self {
            out: Box::new(output::stdout()),
            table: Table::new(width, colour),
            bar,
            running: Vec::new(),
        }
    }

    /// A reporter to anything, without progress bar.
    pub fn to(out: Box<dyn Write + Send>, width: usize, colour: bool) -> Self {
        Self {
            out,
            table: Table::new(width, colour),
            bar: ProgressBar::hidden(),
            running: Vec::new(),
        }
    }

    /// What the commands that run a scene again repeat of this run.
    #[must_use]
    pub fn with_again(mut self, again: Again) -> Self {
        self.table.again = again;
        self
    }

    /// Says on the progress bar that a scene is being replayed.
    pub fn scene_started(&mut self, name: &str) {
        self.running.push(clean(name).into_owned());
        self.bar.set_message(self.running.join(", "));
    }

    /// Prints the scene's line of the table, with lines that explain what diverged.
    ///
    /// # Errors
    ///
    /// If the output cannot be written; like all others here.
    pub fn scene_done(&mut self, scene: &SceneResult) -> io::Result<()> {
        let name = clean(&scene.name);
        self.running.retain(|running| *running != name);
        self.bar.set_message(self.running.join(", "));
        self.bar.inc(1);
        let lines = self.table.scene(scene);
        self.print(&lines)
    }

    /// Prints a remark between the scenes.
    ///
    /// # Errors
    ///
    /// As [`Self::scene_done`].
    pub fn remark(&mut self, text: &str) -> io::Result<()> {
        self.print(&[clean(text).into_owned()])
    }

    /// Prints totals and verdict, and where the report lies.
    ///
    /// # Errors
    ///
    /// As [`Self::scene_done`].
    pub fn finish(&mut self, summary: &Summary, report: Option<&Path>) -> io::Result<()> {
        self.bar.finish_and_clear();
        let mut lines = self.table.totals(summary);
        if let Some(path) = report {
            lines.push(format!("Report: {}", clean(&path.display().to_string())));
        }
        self.print(&lines)
    }

    fn print(&mut self, lines: &[String]) -> io::Result<()> {
        let out = &mut self.out;
        self.bar.suspend(|| {
            for line in lines {
                writeln!(out, "{}", line.trim_end())?;
            }
            out.flush()
        })
    }
}

fn style(colour: bool) -> ProgressStyle {
    let template = match colour {
        true => "{bar:24.cyan/dim} {pos}/{len} {elapsed} {wide_msg:.dim}",
        false => "{bar:24} {pos}/{len} {elapsed} {wide_msg}",
    };
    ProgressStyle::with_template(template)
        .expect("a template that a test parses")
        .progress_chars("━╸─")
}

#[cfg(test)]
mod tests;
