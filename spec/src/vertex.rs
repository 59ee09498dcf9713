//! Vertex stages: transform, clip, snap.
//!
//! World-space triangles become triangles on an integer grid: x and y in
//! sub-pixels, z on Appendix A's 31-bit depth scale (Yang et al. 2010). All
//! rounding of positions happens here, once; every later decision is integer
//! arithmetic on the result. Twin: `gpu/src/vertex.wgsl`.

mod clip;

use crate::bound::Real;
use crate::matrix::Matrix;
use crate::raster::Samples;
use crate::scene::{Scene, Size, Vertex};

pub use clip::{Plane, clip, clip_run, clip_triangle};

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
    /// The samples of every pixel.
    pub samples: Samples,
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
    transform_run(&to_pixels(scene), &scene.vertices)
}

/// Homogeneous pixels from the object space of each instance.
pub fn to_pixels(scene: &Scene) -> Vec<Matrix> {
    let viewport = viewport(scene.size);
    scene.instances.iter().map(|m| viewport.times(m)).collect()
}

/// [`transform`] of some of a scene's vertices, with all of its matrices ([`to_pixels`]).
pub fn transform_run<T: Real>(matrices: &[Matrix], vertices: &[Vertex]) -> Vec<Position<T>> {
    let apply = |v: &Vertex| {
        let m = &matrices[v.instance as usize];
        let [x, y, z] = v.position.map(f64::from);
        m.rows.map(|row| T::sum_of_products(row, [x, y, z, 1.0]))
    };
    vertices.iter().map(apply).collect()
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
///
/// Rounding moves a corner by up to half a sub-pixel. As it may turn a sliver over, so
/// it may turn a corner of a cut polygon inwards, between edges that are nearly
/// parallel or as short as a sub-pixel; the fan's triangles then overlap by as much.
/// By rule every leg draws the fan as it is.
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
        samples: scene.samples,
        snapped: polygons.corners.iter().map(round).collect(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    for (triangle, range) in polygons.offsets.windows(2).enumerate() {
        for corner in range[0] + 2..range[1] {
            primitives.prims.push([range[0], corner - 1, corner]);
            primitives.source.push(row(triangle));
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
