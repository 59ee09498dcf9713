//! Arrays of the pixels: as many entries as fit, then ranges of depth one after another.

use std::ops::Range;

use triptych_spec::abuffer::Lists;
use triptych_spec::layouts::{ALL, Entry};

use super::arrays::Linked;
use super::ranges::middle;
use super::room::{Room, Step, pixels_max};
use super::shown::{BEGINS, ENDS, FOLLOWS, GOES_ON};
use super::{Built, ENTRIES, Layout, Listing, Options, memory};
use crate::abuffer::BandResult;
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::{MEMORY, Rasterizer, SATURATED};

/// Bands of rows, top to bottom, of which each pixel has room for an entry at least.
pub(super) fn bands(rasterizer: &Rasterizer<'_>) -> Vec<Band> {
    let each = memory::of_pixel(Layout::Bucket, rasterizer.samples.count()) + memory::ENTRY;
    let most = pixels_max(rasterizer).min(MEMORY / each);
    // A single row that is too much is refused by the buffer's name.
    Band::of_pixels(rasterizer.size, most)
}

/// A band under way.
struct Bucket<'r, 'g> {
    room: Room<'r, 'g>,
    /// Most entries that the arrays can have.
    most: u32,
    built: Linked<'r>,
    sorted: Linked<'r>,
    /// Fragments that were counted in all ranges that fitted.
    counted: u64,
    /// These, nearest first, and the longest list of any.
    ranges: Vec<Range<Entry>>,
    longest: u32,
    all: Built,
}

/// Draws a band: ranges that do not fit are split.
pub(super) fn run(
    rasterizer: &Rasterizer<'_>,
    options: Options<'_>,
    band: Band,
    is_opaque: impl Fn(u32) -> bool,
) -> Result<Built, GpuError> {
    let mut room = Room::new(rasterizer, Layout::Bucket, options, (band, 0), is_opaque)?;
    let pixels = room.pixels();
    let asked = options.arrays.unwrap_or(u32::MAX).max(1);
    let most = most_entries(rasterizer, pixels).min(asked);
    let first = options.capacity.map_or(ENTRIES, |nodes| nodes / pixels);
    make(&mut room)?;
    let linked = || Linked::new(pixels, &rasterizer.colours);
    let mut bucket = Bucket {
        room,
        most,
        built: linked(),
        sorted: linked(),
        counted: 0,
        ranges: Vec::new(),
        longest: 0,
        all: Built::default(),
    };
    bucket.make_room(first.clamp(1, most))?;
    bucket.all_ranges(depths(rasterizer))?;
    let counted = u32::try_from(bucket.counted).unwrap_or(u32::MAX);
    bucket.all.image = bucket.room.picture()?;
    for layers in options.nearest {
        let picture = bucket.nearest(*layers)?;
        bucket.all.nearest.push(picture);
    }
    let mut all = bucket.all;
    all.bands.push(BandResult {
        band,
        built: bucket.built.counted(counted),
        sorted: Some(bucket.sorted.counted(counted)),
    });
    Ok(all)
}

/// Most entries that each of so many arrays can have, one at least.
fn most_entries(rasterizer: &Rasterizer<'_>, pixels: u32) -> u32 {
    let taken = memory::of_pixel(Layout::Bucket, rasterizer.samples.count()) * u64::from(pixels);
    let bytes = MEMORY.saturating_sub(taken);
    let bytes = bytes.min(rasterizer.gpu.binding_limit());
    let most = bytes / (memory::ENTRY * u64::from(pixels));
    u32::try_from(most).unwrap_or(u32::MAX).max(1)
}

/// All entries that the triangles can have: keys lie between those of corners.
fn depths(rasterizer: &Rasterizer<'_>) -> Range<Entry> {
    let [nearest, farthest] = rasterizer.depths();
    [nearest, 0]..[farthest.saturating_add(1), 0]
}

impl Bucket<'_, '_> {
    fn make_room(&mut self, entries: u32) -> Result<(), GpuError> {
        self.all.entries = entries;
        make_room(&mut self.room, entries)
    }

    /// All ranges, nearest first.
    fn all_ranges(&mut self, depths: Range<Entry>) -> Result<(), GpuError> {
        // What is beyond the corners' depths would be a defect, which comparisons are to see.
        let mut ranges = vec![ALL];
        while let Some(range) = ranges.pop() {
            let counts = self.fill(&range)?;
            let longest = counts.iter().copied().max().unwrap_or(0);
            if longest <= self.room.listing.entries {
                let is_last = ranges.is_empty();
                self.take(&counts, longest, is_last)?;
                self.ranges.push(range);
                self.longest = self.longest.max(longest);
                continue;
            }
            if range == ALL {
                let stored = stored(&self.room, &counts)?;
                self.all.overflowed.push((self.room.band, stored));
            }
            let entries = longest.min(self.most);
            if entries > self.room.listing.entries {
                self.make_room(entries)?;
            }
            if longest <= self.most {
                ranges.push(range);
                continue;
            }
            let middle = middle(&range, &depths).ok_or_else(|| self.too_many(longest))?;
            ranges.extend([middle..range.end, range.start..middle]);
        }
        Ok(())
    }

    /// What a range has more of than is possible.
    fn too_many(&self, longest: u32) -> GpuError {
        GpuError::Limit {
            adapter: self.room.rasterizer.gpu.name.clone(),
            what: "bucket",
            needed: longest.into(),
            limit: self.most.into(),
        }
    }

    /// The passes that fill the arrays with the fragments of a range.
    fn filling(&mut self, range: &Range<Entry>) -> Result<Vec<Step>, GpuError> {
        let [from_key, from_face] = range.start;
        let [until_key, until_face] = range.end;
        self.room.listing = Listing {
            from_key,
            from_face,
            until_key,
            until_face,
            ..self.room.listing
        };
        let mut steps = self.room.empty()?;
        steps.extend(self.room.build()?);
        Ok(steps)
    }

    /// Fills the arrays with the fragments of a range; how many each pixel has.
    fn fill(&mut self, range: &Range<Entry>) -> Result<Vec<u32>, GpuError> {
        let steps = self.filling(range)?;
        self.all.build += self.room.submit(&steps)?;
        let (gpu, pixels) = (self.room.rasterizer.gpu, self.room.pixels() as usize);
        gpu.read(self.room.buffers.get("counts"), pixels)
    }

    /// Takes up a range that fits.
    fn take(&mut self, counts: &[u32], longest: u32, is_last: bool) -> Result<(), GpuError> {
        self.counted += counts.iter().map(|n| u64::from(*n)).sum::<u64>();
        self.all.ranges += 1;
        let read = |room: &Room<'_, '_>, linked: &mut Linked<'_>| -> Result<(), GpuError> {
            each(room, counts, |pixel, own| linked.extend(pixel, own))
        };
        read(&self.room, &mut self.built)?;
        let mut flags = if self.all.ranges == 1 { BEGINS } else { 0 };
        if is_last {
            flags |= ENDS;
        }
        let steps = self.ranked(longest, flags)?;
        self.all.finish += self.room.submit(&steps)?;
        read(&self.room, &mut self.sorted)
    }

    /// The passes that put the arrays of a range in order, and blend them.
    fn ranked(&mut self, longest: u32, flags: u32) -> Result<Vec<Step>, GpuError> {
        let all = self.room.listing.entries.saturating_mul(self.room.pixels());
        let mut steps = self.room.rank(longest, all)?;
        steps.extend(self.room.blend_from("rank_blend", longest, flags)?);
        Ok(steps)
    }

    /// The picture of so many nearest layers alone, of the ranges that fitted.
    fn nearest(&mut self, layers: u32) -> Result<Vec<[f32; 3]>, GpuError> {
        // Several ranges count in these what they have shown.
        self.room.zeros("offsets", self.room.pixels().into())?;
        self.room.listing.layers = layers;
        let count = self.ranges.len();
        for at in 0..count {
            let mut flags = if at == 0 { BEGINS } else { FOLLOWS };
            flags |= if at + 1 == count { ENDS } else { GOES_ON };
            let range = self.ranges[at].clone();
            let mut steps = self.filling(&range)?;
            steps.extend(self.ranked(self.longest, flags)?);
            self.room.submit(&steps)?;
        }
        self.room.listing.layers = u32::MAX;
        self.room.picture()
    }
}

/// Buffers that do not depend on how many entries there are.
fn make(room: &mut Room<'_, '_>) -> Result<(), GpuError> {
    room.zeros("counts", room.pixels().into())?;
    // What kernels bind of lists in other layouts.
    room.zeros("unfinished", 1)?;
    room.zeros("offsets", 1)
}

fn make_room(room: &mut Room<'_, '_>, entries: u32) -> Result<(), GpuError> {
    room.listing.entries = entries;
    room.zeros("listed", 2 * u64::from(entries) * u64::from(room.pixels()))
}

/// Counts the fragments of a whole target, and makes room for the longest list at every pixel.
pub(super) fn make_exactly(room: &mut Room<'_, '_>) -> Result<u32, GpuError> {
    make(room)?;
    make_room(room, 1)?;
    room.submit(&room.draw("bucket")?)?;
    let gpu = room.rasterizer.gpu;
    let counts: Vec<u32> = gpu.read(room.buffers.get("counts"), room.pixels() as usize)?;
    let longest = counts.iter().copied().max().unwrap_or(0);
    let most = most_entries(room.rasterizer, room.pixels());
    if longest > most {
        return Err(GpuError::Limit {
            adapter: gpu.name.clone(),
            what: "an array for each pixel",
            needed: longest.into(),
            limit: most.into(),
        });
    }
    make_room(room, longest.max(1))?;
    let counted: u64 = counts.iter().map(|n| u64::from(*n)).sum();
    Ok(u32::try_from(counted).unwrap_or(u32::MAX))
}

/// The arrays as they are.
pub(super) fn lists(room: &Room<'_, '_>) -> Result<Lists, GpuError> {
    let gpu = room.rasterizer.gpu;
    let counts: Vec<u32> = gpu.read(room.buffers.get("counts"), room.pixels() as usize)?;
    stored(room, &counts)
}

/// The same, where so many fragments were counted: those that there was room for.
fn stored(room: &Room<'_, '_>, counts: &[u32]) -> Result<Lists, GpuError> {
    let mut linked = Linked::new(room.pixels(), &room.rasterizer.colours);
    each(room, counts, |pixel, own| linked.extend(pixel, own))?;
    let counted = counts.iter().map(|n| u64::from(*n)).sum::<u64>();
    Ok(linked.counted(u32::try_from(counted).unwrap_or(SATURATED)))
}

/// Reads the entries of each pixel.
fn each(
    room: &Room<'_, '_>,
    counts: &[u32],
    mut take: impl FnMut(usize, &[Entry]),
) -> Result<(), GpuError> {
    let entries = room.listing.entries as usize;
    let all: Vec<Entry> = room
        .rasterizer
        .gpu
        .read(room.buffers.get("listed"), entries * counts.len())?;
    let own = all.chunks_exact(entries).zip(counts).enumerate();
    for (pixel, (own, &count)) in own {
        take(pixel, &own[..entries.min(count as usize)]);
    }
    Ok(())
}
