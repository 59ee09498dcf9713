//! One attempt at one band: bins, lists, picture.

use std::time::Duration;

use triptych_spec::abuffer::{EOL, Lists};

use super::linked;
use super::room::Room;
use super::{Layout, Options};
use crate::abuffer::{BandResult, Done, Times};
use crate::dispatch::Ready;
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::Rasterizer;

/// What came of an attempt.
pub(super) enum Tried {
    /// Everything fitted.
    Done(Box<Done>),
    /// So many nodes are needed; what was stored, where anything was.
    Needs(u32, Option<Lists>),
}

/// Draws a band with room for so many fragments.
pub(super) fn run(
    rasterizer: &Rasterizer<'_>,
    options: &Options<'_>,
    band: Band,
    capacity: u32,
) -> Result<Tried, GpuError> {
    let mut room = room(rasterizer, options, band)?;
    let longest = bins(&mut room, false)?;
    let drawn = (longest, options.drawn);
    match options.layout {
        Layout::Blocks => blocks(&mut room, band, capacity, drawn),
        Layout::Regions => regions(&mut room, band, capacity, drawn),
    }
}

/// A band's buffers, with its opaque surfaces.
pub(super) fn room<'r, 'g>(
    rasterizer: &'r Rasterizer<'g>,
    options: &Options<'_>,
    band: Band,
) -> Result<Room<'r, 'g>, GpuError> {
    let [r, g, b] = options.background;
    let frame = Frame {
        depth_test: options.depth_test.into(),
        background: [r, g, b, 1.0],
        ..rasterizer.frame(band)
    };
    let gpu = rasterizer.gpu;
    let mut room = Room::new(rasterizer, band, frame)?;
    let first = (band.first * rasterizer.size.width) as usize;
    let pixels = first..first + band.pixels(rasterizer.size) as usize;
    let opaque = options.opaque;
    room.set(
        "opaque_key",
        gpu.upload("opaque keys", &opaque.key[pixels.clone()])?,
    );
    room.set(
        "opaque_prim",
        gpu.upload("opaque triangles", &opaque.prim[pixels])?,
    );
    Ok(room)
}

/// Puts the opaque or the other triangles in bins; how many the fullest holds.
pub(super) fn bins(room: &mut Room<'_, '_>, opaque: bool) -> Result<u32, GpuError> {
    let gpu = room.rasterizer.gpu;
    submit(room, &room.count_bins(opaque)?)?;
    let offsets: Vec<u32> = gpu.read(room.get("bins"), room.tiles as usize + 1)?;
    let binned = offsets.last().copied().unwrap_or(0);
    let bytes = 4 * u64::from(binned);
    room.set("binned", gpu.storage("triangles in tiles", bytes)?);
    submit(room, &room.fill_bins(opaque, binned)?)?;
    Ok(longest(&offsets))
}

/// Stages blocks and shade.
fn blocks(
    room: &mut Room<'_, '_>,
    band: Band,
    capacity: u32,
    drawn: (u32, u32),
) -> Result<Tried, GpuError> {
    let rasterizer = room.rasterizer;
    let gpu = rasterizer.gpu;
    let mut times = Times::default();
    times.build += submit(room, &room.count_lists(drawn)?)?;
    let offsets: Vec<u32> = gpu.read(room.get("offsets"), room.lists as usize + 1)?;
    let needed = offsets.last().copied().unwrap_or(0);
    if needed > capacity {
        return Ok(Tried::Needs(needed, None));
    }
    let longest = longest(&offsets);
    let entries = || gpu.storage("entries of lists", 8 * u64::from(needed));
    room.set("listed", entries()?);
    room.set("merged", entries()?);
    times.build += submit(room, &room.drawn("blocks_fill", needed, drawn)?)?;
    let linked = |room: &Room<'_, '_>| -> Result<Lists, GpuError> {
        let entries: Vec<[u32; 2]> = gpu.read(room.get("listed"), needed as usize)?;
        let size = (rasterizer.size.width, band);
        Ok(linked::of_runs(
            size,
            &offsets,
            &entries,
            &rasterizer.colours,
        ))
    };
    let built = linked(room)?;
    let (sort, _) = room.sort_lists(needed, longest)?;
    times.sort = submit(room, &sort)?;
    times.resolve = submit(room, &room.shade(longest)?)?;
    Ok(Tried::Done(Box::new(Done {
        opaque: Default::default(),
        band: BandResult {
            band,
            sorted: Some(linked(room)?),
            built,
        },
        image: picture(room)?,
        times,
        damaged: false,
        endless: None,
    })))
}

fn regions(
    room: &mut Room<'_, '_>,
    band: Band,
    capacity: u32,
    drawn: (u32, u32),
) -> Result<Tried, GpuError> {
    let _ = (room, band, capacity, drawn, EOL, linked::of_nodes);
    todo!()
}

/// The longest of some runs.
pub(super) fn longest(offsets: &[u32]) -> u32 {
    let lengths = offsets.windows(2).map(|run| run[1].saturating_sub(run[0]));
    lengths.max().unwrap_or(0)
}

fn picture(room: &Room<'_, '_>) -> Result<Vec<[f32; 3]>, GpuError> {
    let pixels = (room.frame.width * room.frame.rows) as usize;
    let picture: Vec<[f32; 4]> = room.rasterizer.gpu.read(room.get("picture"), pixels)?;
    Ok(picture.into_iter().map(|[r, g, b, _]| [r, g, b]).collect())
}

pub(super) fn submit(room: &Room<'_, '_>, passes: &[Ready]) -> Result<Duration, GpuError> {
    let gpu = room.rasterizer.gpu;
    let mut encoder = gpu.encoder();
    for pass in passes {
        pass.record(&mut encoder, None);
    }
    let start = std::time::Instant::now();
    gpu.submit(encoder)?;
    Ok(start.elapsed())
}
