//! Listing 5 as it is printed: `delete first` as soon as `head` has moved on.
//!
//! The same models pass if nodes are freed later, whichever way.

#![expect(clippy::duplicate_mod, reason = "one text, under several checkers")]

#[macro_use]
mod support;
#[path = "trees/loom.rs"]
mod all;
#[path = "trees/shuttle.rs"]
mod some;

use support::how::How;
use support::kind::Kind;
use support::script::Script;
use support::verdict::verdict;

/// Two get, and one frees what the other is about to read.
const READ: Script = Script {
    dealt: 2,
    threads: &["g", "g"],
    ..Script::PLAIN
};

/// One is about to move `head` from node A to its successor B. Meanwhile the other takes what B
/// holds, and A is freed; adds two tasks, in A and in a new node C; takes the first of
/// them, so that A is the sentinel again, before C, and B is freed; and adds one, in B. The
/// first one's compare-and-swap finds A and sets `head` to B: C is lost.
const ADDRESS_COMES_BACK: Script = Script {
    dealt: 1,
    threads: &["gaaga", "g"],
    ..Script::PLAIN
};

const LATER: [Kind; 3] = [Kind::Held, Kind::Tracked, Kind::Epochs];

#[test]
fn a_node_is_read_after_it_was_freed() {
    let freed = Kind::Freed { looks: true };
    // To loom, freeing is a write that nothing orders after the other's read.
    for (checker, how, dies) in [
        ("loom", How::All, "Causality violation"),
        ("shuttle", How::Random(10_000), "was read in generation"),
    ] {
        let run = match checker {
            "loom" => all::run::run,
            _ => some::run::run,
        };
        let (schedules, said) = verdict(move |count| run(freed, READ, how, count));
        let said = said.unwrap_or_else(|| panic!("{checker}: not found in {schedules}"));
        println!("{checker}, after {schedules}: {said}");
        assert!(said.contains(dies), "{checker}: {said}");
        for kind in LATER {
            let (schedules, said) = verdict(move |count| run(kind, READ, how, count));
            println!("{checker}, {kind:?}: {schedules} pass");
            assert_eq!(said, None, "{checker}: {kind:?}");
        }
    }
}

/// Memory that stays what it is does not help, nor does a compiler that knows nothing.
#[test]
fn an_address_comes_back() {
    let how = How::Priorities(20_000, 2);
    let (schedules, said) = verdict(move |count| {
        some::run::run(Kind::Freed { looks: false }, ADDRESS_COMES_BACK, how, count);
    });
    let said = said.unwrap_or_else(|| panic!("not found in {schedules}"));
    println!("after {schedules}: {said}");
    assert!(said.contains("lost: task"), "{said}");
    for kind in LATER {
        let (schedules, said) =
            verdict(move |count| some::run::run(kind, ADDRESS_COMES_BACK, how, count));
        println!("{kind:?}: {schedules} pass");
        assert_eq!(said, None, "{kind:?}");
    }
}
