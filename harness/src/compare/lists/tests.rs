use triptych_spec::abuffer::{EOL, Lists, Node, Sorted};
use triptych_spec::raster::Fragment;

use super::{Expected, compare, compare_overflowed};
use crate::cause::Cause;
use crate::compare::Judgement;

/// First pixel of the band: the band's own pixels count from 0.
const FIRST: u32 = 4;

/// Two triangles parallel to the screen: the same keys in every pixel.
const KEYS: [u32; 2] = [5, 7];

fn node(prim: usize, next: u32) -> Node {
    Node {
        key: KEYS[prim],
        next,
        prim: u32::try_from(prim).expect("one of two"),
        mask: 1,
    }
}

/// What a band of two pixels must hold, both covered by both triangles, in one row of six.
/// The first pixel of the row, outside of the band, is covered too.
fn sorted() -> Sorted {
    let fragment = |pixel, prim: u32| Fragment {
        pixel,
        prim,
        key: KEYS[prim as usize],
        mask: 1,
    };
    let pixels = [0, FIRST, FIRST + 1];
    Sorted {
        offsets: vec![0, 2, 2, 2, 2, 4, 6],
        fragments: pixels
            .iter()
            .flat_map(|p| [fragment(*p, 0), fragment(*p, 1)])
            .collect(),
    }
}

fn expected(sorted: &Sorted) -> Expected<'_> {
    Expected {
        sorted,
        first_pixel: FIRST,
        faces: &[[0.0; 4]; 2],
        width: 6,
    }
}

/// Lists of which every node was counted.
pub(in crate::compare) fn lists(heads: &[u32], nodes: Vec<Node>) -> Lists {
    let stored = u32::try_from(nodes.len()).expect("few");
    Lists {
        heads: heads.to_vec(),
        colours: vec![[0.0; 4]; nodes.len()],
        nodes,
        attempts: stored,
        capacity: 8,
    }
}

fn judge(heads: [u32; 2], nodes: Vec<Node>) -> Judgement {
    compare(&expected(&sorted()), &lists(&heads, nodes))
}

#[test]
fn sound_lists_agree() {
    let nodes = vec![node(0, EOL), node(0, EOL), node(1, 0), node(1, 1)];
    let judgement = judge([2, 3], nodes);
    assert_eq!((judgement.differ(), judgement.compared), (0, 4));
}

/// A triangle that does not reach the first pixel, and a node that the second loses:
/// each pixel has its own cause, though the fragments are alike.
#[test]
fn a_lost_node_stands_for_its_own_pixel() {
    let nodes = vec![node(0, EOL), node(0, EOL), node(1, 1)];
    let judgement = judge([0, 1], nodes);
    let marks = [(FIRST, Cause::Coverage), (FIRST + 1, Cause::LostNode)];
    assert_eq!(judgement.marks, marks, "{judgement:#?}");
}

/// The second pixel lacks nothing, but one of its fragments was stored twice, once out
/// of reach: no excuse for what the first pixel lacks.
#[test]
fn a_stray_node_does_not_stand_for_another_pixel() {
    let nodes = vec![node(0, EOL), node(0, EOL), node(1, 1), node(1, 2)];
    let judgement = judge([0, 2], nodes);
    let marks = [(FIRST, Cause::Coverage), (FIRST + 1, Cause::LostNode)];
    assert_eq!(judgement.marks, marks, "{judgement:#?}");
}

/// Links are followed through other nodes that are out of reach.
#[test]
fn a_chain_of_lost_nodes_is_of_the_pixel_where_it_ends() {
    let nodes = vec![node(0, EOL), node(1, 0), node(0, 1), node(1, 2)];
    let judgement = judge([0, EOL], nodes);
    // The chain 3, 2, 1 ends in the first pixel's list, which lacks one of the three.
    let causes = [(Cause::Coverage, 2), (Cause::LostNode, 3)];
    assert_eq!(judgement.causes, causes.into(), "{judgement:#?}");
}

/// Where no link tells, a node may be of any pixel that lacks it, but of one only.
#[test]
fn a_node_of_no_known_pixel_stands_for_one_fragment() {
    let nodes = vec![node(0, EOL), node(0, EOL), node(1, EOL)];
    let judgement = judge([0, 1], nodes);
    let causes = [(Cause::Coverage, 1), (Cause::LostNode, 1)];
    assert_eq!(judgement.causes, causes.into(), "{judgement:#?}");
}

/// Links in a circle, and links out of bounds, lead to no pixel, and to an end.
#[test]
fn circles_out_of_reach_are_of_no_known_pixel() {
    let nodes = vec![node(0, EOL), node(0, 2), node(1, 1), node(1, 77)];
    let judgement = judge([0, EOL], nodes);
    assert_eq!(
        judgement.causes,
        [(Cause::LostNode, 3)].into(),
        "{judgement:#?}"
    );
}

fn sound() -> Vec<Node> {
    vec![node(0, EOL), node(0, EOL), node(1, 0), node(1, 1)]
}

#[test]
fn a_wrong_counter_is_overflow() {
    for attempts in [3, 5] {
        let mut wrong = lists(&[2, 3], sound());
        wrong.attempts = attempts;
        let judgement = compare(&expected(&sorted()), &wrong);
        assert_eq!(
            judgement.causes,
            [(Cause::Overflow, 1)].into(),
            "{attempts}"
        );
        let words = format!("overflow: the counter is {attempts}, must be 4");
        assert_eq!(judgement.described, [words]);
    }
}

/// One address was handed out twice: a list runs into the other, or into itself.
#[test]
fn addresses_that_are_shared_explain_every_fault() {
    let mut shared = lists(&[1, 2], vec![node(0, EOL), node(1, 0), node(1, 1)]);
    shared.attempts = 1;
    let judgement = compare(&expected(&sorted()), &shared);
    assert_eq!(
        judgement.causes,
        [(Cause::Overflow, 3)].into(),
        "{judgement:#?}"
    );
    let words = "overflow: the counter is 1, must be 4: addresses are shared";
    assert_eq!(judgement.described[0], words);
}

#[test]
fn empty_lists_are_what_is_compared_without_fragments() {
    let none = Sorted {
        offsets: vec![0, 2, 2, 2, 2, 2, 2],
        fragments: sorted().fragments[..2].to_vec(),
    };
    let judgement = compare(&expected(&none), &lists(&[EOL; 2], Vec::new()));
    assert_eq!((judgement.compared, judgement.differ()), (2, 0));
    assert_eq!(judgement.unit, "empty lists");
}

/// Lists with room for three of four: what is stored must be of the spec's, and the
/// counter that of the attempt with enough room.
#[test]
fn what_overflowed_is_a_part_and_was_counted() {
    let mut stored = lists(&[2, 1], vec![node(0, EOL), node(0, EOL), node(1, 0)]);
    (stored.attempts, stored.capacity) = (4, 3);
    let judged = |lists: &Lists| compare_overflowed(&expected(&sorted()), lists, 4);
    let sound = judged(&stored);
    assert_eq!(
        (sound.compared, sound.differ()),
        (4, 0),
        "three nodes and a counter"
    );
    assert_eq!(sound.unit, "nodes");
    let miscounted = judged(&Lists {
        attempts: 5,
        ..stored.clone()
    });
    assert_eq!(miscounted.causes, [(Cause::Overflow, 1)].into());
    let mut wrong = stored.clone();
    wrong.nodes[2].key = 6;
    assert_eq!(judged(&wrong).causes, [(Cause::DepthKey, 1)].into());
    let mut shared = stored;
    (shared.attempts, shared.heads[1]) = (3, 0);
    assert_eq!(judged(&shared).causes, [(Cause::Overflow, 1)].into());
}
