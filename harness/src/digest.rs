//! Rows drawn together for people: by pair of legs, by stage and leg.

use std::collections::BTreeMap;

use triptych_gpu::raster::Path;

use crate::cause::Cause;
use crate::row::{Row, Verdict};

/// All stages of one scene between the same two legs.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair<'a> {
    /// First leg.
    pub a: &'a str,
    /// Second leg.
    pub b: &'a str,
    /// The rows, in the order in which they came.
    pub rows: Vec<&'a Row>,
}

impl Pair<'_> {
    /// Diverges if any stage does; agrees if no stage diverges and any agrees.
    pub fn verdict(&self) -> Verdict {
        verdict(self.rows.iter().copied())
    }

    /// Items compared, over all stages.
    pub fn compared(&self) -> u64 {
        sum(self.rows.iter().map(|r| r.compared))
    }

    /// Items that differ at the first stage that diverges, with or without a
    /// cause; later stages inherit them. Pairs that share a column are added up.
    pub fn differ(&self) -> u64 {
        let mut first: Vec<&Row> = Vec::new();
        for row in &self.rows {
            let known = first.iter().any(|r| r.a == row.a && r.b == row.b);
            if row.verdict() == Verdict::Diverge && !known {
                first.push(row);
            }
        }
        sum(first.iter().map(|r| r.differ.max(r.unexplained)))
    }

    /// Whether its column is [`PLAN`].
    fn is_plan(&self) -> bool {
        self.rows.iter().all(|r| r.stage == "plan")
    }
}

/// The column of all legs that are compared with themselves, with and without skipping.
pub const PLAN: (&str, &str) = ("gpu", "plan");

/// The order of columns: GPU legs, Embree, then what a GPU leg is compared with
/// beside the spec, then the rest.
pub fn column_order<'a>(a: &'a str, b: &'a str) -> impl Ord + use<'a> {
    let rank = match (leg_parts(a).0, leg_parts(b).0) {
        ("spec", "gpu") => 0,
        ("spec", "embree") => 1,
        ("gpu", _) => 2,
        _ => 3,
    };
    (rank, b, a)
}

/// The verdict of several rows together; no rows at all diverge, because nothing
/// compared is never a pass.
pub fn verdict<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Verdict {
    let verdicts: Vec<Verdict> = rows.into_iter().map(Row::verdict).collect();
    if verdicts.is_empty() || verdicts.contains(&Verdict::Diverge) {
        Verdict::Diverge
    } else if verdicts.contains(&Verdict::Agree) {
        Verdict::Agree
    } else {
        Verdict::Skipped
    }
}

/// A sum that stops at the largest `u64`: counts that come from a file may be
/// anything.
pub fn sum(counts: impl IntoIterator<Item = u64>) -> u64 {
    counts.into_iter().fold(0, u64::saturating_add)
}

/// Rows by pair of legs, in order of first appearance.
pub fn pairs(rows: &[Row]) -> Vec<Pair<'_>> {
    let mut pairs: Vec<Pair<'_>> = Vec::new();
    for row in rows {
        match pairs.iter_mut().find(|p| p.a == row.a && p.b == row.b) {
            Some(pair) => pair.rows.push(row),
            None => pairs.push(Pair {
                a: &row.a,
                b: &row.b,
                rows: vec![row],
            }),
        }
    }
    pairs
}

/// Rows by column of a table: a pair of legs, or all that [`PLAN`] holds.
pub fn columns(rows: &[Row]) -> Vec<Pair<'_>> {
    let (plan, mut columns): (Vec<_>, Vec<_>) = pairs(rows).into_iter().partition(Pair::is_plan);
    let rows: Vec<&Row> = plan.into_iter().flat_map(|pair| pair.rows).collect();
    let (a, b) = PLAN;
    columns.extend((!rows.is_empty()).then_some(Pair { a, b, rows }));
    columns
}

/// Rows by scene, in order of first appearance.
pub fn scenes(rows: &[Row]) -> Vec<(&str, Vec<Row>)> {
    let mut index: BTreeMap<&str, usize> = BTreeMap::new();
    let mut scenes: Vec<(&str, Vec<Row>)> = Vec::new();
    for row in rows {
        let at = *index.entry(&row.scene).or_insert(scenes.len());
        if at == scenes.len() {
            scenes.push((&row.scene, Vec::new()));
        }
        scenes[at].1.push(row.clone());
    }
    scenes
}

/// Causes over several rows, and how many of each.
pub fn causes<'a>(rows: impl IntoIterator<Item = &'a Row>) -> BTreeMap<Cause, u64> {
    let mut total: BTreeMap<Cause, u64> = BTreeMap::new();
    for (&cause, &n) in rows.into_iter().flat_map(|r| &r.causes) {
        let entry = total.entry(cause).or_default();
        *entry = entry.saturating_add(n);
    }
    total
}

/// Why rows compared nothing, and how many rows each, most frequent first.
pub fn skips<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Vec<(&'a str, u64)> {
    let mut total: BTreeMap<&str, u64> = BTreeMap::new();
    for reason in rows.into_iter().filter_map(|r| r.skipped.as_deref()) {
        *total.entry(reason).or_default() += 1;
    }
    let mut skips: Vec<_> = total.into_iter().collect();
    skips.sort_by_key(|&(_, n)| std::cmp::Reverse(n));
    skips
}

/// The largest share of items that were counted but not judged, over rows that
/// hold it to a budget; and whether any row exceeds its own.
pub fn edge_share<'a>(rows: impl IntoIterator<Item = &'a Row>) -> Option<(f64, bool)> {
    let of = |row: &Row| {
        let budget = row.admitted_budget?;
        let share = row.admitted_share();
        (row.compared > 0).then_some((share, share > budget))
    };
    rows.into_iter()
        .filter_map(of)
        .reduce(|a, b| (a.0.max(b.0), a.1 || b.1))
}

/// Rows whose times hold what other rows count too: all stages in one, and the
/// lists of `build` before their buffers grew.
const AGAIN: [&str; 3] = ["end to end", "overflow", "plan"];

/// Milliseconds of every stage of every leg, each counted once however many
/// pairs it takes part in. Stages and legs are in order of first appearance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Times<'a> {
    /// Legs that were timed.
    pub legs: Vec<&'a str>,
    /// Stage, and one entry per leg.
    pub stages: Vec<(&'a str, Vec<Option<f64>>)>,
}

impl<'a> Times<'a> {
    /// Collects the times of one scene.
    pub fn of(rows: &'a [Row]) -> Self {
        let mut times = Times::default();
        for row in rows {
            for (leg, ms) in [(&row.a, row.ms_a), (&row.b, row.ms_b)] {
                if let Some(ms) = ms {
                    times.put(&row.stage, leg, ms);
                }
            }
        }
        let legs = times.legs.len();
        for (_, cells) in &mut times.stages {
            cells.resize(legs, None);
        }
        times
    }

    fn put(&mut self, stage: &'a str, leg: &'a str, ms: f64) {
        let column = position_or_push(&mut self.legs, |l| *l == leg, || leg);
        let row = position_or_push(
            &mut self.stages,
            |(s, _)| *s == stage,
            || (stage, Vec::new()),
        );
        let cells = &mut self.stages[row].1;
        if cells.len() <= column {
            cells.resize(column + 1, None);
        }
        cells[column].get_or_insert(ms);
    }

    /// All stages of a leg together; `None` if none was timed.
    pub fn total(&self, leg: usize) -> Option<f64> {
        let single = self.stages.iter().filter(|(s, _)| !AGAIN.contains(s));
        let times = single.filter_map(|(_, cells)| cells[leg]);
        times.reduce(|sum, ms| sum + ms)
    }
}

fn position_or_push<T>(list: &mut Vec<T>, is: impl Fn(&T) -> bool, new: impl Fn() -> T) -> usize {
    list.iter().position(is).unwrap_or_else(|| {
        list.push(new());
        list.len() - 1
    })
}

/// A leg's label taken apart: `gpu@llvmpipe/fragment` is leg `gpu`, adapter
/// `llvmpipe`, path `fragment`.
pub fn leg_parts(label: &str) -> (&str, Option<&str>, Option<&str>) {
    let Some((leg, rest)) = label.split_once('@') else {
        return (label, None, None);
    };
    // A leg that could not run has no path, and an adapter's name may have a slash.
    let known = |path: &str| {
        Path::ALL
            .iter()
            .any(|p| path.split(' ').next() == Some(p.name()))
    };
    match rest.rsplit_once('/').filter(|(_, path)| known(path)) {
        Some((adapter, path)) => (leg, Some(adapter), Some(path)),
        None => (leg, Some(rest), None),
    }
}

#[cfg(test)]
pub(crate) mod tests;
