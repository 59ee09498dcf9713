//! What is counted, and where counting stops.

use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::{Blockers, Membership};

use super::*;
use crate::dispatch::share;

/// As many triangles across all of the cells of one row.
fn row(cells: u32, triangles: u32) -> Grid {
    let corners = [[-1024, 0, 0], [1024, 0, 0], [0, 8, 8]];
    let blockers = Blockers {
        vertices: corners.to_vec(),
        triangles: (0..triangles).map(|_| [0, 1, 2]).collect(),
    };
    let resolution = Resolution::Given([cells, 1, 1]);
    Grid::build(&blockers, resolution, Membership::Box).expect("within the limits")
}

#[test]
fn a_list_counts_in_every_cell() {
    let grid = row(16, 5);
    let along = Ray::between([-1024, 1, 1], [1024, 1, 1]);
    let whole = Work {
        cells: 16,
        entries: 80,
    };
    assert_eq!(of(&grid, along), whole);
    assert_eq!(most(&grid), whole, "no ray has more");
    let beside = Ray::between([-1024, 5000, 0], [1024, 5000, 0]);
    assert_eq!(of(&grid, beside), Work::default(), "no cell, no work");
    let half = Ray::between([-1024, 1, 1], [-64, 1, 1]);
    assert_eq!(of(&grid, half).cells, 8, "a segment ends");
}

#[test]
fn all_parts_count_on_any_number_of_threads() {
    for threads in [1, 2, 7] {
        share::with_threads(threads, || {
            for (limit, fits) in [(4950, true), (4949, false)] {
                let meter = Meter::new(limit);
                let all = share::all(100, 1, |part| meter.takes(part as u64));
                assert_eq!(all, fits, "{limit} on {threads}");
            }
        });
    }
    let meter = Meter::new(u64::MAX);
    assert!(meter.takes(u64::MAX) && meter.takes(0), "to the limit");
    let meter = Meter::new(1);
    assert!(
        !meter.takes(u64::MAX) && !meter.takes(0),
        "beyond it, for good"
    );
}
