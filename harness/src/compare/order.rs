//! Stage `sort`: the order of every list.

use triptych_spec::abuffer::{EOL, Lists, Sorted};
use triptych_spec::raster::Fragment;

use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::fragments::at;
use crate::compare::lists::certify;
use crate::row::Class;

/// Follows every list of `lists`; gives fragments list by list. Pixels count from
/// 0. `None` if a link leads astray or a list does not end.
pub fn flatten(lists: &Lists) -> Option<Sorted> {
    let mut flat = Sorted {
        offsets: vec![0],
        fragments: Vec::with_capacity(lists.nodes.len()),
    };
    for (pixel, &head) in (0_u32..).zip(&lists.heads) {
        let mut at = head;
        while at != EOL {
            let node = lists.nodes.get(at as usize)?;
            if flat.fragments.len() == lists.nodes.len() {
                return None;
            }
            let (prim, key, mask) = (node.prim, node.key, node.mask);
            flat.fragments.push(Fragment {
                pixel,
                prim,
                key,
                mask,
            });
            at = node.next;
        }
        flat.offsets.push(u32::try_from(flat.fragments.len()).ok()?);
    }
    Some(flat)
}

/// Compares the order of lists that hold the same fragments. A run of equal keys
/// in another order is a broken tie; everything else is not sorted. Lists that do
/// not hold the same any more have the cause of `build`'s certificate: a fault, or a
/// node that no list leads to.
pub fn compare(spec: &Sorted, other: &Lists, width: u32) -> Judgement {
    let mut judgement = Judgement::new(Class::Tie, "fragments");
    let certificate = certify(other);
    for fault in &certificate.faults {
        judgement.differs(fault.cause, Some(fault.pixel), || {
            let (at, to) = (at(fault.pixel, width), fault.address);
            format!("{at}: after sorting a link leads to address {to}")
        });
    }
    // Nodes that were in no list before sorting are no concern of it.
    let nodes = spec.fragments.len();
    if certificate.faults.is_empty() {
        for _ in certificate.order.len()..nodes {
            let sorted = certificate.order.len();
            judgement.differs(Cause::LostNode, None, || {
                format!("{nodes} nodes were in lists before sorting, {sorted} are after it")
            });
        }
    }
    let other = flatten(other).filter(|o| o.offsets == spec.offsets);
    let Some(other) = other.filter(|_| judgement.differ() == 0) else {
        // Sound lists of other lengths: a node went from one list to another.
        if judgement.differ() == 0 {
            judgement.differs(Cause::CorruptLink, None, || {
                "sorting changed the number of fragments in a list".into()
            });
        }
        return judgement;
    };
    for pixel in 0..spec.offsets.len() - 1 {
        let (must, seen) = (spec.list(pixel), other.list(pixel));
        judgement.compared += must.len() as u64;
        if must == seen {
            continue;
        }
        let keys_agree = must.iter().map(|f| f.key).eq(seen.iter().map(|f| f.key));
        let cause = if keys_agree {
            Cause::TieOrder
        } else {
            Cause::SortOrder
        };
        let pixel = u32::try_from(pixel).expect("a target has fewer than 2^32 pixels");
        judgement.differs(cause, Some(pixel), || {
            format!(
                "{} is {}, must be {}",
                at(pixel, width),
                words(seen),
                words(must)
            )
        });
    }
    if judgement.compared == 0 {
        judgement.unit = "empty lists";
        judgement.compared = spec.offsets.len() as u64 - 1;
    }
    judgement
}

/// A list as `(key, row)` pairs, shortened.
pub fn words(list: &[Fragment]) -> String {
    const SHOWN: usize = 6;
    let mut shown: Vec<String> = list
        .iter()
        .take(SHOWN)
        .map(|f| format!("{}:{}", f.key, f.prim))
        .collect();
    if list.len() > SHOWN {
        shown.push(format!("… {} in all", list.len()));
    }
    format!("[{}]", shown.join(" "))
}

#[cfg(test)]
mod tests;
