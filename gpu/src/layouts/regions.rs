//! Linked nodes from several counters. What follows the lists is that of stages `sort` and `resolve`.

use std::time::Duration;

use triptych_spec::abuffer::{EOL, Lists, Node};

use super::room::{Room, Step, no_lists, word};
use super::{Built, Layout, Options, REGIONS, Tried};
use crate::abuffer::{BandResult, PROGRESS, dispatches};
use crate::error::GpuError;
use crate::frame::{Band, WORKGROUP};
use crate::lists;
use crate::raster::Rasterizer;

/// Draws a band with room for so many nodes in all regions.
pub(super) fn attempt(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    (band, capacity): (Band, u32),
    is_opaque: impl Fn(u32) -> bool,
    inspect: impl Fn(&Lists) -> Option<u32>,
) -> Result<Tried, GpuError> {
    let run = (band, capacity / REGIONS);
    let mut room = Room::new(rasterizer, Layout::Regions, options, run, is_opaque)?;
    make(&mut room)?;
    let mut all = Built::default();
    all.build += room.submit(&room.draw("regions")?)?;
    let attempts = room.counters()?;
    let fullest = attempts.iter().copied().max().unwrap_or(0);
    let built = lists(&room, &attempts)?;
    if fullest > room.frame.capacity {
        // As much for each as the fullest one needs: regions lose compactness.
        return Ok(Tried::Needs(fullest.saturating_mul(REGIONS), Some(built)));
    }
    let mut result = BandResult {
        band,
        sorted: None,
        built,
    };
    if let Some(longest) = inspect(&result.built) {
        all.finish += until_done(&room, "sort", longest)?;
        result.sorted = Some(lists(&room, &attempts)?);
        if room.is_shown() {
            all.finish += until_done(&room, "resolve", longest)?;
            all.image = room.picture()?;
        }
    }
    all.bands.push(result);
    Ok(Tried::Done(Box::new(all)))
}

/// Counters, empty lists and nodes.
pub(super) fn make(room: &mut Room<'_, '_>) -> Result<(), GpuError> {
    let gpu = room.rasterizer.gpu;
    let pixels = room.pixels();
    let nodes = u64::from(REGIONS) * u64::from(room.frame.capacity);
    room.listing.regions = REGIONS;
    room.zeros("counters", REGIONS.into())?;
    room.buffers.set("heads", gpu.filled("heads", pixels, EOL)?);
    room.zeros("nodes", 4 * nodes)?;
    room.zeros("colours", 4 * nodes)?;
    room.zeros("progress", 1 + PROGRESS / 4 * u64::from(pixels))
}

impl Room<'_, '_> {
    /// How often an address was asked for in each region.
    fn counters(&self) -> Result<Vec<u32>, GpuError> {
        let gpu = self.rasterizer.gpu;
        gpu.read(self.buffers.get("counters"), REGIONS as usize)
    }
}

/// Dispatches a stage of the A-buffer until no pixel asks for more.
fn until_done(
    room: &Room<'_, '_>,
    entry: &'static str,
    longest: u32,
) -> Result<Duration, GpuError> {
    let groups = room.pixels().div_ceil(WORKGROUP);
    let step = [Step::Other(room.pass_of(
        "abuffer",
        entry,
        room.listing,
        groups,
    )?)];
    let most = (entry, dispatches(longest));
    let progress = room.buffers.get("progress");
    lists::until_done(room.rasterizer.gpu, progress, most, || room.submit(&step))
}

/// The nodes of all regions, one region after another without gaps, with links to match. What leads to a
/// place that no counter handed out leads nowhere.
pub(super) fn lists(room: &Room<'_, '_>, attempts: &[u32]) -> Result<Lists, GpuError> {
    let gpu = room.rasterizer.gpu;
    let capacity = room.frame.capacity as usize;
    let all = REGIONS as usize * capacity;
    let nodes: Vec<[u32; 4]> = gpu.read(room.buffers.get("nodes"), all)?;
    let colours: Vec<[f32; 4]> = gpu.read(room.buffers.get("colours"), all)?;
    let heads: Vec<u32> = gpu.read(room.buffers.get("heads"), room.pixels() as usize)?;
    let stored: Vec<usize> = attempts.iter().map(|n| capacity.min(*n as usize)).collect();
    let before: Vec<usize> = stored
        .iter()
        .scan(0, |sum, n| {
            *sum += n;
            Some(*sum - n)
        })
        .collect();
    let moved = |at: u32| {
        let (region, place) = match capacity {
            0 => (usize::MAX, 0),
            _ => (at as usize / capacity, at as usize % capacity),
        };
        match stored.get(region) {
            _ if at == EOL => EOL,
            Some(n) if place < *n => word(before[region] + place),
            // One less than the end of a list is no address.
            _ => EOL - 1,
        }
    };
    let counted: u64 = attempts.iter().map(|n| u64::from(*n)).sum();
    let mut lists = Lists {
        heads: heads.into_iter().map(moved).collect(),
        attempts: u32::try_from(counted).unwrap_or(u32::MAX),
        ..no_lists(0)
    };
    for (region, &n) in stored.iter().enumerate() {
        for at in region * capacity..region * capacity + n {
            let [key, next, prim, mask] = nodes[at];
            let next = moved(next);
            lists.nodes.push(Node {
                key,
                next,
                prim,
                mask,
            });
            lists.colours.push(colours[at]);
        }
    }
    lists.capacity = word(lists.nodes.len());
    Ok(lists)
}
