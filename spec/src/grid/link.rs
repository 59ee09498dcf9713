//! The paper's own lists: linked, in whatever order triangles come.

use super::{Blockers, Cells, id};
use crate::abuffer::EOL;

/// An entry of a cell's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Row in [`Blockers::triangles`].
    pub prim: u32,
    /// The next entry, or [`EOL`].
    pub next: u32,
}

/// Heads, entries and the counter that hands out their addresses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Linked {
    /// First entry of each cell's list, or [`EOL`].
    pub heads: Vec<u32>,
    /// Entries by address.
    pub entries: Vec<Entry>,
    /// How often an address was asked for; what exceeds the capacity overflowed.
    pub attempts: u32,
    /// Number of addresses.
    pub capacity: u32,
}

/// Stage `link`: every triangle into the list of every cell that lists it (section 4.2, by
/// the three steps of section 3). An entry without an address touches no head.
pub fn link(blockers: &Blockers, cells: &Cells, capacity: u32) -> Linked {
    let mut linked = Linked {
        heads: vec![EOL; cells.total()],
        entries: Vec::new(),
        attempts: 0,
        capacity,
    };
    for prim in (0..blockers.triangles.len()).map(id) {
        for cell in cells.of(blockers.corners(prim)) {
            insert(&mut linked, cell, prim);
        }
    }
    linked
}

fn insert(linked: &mut Linked, cell: usize, prim: u32) {
    let address = linked.attempts;
    linked.attempts = address.checked_add(1).expect("fewer than 2^32 entries");
    if address < linked.capacity {
        let next = std::mem::replace(&mut linked.heads[cell], address);
        linked.entries.push(Entry { prim, next });
    }
}
