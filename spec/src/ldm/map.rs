//! Where a map lies: its axes as integers, its pixels, and its part of the pool of all maps.

use super::{LdmError, within};
use crate::grid::lattice::Point;
use crate::scene::Size;

/// Fewest pixels across the scene: half of one is then below 2^24 keys, see [`Maps::half`].
pub const RESOLUTION_MIN: u32 = 8;

/// Most pixels across the scene, with 6 sub-pixel bits: 724 * 64 = 46,336 sub-pixels, so that
/// edge functions fit in 31 bits and a sign, at every pixel that the scene has, covered or not.
///
/// A vertex is at most `r` = 23,169 sub-pixels, half of those and what rounding adds, from where
/// the middle of the scene's box is. The middle of a pixel is as far along either axis, or half a
/// pixel farther (64): at most `R` = 32,857 away in all. An edge function at a point is linear
/// in each end of its edge, so it is largest with both ends on the circle: seen under an angle of
/// `2 a`, they are `2 r sin a` apart, and the point is at most `R + r cos a` from their line. The
/// product is below 1.80e9 < 2^31 for all `a`. Differences of coordinates are below 2^16. Where a
/// pixel's middle is within the triangle's own rectangle each of an edge function's two products
/// is below 46,338^2 < 2^31; elsewhere one may be beyond, but wraps around to the right sum.
///
/// A crop takes pixels away and moves no vertex, so the same holds for what reaches beyond it.
pub const RESOLUTION_MAX: u32 = 724;

/// Most pixels with 7 sub-pixel bits, for the same reason: 362 * 128 = 46,336.
const FINE_MAX: u32 = 362;

/// Depth keys of a step of the lattice.
pub const KEYS_PER_STEP: i32 = 8;

/// Bits of a component of [`Map::planes`]. A dot product with [`crate::rsm::Face::coarse`] is
/// then at most 2^28 and a little in size.
pub const PLANE_BITS: u32 = crate::rsm::COARSE_BITS;

/// Bits of the rows' longest component.
const ROW_BITS: i32 = 30;

/// Least width of a pixel in steps: as many as it has sub-pixels.
const PIXEL_MIN: f64 = 128.0;

/// One map.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Unit vector from the scene to whom the map is seen by.
    pub direction: [f64; 3],
    /// What a point of the lattice is multiplied by for its column, row and key, before they are
    /// shifted down; components are at most 2^30 in size.
    pub rows: [[i32; 3]; 3],
    /// The unit vectors along columns, rows, and to the viewer, at length 2^[`PLANE_BITS`].
    pub planes: [Point; 3],
    /// The sub-pixels where pixel (0, 0) begins, and the least key.
    pub origin: Point,
    /// Pixels that both the scene's box and that of receivers cover; 0 by 0 if there are none.
    pub size: Size,
    /// Number of the first pixel among those of all maps.
    pub first: u32,
}

/// All maps of a set of directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Maps {
    /// In order of direction.
    pub maps: Vec<Map>,
    /// Sub-pixel bits: 7 up to 362 pixels across the scene, 6 beyond.
    pub bits: u32,
    /// How far dot products with the first two rows are shifted down, and with the third.
    pub shifts: [u32; 2],
    /// Steps of the lattice to a pixel.
    pub pixel: f64,
    /// Keys by which depth changes within half a pixel where it changes by one key a key, and
    /// the bits of [`Maps::half`] that were shifted out.
    pub half: u32,
    /// See [`Maps::half`].
    pub half_shift: u32,
    /// Pixels of all maps.
    pub pixels: u32,
}

impl Maps {
    /// Maps of all that is in the box `scene`, for points in the box `receivers`; each is the
    /// least and the greatest coordinates. There are as many pixels across the scene's diagonal as
    /// `resolution` says, but no more than one for 128 steps.
    ///
    /// Each map is cropped to the pixels that both boxes cover. What borders they have, and keys,
    /// depend on the scene alone: a cropped map is a part of the whole one, and a receiver in its
    /// box finds the same in both. Receivers may be outside of the scene, where all is open; a map
    /// that none can look up has no pixels. Blockers must be in the scene's box.
    ///
    /// The axes of a map are its direction and two of the basis by Duff et al. (2017), which has
    /// no pole. They are rounded to integers here, once: every leg starts from them.
    ///
    /// # Errors
    /// No direction or too many, a resolution beyond its limits.
    pub fn new(
        directions: &[[f64; 3]],
        scene: [Point; 2],
        receivers: [Point; 2],
        resolution: u32,
    ) -> Result<Self, LdmError> {
        let count = directions.len() as u64;
        let most = u64::from(super::DIRECTIONS_MAX);
        within("the number of directions", count, 1, most)?;
        let (least, most) = (RESOLUTION_MIN.into(), RESOLUTION_MAX.into());
        within("the resolution", resolution.into(), least, most)?;
        let bits = if resolution <= FINE_MAX { 7 } else { 6 };
        let pixel = (diagonal(scene) / f64::from(resolution)).max(PIXEL_MIN);
        let scale = f64::from(1_u32 << bits) / pixel;
        // The largest power of two with which no component exceeds 2^30.
        let exponent = ROW_BITS - libm::frexp(scale).1;
        let [half, half_shift] = half(pixel, bits);
        let mut all = Self {
            maps: Vec::with_capacity(directions.len()),
            bits,
            shifts: [exponent.unsigned_abs(), DEPTH_SHIFT],
            pixel,
            half,
            half_shift,
            pixels: 0,
        };
        for direction in directions {
            let mut map = all.map(*direction, libm::scalbn(scale, exponent));
            all.crop(&mut map, scene, receivers);
            // 4096 maps of at most 726 x 726 pixels: fewer than 2^32.
            all.pixels += map.size.width * map.size.height;
            all.maps.push(map);
        }
        Ok(all)
    }

    /// A map that has no pixels yet, and begins where the lattice does.
    fn map(&self, direction: [f64; 3], scale: f64) -> Map {
        let axes = basis(direction);
        let depth = f64::from(1 << ROW_BITS);
        Map {
            direction,
            rows: [
                axes[0].map(|c| rounded(c * scale)),
                axes[1].map(|c| rounded(c * scale)),
                // Depth grows away from the viewer.
                axes[2].map(|c| rounded(-c * depth)),
            ],
            planes: axes.map(|axis| axis.map(|c| rounded(c * f64::from(1 << PLANE_BITS)))),
            origin: [0; 3],
            size: Size {
                width: 0,
                height: 0,
            },
            first: self.pixels,
        }
    }

    /// Gives a map the pixels that both boxes cover, and the scene's least key.
    fn crop(&self, map: &mut Map, scene: [Point; 2], receivers: [Point; 2]) {
        let [scene, receivers] = [scene, receivers].map(|bounds| self.extent(map, bounds));
        let begin = [0, 1].map(|axis| scene[0][axis].max(receivers[0][axis]) >> self.bits);
        let end = [0, 1].map(|axis| (scene[1][axis].min(receivers[1][axis]) >> self.bits) + 1);
        map.origin = [begin[0] << self.bits, begin[1] << self.bits, scene[0][2]];
        if (0..2).all(|axis| begin[axis] < end[axis]) {
            let [width, height] = [0, 1].map(|axis| (end[axis] - begin[axis]).unsigned_abs());
            map.size = Size { width, height };
        }
    }

    /// The least and the greatest places of a box, which are those of corners: a place never
    /// falls where a coordinate's part in it grows.
    fn extent(&self, map: &Map, [low, high]: [Point; 2]) -> [Point; 2] {
        let corners =
            (0..8).map(|n| [0, 1, 2].map(|i| if n >> i & 1 == 0 { low[i] } else { high[i] }));
        let places = corners.map(|corner| self.place(map, corner));
        places.fold([[i32::MAX; 3], [i32::MIN; 3]], |[least, most], place| {
            [
                [0, 1, 2].map(|axis| least[axis].min(place[axis])),
                [0, 1, 2].map(|axis| most[axis].max(place[axis])),
            ]
        })
    }

    /// Where a point of the lattice is in a map: column and row in sub-pixels from its corner,
    /// and its key. Exact: a dot product is below 2^54, and halves are rounded up when it is
    /// shifted down. A point in the boxes of both scene and receivers is in the map; one in the
    /// scene's has a key from 0 to 2^28.
    pub fn place(&self, map: &Map, point: Point) -> Point {
        let shifts = [self.shifts[0], self.shifts[0], self.shifts[1]];
        [0, 1, 2].map(|axis| {
            let dot: i64 = (0..3)
                .map(|i| i64::from(map.rows[axis][i]) * i64::from(point[i]))
                .sum();
            let half = 1_i64 << (shifts[axis] - 1);
            let place = (dot + half) >> shifts[axis];
            i32::try_from(place).expect("at most 2^27 in size") - map.origin[axis]
        })
    }
}

/// By how much a dot product with the row of depth is shifted down.
const DEPTH_SHIFT: u32 = 27;

fn diagonal([low, high]: [Point; 2]) -> f64 {
    let side = |i: usize| f64::from(high[i]) - f64::from(low[i]);
    libm::sqrt((0..3).map(|i| side(i) * side(i)).sum())
}

/// Keys of half a pixel, rounded up to 16 bits, and how many bits were left out. Corners and the
/// point itself are rounded by half a sub-pixel each, which the half pixel is longer by.
fn half(pixel: f64, bits: u32) -> [u32; 2] {
    let longer = 1.0 + libm::scalbn(2.0, -bits.cast_signed());
    let keys = libm::ceil(pixel / 2.0 * f64::from(KEYS_PER_STEP) * longer);
    let shift = (libm::frexp(keys).1 - 16).max(0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "at most 2^16"
    )]
    let keys = libm::ceil(libm::scalbn(keys, -shift)) as u32;
    [keys, shift.unsigned_abs()]
}

fn rounded(x: f64) -> i32 {
    #[expect(clippy::cast_possible_truncation, reason = "at most 2^30 in size")]
    let integer = libm::round(x) as i32;
    integer
}

/// Two axes at right angles to a third one (Duff et al. 2017).
fn basis([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    let sign = if z < 0.0 { -1.0 } else { 1.0 };
    let a = -1.0 / (sign + z);
    let b = x * y * a;
    [
        [1.0 + sign * x * x * a, sign * b, -sign * x],
        [b, sign + y * y * a, -y],
        [x, y, z],
    ]
}
