//! Symmetries: everything turned together; directions swapped for their opposites.

use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::ldm::{
    Falloff, Hits, Layers, Map, Maps, Receiver, Rotation, directions, layers, neighbours,
    occlusion, openness, own_band, rotated, weight,
};
use triptych_spec::raster::{Setup, sample};
use triptych_spec::vertex::Primitives;

use super::light::ball;
use super::places::dot;
use super::traces::whole;
use super::{sphere, uncropped};

/// A point of the lattice in `f64`.
fn wide(point: Point) -> [f64; 3] {
    point.map(f64::from)
}

/// The largest ball around the origin inside of a closed mesh, and the smallest around it.
fn radii(mesh: &Blockers) -> [f64; 2] {
    let triangles = 0..u32::try_from(mesh.triangles.len()).unwrap();
    let planes = triangles.filter_map(|n| {
        let [a, b, c] = mesh.corners(n).map(wide);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
        let normal = [(1, 2), (2, 0), (0, 1)].map(|(j, k)| u[j] * v[k] - u[k] * v[j]);
        let long = dot(normal, normal).sqrt();
        (long > 0.0).then(|| (dot(a, normal) / long).abs())
    });
    let corners = mesh.vertices.iter().map(|v| dot(wide(*v), wide(*v)).sqrt());
    [planes.fold(f64::MAX, f64::min), corners.fold(0.0, f64::max)]
}

/// What a point outside of a ball around the origin sees of it along a direction, and against it,
/// if no border of the ball is as near as `margin`.
fn expected(
    point: [f64; 3],
    along: [f64; 3],
    [inner, outer]: [f64; 2],
    margin: f64,
) -> Option<[bool; 2]> {
    let toward = -dot(point, along);
    let beside = (dot(point, point) - toward * toward).sqrt();
    if beside > outer + margin {
        return Some([false; 2]);
    }
    (beside < inner - margin).then_some([toward > 0.0, toward < 0.0])
}

/// Turned together, scene, points, normals and directions give the same, but where the border of
/// something is within a pixel; numbers differ by what rounding the turned ones comes to.
#[test]
fn everything_turned_together_is_the_same() {
    let mesh = sphere([1e6; 3], 32, 24);
    let radii = radii(&mesh);
    let set = directions(128).unwrap();
    let still = uncropped(&set, &mesh, 200);
    let start = |n: u32| Rotation::of(2, n).turn([0.0, 0.0, 1.3e6 + 2e5 * f64::from(n % 7)]);
    let normal = |n: u32| Rotation::of(4, n).turn([0.0, 0.0, 16_384.0]);
    // Vectors of 14 bits, rounded in each component, in both scenes; weights are rounded down.
    let rounded = 2.0 * (28_380.0 / 268_435_456.0 + 1.0 / 524_288.0);
    for frame in 1..5 {
        let turn = |v: [f64; 3]| Rotation::of(11, frame).turn(v);
        let turned = Blockers {
            vertices: mesh
                .vertices
                .iter()
                .map(|v| turn(wide(*v)).map(whole))
                .collect(),
            triangles: mesh.triangles.clone(),
        };
        let maps = uncropped(&rotated(&set, 11, frame), &turned, 200);
        let [a, b] =
            [(&still, &mesh), (&maps, &turned)].map(|(maps, mesh)| layers(maps, mesh).unwrap());
        // From a point to the middle of its pixel, and what places are rounded by on the way.
        let margin = 0.5_f64.sqrt() * still.pixel.max(maps.pixel) * (1.0 + 1.0 / 32.0);
        for n in 0..40 {
            let (from, normal) = (start(n), normal(n));
            let seen = [
                (&still, &a, from, normal),
                (&maps, &b, turn(from), turn(normal)),
            ]
            .map(|(maps, layers, from, normal)| {
                all(maps, layers, from.map(whole), normal.map(whole))
            });
            let mut unsure = 0.0;
            for (at, direction) in set.iter().enumerate() {
                match expected(from, *direction, radii, margin) {
                    Some(sure) => assert_eq!(seen.each_ref().map(|s| s.1[at]), [sure; 2]),
                    None => unsure += dot(normal, *direction).abs() / 16_384.0,
                }
            }
            assert!(unsure < 128.0 * 0.08, "{unsure}");
            let off = (seen[0].0 - seen[1].0).abs();
            assert!(off <= 2.0 * (unsure / 128.0 + rounded), "{off} {unsure}");
        }
    }
}

/// The part that is open at a point on no surface, and whether each map has something before it,
/// and behind.
fn all(maps: &Maps, layers: &Layers, point: Point, normal: Point) -> (f64, Vec<[bool; 2]>) {
    let free = Receiver {
        point,
        normal: [0; 3],
        off: 0,
    };
    let hits: Vec<(&Map, Hits)> = maps
        .maps
        .iter()
        .map(|map| (map, neighbours(maps, map, layers, &free)))
        .collect();
    let seen = hits
        .iter()
        .map(|(_, hits)| [hits.before.is_some(), hits.behind.is_some()]);
    let seen = seen.collect();
    let open = occlusion(hits.into_iter(), normal, Falloff::None);
    (
        openness(&open, u32::try_from(maps.maps.len()).unwrap()).value,
        seen,
    )
}

/// Whether a receiver is clear of all that a mirror changes: halves that are rounded up on both
/// sides, borders of pixels and of triangles, which belong to one side, and keys at the ends of
/// the point's own band, as keys are rounded down.
fn is_clear(
    maps: [&Maps; 2],
    at: usize,
    mesh: &Blockers,
    layers: &Layers,
    receiver: &Receiver,
) -> bool {
    let [map, other] = maps.map(|maps| &maps.maps[at]);
    let mirrored = |point: &Point| {
        let [a, b] = [(maps[0], map), (maps[1], other)].map(|(maps, map)| {
            let place = maps.place(map, *point);
            [0, 1, 2].map(|axis| place[axis] + map.origin[axis])
        });
        a == [b[0], -b[1], -b[2]]
    };
    if !mesh.vertices.iter().chain([&receiver.point]).all(mirrored) {
        return false;
    }
    let maps = maps[0];
    let [x, y, key] = maps.place(map, receiver.point);
    let pixel = [x, y].map(|c| (c >> maps.bits).cast_unsigned());
    let drawn = Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: map.size,
        bits: maps.bits,
        snapped: mesh.vertices.iter().map(|v| maps.place(map, *v)).collect(),
        prims: mesh.triangles.clone(),
        source: Vec::new(),
    };
    let middle = pixel.map(|n| sample(n, maps.bits));
    let on_edge = |n: u32| Setup::new(&drawn, n).is_some_and(|s| s.edges(middle).contains(&0));
    let band = own_band(maps, map, receiver);
    let at_end = |own: &u32| ((own.cast_signed() - key).abs() - band).abs() <= 2;
    let list = layers.list(map.first + pixel[1] * map.size.width + pixel[0]);
    y & ((1 << maps.bits) - 1) != 0
        && !(0..u32::try_from(mesh.triangles.len()).unwrap()).any(on_edge)
        && !list.iter().any(at_end)
}

/// A map serves both of its directions: with the opposite ones what was before is behind, at the
/// same distance but for the rounding of a key, and what is open is the same to the last bit.
#[test]
fn a_direction_and_its_opposite_are_one() {
    let (mesh, receivers) = ball();
    let (mut clear, mut blocked) = (0, 0);
    for (frame, resolution) in [(1, 40), (2, 90), (3, 300)] {
        let set = rotated(&directions(32).unwrap(), 7, frame);
        let opposite: Vec<[f64; 3]> = set.iter().map(|d| d.map(|c| -c)).collect();
        let [one, other] = [&set, &opposite].map(|set| uncropped(set, &mesh, resolution));
        let [a, b] = [&one, &other].map(|maps| layers(maps, &mesh).unwrap());
        for receiver in &receivers {
            let mut found = [Vec::new(), Vec::new()];
            for at in (0..set.len()).filter(|at| is_clear([&one, &other], *at, &mesh, &a, receiver))
            {
                let (m, o) = (&one.maps[at], &other.maps[at]);
                let [h, i] = [
                    neighbours(&one, m, &a, receiver),
                    neighbours(&other, o, &b, receiver),
                ];
                let apart =
                    |hits: Hits, found: Option<u32>| found.map(|k| k.cast_signed() - hits.key);
                for (x, y) in [
                    (apart(h, h.before), apart(i, i.behind)),
                    (apart(h, h.behind), apart(i, i.before)),
                ] {
                    assert_eq!(x.is_some(), y.is_some(), "{x:?} {y:?}");
                    assert!(
                        x.zip(y).is_none_or(|(x, y)| (x + y).abs() <= 1),
                        "{x:?} {y:?}"
                    );
                    blocked += u32::from(x.is_some());
                }
                assert_eq!(weight(m, receiver.normal), -weight(o, receiver.normal));
                found[0].push((m, h));
                found[1].push((o, i));
            }
            clear += found[0].len();
            let [x, y] = found.map(|f| occlusion(f.into_iter(), receiver.normal, Falloff::None));
            assert_eq!(x, y);
        }
    }
    // Nearly all are.
    assert!(
        clear > 3 * 24 * 32 * 9 / 10 && blocked > 400,
        "{clear} {blocked}"
    );
}
