//! Stage `block`: buffer B.

use super::kernel::texels;
use super::sum::Sum;
use super::{Colour, DARK, Gbuffer, Light, Model, Parameters, Place, term};
use crate::grid::ray::Ray;
use crate::grid::trace::blocked;
use crate::grid::{Blockers, Grid};
use crate::scene::Size;

/// What blockers keep away from every so-many-th pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocked {
    /// Of the buffer ([`Parameters::coarse`]).
    pub size: Size,
    /// [`Parameters::words`] a pixel, and in them a bit for each texel of its kernel, row by
    /// row: whether it would give light, and is blocked.
    pub bits: Vec<u32>,
    /// How many rays were asked for.
    pub rays: u64,
    /// The light of the texels whose bits are set: irradiance.
    pub light: Vec<Colour>,
}

impl Blocked {
    /// Whether a texel of the kernel is blocked from a pixel of the buffer.
    pub fn is_blocked(&self, pixel: usize, texel: usize) -> bool {
        let words = self.bits.len() / self.size.pixels();
        self.bits[pixel * words + texel / 32] >> (texel % 32) & 1 == 1
    }
}

/// The pixel of a picture of size `eye` that a pixel of buffer B is: the first of its square.
pub fn fine(pixel: usize, coarse: Size, eye: Size, divisor: u32) -> usize {
    let (columns, divisor) = (coarse.width as usize, divisor as usize);
    let (x, y) = (pixel % columns * divisor, pixel / columns * divisor);
    y * eye.width as usize + x
}

/// Stage `block`: the irradiance that blockers keep away, and which texels they block.
///
/// As [`super::gather`], but only for texels whose segment from the pixel's point to their
/// own meets a blocker, ends included. Segments join points of the lattice, so the answers
/// are exact. Only texels that would give light are asked for; without blockers, none.
pub fn block(
    model: &Model,
    seen: &Gbuffer,
    places: &[Option<Place>],
    lights: &[Option<Light>],
    size: Size,
    (grid, blockers): (&Grid, &Blockers),
    parameters: &Parameters,
) -> Blocked {
    let coarse = parameters.coarse(seen.size);
    let words = parameters.words();
    let mut buffer = Blocked {
        size: coarse,
        bits: vec![0; coarse.pixels() * words],
        rays: 0,
        light: vec![DARK; coarse.pixels()],
    };
    if blockers.triangles.is_empty() {
        return buffer;
    }
    for pixel in 0..coarse.pixels() {
        let at = fine(pixel, coarse, seen.size, parameters.divisor);
        let (Some(surface), Some(place)) = (&seen.surfaces[at], &places[at]) else {
            continue;
        };
        let mut sum = Sum::default();
        for (number, texel) in texels(parameters, place.texel, size) {
            let Some(light) = &lights[texel] else {
                continue;
            };
            let Some(term) = term(model, surface, light, parameters.clamp) else {
                continue;
            };
            buffer.rays += 1;
            let ray = Ray::between(surface.point, light.surface.point);
            if blocked(grid, blockers, ray) {
                buffer.bits[pixel * words + number / 32] |= 1 << (number % 32);
                sum.add(&term);
            }
        }
        buffer.light[pixel] = sum.finish();
    }
    buffer
}
