//! Stage `linked`: linked lists, a region of the nodes and a counter for each tile.

use std::time::Duration;

use bytemuck::{Pod, Zeroable};
use triptych_spec::abuffer::Lists;

use super::attempt::{self, Tried};
use super::lists::STEPS;
use super::nodes;
use super::room::{COLOUR, Room, SAMPLE};
use super::{Options, Tiled};
use crate::abuffer::{BandResult, PROGRESS, dispatches};
use crate::error::GpuError;
use crate::frame::Band;
use crate::lists::until_done;
use crate::raster::{Need, Rasterizer, SATURATED};
use crate::ready::Ready;

/// Of a sample: opaque surface, picture. Of a pixel: head, progress of sort and blend. Of a fragment: a
/// node.
pub(super) fn need(rasterizer: &Rasterizer<'_>) -> Need {
    let samples = u64::from(rasterizer.samples.count());
    let largest = (PROGRESS + 4).max(COLOUR * samples);
    Need {
        what: "linked",
        pixel: SAMPLE * samples + 4 + PROGRESS,
        node: NODE,
        pixels_max: rasterizer.gpu.binding_limit() / largest,
    }
}

/// Bytes of a node.
const NODE: u64 = 16;

/// A tile's nodes. Twin: `Region` in `linked.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Region {
    /// The first.
    pub first: u32,
    /// How many there is room for.
    pub capacity: u32,
    /// How many there would be.
    pub attempts: u32,
    /// Nothing.
    pub unused: u32,
    /// The lists that are in order, a bit each.
    pub in_order: [u32; 2],
}

/// What came out of all bands.
#[derive(Default)]
pub struct Linked {
    /// Of each band, its lists as they were built, and in order.
    pub bands: Vec<BandResult>,
    /// The picture, row by row.
    pub image: Vec<[f32; 3]>,
    /// What attempts stored that had too little room for some tile.
    pub overflowed: Vec<(Band, Lists)>,
    /// Time on the device, without transfers and retries.
    pub time: Duration,
}

/// Draws the transparent triangles, in bands of rows. `inspect` says how long the longest list is, or `None`
/// if lists must not be followed; then there is no picture.
///
/// # Errors
/// Limits by name, WGSL errors, and whatever the device reports.
pub fn run(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    inspect: impl Fn(&Lists) -> Option<u32>,
) -> Result<Linked, GpuError> {
    let mut result = Linked::default();
    let draw = |band, capacity| of_band(rasterizer, &options, (band, capacity), &inspect);
    let add = |part| result.add(part);
    let need = need(rasterizer);
    attempt::in_bands(rasterizer, need, options.capacity, draw, add)?;
    Ok(result)
}

impl Linked {
    /// Adds a band.
    fn add(&mut self, part: Self) {
        self.bands.extend(part.bands);
        self.image.extend(part.image);
        self.overflowed.extend(part.overflowed);
        self.time += part.time;
    }
}

/// Where the regions of tiles lie: one after another, with room for so many nodes each.
fn placed(capacities: impl Iterator<Item = u32>) -> Vec<Region> {
    let mut first = 0;
    let region = |capacity| {
        let region = Region {
            first,
            capacity,
            ..Region::default()
        };
        first += capacity;
        region
    };
    capacities.map(region).collect()
}

fn of_band(
    rasterizer: &Rasterizer<'_>,
    options: &Options<'_>,
    (band, capacity): (Band, u32),
    inspect: &impl Fn(&Lists) -> Option<u32>,
) -> Result<Tried<Linked>, GpuError> {
    let mut room = attempt::room(rasterizer, options, band)?;
    let Some((bins, mut time)) = attempt::bins(&mut room)? else {
        return Ok(Tried::Needs(SATURATED));
    };
    let drawn = (
        attempt::longest(&bins),
        attempt::at_once(options, rasterizer),
    );
    let each = capacity / room.tiles;
    let mut regions = placed((0..room.tiles).map(|_| each));
    let mut overflowed = Vec::new();
    loop {
        room.with_nodes(&regions)?;
        time += attempt::submit(&room, &room.drawn("linked", 0, drawn)?)?;
        room.count(&mut regions)?;
        let needed: u64 = regions.iter().map(|r| u64::from(r.attempts)).sum();
        let needed = u32::try_from(needed).unwrap_or(SATURATED).min(SATURATED);
        // Whoever asks for more than it asked for before asks for ever: that is a result.
        let is_whole = regions.iter().all(|r| r.attempts <= r.capacity);
        if is_whole || !overflowed.is_empty() {
            break;
        }
        if needed > capacity {
            return Ok(Tried::Needs(needed));
        }
        overflowed.push((band, nodes::lists(&room, band, &regions)?));
        // Together they fit: each tile gets what it asked for.
        regions = placed(regions.iter().map(|r| r.attempts));
    }
    let built = nodes::lists(&room, band, &regions)?;
    let mut linked = Linked {
        overflowed,
        ..Linked::default()
    };
    let mut result = BandResult {
        band,
        sorted: None,
        built,
    };
    if let Some(longest) = inspect(&result.built) {
        let (sort, most) = ([room.sort_linked()?], ("linked", dispatches(longest)));
        let progress = room.buffers.get("progress");
        time += until_done(rasterizer.gpu, progress, most, || {
            attempt::submit(&room, &sort)
        })?;
        result.sorted = Some(nodes::lists(&room, band, &regions)?);
        for pass in room.blend_linked(longest, u32::MAX)? {
            time += attempt::submit(&room, &[pass])?;
        }
        linked.image = attempt::picture(&room)?;
    }
    linked.bands.push(result);
    linked.time = time;
    Ok(Tried::Done(Box::new(linked)))
}

impl Region {
    /// Lists that are not in order.
    pub(super) fn unordered(&self) -> u32 {
        self.in_order.map(u32::count_zeros).iter().sum()
    }
}

impl Room<'_, '_> {
    /// Links everything, in regions that hold just what is drawn: these, and the passes.
    pub(super) fn link_exactly(
        &mut self,
        drawn: (u32, u32),
    ) -> Result<(Vec<Region>, Vec<Ready>), GpuError> {
        let mut regions = placed((0..self.tiles).map(|_| 0));
        for _ in 0..2 {
            regions = placed(regions.iter().map(|r| r.attempts));
            self.with_nodes(&regions)?;
            attempt::submit(self, &self.drawn("linked", 0, drawn)?)?;
            self.count(&mut regions)?;
        }
        let passes = self.drawn("linked", 0, drawn)?;
        Ok((regions, passes))
    }

    /// Reads what each region counted. Where it lies and how large it is, the host knows.
    fn count(&self, regions: &mut [Region]) -> Result<(), GpuError> {
        let buffer = self.buffers.get("regions");
        let counted: Vec<Region> = self.rasterizer.gpu.read(buffer, regions.len())?;
        for (region, counted) in regions.iter_mut().zip(counted) {
            region.attempts = counted.attempts;
            region.in_order = counted.in_order;
        }
        Ok(())
    }

    /// Makes room for nodes.
    pub(super) fn with_nodes(&mut self, regions: &[Region]) -> Result<(), GpuError> {
        let gpu = self.rasterizer.gpu;
        let pixels = u64::from(self.frame.width) * u64::from(self.frame.rows);
        let nodes = regions.last().map_or(0, |last| last.first + last.capacity);
        for (name, bytes) in [
            ("nodes", NODE * u64::from(nodes)),
            ("heads", 4 * pixels),
            ("progress", 4 + PROGRESS * pixels),
        ] {
            self.buffers.set(name, self.pool.storage(gpu, name, bytes)?);
        }
        self.buffers.set("regions", gpu.upload("regions", regions)?);
        Ok(())
    }

    /// Puts lists in order that are not; over and over, until none asks for more.
    pub(super) fn sort_linked(&self) -> Result<Ready, GpuError> {
        self.pass("linked_sort", self.of_tiles(), self.tiles)
    }

    /// The same for lists of at most `longest` nodes, as often as any may ask for.
    pub(super) fn sort_linked_whole(&self, longest: u32) -> Result<Vec<Ready>, GpuError> {
        let first = self
            .sort_linked()?
            .after_clearing(self.buffers.get("progress").clone());
        let others = (1..dispatches(longest)).map(|_| self.sort_linked());
        std::iter::once(Ok(first)).chain(others).collect()
    }

    /// Blends lists of at most `longest` nodes.
    pub(super) fn blend_linked(&self, longest: u32, layers: u32) -> Result<Vec<Ready>, GpuError> {
        let pass = |first| {
            let tiled = Tiled {
                first,
                count: STEPS,
                layers,
                ..self.of_tiles()
            };
            self.pass("linked_blend", tiled, self.tiles)
        };
        // A list ends behind its last node.
        (0..=longest).step_by(STEPS as usize).map(pass).collect()
    }
}
