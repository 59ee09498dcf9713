//! The queues' atomics, locks, cells and memory, as shuttle has them.

use std::sync::Mutex as Lock;

use shuttle::scheduler::{PctScheduler, RandomScheduler};
pub use shuttle::sync::Mutex;
pub use shuttle::sync::atomic::{AtomicUsize, Ordering};

pub use crate::support::heap::{create, free};
use crate::support::how::{Checker, Count, How};

checked!(shuttle::sync::atomic::AtomicPtr, plain::Plain);

/// Shuttle has no cells: it knows nothing of memory that is not atomic.
mod plain {
    /// With loom's names.
    pub struct Plain<T>(std::cell::UnsafeCell<T>);

    impl<T> Plain<T> {
        pub const fn new(value: T) -> Self {
            Self(std::cell::UnsafeCell::new(value))
        }

        pub fn with<R>(&self, read: impl FnOnce(*const T) -> R) -> R {
            read(self.0.get())
        }

        pub fn with_mut<R>(&self, write: impl FnOnce(*mut T) -> R) -> R {
            write(self.0.get())
        }
    }
}

/// Shuttle: some schedules of many, drawn from a seed that is always the same.
pub struct Shim;

const SEED: u64 = 0x5eed;

impl Checker for Shim {
    type Thread<T> = shuttle::thread::JoinHandle<T>;
    type Clock = Lock<usize>;

    fn explore(how: How, count: &Count, model: impl Fn() + Send + Sync + 'static) {
        let mut config = shuttle::Config::new();
        config.failure_persistence = shuttle::FailurePersistence::None;
        config.max_steps = shuttle::MaxSteps::FailAfter(20_000);
        // Of orderings of memory, which are loom's to check.
        config.silence_warnings = true;
        let count = count.clone();
        let model = move || {
            count.one();
            model();
        };
        match how {
            How::Random(tries) => {
                let scheduler = RandomScheduler::new_from_seed(SEED, tries);
                shuttle::Runner::new(scheduler, config).run(model);
            }
            How::Priorities(tries, depth) => {
                let scheduler = PctScheduler::new_from_seed(SEED, depth, tries);
                shuttle::Runner::new(scheduler, config).run(model);
            }
            How::All | How::Bounded(_) => unreachable!("shuttle tries some"),
        }
    }

    fn spawn<T: Send + 'static>(run: impl FnOnce() -> T + Send + 'static) -> Self::Thread<T> {
        shuttle::thread::spawn(run)
    }

    fn join<T>(thread: Self::Thread<T>) -> T {
        thread.join().expect("a panic ends the model")
    }

    fn pause() {
        shuttle::thread::yield_now();
    }

    fn clock() -> Lock<usize> {
        Lock::new(0)
    }

    /// No turn of another's is between: a clock that the checker does not see.
    fn now(clock: &Lock<usize>) -> usize {
        let mut now = clock.lock().expect("nobody panics here");
        *now += 1;
        *now
    }
}
