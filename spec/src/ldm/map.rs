//! Where a map lies: its axes as integers, its pixels, and its part of the pool of all maps.

use super::{LdmError, within};
use crate::grid::lattice::Point;
use crate::scene::Size;

/// Fewest pixels across the scene: half of one is then below 2^24 keys, see [`Maps::half`].
pub const RESOLUTION_MIN: u32 = 8;

/// Most pixels across the scene: with 6 sub-pixel bits an edge function is at most
/// `(724 * 64)^2 < 2^31`.
pub const RESOLUTION_MAX: u32 = 724;

/// Most pixels with 7 sub-pixel bits, for the same reason: `(362 * 128)^2 < 2^31`.
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
    /// Pixels that the scene's box covers.
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
    /// Maps of a box, `low` to `high`, with as many pixels across its diagonal as `resolution`
    /// says, but no more than one for 128 steps. Each map is cropped to what the box covers.
    ///
    /// The axes of a map are its direction and two of the basis by Duff et al. (2017), which has
    /// no pole. They are rounded to integers here, once: every leg starts from them.
    ///
    /// # Errors
    /// No direction or too many, a resolution beyond its limits.
    pub fn new(
        directions: &[[f64; 3]],
        [low, high]: [Point; 2],
        resolution: u32,
    ) -> Result<Self, LdmError> {
        let count = directions.len() as u64;
        let most = u64::from(super::DIRECTIONS_MAX);
        within("the number of directions", count, 1, most)?;
        let (least, most) = (RESOLUTION_MIN.into(), RESOLUTION_MAX.into());
        within("the resolution", resolution.into(), least, most)?;
        let bits = if resolution <= FINE_MAX { 7 } else { 6 };
        let pixel = (diagonal(low, high) / f64::from(resolution)).max(PIXEL_MIN);
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
            let map = all.map(*direction, [low, high], libm::scalbn(scale, exponent));
            // 4096 maps of at most 725 x 725 pixels: fewer than 2^32.
            all.pixels += map.size.width * map.size.height;
            all.maps.push(map);
        }
        Ok(all)
    }

    fn map(&self, direction: [f64; 3], [low, high]: [Point; 2], scale: f64) -> Map {
        let axes = basis(direction);
        let depth = f64::from(1 << ROW_BITS);
        let rows = [
            axes[0].map(|c| rounded(c * scale)),
            axes[1].map(|c| rounded(c * scale)),
            // Depth grows away from the viewer.
            axes[2].map(|c| rounded(-c * depth)),
        ];
        let mut map = Map {
            direction,
            rows,
            planes: axes.map(|axis| axis.map(|c| rounded(c * f64::from(1 << PLANE_BITS)))),
            origin: [0; 3],
            size: Size {
                width: 0,
                height: 0,
            },
            first: self.pixels,
        };
        let corners =
            (0..8).map(|n| [0, 1, 2].map(|i| if n >> i & 1 == 0 { low[i] } else { high[i] }));
        let places: Vec<Point> = corners.map(|corner| self.place(&map, corner)).collect();
        let least = |axis: usize| places.iter().map(|p| p[axis]).min().unwrap_or(0);
        let most = |axis: usize| places.iter().map(|p| p[axis]).max().unwrap_or(0);
        let begin = [0, 1].map(|axis| least(axis) >> self.bits);
        let pixels =
            [0, 1].map(|axis| ((most(axis) >> self.bits) - begin[axis] + 1).unsigned_abs());
        map.origin = [begin[0] << self.bits, begin[1] << self.bits, least(2)];
        map.size = Size {
            width: pixels[0],
            height: pixels[1],
        };
        map
    }

    /// Where a point of the lattice is in a map: column and row in sub-pixels from its corner,
    /// and its key. Exact: a dot product is below 2^54, and halves are rounded up when it is
    /// shifted down. A point of the box is in the map, with a key from 0 to 2^28.
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

fn diagonal(low: Point, high: Point) -> f64 {
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
