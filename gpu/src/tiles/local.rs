//! Stage `local`: the picture without lists in memory, but for tiles that need them.

use std::time::Duration;

use triptych_spec::abuffer::{EOL, Lists};
use triptych_spec::raster::Samples;
use triptych_spec::tiles::{Digest, SIDE, digest, packed};

use super::attempt::{self, Tried};
use super::room::{self, Room};
use super::{Options, Tiled, tiles};
use crate::error::GpuError;
use crate::frame::Band;
use crate::lists::LONG;
use crate::raster::{Rasterizer, SATURATED};
use crate::ready::Ready;

/// What came out of all bands.
#[derive(Clone, Debug, Default)]
pub struct Local {
    /// Of each pixel, row by row, the fragments that were blended.
    pub digests: Vec<Digest>,
    /// The picture, row by row.
    pub image: Vec<[f32; 3]>,
    /// Of each band, which tiles were left to lists in memory.
    pub left: Vec<(Band, Vec<bool>)>,
    /// Time on the device, without transfers and retries.
    pub time: Duration,
}

/// Marks a tile that is done, in the count of its first pixel's digest. Twin: `FINISHED` in `digest.wgsl`.
pub const FINISHED: u32 = 0x8000_0000;

/// Draws the transparent triangles, in bands of rows.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(rasterizer: &Rasterizer<'_>, options: Options<'_>) -> Result<Local, GpuError> {
    let mut result = Local::default();
    let draw = |band, capacity| of_band(rasterizer, &options, band, capacity);
    let add = |part| result.add(part);
    let need = room::need(rasterizer);
    attempt::in_bands(rasterizer, need, options.capacity, draw, add)?;
    Ok(result)
}

impl Local {
    /// Adds a band.
    fn add(&mut self, part: Self) {
        self.digests.extend(part.digests);
        self.image.extend(part.image);
        self.left.extend(part.left);
        self.time += part.time;
    }
}

impl Room<'_, '_> {
    /// Draws all tiles, up to so many layers; a tile of more than so many triangles is left.
    pub(super) fn local(&self, drawn: u32, layers: u32) -> Result<Ready, GpuError> {
        let tiled = Tiled {
            // Longer bins are in no order; llvmpipe leaves loops that are too long.
            count: drawn.min(LONG),
            layers,
            ..self.of_tiles()
        };
        let pass = self.pass("local", tiled, self.tiles)?;
        Ok(pass.after_clearing(self.buffers.get("digests").clone()))
    }

    /// Makes room for digests.
    pub(super) fn with_digests(&mut self) -> Result<(), GpuError> {
        let bytes = 4 + 8 * u64::from(self.frame.width) * u64::from(self.frame.rows);
        let gpu = self.rasterizer.gpu;
        let digests = self.pool.storage(gpu, "digests", bytes)?;
        self.buffers.set("digests", digests);
        Ok(())
    }
}

fn of_band(
    rasterizer: &Rasterizer<'_>,
    options: &Options<'_>,
    band: Band,
    capacity: u32,
) -> Result<Tried<Local>, GpuError> {
    let gpu = rasterizer.gpu;
    let mut room = attempt::room(rasterizer, options, band)?;
    let Some((bins, mut time)) = attempt::bins(&mut room)? else {
        return Ok(Tried::Needs(SATURATED));
    };
    room.with_digests()?;
    let drawn = attempt::at_once(options, rasterizer);
    time += attempt::submit(&room, &[room.local(drawn, u32::MAX)?])?;
    let pixels = band.pixels(rasterizer.size) as usize;
    let words: Vec<u32> = gpu.read(room.buffers.get("digests"), 1 + 2 * pixels)?;
    let left = words[0];
    let of_pixel = |d: &[u32]| Digest {
        count: d[0],
        words: d[1],
    };
    let mut digests: Vec<Digest> = words[1..].chunks_exact(2).map(of_pixel).collect();
    let width = rasterizer.size.width;
    let mut finished = vec![false; room.tiles as usize];
    for (pixel, digest) in digests.iter_mut().enumerate() {
        finished[tile_of(pixel, width, band)] |= digest.count & FINISHED != 0;
        digest.count &= !FINISHED;
    }
    if left > 0 {
        let drawn = (attempt::longest(&bins), drawn);
        let lists = match attempt::jagged(&mut room, band, capacity, drawn)? {
            Tried::Needs(fragments) => return Ok(Tried::Needs(fragments)),
            Tried::Done(lists) => lists,
        };
        time += lists.times.jagged + lists.times.shade;
        let sorted = lists.bands.first().and_then(|band| band.sorted.as_ref());
        for (pixel, own) in digests.iter_mut().enumerate() {
            if !finished[tile_of(pixel, width, band)] {
                // A list that leads astray is no list.
                let list = sorted.and_then(|lists| followed(lists, pixel, rasterizer.samples));
                *own = list.map_or(Digest::default(), digest);
            }
        }
    }
    Ok(Tried::Done(Box::new(Local {
        digests,
        image: attempt::picture(&room)?,
        left: vec![(band, finished.into_iter().map(|done| !done).collect())],
        time,
    })))
}

fn tile_of(pixel: usize, width: u32, band: Band) -> usize {
    let [across, _] = tiles(width, band);
    let (x, y) = (pixel % width as usize, pixel / width as usize);
    y / SIDE as usize * across as usize + x / SIDE as usize
}

/// The entries of a pixel's list; `None` if its links lead nowhere, or around.
fn followed(lists: &Lists, pixel: usize, samples: Samples) -> Option<Vec<[u32; 2]>> {
    let mut list = Vec::new();
    let mut at = lists.heads[pixel];
    while at != EOL {
        let node = lists.nodes.get(at as usize)?;
        if list.len() == lists.nodes.len() {
            return None;
        }
        list.push([node.key, packed(samples, node.prim, node.mask)]);
        at = node.next;
    }
    Some(list)
}
