//! One attempt at one band: bins, lists, picture.

use std::time::Duration;

use triptych_spec::abuffer::Lists;
use triptych_spec::layouts::PRIMS_MAX;

use super::pool::Pool;
use super::room::Room;
use super::rows;
use super::{DRAWN, Drawn, Options, Times};
use crate::abuffer::BandResult;
use crate::abuffer::rivals::{Surfaces, image};
use crate::error::GpuError;
use crate::frame::{Band, Frame};
use crate::raster::{Attempts, Need, Rasterizer, SATURATED};
use crate::ready::Ready;

/// Triangles in bins beyond which a band is split: a triangle has 64 fragments in a tile at most, and
/// sums of fragments are to stay below [`SATURATED`].
pub(super) const BINNED_MAX: u32 = SATURATED / 64;

/// What came of an attempt.
pub(super) enum Tried<T = Drawn> {
    /// Everything fitted.
    Done(Box<T>),
    /// There is not enough room: so many fragments are to be stored.
    Needs(u32),
}

/// Draws a whole target in bands of rows, each with as much room as it turns out to need.
pub(super) fn in_bands<T>(
    rasterizer: &Rasterizer<'_>,
    need: Need,
    capacity: Option<u32>,
    draw: impl Fn(Band, u32) -> Result<Tried<T>, GpuError>,
    mut add: impl FnMut(T),
) -> Result<(), GpuError> {
    let mut attempts = Attempts::new(rasterizer.gpu, rasterizer.size, need, capacity);
    while let Some((band, capacity)) = attempts.next() {
        match draw(band, capacity) {
            Ok(Tried::Done(part)) => add(*part),
            Ok(Tried::Needs(fragments)) => attempts.overflowed(band, fragments)?,
            Err(error) => attempts.failed(band, capacity, error)?,
        }
    }
    Ok(())
}

/// Draws a band with room for so many fragments.
pub(super) fn run(
    rasterizer: &Rasterizer<'_>,
    options: &Options<'_>,
    band: Band,
    capacity: u32,
) -> Result<Tried, GpuError> {
    let mut room = room(rasterizer, options, band)?;
    let Some((bins, bin)) = bins(&mut room)? else {
        return Ok(Tried::Needs(SATURATED));
    };
    let binned = bins.last().copied().unwrap_or(0);
    let prims = rasterizer
        .gpu
        .read(room.buffers.get("binned"), binned as usize)?;
    let drawn = (longest(&bins), at_once(options, rasterizer));
    let mut tried = jagged(&mut room, band, capacity, drawn)?;
    if let Tried::Done(drawn) = &mut tried {
        drawn.times.bin = bin;
        drawn.bins.push((band, bins, prims));
    }
    Ok(tried)
}

/// Triangles of a tile that one dispatch draws, so that no loop of an invocation is too long for
/// llvmpipe: with several samples, a triangle takes an iteration for each in up to two loops, of eight
/// pixels if it is small, but then it is one of the 64 of a batch.
pub(super) fn at_once(options: &Options<'_>, rasterizer: &Rasterizer<'_>) -> u32 {
    let iterations = match rasterizer.samples.count() {
        1 => 1,
        samples => 4 * samples,
    };
    options.drawn.clamp(1, DRAWN / iterations)
}

/// Puts the triangles of a band in bins: where each begins. `None` if they may have more fragments than
/// any counter takes, for all that is known.
pub(super) fn bins(room: &mut Room<'_, '_>) -> Result<Option<(Vec<u32>, Duration)>, GpuError> {
    let (bins, time) = count_bins(room)?;
    let binned = bins.last().copied().unwrap_or(0);
    if binned > BINNED_MAX
        || 4 * u64::from(room.tiles + binned) > room.rasterizer.gpu.binding_limit()
    {
        return Ok(None);
    }
    let filled = fill_bins(room, binned)?;
    Ok(Some((bins, time + filled)))
}

/// A band's buffers, with its opaque surfaces.
pub(super) fn room<'r, 'g>(
    rasterizer: &'r Rasterizer<'g>,
    options: &Options<'_>,
    band: Band,
) -> Result<Room<'r, 'g>, GpuError> {
    room_in(rasterizer, options, (band, Pool::default()))
}

/// The same with buffers that others had.
pub(super) fn room_in<'r, 'g>(
    rasterizer: &'r Rasterizer<'g>,
    options: &Options<'_>,
    (band, pool): (Band, Pool),
) -> Result<Room<'r, 'g>, GpuError> {
    if rasterizer.samples.count() > 1 && rasterizer.prims() > PRIMS_MAX {
        return Err(GpuError::Limit {
            adapter: rasterizer.gpu.name.clone(),
            what: "triangles by tiles with several samples a pixel",
            needed: rasterizer.prims().into(),
            limit: PRIMS_MAX.into(),
        });
    }
    let [r, g, b] = options.background;
    let frame = Frame {
        depth_test: options.depth_test.into(),
        background: [r, g, b, 1.0],
        ..rasterizer.frame(band)
    };
    let mut room = Room::new(rasterizer, (band, pool), frame)?;
    let surfaces = Surfaces::upload(rasterizer, options.opaque, band)?;
    for (name, buffer) in surfaces.named() {
        room.buffers.set(name, buffer.clone());
    }
    Ok(room)
}

/// Counts the transparent triangles of each tile: where its bin begins.
pub(super) fn count_bins(room: &Room<'_, '_>) -> Result<(Vec<u32>, Duration), GpuError> {
    let time = submit(room, &room.count_bins()?)?;
    let gpu = room.rasterizer.gpu;
    let offsets = gpu.read(room.buffers.get("bins"), room.tiles as usize + 1)?;
    Ok((offsets, time))
}

/// Puts them in bins.
pub(super) fn fill_bins(room: &mut Room<'_, '_>, binned: u32) -> Result<Duration, GpuError> {
    let bytes = 4 * u64::from(binned);
    let gpu = room.rasterizer.gpu;
    let bins = room.pool.storage(gpu, "triangles in tiles", bytes)?;
    room.buffers.set("binned", bins);
    room.binned = binned;
    submit(room, &room.fill_bins(binned)?)
}

/// Stages jagged and shade.
pub(super) fn jagged(
    room: &mut Room<'_, '_>,
    band: Band,
    capacity: u32,
    drawn: (u32, u32),
) -> Result<Tried, GpuError> {
    let rasterizer = room.rasterizer;
    let gpu = rasterizer.gpu;
    let mut times = Times::default();
    let place = room.place_lists(drawn)?;
    times.jagged += submit(room, &place)?;
    let needed = gpu.word(room.buffers.get("counter"), 0)?;
    if needed > capacity {
        return Ok(Tried::Needs(needed));
    }
    let entries = || gpu.storage("entries of lists", 8 * u64::from(needed));
    room.buffers.set("listed", entries()?);
    times.jagged += submit(room, &room.drawn("jagged_fill", needed, drawn)?)?;
    let longest = room.longest(needed)?;
    if longest.is_merged() {
        room.buffers.set("merged", entries()?);
    }
    let lists: Vec<rows::List> = gpu.read(room.buffers.get("lists"), room.lists as usize)?;
    let words = room.buffers.get("rows").size() / 4;
    let moved: Vec<u32> = gpu.read(room.buffers.get("rows"), words as usize)?;
    let linked = |room: &Room<'_, '_>| -> Result<Lists, GpuError> {
        let entries: Vec<[u32; 2]> = gpu.read(room.buffers.get("listed"), needed as usize)?;
        let size = (rasterizer.size.width, band);
        Ok(rows::of_rows(
            size,
            (&lists, &moved),
            (&entries, rasterizer.samples),
            &rasterizer.colours,
        ))
    };
    let built = linked(room)?;
    let sort = room.sort_lists(longest)?;
    times.shade = submit(room, &sort)?;
    times.shade += submit(room, &room.shade(longest, u32::MAX, true)?)?;
    let result = BandResult {
        band,
        sorted: Some(linked(room)?),
        built,
    };
    Ok(Tried::Done(Box::new(Drawn {
        bins: Vec::new(),
        bands: vec![result],
        image: picture(room)?,
        times,
    })))
}

/// The longest of some runs.
pub(super) fn longest(offsets: &[u32]) -> u32 {
    let lengths = offsets.windows(2).map(|run| run[1].saturating_sub(run[0]));
    lengths.max().unwrap_or(0)
}

pub(super) fn picture(room: &Room<'_, '_>) -> Result<Vec<[f32; 3]>, GpuError> {
    let samples = room.frame.width * room.frame.rows * room.frame.samples;
    let picture = image(room.rasterizer.gpu, room.buffers.get("picture"), samples)?;
    // A pixel's mean is at its first sample.
    let pixels = picture.into_iter().step_by(room.frame.samples as usize);
    Ok(pixels.collect())
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
