//! A-buffer: order-independent transparency with per-pixel linked lists.
//!
//! Yang, Hensley, Grün and Thibieroz, "Real-Time Concurrent Linked List
//! Construction on the GPU" (2010), sections 3 and 4.1 and appendix A. Opaque
//! surfaces come first, with depth ([`opaque`]); transparent fragments in front of
//! them go into lists ([`build`]), which are sorted ([`sort`]) and blended
//! ([`resolve`]). Twin: `gpu/src/abuffer.wgsl`.
//!
//! Settled errata of the paper's listing: the address that the exchange stores is
//! the counter's value (the listing names two variables that it never sets); a
//! fragment beyond the capacity is counted but touches neither head nor node, so
//! that overflow can lose that fragment, never a list; depth 1 is
//! [`crate::vertex::DEPTH_ONE`].

mod alpha;
mod defocus;
mod density;
mod dual;
mod multisample;
mod nearest;
mod peel;
mod reduced;
mod sorted;
mod weighted;

use crate::bound::{Bounded, TINY, gamma};
use crate::raster::{Fragment, cover_only};
use crate::scene::Scene;
use crate::vertex::Primitives;
pub use alpha::{Target, alpha};
pub use defocus::{Lens, RADIUS_MAX, defocus};
pub use density::{attenuation, density};
pub use dual::{dual, halves, middle};
pub use multisample::{Order, average, resolve_pixels, resolve_samples, visible};
pub use nearest::{nearest_layers, nearest_of};
pub use peel::{LAYERS_MAX, peel};
pub use reduced::{HALVINGS_MAX, Reduced, Reduction, Upsampling, reduced};
pub use sorted::{Sorted, sort};
pub use weighted::{SUM_LEAST, WEIGHT_LEAST, WEIGHT_MOST, weighted};

/// End of a list, and an empty list's head (section 3: "a special flag, e.g. -1").
pub const EOL: u32 = u32::MAX;

/// "No opaque surface": farther than every key.
pub const NOTHING: u32 = u32::MAX;

/// The nearest opaque surface at every sample: those of a pixel follow each other, in order of
/// the mask's bits.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Opaque {
    /// Depth key, or [`NOTHING`].
    pub key: Vec<u32>,
    /// Row in [`Primitives::prims`], or [`NOTHING`].
    pub prim: Vec<u32>,
}

/// Depth and link of a node (appendix A, `tRWFragmentDepthAndLink`), with what the
/// comparison needs to name the fragment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// Depth key.
    pub key: u32,
    /// The next node, or [`EOL`].
    pub next: u32,
    /// Row in [`Primitives::prims`].
    pub prim: u32,
    /// Covered samples.
    pub mask: u32,
}

/// Heads, nodes and the counter that hands out node addresses (sections 3, 3.1).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lists {
    /// First node of each pixel's list, or [`EOL`].
    pub heads: Vec<u32>,
    /// Depth and link, by address.
    pub nodes: Vec<Node>,
    /// Colour and opacity, by the same address (section 3.1: one counter
    /// addresses several buffers).
    pub colours: Vec<[f32; 4]>,
    /// How often an address was asked for; what exceeds the capacity overflowed.
    pub attempts: u32,
    /// Number of addresses.
    pub capacity: u32,
}

impl Opaque {
    /// No surface at any sample.
    pub fn nothing(primitives: &Primitives) -> Self {
        let samples = primitives.size.pixels() * primitives.samples.count() as usize;
        Self {
            key: vec![NOTHING; samples],
            prim: vec![NOTHING; samples],
        }
    }

    /// How many of so many pixels show a surface at any of their samples.
    pub fn pixels(&self, count: usize) -> usize {
        let shows = |prims: &&[u32]| prims.iter().any(|p| *p != NOTHING);
        let samples = (self.prim.len() / count.max(1)).max(1);
        self.prim.chunks(samples).filter(shows).count()
    }
}

/// Stage `opaque`: the smallest `(key, prim)` of the opaque triangles at each
/// sample, with the true key there (section 4.1, step 1).
pub fn opaque(scene: &Scene, primitives: &Primitives) -> Opaque {
    let mut nearest = Opaque::nothing(primitives);
    let select = |prim| is_opaque(scene, primitives, prim);
    cover_only(primitives, select, |f| {
        multisample::surface(primitives, &f, |place, key| {
            if (key, f.prim) < (nearest.key[place], nearest.prim[place]) {
                (nearest.key[place], nearest.prim[place]) = (key, f.prim);
            }
        });
    });
    nearest
}

/// Stage `build`: transparent fragments into linked lists (section 4.1, step 2).
///
/// A fragment is kept if and only if its key is less than the opaque key at one of its
/// samples or more, and its mask is these alone ([`visible`]); with `depth_test` false, all are
/// kept as they are. Insertion follows section 3, steps 1 to 3.
pub fn build(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    depth_test: bool,
    capacity: u32,
) -> Lists {
    let mut lists = Lists {
        heads: vec![EOL; primitives.size.pixels()],
        nodes: Vec::new(),
        colours: Vec::new(),
        attempts: 0,
        capacity,
    };
    let select = |prim| !is_opaque(scene, primitives, prim);
    cover_only(primitives, select, |f| {
        let mask = match depth_test {
            true => visible(primitives, opaque, &f),
            false => f.mask,
        };
        if mask != 0 {
            let f = Fragment { mask, ..f };
            insert(&mut lists, f, colour(scene, primitives, f.prim));
        }
    });
    lists
}

/// Section 3's three steps, with appendix A's test for a full buffer before any
/// head is touched.
fn insert(lists: &mut Lists, f: Fragment, colour: [f32; 4]) {
    let address = lists.attempts;
    lists.attempts = address.checked_add(1).expect("fewer than 2^32 fragments");
    if address >= lists.capacity {
        return;
    }
    let next = std::mem::replace(&mut lists.heads[f.pixel as usize], address);
    lists.nodes.push(Node {
        key: f.key,
        next,
        prim: f.prim,
        mask: f.mask,
    });
    lists.colours.push(colour);
}

/// Stage `resolve`: every list blended over what lies behind it, nearest first
/// (section 4.1, step 3). Linear colours, the "over" operator, no clamping.
///
/// With layers `c_i, a_i` and the opaque surface or background `b`, the result is
/// `sum_i T_i a_i c_i + T_n b`, `T_i = prod_{j<i} (1 - a_j)`. Term `i` of an
/// evaluation in `f32` meets `2i` roundings in `T_i`, two products, and at most
/// `n + 1` additions in any order, so its error is at most
/// `gamma(2i + n + 3) |term_i|`.
///
/// Flushing changes an operand or result by [`TINY`] at most. What is flushed on the
/// way to the weight `T_i a_i` (its `2i + 1` operations, and the opacities) is
/// multiplied by factors within 1 and then by the colour, which may be large: at
/// most `(3i + 2) |c_i| TINY`. The colour itself, the product and the addition add
/// three more.
///
/// With several samples it is the mean of theirs, with layers in the scene's order
/// ([`resolve_pixels`], [`resolve_samples`]).
pub fn resolve(
    scene: &Scene,
    primitives: &Primitives,
    opaque: &Opaque,
    sorted: &Sorted,
) -> Vec<[Bounded; 3]> {
    match scene.order {
        Order::Centroid => resolve_pixels(scene, primitives, opaque, sorted),
        order @ Order::Sample => {
            let samples = resolve_samples(scene, primitives, opaque, sorted, order);
            average(&samples, primitives.samples.count())
        }
    }
}

/// What lies behind the layers at a sample.
fn behind(scene: &Scene, primitives: &Primitives, opaque: &Opaque, sample: usize) -> [f32; 3] {
    match opaque.prim[sample] {
        NOTHING => scene.background,
        prim => {
            let [r, g, b, _] = colour(scene, primitives, prim);
            [r, g, b]
        }
    }
}

fn over(layers: &[[f32; 4]], behind: [f32; 3]) -> [Bounded; 3] {
    let n = u32::try_from(layers.len()).expect("fewer than 2^32 layers");
    let mut sum = [Bounded {
        value: 0.0,
        bound: 0.0,
    }; 3];
    let mut add = |i: u32, weight: f64, colour: [f32; 3]| {
        for (channel, c) in sum.iter_mut().zip(colour) {
            let term = weight * f64::from(c);
            channel.value += term;
            channel.bound += gamma(2 * i + n + 3) * term.abs();
            channel.bound += (f64::from(3 * i + 2) * f64::from(c.abs()) + 3.0) * TINY;
        }
    };
    let mut transmittance = 1.0;
    for (i, &[r, g, b, a]) in (0..).zip(layers) {
        let a = f64::from(a);
        add(i, transmittance * a, [r, g, b]);
        transmittance *= 1.0 - a;
    }
    // Without layers the surface is stored as it is, unless it is flushed.
    if n == 0 {
        return behind.map(|c| Bounded {
            value: f64::from(c),
            bound: TINY,
        });
    }
    add(n, transmittance, behind);
    sum
}

fn is_opaque(scene: &Scene, primitives: &Primitives, prim: u32) -> bool {
    scene.triangles[primitives.source[prim as usize] as usize].is_opaque()
}

fn colour(scene: &Scene, primitives: &Primitives, prim: u32) -> [f32; 4] {
    scene.triangles[primitives.source[prim as usize] as usize].colour
}
