//! Peeling to the end, with all that was peeled read back.

use std::time::Instant;

use triptych_spec::abuffer::Sorted;
use triptych_spec::raster::Fragment;

use super::{Given, Peeling, Rival, Surfaces, Technique, bands, image};
use crate::context::Gpu;
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::Rasterizer;

/// Layers that are recorded at once.
const AT_ONCE: u64 = 2;

/// Bytes that their history takes at most, unless a single layer takes more.
const HISTORY: u64 = 1 << 26;

/// Peels up to `layers` layers of every pixel, and ends where a layer has no fragment at any.
///
/// # Errors
/// WGSL errors; whatever the device reports.
pub fn peel(
    rasterizer: &Rasterizer<'_>,
    technique: Technique,
    given: Given<'_>,
    layers: u32,
    is_opaque: impl Fn(u32) -> bool,
) -> Result<Rival, GpuError> {
    rasterizer.take_passes();
    let mut all = Rival {
        sorted: Sorted {
            offsets: vec![0],
            fragments: Vec::new(),
        },
        ..Rival::default()
    };
    for band in bands(rasterizer, 16) {
        let surfaces = Surfaces::upload(rasterizer, given.opaque, band)?;
        let at = (band, given.background);
        let peeling = Peeling::new(rasterizer, technique, &surfaces, at, &is_opaque)?;
        Run {
            rasterizer,
            technique,
            peeling,
            band,
        }
        .to_the_end(layers, &mut all)?;
    }
    all.passes = rasterizer.take_passes();
    Ok(all)
}

/// A band under way.
struct Run<'r, 'g> {
    rasterizer: &'r Rasterizer<'g>,
    technique: Technique,
    peeling: Peeling<'r, 'g>,
    band: Band,
}

/// What was peeled of each pixel, as (key, triangle): from the front, and from the back.
struct Found {
    front: Vec<Vec<[u32; 2]>>,
    back: Vec<Vec<[u32; 2]>>,
    /// What the buffer held before.
    before: Vec<u32>,
}

impl Run<'_, '_> {
    fn gpu(&self) -> &Gpu {
        self.rasterizer.gpu
    }

    fn to_the_end(&self, layers: u32, all: &mut Rival) -> Result<(), GpuError> {
        let gpu = self.gpu();
        let pixels = self.band.pixels(self.rasterizer.size);
        let (kept, words) = self.technique.kept();
        let kept = self.peeling.buffer(kept);
        let bytes = 4 * words * u64::from(pixels);
        let at_once = AT_ONCE.min((HISTORY / bytes).max(1));
        let history = gpu.storage_unbound("history", bytes * at_once)?;
        let [clear, layer, behind] = self.peeling.parts();
        let (mut encoder, mut done) = (gpu.encoder(), 0);
        self.rasterizer.record(clear, &mut encoder);
        let start = Instant::now();
        gpu.submit(encoder)?;
        all.time += start.elapsed();
        let words = usize::try_from(words).expect("a few");
        let count = pixels as usize * words;
        let mut found = Found::new(gpu.read(kept, count)?, words);
        let mut ended = false;
        while done < layers && !ended {
            let now = at_once.min(u64::from(layers - done));
            let mut encoder = gpu.encoder();
            for at in 0..now {
                self.rasterizer.record(layer, &mut encoder);
                encoder.copy_buffer_to_buffer(kept, 0, &history, at * bytes, bytes);
            }
            let start = Instant::now();
            gpu.submit(encoder)?;
            all.time += start.elapsed();
            let read: Vec<u32> =
                gpu.read(&history, usize::try_from(now).expect("a few") * count)?;
            for state in read.chunks(count) {
                ended = !found.add(self.technique, state.to_vec());
                done += u32::from(!ended);
            }
        }
        let mut encoder = gpu.encoder();
        self.rasterizer.record(behind, &mut encoder);
        gpu.submit(encoder)?;
        let picture = image(gpu, self.peeling.buffer("picture"), pixels)?;
        all.image.extend(picture);
        all.counted += u64::from(self.peeling.peeled()?);
        all.layers = all.layers.max(done);
        all.bytes = all.bytes.max(self.peeling.bytes());
        found.into_lists(
            self.band.first * self.rasterizer.size.width,
            &mut all.sorted,
        );
        Ok(())
    }
}

impl Found {
    fn new(before: Vec<u32>, words: usize) -> Self {
        let pixels = before.len() / words;
        Self {
            front: vec![Vec::new(); pixels],
            back: vec![Vec::new(); pixels],
            before,
        }
    }

    /// Takes up a layer from what is kept after it; false if nothing changed.
    fn add(&mut self, technique: Technique, state: Vec<u32>) -> bool {
        let words = state.len() / self.front.len();
        let pixels = state.chunks(words).zip(self.before.chunks(words));
        for (pixel, (now, before)) in pixels.enumerate() {
            if now == before {
                continue;
            }
            match (technique, now) {
                (Technique::Alpha, _) => self.front[pixel].push([0, now[0].wrapping_sub(1)]),
                (_, [key, after, ..]) => self.front[pixel].push([*key, after.wrapping_sub(1)]),
                _ => unreachable!("two words or four"),
            }
            // A fragment that is both ends was taken at the front.
            if let [key, after, far, prim] = *now
                && [key, after.wrapping_sub(1)] != [far, prim]
            {
                self.back[pixel].push([far, prim]);
            }
        }
        let changed = state != self.before;
        self.before = state;
        changed
    }

    fn into_lists(self, first: u32, sorted: &mut Sorted) {
        let lists = self.front.into_iter().zip(self.back);
        for (pixel, (front, back)) in (first..).zip(lists) {
            let all = front.into_iter().chain(back.into_iter().rev());
            sorted.fragments.extend(all.map(|[key, prim]| Fragment {
                pixel,
                prim,
                key,
                mask: 1,
            }));
            let end = u32::try_from(sorted.fragments.len()).expect("fewer than 2^32 fragments");
            sorted.offsets.push(end);
        }
    }
}
