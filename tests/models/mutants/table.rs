//! Defects, and the model that must see each.
//!
//! Not here, as they change nothing that could be seen: leaving the second step of `add`
//! (moving `tail`) to those who help; taking `head == tail` for empty without looking at
//! `next` (whoever added it has not ended, so its task is not there yet); and not reading
//! `head` or `tail` again, which only nodes that come back, or hazard pointers, need.

use super::kind::Kind;

/// A defect.
pub struct Mutant {
    /// What is wrong.
    pub name: &'static str,
    /// Of the queues' sources, or a model's.
    pub file: &'static str,
    /// Texts that occur once, and what stands there instead.
    pub edits: &'static [(&'static str, &'static str)],
    /// What shows it.
    pub model: Model,
    /// A part of what loom says, and with which bound; zero: none.
    pub loom: Option<(usize, &'static str)>,
    /// A part of what shuttle says.
    pub shuttle: Option<&'static str>,
}

/// Queue, tasks dealt, what threads do, whether with a clock.
pub type Model = (Kind, usize, &'static [&'static str], bool);

const RACE: &str = "Causality violation";
const FREED: &str = "used after it was freed";
const SPINS: &str = "maximum number of branches";
const TAKEN: &str = "a value is taken once";

const TWO_ADD: &[&str] = &["a", "a"];
const TWO_GET: &[&str] = &["g", "g"];
const ONE_EACH: &[&str] = &["a", "g"];

const HEAD: &str = "if swap(&self.head.0, first, next) {";
const TAKE: &str = "let value = unsafe { self.reclaim.node(&guard, next).take() };";
const RETIRE: &str = "unsafe { self.reclaim.retire(&guard, first) };";

const TAKE_FIRST: &str = "let value = unsafe { self.reclaim.node(&guard, next).take() }; \
    if swap(&self.head.0, first, next) {";
const RETIRE_FIRST: &str = "unsafe { self.reclaim.retire(&guard, first) }; \
    if swap(&self.head.0, first, next) {";

pub const MUTANTS: &[Mutant] = &[
    Mutant {
        name: "lock: next written relaxed",
        file: "lock.rs",
        edits: &[(
            "next.store(node, Ordering::Release)",
            "next.store(node, Ordering::Relaxed)",
        )],
        model: (Kind::Lock, 0, ONE_EACH, false),
        loom: Some((0, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "lock: next read relaxed",
        file: "lock.rs",
        edits: &[(
            "next.load(Ordering::Acquire)",
            "next.load(Ordering::Relaxed)",
        )],
        model: (Kind::Lock, 0, ONE_EACH, false),
        loom: Some((0, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "lock: let go while adding",
        file: "lock.rs",
        edits: &[(
            "let last = *tail;",
            "let last = *tail; drop(tail); let mut tail = self.tail.0.lock().expect(SOUND);",
        )],
        model: (Kind::Lock, 0, TWO_ADD, false),
        loom: Some((0, "lost: task")),
        shuttle: Some("lost: task"),
    },
    Mutant {
        name: "lock: let go while getting",
        file: "lock.rs",
        edits: &[(
            "*head = next;",
            "drop(head); let mut head = self.head.0.lock().expect(SOUND); *head = next;",
        )],
        model: (Kind::Lock, 2, TWO_GET, false),
        loom: Some((0, TAKEN)),
        shuttle: Some(TAKEN),
    },
    Mutant {
        name: "lock: value read after letting go, as in listing 4",
        file: "lock.rs",
        edits: &[
            ("        drop(head);\n", ""),
            (
                "let value = unsafe { (*next)",
                "drop(head); let value = unsafe { (*next)",
            ),
        ],
        model: (Kind::Lock, 2, TWO_GET, false),
        loom: Some((0, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "lock: the sentinel's value, as in listing 4",
        file: "lock.rs",
        edits: &[("(*next).take()", "(*first).take()")],
        model: (Kind::Lock, 0, ONE_EACH, false),
        loom: Some((0, TAKEN)),
        shuttle: Some(TAKEN),
    },
    Mutant {
        name: "lfree: adding does not help",
        file: "lfree.rs",
        edits: &[(
            "swap(&self.tail.0, last, next);\n            } else",
            "} else",
        )],
        model: (Kind::Held, 0, TWO_ADD, false),
        loom: Some((0, SPINS)),
        shuttle: None,
    },
    Mutant {
        name: "lfree: getting does not help",
        file: "lfree.rs",
        edits: &[(
            "swap(&self.tail.0, last, next);\n                continue;",
            "continue;",
        )],
        model: (Kind::Held, 0, ONE_EACH, false),
        loom: Some((0, SPINS)),
        shuttle: None,
    },
    Mutant {
        name: "lfree: adding never moves tail",
        file: "lfree.rs",
        edits: &[
            (
                "swap(&self.tail.0, last, next);\n            } else",
                "} else",
            ),
            ("swap(&self.tail.0, last, node);", ""),
        ],
        model: (Kind::Held, 0, &["aa", "g"], false),
        loom: Some((0, SPINS)),
        shuttle: Some("exceeded max_steps"),
    },
    Mutant {
        name: "lfree: head overtakes tail",
        file: "lfree.rs",
        edits: &[("if first == last {", "if next.is_null() {")],
        model: (Kind::Tracked, 0, &["a", "ga"], false),
        loom: Some((0, FREED)),
        shuttle: Some(FREED),
    },
    Mutant {
        name: "lfree: next swapped relaxed",
        file: "lfree.rs",
        edits: &[(
            "swap(&end.next, next, node)",
            "end.next.compare_exchange(next, node, Ordering::Relaxed, Ordering::Relaxed).is_ok()",
        )],
        model: (Kind::Held, 0, ONE_EACH, false),
        loom: Some((0, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "lfree: head swapped relaxed, and overtakes a tail that was read too early",
        file: "lfree.rs",
        edits: &[(
            HEAD,
            "if self.head.0.compare_exchange(first, next, Ordering::Relaxed, Ordering::Relaxed).is_ok() {",
        )],
        model: (Kind::Held, 0, &["ag", "g"], false),
        loom: Some((0, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "lfree: a lost race is taken for an empty queue",
        file: "lfree.rs",
        edits: &[(
            "return Some(value);\n            }",
            "return Some(value);\n            }\n            return None;",
        )],
        model: (Kind::Held, 2, TWO_GET, true),
        loom: Some((0, "no queue answers so")),
        shuttle: Some("no queue answers so"),
    },
    Mutant {
        name: "lfree: whoever swaps head, all take the value",
        file: "lfree.rs",
        edits: &[(HEAD, "{ swap(&self.head.0, first, next);")],
        model: (Kind::Held, 2, TWO_GET, false),
        loom: Some((0, RACE)),
        shuttle: Some(TAKEN),
    },
    Mutant {
        name: "lfree: value taken before head is swapped, as in listing 5",
        file: "lfree.rs",
        edits: &[(TAKE, ""), (HEAD, TAKE_FIRST)],
        model: (Kind::Held, 2, TWO_GET, false),
        loom: Some((0, RACE)),
        shuttle: Some(TAKEN),
    },
    Mutant {
        name: "lfree: retired before head is swapped",
        file: "lfree.rs",
        edits: &[(RETIRE, ""), (HEAD, RETIRE_FIRST)],
        model: (Kind::Tracked, 2, TWO_GET, false),
        loom: Some((0, "freed")),
        shuttle: Some("freed"),
    },
    Mutant {
        name: "epochs: freed at once, as in listing 5",
        file: "reclaim.rs",
        edits: &[(
            "guard.defer_unchecked(move || free(node))",
            "let _ = guard; free(node)",
        )],
        model: (Kind::Epochs, 2, TWO_GET, false),
        loom: Some((0, FREED)),
        shuttle: Some(FREED),
    },
    Mutant {
        name: "epochs: pointers read relaxed",
        file: "reclaim.rs",
        edits: &[(
            "place.load(Ordering::Acquire)",
            "place.load(Ordering::Relaxed)",
        )],
        model: (Kind::Epochs, 0, ONE_EACH, false),
        loom: Some((0, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "node: a value read stays",
        file: "node.rs",
        edits: &[("(*value).take()", "std::ptr::read(value)")],
        model: (Kind::Held, 1, ONE_EACH, false),
        loom: Some((0, "was dropped 2 times")),
        shuttle: Some("was dropped 2 times"),
    },
    Mutant {
        name: "local: what was not done is forgotten",
        file: "local.rs",
        edits: &[("*slot = mem::take(&mut self.tasks);", "")],
        model: (Kind::Local, 0, &["a", "a"], true),
        loom: Some((0, "lost: task")),
        shuttle: Some("lost: task"),
    },
    Mutant {
        name: "frame: done before its children are counted",
        file: "part.rs",
        edits: &[(
            "work(self, task);",
            "if let Some(outstanding) = self.outstanding { outstanding.done(1); } work(self, task); continue;",
        )],
        model: (Kind::Frame, 0, &["", ""], false),
        loom: Some((2, RACE)),
        shuttle: Some("a task was done 0 times when all was over"),
    },
    Mutant {
        name: "frame: children counted after they can be got",
        file: "part.rs",
        edits: &[
            ("outstanding.add(1);", "let _ = outstanding;"),
            (
                "self.worker.add(task);",
                "self.worker.add(task); if let Some(outstanding) = self.outstanding { outstanding.add(1); }",
            ),
        ],
        model: (Kind::Frame, 0, &["", ""], false),
        loom: Some((2, "when all was over")),
        shuttle: Some("when all was over"),
    },
    Mutant {
        name: "outstanding: done relaxed",
        file: "outstanding.rs",
        edits: &[("Ordering::Release", "Ordering::Relaxed")],
        model: (Kind::Frame, 0, &["", ""], false),
        loom: Some((2, RACE)),
        shuttle: None,
    },
    Mutant {
        name: "outstanding: over read relaxed",
        file: "outstanding.rs",
        edits: &[("Ordering::Acquire", "Ordering::Relaxed")],
        model: (Kind::Frame, 0, &["", ""], false),
        loom: Some((2, RACE)),
        shuttle: None,
    },
];
