//! Nodes that no list leads to.
//!
//! A node does not say which pixel it belongs to, but its link may: `build` puts a
//! node in front of its own pixel's list, so what it links to is of the same pixel.
//! Where links from node to node reach a list, the pixel is known, and the node stands
//! for what that pixel lacks and no other. Where they reach an end, it may be of any.

use std::collections::BTreeMap;

use triptych_spec::abuffer::Lists;
use triptych_spec::raster::Fragment;

use super::{Certificate, Expected};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;

/// Triangle, key and mask of a node, and its pixel where that is known.
type Content = (u32, u32, u32, Option<u32>);

/// Nodes that no list leads to, counted by what they hold.
pub(super) struct Unowned(BTreeMap<Content, u64>);

impl Unowned {
    pub(super) fn new(lists: &Lists, certificate: &Certificate) -> Self {
        let mut counts = BTreeMap::new();
        let origins = origins(lists, certificate);
        for (&address, origin) in certificate.unowned.iter().zip(origins) {
            let node = lists.nodes[address as usize];
            let content = (node.prim, node.key, node.mask, origin);
            *counts.entry(content).or_default() += 1;
        }
        Self(counts)
    }

    /// Takes one node that holds `f`, which the list of the band's `pixel` lacks, if
    /// there is one that may be of that pixel.
    pub(super) fn take(&mut self, pixel: u32, f: &Fragment) -> bool {
        [Some(pixel), None].into_iter().any(|origin| {
            match self.0.get_mut(&(f.prim, f.key, f.mask, origin)) {
                Some(count) if *count > 0 => {
                    *count -= 1;
                    true
                }
                _ => false,
            }
        })
    }

    /// What is left belongs to no list that lacks it. Every fragment covers a sample:
    /// a mask of 0 was never stored.
    pub(super) fn report(&self, expected: &Expected<'_>, judgement: &mut Judgement) {
        for (&(prim, key, mask, origin), count) in &self.0 {
            let pixel = origin.map(|pixel| expected.first_pixel + pixel);
            for _ in 0..*count {
                if [prim, key, mask] == [0; 3] {
                    judgement.differs(Cause::Overflow, None, || {
                        "an address was counted, but nothing is stored there".into()
                    });
                    continue;
                }
                judgement.differs(Cause::LostNode, pixel, || {
                    let place = pixel.map_or(String::new(), |pixel| {
                        format!(", though linked to that of {}", at(pixel, expected.width))
                    });
                    format!("a node of triangle row {prim} at key {key} is in no list{place}")
                });
            }
        }
    }
}

/// For each unowned node the pixel to whose list its links lead. Each link is followed
/// once; links in a circle lead nowhere.
fn origins(lists: &Lists, certificate: &Certificate) -> Vec<Option<u32>> {
    if certificate.unowned.is_empty() {
        return Vec::new();
    }
    let mut known: Vec<Option<Option<u32>>> = vec![Some(None); lists.nodes.len()];
    for &address in &certificate.unowned {
        known[address as usize] = None;
    }
    for pixel in (0_u32..).take(lists.heads.len()) {
        for &address in certificate.list(pixel) {
            known[address as usize] = Some(Some(pixel));
        }
    }
    let mut path = Vec::new();
    let origin = |start: &u32| {
        path.clear();
        let mut address = *start as usize;
        let found = loop {
            match known.get(address) {
                Some(Some(found)) => break *found,
                // An end, or a link that leads astray.
                None => break None,
                Some(None) => {
                    // Until the end is known; this also stops at a circle.
                    known[address] = Some(None);
                    path.push(address);
                    address = lists.nodes[address].next as usize;
                }
            }
        };
        for &address in &path {
            known[address] = Some(found);
        }
        found
    };
    certificate.unowned.iter().map(origin).collect()
}
