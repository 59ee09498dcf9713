//! Rays through a scanned mesh.

use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::{EXTENT, Lattice, Point, REACH};
use triptych_spec::grid::ray::Ray;
use triptych_spec::grid::trace::Query;

use super::{QUERIES, Random, Scene};
use crate::compare::embree::tests::world::load;

/// Rays of each kind.
const EACH: usize = 40_000;

/// What rays are aimed at.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Segments between points of the box around the mesh.
    Anywhere,
    /// Segments in the plane of a triangle, but for rounding, through its inside.
    Grazing,
    /// Rays at corners.
    Corner,
    /// Rays at points of edges, but for rounding.
    Edge,
    /// Rays from points of triangles, but for rounding: shadows.
    Surface,
}

/// All of them.
const KINDS: [Kind; 5] = [
    Kind::Anywhere,
    Kind::Grazing,
    Kind::Corner,
    Kind::Edge,
    Kind::Surface,
];

/// The mesh, snapped to a lattice. It comes with set-up, as the corpus has it.
fn bunny() -> Scene {
    let loaded = load("abuffer/bunny");
    let points = loaded.world.points(&loaded.scene);
    let lattice = Lattice::around(points.iter().copied()).expect("a mesh of numbers");
    let snap = |p: &[f64; 3]| lattice.snap(*p).expect("inside");
    let triangles = loaded.scene.triangles.iter().map(|t| t.vertices);
    Scene::new(Blockers {
        vertices: points.iter().map(snap).collect(),
        triangles: triangles.collect(),
    })
}

/// A point of a triangle, up to half a step.
fn of(random: &mut Random, corners: [Point; 3]) -> Point {
    let part = |random: &mut Random| f64::from(random.within(0, 1 << 20)) / f64::from(1 << 20);
    let (mut a, mut b) = (part(random), part(random));
    if a + b > 1.0 {
        (a, b) = (1.0 - a, 1.0 - b);
    }
    mixed(corners, [1.0 - a - b, a, b])
}

fn mixed(corners: [Point; 3], parts: [f64; 3]) -> Point {
    [0, 1, 2].map(|i| {
        let sum: f64 = (0..3).map(|c| parts[c] * f64::from(corners[c][i])).sum();
        #[expect(clippy::cast_possible_truncation, reason = "between corners")]
        let nearest = sum.round() as i32;
        nearest
    })
}

/// A ray of a kind.
fn ray(scene: &Scene, random: &mut Random, kind: Kind) -> Ray {
    let count = i32::try_from(scene.blockers.triangles.len()).expect("not many");
    let prim = random.within(0, count - 1).cast_unsigned();
    let corners = scene.blockers.corners(prim);
    let far = |random: &mut Random| super::point(random, EXTENT);
    let endless = |from, to| Ray {
        segment: false,
        ..Ray::between(from, to)
    };
    match kind {
        Kind::Anywhere => Ray::between(far(random), far(random)),
        Kind::Grazing => {
            let (middle, corner) = (of(random, corners), corners[0]);
            // Out to both sides in the plane.
            let times = random.within(1, 64);
            let ends = [times, -times].map(|n| {
                [0, 1, 2]
                    .map(|i| middle[i] + n * (middle[i] - corner[i]))
                    .map(|c| c.clamp(-REACH, REACH))
            });
            Ray::between(ends[0], ends[1])
        }
        Kind::Corner => endless(far(random), corners[0]),
        Kind::Edge => {
            let part = f64::from(random.within(0, 1 << 20)) / f64::from(1 << 20);
            endless(far(random), mixed(corners, [part, 1.0 - part, 0.0]))
        }
        Kind::Surface => endless(of(random, corners), far(random)),
    }
}

fn rays(scene: &Scene, kind: Kind, count: usize, seed: u64) -> Vec<Ray> {
    let mut random = Random(seed);
    (0..count).map(|_| ray(scene, &mut random, kind)).collect()
}

#[test]
fn a_scanned_mesh_agrees() {
    let scene = bunny();
    for kind in KINDS {
        let rays = rays(&scene, kind, EACH, 8);
        for query in QUERIES {
            let vote = scene.vote(&rays, query);
            println!("{kind:?} {query:?}: {vote}");
            assert_eq!(vote.disagree, 0, "{kind:?} {query:?}: {vote}");
            assert!(vote.edge * 2 < vote.rays, "{kind:?} {query:?}: {vote}");
            assert!(
                query == Query::Any || vote.times > 1_000 && vote.error_over_bound > 0.1,
                "{kind:?}: {vote}"
            );
        }
    }
}
