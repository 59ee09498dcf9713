//! Nodes whose colours have a byte a channel.

use crate::abuffer::{NOTHING, Opaque, Sorted, average, visible};
use crate::bound::{Bounded, Real, Sum, TINY, U};
use crate::raster::Fragment;
use crate::scene::Scene;
use crate::vertex::Primitives;

/// How far the byte of a channel may be from 255 times the channel: half a step, and in `f32` the product
/// and the sum, which are at most 255.5 and within a unit each.
const BYTE_ERROR: f64 = 0.5 + 511.0 * U;

/// Whether a byte may stand for a channel, which is cut to 0 to 1.
pub fn rounds_to(channel: f32, byte: u32) -> bool {
    let exact = 255.0 * f64::from(channel.clamp(0.0, 1.0));
    (f64::from(byte) - exact).abs() <= BYTE_ERROR && byte <= 255
}

/// The bytes that may stand for a channel: two next to each other if it is half-way between, else one twice.
#[expect(clippy::cast_possible_truncation, reason = "0 to 255")]
#[expect(clippy::cast_sign_loss, reason = "0 to 255")]
fn bytes(channel: f32) -> [u32; 2] {
    let near = (255.0 * f64::from(channel.clamp(0.0, 1.0))).floor() as u32;
    match [near, near + 1].map(|byte| rounds_to(channel, byte)) {
        [true, true] => [near, near + 1],
        [false, _] => [near + 1; 2],
        [true, false] => [near; 2],
    }
}

/// A channel as it comes out of its byte, or of either: a quotient, which is within 2.5 units.
fn unpacked(channel: f32) -> Bounded {
    let [low, high] = bytes(channel).map(|byte| f64::from(byte) / 255.0);
    let bound = 0.5 * (high - low);
    Bounded {
        value: 0.5 * (low + high),
        bound: bound + 2.5 * U * high + TINY,
    }
}

/// Stage `packed`: as stage `resolve`, of layers in the order of their lists whose colours and opacities are
/// cut to 0 to 1 and rounded to 256 steps; the mean, where pixels have several samples. Opaque surfaces and
/// the background are not in lists, and exact.
///
/// The value is that of rounded colours; where a channel lies half-way between two steps, so that either may
/// be taken, it is that of their middle, and the bound holds what half a step makes of it. Each operation carries the errors of its operands, through the blend. A product of
/// three may be taken in any order: each order meets as many roundings, of operands within the same bounds,
/// all of them about 1 at most, and what is flushed is covered by two more times [`TINY`].
pub fn packed(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
) -> Vec<[Bounded; 3]> {
    let colour = |prim: u32| scene.triangles[primitives.source[prim as usize] as usize].colour;
    let count = primitives.samples.count() as usize;
    let sample = |place: usize| {
        let (pixel, s) = (place / count, place % count);
        let shows = |f: &&Fragment| visible(primitives, opaque, f) >> s & 1 == 1;
        let layers = sorted.list(pixel).iter().filter(shows);
        let layers: Vec<[f32; 4]> = layers.map(|f| colour(f.prim)).collect();
        let behind = match opaque.prim[place] {
            NOTHING => scene.background,
            prim => {
                let [r, g, b, _] = colour(prim);
                [r, g, b]
            }
        };
        over(&layers, behind)
    };
    let samples: Vec<_> = (0..count * primitives.size.pixels()).map(sample).collect();
    average(&samples, primitives.samples.count())
}

fn over(layers: &[[f32; 4]], behind: [f32; 3]) -> [Bounded; 3] {
    if layers.is_empty() {
        // The surface is stored as it is, unless it is flushed.
        return behind.map(|c| Bounded {
            value: f64::from(c),
            bound: TINY,
        });
    }
    let mut sums = [Sum::default(); 3];
    let mut through = Bounded::exact(1.0);
    let mut add = |weight: Bounded, colour: [Bounded; 3]| {
        for (sum, c) in sums.iter_mut().zip(colour) {
            let term = weight.mul(c);
            sum.add(Bounded {
                bound: term.bound + 2.0 * TINY,
                ..term
            });
        }
    };
    for &[r, g, b, a] in layers {
        let a = unpacked(a);
        add(through.mul(a), [r, g, b].map(unpacked));
        through = through.mul(Bounded::exact(1.0).sub(a));
    }
    add(through, behind.map(|c| Bounded::exact(f64::from(c))));
    sums.map(|sum| sum.finish())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_are_the_nearest_ones() {
        for byte in 0..=255_u32 {
            let exact = byte as f32 / 255.0;
            assert!(rounds_to(exact, byte), "{byte}");
            assert!(!rounds_to(exact, byte + 1), "{byte}");
            assert!(byte == 0 || !rounds_to(exact, byte - 1), "{byte}");
        }
        // Half-way, either may come out.
        let half = 2.5 / 255.0;
        assert!(rounds_to(half, 2) && rounds_to(half, 3), "either");
        assert!(rounds_to(7.5, 255) && rounds_to(-1.0, 0), "what is cut");
        assert!(!rounds_to(7.5, 256), "no byte");
    }

    /// One layer. Three quarters of 255 are rounded in one way alone; half of it is half-way, as an opacity as well.
    #[test]
    fn half_a_step_where_either_may_be_taken() {
        let [red, green, _] = over(&[[0.75, 0.5, 0.0, 1.0]], [1.0, 0.0, 0.0]);
        assert!((red.value - 191.0 / 255.0).abs() < 1e-12, "{red:?}");
        // A quotient, two products and two sums of numbers of about 1 each.
        assert!(red.bound < 16.0 * U, "{red:?}");
        let step = 0.5 / 255.0;
        assert!((green.value - 0.5).abs() < 1e-12, "{green:?}");
        assert!(
            green.bound >= step && green.bound <= 1.01 * step,
            "{green:?}"
        );
        let [red, ..] = over(&[[0.75, 0.0, 0.0, 0.5]], [1.0, 0.0, 0.0]);
        // Of a layer and what is behind it, each with half a step of the opacity.
        let most = (1.0 + 191.0 / 255.0) * step;
        assert!(
            red.bound >= step * 64.0 / 255.0 && red.bound <= 1.01 * most,
            "{red:?}"
        );
    }
}
