//! Regions by brute force: each corner at each corner of its square.

use triptych_spec::scene::Size;

use super::{Columns, Region, hull};

/// Half side of the squares, in pixels: a power of two, so that all here is exact.
const R: f64 = 0.25;

const SIZE: Size = Size {
    width: 12,
    height: 12,
};

/// How often a closed polygon winds around a point; `None` on its border.
fn winding(polygon: &[[f64; 2]], p: [f64; 2]) -> Option<i32> {
    let mut turns = 0;
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let side = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
        let between = |i: usize| (a[i] <= p[i] && p[i] <= b[i]) || (b[i] <= p[i] && p[i] <= a[i]);
        if side == 0.0 && between(0) && between(1) {
            return None;
        }
        match (a[1] <= p[1], b[1] <= p[1]) {
            (true, false) if side > 0.0 => turns += 1,
            (false, true) if side < 0.0 => turns -= 1,
            _ => {}
        }
    }
    Some(turns)
}

/// All polygons with each corner at a corner of its square.
fn moved(corners: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut all = vec![Vec::new()];
    for c in corners {
        let at = [[-R, -R], [-R, R], [R, -R], [R, R]].map(|d| [c[0] + d[0], c[1] + d[1]]);
        let longer = |way: &Vec<[f64; 2]>| {
            let way = way.clone();
            at.map(move |p| [&way[..], &[p]].concat())
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}

struct Random(u64);

impl Random {
    /// A quarter of a pixel's multiple between -4 and 16.
    fn corner(&mut self) -> [f64; 2] {
        [0; 2].map(|_| {
            self.0 = self
                .0
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((self.0 >> 33) % 80) as f64 / 4.0 - 4.0
        })
    }
}

#[test]
fn what_must_be_and_what_must_not_be_covered_is_sound() {
    let mut random = Random(1);
    let (mut must, mut open, mut turned) = (0_u32, 0_u32, 0_u32);
    for i in 0..60 {
        let mut corners: Vec<[f64; 2]> = [0; 3].map(|_| random.corner()).into();
        if i % 3 == 0 {
            // A quadrilateral with a corner on a side, where a clipped one has it.
            let middle = [0, 1].map(|k| f64::midpoint(corners[2][k], corners[0][k]));
            corners.push(middle);
        }
        let region = Region::new(&corners, R).expect("it is small");
        let ways = moved(&corners);
        for y in 0..SIZE.height {
            let columns = region.columns(y, SIZE);
            for x in 0..SIZE.width {
                let p = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                let windings = || ways.iter().map(|way| winding(way, p));
                let (is_must, is_may) = (columns.must.contains(&x), columns.may.contains(&x));
                let at = format!("{corners:?} at {p:?}");
                assert!(is_may || !is_must, "{at}");
                if is_must {
                    assert!(windings().all(|w| w.is_some_and(|w| w != 0)), "{at}");
                }
                if !is_may {
                    assert!(windings().all(|w| w == Some(0)), "{at}");
                    assert!(!region.rows(SIZE).contains(&y) || !is_must, "{at}");
                }
                let covered = windings().filter(|w| w.is_some_and(|w| w != 0)).count();
                must += u32::from(is_must);
                open += u32::from(is_may && !is_must);
                let both = (1..ways.len()).contains(&covered);
                turned += u32::from(both);
            }
        }
    }
    assert!(must > 300 && open > 300, "{must} and {open} samples");
    // The corners' squares are not all of what may move, so that much is enough.
    assert!(turned * 2 > open, "{turned} of {open} turn");
}

#[test]
fn rows_are_those_with_columns() {
    let mut random = Random(2);
    for _ in 0..200 {
        let corners = [0; 3].map(|_| random.corner());
        let region = Region::new(&corners, R).expect("it is small");
        let rows = region.rows(SIZE);
        for y in (0..SIZE.height).filter(|y| !rows.contains(y)) {
            assert!(region.columns(y, SIZE).may.is_empty(), "{corners:?}");
        }
    }
}

#[test]
fn without_area_nothing_must_be_covered() {
    for corners in [
        vec![[3.5, 3.5]],
        vec![[1.0, 3.5], [9.0, 3.5]],
        vec![[1.0, 1.0], [5.0, 5.0], [9.0, 9.0], [1.0, 1.0]],
    ] {
        let region = Region::new(&corners, R).expect("it is small");
        let columns = region.columns(3, SIZE);
        assert!(columns.must.is_empty(), "{columns:?}");
        assert!(columns.is_open(3), "{columns:?}");
        assert!(!columns.may.contains(&11), "{columns:?}");
    }
}

#[test]
fn lengths_are_those_of_the_line_of_samples() {
    let corners = [[2.0, 0.0], [7.0, 0.0], [7.0, 9.0], [2.0, 9.0]];
    let region = Region::new(&corners, 0.5).expect("it is small");
    let [may, must] = region.columns(4, SIZE).lengths;
    assert!(
        (may - 6.0).abs() < 1e-3 && (must - 4.0).abs() < 1e-3,
        "{may} {must}"
    );
}

#[test]
fn what_cannot_be_judged_is_no_region() {
    let far = [[0.0, 0.0], [5000.0, 0.0], [0.0, 1.0]];
    assert_eq!(Region::new(&far, R), None, "beyond the guard");
    let nan = [[0.0, f64::NAN]];
    assert_eq!(Region::new(&nan, R), None, "no number");
    let fine = [[0.0, 0.0], [5.0, 0.0], [0.0, 1.0]];
    assert_eq!(Region::new(&fine, 1e9), None, "a reach without end");
    assert_eq!(Region::new(&[], R), None, "no corner");
}

fn region(corners: &[[f64; 2]]) -> Region {
    Region::new(corners, R).expect("it is small")
}

/// Beside a tip the sides' widened lines meet far out, but no corner can be there.
#[test]
fn no_sample_beyond_the_corners_squares_may_be_covered() {
    let right = region(&[[1.0, 2.0], [9.0, 3.5], [1.0, 5.0]]);
    assert_eq!(right.columns(3, SIZE).may, 1..9, "9.5 is beyond 9.25");
    let left = region(&[[2.0, 3.5], [9.0, 2.0], [9.0, 5.0]]);
    assert_eq!(left.columns(3, SIZE).may, 2..9, "1.5 is before 1.75");
    let low = region(&[[2.0, 4.0], [7.0, 2.0], [7.0, 9.0]]);
    assert_eq!(
        low.rows(SIZE),
        2..9,
        "1.5 is above 1.75, and 9.5 below 9.25"
    );
    for row in [1, 9] {
        assert_eq!(low.columns(row, SIZE), Columns::default(), "row {row}");
    }
}

#[test]
fn open_is_what_may_be_and_need_not_be_covered() {
    let columns = region(&[[2.4, 0.0], [7.0, 0.0], [7.0, 9.0], [2.4, 9.0]]).columns(4, SIZE);
    assert_eq!((columns.may.clone(), columns.must.clone()), (2..7, 3..7));
    let open: Vec<u32> = (0..12).filter(|c| columns.is_open(*c)).collect();
    assert_eq!(open, [2]);
}

/// Exactly as far from a side as its ends may move, a sample lies on it at worst.
#[test]
fn a_sample_at_the_reach_need_not_be_covered() {
    // What a corner's rounding takes is in the reach.
    let reach = R + 2.0 / 65536.0;
    for (farther, must) in [(0.0, 3..7), (1.0 / 65536.0, 2..7)] {
        let x = 2.5 - reach - farther;
        let columns = region(&[[x, 0.0], [7.0, 0.0], [7.0, 9.0], [x, 9.0]]).columns(4, SIZE);
        assert_eq!((columns.may, columns.must), (2..7, must), "{farther}");
    }
}

#[test]
fn nothing_of_a_row_beside_a_level_side_must_be_covered() {
    let region = region(&[[2.0, 1.4], [7.0, 1.4], [7.0, 9.0], [2.0, 9.0]]);
    let columns = region.columns(1, SIZE);
    assert_eq!((columns.may, columns.must.is_empty()), (2..7, true));
    assert_eq!(region.columns(2, SIZE).must, 2..7, "a row farther");
}

#[test]
fn a_hull_has_no_corner_on_a_side() {
    let square = [[0, 0], [4, 0], [4, 4], [0, 4]];
    let more = [[2, 0], [4, 2], [3, 4], [0, 1], [1, 3], [4, 4]];
    assert_eq!(hull([&more[..], &square].concat()), square);
    assert_eq!(hull(vec![[1, 1], [3, 3], [2, 2]]), [[1, 1], [3, 3]]);
}
