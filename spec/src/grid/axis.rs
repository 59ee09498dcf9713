//! Cell boundaries along one axis.

use super::lattice::{EXTENT, REACH};

/// How far, in lattice steps, a kernel's crossing of a cell boundary may be off, rounded
/// up: cells take in whatever comes this near.
///
/// A kernel steps through cells in `f32`. When it crosses boundary `b` it takes the time
/// `(b - o) * (1 / d)`: the difference is exact, division is off by 2.5 units of 2^-23 and
/// the product by 1, so the ray is then `|b - o| * 3.51 * 2^-23 <= 7.02` steps from the
/// boundary, since `|b - o| <= 2^24`. While a kernel is in a cell, between the times it
/// takes for entering and leaving, the ray is therefore in the widened cell; if the ray
/// meets a triangle there, the triangle's box touches the widened cell, and is listed.
/// WGSL does not promise the same value twice for the same expression, so the times of
/// steps may fall a little; what lies before the latest so far has been looked at.
pub const WIDENED: i32 = 8;

/// Least width of a cell: times of successive boundaries then rise in any arithmetic that
/// a kernel may use, since `32 > 2 * 7.02`, and cells are passed in order.
pub const WIDTH_MIN: i32 = 32;

/// Most cells along an axis.
pub const CELLS_MAX: u32 = 1024;

/// Boundaries of the cells along an axis, in lattice steps, rising. Cell `i` lies between
/// boundaries `i` and `i + 1`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    boundaries: Vec<i32>,
}

impl Axis {
    /// Cells of equal width, but for rounding down, around coordinates `low..=high` of
    /// blockers. The outermost boundaries lie so far outside that a widened blocker is
    /// inside them wherever a kernel thinks that it enters the grid. As many cells as are
    /// asked for, or as keep [`WIDTH_MIN`].
    pub fn around(low: i32, high: i32, cells: u32) -> Self {
        debug_assert!(
            -EXTENT <= low && low <= high && high <= EXTENT,
            "blockers are within the lattice's extent"
        );
        let (low, high) = (low - 2 * WIDENED, high + 2 * WIDENED);
        let width = i64::from(high) - i64::from(low);
        let most = (width / i64::from(WIDTH_MIN)).min(i64::from(CELLS_MAX));
        let cells = i64::from(cells).clamp(1, most);
        let boundary = |i: i64| {
            let offset = i32::try_from(i * width / cells).expect("no more than the width");
            low + offset
        };
        Self {
            boundaries: (0..=cells).map(boundary).collect(),
        }
    }

    /// The boundaries; one more than cells.
    pub fn boundaries(&self) -> &[i32] {
        &self.boundaries
    }

    /// Number of cells.
    pub fn cells(&self) -> u32 {
        u32::try_from(self.boundaries.len() - 1).expect("at most CELLS_MAX")
    }

    /// The first and the last cell that coordinates `low..=high` touch, when widened.
    ///
    /// Cell `i` is touched if `low <= boundary(i + 1) + WIDENED` and
    /// `high >= boundary(i) - WIDENED`. Blockers lie inside, so some cell always is.
    pub fn touched(&self, low: i32, high: i32) -> [u32; 2] {
        debug_assert!(
            low <= high && self.boundaries[0] <= low && high <= self.last(),
            "blockers are inside the grid"
        );
        let first = self.boundaries[1..].partition_point(|b| b + WIDENED < low);
        let end =
            self.boundaries[..self.boundaries.len() - 1].partition_point(|b| b - WIDENED <= high);
        [first, end - 1].map(|i| u32::try_from(i).expect("a cell"))
    }

    /// The outermost boundary.
    fn last(&self) -> i32 {
        *self.boundaries.last().expect("at least two boundaries")
    }
}

const _: () = assert!(
    EXTENT + 2 * WIDENED <= REACH && WIDTH_MIN <= 4 * WIDENED,
    "the outermost boundaries are lattice points, and a flat axis has room for a cell"
);
