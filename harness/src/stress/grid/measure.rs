//! What came of a step.

use std::path::PathBuf;

use super::super::measure::worst_of;
use super::super::sweeps::Step;
use super::{EVERY, GridShot, Walks};
use crate::corpus::Entry;
use crate::replay::grid::GridRun;
use crate::row::{Class, Row};

/// Times that have a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// A kernel's, of closest hits, from the spec's lists and from its own.
    Gpu,
    /// Embree's.
    Embree,
}

impl Bound {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Gpu, Self::Embree];

    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gpu => "gpu",
            Self::Embree => "embree",
        }
    }

    /// Whether a row is of such times.
    pub fn is_of(self, row: &Row) -> bool {
        match self {
            Self::Gpu => row.b.starts_with("gpu@"),
            Self::Embree => row.class == Class::Vote,
        }
    }
}

/// What came of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// Name of its sweep.
    pub sweep: &'static str,
    /// The number that the sweep varies, as it is written.
    pub step: String,
    /// The number.
    pub value: f64,
    /// Its scene.
    pub path: PathBuf,
    /// A part of what it must be refused with, if it must be.
    pub must_refuse: Option<&'static str>,
    /// What it was refused with.
    pub refused: Option<String>,
    /// The comparisons.
    pub rows: Vec<Row>,
    /// What the plan made of a step without triangles, whose [`Self::rows`] are those of a run
    /// in which nothing is skipped.
    pub skipped: Vec<Row>,
    /// Rays of each leg.
    pub rays: u64,
    /// Cells along each axis.
    pub cells: [u32; 3],
    /// Entries in the longest list.
    pub list: u32,
    /// How far rays go.
    pub walks: Walks,
}

/// What the plan saves of a step, on all legs that it skips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Saved {
    /// Passes, over all legs.
    pub passes: usize,
    /// What they take if they run all the same.
    pub ms: f64,
}

impl Measured {
    /// Nothing yet.
    pub fn new(sweep: &'static str, step: &Step<GridShot>, entry: &Entry) -> Self {
        Self {
            sweep,
            step: step.label.clone(),
            value: step.value,
            path: entry.path.clone(),
            must_refuse: step.shot.refused,
            refused: None,
            rows: Vec::new(),
            skipped: Vec::new(),
            rays: 0,
            cells: [0; 3],
            list: 0,
            walks: Walks::default(),
        }
    }

    /// Takes what the spec tells of grid and walks.
    pub(super) fn of(&mut self, run: &GridRun) {
        self.rays = run.rays.len() as u64;
        self.cells = run.grid.axes.each_ref().map(|axis| axis.cells());
        self.list = run.counts.iter().copied().max().unwrap_or(0);
        self.walks = Walks::of(&run.grid, &run.rays, &run.answers);
    }

    /// The largest error over bound, and whose; `None` if no time was compared.
    pub fn worst(&self, bound: Bound) -> Option<(f64, &Row)> {
        self.worst_of(|row| bound.is_of(row))
    }

    /// The same of the rows of which this is true.
    pub(super) fn worst_of(&self, is_of: impl Fn(&Row) -> bool) -> Option<(f64, &Row)> {
        worst_of(&self.rows, is_of)
    }

    /// Share of Embree's rays in class edge, of each of its queries: any, closest.
    pub fn edge(&self) -> [Option<f64>; 2] {
        let votes = self.rows.iter().filter(|row| row.class == Class::Vote);
        let mut asked = votes.filter(|row| row.skipped.is_none() || row.admitted > 0);
        [(); 2].map(|()| asked.next().map(Row::admitted_share))
    }

    /// The largest share of an adapter's closest hits that are another triangle than the
    /// spec's, at a time that the bounds do not tell from it.
    pub fn admitted(&self) -> f64 {
        let rows = self.rows.iter().filter(|row| is_closest(row));
        rows.map(Row::admitted_share).fold(0.0, f64::max)
    }

    /// Items compared, over all legs.
    pub fn compared(&self) -> u64 {
        self.rows.iter().map(|row| row.compared).sum()
    }

    /// Items that differ, over all legs.
    pub fn differ(&self) -> u64 {
        self.rows.iter().map(|row| row.differ).sum()
    }

    /// What the plan saved; `None` where it skipped nothing.
    pub fn saved(&self) -> Option<Saved> {
        let of_plan = |row: &&Row| {
            row.skipped
                .as_ref()
                .is_some_and(|r| r.starts_with("plan: "))
        };
        let passes: Vec<&Row> = self.skipped.iter().filter(of_plan).collect();
        let run = |row: &&Row| passes.iter().any(|p| p.b == row.b && row.b != EVERY);
        let rows = self.rows.iter().filter(run);
        (!passes.is_empty()).then(|| Saved {
            passes: passes.len(),
            ms: rows.filter_map(|row| row.ms_b).sum(),
        })
    }

    /// What was not compared, and why.
    pub fn reasons(&self) -> impl Iterator<Item = (&Row, &str)> {
        let rows = self.skipped.iter().chain(&self.rows);
        rows.filter_map(|row| Some((row, row.skipped.as_deref()?)))
    }
}

/// Whether a row is about a kernel's closest hits.
fn is_closest(row: &Row) -> bool {
    row.class == Class::Decision && row.unit == "rays"
}
