//! Passes over the lists of a band.

use super::Tiled;
use super::room::{Longest, Room};
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::lists::long_passes;
use crate::ready::{GROUPS_MAX, Ready};

/// Steps along lists that a dispatch takes.
pub(super) const STEPS: u32 = 16_384;

/// Kernels that blend lists that nobody has to sort before, by the bits of [`Longest::kernels`]: lists
/// in rows, by the sizes of [`crate::wgsl::network::SIZES`], and lists in order.
const ENTRIES: [(u32, &str); 5] = [
    (0, "shade_8"),
    (1, "shade_16"),
    (2, "shade_32"),
    (3, "shade_64"),
    (AS_IT_IS, "shade_ordered"),
];

/// The bit of lists that are sorted in memory, and blended by `shade_long`. Twin: `IN_MEMORY` in
/// `jagged.wgsl`.
pub const IN_MEMORY: u32 = 4;

/// That of lists that are blended as they are. Twin: `AS_IT_IS` in `jagged.wgsl`.
pub const AS_IT_IS: u32 = 5;

impl Longest {
    /// Whether any list is sorted in memory.
    pub(super) fn has_unsorted(&self) -> bool {
        self.kernels >> IN_MEMORY & 1 == 1
    }

    /// The same lists, filled in any order: for frames whose bins are in another each time.
    pub(super) fn in_any_order(self) -> Self {
        let kernels = ((1 << (IN_MEMORY + 1)) - 1) | (1 << AS_IT_IS);
        Self { kernels, ..self }
    }

    /// Whether any is too long for a workgroup, which merges its parts.
    pub(super) fn is_merged(&self) -> bool {
        self.has_unsorted() && self.count > 0
    }
}

impl Room<'_, '_> {
    /// Counts the fragments of each list, and says where they will be.
    pub(super) fn place_lists(&mut self, bins: (u32, u32)) -> Result<Vec<Ready>, GpuError> {
        let words = u64::from(self.tiles) + u64::from(self.binned);
        let rows = self
            .pool
            .storage(self.rasterizer.gpu, "rows of tiles", 4 * words)?;
        self.buffers.set("rows", rows);
        let mut passes = self.drawn("jagged_count", 0, bins)?;
        let place = self.pass("jagged_place", self.of_tiles(), self.tiles)?;
        let place = place.after_clearing(self.buffers.get("counter").clone());
        passes.push(place.after_clearing(self.buffers.get("longest").clone()));
        Ok(passes)
    }

    pub(super) fn of_tiles(&self) -> Tiled {
        Tiled {
            items: self.tiles,
            ..Tiled::default()
        }
    }

    /// Puts lists that no network sorts in order.
    pub(super) fn sort_lists(&mut self, longest: Longest) -> Result<Vec<Ready>, GpuError> {
        let Longest { length, count, .. } = longest;
        let mut passes = Vec::new();
        if !longest.has_unsorted() {
            return Ok(passes);
        }
        passes.push(self.pass("shade_sort", self.of_tiles(), self.tiles)?);
        if !longest.is_merged() {
            return Ok(passes);
        }
        let groups = length.div_ceil(WORKGROUP);
        let needed = u64::from(groups) * u64::from(count);
        let all = u32::try_from(needed).ok().filter(|all| *all <= GROUPS_MAX);
        let all = all.ok_or_else(|| GpuError::Limit {
            adapter: self.rasterizer.gpu.name.clone(),
            what: "workgroups for the longest lists",
            needed,
            limit: GROUPS_MAX.into(),
        })?;
        let mut long: Vec<_> = long_passes(["shade_runs", "shade_merge"], length).collect();
        if long.len() % 2 == 1 {
            // What is in order is copied back to where all other lists are.
            long.push(("shade_merge", length.next_power_of_two()));
        }
        for (entry, run) in long {
            let tiled = Tiled {
                items: count,
                run,
                groups,
                ..Tiled::default()
            };
            passes.push(self.pass(entry, tiled, all)?);
            self.buffers.swap(["listed", "merged"]);
        }
        Ok(passes)
    }

    /// Blends so many layers of these lists; `stored`: short ones are written back in order as well.
    pub(super) fn shade(
        &self,
        longest: Longest,
        layers: u32,
        stored: bool,
    ) -> Result<Vec<Ready>, GpuError> {
        let mut passes = Vec::new();
        let short = Tiled {
            layers,
            stored: stored.into(),
            ..self.of_tiles()
        };
        for (bit, entry) in ENTRIES {
            if longest.kernels >> bit & 1 == 1 {
                passes.push(self.pass(entry, short, self.tiles)?);
            }
        }
        let long = match longest.has_unsorted() {
            true => longest.length,
            false => 0,
        };
        for first in (0..long).step_by(STEPS as usize) {
            let tiled = Tiled {
                first,
                count: STEPS,
                layers,
                ..self.of_tiles()
            };
            passes.push(self.pass("shade_long", tiled, self.tiles)?);
        }
        Ok(passes)
    }
}
