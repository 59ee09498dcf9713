//! The queues as they are shipped, on more threads than there are cores.
//!
//! Under Miri and ThreadSanitizer too: `sanitizers.rs`.

#[path = "trees/real.rs"]
mod tree;

use std::sync::Barrier;
use std::thread;

use tree::lfree::Lfree;
use tree::local::Local;
use tree::lock::Lock;
use tree::outstanding::Outstanding;
use tree::segments::Segments;
use tree::steal::Stealing;
use tree::traits::{Queue, Worker};

/// How many threads, and how many tasks they add together.
const SIZES: &[(usize, usize)] = if cfg!(miri) {
    &[(3, 60)]
} else {
    &[(8, 400_000), (32, 400_000)]
};

/// A task: who added it, and its number among that one's. What is dealt is nobody's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Task {
    by: usize,
    number: usize,
    children: usize,
}

/// Whose tasks come in which order.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Order {
    /// Each thread gets another's in the order in which that one added them.
    Kept,
    /// Thieves take some before others.
    Lost,
}

/// On the heap: what is dropped twice or never, Miri sees.
type Boxed = Box<Task>;

/// A thread's frame: some tasks have children, all are got, each thread notes which.
fn work(
    thread: usize,
    mut worker: impl Worker<Boxed>,
    outstanding: &Outstanding,
    counted: bool,
) -> (Vec<Task>, usize) {
    let (mut got, mut added) = (Vec::new(), 0);
    loop {
        if let Some(task) = worker.get() {
            outstanding.add(task.children);
            for _ in 0..task.children {
                worker.add(Box::new(Task {
                    by: thread,
                    number: added,
                    children: 0,
                }));
                added += 1;
            }
            got.push(*task);
            outstanding.done(1);
        } else if !counted || outstanding.is_over() {
            return (got, added);
        } else {
            thread::yield_now();
        }
    }
}

/// Two frames, of tasks that have up to three children each.
fn stress(threads: usize, tasks: usize, queue: impl Queue<Boxed>, order: Order, counted: bool) {
    let outstanding = Outstanding::new();
    for frame in 0..2 {
        let dealt = (0..tasks / 2).map(|number| Task {
            by: threads,
            number,
            children: (number + frame) % 4,
        });
        outstanding.add(tasks / 2);
        queue.deal(dealt.map(Box::new));
        let start = Barrier::new(threads);
        let outcome: Vec<_> = thread::scope(|scope| {
            let begin = |thread| {
                let (queue, outstanding, start) = (&queue, &outstanding, &start);
                scope.spawn(move || {
                    start.wait();
                    work(thread, queue.worker(thread), outstanding, counted)
                })
            };
            let running: Vec<_> = (0..threads).map(begin).collect();
            running
                .into_iter()
                .map(|thread| thread.join().expect("it ends"))
                .collect()
        });
        assert!(outstanding.is_over(), "all have left, and tasks are left");
        let mut added: Vec<usize> = outcome.iter().map(|(_, added)| *added).collect();
        added.push(tasks / 2);
        judge(&added, outcome.iter().map(|(got, _)| &got[..]), order);
    }
}

/// Nothing lost, nothing twice, and in order.
fn judge<'g>(added: &[usize], outcome: impl Iterator<Item = &'g [Task]>, order: Order) {
    let mut seen: Vec<Vec<bool>> = added.iter().map(|count| vec![false; *count]).collect();
    for got in outcome {
        let mut next = vec![0; added.len()];
        for task in got {
            let seen = &mut seen[task.by][task.number];
            assert!(!*seen, "twice: {task:?}");
            *seen = true;
            let next = &mut next[task.by];
            assert!(
                order == Order::Lost || task.number >= *next,
                "reordered: {task:?} after {next}"
            );
            *next = task.number + 1;
        }
    }
    for (by, seen) in seen.iter().enumerate() {
        let lost = seen.iter().position(|seen| !seen);
        assert_eq!(lost, None, "lost: a task of {by}");
    }
}

fn each(stress: impl Fn(usize, usize)) {
    for (threads, tasks) in SIZES {
        stress(*threads, *tasks);
    }
}

#[test]
fn lock() {
    each(|threads, tasks| stress(threads, tasks, Lock::new(), Order::Kept, true));
}

#[test]
fn lfree() {
    each(|threads, tasks| stress(threads, tasks, Lfree::new(), Order::Kept, true));
}

/// Nobody adds to another's queue, so a thread whose own is empty is done.
#[test]
fn local() {
    each(|threads, tasks| stress(threads, tasks, Local::new(threads), Order::Kept, false));
}

#[test]
fn segments() {
    each(|threads, tasks| stress(threads, tasks, Segments::new(), Order::Kept, true));
}

#[test]
fn stealing() {
    each(|threads, tasks| stress(threads, tasks, Stealing::new(threads), Order::Lost, true));
}

/// Tasks are dealt in turn, task by task, and frame after frame.
#[test]
fn local_deals_in_turn() {
    let queue = Local::new(3);
    for frame in 0..2 {
        queue.deal(0..4 + frame);
    }
    let all = |thread| {
        let mut worker = queue.worker(thread);
        std::iter::from_fn(|| worker.get()).collect::<Vec<usize>>()
    };
    assert_eq!(
        [all(0), all(1), all(2)],
        [vec![0, 3, 2], vec![1, 0, 3], vec![2, 1, 4]],
        "in turn"
    );
}

/// A long queue that nobody empties is dropped without recursion, and every task once.
#[test]
fn what_is_left_is_dropped() {
    let count = if cfg!(miri) { 100 } else { 1_000_000 };
    let task = std::sync::Arc::new(());
    let tasks = || std::iter::repeat_with(|| task.clone()).take(count);
    let (lock, lfree) = (Lock::new(), Lfree::new());
    lock.deal(tasks());
    lfree.deal(tasks());
    for _ in 0..10 {
        assert!(
            lock.get().is_some() && lfree.get().is_some(),
            "there are more"
        );
    }
    drop((lock, lfree));
    assert_eq!(
        std::sync::Arc::strong_count(&task),
        1,
        "a task was not dropped"
    );
}

/// A queue of borrowed tasks, whose nodes epochs may free after what was borrowed has gone.
#[test]
fn tasks_may_borrow() {
    for round in 0..if cfg!(miri) { 10 } else { 200 } {
        let text = round.to_string();
        let queue = Lfree::new();
        queue.deal(text.split(""));
        let got: String = std::iter::from_fn(|| queue.get()).collect();
        assert_eq!(got, text, "all of it");
    }
}
