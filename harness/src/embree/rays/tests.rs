//! Bounds against `f32` arithmetic done here, and rays whose answer is known.

use triptych_spec::grid::Blockers;
use triptych_spec::grid::exact::{minus, triple};
use triptych_spec::grid::hit::{crossing, sides};
use triptych_spec::grid::lattice::{EXTENT, Point, REACH};
use triptych_spec::grid::ray::Ray;

use super::bound::{Pair, edge_errors, pair};
use super::{RayAnswers, RayScene, single};
use crate::generate::Random;

/// A number between two, both included.
fn within(random: &mut Random, low: i32, high: i32) -> i32 {
    let width = high.abs_diff(low) as usize + 1;
    let above = i32::try_from(random.below(width)).expect("a short way");
    low + above
}

/// A triangle of sides up to `size` around a point, and a segment past it.
fn random(random: &mut Random, size: i32) -> (Ray, [Point; 3]) {
    let half = EXTENT - size;
    let centre = [0; 3].map(|_| within(random, -half, half));
    let mut near = |reach: i32| centre.map(|c| c + within(random, -reach, reach));
    let corners = [near(size), near(size), near(size)];
    let aim = near(size);
    let from = [0; 3].map(|_| within(random, -REACH, REACH));
    // Past the aim by up to as much again, where the lattice allows it.
    let to = [0, 1, 2].map(|i| (2 * aim[i] - from[i]).clamp(-REACH, REACH));
    let segment = within(random, 0, 1) == 0;
    let ray = Ray {
        segment,
        ..Ray::between(from, to)
    };
    (ray, corners)
}

/// Sizes of triangles, in steps.
const SIZES: [i32; 4] = [16, 1 << 10, 1 << 16, 1 << 22];

type Single = [f32; 3];

fn dot(a: Single, b: Single) -> f32 {
    a[0] * b[0] + (a[1] * b[1] + a[2] * b[2])
}

fn combined(a: Single, b: Single, f: impl Fn(f32, f32) -> f32) -> Single {
    [0, 1, 2].map(|i| f(a[i], b[i]))
}

fn cross(a: Single, b: Single) -> Single {
    let term = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// Embree's edge functions and time (`triangle_intersector_pluecker.h`), but for the
/// approximate reciprocal, in place of which this divides.
fn embree(ray: &Ray, corners: [Point; 3]) -> ([f32; 3], f32) {
    let (origin, direction) = (single(ray.origin), single(ray.direction));
    let [a, b, c] = corners.map(|v| combined(single(v), origin, |x, y| x - y));
    let edges = [[b, c], [c, a], [a, b]];
    let values = edges.map(|[from, to]| {
        let (edge, sum) = (
            combined(from, to, |x, y| x - y),
            combined(from, to, |x, y| x + y),
        );
        dot(cross(edge, sum), direction)
    });
    let [e0, e1, e2] = [[c, a], [a, b], [b, c]].map(|[x, y]| combined(x, y, |x, y| x - y));
    let (one, other) = (cross(e0, e1), cross(e1, e2));
    let second = |x: Single, y: Single, i: usize| (x[(i + 2) % 3] * y[(i + 1) % 3]).abs();
    let normal = [0, 1, 2].map(|i| match second(e0, e1, i) < second(e1, e2, i) {
        true => one[i],
        false => other[i],
    });
    let t = 1.0 / (2.0 * dot(normal, direction)) * (2.0 * dot(a, normal));
    (values, t)
}

#[test]
fn edge_functions_stay_within_their_bounds() {
    let mut source = Random::new(1);
    for size in SIZES {
        let mut largest: f64 = 0.0;
        for _ in 0..100_000 {
            let (ray, corners) = random(&mut source, size);
            let errors = edge_errors(&ray, corners);
            let (values, _) = embree(&ray, corners);
            for (i, exact) in sides(&ray, corners).into_iter().enumerate() {
                #[expect(clippy::cast_possible_truncation, reason = "an integer below 2^79")]
                let value = values[i] as i128;
                let error = (value - 2 * exact).unsigned_abs() as f64;
                assert!(error <= errors[i], "{error} {errors:?} {ray:?} {corners:?}");
                largest = largest.max(error / errors[i].max(1.0));
            }
        }
        assert!((0.2..=1.0).contains(&largest), "{size}: {largest}");
    }
}

#[test]
fn times_stay_within_their_bounds() {
    let mut source = Random::new(2);
    for size in SIZES {
        let (mut largest, mut inside) = (0.0_f64, 0);
        for _ in 0..100_000 {
            let (ray, corners) = random(&mut source, size);
            let met = match pair(&ray, corners) {
                Pair::Inside(met) => met,
                Pair::Edge(Some(met)) => met,
                Pair::Edge(None) | Pair::Outside => continue,
            };
            inside += 1;
            let (_, t) = embree(&ray, corners);
            let ratio = (f64::from(t) - met.t).abs() / met.bound;
            assert!(ratio <= 1.0, "{ratio} {met:?} {ray:?} {corners:?}");
            largest = largest.max(ratio);
        }
        assert!(inside > 1000, "{size}: {inside} pairs");
        assert!((0.2..=1.0).contains(&largest), "{size}: {largest}");
    }
}

#[test]
fn classes_are_those_of_the_spec_where_they_are_certain() {
    let mut source = Random::new(3);
    let mut seen = [0; 3];
    for round in 0..200_000 {
        let (ray, corners) = random(&mut source, SIZES[round % 4]);
        let met = crossing(&ray, corners);
        match pair(&ray, corners) {
            Pair::Inside(at) => {
                seen[0] += 1;
                let t = met.expect("the spec meets it").value();
                assert_eq!(t, at.t, "{ray:?} {corners:?}");
            }
            Pair::Outside => {
                seen[1] += 1;
                assert_eq!(met, None, "{ray:?} {corners:?}");
            }
            Pair::Edge(_) => seen[2] += 1,
        }
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}

#[test]
fn what_embree_is_sure_of_is_what_it_says() {
    let mut source = Random::new(4);
    for round in 0..2_000 {
        let (ray, corners) = random(&mut source, SIZES[round % 4]);
        let scene = scene(corners);
        let (occluded, closest) = (scene.occluded(&ray), scene.closest(&ray));
        let said = closest.map(|hit| f64::from(hit.t));
        let within = match pair(&ray, corners) {
            Pair::Inside(met) => occluded && said.is_some_and(|t| (t - met.t).abs() <= met.bound),
            Pair::Outside => !occluded && said.is_none(),
            Pair::Edge(_) => true,
        };
        assert!(within, "{said:?} {ray:?} {corners:?}");
        scene.check().expect("no error");
    }
}

fn scene(corners: [Point; 3]) -> RayScene {
    let blockers = Blockers {
        vertices: corners.to_vec(),
        triangles: vec![[0, 1, 2]],
    };
    RayScene::new(&blockers).expect("Embree builds")
}

/// A right angle in the plane x = 0.
const RIGHT: [Point; 3] = [[0, 0, 0], [0, 4096, 0], [0, 0, 4096]];

#[test]
fn a_bound_is_what_is_worked_out_by_hand() {
    let ray = Ray::between([-1024, 1024, 1024], [1024, 1024, 1024]);
    let Pair::Inside(met) = pair(&ray, RIGHT) else {
        panic!("it goes through the middle");
    };
    // N = (2^24, 0, 0) and d = (0, ., .): N's own error does not count. Each dot product is
    // off by 3 u of itself, the reciprocal and its product by 5.25 u of t, which is 1 / 2.
    let u = 2.0_f64.powi(-24);
    let by_hand = (3.0 + 3.0 + 5.25) * u / 2.0;
    assert_eq!(met.t, 0.5, "half way");
    let ratio = met.bound / by_hand;
    assert!((1.0..1.01).contains(&ratio), "{ratio}");
}

#[test]
fn the_error_of_a_slanting_normal_counts_with_the_size_of_the_triangle() {
    let k = 4096;
    let slanting = [[0, 0, 0], [k, k, 0], [0, 0, k]];
    let ray = Ray::between([-1024, 1024, 1024], [3072, 1024, 1024]);
    let Pair::Inside(met) = pair(&ray, slanting) else {
        panic!("it goes through the middle");
    };
    // N = (1, -1, 0) k^2, its errors (2, 2, 0) u k^2, as each component has a pair of edges
    // without a second term. N . D = 4096 k^2, d = (-1, -1, -1) 1024, v0 = (1, -1, -1) 1024.
    let u = 2.0_f64.powi(-24);
    let of_normal = 1024.0 * 2.0 * 2.0;
    let of_dots = 3.0 * 2.0 * 1024.0 + 3.0 * 4096.0 / 2.0;
    let by_hand = u * ((of_normal + of_dots) / 4096.0 + 5.25 / 2.0);
    let ratio = met.bound / by_hand;
    assert!((1.0..1.01).contains(&ratio), "{ratio}");
}

#[test]
fn a_sum_that_rounds_counts() {
    // From the corner a to b: e = (0, 1, 1), s = (0, 1, 2^24 + 1), which is rounded by 1. The
    // components of the cross product are (2^24, 0, 0), whose products are 2^24 + 1 and 1.
    let far = 1 << 22;
    let corners = [[0, 0, far], [0, 1, far + 1], [9, 9, 9]];
    let ray = Ray::between([0, 0, -far], [1, 0, -far]);
    let [_, _, error] = edge_errors(&ray, corners);
    let by_hand = 1.0 + (1.0 + 4.0);
    let ratio = error / by_hand;
    assert!((1.0..1.01).contains(&ratio), "{ratio}");
}

#[test]
fn ends_of_a_segment_on_a_triangle_are_open() {
    let at = [0, 1024, 1024];
    let edge = |ray: Ray| matches!(pair(&ray, RIGHT), Pair::Edge(Some(_)));
    let far = [1 << 20, 5, 9];
    assert!(edge(Ray::between(at, far)), "starts there");
    assert!(edge(Ray::between(far, at)), "ends there");
    let endless = Ray {
        segment: false,
        ..Ray::between(far, at)
    };
    assert!(matches!(pair(&endless, RIGHT), Pair::Inside(_)), "goes on");
}

#[test]
fn what_lies_behind_or_beyond_is_outside() {
    let [near, far] = [[-9000, 1024, 1024], [-1000, 1024, 1024]];
    assert_eq!(pair(&Ray::between(near, far), RIGHT), Pair::Outside, "ends");
    let back = Ray {
        segment: false,
        ..Ray::between(far, near)
    };
    assert_eq!(pair(&back, RIGHT), Pair::Outside, "goes the other way");
}

#[test]
fn a_triangle_without_area_is_outside() {
    let flat = [[0, 0, 0], [3, 6, 9], [1, 2, 3]];
    let ray = Ray::between([5, 5, -5], [-3, -1, 11]);
    assert_eq!(pair(&ray, flat), Pair::Outside, "a line that the ray meets");
    assert_eq!(pair(&ray, [[1, 2, 3]; 3]), Pair::Outside, "a point");
    assert_eq!(scene(flat).closest(&ray), None, "Embree");
}

#[test]
fn a_triangle_seen_edge_on_has_no_time() {
    // In its plane, past a corner from within rounding: no edge function is clear.
    let ray = Ray::between([0, 0, -(1 << 20)], [0, 0, 1 << 20]);
    assert_eq!(pair(&ray, RIGHT), Pair::Edge(None), "along an edge");
    assert_eq!(
        triple(
            ray.direction,
            minus(RIGHT[1], RIGHT[0]),
            minus(RIGHT[2], RIGHT[0])
        ),
        0,
        "the plane holds the ray"
    );
}

#[test]
fn blockers_beyond_the_lattice_or_without_corners_are_refused() {
    let mut beyond = RIGHT;
    beyond[1][2] = EXTENT + 1;
    let blockers = |vertices: &[Point], triangle| Blockers {
        vertices: vertices.to_vec(),
        triangles: vec![triangle],
    };
    for (blockers, word) in [
        (blockers(&beyond, [0, 1, 2]), "beyond the lattice"),
        (blockers(&RIGHT, [0, 1, 3]), "no corner 3"),
    ] {
        let error = RayScene::new(&blockers).err().expect("refused").to_string();
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn without_triangles_nothing_is_met() {
    let scene = RayScene::new(&Blockers::default()).expect("nothing to build");
    let ray = Ray::between([-9; 3], [9; 3]);
    assert!(!scene.occluded(&ray), "nothing is there");
    assert_eq!(scene.closest(&ray), None, "nothing is there");
    scene.check().expect("no error");
}
