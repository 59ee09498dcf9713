//! Whether a history is one of a queue.
//!
//! Linearizable is: each operation can be given a moment between its beginning and its
//! end, so that in the order of those moments a plain queue would have answered the same. Found
//! by trying (Wing and Gong 1993), where no state is tried twice (Lowe 2017); for longer
//! histories what can be told without trying.

use std::collections::{BTreeMap, HashSet, VecDeque};

use super::events::{Act, Event};

/// Operations that are tried out, at most.
pub const TRIED_MAX: usize = 24;

/// Nothing is lost, nothing comes twice, nothing comes from nowhere. The queue was emptied.
pub fn complete(events: &[Event]) -> Result<(), String> {
    let mut balance: BTreeMap<usize, (usize, usize)> = BTreeMap::new();
    for event in events {
        match event.act {
            Act::Add(id) => balance.entry(id).or_default().0 += 1,
            Act::Get(Some(id)) => balance.entry(id).or_default().1 += 1,
            Act::Get(None) => {}
        }
    }
    for (id, (added, got)) in balance {
        if added != got {
            let what = if got < added { "lost" } else { "twice" };
            return Err(format!(
                "{what}: task {id} was added {added} times, got {got} times"
            ));
        }
    }
    Ok(())
}

/// A thread gets the tasks of another in the order in which that one added them, where
/// `producer` says whose a task is. Events of a thread are in order.
pub fn ordered(events: &[Event], producer: impl Fn(usize) -> usize) -> Result<(), String> {
    let mut added: BTreeMap<usize, usize> = BTreeMap::new();
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for event in events {
        if let Act::Add(id) = event.act {
            let count = counts.entry(event.thread).or_default();
            added.insert(id, *count);
            *count += 1;
        }
    }
    let mut last: BTreeMap<(usize, usize), (usize, usize)> = BTreeMap::new();
    for event in events {
        if let Act::Get(Some(id)) = event.act {
            let place = (event.thread, producer(id));
            let own = added.get(&id).copied().unwrap_or_default();
            if let Some((before, other)) = last.insert(place, (own, id))
                && before > own
            {
                return Err(format!(
                    "reordered: thread {} got {id} after {other}",
                    event.thread
                ));
            }
        }
    }
    Ok(())
}

/// What must not be, whatever the moments were, found from pairs alone: a task got before it
/// was added, one overtaken by a later one, and `EMPTY` while one was surely there.
pub fn plausible(events: &[Event]) -> Result<(), String> {
    let mut tasks: BTreeMap<usize, (Option<&Event>, Option<&Event>)> = BTreeMap::new();
    for event in events {
        match event.act {
            Act::Add(id) => tasks.entry(id).or_default().0 = Some(event),
            Act::Get(Some(id)) => tasks.entry(id).or_default().1 = Some(event),
            Act::Get(None) => {}
        }
    }
    for (id, (add, get)) in &tasks {
        let (Some(add), get) = (add, get) else {
            return Err(format!("task {id} was never added"));
        };
        if get.is_some_and(|get| get.to < add.from) {
            return Err(format!("task {id} was got before it was added"));
        }
        let gone = get.map_or(usize::MAX, |get| get.from);
        for (other, (later, got)) in &tasks {
            if let (Some(later), Some(got)) = (later, got)
                && add.to < later.from
                && got.to < gone
            {
                return Err(format!("reordered: {other} overtook {id}"));
            }
        }
        for empty in events.iter().filter(|e| e.act == Act::Get(None)) {
            if add.to < empty.from && empty.to < gone {
                return Err(format!("EMPTY while {id} was there"));
            }
        }
    }
    Ok(())
}

/// The search: which operations have had their moment, and what the queue holds then.
struct Search<'e> {
    events: &'e [Event],
    refused: HashSet<(u32, VecDeque<usize>)>,
}

impl Search<'_> {
    fn goes_on(&mut self, done: u32, held: &VecDeque<usize>) -> bool {
        if done.count_ones() as usize == self.events.len() {
            return true;
        }
        if self.refused.contains(&(done, held.clone())) {
            return false;
        }
        let open = |at: &usize| done & 1 << at == 0;
        let ends = (0..self.events.len())
            .filter(open)
            .map(|at| self.events[at].to);
        let first_end = ends.min().expect("one is open");
        for at in (0..self.events.len()).filter(open) {
            let event = self.events[at];
            // What began after another had ended comes after it.
            if event.from > first_end {
                continue;
            }
            let mut next = held.clone();
            let fits = match event.act {
                Act::Add(id) => {
                    next.push_back(id);
                    true
                }
                Act::Get(got) => next.pop_front() == got,
            };
            if fits && self.goes_on(done | 1 << at, &next) {
                return true;
            }
        }
        self.refused.insert((done, held.clone()));
        false
    }
}

/// Whether a queue that was empty can have answered so; exact.
pub fn linear(events: &[Event]) -> Result<(), String> {
    assert!(
        events.len() <= TRIED_MAX,
        "{} operations are too many",
        events.len()
    );
    let refused = HashSet::new();
    let mut search = Search { events, refused };
    if search.goes_on(0, &VecDeque::new()) {
        return Ok(());
    }
    let lines = events.iter().map(|e| format!("\n  {e:?}"));
    Err(format!("no queue answers so:{}", lines.collect::<String>()))
}
