//! The table: one line per scene, one column per pair of legs; but one for all that are
//! compared with themselves.

use console::{Style, measure_text_width};

use super::SceneResult;
use super::explain;
use super::ink::Ink;
use super::layout::{Layout, MARK, cut, pad, right};
use super::totals::Totals;
use crate::again::Again;
use crate::digest::{self, Pair, Times, column_order};
use crate::row::{Row, Summary, Verdict};
use crate::text::{clean, compact, count, plural, share, time};

/// What the table remembers between scenes.
pub struct Table {
    width: usize,
    ink: Ink,
    /// Pairs of legs that have a column, and [`digest::PLAN`].
    pairs: Vec<(String, String)>,
    /// Reasons for skipping, by the number that stands for them.
    reasons: Vec<String>,
    totals: Totals,
    /// The run, for the commands that run a scene again.
    pub again: Again,
}

impl Table {
    /// An empty table for a window of so many columns.
    pub fn new(width: usize, colour: bool) -> Self {
        Self {
            width,
            ink: Ink { colour },
            pairs: Vec::new(),
            reasons: Vec::new(),
            totals: Totals::default(),
            again: Again::default(),
        }
    }

    /// The lines after the last scene.
    pub fn totals(&self, summary: &Summary) -> Vec<String> {
        self.totals.lines(summary, self.ink)
    }

    /// The lines of a scene, with the header before the first scene and whenever a
    /// new pair of legs turns up.
    pub fn scene(&mut self, scene: &SceneResult) -> Vec<String> {
        self.totals.add(&scene.rows);
        let pairs = digest::pairs(&scene.rows);
        let columns = digest::columns(&scene.rows);
        let mut lines = self.header(&columns);
        let known = self.reasons.len();
        match Layout::fit(self.width, &self.pairs) {
            Some(layout) => lines.extend(self.columns(layout, scene, &columns)),
            None => lines.push(self.sentence(scene, &pairs)),
        }
        for (i, reason) in self.reasons.iter().enumerate().skip(known) {
            let line = format!("{}[{}] {}", " ".repeat(MARK), i + 1, clean(reason));
            lines.push(self.ink.paint(&line, Style::dim));
        }
        lines.extend(explain::scene(scene, &pairs, &self.again, self.ink));
        lines
    }

    fn header(&mut self, pairs: &[Pair<'_>]) -> Vec<String> {
        let label = |leg: &str| clean(leg).into_owned();
        let new: Vec<_> = pairs
            .iter()
            .map(|p| (label(p.a), label(p.b)))
            .filter(|pair| !self.pairs.contains(pair))
            .collect();
        let first = self.pairs.is_empty();
        if new.is_empty() {
            return Vec::new();
        }
        self.pairs.extend(new);
        self.pairs
            .sort_by(|x, y| column_order(&x.0, &x.1).cmp(&column_order(&y.0, &y.1)));
        let mut lines = Vec::new();
        if first {
            let legend = "✓ agrees, items compared   ✗ items that differ   – skipped, see [n]   \
                          c from the cache";
            lines.extend(wrapped(legend, self.width));
        }
        if let Some(layout) = Layout::fit(self.width, &self.pairs) {
            for i in layout.unclear(&self.pairs) {
                let (a, b) = &self.pairs[i];
                let legs = match (a.as_str(), b.as_str()) {
                    digest::PLAN => "each GPU leg against itself with --no-skip".to_owned(),
                    _ => format!("{a} against {b}"),
                };
                lines.push(format!("column {}: {legs}", i + 1));
            }
            lines.push(String::new());
            lines.extend(layout.header(&self.pairs));
            let rule = MARK + layout.name + self.pairs.len() * layout.cell;
            lines.push("─".repeat(rule + layout.edge + 2 * layout.time));
        }
        let dim = |line: &String| self.ink.paint(line, Style::dim);
        lines.iter().map(dim).collect()
    }

    fn columns(&mut self, layout: Layout, scene: &SceneResult, pairs: &[Pair<'_>]) -> Vec<String> {
        let mut lines = Vec::new();
        let mut line = self.mark(&scene.rows);
        let name = clean(&scene.name).into_owned();
        if measure_text_width(&name) > layout.name {
            // A line of its own rather than half a name.
            lines.push(format!("{line}{name}"));
            line = " ".repeat(MARK + layout.name);
        } else {
            line.push_str(&pad(&name, layout.name));
        }
        for (a, b) in &self.pairs.clone() {
            let pair = pairs.iter().find(|p| clean(p.a) == *a && clean(p.b) == *b);
            let cell = pair.map_or(String::new(), |pair| self.cell(pair, layout));
            line.push_str(&right(&cell, layout.cell));
        }
        if layout.edge > 0 {
            line.push_str(&right(&self.edge(&scene.rows), layout.edge));
        }
        if layout.time > 0 {
            let (spec, gpu) = times(&scene.rows);
            for ms in [spec, gpu] {
                line.push_str(&right(&ms.map_or(String::new(), time), layout.time));
            }
        }
        lines.push(line);
        lines
    }

    /// A scene where there is no room for columns.
    fn sentence(&mut self, scene: &SceneResult, pairs: &[Pair<'_>]) -> String {
        let count_of = |v| pairs.iter().filter(|p| p.verdict() == v).count() as u64;
        let mut parts = vec![clean(&scene.name).into_owned()];
        let of = plural(pairs.len() as u64, "pair");
        parts.push(match count_of(Verdict::Diverge) {
            0 => format!("{} of {of} agree", count_of(Verdict::Agree)),
            n => format!("{n} of {of} diverge"),
        });
        let compared = digest::sum(scene.rows.iter().map(|r| r.compared));
        parts.push(format!("{} items", compact(compared)));
        if digest::edge_share(&scene.rows).is_some() {
            parts.push(format!("edge {}", self.edge(&scene.rows)));
        }
        for pair in pairs.iter().filter(|p| p.verdict() == Verdict::Skipped) {
            let reason = self.reason(pair);
            parts.push(format!("– {} {reason}", clean(pair.b)));
        }
        format!("{}{}", self.mark(&scene.rows), parts.join(", "))
    }

    fn mark(&self, rows: &[Row]) -> String {
        let sign = match digest::verdict(rows) {
            Verdict::Agree => self.ink.paint("✓", Style::green),
            Verdict::Skipped => self.ink.paint("–", Style::yellow),
            Verdict::Diverge => self.ink.paint("✗", |s| s.red().bold()),
        };
        let cached = if rows.iter().any(|r| r.cached) {
            'c'
        } else {
            ' '
        };
        format!("{sign}{cached} ")
    }

    fn cell(&mut self, pair: &Pair<'_>, layout: Layout) -> String {
        let number = |n: u64| match count(n) {
            full if layout.full && full.len() <= layout.cell - 3 => full,
            _ => compact(n),
        };
        match pair.verdict() {
            Verdict::Agree => format!(
                "{} {}",
                self.ink.paint("✓", Style::green),
                number(pair.compared())
            ),
            Verdict::Diverge => {
                let text = match pair.differ() {
                    0 => "✗ see below".to_owned(),
                    n => format!("✗ {}", number(n)),
                };
                self.ink.paint(&text, |s| s.red().bold())
            }
            Verdict::Skipped => {
                let text = format!("– {}", self.reason(pair));
                self.ink.paint(&text, Style::yellow)
            }
        }
    }

    /// The number of the reason why a pair compared nothing.
    fn reason(&mut self, pair: &Pair<'_>) -> String {
        let reasons: Vec<&str> = digest::skips(pair.rows.iter().copied())
            .into_iter()
            .map(|(reason, _)| reason)
            .collect();
        let reason = reasons.join("; ");
        let known = self.reasons.iter().position(|r| *r == reason);
        let at = known.unwrap_or_else(|| {
            self.reasons.push(reason);
            self.reasons.len() - 1
        });
        format!("[{}]", at + 1)
    }

    fn edge(&self, rows: &[Row]) -> String {
        match digest::edge_share(rows) {
            None => String::new(),
            Some((part, false)) => share(part),
            Some((part, true)) => self
                .ink
                .paint(&format!("{}!", share(part)), |s| s.red().bold()),
        }
    }
}

/// Milliseconds of the spec, and of the fastest GPU leg.
fn times(rows: &[Row]) -> (Option<f64>, Option<f64>) {
    let times = Times::of(rows);
    let of = |is: &dyn Fn(&str) -> bool| {
        let legs = times.legs.iter().enumerate().filter(|(_, leg)| is(leg));
        legs.filter_map(|(i, _)| times.total(i)).reduce(f64::min)
    };
    (of(&|leg| leg == "spec"), of(&|leg| leg.starts_with("gpu")))
}

/// A legend's entries, three spaces apart, on as many lines as the width needs.
fn wrapped(legend: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for entry in legend.split("   ") {
        match lines.last_mut() {
            Some(line) if measure_text_width(line) + 3 + measure_text_width(entry) <= width => {
                line.push_str("   ");
                line.push_str(entry);
            }
            _ => lines.push(cut(entry, width)),
        }
    }
    lines
}
