//! Whether heads and links form lists at all.

use triptych_spec::abuffer::{EOL, Lists};

use crate::cause::Cause;

/// A head or link that leads astray; the list ends before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Whose list, counted from the band's first pixel.
    pub pixel: u32,
    /// What kind of wrong.
    pub cause: Cause,
    /// Where it leads.
    pub address: u32,
    /// The pixel whose list holds that node already.
    pub owner: Option<u32>,
}

/// The outcome of following every list.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Certificate {
    /// For each pixel the range of `order` that is its list, up to a fault.
    pub offsets: Vec<u32>,
    /// Addresses, list by list.
    pub order: Vec<u32>,
    /// At most one per pixel, in order of pixels.
    pub faults: Vec<Fault>,
    /// Stored nodes that no list leads to, in order.
    pub unowned: Vec<u32>,
}

impl Certificate {
    /// Every node is in exactly one list, and every list ends.
    pub fn is_sound(&self) -> bool {
        self.faults.is_empty() && self.unowned.is_empty()
    }

    /// Nodes in the longest list; `None` if a link leads astray.
    pub fn longest(&self) -> Option<u32> {
        let lengths = self.offsets.windows(2).map(|w| w[1] - w[0]);
        self.faults.is_empty().then(|| lengths.max().unwrap_or(0))
    }

    /// The addresses of a pixel's nodes, from the head on.
    pub fn list(&self, pixel: u32) -> &[u32] {
        let [start, end] = [0, 1].map(|i| self.offsets[pixel as usize + i] as usize);
        &self.order[start..end]
    }
}

/// Follows every list, once over each node: O(pixels + nodes).
pub fn certify(lists: &Lists) -> Certificate {
    const NOBODY: u32 = u32::MAX;
    let mut owner = vec![NOBODY; lists.nodes.len()];
    let mut certificate = Certificate {
        offsets: vec![0],
        order: Vec::with_capacity(lists.nodes.len()),
        faults: Vec::new(),
        unowned: Vec::new(),
    };
    for (pixel, &head) in (0_u32..).zip(&lists.heads) {
        let mut address = head;
        while address != EOL {
            let cause = match owner.get(address as usize) {
                Some(&NOBODY) => None,
                Some(&other) if other == pixel => Some(Cause::Cycle),
                Some(_) => Some(Cause::CorruptLink),
                None if address >= lists.capacity && address < lists.attempts => {
                    Some(Cause::Overflow)
                }
                None if address < lists.capacity => Some(Cause::StalePass),
                None => Some(Cause::CorruptLink),
            };
            if let Some(cause) = cause {
                let owner = owner.get(address as usize).copied();
                certificate.faults.push(Fault {
                    pixel,
                    cause,
                    address,
                    owner: owner.filter(|other| *other != pixel),
                });
                break;
            }
            owner[address as usize] = pixel;
            certificate.order.push(address);
            address = lists.nodes[address as usize].next;
        }
        certificate.offsets.push(row(certificate.order.len()));
    }
    let unowned = (0_u32..).zip(&owner).filter(|(_, owner)| **owner == NOBODY);
    certificate.unowned = unowned.map(|(address, _)| address).collect();
    certificate
}

fn row(n: usize) -> u32 {
    u32::try_from(n).expect("no more than 2^31 nodes are stored")
}
