//! Linked lists, a region of the nodes for each tile.

use crate::abuffer::Opaque;
use crate::layouts::{Regions, regions};
use crate::scene::Scene;
use crate::vertex::Primitives;

use super::SIDE;

/// Stage `linked`: as stage `regions`, with a region of `capacity` nodes for each tile.
///
/// Where a tile has more fragments, all regions are made anew, as large as each tile's count says.
pub fn linked(
    scene: &Scene,
    primitives: &Primitives,
    seen: (&Opaque, bool),
    capacity: u32,
) -> Regions {
    let width = primitives.size.width;
    let [across, down] = [width, primitives.size.height].map(|side| side.div_ceil(SIDE));
    regions(scene, primitives, seen, (across * down, capacity), |f| {
        f.pixel / width / SIDE * across + f.pixel % width / SIDE
    })
}
