//! Stage `chain`: the paper's linked lists.

use triptych_spec::abuffer::{Lists, Node};
use triptych_spec::ldm::{Chains, Layers, Link, Maps};

use super::lists::cause;
use super::{list, listed, named, shown};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::lists::certify;
use crate::row::Class;

/// Every entry is in exactly one list, the counter says how many were asked for, and each list,
/// as it is linked, holds the pixel's keys in order. Without room for all of them, a list may
/// lack some, and nothing else.
pub fn chains(maps: &Maps, spec: &Layers, seen: &Chains) -> Judgement {
    let needed = spec.keys.len() as u64;
    let stored = needed.min(seen.capacity.into());
    let pixels = spec.offsets.len().saturating_sub(1);
    let mut judgement = listed(Class::Structure, "lists", pixels, seen.heads.len());
    if u64::from(seen.attempts) != needed || seen.links.len() as u64 != stored {
        judgement.differs(Cause::Overflow, None, || {
            let (attempts, links) = (seen.attempts, seen.links.len());
            format!(
                "{attempts} entries asked for and {links} stored, must be {needed} and {stored}"
            )
        });
    }
    let certificate = certify(&lists(seen));
    for fault in &certificate.faults {
        judgement.differs(fault.cause, None, || {
            let named = named(maps, fault.pixel as usize);
            format!("the list of {named} leads to entry {}", fault.address)
        });
    }
    let faulty = |pixel: u32| {
        let faults = &certificate.faults;
        faults.binary_search_by_key(&pixel, |f| f.pixel).is_ok()
    };
    for pixel in (0_u32..).take(pixels.min(seen.heads.len())) {
        let at = pixel as usize;
        let must = &spec.keys[list(&spec.offsets, &spec.keys, at)];
        let entries = certificate.list(pixel).iter();
        let is: Vec<u32> = entries.map(|at| seen.links[*at as usize].key).collect();
        let wrong = match stored == needed {
            true => is != must,
            false => !is.is_sorted() || !is_part(&is, must),
        };
        if wrong && !faulty(pixel) {
            judgement.differs(cause(must, &is), None, || {
                let named = named(maps, at);
                format!("{named} links {}, must link {}", shown(&is), shown(must))
            });
        }
    }
    if let Some(first) = certificate.unowned.first()
        && judgement.differ() == 0
    {
        judgement.differs(Cause::LostNode, None, || {
            format!("entry {first} is in no list")
        });
    }
    judgement.note = format!("room for {} of {needed} entries", seen.capacity);
    judgement
}

/// Whether every list ends, and no entry is in two: a kernel may follow them.
pub fn may_follow(seen: &Chains) -> bool {
    certify(&lists(seen)).faults.is_empty()
}

/// Whether a sorted list holds nothing that another does not hold as often.
fn is_part(part: &[u32], whole: &[u32]) -> bool {
    let mut rest = whole.iter();
    part.iter().all(|key| rest.any(|other| other == key))
}

/// As lists of fragments, whose shape is certified.
fn lists(seen: &Chains) -> Lists {
    let node = |link: &Link| Node {
        key: link.key,
        next: link.next,
        prim: 0,
        mask: 0,
    };
    Lists {
        heads: seen.heads.clone(),
        nodes: seen.links.iter().map(node).collect(),
        colours: Vec::new(),
        attempts: seen.attempts,
        capacity: seen.capacity,
    }
}
