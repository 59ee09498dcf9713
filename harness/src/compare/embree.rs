//! The spec's coverage against Embree's hits, in screen space.
//!
//! A pair is a sample's ray and a triangle. Before any result is looked at, each
//! pair is put into one of four classes:
//!
//! - *edge*: with the exact edge functions E of the sample, the least of them is
//!   within `2^-22 (|E_0| + |E_1| + |E_2|)` of 0. Embree's own tolerance there is
//!   half of that. (The least with its sign: a sample that another edge clearly
//!   excludes is judged, however close it lies to the line through this one.)
//! - *unresolved*: not edge, but Embree's rounding may exceed its own tolerance
//!   ([`crate::embree::bound`]). Products of coordinates are exact up to 2^24, so
//!   only triangles longer than 11 pixels (at 8 sub-pixel bits) that are thin, or
//!   triangles seen nearly edge on, have such pairs.
//! - *inside* and *outside*: Embree must report the triangle, or must not.
//!
//! How many pairs are in class edge is a matter of the grid, as for most triangles
//! only E = 0 is. A triangle of double area D has about D / 2 points of the grid
//! inside and B on its border (the greatest common divisors of its edges' extents;
//! 13 to 15 on average in scanned meshes), and samples fall on all of them alike.
//! So the share is near 2 B / D: 0.1 % is met where triangles are larger than a
//! fifth of a pixel's area, and exceeded by smaller ones whatever the scene.
//!
//! The first two are counted, agreeing or not; the other two must agree. For pairs
//! inside, depth is compared as well: Embree's t within its bound of the spec's
//! key, and hits in the order of their keys wherever the bounds tell them apart.

mod band;
mod edge;
mod known;
mod maps;
mod order;
mod pair;
mod pairs;
mod rays;
mod screen;
mod vote;
mod world;

use triptych_spec::scene::Scene;
use triptych_spec::vertex::Primitives;

use crate::dispatch::share;
use crate::embree::world::World;
use crate::embree::{EmbreeError, RayHits, ScreenHits};
use band::judge;
use known::Shares;
pub use maps::{MapConflict, MapDisagreement, MapVote, Sampled, compare_maps};
pub use pair::{DepthPair, Pair, pair};
use pairs::Pairs;
pub use rays::{OfKind, RayConflict, RayDisagreement, RayVote, compare_kinds, compare_rays};
use screen::Screen;
pub use vote::{Conflict, Disagreement, EmbreeVote};
use world::InWorld;

/// Rows of pixels that one task works through. Memory is proportional to the pairs in a
/// band; the result does not depend on it.
pub(crate) const BAND: u32 = 8;

/// Compares the spec's coverage of `spec` with what Embree reports of the same triangles.
///
/// # Errors
/// The first error that Embree reports, in order of bands.
pub fn compare<E: ScreenHits>(spec: &Primitives, embree: &E) -> Result<EmbreeVote, EmbreeError> {
    let depth = embree.depth();
    in_bands(&Screen { spec, depth }, embree)
}

/// Compares the spec's coverage with what Embree reports of the scene in world space, and
/// gives the share of the triangles' area that lies in class edge.
///
/// # Errors
/// The first error that Embree reports, in order of bands.
pub fn compare_world<E: RayHits>(
    scene: &Scene,
    world: &World,
    spec: &Primitives,
    embree: &E,
) -> Result<(EmbreeVote, f64), EmbreeError> {
    let pairs = InWorld::new(scene, world, spec);
    Ok((in_bands(&pairs, embree)?, pairs.band_share()))
}

/// Deterministic: bands are independent, and summed in order.
fn in_bands<P: Pairs, E: RayHits>(pairs: &P, embree: &E) -> Result<EmbreeVote, EmbreeError> {
    let height = pairs.size().height;
    let shares = Shares::new(pairs, BAND);
    let bands: Vec<_> = (0..height.div_ceil(BAND)).collect();
    let bands: Vec<Result<EmbreeVote, EmbreeError>> = share::map(&bands, 1, |band| {
        let first = band * BAND;
        let rows = first..(first + BAND).min(height);
        judge(pairs, embree, &shares, *band as usize, rows)
    });
    let mut total = EmbreeVote::default();
    for band in bands {
        total.add(band?);
    }
    Ok(total)
}

#[cfg(test)]
mod tests;
