//! Where the samples of a pixel lie.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 4.1.2, take a pixel's samples as the
//! hardware has them. Positions are data here: those that WebGPU and Direct3D call standard,
//! or those that a driver was found to have.

/// Most samples of a pixel.
pub const SAMPLES_MAX: usize = 8;

/// Positions are whole numbers of 1 / 2^8 of a pixel: what the finest grid tells apart.
const POSITION_BITS: u32 = crate::vertex::SUBPIXEL_BITS;

/// The samples of every pixel: how many, and where.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Samples {
    count: u8,
    /// Right and down from the pixel's top left, in 1 / 2^8 of a pixel.
    at: [[u8; 2]; SAMPLES_MAX],
}

impl Default for Samples {
    fn default() -> Self {
        Self::ONE
    }
}

impl Samples {
    /// One, in the middle.
    pub const ONE: Self = Self::of(&[[8, 8]]);

    /// The numbers of samples that have a standard pattern.
    pub const COUNTS: [u32; 4] = [1, 2, 4, 8];

    /// The standard pattern of so many samples (WebGPU, "sample positions"; Direct3D 11.3,
    /// section 19.2.4); `None` unless it is one of [`Samples::COUNTS`].
    pub fn standard(count: u32) -> Option<Self> {
        let pattern: &[[u8; 2]] = match count {
            1 => return Some(Self::ONE),
            2 => &[[12, 12], [4, 4]],
            4 => &[[6, 2], [14, 6], [2, 10], [10, 14]],
            8 => &[
                [9, 5],
                [7, 11],
                [13, 9],
                [5, 3],
                [3, 13],
                [1, 7],
                [11, 15],
                [15, 1],
            ],
            _ => return None,
        };
        Some(Self::of(pattern))
    }

    /// From sixteenths of a pixel.
    const fn of(pattern: &[[u8; 2]]) -> Self {
        let mut at = [[0; 2]; SAMPLES_MAX];
        let mut i = 0;
        while i < pattern.len() {
            at[i] = [pattern[i][0] << 4, pattern[i][1] << 4];
            i += 1;
        }
        Self {
            #[expect(clippy::cast_possible_truncation, reason = "at most eight")]
            count: pattern.len() as u8,
            at,
        }
    }

    /// Samples that were found at these positions, in sub-pixels of a grid of `bits`. `None`
    /// if their number is not one of [`Samples::COUNTS`], if one lies outside the pixel, or
    /// if a single one is not in the middle, as which every leg takes it.
    pub fn found(positions: &[[u32; 2]], bits: u32) -> Option<Self> {
        let count = u32::try_from(positions.len()).ok()?;
        let mut found = Self::standard(count)?;
        for (at, position) in found.at.iter_mut().zip(positions) {
            for (at, place) in at.iter_mut().zip(position) {
                *at =
                    u8::try_from(place.checked_mul(1 << POSITION_BITS.checked_sub(bits)?)?).ok()?;
            }
        }
        (count > 1 || found == Self::ONE).then_some(found)
    }

    /// How many there are.
    pub fn count(self) -> u32 {
        u32::from(self.count)
    }

    /// The mask of a fragment that covers them all.
    pub fn all(self) -> u32 {
        (1 << self.count) - 1
    }

    /// Right and down from a pixel's top left, in sub-pixels of a grid of `bits`, in order of
    /// the mask's bits. Exact for standard positions, which are sixteenths of a pixel, and for
    /// those that were found on that grid.
    pub fn offsets(&self, bits: u32) -> impl Iterator<Item = [i64; 2]> + '_ {
        let places = self.at[..usize::from(self.count)].iter();
        places.map(move |at| at.map(|place| sub_pixels(place, bits)))
    }

    /// The least and the largest of [`Samples::offsets`], right and down each by itself.
    pub fn extent(&self, bits: u32) -> [[i64; 2]; 2] {
        let least = |a: [i64; 2], b: [i64; 2]| [a[0].min(b[0]), a[1].min(b[1])];
        let largest = |a: [i64; 2], b: [i64; 2]| [a[0].max(b[0]), a[1].max(b[1])];
        let all = || self.offsets(bits);
        let ends = [all().reduce(least), all().reduce(largest)];
        ends.map(|end| end.expect("a pixel has a sample"))
    }

    /// Where sample `s` of a pixel lies, in sub-pixels.
    pub fn point(&self, s: u32, [column, row]: [u32; 2], bits: u32) -> [i64; 2] {
        let at = self.at[s as usize];
        let place = |pixel: u32, at: u8| (i64::from(pixel) << bits) + sub_pixels(at, bits);
        [place(column, at[0]), place(row, at[1])]
    }

    /// The positions in pixels, for people and dumps.
    pub fn positions(&self) -> Vec<[f64; 2]> {
        let places = self.at[..usize::from(self.count)].iter();
        places
            .map(|at| at.map(|place| f64::from(place) / f64::from(1 << POSITION_BITS)))
            .collect()
    }
}

/// A place within a pixel, in sub-pixels of a grid of `bits`.
fn sub_pixels(place: u8, bits: u32) -> i64 {
    (i64::from(place) << bits) >> POSITION_BITS
}

/// The samples of a mask, lowest first.
pub fn samples_of(mask: u32) -> impl Iterator<Item = u32> {
    (0..u32::BITS).filter(move |s| mask >> s & 1 == 1)
}
