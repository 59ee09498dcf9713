//! What every kernel of a frame is told. Twin: `Frame` in `frame.wgsl`; a test
//! holds the two layouts together.

use bytemuck::{Pod, Zeroable};
use triptych_spec::raster::{SAMPLES_MAX, Samples};
use triptych_spec::scene::Size;
use triptych_spec::vertex::guard_origin;

const _: () = assert!(SAMPLES_MAX == 8, "as `Frame::places` has it");

/// Invocations per workgroup, one dimension.
pub const WORKGROUP: u32 = 64;

/// The uniform block.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Frame {
    /// Pixels per row.
    pub width: u32,
    /// Rows of the target.
    pub height: u32,
    /// Sub-pixel bits.
    pub bits: u32,
    /// Nodes (or stream entries) that there is room for.
    pub capacity: u32,
    /// First row of the band.
    pub first_row: u32,
    /// Rows in the band.
    pub rows: u32,
    /// First entry of the batch in the work list.
    pub work_first: u32,
    /// Entries of the batch.
    pub work_count: u32,
    /// Walks over rows of triangles in the batch: invocations of a compute kernel.
    pub items: u32,
    /// First column of the guard rectangle.
    pub guard_x: i32,
    /// First row of the guard rectangle.
    pub guard_y: i32,
    /// 0 keeps fragments behind opaque surfaces.
    pub depth_test: u32,
    /// Linear background colour.
    pub background: [f32; 4],
    /// Samples of a pixel.
    pub samples: u32,
    /// Whose turn it is, in kernels for one sample.
    pub sample: u32,
    /// 1: layers lie by their keys at each sample; 0: by those of the list.
    pub order: u32,
    /// 1: pixels whose samples are all alike are shaded once.
    pub once: u32,
    /// Right plus down times 2^16 of each sample, in sub-pixels.
    pub places: [u32; 8],
}

/// A run of rows that is rendered at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Band {
    /// First row.
    pub first: u32,
    /// Number of rows, at least 1.
    pub rows: u32,
}

impl Band {
    /// The whole target.
    pub fn whole(size: Size) -> Self {
        Self {
            first: 0,
            rows: size.height,
        }
    }

    /// The two halves of a band of two rows or more.
    pub fn halves(self) -> Option<[Self; 2]> {
        self.halves_in(1)
    }

    /// The same of a band with more than `side` rows, the upper one in whole multiples of them.
    pub fn halves_in(self, side: u32) -> Option<[Self; 2]> {
        let upper = self.rows.div_ceil(side) / 2 * side;
        (upper > 0).then_some([
            Self {
                first: self.first,
                rows: upper,
            },
            Self {
                first: self.first + upper,
                rows: self.rows - upper,
            },
        ])
    }

    /// The whole target in bands of at most so many pixels, top to bottom; a single row may have more.
    pub fn of_pixels(size: Size, most: u64) -> Vec<Self> {
        let mut left = vec![Self::whole(size)];
        let mut bands = Vec::new();
        while let Some(band) = left.pop() {
            match band.halves() {
                Some([upper, lower]) if u64::from(band.pixels(size)) > most => {
                    left.extend([lower, upper]);
                }
                _ => bands.push(band),
            }
        }
        bands
    }

    /// Number of pixels.
    pub fn pixels(self, size: Size) -> u32 {
        self.rows * size.width
    }
}

impl Frame {
    /// A band of a target with one sample a pixel, without work.
    pub fn new(size: Size, bits: u32, band: Band) -> Self {
        Self::with_samples(size, bits, Samples::ONE, band)
    }

    /// The same with these samples in every pixel.
    pub fn with_samples(size: Size, bits: u32, samples: Samples, band: Band) -> Self {
        let mut places = [0; 8];
        for (word, [right, down]) in places.iter_mut().zip(samples.offsets(bits)) {
            let packed = right | down << 16;
            *word = u32::try_from(packed)
                .expect("less than a pixel, which has at most 2^10 sub-pixels");
        }
        Self {
            width: size.width,
            height: size.height,
            bits,
            first_row: band.first,
            rows: band.rows,
            guard_x: guard_origin(size.width),
            guard_y: guard_origin(size.height),
            samples: samples.count(),
            places,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Band;

    #[test]
    fn halves_are_whole_multiples() {
        let halves = |rows, side| {
            let band = Band { first: 3, rows };
            let halves = band.halves_in(side);
            halves.map(|halves| halves.map(|half| [half.first, half.rows]))
        };
        assert_eq!(halves(9, 1), Some([[3, 4], [7, 5]]));
        assert_eq!(halves(1, 1), None);
        assert_eq!(halves(9, 8), Some([[3, 8], [11, 1]]));
        assert_eq!(halves(8, 8), None);
        assert_eq!(halves(41, 8), Some([[3, 24], [27, 17]]));
    }
}
