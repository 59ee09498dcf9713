//! A frame over the queue without locks, by the engine's loop, with tasks that have children.

use super::held::Held;
use super::lfree::Lfree;
use super::outstanding::Outstanding;
use super::part::Part;
use super::sync::{Shim, UnsafeCell};
use crate::support::how::{Checker, Count, How};
use crate::support::traits::Queue;

/// When a thread's frame ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rule {
    /// As in listing 2: the queue is empty at this moment.
    Empty,
    /// All tasks are done.
    Counted,
}

/// Tasks of the model: the first has the others for children.
const TASKS: usize = 3;

struct Frame {
    queue: Lfree<usize, Held<super::node::Node<usize>>>,
    outstanding: Outstanding,
    /// What each task writes, once.
    written: [UnsafeCell<usize>; TASKS],
}

// SAFETY: the checker watches the cells, and fails where two threads meet.
#[expect(unsafe_code, reason = "a model's cells")]
unsafe impl Sync for Frame {}

impl Frame {
    /// Whether this thread left while there was something to do.
    #[expect(unsafe_code, reason = "a model's cells")]
    fn work(&self, rule: Rule, thread: usize) -> bool {
        let counted = rule != Rule::Empty;
        let mut part = Part {
            worker: self.queue.worker(thread),
            outstanding: counted.then_some(&self.outstanding),
        };
        // Where the frame does not count, the model does, to see who left early.
        let own = (!counted).then_some(&self.outstanding);
        let work = |part: &mut Part<'_, _>, task: usize| {
            // SAFETY: the checker fails if another thread has it.
            self.written[task].with_mut(|written| unsafe { *written += 1 });
            let children = if task == 0 { 1..TASKS } else { 0..0 };
            own.inspect(|own| own.add(children.len()));
            children.for_each(|child| part.add(child));
            own.inspect(|own| own.done(1));
        };
        let pause = |_: &mut _| {
            Shim::pause();
            true
        };
        part.work_off(work, pause);
        if counted {
            for written in &self.written {
                // SAFETY: as above.
                let times = written.with(|written| unsafe { *written });
                assert_eq!(times, 1, "a task was done {times} times when all was over");
            }
        }
        !self.outstanding.is_over()
    }
}

/// Schedules in which some thread left early.
pub fn run(rule: Rule, threads: usize, how: How, count: &Count) -> usize {
    let early = Count::default();
    let left = early.clone();
    Shim::explore(how, count, move || {
        let frame: &'static Frame = Box::leak(Box::new(Frame {
            queue: Lfree::with(Held::new()),
            outstanding: Outstanding::new(),
            written: std::array::from_fn(|_| UnsafeCell::new(0)),
        }));
        frame.outstanding.add(1);
        frame.queue.deal([0]);
        let others: Vec<_> = (1..threads)
            .map(|t| Shim::spawn(move || frame.work(rule, t)))
            .collect();
        let mut any = frame.work(rule, 0);
        for other in others {
            any |= Shim::join(other);
        }
        assert!(
            frame.outstanding.is_over(),
            "all have left, and tasks are left"
        );
        if any {
            left.one();
        }
        // SAFETY: it is the box that was leaked above, and the threads have ended.
        #[expect(unsafe_code, reason = "a model's threads borrow from it")]
        drop(unsafe { Box::from_raw((&raw const *frame).cast_mut()) });
        crate::support::heap::end(false);
    });
    early.get()
}
