//! What the stages are told, and within which limits.

use super::RsmError;
use crate::grid::lattice::{EXTENT, REACH};
use crate::scene::Size;
use crate::vertex::DEPTH_ONE;

/// Largest radius of a kernel. A sum of its `2047^2 < 2^22` terms in any order is then off
/// by less than itself, `gamma(2^22) < 1`; and it holds a map of 1024 x 1024 from any texel.
pub const RADIUS_MAX: u32 = 1023;

/// Largest distance of successive texels of a kernel.
pub const STRIDE_MAX: u32 = 64;

/// Largest number of pixels to one of buffer B, in x and in y.
pub const DIVISOR_MAX: u32 = 64;

/// Largest radius of a blur.
pub const BLUR_MAX: u32 = 16;

/// Largest bias of the shadow test: all depths are then equal.
pub const BIAS_MAX: u32 = DEPTH_ONE.cast_unsigned();

/// Least offset of a point from its face: snapping may leave a point behind the face's
/// plane by half a step in each axis, `|n|_1 / 2` times the normal; `k` steps along the
/// longest component of the normal lead back by at least `k |n|_1 / 3`. Two are enough, and
/// leave `|n|_1 / 6`, far more than the rounding of the point in `f64`.
pub const OFFSET_MIN: u32 = 2;

/// Largest offset: the point of a corner at [`EXTENT`] remains on the lattice.
pub const OFFSET_MAX: u32 = (REACH - EXTENT).cast_unsigned();

/// Largest distance from a plane that still is the same surface.
pub const EDGE_MAX: u32 = 1 << 20;

/// Most bits of [`super::Blocked`]: 128 MiB.
pub const BITS_MAX: u64 = 1 << 30;

/// Numbers that a scene states; lengths are in lattice steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameters {
    /// The kernel reaches so many texels to each side; `(2 radius + 1)^2` in all. At most
    /// [`RADIUS_MAX`].
    pub radius: u32,
    /// Texels from one of the kernel to the next, 1 to [`STRIDE_MAX`].
    pub stride: u32,
    /// Every so-many-th pixel, in x and in y, is one of buffer B; 1 to [`DIVISOR_MAX`].
    pub divisor: u32,
    /// Buffer B is averaged over so many of its pixels to each side; at most [`BLUR_MAX`].
    pub blur: u32,
    /// How far behind the map's surface a point may be and still be lit, in depth keys; at
    /// most [`BIAS_MAX`].
    pub bias: u32,
    /// Squared distances are taken to be at least this, in square steps, so that no texel
    /// is infinitely bright; 1 to [`Parameters::CLAMP_MAX`].
    pub clamp: u64,
    /// By how many steps points are moved off their face; [`OFFSET_MIN`] to [`OFFSET_MAX`].
    pub offset: u32,
    /// How far from each other's planes two points of the same surface may be; at most
    /// [`EDGE_MAX`].
    pub edge: u32,
}

impl Parameters {
    /// The largest squared distance on the lattice.
    pub const CLAMP_MAX: u64 = 3 << 48;

    /// Checks every limit, and that of the bits that buffer B needs for a picture.
    ///
    /// # Errors
    /// The first that is exceeded.
    pub fn check(&self, eye: Size) -> Result<(), RsmError> {
        within("the kernel's radius", self.radius, 0, RADIUS_MAX)?;
        within("the stride", self.stride, 1, STRIDE_MAX)?;
        within("the divisor", self.divisor, 1, DIVISOR_MAX)?;
        within("the blur's radius", self.blur, 0, BLUR_MAX)?;
        within("the bias", self.bias, 0, BIAS_MAX)?;
        within("the squared distance", self.clamp, 1, Self::CLAMP_MAX)?;
        within("the offset", self.offset, OFFSET_MIN, OFFSET_MAX)?;
        within("the edge", self.edge, 0, EDGE_MAX)?;
        let bits = self.coarse(eye).pixels() as u64 * self.words() as u64 * 32;
        within("the number of rays", bits, 0, BITS_MAX)
    }

    /// Size of buffer B.
    pub fn coarse(&self, eye: Size) -> Size {
        Size {
            width: eye.width.div_ceil(self.divisor),
            height: eye.height.div_ceil(self.divisor),
        }
    }

    /// Texels along a side of the kernel.
    pub fn side(&self) -> u32 {
        2 * self.radius + 1
    }

    /// Words of 32 bits with one for each texel of the kernel.
    pub fn words(&self) -> usize {
        let side = self.side() as usize;
        (side * side).div_ceil(32)
    }
}

/// An error unless `least <= value <= most`.
pub(super) fn within<T: Into<u64> + Copy>(
    name: &'static str,
    value: T,
    least: T,
    most: T,
) -> Result<(), RsmError> {
    let [value, least, most] = [value, least, most].map(T::into);
    match (least..=most).contains(&value) {
        true => Ok(()),
        false => Err(RsmError::Limit {
            name,
            value,
            least,
            most,
        }),
    }
}
