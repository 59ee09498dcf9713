//! Nodes that are freed at once, as listing 5 has it, in an arena that can tell.
//!
//! The slot that was freed last is used first, as allocators do. Each has a generation, one
//! more each time that it is freed; a thread that reads a node of another generation than
//! the one to which it loaded a pointer has used it after it was freed. Where nobody looks
//! (memory that stays what it is, without tags), nothing happens, until an address comes back.

use std::cell::{RefCell, UnsafeCell};
use std::collections::BTreeMap;
use std::mem::MaybeUninit;
use std::sync::Mutex;

use super::reclaim::Reclaim;
use super::sync::{AtomicPtr, Ordering};

/// More nodes than a model has.
const SLOTS: usize = 16;

struct State {
    free: Vec<usize>,
    generations: [usize; SLOTS],
}

/// Slots for nodes.
pub struct Arena<N> {
    slots: Box<[UnsafeCell<MaybeUninit<N>>]>,
    state: Mutex<State>,
    /// Whether generations are compared.
    looks: bool,
}

// SAFETY: a slot is written by who took it from the list of free ones, under a lock.
#[expect(unsafe_code, reason = "a reclaimer is")]
unsafe impl<N> Send for Arena<N> {}
// SAFETY: as above. What is read of slots are atomics, and cells that the checker watches.
#[expect(unsafe_code, reason = "a reclaimer is")]
unsafe impl<N> Sync for Arena<N> {}

/// Slots and the generation in which each was first pointed to.
type Seen = RefCell<BTreeMap<usize, usize>>;

impl<N> Arena<N> {
    pub fn new(looks: bool) -> Self {
        let slot = || UnsafeCell::new(MaybeUninit::uninit());
        let state = State {
            free: (0..SLOTS).rev().collect(),
            generations: [0; SLOTS],
        };
        Self {
            slots: std::iter::repeat_with(slot).take(SLOTS).collect(),
            state: Mutex::new(state),
            looks,
        }
    }

    /// The slot in which an address lies.
    fn slot(&self, address: usize) -> Option<usize> {
        let from = address.checked_sub(self.slots.as_ptr().addr())?;
        let slot = from / size_of::<N>();
        (slot < SLOTS).then_some(slot)
    }

    fn compare(&self, seen: &Seen, slot: usize) {
        let now = self.state.lock().expect("nobody panics here").generations[slot];
        let then = *seen.borrow_mut().entry(slot).or_insert(now);
        if self.looks && then != now {
            panic!("node {slot} of generation {then} was read in generation {now}");
        }
    }

    fn give_back(&self, node: *mut N) {
        let slot = self.slot(node.addr()).expect("it is the arena's");
        let mut state = self.state.lock().expect("nobody panics here");
        state.generations[slot] += 1;
        state.free.push(slot);
    }
}

#[expect(unsafe_code, reason = "a reclaimer is")]
impl<N> Reclaim<N> for Arena<N> {
    type Guard<'g>
        = Seen
    where
        N: 'g;

    fn pin(&self) -> Seen {
        Seen::default()
    }

    fn create(&self, node: N) -> *mut N {
        let slot = self.state.lock().expect("nobody panics here").free.pop();
        let place = self.slots[slot.expect("enough slots")].get().cast::<N>();
        // SAFETY: the slot is nobody's. Others may refer to what was there, but only to
        // atomics and cells, which may change.
        unsafe { place.write(node) };
        place
    }

    fn load(&self, seen: &Seen, place: &AtomicPtr<N>) -> *mut N {
        let node = place.load(Ordering::Acquire);
        // Others had their turn before the load, so that is what must be right now.
        if let Some(slot) = self.slot((&raw const *place).addr()) {
            self.compare(seen, slot);
        }
        // A pointer is good for the generation in which it was loaded.
        if let Some(slot) = self.slot(node.addr()) {
            let now = self.state.lock().expect("nobody panics here").generations[slot];
            seen.borrow_mut().insert(slot, now);
        }
        node
    }

    unsafe fn node<'g>(&self, seen: &'g Seen, node: *mut N) -> &'g N {
        self.compare(seen, self.slot(node.addr()).expect("it is the arena's"));
        // SAFETY: slots stay, and hold a node from their first use on.
        unsafe { &*node }
    }

    unsafe fn retire(&self, _seen: &Seen, node: *mut N) {
        self.give_back(node);
        if self.looks {
            // SAFETY: it was whole. Being freed is an access that the checker sees; nobody gets
            // past reading what is left.
            unsafe { node.drop_in_place() };
        }
    }

    unsafe fn free(&self, node: *mut N) {
        // SAFETY: the caller is the last, and it is dropped once.
        unsafe { node.drop_in_place() };
        self.give_back(node);
    }
}
