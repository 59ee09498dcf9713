//! Stage `deposit`: sums of light that do not depend on its order.

use crate::scene::Size;

/// A picture is summed up in units of `2^-UNIT_BITS`.
pub const UNIT_BITS: u32 = 24;

/// Light in units: a number of `f32`, not negative and below 2^31, rounded to the nearest unit,
/// halves up. Exact but for that: a product with a power of two, and at most 24 bits.
pub fn units(light: f32) -> u64 {
    let scaled = libm::scalbn(f64::from(light), UNIT_BITS.cast_signed());
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "not negative, below 2^55"
    )]
    let rounded = libm::floor(scaled + 0.5) as u64;
    rounded
}

/// The sums of a picture (the paper's framebuffer), in units of 2^-[`UNIT_BITS`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sums {
    /// Of the picture.
    pub size: Size,
    /// Red, green and blue, row by row.
    pub pixels: Vec<[u64; 3]>,
}

impl Sums {
    /// No light.
    pub fn new(size: Size) -> Self {
        Self {
            size,
            pixels: vec![[0; 3]; size.pixels()],
        }
    }

    /// Linear light of a pixel.
    pub fn light(&self, pixel: usize) -> [f64; 3] {
        let unit = -UNIT_BITS.cast_signed();
        self.pixels[pixel].map(|c| libm::scalbn(c as f64, unit))
    }
}

/// Stage `deposit` (paper listing 2, `FrameBuffer.Update`): adds light to a pixel. The paper's
/// framebuffer adds floats under a spinlock, so its pictures depend on the order of arrival;
/// sums of integers do not.
pub fn deposit(sums: &mut Sums, pixel: u32, light: [f32; 3]) {
    for (sum, light) in sums.pixels[pixel as usize].iter_mut().zip(light) {
        *sum += units(light);
    }
}
