//! Stage `blur`: buffer B, averaged.

use super::block::fine;
use super::sum::Sum;
use super::{Colour, DARK, Gbuffer, Model, Parameters, Surface, same};
use crate::bound::{Bounded, Real};
use crate::scene::Size;

/// What the pixels of buffer B see.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Coarse {
    /// Of the buffer.
    pub size: Size,
    /// What is seen, if anything.
    pub surfaces: Vec<Option<Surface>>,
}

impl Coarse {
    /// Every so-many-th pixel of what the eye sees.
    pub fn new(seen: &Gbuffer, parameters: &Parameters) -> Self {
        let size = parameters.coarse(seen.size);
        let at = |pixel| seen.surfaces[fine(pixel, size, seen.size, parameters.divisor)];
        Self {
            size,
            surfaces: (0..size.pixels()).map(at).collect(),
        }
    }

    /// The pixels at most `radius` columns and rows from one, row by row.
    fn around(&self, pixel: usize, radius: u32) -> impl Iterator<Item = usize> {
        let (width, radius) = (self.size.width as usize, radius as usize);
        let near =
            |at: usize, end: u32| at.saturating_sub(radius)..(at + radius + 1).min(end as usize);
        let columns = near(pixel % width, self.size.width);
        let rows = near(pixel / width, self.size.height);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

/// Stage `blur`: the mean of buffer B over a square of pixels, of those that see the same
/// surface as the one in the middle ([`same`]); so nothing is mixed across a depth edge or
/// a crease. A pixel always counts itself; one without a surface is dark.
///
/// Which neighbours count differs from pixel to pixel, so the square does not fall into a
/// row and a column. The sum is divided by the number of its terms; a kernel that multiplies
/// by a rounded reciprocal needs one rounding more than it is given here.
pub fn blur(
    model: &Model,
    coarse: &Coarse,
    buffer: &[Colour],
    parameters: &Parameters,
) -> Vec<Colour> {
    let pixel = |pixel: usize| {
        let Some(middle) = &coarse.surfaces[pixel] else {
            return DARK;
        };
        let mut sum = Sum::default();
        for other in coarse.around(pixel, parameters.blur) {
            let surface = coarse.surfaces[other].as_ref();
            if surface.is_some_and(|s| same(model, middle, s, parameters.edge)) {
                sum.add(&buffer[other]);
            }
        }
        let terms = Bounded::exact(f64::from(sum.terms()));
        let mean = |channel: Bounded| {
            // One term is what it was, and no light is none, exactly.
            let exact = sum.terms() == 1 || (channel.value == 0.0 && channel.bound == 0.0);
            if exact { channel } else { channel.div(terms) }
        };
        sum.finish().map(mean)
    };
    (0..coarse.size.pixels()).map(pixel).collect()
}
