//! Programmable blending over sorted fragments: depth of field from the layers.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 5: the layers of the lists, each blurred
//! by how far it is out of focus, and blended in order.

use super::{NOTHING, Opaque, Sorted, colour};
use crate::bound::{Bounded, Real, Sum, TINY};
use crate::scene::{Scene, Size};
use crate::vertex::Primitives;

/// Largest radius of a circle of confusion, in pixels: a kernel looks at all pixels around each
/// within it.
pub const RADIUS_MAX: u32 = 8;

/// A lens, all in integers, so that whom a fragment reaches is exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lens {
    /// Depth key that is in focus, at most 2^31 - 1.
    pub focus: u32,
    /// Pixels of radius at the depth of the whole range from the focus, below 2^16.
    pub aperture: u32,
    /// No radius is larger, up to [`RADIUS_MAX`] pixels.
    pub radius: u32,
}

impl Lens {
    /// Radius of the circle of confusion at a depth, in whole pixels: keys from the focus, in
    /// units of 2^15, times the aperture, over 2^16, rounded down, up to the lens's radius.
    pub fn radius_at(self, key: u32) -> u32 {
        let away = key.abs_diff(self.focus) >> 15;
        ((away * self.aperture) >> 16).min(self.radius)
    }
}

/// A fragment as it is spread.
#[derive(Clone, Copy)]
struct Spot {
    radius: u32,
    colour: [f32; 4],
}

/// Stage `defocus`: the `i`-th fragments of all sorted lists in front of the opaque surfaces are
/// layer `i`; each layer is blurred, and blended under those before it, and all over what lies
/// behind, which is blurred last.
///
/// A fragment of radius `r` ([`Lens::radius_at`]) spreads over the square of `2r + 1` pixels
/// around its own, a box that stands for the circle, with a share of `1 / (2r + 1)^2` each. A
/// pixel gathers `A = sum share a` and `C = sum share a c` from the pixels around it, row by row;
/// beyond the border they are those at it. Where shares make more than 1, as between radii,
/// both are divided by `A`: with `m = max(A, 1)`, the layer is `C / m` with opacity `A / m`.
/// Of the last layer opaque surfaces have opacity 1 and their own radius; where there is none,
/// the background, which has no depth, stays where it is. With aperture 0 every radius is 0,
/// and it is [`super::resolve`].
///
/// Radii are exact. Shares, sums in any order, quotients and products add what they round and
/// flush ([`Bounded`], [`Sum`]). Twin: `defocus` in `gpu/src/defocus.wgsl`.
pub fn defocus(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
    lens: Lens,
) -> Vec<[Bounded; 3]> {
    let pixels = primitives.size.pixels();
    let visible = |pixel: usize| {
        let list = sorted.list(pixel);
        let end = list.partition_point(|f| f.key < opaque.key[pixel]);
        &list[..end]
    };
    let layers = (0..pixels).map(|pixel| visible(pixel).len()).max();
    let [zero, one] = [0.0, 1.0].map(Bounded::exact);
    let mut seen = vec![[zero, zero, zero, one]; pixels];
    let size = primitives.size;
    for i in 0..layers.unwrap_or(0) {
        let layer = |pixel: usize| {
            visible(pixel).get(i).map(|f| Spot {
                radius: lens.radius_at(f.key),
                colour: colour(scene, primitives, f.prim),
            })
        };
        let layer: Vec<Option<Spot>> = (0..pixels).map(layer).collect();
        blend_under(&layer, size, lens, &mut seen);
    }
    let surface = |pixel: usize| {
        (opaque.prim[pixel] != NOTHING).then(|| Spot {
            radius: lens.radius_at(opaque.key[pixel]),
            colour: colour(scene, primitives, opaque.prim[pixel]),
        })
    };
    let surfaces: Vec<Option<Spot>> = (0..pixels).map(surface).collect();
    if surfaces.iter().any(Option::is_some) {
        blend_under(&surfaces, size, lens, &mut seen);
    }
    let finish = |[r, g, b, through]: [Bounded; 4]| {
        let mut channels = [r, g, b];
        for (channel, c) in channels.iter_mut().zip(scene.background) {
            *channel = channel.add(through.mul(given(c)));
        }
        channels
    };
    seen.into_iter().map(finish).collect()
}

/// A blurred layer under what is seen so far.
fn blend_under(layer: &[Option<Spot>], size: Size, lens: Lens, seen: &mut [[Bounded; 4]]) {
    let width = size.width as usize;
    for (pixel, seen) in seen.iter_mut().enumerate() {
        let Some([r, g, b, a]) = gather(layer, size, lens, [pixel % width, pixel / width]) else {
            continue;
        };
        let through = seen[3];
        for (channel, c) in seen.iter_mut().zip([r, g, b]) {
            *channel = channel.add(through.mul(c));
        }
        seen[3] = through.mul(Bounded::exact(1.0).sub(a));
    }
}

/// Colour times opacity and opacity of a blurred layer at a pixel; `None` where nothing reaches.
fn gather(
    layer: &[Option<Spot>],
    size: Size,
    lens: Lens,
    [x, y]: [usize; 2],
) -> Option<[Bounded; 4]> {
    let reach = lens.radius as usize;
    let mut sums = [Sum::default(); 4];
    // Pixel p + d - reach, at the border if beyond it.
    let at = |p: usize, d: usize, side: u32| (p + d).saturating_sub(reach).min(side as usize - 1);
    for dy in 0..=2 * reach {
        for dx in 0..=2 * reach {
            let from = at(y, dy, size.height) * size.width as usize + at(x, dx, size.width);
            let away = dx.abs_diff(reach).max(dy.abs_diff(reach));
            let Some(spot) = layer[from].filter(|spot| away <= spot.radius as usize) else {
                continue;
            };
            let side = f64::from(2 * spot.radius + 1);
            let share = Bounded::exact(1.0).div(Bounded::exact(side * side));
            let [r, g, b, a] = spot.colour.map(given);
            let share = share.mul(a);
            for (sum, c) in sums.iter_mut().zip([r, g, b]) {
                sum.add(share.mul(c));
            }
            sums[3].add(share);
        }
    }
    let reached = sums[3].terms() > 0;
    reached.then(|| {
        let whole = sums.map(|sum| sum.finish());
        whole.map(|sum| sum.div(whole[3].at_least(1.0)))
    })
}

/// A number of the scene, which may be flushed.
fn given(value: f32) -> Bounded {
    Bounded {
        value: value.into(),
        bound: if value == 0.0 { 0.0 } else { TINY },
    }
}
