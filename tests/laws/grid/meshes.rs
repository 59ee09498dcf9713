//! Closed meshes: what starts inside and ends outside meets them.

use proptest::prelude::*;
use triptych_spec::grid::lattice::{Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::{blocked, closest};
use triptych_spec::grid::{Blockers, Grid, Membership};

use super::point;
use crate::config;
use crate::samples::sphere;

/// A closed surface around 0: a sphere of so many meridians and parallels, stretched.
fn spheres() -> impl Strategy<Value = Blockers> {
    let radius = prop_oneof![16.0..200.0_f64, 1e3..4e6_f64];
    let size = [radius.clone(), radius.clone(), radius];
    (3..9_u32, 3..9_u32, size).prop_map(|(around, down, size)| sphere(size, around, down))
}

/// A corner, a point of an edge, or anything.
fn target(mesh: &Blockers) -> BoxedStrategy<Point> {
    let edge = |rows: [u32; 3]| [rows[0], rows[1]].map(|row| mesh.vertices[row as usize]);
    let edges: Vec<[Point; 2]> = mesh.triangles.iter().map(|rows| edge(*rows)).collect();
    let middle = |[a, b]: [Point; 2]| [0, 1, 2].map(|i| i32::midpoint(a[i], b[i]));
    prop_oneof![
        2 => prop::sample::select(mesh.vertices.clone()),
        2 => prop::sample::select(edges).prop_map(middle),
        1 => point(),
    ]
    .boxed()
}

proptest! {
    #![proptest_config(config(2000))]

    /// From the middle no direction leads out between triangles, and no way leads in.
    #[test]
    fn closed((mesh, target) in spheres().prop_flat_map(|mesh| {
        let target = target(&mesh);
        (Just(mesh), target)
    }), resolution in super::resolution()) {
        let grid = Grid::build(&mesh, resolution, Membership::Overlap).expect("within the limits");
        prop_assume!(target != [0; 3]);
        let out = Ray { segment: false, ..Ray::between([0; 3], target) };
        prop_assert!(blocked(&grid, &mesh, out));
        prop_assert!(closest(&grid, &mesh, out).is_some());
        // The same line from as far as the lattice goes.
        let longest = target.iter().fold(0, |m, c| m.max(c.abs()));
        let far = target.map(|c| c * (REACH / longest));
        let in_ = Ray::between(far, [0; 3]);
        let outside = mesh.vertices.iter().flatten().all(|c| c.abs() < REACH / 2);
        prop_assert!(!outside || blocked(&grid, &mesh, in_), "{:?}", in_);
    }
}
