//! Fragments at a reduced resolution, under the full one's opaque picture.
//!
//! Yang, Hensley, Grün and Thibieroz (2010), section 5, to save memory: "store fragments at a reduced
//! resolution and upscale the resolved contents". How they are upscaled is left open there; besides the
//! nearest one it is joint bilateral upsampling here (Kopf, Cohen, Lischinski and Uyttendaele 2007), with the
//! opaque surfaces' depths as the guide.

use super::{Opaque, Sorted, behind, build, colour, opaque as surfaces, sort};
use crate::bound::{Bounded, Real, Sum, TINY};
use crate::scene::{Scene, Size};
use crate::vertex::Primitives;

/// Halvings of the resolution at most: edge functions then change by less than 2^30 from one column to the
/// next, and depth keys' numerators by less than 2^63.
pub const HALVINGS_MAX: u32 = 2;

/// A surface's depth where there is none: behind the farthest key.
const BEYOND: u32 = 1 << 31;

/// How far resolution is reduced, and how depth guides what is made of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reduction {
    /// A pixel stands for a block of `2^halvings` pixels a side.
    pub halvings: u32,
    /// How fast a neighbour's weight falls with the difference of depths, in units of one over the depth
    /// range: to a half at `1 / falloff` of it. At least 0.
    pub falloff: f32,
}

/// How pixels of the full resolution are made of reduced ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Upsampling {
    /// Each of that of its block.
    Nearest,
    /// Each of the four around it, by place and depth.
    Joint,
}

/// Lists at a reduced resolution, and what lies behind them there.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduced {
    /// The triangles.
    pub primitives: Primitives,
    /// The nearest opaque surface of each pixel.
    pub opaque: Opaque,
    /// The fragments in front of these, in order.
    pub sorted: Sorted,
}

impl Reduction {
    /// Pixels along a side of a block.
    pub fn side(self) -> u32 {
        1 << self.halvings
    }

    /// The reduced target: blocks at its right and bottom may lie partly outside of the full one.
    pub fn size(self, full: Size) -> Size {
        Size {
            width: full.width.div_ceil(self.side()),
            height: full.height.div_ceil(self.side()),
        }
    }

    /// The same triangles on the same grid, in pixels that are `2^halvings` times as wide and have as many
    /// more sub-pixels. Nothing is rounded, so that coverage and keys are those of the triangles at the
    /// blocks' middles, which are corners of pixels of the full resolution.
    pub fn primitives(self, full: &Primitives) -> Primitives {
        Primitives {
            size: self.size(full.size),
            bits: full.bits + self.halvings,
            ..full.clone()
        }
    }

    /// Stages opaque, build and sort at the reduced resolution.
    pub fn lists(self, scene: &Scene, full: &Primitives) -> Reduced {
        let primitives = self.primitives(full);
        let opaque = surfaces(scene, &primitives);
        let lists = build(scene, &primitives, &opaque, true, u32::MAX);
        Reduced {
            sorted: sort(&lists),
            primitives,
            opaque,
        }
    }
}

/// Stage `reduced`: what the lists of a reduced resolution show, over the opaque surfaces of the full one,
/// of which `opaque` has one for each pixel. Pixels have one sample.
///
/// Each reduced pixel `q` is blended without what lies behind it: the colour of its layers
/// `C_q = sum_i T_i a_i c_i` and what goes through them, `T_q`. A pixel of the full resolution, whose surface
/// or background is `b`, shows `C + T b`. By [`Upsampling::Nearest`], `C` and `T` are those of its block.
/// By [`Upsampling::Joint`] they are the means of those of the four reduced pixels whose middles are
/// around its own (at the border, of those that there are), with weights `w = s r`: `s` that of bilinear
/// interpolation, in whole numbers, and `r = 1 / (1 + falloff d)`, with `d` the difference of the keys of the
/// opaque surfaces of both over `2^31`; where there is none, the key is `2^31`. So light of layers before a
/// far surface stays off a near one, whose reduced pixels hide them.
///
/// Terms are added in any order ([`Sum`]); other operations add what they round and flush ([`Bounded`]).
/// Twin: `gpu/src/reduced.wgsl`.
pub fn reduced(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    lists: &Reduced,
    (reduction, upsampling): (Reduction, Upsampling),
) -> Vec<[Bounded; 3]> {
    let low = lists.primitives.size;
    let layers: Vec<[Bounded; 4]> = (0..low.pixels())
        .map(|q| blended(scene, lists, q))
        .collect();
    let width = primitives.size.width as usize;
    let pixel = |pixel: usize| {
        let [x, y] = [pixel % width, pixel / width];
        let [r, g, b, through] = match upsampling {
            Upsampling::Nearest => {
                let side = reduction.side() as usize;
                layers[y / side * low.width as usize + x / side]
            }
            Upsampling::Joint => {
                let taps = around(reduction, low, [x, y]);
                let weight = |&(q, s): &(usize, u32)| {
                    let r = range(reduction, opaque.key[pixel], lists.opaque.key[q]);
                    (q, Bounded::exact(s.into()).mul(r))
                };
                mean(&layers, taps.iter().map(weight))
            }
        };
        let mut channels = [r, g, b];
        let behind = behind(scene, primitives, opaque, pixel);
        for (channel, c) in channels.iter_mut().zip(behind) {
            *channel = channel.add(through.mul(given(c)));
        }
        channels
    };
    (0..primitives.size.pixels()).map(pixel).collect()
}

/// Colour of a reduced pixel's layers, and what goes through them.
fn blended(scene: &Scene, lists: &Reduced, q: usize) -> [Bounded; 4] {
    let mut sums = [Sum::default(); 3];
    let mut through = Bounded::exact(1.0);
    let end = lists.opaque.key[q];
    for f in lists.sorted.list(q).iter().take_while(|f| f.key < end) {
        let [r, g, b, a] = colour(scene, &lists.primitives, f.prim).map(given);
        for (sum, c) in sums.iter_mut().zip([r, g, b]) {
            sum.add(through.mul(a).mul(c));
        }
        through = through.mul(Bounded::exact(1.0).sub(a));
    }
    let [r, g, b] = sums.map(|sum| sum.finish());
    [r, g, b, through]
}

/// The reduced pixels around a pixel's middle with their bilinear weights, in units of `1 / (2 side)^2`;
/// without those of weight 0. In units of half a pixel, a pixel's middle is at `2 x + 1`, and that of reduced
/// pixel `X` at `side (2 X + 1)`.
fn around(reduction: Reduction, low: Size, at: [usize; 2]) -> Vec<(usize, u32)> {
    let side = i64::from(reduction.side());
    let along = |p: usize, count: u32| {
        let from_first = 2 * i64::try_from(p).expect("a pixel") + 1 - side;
        let (first, part) = (
            from_first.div_euclid(2 * side),
            from_first.rem_euclid(2 * side),
        );
        [(first, 2 * side - part), (first + 1, part)].map(|(q, weight)| {
            let q = q.clamp(0, i64::from(count) - 1);
            let word = |n: i64| u32::try_from(n).expect("small and not negative");
            (word(q), word(weight))
        })
    };
    let (columns, rows) = (along(at[0], low.width), along(at[1], low.height));
    let tap = |(y, of_row): (u32, u32)| {
        columns.map(|(x, of_column)| ((y * low.width + x) as usize, of_row * of_column))
    };
    let taps = rows.into_iter().flat_map(tap);
    taps.filter(|(_, weight)| *weight > 0).collect()
}

/// The weight of a reduced pixel whose surface has one key, for one whose has another.
fn range(reduction: Reduction, key: u32, other: u32) -> Bounded {
    let keys = key.min(BEYOND).abs_diff(other.min(BEYOND));
    let one = Bounded::exact(1.0);
    if keys == 0 {
        return one.div(one);
    }
    let distance = Bounded::once(keys.into()).mul(Bounded::exact(1.0 / f64::from(BEYOND)));
    one.div(one.add(distance.mul(given(reduction.falloff))))
}

/// The mean of some reduced pixels by weights that are not all 0.
fn mean(layers: &[[Bounded; 4]], taps: impl Iterator<Item = (usize, Bounded)>) -> [Bounded; 4] {
    let (mut sums, mut weights) = ([Sum::default(); 4], Sum::default());
    for (q, weight) in taps {
        for (sum, part) in sums.iter_mut().zip(layers[q]) {
            sum.add(weight.mul(part));
        }
        weights.add(weight);
    }
    let weights = weights.finish();
    sums.map(|sum| sum.finish().div(weights))
}

/// A number of the scene, which may be flushed.
fn given(value: f32) -> Bounded {
    Bounded {
        value: value.into(),
        bound: if value == 0.0 { 0.0 } else { TINY },
    }
}
