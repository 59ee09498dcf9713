//! Both sets by brute force: each corner at each corner of its square.

use super::{area, certain, cross, edges, reached};

type Corners = [[i64; 2]; 3];

/// Half side of the squares.
const R: i64 = 2;

fn corners_of(p: [i64; 2]) -> [[i64; 2]; 4] {
    [[-R, -R], [-R, R], [R, -R], [R, R]].map(|d| [p[0] + d[0], p[1] + d[1]])
}

/// Whether a closed triangle, either way around, holds the origin.
fn holds(corners: Corners) -> bool {
    let values = edges(corners).map(|(a, b)| cross(a, b));
    let side = |s: i64| values.iter().all(|v| v * s >= 0);
    let near = |axis: usize| {
        let c = corners.map(|c| c[axis]);
        c.iter().any(|c| *c <= 0) && c.iter().any(|c| *c >= 0)
    };
    (side(1) || side(-1)) && near(0) && near(1)
}

/// Whether some choice covers the origin: a convex combination of points of the
/// squares is one of three of their corners (Caratheodory).
fn some(corners: Corners) -> bool {
    let points: Vec<[i64; 2]> = corners.into_iter().flat_map(corners_of).collect();
    let n = points.len();
    let triples = (0..n).flat_map(|i| (i..n).flat_map(move |j| (j..n).map(move |k| [i, j, k])));
    triples.into_iter().any(|t| holds(t.map(|i| points[i])))
}

/// Whether every choice has the origin in its interior.
fn every(corners: Corners) -> bool {
    let [a, b, c] = corners.map(corners_of);
    let inside = |t: Corners| edges(t).into_iter().all(|(a, b)| cross(a, b) > 0);
    a.iter()
        .all(|a| b.iter().all(|b| c.iter().all(|c| inside([*a, *b, *c]))))
}

#[test]
fn both_sets_are_exact() {
    let mut seed = 1_u64;
    let mut random = |reach: i64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (seed >> 33).cast_signed() % (2 * reach + 1) - reach
    };
    let (mut reaching, mut surely, mut flat) = (0, 0, 0);
    for i in 0..4000 {
        let reach = [3, 8, 40][i % 3];
        let mut corners: Corners = [0; 3].map(|_| [random(reach), random(reach)]);
        if i % 7 == 0 {
            // Without area: on a line, and now and then in a point.
            let t = random(2);
            corners[2] = [0, 1].map(|k| corners[0][k] + t * (corners[1][k] - corners[0][k]));
        }
        if area(corners) < 0 {
            corners.swap(1, 2);
        }
        assert_eq!(reached(corners, R), some(corners), "reached {corners:?}");
        assert_eq!(certain(corners, R), every(corners), "certain {corners:?}");
        reaching += u32::from(reached(corners, R));
        surely += u32::from(certain(corners, R));
        flat += u32::from(area(corners) == 0);
    }
    let counts = [reaching, surely, flat];
    assert!(
        counts.iter().all(|n| (100..3900).contains(n)),
        "one-sided: {counts:?}"
    );
}
