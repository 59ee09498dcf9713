//! Grids: cells' lists, and what rays meet.

mod cells;
mod exhaustive;
mod linked;
mod traced;

#[cfg(test)]
mod tests;

use super::Judgement;
use crate::row::Class;

pub use cells::{counts, counts_within, entries, offsets, overflowed, within};
pub use exhaustive::{exhaustive, nearest_of_each};
pub use linked::linked;
pub use traced::{Asked, any, closest};

/// What a comparison of lists counts: entries, or the lists themselves where there are none
/// to hold.
fn listed(class: Class, entries: u64, lists: usize) -> Judgement {
    let (unit, compared) = match entries {
        0 => ("lists", lists as u64),
        _ => ("entries", entries),
    };
    Judgement {
        compared,
        ..Judgement::new(class, unit)
    }
}

/// Lists as runs of an array.
#[derive(Clone, Copy, Debug)]
pub struct Runs<'a> {
    /// Where each cell's run starts; one more than cells.
    pub offsets: &'a [u32],
    /// Ids.
    pub prims: &'a [u32],
}

impl<'a> Runs<'a> {
    /// The run of a cell; empty where the offsets lead astray.
    pub fn list(&self, cell: usize) -> &'a [u32] {
        let [start, end] = [0, 1].map(|i| self.offsets[cell + i] as usize);
        self.prims.get(start..end).unwrap_or_default()
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.offsets.len() - 1
    }
}
