//! Lists that are in order while they are built.

use triptych_spec::abuffer::{EOL, Lists};
use triptych_spec::layouts::Entry;

use super::arrays::Linked;
use super::room::{Room, Step};
use super::shown::longest;
use super::{Built, Layout, Listing, Options, Tried};
use crate::abuffer::{BandResult, STEPS};
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};
use crate::raster::{Path, Rasterizer};

/// Whether one atomic holds key and triangle, so that one pass over the triangles is enough.
pub fn is_wide(rasterizer: &Rasterizer<'_>) -> bool {
    rasterizer.path == Path::Native && rasterizer.kernels.alike("slots", "slots_wide")
}

/// Draws a band with room for so many nodes.
pub(super) fn attempt(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    run: (Band, u32),
    is_opaque: impl Fn(u32) -> bool,
) -> Result<Tried, GpuError> {
    let gpu = rasterizer.gpu;
    let mut room = Room::new(rasterizer, Layout::Ordered, options, run, is_opaque)?;
    make(&mut room)?;
    let mut all = Built::default();
    let mut steps = vec![clear(&room)?];
    steps.extend(draw(&room)?);
    all.build += room.submit(&steps)?;
    let claimed = gpu.word(room.buffers.get("counter"), 0)?;
    if claimed > room.frame.capacity {
        // An invocation that finds its node unneeded keeps it: at most one node for each fragment is wasted,
        // and of those there are no more than were claimed.
        return Ok(Tried::Needs(claimed.saturating_mul(2), None));
    }
    check_steps(&room)?;
    let lists = lists(&room)?;
    let longest = longest(&lists);
    all.finish += room.submit(&room.blend(longest)?)?;
    all.image = room.picture()?;
    all.nearest = room.pictures(options.nearest, (longest, 0))?;
    check_steps(&room)?;
    all.bands.push(BandResult {
        band: room.band,
        sorted: Some(lists.clone()),
        built: lists,
    });
    Ok(Tried::Done(Box::new(all)))
}

/// Links and nodes, which the first pass empties.
pub(super) fn make(room: &mut Room<'_, '_>) -> Result<(), GpuError> {
    let (pixels, nodes) = (room.pixels(), u64::from(room.frame.capacity));
    room.listing.links = pixels;
    room.zeros("counter", 1)?;
    room.zeros("unfinished", 1)?;
    room.zeros("links", u64::from(pixels) + nodes)?;
    if is_wide(room.rasterizer) {
        return room.zeros("both", 2 * nodes);
    }
    room.zeros("keys", nodes)?;
    room.zeros("in_order", nodes)
}

/// Fails by name if an invocation ran out of steps.
pub(super) fn check_steps(room: &Room<'_, '_>) -> Result<(), GpuError> {
    let gpu = room.rasterizer.gpu;
    match gpu.word(room.buffers.get("unfinished"), 0)? {
        0 => Ok(()),
        _ => Err(GpuError::Limit {
            adapter: gpu.name.clone(),
            what: "ordered",
            needed: STEPS + 1,
            limit: STEPS,
        }),
    }
}

/// Empties lists and nodes.
pub(super) fn clear(room: &Room<'_, '_>) -> Result<Step, GpuError> {
    let links = room.pixels() + room.frame.capacity;
    let listing = Listing {
        items: links,
        ..room.listing
    };
    let clear = room.pass("ordered_clear", listing, links.div_ceil(WORKGROUP))?;
    Ok(Step::Other(clear))
}

/// Goes through the triangles, twice unless one word holds key and triangle.
pub(super) fn draw(room: &Room<'_, '_>) -> Result<Vec<Step>, GpuError> {
    let mut steps = room.draw("ordered")?;
    if !is_wide(room.rasterizer) {
        steps.extend(room.draw("ordered_ties")?);
    }
    Ok(steps)
}

/// The lists as they are linked. One that does not end is left sometime.
pub(super) fn lists(room: &Room<'_, '_>) -> Result<Lists, GpuError> {
    let gpu = room.rasterizer.gpu;
    let (pixels, nodes) = (room.pixels() as usize, room.frame.capacity as usize);
    let links: Vec<u32> = gpu.read(room.buffers.get("links"), pixels + nodes)?;
    let entries: Vec<Entry> = match is_wide(room.rasterizer) {
        true => {
            let both: Vec<[u32; 2]> = gpu.read(room.buffers.get("both"), nodes)?;
            both.into_iter().map(|[low, high]| [high, low]).collect()
        }
        false => {
            let keys: Vec<u32> = gpu.read(room.buffers.get("keys"), nodes)?;
            let faces: Vec<u32> = gpu.read(room.buffers.get("in_order"), nodes)?;
            keys.into_iter().zip(faces).map(Entry::from).collect()
        }
    };
    let mut linked = Linked::new(room.pixels(), &room.rasterizer.colours);
    let (mut left, mut counted) = (nodes, 0);
    for pixel in 0..pixels {
        let mut at = links[pixel];
        while at != EOL && left > 0 {
            let Some(entry) = entries.get(at as usize) else {
                break;
            };
            linked.extend(pixel, &[*entry]);
            at = links[pixels + at as usize];
            left -= 1;
            counted += 1;
        }
    }
    Ok(linked.counted(counted))
}
