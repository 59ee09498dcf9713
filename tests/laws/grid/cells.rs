//! Which cells list which triangles.

use proptest::prelude::*;
use triptych_spec::abuffer::EOL;
use triptych_spec::grid::axis::{Axis, CELLS_MAX, WIDENED, WIDTH_MIN};
use triptych_spec::grid::lattice::{EXTENT, Point};
use triptych_spec::grid::link::link;
use triptych_spec::grid::resolution::{DENSITY, Resolution, TOTAL_MAX, axes};
use triptych_spec::grid::{
    Blockers, Cells, Grid, GridError, Membership, brick_counts, bricks, overlap, scan,
};

use super::{blockers, coordinate, grids, resolution};
use crate::config;

/// Every cell with its number.
fn all_cells(axes: &[Axis; 3]) -> Vec<[u32; 3]> {
    let [x, y, z] = axes.each_ref().map(Axis::cells);
    let rows = (0..z).flat_map(|k| (0..y).map(move |j| [j, k]));
    rows.flat_map(|[j, k]| (0..x).map(move |i| [i, j, k]))
        .collect()
}

/// The widened cell.
fn widened(axes: &[Axis; 3], cell: [u32; 3]) -> [[i32; 3]; 2] {
    let boundary = |axis: usize, i: u32| axes[axis].boundaries()[i as usize];
    [
        [0, 1, 2].map(|axis| boundary(axis, cell[axis]) - WIDENED),
        [0, 1, 2].map(|axis| boundary(axis, cell[axis] + 1) + WIDENED),
    ]
}

fn boxes_touch([low, high]: [Point; 2], corners: [Point; 3]) -> bool {
    (0..3).all(|i| {
        let c = corners.map(|c| c[i]);
        c.iter().any(|c| *c <= high[i]) && c.iter().any(|c| *c >= low[i])
    })
}

proptest! {
    #![proptest_config(config(500))]

    /// A cell lists the triangles whose box touches it, widened, each once and rising.
    #[test]
    fn boxes(blockers in blockers(), resolution in resolution()) {
        let grid = Grid::build(&blockers, resolution, Membership::Box).expect("within the limits");
        for cell in all_cells(&grid.axes) {
            let touched = |prim: &u32| boxes_touch(widened(&grid.axes, cell), blockers.corners(*prim));
            let expected: Vec<u32> = (0..).take(blockers.triangles.len()).filter(touched).collect();
            prop_assert_eq!(grid.list(cell), &expected[..], "{:?}", cell);
        }
    }

    /// With `Overlap` a cell lists those of them whose own points it holds.
    #[test]
    fn overlaps(corners in [[-40..40, -40..40, -40..40_i32], [-40..40, -40..40, -40..40], [-40..40, -40..40, -40..40]]) {
        let corners = corners.map(|c| c.map(|c| c * 3));
        let blockers = Blockers { vertices: corners.to_vec(), triangles: vec![[0, 1, 2]] };
        let grid = Grid::build(&blockers, Resolution::Given([4; 3]), Membership::Box).expect("small");
        for cell in all_cells(&grid.axes) {
            let touches = overlap::touches(&grid.axes, cell, corners);
            let [low, high] = widened(&grid.axes, cell);
            let part = |by: f64| !clipped(corners, low.map(|c| f64::from(c) - by), high.map(|c| f64::from(c) + by)).is_empty();
            // Coordinates are small, so clipping in f64 is off by far less than this.
            prop_assert!(if touches { part(1e-6) } else { !part(-1e-6) }, "{:?}", cell);
        }
    }

    /// The paper's lists hold the same, newest first; without room they lose entries, never
    /// more than that.
    #[test]
    fn linked((blockers, grid) in grids(), share in 0..=4_u32) {
        for membership in [Membership::Box, Membership::Overlap] {
            let cells = Cells { axes: &grid.axes, membership };
            let runs = Grid::build(&blockers, given(&grid.axes), membership).expect("as before");
            let total = u32::try_from(runs.prims.len()).unwrap();
            let capacity = total * share / 4;
            let lists = link(&blockers, &cells, capacity);
            prop_assert_eq!(lists.attempts, total);
            prop_assert_eq!(lists.entries.len(), capacity as usize);
            let mut stored = 0;
            for (at, cell) in all_cells(&grid.axes).into_iter().enumerate() {
                let mut list = Vec::new();
                let mut next = lists.heads[at];
                while next != EOL {
                    let entry = lists.entries[next as usize];
                    list.insert(0, entry.prim);
                    next = entry.next;
                }
                stored += list.len();
                prop_assert_eq!(&list[..], &runs.list(cell)[..list.len()]);
            }
            prop_assert_eq!(stored, capacity as usize);
        }
    }

    /// A bit for every cell that lists something, and for no other.
    #[test]
    fn occupied((_, grid) in grids()) {
        let words = bricks(&grid.axes, &grid.offsets);
        let [x, y, z] = brick_counts(&grid.axes);
        prop_assert_eq!(words.len(), (x * y * z) as usize);
        let set: u32 = words.iter().flatten().map(|word| word.count_ones()).sum();
        let mut full = 0;
        for cell in all_cells(&grid.axes) {
            let [i, j, k] = cell;
            let pair = words[(i / 4 + x * (j / 4 + y * (k / 4))) as usize];
            let mask = u64::from(pair[0]) | u64::from(pair[1]) << 32;
            let bit = mask >> (i % 4 + 4 * (j % 4) + 16 * (k % 4)) & 1;
            prop_assert_eq!(bit == 1, !grid.list(cell).is_empty());
            full += u32::from(bit == 1);
        }
        prop_assert_eq!(set, full);
    }

    /// Boundaries rise by `WIDTH_MIN` at least, cells are about as wide as each other, and
    /// what was to be inside is, widened twice.
    #[test]
    fn axis(a in coordinate(), b in coordinate(), cells in 1..=CELLS_MAX) {
        let (low, high) = (a.min(b), a.max(b));
        let axis = Axis::around(low, high, cells);
        let boundaries = axis.boundaries();
        prop_assert_eq!(boundaries[0], low - 2 * WIDENED);
        prop_assert_eq!(boundaries[boundaries.len() - 1], high + 2 * WIDENED);
        let widths: Vec<i32> = boundaries.windows(2).map(|b| b[1] - b[0]).collect();
        let (least, most) = (widths.iter().min().unwrap(), widths.iter().max().unwrap());
        prop_assert!(*least >= WIDTH_MIN && most - least <= 1);
        let room = (high - low + 4 * WIDENED) / WIDTH_MIN;
        prop_assert_eq!(axis.cells(), cells.min(room.unsigned_abs()));
    }

    /// The scene's own resolution makes about `DENSITY` cells a triangle, cubes where the
    /// bounds let it.
    #[test]
    fn density(triangles in 1..100_000_usize, size in [9..23_u32, 9..23, 9..23]) {
        let high = size.map(|bits| 1 << bits);
        let found = axes(Resolution::FromScene, triangles, [0; 3], high).expect("within the limits");
        let cells = found.each_ref().map(|axis| f64::from(axis.cells()));
        let total: f64 = cells.iter().product();
        prop_assert!(total <= DENSITY * triangles as f64);
        let edge = |i: usize| f64::from(high[i]) / cells[i];
        let several: Vec<usize> = (0..3).filter(|i| (8..1000).contains(&found[*i].cells())).collect();
        for pair in several.windows(2) {
            let ratio = edge(pair[0]) / edge(pair[1]);
            prop_assert!((0.8..1.25).contains(&ratio), "{cells:?} of {high:?}");
        }
        // Rounding down halves an axis at worst; a short or a long one is held by its limits.
        let limited = found.iter().any(|a| a.cells() == CELLS_MAX || a.boundaries()[1] - a.boundaries()[0] < 2 * WIDTH_MIN);
        prop_assert!(limited || total >= DENSITY * triangles as f64 / 8.0, "{cells:?} of {high:?}");
    }
}

fn given(axes: &[Axis; 3]) -> Resolution {
    Resolution::Given(axes.each_ref().map(Axis::cells))
}

/// The part of a triangle between two corners of a box (Sutherland and Hodgman 1974).
fn clipped(corners: [Point; 3], low: [f64; 3], high: [f64; 3]) -> Vec<[f64; 3]> {
    let mut polygon: Vec<[f64; 3]> = corners.iter().map(|c| c.map(f64::from)).collect();
    for axis in 0..3 {
        for (sign, limit) in [(1.0, high[axis]), (-1.0, -low[axis])] {
            let over = |p: [f64; 3]| sign * p[axis] - limit;
            let mut kept = Vec::new();
            for (i, &to) in polygon.iter().enumerate() {
                let from = polygon[(i + polygon.len() - 1) % polygon.len()];
                let (f, t) = (over(from), over(to));
                if (f > 0.0) != (t > 0.0) {
                    let s = f / (f - t);
                    kept.push([0, 1, 2].map(|i| from[i] + s * (to[i] - from[i])));
                }
                if t <= 0.0 {
                    kept.push(to);
                }
            }
            polygon = kept;
        }
    }
    polygon
}

/// Limits are checked, and named.
#[test]
fn limits() {
    let corner = |c: i32| Blockers {
        vertices: vec![[c; 3], [0; 3], [c, 0, 0]],
        triangles: vec![[0, 1, 2]],
    };
    let build = |b: &Blockers, cells| Grid::build(b, Resolution::Given(cells), Membership::Box);
    let large = corner(EXTENT);
    assert_eq!(build(&large, [0, 1, 1]), Err(GridError::Cells(0)));
    assert_eq!(build(&large, [1, 1025, 1]), Err(GridError::Cells(1025)));
    let too_many = build(&large, [1024, 1024, 17]);
    assert_eq!(too_many, Err(GridError::Cells(1024 * 1024 * 17)));
    assert_eq!(TOTAL_MAX, 1024 * 1024 * 16);
    let outside = build(&corner(EXTENT + 1), [1; 3]);
    assert_eq!(outside, Err(GridError::Outside([EXTENT + 1; 3])));
    // 64 triangles across a grid of 2^24 cells are not counted one by one.
    let across = |count| Blockers {
        vertices: vec![[-EXTENT; 3], [EXTENT; 3], [0; 3]],
        triangles: vec![[0, 1, 2]; count],
    };
    let cells = [256, 256, 256];
    assert_eq!(build(&across(64), cells), Err(GridError::Entries(1 << 30)));
    let counts = [1 << 25, 1 << 25, 1];
    assert_eq!(scan(&counts), Err(GridError::Entries((1 << 26) + 1)));
    assert_eq!(scan(&counts[..2]), Ok(vec![0, 1 << 25, 1 << 26]));
    let nothing = build(&Blockers::default(), [1; 3]).expect("a grid of nothing");
    assert_eq!(nothing.offsets, [0, 0]);
}
