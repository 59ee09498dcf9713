//! Linked nodes of 16 bytes, and heads that need no clearing: two frames in the same buffers.

use std::time::Duration;

use triptych_spec::abuffer::{Lists, Node};
use triptych_spec::layouts::{fragment, rounds_to};

use super::room::{Room, Step, no_lists};
use super::{Built, Layout, Options, Tried};
use crate::abuffer::{BandResult, PROGRESS, dispatches};
use crate::error::GpuError;
use crate::frame::Band;
use crate::lists;
use crate::raster::Rasterizer;

/// Draws a band with room for so many nodes, twice.
pub(super) fn attempt(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    (band, capacity): (Band, u32),
    is_opaque: impl Fn(u32) -> bool,
    inspect: impl Fn(&Lists) -> Option<u32>,
) -> Result<Tried, GpuError> {
    let run = (band, capacity);
    let mut room = Room::new(rasterizer, Layout::Packed, options, run, is_opaque)?;
    make(&mut room)?;
    let mut all = Built::default();
    all.build += room.submit(&room.draw("packed")?)?;
    let built = lists(&room)?;
    if built.attempts > capacity {
        return Ok(Tried::Needs(built.attempts, Some(built)));
    }
    let mut result = BandResult {
        band,
        sorted: None,
        built,
    };
    if let Some(longest) = inspect(&result.built) {
        all.finish += until_done(&room, "packed_sort", longest)?;
        result.sorted = Some(lists(&room)?);
        all.finish += room.submit(&room.blend(longest)?)?;
        all.image = room.picture()?;
        // Other frames, without clearing anything.
        all.nearest = room.pictures(options.nearest, (longest, capacity))?;
        room.submit(&room.draw("packed")?)?;
        all.again.push((band, lists(&room)?));
    }
    all.bands.push(result);
    Ok(Tried::Done(Box::new(all)))
}

/// Heads, nodes and what stands in between. New buffers are zeros, which are empty lists.
pub(super) fn make(room: &mut Room<'_, '_>) -> Result<(), GpuError> {
    let (pixels, nodes) = (u64::from(room.pixels()), u64::from(room.frame.capacity));
    room.zeros("counter", 1)?;
    room.zeros("heads", pixels)?;
    room.zeros("packed_nodes", 4 * nodes)?;
    room.zeros("progress", 1 + PROGRESS / 4 * pixels)
}

/// Dispatches a stage until no pixel asks for more.
pub(super) fn until_done(
    room: &Room<'_, '_>,
    entry: &'static str,
    longest: u32,
) -> Result<Duration, GpuError> {
    let step = [Step::Other(room.per_pixel(entry, room.listing)?)];
    let most = ("packed", dispatches(longest));
    let progress = room.buffers.get("progress");
    lists::until_done(room.rasterizer.gpu, progress, most, || room.submit(&step))
}

/// The nodes as they are, with addresses for links. A colour that a triangle's may be rounded to stands
/// for the triangle's.
pub(super) fn lists(room: &Room<'_, '_>) -> Result<Lists, GpuError> {
    let gpu = room.rasterizer.gpu;
    let (pixels, capacity) = (room.pixels(), room.frame.capacity);
    let attempts = gpu.word(room.buffers.get("counter"), 0)?;
    let stored = attempts.min(capacity) as usize;
    let heads: Vec<u32> = gpu.read(room.buffers.get("heads"), pixels as usize)?;
    let nodes: Vec<[u32; 4]> = gpu.read(room.buffers.get("packed_nodes"), stored)?;
    let mut lists = Lists {
        heads: heads.into_iter().map(|head| head.wrapping_sub(1)).collect(),
        attempts,
        capacity,
        ..no_lists(0)
    };
    for [colour, key, face, link] in nodes {
        let f = fragment(0, [key, face]);
        lists.nodes.push(Node {
            key,
            next: link.wrapping_sub(1),
            prim: f.prim,
            mask: f.mask,
        });
        let face = room.rasterizer.colours.get(f.prim as usize);
        lists.colours.push(restored(colour, face));
    }
    Ok(lists)
}

fn restored(packed: u32, face: Option<&[f32; 4]>) -> [f32; 4] {
    let bytes = packed.to_le_bytes().map(u32::from);
    let is_rounded = |face: &&[f32; 4]| face.iter().zip(bytes).all(|(c, byte)| rounds_to(*c, byte));
    let unpacked = || bytes.map(|byte| byte as f32 / 255.0);
    face.filter(is_rounded).copied().unwrap_or_else(unpacked)
}
