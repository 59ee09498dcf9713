//! What came of a step.

use std::path::PathBuf;

use super::super::measure::worst_of;
use super::super::sweeps::Step;
use super::alone::steep;
use super::{Alone, Form, Found, LdmShot, Parts};
use crate::corpus::Entry;
use crate::replay::ldm::LdmRun;
use crate::row::{Class, Row};

/// Results that have a bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bound {
    /// A kernel's sums of what is partly open.
    Occlusion,
    /// A kernel's light.
    Environment,
    /// Embree's depths of what lists hold.
    Embree,
    /// Keys of what points find, against the scene as its files have it.
    Key,
    /// Its distances from the points.
    Distance,
}

impl Bound {
    /// All.
    pub const ALL: [Self; 5] = [
        Self::Occlusion,
        Self::Environment,
        Self::Embree,
        Self::Key,
        Self::Distance,
    ];

    /// What tables call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Occlusion => "occlusion",
            Self::Environment => "environment",
            Self::Embree => "embree",
            Self::Key => "key",
            Self::Distance => "distance",
        }
    }

    /// Whether a row is of such results.
    pub fn is_of(self, row: &Row) -> bool {
        match self {
            Self::Occlusion | Self::Environment => {
                row.class == Class::Interval && row.stage == self.name()
            }
            Self::Embree => row.class == Class::Vote,
            Self::Key | Self::Distance => false,
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
    /// What is known of it beforehand.
    pub form: Form,
    /// The comparisons.
    pub rows: Vec<Row>,
    /// Who asks, maps, and keys in them.
    pub counts: [u64; 3],
    /// Steps of the lattice to a pixel of a map.
    pub pixel: f64,
    /// Where the error of what is open comes from.
    pub parts: Parts,
    /// What points find, against the scene as its files have it.
    pub found: Found,
    /// Every face by itself.
    pub alone: Alone,
    /// What is open over each asker, to the bit.
    pub open: Vec<(u32, u64)>,
    /// Askers over which something is in the way.
    pub covered: u64,
    /// Of these, such that lose more to it than all maps weigh in which their faces are steep.
    pub covered_more: u64,
}

impl Measured {
    /// Nothing yet.
    pub fn new(sweep: &'static str, step: &Step<LdmShot>, entry: &Entry) -> Self {
        Self {
            sweep,
            step: step.label.clone(),
            value: step.value,
            path: entry.path.clone(),
            must_refuse: step.shot.refused,
            refused: None,
            form: step.shot.form,
            rows: Vec::new(),
            counts: [0; 3],
            pixel: 0.0,
            parts: Parts::default(),
            found: Found::default(),
            alone: Alone::default(),
            open: Vec::new(),
            covered: 0,
            covered_more: 0,
        }
    }

    /// Takes what the spec counts.
    pub(super) fn of(&mut self, run: &LdmRun) {
        let receivers = run.setup.receivers.len();
        self.counts = [receivers as u64, run.tally.maps, run.tally.keys];
        let open = run.open.iter();
        self.open = open.map(|o| (o.whole, o.part.value.to_bits())).collect();
        self.pixel = run.turns.first().map_or(0.0, |turn| turn.maps.pixel);
        for (at, asker) in run.setup.receivers.iter().enumerate() {
            let lost = run.weights(at) - run.open[at].whole;
            self.covered += u64::from(lost > 0);
            self.covered_more += u64::from(lost > steep(run, asker));
        }
    }

    /// The largest error over bound, and the leg; `None` if nothing was compared.
    pub fn worst(&self, bound: Bound) -> Option<(f64, &str)> {
        let spec = |ratio| (self.found.sides > 0).then_some((ratio, "spec"));
        match bound {
            Bound::Key => spec(self.found.key),
            Bound::Distance => spec(self.found.distance),
            bound => {
                let (ratio, row) = worst_of(&self.rows, |row| bound.is_of(row))?;
                Some((ratio, &row.b))
            }
        }
    }

    /// Share of Embree's pairs in class edge.
    pub fn edge(&self) -> Option<f64> {
        let votes = self.rows.iter().filter(|row| row.class == Class::Vote);
        let mut asked = votes.filter(|row| row.skipped.is_none() || row.admitted > 0);
        asked.next().map(Row::admitted_share)
    }

    /// Items compared, over all legs.
    pub fn compared(&self) -> u64 {
        self.rows.iter().map(|row| row.compared).sum()
    }

    /// Items that differ, over all legs.
    pub fn differ(&self) -> u64 {
        self.rows.iter().map(|row| row.differ).sum()
    }

    /// What was not compared, and why.
    pub fn reasons(&self) -> impl Iterator<Item = (&Row, &str)> {
        let rows = self.rows.iter();
        rows.filter_map(|row| Some((row, row.skipped.as_deref()?)))
    }
}
