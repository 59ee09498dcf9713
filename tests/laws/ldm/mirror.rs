//! What glossy surfaces mirror: the nearest direction, its side, and what rays see there.

use proptest::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{
    Layers, Map, Maps, Mirrored, Receiver, Sky, layers, mirror, nearness, neighbours, view,
};

use super::{direction, empty, maps_of, normal_of, quad, uncropped};
use crate::config;
use crate::samples::sphere;

/// How far a map's direction may be rounded, of its length: half in each component of 2^14.
const ROUNDED: f64 = 0.866_025_5 / 16_384.0;

fn skies(maps: &Maps) -> Vec<Sky> {
    let numbers = (0_u16..).take(maps.maps.len()).map(f32::from);
    numbers.map(|n| [[n, 1.0, 0.5], [n, 2.0, 0.25]]).collect()
}

/// What a point mirrors through lists, in the nearest direction of all maps.
fn mirrored(maps: &Maps, layers: &Layers, receiver: &Receiver, view: Point) -> Mirrored {
    let skies = skies(maps);
    let all = maps.maps.iter().zip(&skies);
    let all = all.map(|(map, sky)| (map, neighbours(maps, map, layers, receiver), sky));
    mirror(all, receiver.normal, view)
}

fn coarse(direction: [f64; 3]) -> Point {
    #[expect(clippy::cast_possible_truncation, reason = "at most 2^20")]
    view(direction.map(|c| (c * 1_048_576.0).round() as i32))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| a[i] * b[i]).sum()
}

fn unit(v: Point) -> [f64; 3] {
    let v = v.map(f64::from);
    v.map(|c| c / dot(v, v).sqrt())
}

/// The mirror vector of integers, at length 1.
fn reflected(normal: Point, view: Point) -> [f64; 3] {
    let [n, v] = [normal, view].map(unit);
    let twice = 2.0 * dot(n, v);
    [0, 1, 2].map(|i| twice * n[i] - v[i])
}

/// The direction in which a point looks through the map that was found.
fn found_direction(maps: &Maps, found: &Mirrored) -> Option<[f64; 3]> {
    let map = &maps.maps[found.map? as usize];
    Some(map.direction.map(|c| if found.opposite { -c } else { c }))
}

/// Unit vectors at length 2^14, random and along axes.
fn vector() -> impl Strategy<Value = Point> {
    direction().prop_map(coarse)
}

fn one_triangle() -> Blockers {
    let mut mesh = empty();
    quad(&mut mesh, [-4_000_000; 2], [4_000_000; 2], 0);
    mesh
}

proptest! {
    #![proptest_config(config(256))]

    /// By brute force over all directions above the surface, in f64: none is nearer by more than
    /// what two rounded directions may differ by. A direction whose cosine with the normal is
    /// beyond 2^-19, the least weight, and both roundings is certainly one of them.
    #[test]
    fn none_is_nearer(
        normal in vector(), view in vector(),
        directions in prop::collection::vec(direction(), 1..40),
    ) {
        let mesh = one_triangle();
        let maps = uncropped(&directions, &mesh, 8);
        let receiver = Receiver { point: [0; 3], normal, off: 0 };
        let none = Layers { offsets: vec![0; maps.pixels as usize + 1], keys: Vec::new() };
        let found = mirrored(&maps, &none, &receiver, view);
        let (along, n) = (reflected(normal, view), unit(normal));
        let sides = directions.iter().flat_map(|d| [*d, d.map(|c| -c)]);
        let sure = sides.filter(|d| dot(*d, n) > 2.0 * ROUNDED + 2.0_f64.powi(-18));
        let nearest = sure.map(|d| dot(d, along)).reduce(f64::max);
        let Some(own) = found_direction(&maps, &found) else {
            prop_assert_eq!(nearest, None);
            return Ok(());
        };
        prop_assert!(dot(own, n) > -2.0 * ROUNDED, "below the surface");
        let slack = 2.0 * ROUNDED + 1e-12;
        let off = nearest.map_or(0.0, |nearest| nearest - dot(own, along));
        prop_assert!(off <= slack, "{} nearer than {:?}", off, found);
        // Nothing is in the way, so that the sky is seen on that side.
        prop_assert_eq!(found.hit, None);
        prop_assert_eq!(found.light[0].to_bits(), (found.map.unwrap() as f32).to_bits());
        prop_assert_eq!(found.light[1] > 1.5, found.opposite);
    }

    /// A surface turned around, seen from the opposite side, mirrors the opposite directions,
    /// exactly; and eye and mirrored direction may change places.
    #[test]
    fn sides_are_alike(normal in vector(), view in vector(), towards in direction()) {
        let maps = uncropped(&[towards], &one_triangle(), 8);
        let map = &maps.maps[0];
        let near = nearness(map, normal, view);
        let back = [normal, view].map(|v| v.map(|c| -c));
        prop_assert_eq!(nearness(map, back[0], back[1]), near);
        let turned = nearness(map, normal, back[1]);
        prop_assert_eq!(turned, near.map(|near| -near));
        prop_assert!(near.is_none_or(|near| near.unsigned_abs() < 1 << 58));
        let plane = map.planes[2];
        let [one, other] = [(view, plane), (plane, view)].map(|(v, d)| {
            let map = Map { planes: [[0; 3], [0; 3], d], ..map.clone() };
            nearness(&map, normal, v).map(i64::unsigned_abs)
        });
        prop_assert!(one.is_none() || other.is_none() || one == other);
    }
}

/// Of equals the first; no direction for a point on no surface, nor in the eye.
#[test]
fn the_first_of_equals_and_none() {
    let mesh = one_triangle();
    let twice = [[0.6, 0.0, 0.8], [0.0, 0.6, 0.8], [0.6, 0.0, 0.8]];
    let maps = uncropped(&twice, &mesh, 8);
    let layers = layers(&maps, &mesh).unwrap();
    let on = |normal| Receiver {
        point: [0, 0, 0],
        normal,
        off: 0,
    };
    let up = [0, 0, 1 << 14];
    let of = |normal, view| mirrored(&maps, &layers, &on(normal), view).map;
    assert_eq!(of(up, coarse([-0.6, 0.0, 0.8])), Some(0));
    assert_eq!(of(up, coarse([0.0, -0.6, 0.8])), Some(1));
    // Midway between two that mirror each other.
    assert_eq!(of(up, coarse([-0.5, -0.5, 0.8])), Some(0));
    assert_eq!(of([0; 3], up), None);
    assert_eq!(of(up, [0; 3]), None);
    assert_eq!(of([1 << 14, 0, 0], up), Some(0), "two have no weight to x");
    assert_eq!(of([0, 1 << 14, 0], up), Some(1));
}

/// A flat mirror under a ball: a point sees something where a line along the direction that was
/// found surely meets the ball, and the sky where it surely does not. A pixel of a map is as
/// long as its half diagonal; the ball's faces are inside of it by their sagitta.
#[test]
fn a_floor_mirrors_what_lines_meet() {
    let (radius, height) = (1_000_000.0, 1_500_000);
    let mut mesh = one_triangle();
    let first = u32::try_from(mesh.vertices.len()).unwrap();
    let ball = sphere([radius; 3], 48, 32);
    mesh.vertices
        .extend(ball.vertices.iter().map(|[x, y, z]| [*x, *y, z + height]));
    mesh.triangles
        .extend(ball.triangles.iter().map(|t| t.map(|row| first + row)));
    let maps = maps_of(&mesh, 200, 300, 1);
    let layers = layers(&maps, &mesh).unwrap();
    let eye: Point = [-3_000_000, 200_000, 4_000_000];
    let normal = normal_of(&mesh, 0);
    // Half a face spans pi / 48 around and pi / 64 from pole to pole: together (1 - cos) is below 0.004.
    let inner = radius * (1.0 - 0.004);
    let pixel = maps.pixel * std::f64::consts::FRAC_1_SQRT_2;
    let (mut sees, mut open) = (0, 0);
    for n in 0..900 {
        let point = [
            n % 30 * 130_000 - 1_900_000,
            n / 30 * 130_000 - 1_900_000,
            0,
        ];
        let receiver = Receiver {
            point,
            normal,
            off: 0,
        };
        let towards = view([0, 1, 2].map(|i| eye[i] - point[i]));
        let found = mirrored(&maps, &layers, &receiver, towards);
        let along = found_direction(&maps, &found).expect("directions above the floor");
        let centre = [0, 1, 2]
            .map(|i| [0, 0, height][i] - point[i])
            .map(f64::from);
        let past = dot(centre, along);
        let distance = (dot(centre, centre) - past * past).sqrt();
        if past > 0.0 && distance < inner - pixel {
            assert!(found.hit.is_some(), "{point:?}: {found:?}");
            assert_eq!(found.light.map(f32::to_bits), [0; 3]);
            sees += 1;
        } else if past < 0.0 || distance > radius + pixel {
            assert_eq!(found.hit, None, "{point:?}");
            assert!(found.light[1] > 0.0);
            open += 1;
        }
    }
    assert!(
        sees > 60 && open > 400 && sees + open > 800,
        "{sees} {open}"
    );
}
