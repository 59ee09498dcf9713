//! How large a picture of a grid is, so that it takes seconds.

use triptych_spec::grid::ray::Ray;
use triptych_spec::scene::Size;

use super::{View, ends};
use crate::replay::work;

/// Pixels along the longer side of a picture, if its rays cost no more than [`WORK`].
pub(super) const SIDE: u32 = 256;

/// Least pixels along a side, so that what is flat is seen at all.
const SIDE_MIN: u32 = 16;

/// How many cells and triangles the rays of a picture may pass and be held against: all cells
/// behind their pixels, and what these list. A software driver takes seconds for as many; beyond, pictures have half
/// as many pixels a side, or fewer yet.
pub(super) const WORK: u64 = 1 << 24;

/// Most of both that the rays of a picture and of its shadows may meet, by the way of every
/// [`EVERY`]-th from end to end: 20 s of the spec on one core. Beyond, there are fewer pixels, and
/// none at last.
pub(in crate::replay::grid) const MOST: u64 = 1 << 28;

/// No divisor of a picture's side, so that all parts of it are looked at.
const EVERY: usize = 61;

impl View<'_> {
    /// The same with as many pixels as there is time for; `None` if there is for none.
    pub(super) fn affordable(mut self) -> Option<Self> {
        let entries = self.columns(u32::saturating_add);
        let cells = u64::from(self.grid.axes[self.depth].cells());
        let work: u64 = entries.iter().map(|list| cells + u64::from(*list)).sum();
        let halvings = (0..4).find(|n| work >> (2 * n) <= WORK).unwrap_or(4);
        (0..halvings).for_each(|_| self.size = halved(self.size));
        while self.work() > MOST {
            let smaller = halved(self.size);
            if smaller == self.size {
                return None;
            }
            self.size = smaller;
        }
        Some(self)
    }

    /// About what its rays meet behind their pixels, and on the way from the far end to the light.
    fn work(&self) -> u64 {
        let [far, _] = ends(&self.grid.axes[self.depth]);
        let of = |ray: Ray| {
            let mut last = ray.origin;
            last[self.depth] = far;
            let ways = [ray, self.to_light(last)];
            ways.map(|way| work::of(self.grid, way).total())
        };
        let rays = self.rays();
        // All of the smallest.
        let every = if rays.len() < EVERY * EVERY { 1 } else { EVERY };
        let some = rays.into_iter().step_by(every).flat_map(of);
        some.sum::<u64>() * every as u64
    }
}

/// Half as many pixels along a side, where so many are left.
fn halved(size: Size) -> Size {
    Size {
        width: (size.width / 2).max(SIDE_MIN),
        height: (size.height / 2).max(SIDE_MIN),
    }
}

/// Of this shape, the longer side so many pixels.
pub(super) fn sized(sides: [f64; 2], longer: u32) -> Size {
    let long = sides[0].max(sides[1]);
    let [width, height] = sides.map(|side| {
        let pixels = (f64::from(longer) * side / long).round();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a share of `longer`"
        )]
        let pixels = pixels as u32;
        pixels.max(SIDE_MIN)
    });
    Size { width, height }
}
