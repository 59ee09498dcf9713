//! One line of the result: a scene, a stage, a pair of legs.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};

use crate::cause::Cause;

/// How a quantity may differ (ARCHITECTURE.md, "What may differ").
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Bit equality.
    Exact,
    /// A certificate of the structure, then equality as multisets.
    Structure,
    /// Equality in the total order of (key, primitive, instance, mask).
    Tie,
    /// Inside the spec's own bound.
    Interval,
    /// Decided by a computed float; both outcomes admitted where the bound allows.
    Decision,
    /// Must, may or must not, by a band of one sub-pixel.
    Band,
    /// A vote by an implementation that is itself inexact near edges.
    Vote,
}

/// The comparison of two legs at one stage of one scene. Serialised as one JSON
/// line; the field names are part of the interface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// `family/case`.
    pub scene: String,
    /// `raster`, `abuffer`, `grid`, `rsm` or `ldm`, the scene's folder.
    pub family: String,
    /// Stage, such as `cover` or `build`.
    pub stage: String,
    /// First leg, such as `spec`.
    pub a: String,
    /// Second leg, such as `gpu@llvmpipe/fragment` or `embree`.
    pub b: String,
    /// How the two were compared.
    pub class: Class,
    /// What was counted: `corners`, `fragments`, `pixels`, `pairs`.
    pub unit: String,
    /// Items compared. Zero is a failure unless the plan predicted it.
    pub compared: u64,
    /// Items that differ.
    pub differ: u64,
    /// Causes of the items that differ, and how many of each.
    pub causes: BTreeMap<Cause, u64>,
    /// Items that differ without a cause.
    pub unexplained: u64,
    /// Items counted but not judged (class edge, admitted decisions, MAY pixels).
    pub admitted: u64,
    /// Largest share of `admitted` that passes.
    pub admitted_budget: Option<f64>,
    /// Largest error, where there is a bound: in homogeneous pixels for `transform` and
    /// `clip`, in keys for `snap` and Embree, in linear colour for `resolve`, in lengths of the
    /// ray's direction for `trace`; of indirect light in steps of the lattice for points, in
    /// keys for `place`, in linear colour elsewhere.
    #[serde(default)]
    pub error: Option<f64>,
    /// Largest error over bound, where the class is an interval.
    pub error_over_bound: Option<f64>,
    /// Why nothing was compared; null if something was.
    pub skipped: Option<String>,
    /// Whether the numbers come from the cache.
    pub cached: bool,
    /// Milliseconds that the first leg took; null if not measured.
    pub ms_a: Option<f64>,
    /// Milliseconds that the second leg took.
    pub ms_b: Option<f64>,
    /// One line for people: the first difference, the largest error, a remark.
    pub note: String,
    /// The command that replays the scene as the run did; empty where that is not
    /// known.
    #[serde(default)]
    pub again: String,
}

/// What a row amounts to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Everything compared agrees.
    Agree,
    /// Nothing was compared, and the reason is stated.
    Skipped,
    /// Something differs, a budget is exceeded, or nothing was compared silently.
    Diverge,
}

impl Row {
    /// Where it stands among a scene's: closed form, Embree, then GPU legs by name.
    pub fn column(&self) -> (u8, String) {
        let rank = match self.b.as_str() {
            "closed form" => 0,
            "embree" => 1,
            leg if self.a == "spec" && leg.starts_with("gpu") => 2,
            _ => 3,
        };
        (rank, self.b.clone())
    }

    /// Items counted but not judged, as a share of those compared; all of them where
    /// nothing was judged, so that nothing counts as compared.
    pub fn admitted_share(&self) -> f64 {
        self.admitted as f64 / self.compared.max(self.admitted).max(1) as f64
    }

    /// The verdict; a row that judged nothing and gives no reason diverges.
    pub fn verdict(&self) -> Verdict {
        let share = self.admitted_share();
        let over_budget = self.admitted_budget.is_some_and(|budget| share > budget);
        if self.differ > 0 || self.unexplained > 0 || over_budget {
            Verdict::Diverge
        } else if self.skipped.is_some() {
            Verdict::Skipped
        } else if self.compared <= self.admitted {
            Verdict::Diverge
        } else {
            Verdict::Agree
        }
    }
}

/// The last JSON line of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Scenes replayed.
    pub scenes: u64,
    /// Items compared over all rows.
    pub compared: u64,
    /// Items that differ without a cause, over all rows.
    pub unexplained: u64,
    /// Rows that compared nothing.
    pub skipped: u64,
    /// Wall time of the whole run.
    pub seconds: f64,
    /// Rows whose verdict is to diverge.
    pub diverging: u64,
}

impl Summary {
    /// The summary of a run's rows. Sums stop at the largest `u64`.
    pub fn of(rows: &[Row], seconds: f64) -> Self {
        let total = |count: fn(&Row) -> u64| rows.iter().map(count).fold(0, u64::saturating_add);
        let scenes: BTreeSet<&str> = rows.iter().map(|r| r.scene.as_str()).collect();
        Self {
            scenes: scenes.len() as u64,
            compared: total(|r| r.compared),
            unexplained: total(|r| r.unexplained),
            skipped: total(|r| u64::from(r.skipped.is_some())),
            seconds,
            diverging: total(|r| u64::from(r.verdict() == Verdict::Diverge)),
        }
    }
}
