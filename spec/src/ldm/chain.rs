//! Stage `chain`: the paper's own lists, linked, in whatever order triangles come.

use super::layers::Drawn;
use super::{LdmError, Maps};
use crate::abuffer::EOL;
use crate::grid::Blockers;

/// An entry of a pixel's list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// Depth key.
    pub key: u32,
    /// The next entry, or [`EOL`].
    pub next: u32,
}

/// Heads, entries and the counter that hands out their addresses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chains {
    /// First entry of the list of each pixel of all maps, or [`EOL`].
    pub heads: Vec<u32>,
    /// Entries by address.
    pub links: Vec<Link>,
    /// How often an address was asked for; what exceeds the capacity overflowed.
    pub attempts: u32,
    /// Number of addresses.
    pub capacity: u32,
}

/// Stage `chain` (paper sections 2.1 and 3): one pass over the triangles of each map, which puts
/// every depth at the head of its pixel's list; then every list is relinked in order. An entry
/// without an address touches no head. The author's program sorts while it inserts, which no
/// order of memory that WGSL promises allows.
///
/// # Errors
/// More keys than a `u32` counts, a corner that is no vertex.
pub fn chain(maps: &Maps, blockers: &Blockers, capacity: u32) -> Result<Chains, LdmError> {
    let mut chains = Chains {
        heads: vec![EOL; maps.pixels as usize],
        links: Vec::new(),
        attempts: 0,
        capacity,
    };
    let mut drawn = Drawn::new(maps, blockers)?;
    let mut attempts = 0_u64;
    for (number, map) in maps.maps.iter().enumerate() {
        drawn.cover(number, |pixel, key| {
            chains.insert((map.first + pixel) as usize, key);
            attempts += 1;
        });
        super::within("the number of keys", attempts, 0, u64::from(u32::MAX))?;
    }
    chains.attempts = u32::try_from(attempts).expect("checked above");
    for pixel in 0..chains.heads.len() {
        chains.sort(pixel);
    }
    Ok(chains)
}

impl Chains {
    fn insert(&mut self, pixel: usize, key: u32) {
        if self.links.len() < self.capacity as usize {
            let address = u32::try_from(self.links.len()).expect("below the capacity");
            let next = std::mem::replace(&mut self.heads[pixel], address);
            self.links.push(Link { key, next });
        }
    }

    /// Addresses of a pixel's list.
    fn addresses(&self, pixel: usize) -> Vec<u32> {
        let next = |at: &u32| Some(self.links[*at as usize].next).filter(|next| *next != EOL);
        let head = Some(self.heads[pixel]).filter(|head| *head != EOL);
        std::iter::successors(head, next).collect()
    }

    /// Relinks a list by key; the first inserted of equals stays the last.
    fn sort(&mut self, pixel: usize) {
        let mut addresses = self.addresses(pixel);
        addresses.sort_by_key(|at| self.links[*at as usize].key);
        let mut next = EOL;
        for at in addresses.into_iter().rev() {
            self.links[at as usize].next = next;
            next = at;
        }
        self.heads[pixel] = next;
    }

    /// Keys of a pixel of all maps', as they are linked.
    pub fn list(&self, pixel: usize) -> Vec<u32> {
        let keys = self.addresses(pixel).into_iter();
        keys.map(|at| self.links[at as usize].key).collect()
    }
}
