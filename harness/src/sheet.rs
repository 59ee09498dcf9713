//! The lists of pixels, packed for people who look into them in the report.
//!
//! A sheet holds what one leg has at some pixels. The spec's are held once; a GPU leg
//! adds only the pixels where it differs, since elsewhere its lists are the spec's, bit
//! for bit. A scene is packed when it is done, so that no run holds all lists at once.
//!
//! Size policy: a sheet has at most [`SPEC_BYTES`], [`GPU_BYTES`] or [`EMBREE_BYTES`].
//! Where all pixels are too many, every second, fourth, … column and row is kept; of
//! pixels that differ, the worst. How many were left out stands in the sheet.

mod embree;
mod gpu;
mod pack;
mod spec;

use serde::{Deserialize, Serialize};
use triptych_spec::abuffer::{NOTHING, Opaque};
use triptych_spec::raster::Fragment;
use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

use crate::report::Difference;

pub use embree::Rays;
pub use gpu::gpu;
pub use pack::pack;
pub use spec::{spec, stride};

/// Largest sheet of the spec, packed.
pub const SPEC_BYTES: usize = 320 << 10;

/// Largest sheet of a GPU leg, packed.
pub const GPU_BYTES: usize = 64 << 10;

/// Largest sheet of Embree, packed.
pub const EMBREE_BYTES: usize = 192 << 10;

/// What a leg has at some pixels.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Sheet {
    /// The leg's label; `spec` is the spec on its own vertices.
    pub leg: String,
    /// The leg of the sheet, on the same grid, whose lists a GPU leg has wherever this
    /// one holds none; empty if it is not a GPU leg's.
    pub against: String,
    /// Sub-pixel bits of the triangles.
    pub bits: u32,
    /// Pixels whose column and row are multiples of this are held, unless their list is
    /// empty; 0 if only single ones are.
    pub stride: u32,
    /// How many pixels are held.
    pub held: u64,
    /// How many pixels with something to show are not held, to keep within the budget.
    pub left_out: u64,
    /// What must be known beside: why a leg has no lists.
    pub note: String,
    /// The two lists of the worst pixel, for readers without a script.
    pub worst: Option<Difference>,
    /// The lists, see [`pack`]; kept in a file of its own.
    #[serde(skip)]
    pub data: Vec<u8>,
}

/// One entry of a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Entry {
    /// Row of [`Primitives::prims`].
    pub prim: u32,
    /// Instance, and triangle of the mesh.
    pub source: [u32; 2],
    /// Depth key; of [`Kind::Astray`] the address.
    pub key: u32,
    /// Covered samples; 0 where there is none to tell.
    pub mask: u32,
    /// Colour and opacity, linear.
    pub colour: [f32; 4],
    /// What it is.
    pub kind: Kind,
}

/// What an entry is. The numbers are part of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Kind {
    /// A fragment in a list, or a hit of Embree's that agrees.
    Listed = 0,
    /// The opaque surface behind a list.
    Opaque = 1,
    /// A link to an address where no node of this list is; the list ends before it.
    Astray = 2,
    /// A hit of Embree's in class edge: not judged.
    Edge = 3,
    /// A hit of Embree's that its arithmetic cannot resolve: not judged.
    Unresolved = 4,
    /// A hit of Embree's on a triangle that does not cover the sample.
    Invented = 5,
    /// A hit of Embree's at another depth.
    Depth = 6,
    /// No hit of Embree's, where the spec has a fragment.
    Missed = 7,
    /// The same, but not judged: class edge, or unresolved.
    MissedUnjudged = 8,
}

/// A pixel's number and its lists: one, or the spec's and the leg's.
pub type Pixel = (u32, Vec<Vec<Entry>>);

impl Sheet {
    /// Whether two sheets hold the same pixels of the same leg on the same grid.
    pub fn is_like(&self, other: &Self) -> bool {
        (&self.leg, self.bits, self.stride) == (&other.leg, other.bits, other.stride)
    }

    /// Whether it holds what a GPU leg does otherwise than the spec.
    pub fn is_gpu(&self) -> bool {
        !self.against.is_empty()
    }
}

/// What a triangle's row leads to. Rows come from nodes, which may hold anything.
fn source(scene: &Scene, primitives: &Primitives, prim: u32) -> [u32; 2] {
    let row = primitives.source.get(prim as usize);
    let triangle = row.and_then(|row| scene.triangles.get(*row as usize));
    triangle.map_or([u32::MAX; 2], |t| [t.instance, t.primitive])
}

/// The opaque surfaces behind a pixel's list: key and triangle. Where pixels have several
/// samples, those that show the same one are one, by its key at the lowest, with their mask.
fn surfaces(opaque: &Opaque, samples: u32, pixel: u32) -> Vec<Fragment> {
    let mut all: Vec<Fragment> = Vec::new();
    for s in 0..samples {
        let at = samples as usize * pixel as usize + s as usize;
        let of = |of: &[u32]| of.get(at).copied().filter(|n| *n != NOTHING);
        let (Some(prim), Some(key)) = (of(&opaque.prim), of(&opaque.key)) else {
            continue;
        };
        let mask = if samples == 1 { 0 } else { 1 << s };
        match all.iter_mut().find(|surface| surface.prim == prim) {
            Some(surface) => surface.mask |= mask,
            None => all.push(Fragment {
                pixel,
                prim,
                key,
                mask,
            }),
        }
    }
    all
}

#[cfg(test)]
mod tests;
