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

/// A channel as it comes out of its byte: a quotient, which is within 2.5 units.
fn unpacked(channel: f32) -> Bounded {
    let value = f64::from(channel.clamp(0.0, 1.0));
    let bound = BYTE_ERROR / 255.0;
    Bounded {
        value,
        bound: bound + 2.5 * U * (value + bound) + TINY,
    }
}

/// Stage `packed`: as stage `resolve`, of layers in the order of their lists whose colours and opacities are
/// cut to 0 to 1 and rounded to 256 steps; the mean, where pixels have several samples. Opaque surfaces and
/// the background are not in lists, and exact.
///
/// The value is that of colours before rounding; the bound holds what half a step of every channel and
/// opacity makes of it. Each operation carries the errors of its operands, through the blend. A product of
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

    /// One layer: half a step of the colour, and of the opacity between colour and background.
    #[test]
    fn half_a_step_of_each_channel() {
        let [red, ..] = over(&[[0.25, 0.5, 0.75, 0.5]], [1.0, 0.0, 0.0]);
        let step = 0.5 / 255.0;
        assert!((red.value - 0.625).abs() < 1e-12, "{red:?}");
        // |a| dc + |c - b| da, at least; products of errors and roundings are small.
        let least = 0.5 * step + 0.25 * step;
        let most = 0.5 * step + (0.25 + 1.0) * step + step * step;
        assert!(red.bound >= least && red.bound <= 1.01 * most, "{red:?}");
    }
}
