//! What the threads of a model do, and what is held against it afterwards.

use super::events::{Act, EACH, Event, Item, Lives};
use super::heap;
use super::how::Checker;
use super::linear;
use super::traits::{Queue, Worker};

/// What each thread does: `a` adds, `g` gets.
#[derive(Clone, Copy, Debug)]
pub struct Script {
    /// Tasks that are dealt before.
    pub dealt: usize,
    /// The first is the model's own thread.
    pub threads: &'static [&'static str],
    /// Whether threads look at a clock, before and after what they do. For it to be of use, it
    /// must order their memory too, and so may hide that a queue does not.
    pub timed: bool,
    /// Whether it is one queue; else each thread may have its own.
    pub one: bool,
    /// Whether epochs free, at a time of their own.
    pub late: bool,
}

impl Script {
    /// Nobody does anything with one queue.
    pub const PLAIN: Self = Self {
        dealt: 0,
        threads: &[],
        timed: false,
        one: true,
        late: false,
    };
}

/// Does one thread's part.
struct Player<C: Checker> {
    thread: usize,
    lives: &'static Lives,
    clock: Option<&'static C::Clock>,
    events: Vec<Event>,
}

impl<C: Checker> Player<C> {
    fn now(&self) -> usize {
        self.clock.map_or(0, C::now)
    }

    fn did(&mut self, act: impl FnOnce(&Self) -> Act) {
        let from = self.now();
        let act = act(self);
        let (thread, to) = (self.thread, self.now());
        self.events.push(Event {
            thread,
            act,
            from,
            to,
        });
    }

    fn item(&self, count: usize) -> Item {
        self.lives.item(self.thread * EACH + count)
    }

    fn plays(mut self, mut worker: impl Worker<Item>, part: &str) -> Vec<Event> {
        for (count, step) in part.chars().enumerate() {
            self.did(|player| match step {
                'a' => {
                    let item = player.item(count);
                    let id = item.id;
                    worker.add(item);
                    Act::Add(id)
                }
                'g' => Act::Get(worker.get().map(|item| item.id)),
                _ => unreachable!("{step} is neither a nor g"),
            });
        }
        self.events
    }

    /// Until it is empty.
    fn empties(mut self, mut worker: impl Worker<Item>) -> Vec<Event> {
        while self.events.last().is_none_or(|e| e.act != Act::Get(None)) {
            self.did(|_| Act::Get(worker.get().map(|item| item.id)));
        }
        self.events
    }
}

/// One schedule of a script.
pub fn play<C: Checker, Q: Queue<Item> + Send + 'static>(script: Script, make: impl FnOnce() -> Q) {
    let threads = script.threads.len();
    // Not dropped in a panic, which in a model can only make it worse.
    let all: &'static (Q, Lives, Option<C::Clock>) = Box::leak(Box::new((
        make(),
        Lives::new(threads + 1),
        script.timed.then(C::clock),
    )));
    let (queue, lives, clock) = (&all.0, &all.1, all.2.as_ref());
    let player = move |thread| Player::<C> {
        thread,
        lives,
        clock,
        events: Vec::new(),
    };
    let mut dealer = player(threads);
    for count in 0..script.dealt {
        dealer.did(|dealer| {
            queue.deal([dealer.item(count)]);
            Act::Add(threads * EACH + count)
        });
    }
    let begin = |thread| {
        C::spawn(move || player(thread).plays(queue.worker(thread), script.threads[thread]))
    };
    let others: Vec<_> = (1..threads).map(begin).collect();
    let mut events = dealer.events;
    events.extend(player(0).plays(queue.worker(0), script.threads[0]));
    events.extend(others.into_iter().flat_map(C::join));
    for thread in 0..threads {
        events.extend(player(thread).empties(queue.worker(thread)));
    }
    // SAFETY: it is the box that was leaked above, and the threads have ended.
    #[expect(unsafe_code, reason = "a model's threads borrow from it")]
    let (queue, lives, _) = *unsafe { Box::from_raw((&raw const *all).cast_mut()) };
    drop(queue);
    check(script, &events, &lives);
    heap::end(script.late);
}

fn check(script: Script, events: &[Event], lives: &Lives) {
    let added = events.iter().filter_map(|e| match e.act {
        Act::Add(id) => Some(id),
        Act::Get(_) => None,
    });
    let found = linear::complete(events)
        .and_then(|()| linear::ordered(events, |id| id / EACH))
        .and_then(|()| match script.timed && script.one {
            true if events.len() <= linear::TRIED_MAX => linear::linear(events),
            true => linear::plausible(events),
            false => Ok(()),
        });
    found.unwrap_or_else(|wrong| panic!("{wrong}"));
    lives.check(added);
}
