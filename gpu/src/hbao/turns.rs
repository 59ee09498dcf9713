//! Which slices a pixel has, and where in them its samples are.

use std::f64::consts::PI;

/// Side of the tile of pixels that have different slices.
pub const TURNED: u32 = 4;

/// The order of a tile's pixels: neighbours are far apart (Bayer 1973).
const ORDER: [u32; 16] = [0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5];

/// The part of 1 by which a pixel's next slice is shifted, that of the golden ratio: however many
/// there are, they stay apart.
const SHIFT: f64 = 0.618_033_988_749_894_9;

/// For each pixel of a tile its slices: cosine and sine of their direction, where within its part
/// of the way each step is, from 0 to 1, and 0. The slices of a tile are all multiples of
/// `pi / (16 slices)`, each once, so that a tile's mean has 16 times as many; where the steps
/// are has the bits of the pixel's order reversed, so that both together are evenly spread.
pub fn turns(slices: u32) -> Vec<[f32; 4]> {
    let all = directions(16 * slices);
    let turn = |pixel: usize, slice: u32| {
        let order = ORDER[pixel];
        let [c, s] = all[(16 * slice + order) as usize];
        let reversed = order.reverse_bits() >> 28;
        let place = (f64::from(reversed) + 0.5) / 16.0 + f64::from(slice) * SHIFT;
        #[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
        [c as f32, s as f32, place.fract() as f32, 0.0]
    };
    let pixels = 0..ORDER.len();
    pixels
        .flat_map(|pixel| (0..slices).map(move |slice| turn(pixel, slice)))
        .collect()
}

/// Cosine and sine of the first `count` multiples of `pi / count`, `count` at least 16: the first
/// by its series, the others by turning on. The same on every platform, within `count` roundings.
fn directions(count: u32) -> Vec<[f64; 2]> {
    let step = PI / f64::from(count);
    let square = step * step;
    // At most pi / 16: the ninth term is below 2^-70.
    let series = |first: u32| {
        let factor = |n: u32| square / f64::from((first + 2 * n) * (first + 2 * n - 1));
        (1..=8).rev().fold(1.0, |all, n| 1.0 - factor(n) * all)
    };
    let [c, s] = [series(0), step * series(1)];
    let mut at = [1.0, 0.0];
    (0..count)
        .map(|_| {
            let now = at;
            at = [now[0] * c - now[1] * s, now[1] * c + now[0] * s];
            now
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slices_of_a_tile_are_evenly_spread() {
        for slices in [1_u32, 3, 64] {
            let turns = turns(slices);
            let mut angles: Vec<f64> = turns
                .iter()
                .map(|[c, s, ..]| f64::from(*s).atan2(f64::from(*c)))
                .collect();
            angles.sort_by(f64::total_cmp);
            let step = PI / f64::from(16 * slices);
            for (number, angle) in (0..).zip(angles) {
                let must = f64::from(number) * step;
                // Both numbers of a direction were rounded to 24 bits.
                assert!((angle - must).abs() < 1e-7, "{number} of {slices}: {angle}");
            }
            for slice in 0..slices as usize {
                let own = turns.iter().skip(slice).step_by(slices as usize);
                let mut places: Vec<f32> = own.map(|turn| turn[2]).collect();
                places.sort_by(f32::total_cmp);
                assert!(places[0] >= 0.0 && places[15] < 1.0, "{places:?}");
                let apart = places.windows(2).map(|two| two[1] - two[0]);
                assert!(
                    apart.map(|by| (by - 0.0625).abs()).all(|off| off < 1e-6),
                    "slice {slice}: {places:?}"
                );
            }
        }
    }
}
