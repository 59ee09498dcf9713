//! Raster stage: which samples a triangle covers, and the depth key there.
//!
//! Integer edge functions with the top-left rule (Pineda 1988), depth as the floor
//! of an exact rational number. With the guard rectangle of 2^12 pixels and at
//! most 8 sub-pixel bits, coordinates span L = 2^20. An edge and a sample, also one
//! outside the triangle, are corners of a triangle within that square, which has at
//! most half its area: an edge function is at most L^2 = 2^40 in size. Where none is
//! negative their sum is the area, so depth numerators stay below 2^71. `i64` and
//! `i128` hold them. Twin: `gpu/src/raster.wgsl`.

mod count;
mod depth;
mod multisample;
mod samples;

use crate::scene::Size;
use crate::vertex::Primitives;
pub use count::{count, count_run, rows_between};
use depth::Depth;
pub use multisample::sample_nodes;
pub use samples::{SAMPLES_MAX, Samples, samples_of};

/// One covered pixel of one triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fragment {
    /// Row-major number of the pixel.
    pub pixel: u32,
    /// Row in [`Primitives::prims`].
    pub prim: u32,
    /// 31-bit depth key at the lowest covered sample.
    pub key: u32,
    /// Covered samples, one bit each.
    pub mask: u32,
}

/// A triangle prepared for evaluation: corners in positive orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    corners: [[i64; 3]; 3],
    /// Twice the area in square sub-pixels; positive.
    pub area: i64,
}

/// Columns `start..end` of a row.
pub type Span = std::ops::Range<u32>;

impl Setup {
    /// Prepares row `prim`. `None` if the triangle has no area on the grid: by rule
    /// it covers nothing.
    pub fn new(primitives: &Primitives, prim: u32) -> Option<Self> {
        let [a, b, c] = primitives.prims[prim as usize]
            .map(|corner| primitives.snapped[corner as usize].map(i64::from));
        let area = edge(a, b, [c[0], c[1]]);
        match area.signum() {
            1 => Some(Self {
                corners: [a, b, c],
                area,
            }),
            -1 => Some(Self {
                corners: [a, c, b],
                area: -area,
            }),
            _ => None,
        }
    }

    /// The three edge functions at a point in sub-pixels; their sum is the area.
    /// Entry `i` belongs to the edge opposite corner `i`.
    pub fn edges(&self, point: [i64; 2]) -> [i64; 3] {
        [0, 1, 2].map(|i| {
            let (a, b) = self.edge_ends(i);
            edge(a, b, point)
        })
    }

    /// Whether a sample with these edge values belongs to the triangle: inside, or
    /// on a top or left edge.
    pub fn covers(&self, edges: [i64; 3]) -> bool {
        (0..3).all(|i| edges[i] >= self.least(i))
    }

    /// Depth key: `floor(sum(E_i Z_i) / area)`, exact. Meaningful at covered
    /// samples, where it lies between the corners' keys.
    pub fn key(&self, edges: [i64; 3]) -> u32 {
        self.depth(edges).key()
    }

    /// The same with the rest of its division.
    fn depth(&self, edges: [i64; 3]) -> Depth {
        let numerator: i128 = (0..3)
            .map(|i| i128::from(edges[i]) * i128::from(self.corners[i][2]))
            .sum();
        let area = i128::from(self.area);
        // The same quotient, faster where 64 bits hold the numerator.
        let (quotient, rest) = match i64::try_from(numerator) {
            Ok(small) => (small.div_euclid(self.area), small.rem_euclid(self.area)),
            Err(_) => {
                let small = |n: i128| i64::try_from(n).expect("a key, or less than the area");
                (
                    small(numerator.div_euclid(area)),
                    small(numerator.rem_euclid(area)),
                )
            }
        };
        Depth { quotient, rest }
    }

    /// Whether a sample is covered and has this depth.
    fn holds(&self, depth: Depth, point: [i64; 2]) -> bool {
        let edges = self.edges(point);
        self.covers(edges) && self.key(edges) == depth.key()
    }

    /// The change of the edge functions from one column to the next.
    fn edge_steps(&self, bits: u32) -> [i64; 3] {
        [0, 1, 2].map(|i| {
            let (a, b) = self.edge_ends(i);
            (a[1] - b[1]) << bits
        })
    }

    /// The change of [`Setup::depth`] from one column to the next. Steps of edges are
    /// below 2^28, or 2^30 at a reduced resolution, and keys below 2^31, so 64 bits hold the sum.
    fn depth_step(&self, bits: u32) -> Depth {
        let steps = self.edge_steps(bits);
        let numerator: i64 = (0..3).map(|i| steps[i] * self.corners[i][2]).sum();
        Depth {
            quotient: numerator.div_euclid(self.area),
            rest: numerator.rem_euclid(self.area),
        }
    }

    /// Smallest value of edge function `i` at a covered sample: 0 on a top or left
    /// edge, else 1. With y down and positive orientation, a left edge goes up and
    /// a top edge goes right.
    pub(crate) fn least(&self, i: usize) -> i64 {
        let (a, b) = self.edge_ends(i);
        let top_left = b[1] < a[1] || (b[1] == a[1] && b[0] > a[0]);
        i64::from(!top_left)
    }

    /// Ends of the edge opposite corner `i`, in positive orientation.
    fn edge_ends(&self, i: usize) -> ([i64; 3], [i64; 3]) {
        (self.corners[(i + 1) % 3], self.corners[(i + 2) % 3])
    }

    /// Rows of the target whose samples may be covered.
    pub fn rows(&self, size: Size, bits: u32) -> Span {
        let y = self.corners.map(|c| c[1]);
        let (low, high) = (y[0].min(y[1]).min(y[2]), y[0].max(y[1]).max(y[2]));
        first_sample(low, bits, size.height)..first_sample(high + 1, bits, size.height)
    }

    /// Columns whose samples lie in the triangle's width.
    pub fn columns(&self, size: Size, bits: u32) -> Span {
        let x = self.corners.map(|c| c[0]);
        let (low, high) = (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        first_sample(low, bits, size.width)..first_sample(high + 1, bits, size.width)
    }

    /// The covered columns of a row: a triangle is convex, so they are one span.
    /// Each edge function is linear in the column, which gives a bound a piece.
    pub fn span(&self, row: u32, size: Size, bits: u32) -> Span {
        self.span_above([0, 1, 2].map(|i| self.least(i)), row, size, bits)
    }

    /// The columns of a row where edge function `i` is at least `least[i]`.
    pub fn span_above(&self, least: [i64; 3], row: u32, size: Size, bits: u32) -> Span {
        self.span_from(least, [sample(0, bits), sample(row, bits)], size, bits)
    }

    /// The columns where edge function `i` is at least `least[i]`, at samples of which column
    /// 0 has its at `origin`.
    fn span_from(&self, least: [i64; 3], origin: [i64; 2], size: Size, bits: u32) -> Span {
        let origin = self.edges(origin);
        let steps = self.edge_steps(bits);
        let (mut start, mut end) = (0, i64::from(size.width));
        for i in 0..3 {
            let step = steps[i];
            let missing = least[i] - origin[i];
            match step.signum() {
                1 => start = start.max(div_ceil(missing, step)),
                -1 => end = end.min((-missing).div_euclid(-step) + 1),
                _ if missing > 0 => end = 0,
                _ => {}
            }
        }
        let end = end.max(0);
        column(start.min(end))..column(end)
    }
}

/// Stage `cover`: every fragment of every triangle, in order of triangle, row and
/// column. A pixel is covered if any of its samples is; its key is that at the lowest covered
/// sample, which section 4.1.2 calls the centroid.
pub fn cover(primitives: &Primitives, emit: impl FnMut(Fragment)) {
    cover_only(primitives, |_| true, emit);
}

/// [`cover`] for the triangles that `select` picks.
pub fn cover_only(
    primitives: &Primitives,
    select: impl Fn(u32) -> bool,
    mut emit: impl FnMut(Fragment),
) {
    let (size, bits) = (primitives.size, primitives.bits);
    let all = 0..column(primitives.prims.len() as i64);
    let reaches = |prim: &u32| !rows_between(primitives, *prim).is_empty();
    for prim in all.filter(|prim| reaches(prim) && select(*prim)) {
        let Some(setup) = Setup::new(primitives, prim) else {
            continue;
        };
        if primitives.samples.count() > 1 {
            setup.fragments(prim, primitives, &mut emit);
            continue;
        }
        // Many triangles of a fine mesh lie between two columns.
        if setup.columns(size, bits).is_empty() {
            continue;
        }
        let mut step = None;
        for row in setup.rows(size, bits) {
            let span = setup.span(row, size, bits);
            if span.is_empty() {
                continue;
            }
            // One division a row; from there quotient and rest are stepped.
            let first = setup.edges([sample(span.start, bits), sample(row, bits)]);
            let mut depth = setup.depth(first);
            let end = span.end;
            for x in span {
                debug_assert!(
                    setup.holds(depth, [sample(x, bits), sample(row, bits)]),
                    "a span holds covered samples only, with their keys"
                );
                emit(Fragment {
                    pixel: row * size.width + x,
                    prim,
                    key: depth.key(),
                    mask: 1,
                });
                if x + 1 < end {
                    // Most triangles of a fine mesh never need it.
                    let step = *step.get_or_insert_with(|| setup.depth_step(bits));
                    depth = depth.plus(step, setup.area);
                }
            }
        }
    }
}

/// Where the middle of a column (row), its only sample if it has one, lies in sub-pixels.
pub fn sample(pixel: u32, bits: u32) -> i64 {
    (i64::from(pixel) << bits) + (1 << (bits - 1))
}

/// Twice the signed area of `a`, `b`, `point`; positive on the right of the way
/// from `a` to `b` with y down.
fn edge(a: [i64; 3], b: [i64; 3], [x, y]: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
}

/// The first pixel whose sample lies at or after a coordinate, within the target.
fn first_sample(coordinate: i64, bits: u32, side: u32) -> u32 {
    first_pixel(coordinate, 1 << (bits - 1), bits, side)
}

/// The same of samples that lie `offset` after the beginning of their pixels.
fn first_pixel(coordinate: i64, offset: i64, bits: u32, side: u32) -> u32 {
    let pixel = -((offset - coordinate) >> bits);
    column(pixel.clamp(0, i64::from(side)))
}

fn div_ceil(numerator: i64, denominator: i64) -> i64 {
    -(-numerator).div_euclid(denominator)
}

/// A count or column as `u32`; callers have clamped it to a target's side or to
/// the number of rows of a scene, both below 2^32.
fn column(n: i64) -> u32 {
    u32::try_from(n).expect("within the target")
}
