//! Counted, added up, filled: two passes over the triangles.

use triptych_spec::layouts::Entry;

use super::arrays::Linked;
use super::room::{Room, Step};
use super::{Built, Layout, Options, Tried};
use crate::abuffer::BandResult;
use crate::error::GpuError;
use crate::frame::Band;
use crate::lists::TILE;
use crate::raster::Rasterizer;

/// Draws a band with room for so many fragments.
pub(super) fn attempt(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    (band, capacity): (Band, u32),
    is_opaque: impl Fn(u32) -> bool,
) -> Result<Tried, GpuError> {
    let gpu = rasterizer.gpu;
    let run = (band, capacity);
    let mut room = Room::new(rasterizer, Layout::Precalc, options, run, is_opaque)?;
    let pixels = room.pixels();
    make(&mut room)?;
    let mut all = Built::default();
    all.build += room.submit(&count(&room)?)?;
    let offsets: Vec<u32> = gpu.read(room.buffers.get("offsets"), pixels as usize + 1)?;
    let counted = offsets.last().copied().unwrap_or(0);
    if counted > capacity {
        return Ok(Tried::Needs(counted, None));
    }
    room.frame.capacity = counted;
    room.zeros("listed", 2 * u64::from(counted))?;
    all.build += room.submit(&room.draw("precalc_fill")?)?;
    let built = linked(&room, &offsets, counted)?;
    let longest = longest(&offsets);
    let mut steps = room.rank(longest, counted)?;
    steps.extend(room.blend(longest)?);
    all.finish += room.submit(&steps)?;
    all.image = room.picture()?;
    all.bands.push(BandResult {
        band,
        built,
        sorted: Some(linked(&room, &offsets, counted)?),
    });
    all.nearest = room.pictures(options.nearest, (longest, counted))?;
    Ok(Tried::Done(Box::new(all)))
}

/// Buffers that do not depend on how many fragments there are.
pub(super) fn make(room: &mut Room<'_, '_>) -> Result<(), GpuError> {
    let pixels = room.pixels();
    room.zeros("counts", pixels.into())?;
    room.zeros("offsets", u64::from(pixels) + 1)?;
    room.zeros("sums", pixels.div_ceil(TILE).into())?;
    room.zeros("unfinished", 1)
}

/// Where each pixel's run begins.
pub(super) fn count(room: &Room<'_, '_>) -> Result<Vec<Step>, GpuError> {
    let parts = room.pixels().div_ceil(TILE);
    let mut steps = room.draw("precalc_count")?;
    for (entry, groups) in [
        ("precalc_parts", parts),
        ("precalc_sums", 1),
        ("precalc_offsets", parts),
    ] {
        steps.push(Step::Other(room.pass(entry, room.listing, groups)?));
    }
    Ok(steps)
}

/// The longest of some runs.
fn longest(offsets: &[u32]) -> u32 {
    let lengths = offsets.windows(2).map(|run| run[1].saturating_sub(run[0]));
    lengths.max().unwrap_or(0)
}

/// The runs as linked lists. Offsets that a kernel of a user's wrote may be anything.
pub(super) fn linked(
    room: &Room<'_, '_>,
    offsets: &[u32],
    counted: u32,
) -> Result<triptych_spec::abuffer::Lists, GpuError> {
    let gpu = room.rasterizer.gpu;
    let entries: Vec<Entry> = gpu.read(room.buffers.get("listed"), counted as usize)?;
    let mut linked = Linked::new(room.pixels(), &room.rasterizer.colours);
    let mut left = entries.len();
    for (pixel, run) in offsets.windows(2).enumerate() {
        let run = run[0] as usize..run[1] as usize;
        // Runs that overlap hold more than there is.
        let own = entries.get(run).unwrap_or(&[]);
        let own = &own[..own.len().min(left)];
        left -= own.len();
        linked.extend(pixel, own);
    }
    Ok(linked.counted(counted))
}
