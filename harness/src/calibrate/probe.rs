//! Triangles that tell a driver's grid.

use triptych_spec::scene::Size;
use triptych_spec::vertex::Primitives;

/// How many there are.
const TRIANGLES: u32 = 600;

/// How far their corners are from the target, in pixels: nearly to the end of the
/// guard rectangle.
const REACH: [i32; 4] = [3, 24, 150, 1900];

const SIZE: Size = Size {
    width: 63,
    height: 47,
};

/// Triangles of all sizes on a grid. One edge of each passes through a sample, to the
/// bit, so that a coarser grid moves it off; of some, all corners are samples, too.
///
/// A fragment far from edges tells nothing and takes time: most are needles, on whose
/// long edges an inexact driver errs most.
pub fn probe(bits: u32) -> Primitives {
    let mut random = SplitMix(0x7121_7974);
    let mut primitives = Primitives {
        samples: triptych_spec::raster::Samples::ONE,
        size: SIZE,
        bits,
        snapped: Vec::new(),
        prims: Vec::new(),
        source: Vec::new(),
    };
    for t in 0..TRIANGLES {
        let reach = REACH[t as usize % REACH.len()];
        let sample = |pixel: i32| (pixel << bits) + (1 << (bits - 1));
        let middle = [SIZE.width, SIZE.height].map(|side| sample(random.below(side.cast_signed())));
        let mut away = |reach: i32| {
            [0, 1].map(|_| match t % 5 {
                0 => (random.below(2 * reach) - reach) << bits,
                _ => random.below((2 * reach) << bits) - (reach << bits),
            })
        };
        // Not at its middle, where what is lost on both sides would cancel.
        let a = away(reach / 3);
        let b = a.map(|x: i32| -3 * x);
        let c = match t % 32 < 4 {
            true => away(reach),
            false => {
                let near = away(4);
                [b[0] + near[0], b[1] + near[1]]
            }
        };
        for corner in [a, b, c] {
            let at = [middle[0] + corner[0], middle[1] + corner[1]];
            primitives
                .snapped
                .push([at[0], at[1], random.below(i32::MAX)]);
        }
        primitives.prims.push([3 * t, 3 * t + 1, 3 * t + 2]);
        primitives.source.push(t);
    }
    primitives
}

/// Steele, Lea and Flood 2014: enough randomness for a probe, and the same on every
/// machine.
struct SplitMix(u64);

impl SplitMix {
    fn below(&mut self, n: i32) -> i32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let n = u64::from(n.unsigned_abs());
        i32::try_from((z ^ (z >> 31)) % n).expect("less than n")
    }
}
