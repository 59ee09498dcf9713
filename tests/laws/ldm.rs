//! Layered depth maps: directions, maps, what is seen through them.

#[path = "ldm/adapters.rs"]
mod adapters;
#[path = "ldm/bands.rs"]
mod bands;
#[path = "ldm/chains.rs"]
mod chains;
#[path = "ldm/crops.rs"]
mod crops;
#[path = "ldm/directions.rs"]
mod directions;
#[path = "ldm/frames.rs"]
mod frames;
#[path = "ldm/light.rs"]
mod light;
#[path = "ldm/loose.rs"]
mod loose;
#[path = "ldm/maps.rs"]
mod maps;
#[path = "ldm/mirror.rs"]
mod mirror;
#[path = "ldm/orders.rs"]
mod orders;
#[path = "ldm/places.rs"]
mod places;
#[path = "ldm/symmetry.rs"]
mod symmetry;
#[path = "ldm/traces.rs"]
mod traces;

use proptest::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{Maps, Rotation, directions, rotated};
use triptych_spec::rsm::Face;

use crate::samples::sphere;

/// The box around vertices.
fn around(vertices: &[Point]) -> [Point; 2] {
    let end = |f: fn(i32, i32) -> i32, start: i32| {
        [0, 1, 2].map(|i| vertices.iter().fold(start, |m, v| f(m, v[i])))
    };
    [end(i32::min, i32::MAX), end(i32::max, i32::MIN)]
}

/// The corners of a box.
fn corners([low, high]: [Point; 2]) -> [Point; 8] {
    std::array::from_fn(|n| [0, 1, 2].map(|i| if n >> i & 1 == 0 { low[i] } else { high[i] }))
}

/// Maps of a mesh in `count` directions, turned as in a frame.
fn maps_of(mesh: &Blockers, count: u32, resolution: u32, frame: u32) -> Maps {
    let set = rotated(&directions(count).expect("a set"), 7, frame);
    uncropped(&set, mesh, resolution)
}

/// Maps for receivers that may be anywhere in the mesh's box.
fn uncropped(directions: &[[f64; 3]], mesh: &Blockers, resolution: u32) -> Maps {
    let bounds = around(&mesh.vertices);
    Maps::new(directions, bounds, bounds, resolution).expect("within the limits")
}

/// A quad at right angles to z, from corner to corner, as two triangles.
fn quad(mesh: &mut Blockers, [x0, y0]: [i32; 2], [x1, y1]: [i32; 2], z: i32) {
    let first = u32::try_from(mesh.vertices.len()).unwrap();
    mesh.vertices
        .extend([[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]);
    mesh.triangles
        .extend([[0, 1, 2], [0, 2, 3]].map(|t| t.map(|row| first + row)));
}

fn empty() -> Blockers {
    Blockers {
        vertices: Vec::new(),
        triangles: Vec::new(),
    }
}

/// A coordinate of the lattice, near its middle or anywhere.
fn coordinate() -> BoxedStrategy<i32> {
    prop_oneof![-4000..=4000_i32, (-4000..=4000_i32).prop_map(|c| c * 2048)].boxed()
}

fn point() -> BoxedStrategy<Point> {
    [coordinate(), coordinate(), coordinate()].boxed()
}

/// A few triangles, some without area, between a few points.
fn mesh() -> impl Strategy<Value = Blockers> {
    let rows = prop::collection::vec(any::<[prop::sample::Index; 3]>(), 1..9);
    (prop::collection::vec(point(), 3..9), rows).prop_map(|(vertices, rows)| {
        let row = |row: prop::sample::Index| u32::try_from(row.index(vertices.len())).unwrap();
        let triangles = rows.into_iter().map(|t| t.map(row)).collect();
        Blockers {
            vertices,
            triangles,
        }
    })
}

/// A direction of any.
fn direction() -> BoxedStrategy<[f64; 3]> {
    prop_oneof![
        4 => (any::<u64>(), 1..1000_u32).prop_map(|(seed, frame)| {
            Rotation::of(seed, frame).turn([0.0, 0.0, 1.0])
        }),
        1 => prop::sample::select(vec![
            [0.0, 0.0, 1.0],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [1.0, 0.0, 0.0],
        ]),
    ]
    .boxed()
}

fn normal_of(mesh: &Blockers, triangle: u32) -> Point {
    Face::new(mesh.corners(triangle)).coarse
}
