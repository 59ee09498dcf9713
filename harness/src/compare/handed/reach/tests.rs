//! The reach's terms by hand, in powers of two.

use triptych_spec::bound::U;

use super::{Errors, Reach, part};
use crate::compare::handed::HALF;
use crate::compare::region::REACH_MAX;

const NONE: Errors = Errors { x: 0.0, w: 0.0 };

/// Half a target of 48 by 32 pixels, normalised.
const TARGET: [f64; 2] = [24.0 / HALF, 16.0 / HALF];

/// Of triangles in view, which are not cut: `x`, `y` and one over `w` of their corners.
fn reach(deep: [[f64; 3]; 3]) -> Reach {
    Reach {
        corners: deep.map(|[x, y, inverse]| [x / inverse, y / inverse, 0.0, 1.0 / inverse]),
        deep: deep.into(),
        target: TARGET,
        middle: 0.0,
    }
}

fn assert_close(seen: f64, must: f64) {
    assert!((seen - must).abs() <= 1e-12 * must, "{seen}, not {must}");
}

#[test]
fn a_corner_moves_by_division_and_by_what_clipping_does_to_it() {
    let mut reach = reach([[0.0; 3]; 3]);
    reach.middle = 100.0;
    let division = U * (5.5 * 2048.0 * 2.0 + 100.0);
    assert_eq!(reach.alone([2.0, 0.5], NONE), division);
    let errors = Errors {
        x: 1.0 / 1024.0,
        w: 1.0 / 4096.0,
    };
    assert_eq!(reach.alone([2.0, 0.5], errors), division + 1.5);
}

#[test]
fn an_extent_is_the_difference_and_the_larger_end() {
    let mut reach = reach([[0.0; 3]; 3]);
    reach.corners = [
        [1.0, 5.0, 0.0, 7.0],
        [-3.0, 6.0, 0.0, 7.0],
        [2.0, 4.0, 0.0, 7.0],
    ];
    let extents = [0, 1, 2, 3].map(|k| reach.extent(k));
    assert_eq!(extents, [5.0 + 3.0, 2.0 + 6.0, 0.0, 7.0]);
}

#[test]
fn a_plane_cuts_what_is_beyond_it_and_not_what_is_in_it() {
    let mut reach = reach([[0.0; 3]; 3]);
    let inside = [0.0, 0.0, 1.0, 2.0];
    let planes = [
        ([0.0, 0.0, 0.0, 2.0], [0.0, 0.0, -0.1, 2.0]),
        ([0.0, 0.0, 2.0, 2.0], [0.0, 0.0, 2.1, 2.0]),
        ([-2.0, 0.0, 1.0, 2.0], [-2.1, 0.0, 1.0, 2.0]),
        ([2.0, 0.0, 1.0, 2.0], [2.1, 0.0, 1.0, 2.0]),
        ([0.0, -2.0, 1.0, 2.0], [0.0, -2.1, 1.0, 2.0]),
        ([0.0, 2.0, 1.0, 2.0], [0.0, 2.1, 1.0, 2.0]),
    ];
    for (within, beyond) in planes {
        reach.corners = [within, inside, inside];
        assert_eq!(reach.cuts(), 0.0, "{within:?}");
        reach.corners = [within, inside, beyond];
        assert_eq!(reach.cuts(), 1.0, "{beyond:?}");
    }
    reach.corners = [
        [2.1, -2.1, 1.0, 2.0],
        [2.1, 0.0, 1.0, 2.0],
        [0.0, 0.0, -0.1, 2.0],
    ];
    assert_eq!(reach.cuts(), 3.0, "each plane once");
}

#[test]
fn a_part_is_where_a_segment_is_in_the_rectangle() {
    let of = |a: [f64; 2], b: [f64; 2]| part([a[0], a[1], 9.0], [b[0], b[1], 1.0], [1.0, 2.0]);
    assert_eq!(of([-0.5, 1.5], [0.5, -1.5]), Some([0.0, 1.0]), "inside");
    assert_eq!(of([-3.0, 0.5], [5.0, 0.5]), Some([0.25, 0.5]), "through x");
    assert_eq!(of([0.5, 6.0], [0.5, -2.0]), Some([0.5, 1.0]), "through y");
    assert_eq!(of([-2.0, 0.0], [2.0, 12.0]), None, "past a corner");
    assert_eq!(of([-3.0, 0.0], [1.0, 4.0]), Some([0.5, 0.5]), "a corner");
    assert_eq!(of([2.0, 0.0], [4.0, 0.0]), None, "beyond an end");
    for (x, met) in [(1.0, true), (-1.0, true), (1.5, false), (-1.5, false)] {
        let along = of([x, -1.0], [x, 1.0]);
        assert_eq!(along, met.then_some([0.0, 1.0]), "along the side, at {x}");
    }
}

/// What an end far outside does counts by its share, if the end is worse in both.
#[test]
fn a_part_moves_by_its_ends_shares() {
    let reach = reach([[0.0; 3]; 3]);
    // Clipping moves a corner by N over w.
    let errors = Errors {
        x: 0.0,
        w: 1.0 / 2048.0,
    };
    let division = U * 5.5 * 2048.0;
    // In the part N is 2 and 1 / w is 2.5 at most, at the end 4 and 4.
    let ends = [[0.0, 0.0, 1.0], [4.0, 1.0, 4.0]];
    let moves = reach.moves(ends, [0.25, 0.5], errors);
    assert_eq!(
        moves,
        (2.0 * division + 5.0) + 0.5 * (4.0 * division + 16.0)
    );
    let turned = [[-1.0, -4.0, 4.0], [0.0, 0.0, 1.0]];
    assert_eq!(reach.moves(turned, [0.5, 0.75], errors), moves);
    // In the part 3 and 2.5; at one end 0 and 4, at the other 4 and 1.
    let crossed = [[0.0, 0.0, 4.0], [0.0, 4.0, 1.0]];
    let moves = reach.moves(crossed, [0.5, 0.75], errors);
    assert_eq!(moves, (3.0 * division + 12.0) + (4.0 * division + 10.0));
}

#[test]
fn what_is_not_cut_moves_by_its_division() {
    let division = U * 5.5 * HALF * 1.001;
    // The target fills the viewport.
    let reach = |deep| Reach {
        target: [1.0; 2],
        ..reach(deep)
    };
    let small = reach([[0.1, 0.0, 1.0], [-0.1, 0.1, 0.5], [-0.1, -0.1, 0.25]]);
    assert_close(small.before_snapping(), division);
    let large = reach([[0.75, 0.0, 1.0], [-0.5, 0.5, 1.0], [-0.5, -0.5, 1.0]]);
    assert_close(large.before_snapping(), division * 2.0 * 0.75);
}

/// A triangle with a side along x = `pixel`, beside the target, and 1 / w; clipping moves
/// its x by 2^-13.
fn beside(pixel: f64, inverse: f64) -> Reach {
    let x = pixel / HALF;
    let mut reach = reach([[x, -1.0, inverse], [x, 1.0, inverse], [1.0, 0.0, inverse]]);
    // Two planes cut; the extent is 2^6, and 2 * 8 U 2^6 is 2^-13.
    let corner = [64.0, 0.0, 0.0, 0.0];
    reach.corners = [[64.0, 0.0, -1.0, 0.0], corner, corner];
    reach
}

#[test]
fn a_side_counts_up_to_the_largest_reach_beside_the_target() {
    let division = U * 5.5 * HALF;
    // The division of what is near the target, and 2^-13 H 2^5 of both ends.
    let both = 2.0 * (division * 55.0 / HALF + 8.0);
    for (pixel, moves) in [(55.0, both), (57.0, division)] {
        for reach in [beside(pixel, 32.0), beside(-pixel, 32.0)] {
            assert_close(reach.before_snapping(), moves * 1.001);
        }
    }
}

#[test]
fn a_side_in_the_viewport_moves_no_more_than_the_largest_reach() {
    let division = U * 5.5 * HALF;
    // Half of what it may, at each end: 2^-13 H is a quarter.
    let inverse = 4.0 * (REACH_MAX / 2.0 - division);
    let at_most = beside(57.0, inverse).before_snapping();
    assert_close(at_most, division * 1.001);
    let more = beside(57.0, inverse * (1.0 + 1e-12));
    assert_eq!(more.before_snapping(), f64::INFINITY, "it may get there");
    let mut beyond = beside(HALF * 1.5, 2.0 * inverse);
    beyond.deep[2][0] = 2.0;
    assert_close(beyond.before_snapping(), division * 1.001);
}

/// Where w is off by a sixteenth and x as much, that is all that is allowed.
#[test]
fn what_is_far_moves_by_an_eighth_at_most() {
    let mut reach = beside(57.0, 64.0);
    let corner = [1024.0, 0.0, 0.0, 1024.0];
    // 8 U 2^10 is 2^-10, and 2^-10 over 2^-6 a sixteenth.
    reach.corners = [[1024.0, 0.0, -1.0, 1024.0], corner, corner];
    reach.deep = vec![[1.5, -1.0, 64.0], [1.5, 1.0, 64.0], [2.0, 0.0, 64.0]];
    let second = 16.0 / 15.0 + 1e-3;
    assert_close(reach.before_snapping(), U * 5.5 * HALF * second);
    reach.deep[1][2] = 64.5;
    assert_eq!(reach.before_snapping(), f64::INFINITY);
}
