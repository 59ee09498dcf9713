//! The checker of histories, on histories.

#[path = "support/events.rs"]
#[expect(dead_code, reason = "the models use the rest")]
mod events;
#[path = "support/linear.rs"]
mod linear;

use events::{Act, Event};
use linear::{complete, linear, ordered, plausible};

/// A history in a line: each thread's operations with their times, as `0:a1@1-2`, where `g1`
/// got task 1 and `g-` found nothing.
fn history(text: &str) -> Vec<Event> {
    text.split_whitespace()
        .map(|word| {
            let (thread, rest) = word.split_once(':').expect("a thread");
            let (act, times) = rest.split_once('@').expect("times");
            let (from, to) = times.split_once('-').expect("two of them");
            let number = |text: &str| text.parse().expect("a number");
            let act = match act.split_at(1) {
                ("a", id) => Act::Add(number(id)),
                ("g", "-") => Act::Get(None),
                ("g", id) => Act::Get(Some(number(id))),
                _ => panic!("{act} is neither"),
            };
            let (thread, from, to) = (number(thread), number(from), number(to));
            Event {
                thread,
                act,
                from,
                to,
            }
        })
        .collect()
}

#[track_caller]
fn right(text: &str) {
    let events = history(text);
    assert_eq!(linear(&events), Ok(()), "{text}");
    assert_eq!(plausible(&events), Ok(()), "{text}");
    assert_eq!(ordered(&events, |id| id / 10), Ok(()), "{text}");
}

#[test]
fn what_a_queue_can_answer() {
    right("");
    right("0:g-@1-2 0:a1@3-4 0:g1@5-6 0:g-@7-8");
    right("0:a1@1-2 0:a2@3-4 1:g1@5-6 1:g2@7-8");
    // Added at once: in either order.
    right("0:a1@1-4 1:a2@2-3 2:g1@5-6 2:g2@7-8");
    right("0:a1@1-4 1:a2@2-3 2:g2@5-6 2:g1@7-8");
    // Got at once.
    right("0:a1@1-2 0:a2@3-4 1:g2@5-8 2:g1@6-7");
    // Empty before what is being added, or after what is being got.
    right("0:a1@1-6 1:g-@2-3 1:g1@4-5");
    right("0:a1@1-2 1:g1@3-6 2:g-@4-5");
    right("0:a1@1-2 1:g-@3-6 2:g1@4-5 ");
    // Not got at all.
    right("0:a1@1-2 0:a2@3-4 1:g1@5-6");
}

#[test]
fn what_it_cannot() {
    let wrong = [
        ("twice", "0:a1@1-2 1:g1@3-4 2:g1@5-6"),
        ("lost", "0:a1@1-2 1:g-@3-4"),
        ("from nowhere", "0:g1@1-2"),
        ("before it was added", "0:g1@1-2 0:a1@3-4"),
        ("reordered", "0:a1@1-2 0:a2@3-4 1:g2@5-6 1:g1@7-8"),
        (
            "reordered over threads",
            "0:a1@1-2 1:a2@3-4 2:g2@5-6 3:g1@7-8",
        ),
        ("overtaken by one that stays", "0:a1@1-2 0:a2@3-4 1:g2@5-6"),
        ("empty while one is there", "0:a1@1-2 1:g-@3-4 2:g1@5-6"),
        // Each pair is possible, all together are not: some task is there at every moment.
        (
            "empty while some is there",
            "0:a1@1-2 0:a2@4-5 1:g-@3-8 2:g1@6-7 2:g2@9-10",
        ),
        (
            "either order, but not both",
            "0:a1@1-4 1:a2@2-3 2:g1@5-8 3:g2@6-7 2:a1@9-10 2:g-@11-12",
        ),
    ];
    for (what, text) in wrong {
        assert!(linear(&history(text)).is_err(), "{what}: {text}");
    }
}

/// What is told from pairs is right too, though it does not tell everything.
#[test]
fn what_pairs_tell() {
    let wrong = [
        ("never added", "0:g1@1-2"),
        ("before it was added", "0:g1@1-2 0:a1@3-4"),
        ("overtook", "0:a1@1-2 0:a2@3-4 1:g2@5-6 1:g1@7-8"),
        ("overtook", "0:a1@1-2 0:a2@3-4 1:g2@5-6"),
        ("EMPTY", "0:a1@1-2 1:g-@3-4 2:g1@5-6"),
    ];
    for (what, text) in wrong {
        let said = plausible(&history(text)).expect_err(text);
        assert!(said.contains(what), "{text}: {said}");
    }
}

#[test]
fn what_comes_out() {
    let said = |text| complete(&history(text)).map_err(|e| e.chars().take(5).collect());
    assert_eq!(said("0:a1@0-0 1:g1@0-0 1:g-@0-0"), Ok(()), "all");
    assert_eq!(said("0:a1@0-0 1:g-@0-0"), Err("lost:".to_owned()), "lost");
    assert_eq!(
        said("0:a1@0-0 1:g1@0-0 2:g1@0-0"),
        Err("twice".to_owned()),
        "twice"
    );
    let order = |text| ordered(&history(text), |id| id / 10);
    assert!(
        order("0:a1@0-0 0:a2@0-0 1:g1@0-0 2:g2@0-0").is_ok(),
        "in order"
    );
    assert!(
        order("0:a1@0-0 0:a2@0-0 1:g2@0-0 1:g1@0-0").is_err(),
        "not in order"
    );
    assert!(
        order("0:a1@0-0 1:a11@0-0 2:g11@0-0 2:g1@0-0").is_ok(),
        "of two"
    );
}
