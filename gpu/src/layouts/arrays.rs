//! Entries of lists in arrays: put in order, blended, and read as linked lists.

use triptych_spec::abuffer::{EOL, Lists, Node};
use triptych_spec::layouts::{Entry, fragment};

use super::Listing;
use super::room::{Room, Step, no_lists, word};
use crate::error::GpuError;
use crate::frame::WORKGROUP;
use crate::lists::long_passes;
use crate::ready::GROUPS_MAX;

const BUFFERS: [&str; 2] = ["listed", "merged"];

impl Room<'_, '_> {
    /// Puts lists of at most `longest` entries in order, of `all` entries.
    pub(super) fn rank(&mut self, longest: u32, all: u32) -> Result<Vec<Step>, GpuError> {
        let listing = self.listing;
        let mut steps = vec![Step::Other(self.per_pixel("rank_lists", listing)?)];
        let mut long: Vec<_> = long_passes(["rank_runs", "rank_merge"], longest).collect();
        if long.is_empty() {
            return Ok(steps);
        }
        if long.len() % 2 == 1 {
            // What is in order is copied back to where it is looked for.
            long.push(("rank_merge", longest.next_power_of_two()));
        }
        let groups = all.div_ceil(WORKGROUP);
        if groups > GROUPS_MAX {
            return Err(GpuError::Limit {
                adapter: self.rasterizer.gpu.name.clone(),
                what: "workgroups for the longest lists",
                needed: groups.into(),
                limit: GROUPS_MAX.into(),
            });
        }
        self.zeros("merged", 2 * u64::from(all))?;
        for (entry, run) in long {
            let listing = Listing {
                items: all,
                run,
                ..listing
            };
            steps.push(Step::Other(self.pass(entry, listing, groups)?));
            self.buffers.swap(BUFFERS);
        }
        Ok(steps)
    }
}

/// Lists that are runs of arrays, linked in the order in which their entries lie.
pub(super) struct Linked<'f> {
    pub(super) lists: Lists,
    faces: &'f [[f32; 4]],
    /// The last node of each list.
    tails: Vec<u32>,
}

impl<'f> Linked<'f> {
    /// Empty lists.
    pub(super) fn new(pixels: u32, faces: &'f [[f32; 4]]) -> Self {
        let mut lists = no_lists(pixels);
        lists.heads = vec![EOL; pixels as usize];
        Self {
            lists,
            faces,
            tails: vec![EOL; pixels as usize],
        }
    }

    /// Adds entries to the end of a pixel's list.
    pub(super) fn extend(&mut self, pixel: usize, entries: &[Entry]) {
        for entry in entries {
            let at = word(self.lists.nodes.len());
            let last = std::mem::replace(&mut self.tails[pixel], at);
            match self.lists.nodes.get_mut(last as usize) {
                Some(node) => node.next = at,
                None => self.lists.heads[pixel] = at,
            }
            let f = fragment(word(pixel), *entry);
            let colour = self.faces.get(f.prim as usize).copied();
            // What is no triangle has no colour.
            self.lists.colours.push(colour.unwrap_or([f32::NAN; 4]));
            self.lists.nodes.push(Node {
                key: f.key,
                next: EOL,
                prim: f.prim,
                mask: f.mask,
            });
        }
    }

    /// The lists, of which so many fragments were counted.
    pub(super) fn counted(mut self, attempts: u32) -> Lists {
        self.lists.attempts = attempts;
        self.lists.capacity = word(self.lists.nodes.len());
        self.lists
    }
}
