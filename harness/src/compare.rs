//! Comparers: each takes two differently labelled observations and says what was
//! compared, what differs, and why.

pub mod dispatch;
pub mod embree;
pub mod fragments;
pub mod grid;
pub mod handed;
pub mod image;
pub mod ldm;
pub mod lists;
pub mod moved;
pub mod opaque;
pub mod order;
pub mod passes;
pub mod peeled;
pub mod region;
pub mod rsm;
pub mod tiles;
pub mod vertex;

use std::collections::BTreeMap;

use crate::cause::Cause;
use crate::observe::{Against, Observed};
use crate::row::Class;

/// How many differences are described in full.
pub const DESCRIBED_MAX: usize = 4;

/// The outcome of one comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// How the two were compared.
    pub class: Class,
    /// What was counted.
    pub unit: &'static str,
    /// Items compared.
    pub compared: u64,
    /// Items that differ, by cause.
    pub causes: BTreeMap<Cause, u64>,
    /// Items that differ without a cause.
    pub unexplained: u64,
    /// Items counted but not judged.
    pub admitted: u64,
    /// Largest share of `admitted` that passes.
    pub admitted_budget: Option<f64>,
    /// Largest error, in the unit that [`crate::row::Row::error`] states.
    pub error: Option<f64>,
    /// Largest error over bound.
    pub error_over_bound: Option<f64>,
    /// The first differences, in words.
    pub described: Vec<String>,
    /// Pixels that differ, for the map of causes.
    pub marks: Vec<(u32, Cause)>,
    /// One line for people.
    pub note: String,
    /// Why nothing was judged, where all items were admitted.
    pub skipped: Option<String>,
}

impl Judgement {
    /// Nothing compared yet.
    pub fn new(class: Class, unit: &'static str) -> Self {
        Self {
            class,
            unit,
            compared: 0,
            causes: BTreeMap::new(),
            unexplained: 0,
            admitted: 0,
            admitted_budget: None,
            error: None,
            error_over_bound: None,
            described: Vec::new(),
            marks: Vec::new(),
            note: String::new(),
            skipped: None,
        }
    }

    /// An exact comparison of `compared` items of which `unexplained` differ for
    /// reasons that the comparer cannot know.
    pub fn exact(unit: &'static str, compared: u64, unexplained: u64) -> Self {
        Self {
            compared,
            unexplained,
            ..Self::new(Class::Exact, unit)
        }
    }

    /// Counts a difference; `words` is only asked for the first few.
    pub fn differs(&mut self, cause: Cause, pixel: Option<u32>, words: impl FnOnce() -> String) {
        *self.causes.entry(cause).or_default() += 1;
        if let Some(pixel) = pixel {
            self.marks.push((pixel, cause));
        }
        if self.described.len() < DESCRIBED_MAX {
            self.described
                .push(format!("{}: {}", cause.name(), words()));
        }
    }

    /// The judgements of the parts of one thing as one. Parts are judged alike, so
    /// the first one's class and unit are those of all; of budgets the smallest holds.
    pub fn sum(parts: impl IntoIterator<Item = Self>) -> Self {
        let mut parts = parts.into_iter();
        let Some(mut total) = parts.next() else {
            return Self::new(Class::Exact, "items");
        };
        for part in parts {
            total.compared += part.compared;
            total.unexplained += part.unexplained;
            total.admitted += part.admitted;
            for (cause, count) in part.causes {
                *total.causes.entry(cause).or_default() += count;
            }
            let larger = |a: Option<f64>, b| a.into_iter().chain(b).reduce(f64::max);
            let budgets = total
                .admitted_budget
                .into_iter()
                .chain(part.admitted_budget);
            total.admitted_budget = budgets.reduce(f64::min);
            total.error = larger(total.error, part.error);
            total.error_over_bound = larger(total.error_over_bound, part.error_over_bound);
            total.marks.extend(part.marks);
            let room = DESCRIBED_MAX.saturating_sub(total.described.len());
            total
                .described
                .extend(part.described.into_iter().take(room));
        }
        total
    }

    /// Items that differ, whatever the cause.
    pub fn differ(&self) -> u64 {
        self.causes.values().sum::<u64>() + self.unexplained
    }
}

/// Compares two legs. Only labels declared [`Against`] each other are accepted.
pub fn compare<A: Against<B>, B, T, U>(
    a: &Observed<A, T>,
    b: &Observed<B, U>,
    judge: impl FnOnce(&T, &U) -> Judgement,
) -> Judgement {
    judge(&a.value, &b.value)
}

#[cfg(test)]
mod tests;
