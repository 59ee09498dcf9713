//! The queues' atomics and locks as they are, but for threads that stop for good.

use std::cell::RefCell;
use std::ops::{Deref, DerefMut};
use std::panic::resume_unwind;
use std::sync::mpsc::Sender;
use std::sync::{LockResult, TryLockError, atomic};
use std::thread;

pub use std::sync::atomic::Ordering;

/// Accesses that a thread has left, and whom it tells that it has none.
struct Fate {
    left: usize,
    stops: Sender<bool>,
}

thread_local! {
    static FATE: RefCell<Option<Fate>> = const { RefCell::new(None) };
}

/// What this thread panics with where it would wait for ever.
pub struct Waits;

/// Runs something on a thread that stops for good once it has accessed what is shared so many
/// times. Tells whether it did; else it came to an end.
pub fn doomed(left: usize, stops: Sender<bool>, run: impl FnOnce() + Send + 'static) {
    thread::spawn(move || {
        let end = stops.clone();
        FATE.set(Some(Fate { left, stops }));
        run();
        FATE.set(None);
        end.send(false).expect("the test waits");
    });
}

/// Before each access.
fn step() {
    let stops = FATE.with_borrow_mut(|fate| {
        let fate = fate.as_mut()?;
        match fate.left.checked_sub(1) {
            Some(left) => {
                fate.left = left;
                None
            }
            None => Some(fate.stops.clone()),
        }
    });
    if let Some(stops) = stops {
        stops.send(true).expect("the test waits");
        loop {
            thread::park();
        }
    }
}

/// A pointer that others may change.
pub struct AtomicPtr<T>(atomic::AtomicPtr<T>);

impl<T> AtomicPtr<T> {
    pub const fn new(value: *mut T) -> Self {
        Self(atomic::AtomicPtr::new(value))
    }

    pub fn load(&self, order: Ordering) -> *mut T {
        step();
        self.0.load(order)
    }

    pub fn store(&self, value: *mut T, order: Ordering) {
        step();
        self.0.store(value, order);
    }

    pub fn compare_exchange(
        &self,
        from: *mut T,
        to: *mut T,
        success: Ordering,
        failure: Ordering,
    ) -> Result<*mut T, *mut T> {
        step();
        self.0.compare_exchange(from, to, success, failure)
    }
}

/// A lock that says so instead of waiting: whoever has it has stopped.
pub struct Mutex<T>(std::sync::Mutex<T>);

/// While it is held; letting go is an access, too.
pub struct Guard<'m, T>(std::sync::MutexGuard<'m, T>);

impl<T> Mutex<T> {
    pub const fn new(value: T) -> Self {
        Self(std::sync::Mutex::new(value))
    }

    pub fn lock(&self) -> LockResult<Guard<'_, T>> {
        step();
        match self.0.try_lock() {
            Ok(guard) => Ok(Guard(guard)),
            Err(TryLockError::WouldBlock) => resume_unwind(Box::new(Waits)),
            Err(TryLockError::Poisoned(_)) => unreachable!("nobody panics under it"),
        }
    }
}

impl<T> Deref for Guard<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T> DerefMut for Guard<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        &mut self.0
    }
}

impl<T> Drop for Guard<'_, T> {
    fn drop(&mut self) {
        step();
    }
}

/// A cell; a thread may stop before it takes what is its own.
pub struct UnsafeCell<T>(std::cell::UnsafeCell<T>);

impl<T> UnsafeCell<T> {
    pub const fn new(value: T) -> Self {
        Self(std::cell::UnsafeCell::new(value))
    }

    pub fn with_mut<R>(&self, write: impl FnOnce(*mut T) -> R) -> R {
        step();
        write(self.0.get())
    }
}

pub fn create<N>(node: N) -> *mut N {
    Box::into_raw(Box::new(node))
}

/// # Safety
///
/// It is [`create`]'s, this happens once, and nobody reads it any more.
#[expect(unsafe_code, reason = "in place of the queues' memory")]
pub unsafe fn free<N>(node: *mut N) {
    // SAFETY: it came from a box, and the caller is its last owner.
    drop(unsafe { Box::from_raw(node) });
}
