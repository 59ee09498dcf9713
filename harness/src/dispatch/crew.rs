//! Threads that are all alike, and the frames that they work on (paper listings 2 and 3).

use std::any::Any;
use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::gate::{End, Gate};
use super::queue::outstanding::Outstanding;
use super::queue::{Part, Queue, Worker};

/// When a thread takes a frame to be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// When nothing is in the queue at this moment, as in the paper. Others may still add tasks,
    /// which they then do themselves.
    Empty,
    /// When no task is left: neither in the queue nor in anybody's hands.
    Counted,
}

impl Ending {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Empty, Self::Counted];

    /// A word for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Empty => "empty",
            Self::Counted => "counted",
        }
    }
}

/// What threads did with their time, summed up over frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spent {
    /// From a thread's last task of a frame to the frame's end, and while it found the queue empty.
    pub idle: Duration,
    /// Within the queue's operations, those aside that found it empty.
    pub access: Duration,
    /// Tasks that it did.
    pub tasks: u64,
}

/// How a crew works.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crew {
    /// How many threads; at least one.
    pub threads: usize,
    /// When a thread takes a frame to be done.
    pub ending: Ending,
    /// Whether to look at the clock around every operation of the queue.
    pub watched: bool,
}

/// A thread's way to the queue: what a task may add tasks with.
pub type Hands<'a, W> = Part<'a, Watched<'a, W>>;

/// A thread's end of the queue, beside a clock.
pub struct Watched<'a, W> {
    worker: W,
    /// Whether to look at it.
    watched: bool,
    /// When taking the last task, or finding none, began.
    began: Option<Instant>,
    access: Duration,
    /// Then there is nothing more to take.
    given_up: &'a AtomicBool,
}

impl<T, W: Worker<T>> Worker<T> for Watched<'_, W> {
    fn add(&mut self, task: T) {
        let start = self.watched.then(Instant::now);
        self.worker.add(task);
        self.access += since(start);
    }

    fn get(&mut self) -> Option<T> {
        if self.given_up.load(Ordering::Relaxed) {
            return None;
        }
        self.began = self.watched.then(Instant::now);
        let task = self.worker.get();
        if task.is_some() {
            self.access += since(self.began);
        }
        task
    }
}

fn since(start: Option<Instant>) -> Duration {
    start.map_or(Duration::ZERO, |start| start.elapsed())
}

/// What the threads of a crew share while they work.
struct Shared<'a, Q, W> {
    queue: &'a Q,
    work: W,
    crew: Crew,
    outstanding: Outstanding,
    gate: Gate,
    /// What a task panicked with; the frame is then given up.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
    given_up: AtomicBool,
}

impl Crew {
    /// A crew that ends frames by counting and looks at no clock.
    pub fn new(threads: usize) -> Self {
        Self {
            threads,
            ending: Ending::Counted,
            watched: false,
        }
    }

    /// Does some tasks, and those that they add, and returns when all are done.
    ///
    /// # Panics
    /// With what a task panics with, and if the system starts no more threads.
    pub fn run<T: Send, Q: Queue<T>>(
        self,
        queue: &Q,
        tasks: impl IntoIterator<Item = T>,
        work: impl Fn(&mut Hands<'_, Q::Worker<'_>>, T) + Sync,
    ) -> Vec<Spent> {
        let mut tasks = Some(tasks);
        self.frames(queue, || tasks.take(), work, || ())
    }

    /// The application's loop (listing 3): `first` gives the tasks that a frame begins with, or
    /// `None` after the last one, and is asked for them while threads work on the frame before (its
    /// `application_logic2`); `finish` is called at the end of each, while all threads wait. What each
    /// thread spent, in order of their numbers.
    ///
    /// # Panics
    /// With what a task, `first` or `finish` panics with, and if the system starts no more threads.
    pub fn frames<T: Send, Q: Queue<T>, I: IntoIterator<Item = T>>(
        self,
        queue: &Q,
        mut first: impl FnMut() -> Option<I>,
        work: impl Fn(&mut Hands<'_, Q::Worker<'_>>, T) + Sync,
        mut finish: impl FnMut(),
    ) -> Vec<Spent> {
        assert!(self.threads > 0, "a crew has at least one thread");
        let shared = Shared {
            queue,
            work,
            crew: self,
            outstanding: Outstanding::new(),
            gate: Gate::default(),
            panic: Mutex::new(None),
            given_up: AtomicBool::new(false),
        };
        thread::scope(|scope| {
            let shared = &shared;
            let end = End(&shared.gate);
            let spawn = |number| {
                let thread = thread::Builder::new();
                let thread = thread.spawn_scoped(scope, move || shared.thread(number));
                thread.expect("the system starts a thread")
            };
            let threads: Vec<_> = (0..self.threads).map(spawn).collect();
            let mut next = first();
            while let Some(tasks) = next {
                queue.deal(tasks.into_iter().inspect(|_| shared.dealt()));
                shared.gate.open(self.threads);
                next = first();
                shared.gate.wait();
                if shared.given_up.load(Ordering::Relaxed) {
                    break;
                }
                finish();
            }
            drop(end);
            let joined = threads.into_iter().map(|thread| thread.join());
            let spent = joined.map(|spent| spent.unwrap_or_else(|panic| resume_unwind(panic)));
            let spent = spent.collect();
            if let Some(panic) = shared.panicked().take() {
                resume_unwind(panic);
            }
            spent
        })
    }
}

impl<Q, W> Shared<'_, Q, W> {
    /// A task is about to be in the queue.
    fn dealt(&self) {
        if self.crew.ending == Ending::Counted {
            self.outstanding.add(1);
        }
    }

    fn panicked(&self) -> MutexGuard<'_, Option<Box<dyn Any + Send>>> {
        self.panic.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A thread's loop (listing 2). A task that panics must not leave the others waiting: the thread
    /// goes on as after its last task, and the application panics in its place.
    fn thread<T: Send>(&self, number: usize) -> Spent
    where
        Q: Queue<T>,
        W: for<'w> Fn(&mut Hands<'_, Q::Worker<'w>>, T) + Sync,
    {
        let mut spent = Spent::default();
        let mut frame = 0;
        while let Some(next) = self.gate.enter(frame) {
            frame = next;
            let work = AssertUnwindSafe(|| self.frame(number, &mut spent));
            let last = catch_unwind(work).unwrap_or_else(|panic| {
                self.panicked().get_or_insert(panic);
                self.given_up.store(true, Ordering::Relaxed);
                None
            });
            self.gate.leave(frame);
            spent.idle += since(last);
        }
        spent
    }

    /// A thread's part of a frame; when it was done with it, if the clock is looked at.
    fn frame<T: Send>(&self, number: usize, spent: &mut Spent) -> Option<Instant>
    where
        Q: Queue<T>,
        W: for<'w> Fn(&mut Hands<'_, Q::Worker<'w>>, T) + Sync,
    {
        let counted = self.crew.ending == Ending::Counted;
        let mut hands = Hands {
            worker: Watched {
                worker: self.queue.worker(number),
                watched: self.crew.watched,
                began: None,
                access: Duration::ZERO,
                given_up: &self.given_up,
            },
            outstanding: counted.then_some(&self.outstanding),
        };
        // In a row, finding nothing.
        let times = Cell::new(0_u32);
        let work = |hands: &mut Hands<'_, _>, task| {
            times.set(0);
            (self.work)(hands, task);
            spent.tasks += 1;
        };
        let pause = |watched: &mut Watched<'_, _>| {
            times.set(times.get().saturating_add(1));
            wait(times.get());
            spent.idle += since(watched.began);
            !self.given_up.load(Ordering::Relaxed)
        };
        hands.work_off(work, pause);
        spent.access += hands.worker.access;
        self.crew.watched.then(Instant::now)
    }
}

/// A moment, longer for whoever has found nothing for a while: there may be fewer cores than
/// threads, and somebody's task then waits for one.
fn wait(times: u32) {
    match times {
        0..16 => std::hint::spin_loop(),
        _ => thread::yield_now(),
    }
}
