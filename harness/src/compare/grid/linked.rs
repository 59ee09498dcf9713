//! The paper's linked lists: each entry in exactly one, then the same as the runs.

use triptych_gpu::grid::Linked;
use triptych_spec::abuffer::EOL;

use super::{Runs, listed};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::row::Class;

/// Follows every list, once over each entry, and compares its ids with the run of the cell:
/// it holds those of `least`, and none beyond `most`, which are the same lists where a kernel
/// can decide. Without room for all, a list may lack some.
pub fn linked(least: Runs<'_>, most: Runs<'_>, seen: &Linked) -> Judgement {
    let exact = least.prims.len() == most.prims.len();
    let needed = match exact {
        true => least.prims.len() as u64,
        false => u64::from(seen.attempts),
    };
    let capacity = seen.entries.len() as u64;
    let mut judgement = listed(Class::Structure, needed.min(capacity), least.cells());
    let bounds = [least, most].map(|runs| runs.prims.len() as u64);
    if !(bounds[0]..=bounds[1]).contains(&u64::from(seen.attempts)) {
        judgement.differs(Cause::Overflow, None, || {
            let [least, most] = bounds;
            format!(
                "the counter is {}, must be {least} to {most}",
                seen.attempts
            )
        });
    }
    let stored = needed.min(capacity);
    let mut owner = vec![None; usize::try_from(stored).expect("no more than are there")];
    let mut list = Vec::new();
    for (cell, &head) in seen.heads.iter().enumerate() {
        list.clear();
        let fault = follow(cell, head, seen, &mut owner, &mut list);
        list.sort_unstable();
        let (low, high) = (least.list(cell), most.list(cell));
        let lost = stored == needed && low.iter().any(|p| list.binary_search(p).is_err());
        let cause = match fault {
            Some(cause) => Some(cause),
            None if list.iter().any(|p| high.binary_search(p).is_err()) => Some(Cause::Coverage),
            None if list.windows(2).any(|pair| pair[0] == pair[1]) => Some(Cause::Duplicate),
            None if lost => Some(Cause::LostNode),
            None => None,
        };
        if let Some(cause) = cause {
            judgement.differs(cause, None, || {
                let (list, run) = (list.len(), low.len());
                format!("the list of cell {cell} leads to {list} entries, must to {run}")
            });
        }
    }
    let lost = owner.iter().filter(|owner| owner.is_none()).count();
    if lost > 0 && judgement.causes.is_empty() {
        judgement.differs(Cause::LostNode, None, || {
            format!("{lost} entries are in no list")
        });
    }
    judgement.note = format!("room for {capacity} of {needed}");
    judgement
}

/// Appends a list's ids, up to a fault.
fn follow(
    cell: usize,
    head: u32,
    seen: &Linked,
    owner: &mut [Option<usize>],
    list: &mut Vec<u32>,
) -> Option<Cause> {
    let mut at = head;
    while at != EOL {
        match owner.get_mut(at as usize) {
            None if at < seen.attempts => return Some(Cause::Overflow),
            None => return Some(Cause::CorruptLink),
            Some(Some(other)) if *other == cell => return Some(Cause::Cycle),
            Some(Some(_)) => return Some(Cause::CorruptLink),
            Some(free) => *free = Some(cell),
        }
        let entry = seen.entries[at as usize];
        list.push(entry.prim);
        at = entry.next;
    }
    None
}
