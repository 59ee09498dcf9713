//! Vertex stages: transform, clip, snap.
//!
//! World-space triangles become triangles on an integer grid: x and y in
//! sub-pixels, z on Appendix A's 31-bit depth scale (Yang et al. 2010). All
//! rounding of positions happens here, once; every later decision is integer
//! arithmetic on the result. Twin: `gpu/src/vertex.wgsl`.

use crate::bound::Real;
use crate::matrix::Matrix;
use crate::scene::{Scene, Size};

/// Side of the guard rectangle in pixels. Nothing outside it is ever handed to a
/// rasteriser, so no driver clips, and every later product has a known size.
pub const GUARD: i32 = 4096;

/// Largest side of a target: half the guard, so that it always encloses it.
pub const TARGET_MAX: u32 = 2048;

/// Bits of the sub-pixel grid, unless a driver's own grid is coarser.
pub const SUBPIXEL_BITS: u32 = 8;

/// Depth 1 on Appendix A's scale: `int(saturate(z) * 0x7fffffff)`.
pub const DEPTH_ONE: i32 = 0x7fff_ffff;

/// A triangle clipped by six planes has at most this many corners.
pub const CORNERS_MAX: usize = 9;

/// A position in homogeneous pixels: `x / w` counts pixels to the right of the
/// target's left edge, `y / w` pixels down from its top, `z / w` is depth.
pub type Position<T> = [T; 4];

/// Convex polygons, one per source triangle; those clipped away are empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygons<T> {
    /// `offsets[t]..offsets[t + 1]` are the corners of source triangle `t`.
    pub offsets: Vec<u32>,
    /// Corners in order.
    pub corners: Vec<Position<T>>,
}

/// Triangles on the grid: what the raster stage starts from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Primitives {
    /// Size of the target.
    pub size: Size,
    /// Sub-pixel bits of `x` and `y`.
    pub bits: u32,
    /// Corners: x right and y down in sub-pixels from the target's top left, z key.
    pub snapped: Vec<[i32; 3]>,
    /// Triangles after clipping, as rows of `snapped`, in tie order.
    pub prims: Vec<[u32; 3]>,
    /// For each row of `prims` its row in [`Scene::triangles`].
    pub source: Vec<u32>,
}

/// First pixel column (row) of the guard rectangle for a side of `side` pixels.
/// The rectangle is centred on the target, to half a pixel.
pub fn guard_origin(side: u32) -> i32 {
    // `side` is at most TARGET_MAX, so neither conversion nor sum can fail.
    -((GUARD - side.cast_signed()) / 2)
}

/// Homogeneous pixels from clip space: the viewport as a matrix.
pub fn viewport(size: Size) -> Matrix {
    let (w, h) = (f64::from(size.width) / 2.0, f64::from(size.height) / 2.0);
    Matrix {
        rows: [
            [w, 0.0, 0.0, w],
            [0.0, -h, 0.0, h],
            [0.0, 0.0, 1.0, 0.0],
            [0.0, 0.0, 0.0, 1.0],
        ],
    }
}

/// Stage `transform`: object space to homogeneous pixels, vertex by vertex.
///
/// With `T = Bounded` each component carries the bound of an `f32` evaluation
/// whose matrix entries were rounded to `f32` once.
pub fn transform<T: Real>(scene: &Scene) -> Vec<Position<T>> {
    let to_pixels = viewport(scene.size);
    let matrices: Vec<Matrix> = scene.instances.iter().map(|m| to_pixels.times(m)).collect();
    let apply = |v: &crate::scene::Vertex| {
        let m = &matrices[v.instance as usize];
        let [x, y, z] = v.position.map(f64::from);
        m.rows.map(|row| T::sum_of_products(row, [x, y, z, 1.0]))
    };
    scene.vertices.iter().map(apply).collect()
}

/// A half-space that clipping keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plane {
    /// Depth at least 0.
    Near,
    /// Depth at most 1.
    Far,
    /// At or right of the guard's left edge.
    Left(i32),
    /// At or left of the guard's right edge.
    Right(i32),
    /// At or below the guard's top edge.
    Top(i32),
    /// At or above the guard's bottom edge.
    Bottom(i32),
}

impl Plane {
    /// The six planes in the order in which polygons are cut. Near comes first:
    /// behind it `w` is positive and the others are meaningful.
    pub fn all(size: Size) -> [Self; 6] {
        let (x, y) = (guard_origin(size.width), guard_origin(size.height));
        [
            Self::Near,
            Self::Far,
            Self::Left(x),
            Self::Right(x + GUARD),
            Self::Top(y),
            Self::Bottom(y + GUARD),
        ]
    }

    /// Signed distance, up to a positive factor; kept where it is not negative.
    pub fn distance<T: Real>(self, [x, y, z, w]: Position<T>) -> T {
        let at = |edge: i32| T::exact(f64::from(edge)).mul(w);
        match self {
            Self::Near => z,
            Self::Far => w.sub(z),
            Self::Left(edge) => x.sub(at(edge)),
            Self::Right(edge) => at(edge).sub(x),
            Self::Top(edge) => y.sub(at(edge)),
            Self::Bottom(edge) => at(edge).sub(y),
        }
    }
}

/// Stage `clip`: cuts every triangle to the view's depth range and the guard
/// rectangle (Sutherland and Hodgman 1974).
///
/// An edge's new point is computed from its two ends in an order that does not
/// depend on the triangle, so that neighbours get the same point, to the bit.
pub fn clip<T: Real>(scene: &Scene, positions: &[Position<T>]) -> Polygons<T> {
    let planes = Plane::all(scene.size);
    let mut polygons = Polygons {
        offsets: vec![0],
        corners: Vec::new(),
    };
    for triangle in &scene.triangles {
        let corners = triangle.vertices.map(|v| positions[v as usize]);
        let polygon = clip_triangle(&planes, corners, |_, plain| plain);
        polygons.corners.extend(polygon);
        polygons.offsets.push(row(polygons.corners.len()));
    }
    polygons
}

/// Clips one triangle; empty if nothing is left.
///
/// Every branch asks `decide`, with the number whose sign decides and with what
/// that sign says: whoever knows that an `f32` evaluation may see the other sign
/// can follow the other branch.
pub fn clip_triangle<T: Real>(
    planes: &[Plane; 6],
    corners: [Position<T>; 3],
    mut decide: impl FnMut(T, bool) -> bool,
) -> Vec<Position<T>> {
    let mut polygon = corners.to_vec();
    let mut sides = Vec::with_capacity(CORNERS_MAX);
    for plane in planes {
        sides.clear();
        sides.extend(polygon.iter().map(|p| {
            let distance = plane.distance(*p);
            let inside = decide(distance, distance.value() >= 0.0);
            Side { distance, inside }
        }));
        if sides.iter().any(|side| !side.inside) {
            polygon = cut(&polygon, &sides);
        }
    }
    // Fewer than three corners are left only of a triangle without area.
    let visible = polygon.len() >= 3 && polygon.iter().all(|p| decide(p[3], p[3].value() > 0.0));
    if visible { polygon } else { Vec::new() }
}

/// Where a corner lies with respect to a plane.
#[derive(Clone, Copy)]
struct Side<T> {
    distance: T,
    inside: bool,
}

fn cut<T: Real>(polygon: &[Position<T>], sides: &[Side<T>]) -> Vec<Position<T>> {
    let mut kept = Vec::with_capacity(CORNERS_MAX);
    for (i, (&a, &side_a)) in polygon.iter().zip(sides).enumerate() {
        let next = (i + 1) % polygon.len();
        let (b, side_b) = (polygon[next], sides[next]);
        if side_a.inside {
            kept.push(a);
        }
        if side_a.inside != side_b.inside {
            kept.push(canonical_crossing(a, side_a.distance, b, side_b.distance));
        }
    }
    kept
}

/// The same point whichever of two neighbours asks.
fn canonical_crossing<T: Real>(a: Position<T>, da: T, b: Position<T>, db: T) -> Position<T> {
    let (first, second) = if precedes(&a, &b) {
        ((a, da), (b, db))
    } else {
        ((b, db), (a, da))
    };
    let plain = crossing(first.0, first.1, second.0, second.1);
    // An f32 evaluation orders the ends alike if their first components, as far as
    // they may stray, leave no doubt; otherwise it may start from the other end.
    if a[0].certainly_differs(b[0]) {
        return plain;
    }
    let other = crossing(second.0, second.1, first.0, first.1);
    [0, 1, 2, 3].map(|i| plain[i].or(other[i]))
}

/// The point between `a` and `b` where the distance is zero.
fn crossing<T: Real>(a: Position<T>, da: T, b: Position<T>, db: T) -> Position<T> {
    let t = da.fraction(db);
    [0, 1, 2, 3].map(|i| a[i].add(t.mul(b[i].sub(a[i]))))
}

/// A total order of positions by their numbers alone.
fn precedes<T: Real>(a: &Position<T>, b: &Position<T>) -> bool {
    let mut order = std::cmp::Ordering::Equal;
    for (a, b) in a.iter().zip(b) {
        order = order.then_with(|| a.value().total_cmp(&b.value()));
    }
    order.is_lt()
}

/// A polygon's corner before rounding: x and y in sub-pixels, z in keys.
///
/// The key is not yet saturated; `floor` after saturation gives Appendix A's
/// integer.
pub fn grid_position<T: Real>([x, y, z, w]: Position<T>, bits: u32) -> [T; 3] {
    let scale = T::exact(f64::from(1_u32 << bits));
    [
        x.div(w).mul(scale),
        y.div(w).mul(scale),
        z.div(w).mul(T::exact(f64::from(DEPTH_ONE))),
    ]
}

/// Stage `snap`: corners to the integer grid, polygons to fans of triangles.
///
/// x and y round to the nearest sub-pixel, ties to even; z is truncated, as in
/// Appendix A, with depth 1 defined as [`DEPTH_ONE`] (the paper's
/// `0x7fffffff` rounds to 2^31 in `f32`, which overflows an `int`: erratum e5).
pub fn snap(scene: &Scene, polygons: &Polygons<f64>, bits: u32) -> Primitives {
    let origin = [
        guard_origin(scene.size.width),
        guard_origin(scene.size.height),
    ];
    let round = |p: &Position<f64>| {
        let [x, y, z] = grid_position(*p, bits);
        let x = clamp(
            x.round_ties_even(),
            origin[0] << bits,
            (origin[0] + GUARD) << bits,
        );
        let y = clamp(
            y.round_ties_even(),
            origin[1] << bits,
            (origin[1] + GUARD) << bits,
        );
        [x, y, clamp(z.floor(), 0, DEPTH_ONE)]
    };
    let mut primitives = Primitives {
        size: scene.size,
        bits,
        snapped: polygons.corners.iter().map(round).collect(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    for (t, range) in polygons.offsets.windows(2).enumerate() {
        for corner in range[0] + 2..range[1] {
            primitives.prims.push([range[0], corner - 1, corner]);
            primitives.source.push(row(t));
        }
    }
    primitives
}

/// Transform, clip and snap in one go.
pub fn primitives(scene: &Scene, bits: u32) -> Primitives {
    snap(scene, &clip(scene, &transform(scene)), bits)
}

/// A whole number inside a range as an integer. Clipping in `f64` can miss the
/// guard by a rounding error; clamping undoes that.
fn clamp(value: f64, low: i32, high: i32) -> i32 {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "clamped to the range of i32"
    )]
    let value = value.clamp(f64::from(low), f64::from(high)) as i32;
    value
}

/// A row number; scenes are limited to fewer than 2^32 corners when loaded.
fn row(n: usize) -> u32 {
    u32::try_from(n).expect("a scene has fewer than 2^32 corners")
}
