//! The A-buffer's lists in other layouts than linked nodes of full precision.
//!
//! Yang, Hensley, Grün and Thibieroz (2010): arrays with a counter for each pixel, which they compare
//! with as bucket peeling (section 2; Liu, Huang, Liu and Wu 2010, "FreePipe"); Precalc, which counts,
//! adds up, and fills (section 2); packed nodes (section 4.1); several counters, each with a region of
//! the nodes (section 3.1); and, beyond the paper, lists that are in order while they are built.
//!
//! What a layout stores is what stage `build` of [`crate::abuffer`] stores, to the bit. Twin:
//! `gpu/src/layouts.wgsl`, and `packed.wgsl`, `regions.wgsl` and `ordered.wgsl` beside it.

mod ordered;
mod packed;

use std::ops::Range;

use crate::abuffer::{EOL, Node, Opaque, Sorted, visible};
use crate::raster::{Fragment, cover_only};
use crate::scene::Scene;
use crate::vertex::Primitives;
pub use ordered::ordered;
pub use packed::{packed, rounds_to};

/// Bits of a mask in a word with a triangle: as many as a pixel has samples at most.
pub const MASK_BITS: u32 = 8;

/// Rows of [`Primitives::prims`] that fit beside it.
pub const PRIMS_MAX: u32 = 1 << (u32::BITS - MASK_BITS);

/// A fragment in 8 bytes: its key, then triangle and mask in a word. In order as fragments are.
pub type Entry = [u32; 2];

/// Before all entries that there can be, and behind them.
pub const ALL: Range<Entry> = [0, 0]..[u32::MAX, u32::MAX];

/// The entry of a fragment, whose triangle is below [`PRIMS_MAX`].
pub fn entry(f: &Fragment) -> Entry {
    [f.key, f.prim << MASK_BITS | f.mask]
}

/// The fragment of an entry.
pub fn fragment(pixel: u32, [key, face]: Entry) -> Fragment {
    Fragment {
        pixel,
        prim: face >> MASK_BITS,
        key,
        mask: face & ((1 << MASK_BITS) - 1),
    }
}

/// The fragments that stage `build` stores, as they come.
fn stored(
    scene: &Scene,
    primitives: &Primitives,
    (opaque, depth_test): (&Opaque, bool),
    mut store: impl FnMut(Fragment),
) {
    let source = |prim: u32| primitives.source[prim as usize] as usize;
    let select = |prim| !scene.triangles[source(prim)].is_opaque();
    cover_only(primitives, select, |f| {
        let mask = match depth_test {
            true => visible(primitives, opaque, &f),
            false => f.mask,
        };
        if mask != 0 {
            store(Fragment { mask, ..f });
        }
    });
}

/// An array for each pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arrays {
    /// Entries that each has room for.
    pub room: u32,
    /// Fragments of each pixel, also those without room.
    pub counts: Vec<u32>,
    /// `room` entries for each pixel; those that were not written are zeros.
    pub entries: Vec<Entry>,
}

impl Arrays {
    /// Most fragments of a pixel: arrays of that room hold all.
    pub fn longest(&self) -> u32 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// The arrays as runs of one; `None` where some did not hold all.
    pub fn runs(&self) -> Option<Runs> {
        if self.longest() > self.room {
            return None;
        }
        let mut runs = Runs::with(self.counts.iter().copied());
        for (pixel, &count) in self.counts.iter().enumerate() {
            let own = pixel * self.room as usize;
            let (to, from) = (runs.offsets[pixel] as usize, own..own + count as usize);
            runs.entries[to..to + from.len()].copy_from_slice(&self.entries[from]);
        }
        Some(runs)
    }
}

/// Runs of one array: `offsets[p]..offsets[p + 1]` is pixel `p`, in the order in which fragments came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Runs {
    /// Where each pixel's run starts; one more than there are pixels.
    pub offsets: Vec<u32>,
    /// The fragments.
    pub entries: Vec<Entry>,
}

impl Runs {
    /// Runs of these lengths, of zeros.
    fn with(counts: impl Iterator<Item = u32>) -> Self {
        let mut offsets = vec![0];
        offsets.extend(counts.scan(0_u32, |sum, count| {
            *sum = sum.checked_add(count).expect("fewer than 2^32 fragments");
            Some(*sum)
        }));
        let all = offsets.last().map_or(0, |all| *all as usize);
        Self {
            offsets,
            entries: vec![[0; 2]; all],
        }
    }
}

/// Stage `bucket`: those of the fragments that are within a range go to their pixels' arrays, as long as
/// there is room; counters count all.
///
/// An array that is full holds whatever came first, which no picture may be made of. Passes over ranges
/// that follow each other hold one after another what one pass has no room for: a range of a single entry
/// has one fragment a pixel.
pub fn bucket(
    scene: &Scene,
    primitives: &Primitives,
    (opaque, depth_test): (&Opaque, bool),
    room: u32,
    range: &Range<Entry>,
) -> Arrays {
    let pixels = primitives.size.pixels();
    let mut arrays = Arrays {
        room,
        counts: vec![0; pixels],
        entries: vec![[0; 2]; pixels * room as usize],
    };
    stored(scene, primitives, (opaque, depth_test), |f| {
        if range.contains(&entry(&f)) {
            let place = arrays.counts[f.pixel as usize];
            arrays.counts[f.pixel as usize] += 1;
            if place < room {
                arrays.entries[(f.pixel * room + place) as usize] = entry(&f);
            }
        }
    });
    arrays
}

/// Stage `precalc`: counts the fragments of each pixel, adds the counts up, and goes through the triangles
/// once more to fill runs of exactly these lengths.
pub fn precalc(
    scene: &Scene,
    primitives: &Primitives,
    (opaque, depth_test): (&Opaque, bool),
) -> Runs {
    let mut counts = vec![0_u32; primitives.size.pixels()];
    let of = (opaque, depth_test);
    stored(scene, primitives, of, |f| counts[f.pixel as usize] += 1);
    let mut runs = Runs::with(counts.into_iter());
    let mut next = runs.offsets.clone();
    stored(scene, primitives, of, |f| {
        let place = &mut next[f.pixel as usize];
        runs.entries[*place as usize] = entry(&f);
        *place += 1;
    });
    runs
}

/// Stage `rank`: each run in order, which is that of stage `sort`.
pub fn rank(runs: &Runs) -> Sorted {
    let mut fragments = Vec::with_capacity(runs.entries.len());
    for (pixel, run) in (0_u32..).zip(runs.offsets.windows(2)) {
        let mut own = runs.entries[run[0] as usize..run[1] as usize].to_vec();
        own.sort_unstable();
        fragments.extend(own.into_iter().map(|e| fragment(pixel, e)));
    }
    Sorted {
        offsets: runs.offsets.clone(),
        fragments,
    }
}

/// Linked lists whose nodes come from several regions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Regions {
    /// First node of each pixel's list, or [`EOL`].
    pub heads: Vec<u32>,
    /// The nodes by address: as many for each region. Those that were never written are `None`.
    pub nodes: Vec<Option<Node>>,
    /// How often an address was asked for in each region.
    pub attempts: Vec<u32>,
}

/// Stage `regions`: as stage `build`, with a counter for each region of `capacity` nodes, of which it
/// stores the first `min(attempts, capacity)`. `region` says whose counter a fragment asks.
///
/// # Panics
/// If that is no region, of which there are `count`.
pub fn regions(
    scene: &Scene,
    primitives: &Primitives,
    (opaque, depth_test): (&Opaque, bool),
    (count, capacity): (u32, u32),
    region: impl Fn(&Fragment) -> u32,
) -> Regions {
    let mut lists = Regions {
        heads: vec![EOL; primitives.size.pixels()],
        nodes: vec![None; count as usize * capacity as usize],
        attempts: vec![0; count as usize],
    };
    stored(scene, primitives, (opaque, depth_test), |f| {
        let region = region(&f);
        let place = lists.attempts[region as usize];
        lists.attempts[region as usize] += 1;
        if place < capacity {
            let address = region * capacity + place;
            let next = std::mem::replace(&mut lists.heads[f.pixel as usize], address);
            let Fragment {
                key, prim, mask, ..
            } = f;
            lists.nodes[address as usize] = Some(Node {
                key,
                next,
                prim,
                mask,
            });
        }
    });
    lists
}
