//! What a run amounts to.

use std::collections::BTreeMap;

use console::Style;

use super::explain;
use super::ink::Ink;
use crate::cause::Cause;
use crate::digest;
use crate::row::{Row, Summary, Verdict};
use crate::text::{clean, count, plural, time};

/// Counts over the scenes so far that the summary does not hold.
#[derive(Debug, Default)]
pub struct Totals {
    /// Rows skipped, by reason.
    skipped: BTreeMap<String, u64>,
    causes: BTreeMap<Cause, u64>,
    /// Scenes, also those without rows, which the summary cannot count.
    scenes: u64,
    /// Scenes that diverge.
    diverging: u64,
    admitted: u64,
    cached: u64,
}

impl Totals {
    /// Adds a scene.
    pub fn add(&mut self, rows: &[Row]) {
        self.scenes += 1;
        self.diverging += u64::from(digest::verdict(rows) == Verdict::Diverge);
        let admitted = digest::sum(rows.iter().map(|r| r.admitted));
        self.admitted = self.admitted.saturating_add(admitted);
        self.cached += digest::sum(rows.iter().map(|r| u64::from(r.cached)));
        for (reason, n) in digest::skips(rows) {
            *self.skipped.entry(reason.to_owned()).or_default() += n;
        }
        for (cause, n) in digest::causes(rows) {
            let entry = self.causes.entry(cause).or_default();
            *entry = entry.saturating_add(n);
        }
    }

    /// The verdict first, then what else there is to know.
    pub fn lines(&self, summary: &Summary, ink: Ink) -> Vec<String> {
        let mut lines = vec![
            String::new(),
            format!(
                "{}, {} compared, {} unexplained, {}",
                self.verdict(summary, ink),
                plural(summary.compared, "item"),
                count(summary.unexplained),
                time(summary.seconds * 1000.0),
            ),
        ];
        if !self.causes.is_empty() {
            let causes = explain::causes(&self.causes);
            lines.push(format!("Causes, over all stages: {causes}"));
        }
        if self.admitted > 0 {
            let n = count(self.admitted);
            lines.push(format!("Counted but not judged (edge, MAY, admitted): {n}"));
        }
        if self.cached > 0 {
            lines.push(format!("From the cache: {}", plural(self.cached, "row")));
        }
        if summary.skipped > 0 {
            lines.push(format!("Skipped: {}", plural(summary.skipped, "row")));
            let mut reasons: Vec<_> = self.skipped.iter().collect();
            reasons.sort_by_key(|&(_, n)| std::cmp::Reverse(n));
            for (reason, n) in reasons {
                lines.push(format!("{:>9}  {}", count(*n), clean(reason)));
            }
        }
        lines
    }

    fn verdict(&self, summary: &Summary, ink: Ink) -> String {
        let scenes = plural(self.scenes, "scene");
        let bad: fn(Style) -> Style = |s| s.red().bold();
        if self.diverging > 0 {
            let verb = if self.diverging == 1 {
                "diverges"
            } else {
                "diverge"
            };
            let diverging = count(self.diverging);
            ink.paint(&format!("{diverging} of {scenes} {verb}"), bad)
        } else if summary.compared == 0 {
            ink.paint("Nothing was compared", bad)
        } else {
            ink.paint(&format!("All agree: {scenes}"), |s| s.green().bold())
        }
    }
}
