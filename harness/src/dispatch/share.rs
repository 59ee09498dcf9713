//! One job in pieces over the cores, through a queue; what comes of them is in order.
//!
//! This is how a replay spreads what the spec and Embree work out: bands of pixels, rays, maps. A piece is
//! worked out by itself, so that results do not depend on who does it, or when; they are handed back in the
//! order of the pieces. The queue is LFREE: pieces are of very unequal cost, which LOCAL
//! cannot make up for (`bench dispatch`, scene `uneven`), and with few pieces access to it costs nothing.

use std::cell::Cell;
use std::ops::Range;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

use super::queue::{Lfree, Part, Queue};

/// Threads that were asked for; 0 for one on each core.
static THREADS: AtomicUsize = AtomicUsize::new(0);

/// Has all jobs from now on done by so many threads, or by one on each core. Nothing but time depends
/// on it.
pub fn set_threads(threads: Option<usize>) {
    THREADS.store(threads.unwrap_or(0), Ordering::Relaxed);
}

thread_local! {
    /// The same for jobs of one thread alone.
    static OWN: Cell<usize> = const { Cell::new(0) };
}

/// Has all jobs that this thread asks for meanwhile done by so many threads. Pieces of a job ask for no others.
pub fn with_threads<R>(threads: usize, work: impl FnOnce() -> R) -> R {
    /// Also if the work panics.
    struct Before(usize);
    impl Drop for Before {
        fn drop(&mut self) {
            OWN.set(self.0);
        }
    }
    let _before = Before(OWN.replace(threads));
    work()
}

/// Threads of a job.
pub fn threads() -> usize {
    let own = Some(OWN.get()).filter(|own| *own > 0);
    match own.unwrap_or_else(|| THREADS.load(Ordering::Relaxed)) {
        0 => thread::available_parallelism().map_or(1, usize::from),
        threads => threads,
    }
}

/// What comes of each of so many pieces.
///
/// # Panics
/// With what a piece panics with.
pub fn each<R: Send>(count: usize, piece: impl Fn(usize) -> R + Sync) -> Vec<R> {
    by(threads(), count, piece)
}

/// The same for runs of `size` items, the last of which may be shorter; all of them put together.
///
/// # Panics
/// With what a run panics with.
pub fn runs<R: Send>(
    items: usize,
    size: usize,
    run: impl Fn(Range<usize>) -> Vec<R> + Sync,
) -> Vec<R> {
    let runs = each(items.div_ceil(size), |number| {
        let first = number * size;
        run(first..(first + size).min(items))
    });
    // As much room as is needed: a run may have nothing to say of most of its items.
    let mut all = Vec::with_capacity(runs.iter().map(Vec::len).sum());
    runs.into_iter().for_each(|run| all.extend(run));
    all
}

/// What comes of each item, in runs of `size`.
///
/// # Panics
/// With what one panics with.
pub fn map<T: Sync, R: Send>(items: &[T], size: usize, of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    runs(items.len(), size, |range| {
        items[range].iter().map(&of).collect()
    })
}

/// Whether something holds for each of so many items, in runs of `size`; after one of which it does
/// not, the rest are not looked at.
///
/// # Panics
/// With what one panics with.
pub fn all(items: usize, size: usize, holds: impl Fn(usize) -> bool + Sync) -> bool {
    let failed = AtomicBool::new(false);
    each(items.div_ceil(size), |number| {
        let mut run = number * size..items.min((number + 1) * size);
        if !run.all(|item| !failed.load(Ordering::Relaxed) && holds(item)) {
            failed.store(true, Ordering::Relaxed);
        }
    });
    !failed.into_inner()
}

/// Two jobs that are unlike.
///
/// # Panics
/// With what one panics with, and if the system starts no more threads.
pub fn join<A: Send, B>(a: impl FnOnce() -> A + Send, b: impl FnOnce() -> B) -> (A, B) {
    if threads() <= 1 {
        return (a(), b());
    }
    thread::scope(|scope| {
        let a = scope.spawn(a);
        let b = b();
        (a.join().unwrap_or_else(|panic| resume_unwind(panic)), b)
    })
}

/// What comes of each of so many pieces, by so many threads.
fn by<R: Send>(threads: usize, count: usize, piece: impl Fn(usize) -> R + Sync) -> Vec<R> {
    let threads = threads.min(count);
    if threads <= 1 {
        return (0..count).map(piece).collect();
    }
    let queue = Lfree::new();
    queue.deal(0..count);
    let help = |number| {
        let mut done = Vec::new();
        // No piece adds another, so an empty queue stays empty.
        let mut part = Part {
            worker: queue.worker(number),
            outstanding: None,
        };
        part.work_off(|_, number| done.push((number, piece(number))), |_| false);
        done
    };
    let mut done = thread::scope(|scope| {
        let help = &help;
        // Fewer help if the system starts no more threads.
        let spawn = |number| {
            let thread = thread::Builder::new();
            thread.spawn_scoped(scope, move || help(number)).ok()
        };
        let others: Vec<_> = (1..threads).map_while(spawn).collect();
        // Who asks works as well: starting a thread takes as long as a small job.
        let mut done = help(0);
        for other in others {
            done.extend(other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        done
    });
    done.sort_unstable_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use std::any::Any;
    use std::panic::catch_unwind;

    use super::{all, by, join, runs, threads, with_threads};

    #[test]
    fn results_are_in_order_whatever_the_threads() {
        let expected: Vec<usize> = (0..1000).map(|n| n * n).collect();
        for threads in [1, 2, 3, 8, 32] {
            let made = by(threads, 1000, |n| {
                // Some take longer than others.
                (0..n % 7 * 100).for_each(|_| std::hint::spin_loop());
                n * n
            });
            assert_eq!(made, expected, "{threads} threads");
        }
        assert_eq!(by(4, 0, |n| n), [0; 0], "nothing to do");
    }

    #[test]
    fn runs_are_put_together() {
        for (items, size) in [(0, 3), (1, 3), (9, 3), (10, 3)] {
            let made = runs(items, size, |range| {
                assert!(range.len() <= size && !range.is_empty(), "{range:?}");
                range.collect()
            });
            assert_eq!(made, (0..items).collect::<Vec<_>>(), "{items} by {size}");
        }
    }

    #[test]
    fn all_must_hold() {
        for count in [1, 3] {
            with_threads(count, || {
                assert_eq!(threads(), count, "as was asked");
                assert!(all(1000, 7, |n| n < 1000), "all do");
                assert!(!all(1000, 7, |n| n != 777), "one does not");
                assert!(all(0, 7, |_| false), "there is none");
            });
        }
    }

    #[test]
    fn both_of_two_jobs_are_done() {
        for count in [1, 2] {
            let made = with_threads(count, || join(|| vec![1, 2], || "three"));
            assert_eq!(made, (vec![1, 2], "three"), "{count} threads");
        }
    }

    #[test]
    fn a_piece_that_panics_is_heard() {
        let run = || by(3, 50, |n| assert!(n != 20, "piece 20"));
        let heard = |panic: Box<dyn Any + Send>| *panic.downcast::<&str>().expect("words");
        assert_eq!(catch_unwind(run).map_err(heard), Err("piece 20"));
        let other = || with_threads(2, || join(|| panic!("the other"), || ()));
        assert_eq!(catch_unwind(other).map_err(heard), Err("the other"));
    }
}
