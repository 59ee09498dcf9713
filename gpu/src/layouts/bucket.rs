//! Arrays of the pixels: as many entries as fit, then ranges of depth one after another.

use std::ops::Range;

use triptych_spec::abuffer::Lists;
use triptych_spec::layouts::{ALL, Entry};

use super::arrays::{BEGINS, ENDS, Linked};
use super::room::{Room, Step, pixels_max};
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
        all: Built::default(),
    };
    bucket.make_room(first.clamp(1, most))?;
    bucket.all_ranges(depths(rasterizer))?;
    let counted = u32::try_from(bucket.counted).unwrap_or(u32::MAX);
    let mut all = bucket.all;
    all.image = bucket.room.picture()?;
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

    /// Fills the arrays with the fragments of a range; how many each pixel has.
    fn fill(&mut self, range: &Range<Entry>) -> Result<Vec<u32>, GpuError> {
        let [from_key, from_face] = range.start;
        let [until_key, until_face] = range.end;
        self.room.listing = Listing {
            from_key,
            from_face,
            until_key,
            until_face,
            ..self.room.listing
        };
        let clear = self.room.per_pixel("bucket_clear", self.room.listing)?;
        let mut steps = vec![Step::Other(clear)];
        steps.extend(self.room.draw("bucket")?);
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
        let all = self.room.listing.entries.saturating_mul(self.room.pixels());
        let mut steps = self.room.rank(longest, all)?;
        if self.room.is_shown() {
            let mut flags = if self.all.ranges == 1 { BEGINS } else { 0 };
            if is_last {
                flags |= ENDS;
            }
            steps.extend(self.room.blend(longest, flags)?);
        }
        self.all.finish += self.room.submit(&steps)?;
        read(&self.room, &mut self.sorted)
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

/// The middle of what lies both in a range and among the depths; `None` if the range has no two entries.
fn middle(range: &Range<Entry>, depths: &Range<Entry>) -> Option<Entry> {
    let number = |[key, face]: Entry| u64::from(key) << 32 | u64::from(face);
    let [from, until] = [range.start, range.end].map(number);
    let [near, far] = [depths.start, depths.end].map(number);
    let middle = from.max(near).midpoint(until.min(far).max(from.max(near)));
    let middle = middle.clamp(from, until);
    // Beyond the depths, a range is halved as it is.
    let middle = match from < middle && middle < until {
        true => middle,
        false => from.midpoint(until),
    };
    let halves = |n: u64| u32::try_from(n & u64::from(u32::MAX)).expect("32 bits");
    (from < middle).then(|| [halves(middle >> 32), halves(middle)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// However ranges are split, they end: at one entry at the latest.
    #[test]
    fn ranges_split_until_one_entry_is_left() {
        let depths = [1000, 0]..[1011, 0];
        for target in [
            [1000, 0],
            [1010, 77],
            [1010, u32::MAX],
            [0, 0],
            [u32::MAX, 3],
        ] {
            let (mut range, mut splits) = (ALL, 0);
            while let Some(middle) = middle(&range, &depths) {
                assert!(range.start < middle && middle < range.end, "{range:?}");
                range = match target < middle {
                    true => range.start..middle,
                    false => middle..range.end,
                };
                splits += 1;
                assert!(splits < 200, "{range:?}");
            }
            assert!(range.contains(&target), "{target:?} in {range:?}");
        }
        assert_eq!(
            middle(&ALL, &depths).map(|m| m[0]),
            Some(1005),
            "of the depths"
        );
    }
}
