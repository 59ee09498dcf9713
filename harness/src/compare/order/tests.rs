use triptych_spec::abuffer::{EOL, Node, Sorted};
use triptych_spec::raster::Fragment;

use super::{compare, flatten, words};
use crate::cause::Cause;
use crate::compare::Judgement;
use crate::compare::lists::tests::lists;

/// Keys of rows 0 to 3; rows 1 and 2 tie.
const KEYS: [u32; 4] = [5, 7, 7, 9];

fn node(prim: usize, next: u32) -> Node {
    Node {
        key: KEYS[prim],
        next,
        prim: u32::try_from(prim).expect("one of four"),
        mask: 1,
    }
}

fn fragment(pixel: u32, prim: u32) -> Fragment {
    Fragment {
        pixel,
        prim,
        key: KEYS[prim as usize],
        mask: 1,
    }
}

/// Pixel 0 is empty, pixel 1 holds rows 0, 1, 2, pixel 2 row 3.
fn spec() -> Sorted {
    Sorted {
        offsets: vec![0, 0, 3, 4],
        fragments: vec![
            fragment(1, 0),
            fragment(1, 1),
            fragment(1, 2),
            fragment(2, 3),
        ],
    }
}

fn sound() -> Vec<Node> {
    vec![node(0, 1), node(1, 2), node(2, EOL), node(3, EOL)]
}

fn judge(heads: [u32; 3], change: impl FnOnce(&mut Vec<Node>)) -> Judgement {
    let mut nodes = sound();
    change(&mut nodes);
    compare(&spec(), &lists(&heads, nodes), 3)
}

fn causes(judgement: &Judgement) -> Vec<(Cause, u64)> {
    judgement.causes.iter().map(|(c, n)| (*c, *n)).collect()
}

#[test]
fn lists_are_followed_in_order_of_pixels() {
    let sorted = flatten(&lists(&[EOL, 0, 3], sound()));
    assert_eq!(sorted, Some(spec()));
    let astray = vec![node(0, 4)];
    assert_eq!(flatten(&lists(&[0], astray)), None, "a link outside");
    let endless = vec![node(0, 1), node(1, 0)];
    assert_eq!(flatten(&lists(&[0], endless)), None, "a list without end");
}

#[test]
fn sorted_lists_agree() {
    let judgement = judge([EOL, 0, 3], |_| {});
    assert_eq!((judgement.compared, judgement.differ()), (4, 0));
    assert_eq!(judgement.unit, "fragments");
}

#[test]
fn what_is_not_in_order_has_its_cause() {
    let tie = judge([EOL, 0, 3], |nodes| {
        (nodes[0].next, nodes[1].next, nodes[2].next) = (2, EOL, 1);
    });
    assert_eq!(causes(&tie), [(Cause::TieOrder, 1)]);
    assert_eq!(
        (tie.compared, &tie.marks[..]),
        (4, &[(1, Cause::TieOrder)][..])
    );
    let text = "tie-order: pixel (1, 0) is [5:0 7:2 7:1], must be [5:0 7:1 7:2]";
    assert_eq!(tie.described, [text]);
    let unsorted = judge([EOL, 1, 3], |nodes| {
        (nodes[0].next, nodes[1].next, nodes[2].next) = (EOL, 2, 0);
    });
    assert_eq!(causes(&unsorted), [(Cause::SortOrder, 1)]);
}

#[test]
fn lists_that_are_not_what_they_were_have_the_cause_of_the_certificate() {
    let lost = judge([EOL, 0, EOL], |_| {});
    assert_eq!(causes(&lost), [(Cause::LostNode, 1)]);
    let text = "lost-node: 4 nodes were in lists before sorting, 3 are after it";
    assert_eq!((lost.described[0].as_str(), lost.compared), (text, 0));
    let outside = judge([EOL, 0, 3], |nodes| nodes[2].next = 8);
    assert_eq!(causes(&outside), [(Cause::CorruptLink, 1)]);
    let unwritten = judge([EOL, 0, 3], |nodes| nodes[2].next = 4);
    assert_eq!(causes(&unwritten), [(Cause::StalePass, 1)]);
    let circle = judge([EOL, 0, 3], |nodes| nodes[2].next = 0);
    assert_eq!(causes(&circle), [(Cause::Cycle, 1)]);
    let text = "cycle: pixel (1, 0): after sorting a link leads to address 0";
    assert_eq!(circle.described, [text]);
    let elsewhere = judge([3, 0, EOL], |_| {});
    assert_eq!(causes(&elsewhere), [(Cause::CorruptLink, 1)]);
}

#[test]
fn empty_lists_are_what_is_compared_without_fragments() {
    let empty = Sorted {
        offsets: vec![0; 4],
        fragments: Vec::new(),
    };
    let judgement = compare(&empty, &lists(&[EOL; 3], Vec::new()), 3);
    assert_eq!((judgement.compared, judgement.unit), (3, "empty lists"));
    assert_eq!(judgement.differ(), 0);
}

#[test]
fn long_lists_are_shortened() {
    let list: Vec<Fragment> = (0..4).map(|prim| fragment(0, prim)).collect();
    assert_eq!(words(&list), "[5:0 7:1 7:2 9:3]");
    let six = [&list[..], &list[..2]].concat();
    assert_eq!(words(&six), "[5:0 7:1 7:2 9:3 5:0 7:1]");
    let seven = [&list[..], &list[..3]].concat();
    assert_eq!(words(&seven), "[5:0 7:1 7:2 9:3 5:0 7:1 … 7 in all]");
}
