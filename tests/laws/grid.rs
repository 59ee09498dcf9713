//! Grids and rays: nothing that a ray meets is missed, whatever the cells.

#[path = "grid/adapters.rs"]
mod adapters;
#[path = "grid/cells.rs"]
mod cells;
#[path = "grid/kernel.rs"]
mod kernel;
#[path = "grid/meshes.rs"]
mod meshes;
#[path = "grid/rays.rs"]
mod rays;

use proptest::prelude::*;
use proptest::sample::Index;
use triptych_spec::grid::hit::crossing;
use triptych_spec::grid::lattice::{EXTENT, Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::resolution::Resolution;
use triptych_spec::grid::trace::Closest;
use triptych_spec::grid::{Blockers, Grid, Membership};

/// A coordinate: near the middle, at the ends, anywhere.
fn coordinate() -> BoxedStrategy<i32> {
    prop_oneof![
        4 => -40..=40_i32,
        2 => (-40..=40_i32).prop_map(|c| c * 4096),
        1 => -EXTENT..=EXTENT,
        1 => prop::sample::select(vec![-EXTENT, EXTENT]),
    ]
    .boxed()
}

fn point() -> BoxedStrategy<Point> {
    [coordinate(), coordinate(), coordinate()].boxed()
}

/// Triangles that share corners now and then; some without area.
fn blockers() -> impl Strategy<Value = Blockers> {
    (
        prop::collection::vec(point(), 1..12),
        prop::collection::vec(any::<[Index; 3]>(), 0..16),
    )
        .prop_map(|(vertices, rows)| {
            let row =
                |row: [Index; 3]| row.map(|i| u32::try_from(i.index(vertices.len())).unwrap());
            Blockers {
                triangles: rows.into_iter().map(row).collect(),
                vertices,
            }
        })
}

/// What a scene decides, a few cells, or so many that whole bricks are empty.
fn resolution() -> impl Strategy<Value = Resolution> {
    prop_oneof![
        3 => Just(Resolution::FromScene),
        3 => [1..9_u32, 1..9_u32, 1..9_u32].prop_map(Resolution::Given),
        1 => [9..25_u32, 9..25_u32, 9..25_u32].prop_map(Resolution::Given),
    ]
}

fn membership() -> impl Strategy<Value = Membership> {
    prop::sample::select(vec![Membership::Box, Membership::Overlap])
}

/// A grid of random triangles.
fn grids() -> impl Strategy<Value = (Blockers, Grid)> {
    (blockers(), resolution(), membership()).prop_map(|(blockers, resolution, membership)| {
        let grid = Grid::build(&blockers, resolution, membership).expect("within the limits");
        (blockers, grid)
    })
}

/// A place worth starting or ending at: corners of triangles and of cells, points on edges
/// and beside all of them, and any.
fn place(blockers: &Blockers, grid: &Grid) -> BoxedStrategy<Point> {
    let vertices = blockers.vertices.clone();
    let axes = grid.axes.each_ref().map(|axis| axis.boundaries().to_vec());
    let [x, y, z] = axes.map(prop::sample::select);
    let corner = prop::sample::select(vertices);
    let beside = (corner.clone(), [-1..=1_i32, -1..=1, -1..=1]);
    let middle = (corner.clone(), corner.clone())
        .prop_map(|(a, b)| [0, 1, 2].map(|i| i32::midpoint(a[i], b[i])));
    prop_oneof![
        2 => corner,
        2 => beside.prop_map(|(a, b)| [0, 1, 2].map(|i| a[i] + b[i])),
        2 => middle,
        2 => [x, y, z],
        2 => point(),
        1 => [-REACH..=REACH, -REACH..=REACH, -REACH..=REACH],
    ]
    .boxed()
}

/// A ray between places, along an axis, or in any direction.
fn rays(blockers: &Blockers, grid: &Grid) -> BoxedStrategy<Ray> {
    let place = place(blockers, grid);
    let unit = prop::sample::select(vec![-1.0, -0.0, 0.0, 1.0, 1e-30, 3e20, 1.0 / 3.0]);
    let free = [unit.clone(), unit.clone(), unit];
    prop_oneof![
        4 => (place.clone(), place.clone()).prop_map(|(a, b)| Ray::between(a, b)),
        2 => (place.clone(), place.clone()).prop_map(|(a, b)| Ray {
            segment: false,
            ..Ray::between(a, b)
        }),
        2 => (place, free).prop_map(|(origin, direction)| Ray::along(origin, direction)),
    ]
    .boxed()
}

/// Triangles in a grid, and rays at them.
fn aimed() -> impl Strategy<Value = (Blockers, Grid, Vec<Ray>)> {
    grids().prop_flat_map(|(blockers, grid)| {
        let rays = prop::collection::vec(rays(&blockers, &grid), 1..12);
        (Just(blockers), Just(grid), rays)
    })
}

/// The nearest triangle, of all.
fn nearest(blockers: &Blockers, ray: &Ray) -> Option<Closest> {
    (0..u32::try_from(blockers.triangles.len()).unwrap())
        .filter_map(|prim| {
            let time = crossing(ray, blockers.corners(prim))?;
            Some(Closest { prim, time })
        })
        .min_by_key(|c| (c.time, c.prim))
}
