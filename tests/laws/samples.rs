//! Random triangles on the sub-pixel grid, and a closed mesh on the lattice.

use proptest::prelude::*;
use triptych_spec::grid::Blockers;
use triptych_spec::grid::lattice::Point;
use triptych_spec::raster::{Fragment, cover};
use triptych_spec::scene::Size;
use triptych_spec::vertex::{DEPTH_ONE, GUARD, Primitives, guard_origin};

/// Corners of a triangle: x and y in sub-pixels, z key.
pub type Triangle = [[i32; 3]; 3];

/// Targets small enough to look at every sample of them; some are so wide that several invocations
/// share a row of a triangle.
pub fn size() -> impl Strategy<Value = Size> {
    prop_oneof![
        4 => (1_u32..=20, 1_u32..=20),
        1 => (65_u32..=300, 1_u32..=4),
    ]
    .prop_map(|(width, height)| Size { width, height })
}

/// Around a target's side: anywhere, on centres and borders of pixels, at the end of
/// the guard rectangle.
pub fn coordinate(side: u32, bits: u32) -> BoxedStrategy<i32> {
    let one = 1 << bits;
    let low = guard_origin(side) << bits;
    let high = low + (GUARD << bits);
    let side = side.cast_signed();
    let margin = one * (side / 4 + 1);
    prop_oneof![
        6 => -margin..=one * side + margin,
        4 => (-1..=2 * side + 1).prop_map(move |half| half * one / 2),
        1 => low..=high,
        1 => prop::sample::select(vec![low, high]),
    ]
    .boxed()
}

/// Any depth key, and more often than not the ends of the scale.
pub fn depth() -> impl Strategy<Value = i32> {
    prop_oneof![3 => 0..=DEPTH_ONE, 1 => 0..3, 1 => DEPTH_ONE - 2..=DEPTH_ONE]
}

/// A corner around a target.
pub fn corner(size: Size, bits: u32) -> BoxedStrategy<[i32; 3]> {
    let (x, y) = (coordinate(size.width, bits), coordinate(size.height, bits));
    (x, y, depth()).prop_map(|(x, y, z)| [x, y, z]).boxed()
}

/// A triangle: any, small, thin, or without area.
pub fn triangle(size: Size, bits: u32) -> BoxedStrategy<Triangle> {
    let free = || corner(size, bits);
    let one = 1 << bits;
    let near = move |reach: i32| {
        (free(), [-reach..=reach, -reach..=reach], depth())
            .prop_map(|([x, y, z], [dx, dy], dz)| ([x, y, z], [x + dx, y + dy, dz]))
    };
    prop_oneof![
        4 => [free(), free(), free()],
        2 => (near(one), free()).prop_map(|((a, b), c)| [a, b, c]),
        2 => (near(2 * one), [-one..=one, -one..=one], depth())
            .prop_map(|((a, b), [dx, dy], z)| [a, b, [a[0] + dx, a[1] + dy, z]]),
        1 => [free(), free()].prop_map(|[a, b]| [a, b, a]),
        1 => whole_guard(size, bits),
    ]
    .boxed()
}

/// Half of the guard rectangle, parallel to the screen: the largest numerators, which
/// the area divides exactly.
fn whole_guard(size: Size, bits: u32) -> impl Strategy<Value = Triangle> {
    let ends = move |side: u32| [0, GUARD].map(|end| (guard_origin(side) + end) << bits);
    let ([left, right], [top, bottom]) = (ends(size.width), ends(size.height));
    (depth(), 0_usize..4).prop_map(move |(z, without)| {
        let mut corners = vec![
            [left, top, z],
            [right, top, z],
            [right, bottom, z],
            [left, bottom, z],
        ];
        corners.remove(without);
        [corners[0], corners[1], corners[2]]
    })
}

/// Triangles of any kind, on a grid of any fineness.
pub fn soup(count: std::ops::Range<usize>) -> impl Strategy<Value = Primitives> {
    (1_u32..=8).prop_flat_map(move |bits| soup_on(bits, count.clone()))
}

/// Triangles of any kind on a grid of so many sub-pixel bits.
pub fn soup_on(bits: u32, count: std::ops::Range<usize>) -> impl Strategy<Value = Primitives> {
    size().prop_flat_map(move |size| {
        prop::collection::vec(triangle(size, bits), count.clone())
            .prop_map(move |triangles| primitives(size, bits, &triangles))
    })
}

/// Triangles as the raster stage takes them, each from a source triangle of its own.
pub fn primitives(size: Size, bits: u32, triangles: &[Triangle]) -> Primitives {
    let rows = 0..u32::try_from(triangles.len()).expect("few triangles");
    Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size,
        bits,
        snapped: triangles.concat(),
        prims: rows
            .clone()
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect(),
        source: rows.collect(),
    }
}

/// The corners of every row.
pub fn triangles(primitives: &Primitives) -> Vec<Triangle> {
    let corners = |row: &[u32; 3]| row.map(|v| primitives.snapped[v as usize]);
    primitives.prims.iter().map(corners).collect()
}

/// Every fragment, in order of triangle, row and column.
pub fn fragments(primitives: &Primitives) -> Vec<Fragment> {
    let mut all = Vec::new();
    cover(primitives, |f| all.push(f));
    all
}

/// How many triangles cover each pixel.
pub fn times(primitives: &Primitives) -> Vec<u32> {
    let mut times = vec![0; primitives.size.pixels()];
    cover(primitives, |f| times[f.pixel as usize] += 1);
    times
}

/// Every pixel with its sample's place, in row-major order.
pub fn samples(size: Size, bits: u32) -> impl Iterator<Item = (u32, [i128; 2])> {
    let centre = move |p: u32| (i128::from(p) << bits) + (1 << (bits - 1));
    (0..size.width * size.height)
        .map(move |p| (p, [centre(p % size.width), centre(p / size.width)]))
}

/// Twice the signed area of three points.
pub fn area(a: [i32; 2], b: [i32; 2], c: [i32; 2]) -> i64 {
    let [[ax, ay], [bx, by], [cx, cy]] = [a, b, c].map(|p| p.map(i64::from));
    (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
}

/// The first two coordinates.
pub fn flat([x, y, _]: [i32; 3]) -> [i32; 2] {
    [x, y]
}

/// A closed surface around 0: a sphere of so many meridians and parallels, stretched to three
/// radii, its corners snapped. Rows at a pole are at one place, and give triangles without area.
pub fn sphere(radii: [f64; 3], around: u32, down: u32) -> Blockers {
    let at = |i: u32, j: u32| -> Point {
        let (turn, tilt) = (
            f64::from(i % around) / f64::from(around) * std::f64::consts::TAU,
            f64::from(j) / f64::from(down) * std::f64::consts::PI,
        );
        let direction = [tilt.sin() * turn.cos(), tilt.sin() * turn.sin(), tilt.cos()];
        #[expect(clippy::cast_possible_truncation, reason = "within the lattice")]
        [0, 1, 2].map(|axis| (direction[axis] * radii[axis]).round() as i32)
    };
    let row = |i: u32, j: u32| j * around + i % around;
    let vertices = (0..=down).flat_map(|j| (0..around).map(move |i| at(i, j)));
    let quads = (0..down).flat_map(|j| (0..around).map(move |i| (i, j)));
    let halves = quads.flat_map(|(i, j)| {
        let [a, b, c, d] = [row(i, j), row(i + 1, j), row(i + 1, j + 1), row(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    Blockers {
        vertices: vertices.collect(),
        triangles: halves.collect(),
    }
}
