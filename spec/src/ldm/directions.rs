//! Directions: the upper half of a partition of the sphere into regions of equal area.

use std::f64::consts::PI;

use super::{LdmError, within};

/// Most directions of a set.
pub const DIRECTIONS_MAX: u32 = 4096;

/// A ring of regions, or a polar cap, which is one region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    /// Angle from the pole at which it begins, in radians.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// Regions, all of them as wide.
    pub regions: u32,
    /// By which part of a turn the ring is turned.
    pub turn: f64,
}

/// The recursive zonal equal-area partition EQ(2, `regions`) of the sphere (Leopardi 2006,
/// section 3; paper section 3.2): two caps, and rings between them that are about as high as a
/// region is wide. Every region has the area 4 pi / `regions`. Rings are turned against each
/// other as in his `eq_point_set`, so that centres of neighbours are apart.
pub fn zones(regions: u32) -> Vec<Zone> {
    let total = f64::from(regions);
    if regions < 2 {
        return vec![Zone {
            from: 0.0,
            to: PI,
            regions,
            turn: 0.0,
        }];
    }
    let counts = counts(regions);
    let mut turn = 0.0;
    let mut before = 0;
    let mut zones = Vec::with_capacity(counts.len());
    for (at, &count) in counts.iter().enumerate() {
        let from = cap(f64::from(before) / total);
        before += count;
        zones.push(Zone {
            from,
            to: cap(f64::from(before) / total),
            regions: count,
            turn,
        });
        // The first ring is not turned.
        if at > 0 && at + 1 < counts.len() {
            turn += offset(count, counts[at + 1]);
            turn -= libm::floor(turn);
        }
    }
    zones
}

/// Regions of each zone, from pole to pole: the ideal numbers, rounded so that what one ring
/// loses the next gains.
fn counts(regions: u32) -> Vec<u32> {
    let total = f64::from(regions);
    let first = cap(1.0 / total);
    let side = libm::sqrt(4.0 * PI / total);
    let height = PI - 2.0 * first;
    let rings = match regions {
        2 => 0.0,
        _ => libm::round(height / side).max(1.0),
    };
    let mut counts = vec![1];
    let mut missing = 0.0;
    let mut ring = 0.0;
    while ring < rings {
        let part = |n: f64| {
            let half = (first + n * height / rings) / 2.0;
            libm::sin(half) * libm::sin(half)
        };
        let ideal = total * (part(ring + 1.0) - part(ring));
        let count = libm::round(ideal + missing);
        missing += ideal - count;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a positive integer of at most 2^13"
        )]
        counts.push(count as u32);
        ring += 1.0;
    }
    counts.push(1);
    counts
}

/// The angle of a polar cap that holds this part of the sphere.
fn cap(part: f64) -> f64 {
    2.0 * libm::asin(libm::sqrt(part.min(1.0)))
}

/// By how much of a turn a ring is turned against the one above it, so that the smallest angle
/// between centres of both is as large as can be.
fn offset(above: u32, below: u32) -> f64 {
    let [a, b] = [above, below].map(f64::from);
    (1.0 / b - 1.0 / a) / 2.0 + f64::from(gcd(above, below)) / (2.0 * a * b)
}

fn gcd(a: u32, b: u32) -> u32 {
    match b {
        0 => a,
        _ => gcd(b, a % b),
    }
}

/// `n` directions: the centres of the upper half of EQ(2, 2 n). The ring on the equator, which
/// any n from 2 on has an even number of regions in if it has one, gives half of its centres:
/// the others are their antipodes, and a map serves both ([`super::neighbours`]).
///
/// The number of regions of a pair of antipodal zones is the same for all n up to
/// [`DIRECTIONS_MAX`], which a law shows.
///
/// # Errors
/// `n` is 0, or above [`DIRECTIONS_MAX`].
pub fn directions(n: u32) -> Result<Vec<[f64; 3]>, LdmError> {
    within(
        "the number of directions",
        n.into(),
        1,
        DIRECTIONS_MAX.into(),
    )?;
    let zones = zones(2 * n);
    let middle = zones.len() / 2;
    let mut all = Vec::with_capacity(n as usize);
    for (at, zone) in zones.iter().enumerate() {
        let on_equator = at == middle && zones.len() % 2 == 1;
        let count = match (at < middle, on_equator) {
            (true, _) => zone.regions,
            (_, true) => zone.regions / 2,
            _ => 0,
        };
        all.extend((0..count).map(|region| centre(zone, at == 0, on_equator, region)));
    }
    Ok(all)
}

/// The middle of a region; of a cap, the pole.
fn centre(zone: &Zone, is_cap: bool, on_equator: bool, region: u32) -> [f64; 3] {
    if is_cap {
        return [0.0, 0.0, 1.0];
    }
    let around = (f64::from(region) + 0.5) / f64::from(zone.regions) + zone.turn;
    let (sin, cos) = libm::sincos(2.0 * PI * around);
    let middle = f64::midpoint(zone.from, zone.to);
    // Exactly on the equator, whatever the rounding.
    let (out, up) = match on_equator {
        true => (1.0, 0.0),
        false => (libm::sin(middle), libm::cos(middle)),
    };
    [out * cos, out * sin, up]
}
