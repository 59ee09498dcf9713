//! A layout's frame of a whole target, set up once and run many times, each part timed.

use triptych_spec::abuffer::Lists;

use super::room::{Room, Step};
use super::{Layout, Options, REGIONS, bucket, check, ordered, packed, precalc, regions};
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::Rasterizer;
use crate::timer::Timer;

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Empties lists: packed nodes and runs need none.
    Clear,
    /// Builds them.
    Build,
    /// Puts them in order, where they are not.
    Rank,
    /// The picture.
    Blend,
    /// A whole frame of so many nearest layers alone, all parts of it, after that of all.
    Nearest(u32),
}

/// A whole target that is set up, with room for exactly what there is.
pub struct Timed<'r, 'g> {
    room: Room<'r, 'g>,
    spans: Vec<(Span, Vec<Step>)>,
    /// Fragments in lists.
    pub fragments: u32,
    /// Fragments of the longest.
    pub longest: u32,
    /// Nodes that there is room for; of each region, where there are regions.
    pub capacity: u32,
}

impl<'r, 'g> Timed<'r, 'g> {
    /// Sets up a target, and frames of [`Options::nearest`] layers alone. What was built is certified by `inspect`, which gives the
    /// length of the longest list.
    ///
    /// # Errors
    /// What does not fit at once, by name; lists that are damaged, as those that do not end; WGSL errors,
    /// and whatever the device reports.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        layout: Layout,
        options: Options<'_>,
        is_opaque: impl Fn(u32) -> bool,
        inspect: impl Fn(&Lists) -> Option<u32>,
    ) -> Result<Self, GpuError> {
        check(rasterizer)?;
        let band = Band::whole(rasterizer.size);
        let mut room = Room::new(rasterizer, layout, options, (band, 0), is_opaque)?;
        let fragments = make(&mut room)?;
        let mut timed = Self {
            capacity: room.frame.capacity,
            room,
            spans: Vec::new(),
            fragments,
            longest: 0,
        };
        timed.set_up_build()?;
        for span in 0..timed.spans.len() {
            timed.run(span)?;
        }
        let lists = read(&timed.room)?;
        let longest = inspect(&lists).ok_or_else(|| GpuError::Endless {
            adapter: rasterizer.gpu.name.clone(),
            stage: layout.name(),
        })?;
        timed.longest = longest;
        timed.set_up_picture(options.nearest)?;
        // Packed nodes begin with empty lists again.
        for span in 0..timed.spans.len() {
            timed.run(span)?;
        }
        Ok(timed)
    }

    fn set_up_build(&mut self) -> Result<(), GpuError> {
        let parts = [
            (Span::Clear, self.room.empty()?),
            (Span::Build, self.room.build()?),
        ];
        self.spans.extend(parts);
        self.spans.retain(|(_, steps)| !steps.is_empty());
        Ok(())
    }

    fn set_up_picture(&mut self, nearest: &[u32]) -> Result<(), GpuError> {
        let room = &mut self.room;
        let all = match room.layout {
            Layout::Bucket => room.listing.entries.saturating_mul(room.pixels()),
            _ => self.fragments,
        };
        let lists = (self.longest, all);
        let rank = room.order(self.longest, all)?;
        let mut parts = vec![(Span::Rank, rank), (Span::Blend, room.blend(self.longest)?)];
        for n in nearest {
            parts.push((Span::Nearest(*n), room.nearest(*n, lists)?));
        }
        self.spans.extend(parts);
        self.spans.retain(|(_, steps)| !steps.is_empty());
        Ok(())
    }

    /// The parts, in the order in which they run.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        self.spans.iter().map(|(span, _)| *span)
    }

    /// Bytes of all buffers, but for the triangles.
    pub fn bytes(&self) -> u64 {
        self.room.buffers.bytes()
    }

    fn run(&self, span: usize) -> Result<(), GpuError> {
        self.room.submit(&self.spans[span].1).map(drop)
    }

    /// Runs every part of the frame of all layers once, one after another; the lists in order, and the picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn frame(&self) -> Result<(Lists, Vec<[f32; 3]>), GpuError> {
        let blend = self.blend();
        for span in 0..blend {
            self.run(span)?;
        }
        let lists = read(&self.room)?;
        self.run(blend)?;
        Ok((lists, self.room.picture()?))
    }

    /// Runs the frames of [`Options::nearest`] layers alone, after [`Self::frame`]; their pictures.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn nearest(&self) -> Result<Vec<Vec<[f32; 3]>>, GpuError> {
        let mut pictures = Vec::new();
        for span in self.blend() + 1..self.spans.len() {
            self.run(span)?;
            pictures.push(self.room.picture()?);
        }
        Ok(pictures)
    }

    /// The part that makes the picture of all layers.
    fn blend(&self) -> usize {
        let blend = self.spans().position(|span| span == Span::Blend);
        blend.expect("every layout has a picture")
    }

    /// Runs every part once, one after another, up to the picture of all layers, and gives that.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn picture(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        for span in 0..=self.blend() {
            self.run(span)?;
        }
        self.room.picture()
    }

    /// Runs every part once, and gives the seconds of each.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(self.spans.len()).expect("a few");
        let rasterizer = self.room.rasterizer;
        timer.time(rasterizer.gpu, 0..count, |span, encoder, queries| {
            let steps = &self.spans[span as usize].1;
            for (at, step) in steps.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, steps.len()));
                step.record(rasterizer, encoder, writes);
            }
        })
    }
}

/// Counts the fragments, and makes room for them.
fn make(room: &mut Room<'_, '_>) -> Result<u32, GpuError> {
    let gpu = room.rasterizer.gpu;
    match room.layout {
        Layout::Bucket => bucket::make_exactly(room),
        Layout::Precalc => {
            precalc::make(room)?;
            room.submit(&precalc::count(room)?)?;
            let counted = gpu.word(room.buffers.get("offsets"), room.pixels())?;
            room.frame.capacity = counted;
            room.zeros("listed", 2 * u64::from(counted))?;
            room.clear("counts", None)?;
            Ok(counted)
        }
        Layout::Packed => {
            packed::make(room)?;
            room.submit(&room.draw("packed")?)?;
            room.frame.capacity = gpu.word(room.buffers.get("counter"), 0)?;
            packed::make(room)?;
            Ok(room.frame.capacity)
        }
        Layout::Regions => {
            regions::make(room)?;
            room.submit(&room.draw("regions")?)?;
            let attempts: Vec<u32> = gpu.read(room.buffers.get("counters"), REGIONS as usize)?;
            room.frame.capacity = attempts.iter().copied().max().unwrap_or(0);
            regions::make(room)?;
            let all: u64 = attempts.iter().map(|n| u64::from(*n)).sum();
            Ok(u32::try_from(all).unwrap_or(u32::MAX))
        }
        Layout::Ordered => {
            ordered::make(room)?;
            room.submit(&[ordered::clear(room)?])?;
            room.submit(&ordered::draw(room)?)?;
            // Without any room each fragment asks once; with room, twice at most.
            let fragments = gpu.word(room.buffers.get("counter"), 0)?;
            room.frame.capacity = fragments.saturating_mul(2);
            ordered::make(room)?;
            Ok(fragments)
        }
    }
}

/// The lists as they are.
fn read(room: &Room<'_, '_>) -> Result<Lists, GpuError> {
    let gpu = room.rasterizer.gpu;
    match room.layout {
        Layout::Bucket => bucket::lists(room),
        Layout::Precalc => {
            let offsets: Vec<u32> =
                gpu.read(room.buffers.get("offsets"), room.pixels() as usize + 1)?;
            precalc::linked(room, &offsets, room.frame.capacity)
        }
        Layout::Packed => packed::lists(room),
        Layout::Regions => {
            let attempts: Vec<u32> = gpu.read(room.buffers.get("counters"), REGIONS as usize)?;
            regions::lists(room, &attempts)
        }
        Layout::Ordered => {
            ordered::check_steps(room)?;
            ordered::lists(room)
        }
    }
}
