//! Which samples a polygon must cover, may cover and must not, where its corners are
//! known up to a reach.
//!
//! Let P be a convex polygon on the screen, and let whoever rasterises it put each of its
//! corners (and any that it adds on a side, where it clips) at most `r` away in x and in
//! y, and rasterise exactly from there. Its polygon Q may be anything of that kind.
//!
//! **Must not.** Q lies in the convex hull of its corners, hence in P plus a square of
//! half side `r` (Minkowski). For convex polygons that sum is cut out by the normals of
//! both: `E >= -r (|dx| + |dy|)` with `d` a side's direction and E its edge function, and
//! the bounding box wider by `r`.
//!
//! **Must.** Move the boundary of P linearly into that of Q. A point of a side is a convex
//! combination of the side's ends, and so is its way, so no point of the boundary moves by
//! more than `r` in x or y. A sample in P that is farther than that from P's boundary is
//! never crossed: Q winds around it once, as P does. So it is covered, by exactly one
//! triangle of any fan that makes up Q, and not on an outer edge, where fill rules matter.
//! In P the distance from the boundary is the least of those from the sides' lines, so
//! the condition is `E > r (|dx| + |dy|)` for all sides.
//!
//! Both are decided in integers, of 2^-16 pixels. Rounding a corner to these moves it by
//! less than a unit, and `r` is two units larger for it. For the same reason P is taken to be
//! the convex hull of the rounded corners. P is clipped to the guard rectangle, whose
//! sides are 1,024 pixels or more from any sample: who clips farther out, or not at all,
//! has the same polygon within `r` of the target as long as `r` is less than that.

use std::ops::Range;

use triptych_spec::scene::Size;
use triptych_spec::vertex::GUARD;

/// Bits of a pixel.
const UNIT_BITS: u32 = 16;

/// Half a pixel, where samples lie.
const HALF: i64 = 1 << (UNIT_BITS - 1);

/// Larger reaches are not judged: far less than what lies between target and guard.
pub const REACH_MAX: f64 = 32.0;

/// A polygon and how far its corners may be off.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Region {
    /// Convex, positive orientation, no three corners on a line; in units.
    hull: Vec<[i64; 2]>,
    low: [i64; 2],
    high: [i64; 2],
    reach: i64,
}

/// Columns of a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Columns {
    /// Those that may be covered. Others must not be.
    pub may: Range<u32>,
    /// Of these, those that must be.
    pub must: Range<u32>,
    /// The lengths in pixels of both parts of the row's line of samples.
    pub lengths: [f64; 2],
}

impl Columns {
    /// Whether a sample is neither.
    pub fn is_open(&self, column: u32) -> bool {
        self.may.contains(&column) && !self.must.contains(&column)
    }
}

impl Region {
    /// The region of a polygon with these corners, in pixels, each at most `reach` pixels
    /// off in x and in y. `None` without corners, and where nothing can be said: reaches
    /// beyond [`REACH_MAX`], and corners outside any guard rectangle.
    pub fn new(corners: &[[f64; 2]], reach: f64) -> Option<Self> {
        let judged = |c: &f64| c.abs() <= f64::from(GUARD);
        let known = reach <= REACH_MAX && corners.iter().flatten().all(judged);
        if corners.is_empty() || !known {
            return None;
        }
        #[expect(clippy::cast_possible_truncation, reason = "below 2^30")]
        let unit = |v: f64| (v * f64::from(1_u32 << UNIT_BITS)).round() as i64;
        let hull = hull(corners.iter().map(|c| c.map(unit)).collect());
        let of = |axis: usize| hull.iter().map(move |c| c[axis]);
        let (low, high) = ([0, 1].map(|a| of(a).min()), [0, 1].map(|a| of(a).max()));
        Some(Self {
            low: low.map(|v| v.expect("a corner")),
            high: high.map(|v| v.expect("a corner")),
            reach: unit(reach.max(0.0)) + 2,
            hull,
        })
    }

    /// Rows of the target with a sample that may be covered.
    pub fn rows(&self, size: Size) -> Range<u32> {
        let mut rows = Sides::new(size.height);
        rows.require(HALF - (self.low[1] - self.reach), 1 << UNIT_BITS);
        rows.require(self.high[1] + self.reach - HALF, -(1 << UNIT_BITS));
        rows.range()
    }

    /// What may and must be covered of a row.
    pub fn columns(&self, row: u32, size: Size) -> Columns {
        let y = (i64::from(row) << UNIT_BITS) + HALF;
        if !(self.low[1] - self.reach..=self.high[1] + self.reach).contains(&y) {
            return Columns::default();
        }
        let (mut may, mut must) = (Sides::new(size.width), Sides::new(size.width));
        if self.hull.len() < 3 {
            must = Sides::new(0);
        }
        let step = 1 << UNIT_BITS;
        may.require(HALF - (self.low[0] - self.reach), step);
        may.require(self.high[0] + self.reach - HALF, -step);
        for (a, b) in self.sides() {
            let d = [b[0] - a[0], b[1] - a[1]];
            let edge = d[0] * (y - a[1]) - d[1] * (HALF - a[0]);
            let widened = self.reach * (d[0].abs() + d[1].abs());
            may.require(edge + widened, -d[1] * step);
            must.require(edge - widened - 1, -d[1] * step);
        }
        Columns {
            may: may.range(),
            must: must.range(),
            lengths: [may.length(), must.length()],
        }
    }

    fn sides(&self) -> impl Iterator<Item = ([i64; 2], [i64; 2])> {
        let next = self.hull.iter().cycle().skip(1);
        self.hull.iter().copied().zip(next.copied())
    }
}

/// The numbers from 0 to below a limit that conditions leave.
struct Sides {
    start: i64,
    end: i64,
    /// The real numbers, from half a step before the first.
    real: [f64; 2],
}

impl Sides {
    fn new(limit: u32) -> Self {
        Self {
            start: 0,
            end: i64::from(limit),
            real: [-0.5, f64::from(limit) - 0.5],
        }
    }

    /// Requires `at + n step >= 0`.
    fn require(&mut self, at: i64, step: i64) {
        let zero = -(at as f64) / step as f64;
        match step.signum() {
            1 => {
                self.start = self.start.max(-at.div_euclid(step));
                self.real[0] = self.real[0].max(zero);
            }
            -1 => {
                self.end = self.end.min(at.div_euclid(-step) + 1);
                self.real[1] = self.real[1].min(zero);
            }
            _ if at < 0 => (self.end, self.real[1]) = (0, f64::NEG_INFINITY),
            _ => {}
        }
    }

    fn range(&self) -> Range<u32> {
        let whole = |n: i64| u32::try_from(n).expect("within the target");
        let end = self.end.max(0);
        whole(self.start.min(end))..whole(end)
    }

    fn length(&self) -> f64 {
        (self.real[1] - self.real[0]).max(0.0)
    }
}

/// The convex hull (Andrew 1979): positive orientation, no three corners on a line.
fn hull(mut points: Vec<[i64; 2]>) -> Vec<[i64; 2]> {
    points.sort_unstable();
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let chain = |points: &mut dyn Iterator<Item = [i64; 2]>| {
        let mut chain: Vec<[i64; 2]> = Vec::new();
        for p in points {
            while let [.., a, b] = chain[..] {
                if turn(a, b, p) > 0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut lower = chain(&mut points.iter().copied());
    lower.extend(chain(&mut points.iter().rev().copied()));
    lower
}

/// Twice the area of a triangle. Coordinates are below 2^29, so it is below 2^62.
fn turn(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests;
