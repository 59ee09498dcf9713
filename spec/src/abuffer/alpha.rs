//! Plain alpha blending: fragments over each other in the order in which they come.
//!
//! "Alpha Blending" in figure 4 of Yang, Hensley, Grün and Thibieroz (2010), the bound of what
//! blending costs. Wrong wherever triangles are not submitted from back to front, and defined
//! nevertheless: the hardware blends in the order of the triangles.

use super::{Opaque, behind, colour, is_opaque};
use crate::bound::{Bounded, Real, TINY, U};
use crate::raster::cover_only;
use crate::scene::Scene;
use crate::vertex::Primitives;

/// What is blended into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// 32-bit floats: as a kernel computes.
    Single,
    /// 16-bit floats. Vulkan (section "Blending") asks for no more precision and range than
    /// the target has, for every operation and operand.
    Half,
}

/// Relative error of one operation in 16-bit floats, whatever the direction.
const HALF_U: f64 = 1.0 / 1024.0;

/// What flushing a subnormal of 16-bit floats changes at most: 2^-14.
const HALF_TINY: f64 = 1.0 / 16384.0;

/// The largest of 16-bit floats.
const HALF_MAX: f64 = 65504.0;

impl Target {
    /// A result that was rounded, from operands that may be off by so much together.
    fn rounded(self, value: f64, propagated: f64) -> Bounded {
        let (u, tiny, most) = match self {
            Self::Single => (U, TINY, f64::from(f32::MAX)),
            Self::Half => (HALF_U, HALF_TINY, HALF_MAX),
        };
        let reach = value.abs() + propagated;
        let bound = propagated + u * reach + tiny;
        let defined = reach + bound <= most;
        Bounded {
            value,
            bound: if defined { bound } else { f64::INFINITY },
        }
    }

    /// What the blender is given of a number: it may be converted to the target's format.
    fn given(self, value: f32) -> Bounded {
        let value = f64::from(value);
        match self {
            _ if value == 0.0 => Bounded::exact(0.0),
            Self::Single => Bounded { value, bound: TINY },
            Self::Half => self.rounded(value, 0.0),
        }
    }

    fn product(self, a: Bounded, b: Bounded) -> Bounded {
        let propagated = a.value.abs() * b.bound + b.value.abs() * a.bound + a.bound * b.bound;
        self.rounded(a.value * b.value, propagated)
    }

    fn sum(self, a: Bounded, b: Bounded) -> Bounded {
        self.rounded(a.value + b.value, a.bound + b.bound)
    }

    /// A layer over what came before it: `a c + (1 - a) d`, and `(1 - a) t` of what goes
    /// through.
    fn over(self, layer: [f32; 4], below: [Bounded; 4]) -> [Bounded; 4] {
        let a = self.given(layer[3]);
        let through = self.rounded(1.0 - a.value, a.bound);
        let mut next = below.map(|d| self.product(through, d));
        for (channel, c) in next.iter_mut().zip(&layer[..3]) {
            *channel = self.sum(self.product(a, self.given(*c)), *channel);
        }
        next
    }
}

/// Stage `alpha`: the transparent fragments in front of each pixel's opaque surface, one over
/// the other in order of `prim`, over what lies behind.
///
/// Layers are blended over nothing first, with what goes through beside them, as a hardware
/// target is cleared: `d = a c + (1 - a) d`, `t = (1 - a) t`, from `d = 0`, `t = 1`; and at the
/// end, by a kernel in `f32`, `d + t b` is the picture. The bound follows each operation and
/// adds what it rounds and flushes, in the target's format: nothing is reordered from one
/// fragment to the next, and fusing spares a rounding. Where triangles come from back to front
/// it is the picture of [`super::resolve`]. Twin: `alpha` in `gpu/src/alpha.wgsl`.
pub fn alpha(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    target: Target,
) -> Vec<[Bounded; 3]> {
    let [zero, one] = [0.0, 1.0].map(Bounded::exact);
    let mut seen = vec![[zero, zero, zero, one]; primitives.size.pixels()];
    let select = |prim| !is_opaque(scene, primitives, prim);
    cover_only(primitives, select, |f| {
        let pixel = f.pixel as usize;
        if f.key < opaque.key[pixel] {
            let layer = colour(scene, primitives, f.prim);
            seen[pixel] = target.over(layer, seen[pixel]);
        }
    });
    let finish = |(pixel, [r, g, b, through]): (usize, [Bounded; 4])| {
        let behind = behind(scene, primitives, opaque, pixel);
        let mut channels = [r, g, b];
        for (channel, behind) in channels.iter_mut().zip(behind) {
            // A subnormal colour may be flushed as it is read.
            let behind = Bounded {
                value: behind.into(),
                bound: TINY,
            };
            *channel = channel.add(through.mul(behind));
        }
        channels
    };
    seen.into_iter().enumerate().map(finish).collect()
}
