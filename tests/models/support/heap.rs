//! Memory for nodes that tells when it is used after it was freed.
//!
//! Freed memory is kept until the schedule is over, so that reading it is defined, and a panic.

use std::alloc::{Layout, dealloc};
use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::{self, ThreadId};

struct Block {
    layout: Layout,
    /// Whose schedule it belongs to: a model runs all its threads on one.
    owner: ThreadId,
    freed: bool,
    /// Its schedule is over, but an epoch has not freed it yet.
    late: bool,
}

/// By address.
static BLOCKS: Mutex<BTreeMap<usize, Block>> = Mutex::new(BTreeMap::new());

fn blocks() -> MutexGuard<'static, BTreeMap<usize, Block>> {
    BLOCKS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Memory for a node.
pub fn create<N>(node: N) -> *mut N {
    let node = Box::into_raw(Box::new(node));
    let block = Block {
        layout: Layout::new::<N>(),
        owner: thread::current().id(),
        freed: false,
        late: false,
    };
    blocks().insert(node.addr(), block);
    node
}

/// Drops a node; its memory stays.
///
/// # Safety
///
/// It is [`create`]'s.
#[expect(unsafe_code, reason = "in place of the queues' memory")]
pub unsafe fn free<N>(node: *mut N) {
    let mut blocks = blocks();
    let block = blocks
        .get_mut(&node.addr())
        .expect("a node that was created");
    if block.late {
        // Outside of its schedule its atomics cannot be used. Its value was taken.
        let layout = block.layout;
        blocks.remove(&node.addr());
        // SAFETY: it came from a box of this layout.
        unsafe { dealloc(node.cast(), layout) };
        return;
    }
    assert!(!block.freed, "a node was freed twice");
    block.freed = true;
    let here = block.owner == thread::current().id();
    drop(blocks);
    if here {
        // SAFETY: it is whole, and dropped once, as it was not freed before.
        unsafe { node.drop_in_place() };
    }
}

/// Panics if an address lies in memory that was freed.
pub fn check(address: usize) {
    let blocks = blocks();
    if let Some((start, block)) = blocks.range(..=address).next_back()
        && address < start + block.layout.size()
        && block.freed
    {
        drop(blocks);
        panic!("a node was used after it was freed");
    }
}

/// Ends a schedule: gives its memory back. What was never freed is an error, unless an
/// epoch may still do it.
#[expect(unsafe_code, reason = "in place of the queues' memory")]
pub fn end(late: bool) {
    let here = thread::current().id();
    let mut blocks = blocks();
    let own: Vec<usize> = blocks
        .iter()
        .filter(|(_, b)| b.owner == here && !b.late)
        .map(|(a, _)| *a)
        .collect();
    let mut left = 0;
    for address in own {
        let block = blocks.get_mut(&address).expect("it was listed");
        if block.freed {
            let layout = block.layout;
            blocks.remove(&address);
            // SAFETY: it came from a box of this layout; nobody has a pointer any more.
            unsafe { dealloc(std::ptr::with_exposed_provenance_mut(address), layout) };
        } else {
            block.late = true;
            left += 1;
        }
    }
    drop(blocks);
    assert!(late || left == 0, "{left} nodes were never freed");
}
