//! Triangles that `f32` has too early: what lies before them in truth is listed only in a later
//! cell than the one in which they seem to be.

use triptych_gpu::dispatch::Stages;
use triptych_spec::dispatch::{Carried, Met, Ray, WEIGHT_ONE, intersect};
use triptych_spec::grid::hit::{FOR_TIME, VOLUME_ERROR, crossing};
use triptych_spec::grid::lattice::{EXTENT, Point};
use triptych_spec::grid::ray::Ray as Way;
use triptych_spec::grid::resolution::Resolution;

use super::worlds::alone_in;
use crate::adapters::devices;

/// How far along x the ray starts before what it meets.
const BEFORE: i32 = (1 << 23) - (1 << 14);

/// Along x.
fn way(from: i32) -> Way {
    Way {
        origin: [from, 0, 0],
        direction: [1 << 23, 0, 0],
        segment: false,
    }
}

/// A time as `glance` of `meet.wgsl` has it, if nothing is fused; `None` where it leaves it to integers.
fn rounded(way: Way, corners: [Point; 3]) -> Option<f32> {
    let [a, b, c] = corners.map(|p| [0, 1, 2].map(|i| (p[i] - way.origin[i]) as f32));
    let minus = |a: [f32; 3], b: [f32; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let sum = |a: [f32; 3]| a[0].abs() + a[1].abs() + a[2].abs();
    let largest = |a: [f32; 3]| a[0].abs().max(a[1].abs()).max(a[2].abs());
    let (e, g) = (minus(b, a), minus(c, a));
    let cross = |j: usize, k: usize| e[j] * g[k] - e[k] * g[j];
    let normal = [cross(1, 2), cross(2, 0), cross(0, 1)];
    let direction = way.direction.map(|c| c as f32);
    let (height, slope) = (dot(a, normal), dot(direction, normal));
    #[expect(clippy::cast_possible_truncation, reason = "few bits")]
    let error = (FOR_TIME * VOLUME_ERROR) as f32 * largest(e) * largest(g);
    let is_open = height.abs() <= error * sum(a) || slope.abs() <= error * sum(direction);
    (!is_open).then_some(height / slope)
}

/// Steps along x at a time.
fn steps(time: f64) -> f64 {
    time * f64::from(1 << 23) - f64::from(BEFORE)
}

/// A triangle that the ray nearly grazes around the middle, and where it meets it: by `f32`, and in
/// truth. Numbers follow from a seed.
fn grazed(seed: u64) -> Option<([Point; 3], [f64; 2])> {
    let mut state = seed;
    let mut next = |most: i32| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        i32::try_from((state >> 33) % (2 * u64::from(most.unsigned_abs()))).unwrap() - most
    };
    let e = [
        next(1 << 20),
        next(1 << 20) + (1 << 21),
        next(1 << 20) - (1 << 21),
    ];
    // Nearly parallel as seen from the ray, so that it is nearly in their plane.
    let g = [
        next(1 << 20),
        e[1] / 2 + next(1 << 12),
        e[2] / 2 + next(1 << 12),
    ];
    let third = [0, 1, 2].map(|i| -(e[i] + g[i]) / 3);
    let corners = [[0; 3], e, g].map(|p| [0, 1, 2].map(|i| p[i] + third[i]));
    let way = way(-BEFORE);
    let met = crossing(&way, corners)?;
    let at = [f64::from(rounded(way, corners)?), met.value()].map(steps);
    (at[1] - at[0] > 24.0).then_some((corners, at))
}

/// Beside the ray, as long as the lattice: two cells along x meet in the middle.
const LONG: [Point; 3] = [
    [-EXTENT, EXTENT, EXTENT],
    [EXTENT, EXTENT, EXTENT],
    [0, EXTENT, EXTENT - 5],
];

#[test]
fn what_is_listed_later_may_be_first() {
    let found: Vec<_> = (0..400_000).filter_map(grazed).take(32).collect();
    assert_eq!(found.len(), 32, "enough of them");
    for (corners, [early, _]) in found {
        // The middle lies after where `f32` has it, and then comes a triangle across the ray.
        #[expect(clippy::cast_possible_truncation, reason = "a few hundred steps")]
        let by = -(early.ceil() as i32) - 4;
        let moved = corners.map(|[x, y, z]| [x + by, y, z]);
        let across = [[12, -900, -900], [12, 900, -900], [12, 0, 900]];
        let scene = alone_in(vec![moved, across, LONG], Resolution::Given([2, 1, 1]));
        let ray = Ray {
            way: way(by - BEFORE),
            pixel: 0,
            depth: 0,
            carried: Carried::Weight([WEIGHT_ONE; 3]),
        };
        assert_eq!(
            intersect(&scene.tracer(), &ray),
            Met::Triangle(1),
            "the one across is first"
        );
        for (gpu, kernels) in devices() {
            for kernels in kernels {
                let stages = Stages::new(gpu, kernels, &scene.world, &scene.grid);
                let met = stages.expect("a device").intersect(&[ray]);
                let met = met.expect("an answer");
                assert_eq!(met, [Met::Triangle(1)], "{}", gpu.name);
            }
        }
    }
}
