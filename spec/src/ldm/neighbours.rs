//! Stage `neighbours`: what is before and behind a point along a direction.

use super::{Layers, Map, Maps};
use crate::grid::lattice::Point;

/// Farthest that a point may be said to be from its surface, in steps: the band of its own layers
/// has 32 bits.
pub const OFF_MAX: u32 = 1 << 18;

/// A point that asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Receiver {
    /// On the lattice.
    pub point: Point,
    /// Normal of its surface at length 2^14, as [`crate::rsm::Face::coarse`] has it, to the side
    /// that it is seen from. Zero for a point that is on no surface, which has no layers of its
    /// own but those at its depth.
    pub normal: Point,
    /// How far the point may be from its surface, in steps along each axis; at most [`OFF_MAX`].
    pub off: u32,
}

/// What a trace finds, in both directions of a map.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hits {
    /// The point's own key.
    pub key: i32,
    /// The first key before it, to whom the map is seen by: along the map's direction.
    pub before: Option<u32>,
    /// The first key behind it: along the opposite direction.
    pub behind: Option<u32>,
}

/// Stage `neighbours` (paper section 3.1 and Figure 4), in both directions at once: find the pixel,
/// find the point's own layers, take the neighbours.
///
/// Layers whose keys are within [`own_band`] of the point's are its own surface's. A point
/// beside the map sees nothing: of those that the map is for ([`Maps::new`]), only what is beside
/// the scene is beside it, where there is nothing. The list that it finds is that of the pixel it
/// is in, `[x, x + 1)` of each side, whatever the distance from the pixel's middle.
pub fn neighbours(maps: &Maps, map: &Map, layers: &Layers, receiver: &Receiver) -> Hits {
    let [x, y, key] = maps.place(map, receiver.point);
    let mut hits = Hits {
        key,
        ..Hits::default()
    };
    let [column, row] = [x >> maps.bits, y >> maps.bits];
    let within = |at: i32, end: u32| u32::try_from(at).ok().filter(|at| *at < end);
    let at = within(column, map.size.width).zip(within(row, map.size.height));
    let Some((column, row)) = at else {
        return hits;
    };
    let list = layers.list(map.first + row * map.size.width + column);
    let band = own_band(maps, map, receiver);
    let before = list.partition_point(|own| own.cast_signed() < key - band);
    let behind = list.partition_point(|own| own.cast_signed() <= key + band);
    hits.before = before.checked_sub(1).map(|at| list[at]);
    hits.behind = list.get(behind).copied();
    hits
}

/// Largest slope of a surface in a map that is told apart, in keys a key; what is steeper is
/// taken for this steep.
const SLOPE_MAX: u32 = 127;

/// How far the keys of a point's own surface may be from its own: depth changes by the slope of
/// the surface in the map, `|dz/dx| + |dz/dy|`, times half a pixel. To that come the roundings
/// of keys, one and a half, and what the point is off its surface: as much as along the longest
/// diagonal in depth, and across the map as much again times the slope, since the surface is
/// looked for where the point is, not where it came from.
///
/// Integers throughout. The coarse normal `n` and the map's unit vectors are each off by half in
/// every component, so a dot product of theirs by less than
/// `sqrt(3) / 2 * 2^14 * 2 + 1 < 28,380`, by which the numerator is raised and the denominator
/// lowered; both lose 8 bits, so that the slope with 8 bits behind the point fits in 32.
pub fn own_band(maps: &Maps, map: &Map, receiver: &Receiver) -> i32 {
    const OFF: u32 = 28_380;
    // 14 keys a step is more than 8 * sqrt(3), of `KEYS_PER_STEP`: at most 2^22.
    let moved = receiver.off * 14;
    if receiver.normal == [0; 3] {
        return moved.cast_signed() + 3;
    }
    let along = map
        .planes
        .map(|axis| dot(axis, receiver.normal).unsigned_abs());
    let numerator = (along[0] + along[1] + 2 * OFF).div_ceil(256);
    let denominator = along[2].saturating_sub(OFF) / 256;
    let steepest = 256 * SLOPE_MAX;
    let slope = match denominator {
        0 => steepest,
        _ => (256 * numerator).div_ceil(denominator).min(steepest),
    };
    // At most 2^15 times 2^16; beyond 2^30 a band holds everything.
    let within_pixel = ((slope * maps.half) >> (8 - maps.half_shift)).min(1 << 30);
    // The product may have 37 bits, so that the slope's are taken apart: at most 2^29.
    let aside = moved * (slope >> 8) + ((moved * (slope & 255)) >> 8);
    (moved + within_pixel + aside).cast_signed() + 5
}

/// At most 2^28 and a little: by Cauchy and Schwarz.
pub(super) fn dot(a: Point, b: Point) -> i32 {
    (0..3).map(|i| a[i] * b[i]).sum()
}
