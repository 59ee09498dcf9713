//! Whether a pixel's list has a key of a triangle, and which.
//!
//! The spec rounds corners to sub-pixels: with `a` a corner as it is drawn, relative to the
//! pixel's middle, the corner itself is at `a + e`, where `e` is at most 1/2 in each coordinate.
//! The ray is at `r` from the middle, at most `s` in each coordinate ([`super::ray`]). So
//!
//! ```text
//! cross(a + e - r, b + f - r) = cross(a, b) + cross(a, f) + cross(e, b) + cross(e, f)
//!                               - cross(r, b - a + f - e)
//! ```
//!
//! is off from the edge function that decides coverage by at most
//! `(|a| + |b| + 1) / 2 + s (|b - a| + 2)`, with `|x|` the sum of the sizes of both coordinates.
//! Where all three are beyond that on one side of 0, triangle and drawing hold ray and middle;
//! where two are on different sides, neither does. Else it is open.
//!
//! **Keys.** The drawn key is that of weights `w` on corners as they are drawn, rounded down; so
//! it is the depth of the triangle's own plane at the middle, moved by the mean of the `e`, off by
//! half a key of rounded corners and one of rounding down. The ray meets that plane `r` from the
//! middle: between the two, at most `1/2 + s` in each coordinate, depth changes by the plane's
//! slope. Embree's time has its own bound. Wherever it is, a key is between those of the corners,
//! as the weights are those of a point inside.

use triptych_spec::grid::lattice::Point;

use super::lists::Interval;
use super::ray::{Projection, Through, Way};

/// Slack for `f64`: coordinates are below 2^18 sub-pixels, their products below 2^36 and exact to
/// 2^-16; and for what is left of the lattice's rounding, see [`Projection`].
const SLACK: f64 = 1.0 / 1024.0;

/// Whether the middle of a pixel is in a triangle as the spec draws it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Covers {
    Yes,
    No,
    Open,
}

/// A pixel and a triangle.
pub(super) struct Judged {
    /// Whether the list has its key.
    pub(super) covers: Covers,
    /// Keys of the corners as they are drawn: the least, and the largest.
    ends: [f64; 2],
    /// Column, row and key of the corners before they are rounded.
    corners: [[f64; 3]; 3],
}

impl Judged {
    /// `places` are the corners as the spec draws them.
    pub(super) fn new(
        projection: &Projection<'_>,
        through: &Through,
        corners: [Point; 3],
        places: [[i32; 3]; 3],
    ) -> Self {
        let from = places.map(|p| [0, 1].map(|i| f64::from(p[i]) - through.middle[i]));
        let edge = |j: usize, k: usize| {
            let (a, b): ([f64; 2], [f64; 2]) = (from[j], from[k]);
            let size = |v: [f64; 2]| v[0].abs() + v[1].abs();
            let way = [b[0] - a[0], b[1] - a[1]];
            let bound = (size(a) + size(b) + 1.0) / 2.0 + through.stray * (size(way) + 2.0);
            (a[0] * b[1] - a[1] * b[0], bound + SLACK)
        };
        let edges = [edge(1, 2), edge(2, 0), edge(0, 1)];
        let positive = |(e, bound): &(f64, f64)| *e > *bound;
        let negative = |(e, bound): &(f64, f64)| -*e > *bound;
        let covers = match () {
            () if edges.iter().all(positive) || edges.iter().all(negative) => Covers::Yes,
            () if edges.iter().any(positive) && edges.iter().any(negative) => Covers::No,
            () => Covers::Open,
        };
        let keys = places.map(|p| f64::from(p[2]));
        Self {
            covers,
            ends: [
                keys[0].min(keys[1]).min(keys[2]),
                keys[0].max(keys[1]).max(keys[2]),
            ],
            corners: corners.map(|corner| projection.place(corner)),
        }
    }

    /// Where a key may be, if there is one at all.
    pub(super) fn range(&self) -> Interval {
        Interval {
            low: self.ends[0] - 1.0,
            high: self.ends[1] + 1.0,
            must: false,
        }
    }

    /// Where the key must be that is seen at a time, which is off by `bound` at most.
    pub(super) fn interval(&self, stray: f64, way: &Way, time: f64, bound: f64) -> Interval {
        let [a, b, c] = self.corners;
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|i| p[i] - a[i]));
        let area = u[0] * v[1] - u[1] * v[0];
        let slope = [
            (u[2] * v[1] - v[2] * u[1]) / area,
            (v[2] * u[0] - u[2] * v[0]) / area,
        ];
        let steepness = slope[0].abs() + slope[1].abs();
        let off = bound * way.keys.abs() + steepness * (0.5 + stray + SLACK) + 1.5 + SLACK;
        // What places of 2^-25 do to the slope of a triangle of an area of 1, and more.
        let off = off * (1.0 + SLACK);
        let key = way.key + time * way.keys;
        let range = self.range();
        // A slope that is no number leaves the range.
        Interval {
            low: range.low.max(key - off),
            high: range.high.min(key + off),
            must: true,
        }
    }
}
