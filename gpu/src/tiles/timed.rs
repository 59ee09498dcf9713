//! A band drawn over and over, each part timed.

use triptych_spec::tiles::ROWS;

use super::attempt::BINNED_MAX;
use super::room::Room;
use super::{DRAWN, Options, attempt};
use crate::dispatch::Ready;
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::Rasterizer;
use crate::timer::Timer;

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Triangles into bins.
    Bin,
    /// Lists counted and placed.
    Place,
    /// Lists filled.
    Fill,
    /// Lists that are too long for registers, sorted.
    Sort,
    /// The picture of so many nearest layers; short lists are sorted for it.
    Shade(u32),
}

/// A whole target that is set up.
pub struct Timed<'r, 'g> {
    room: Room<'r, 'g>,
    spans: Vec<(Span, Vec<Ready>)>,
    /// Triangles in bins.
    pub binned: u32,
    /// Fragments in lists.
    pub fragments: u32,
}

impl<'r, 'g> Timed<'r, 'g> {
    /// Sets up a target, and pictures of these numbers of layers.
    ///
    /// # Errors
    /// Limits by name, WGSL errors, and whatever the device reports.
    pub fn new(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        layers: &[u32],
    ) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let mut room = attempt::room(rasterizer, options, Band::whole(rasterizer.size))?;
        let (bins, _) = attempt::count_bins(&room)?;
        let binned = bins.last().copied().unwrap_or(0);
        if binned > BINNED_MAX {
            return Err(GpuError::Limit {
                adapter: gpu.name.clone(),
                what: "triangles in tiles",
                needed: binned.into(),
                limit: BINNED_MAX.into(),
            });
        }
        attempt::fill_bins(&mut room, binned)?;
        let drawn = (attempt::longest(&bins), options.drawn.clamp(1, DRAWN));
        attempt::submit(&room, &room.place_lists(drawn)?)?;
        let fragments = gpu.word(room.get("counter"), 0)?;
        let longest = room.longest(fragments)?;
        let entries = || gpu.storage("entries of lists", 8 * u64::from(fragments));
        room.set("listed", entries()?);
        if longest.length > ROWS {
            room.set("merged", entries()?);
        }
        let mut bin = room.count_bins()?;
        bin.extend(room.fill_bins(binned)?);
        let mut spans = vec![
            (Span::Bin, bin),
            (Span::Place, room.place_lists(drawn)?),
            (Span::Fill, room.drawn("jagged_fill", fragments, drawn)?),
        ];
        if longest.length > ROWS {
            spans.push((Span::Sort, room.sort_lists(longest)?));
        }
        for n in layers {
            spans.push((Span::Shade(*n), room.shade(longest, *n, false)?));
        }
        Ok(Self {
            room,
            spans,
            binned,
            fragments,
        })
    }

    /// Bytes of all buffers, but for the triangles.
    pub fn bytes(&self) -> u64 {
        self.room.bytes()
    }

    /// The parts, in the order in which they run.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        self.spans.iter().map(|(span, _)| *span)
    }

    /// Runs every part once, one after another, and shows each picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn pictures(&self, mut show: impl FnMut(u32, Vec<[f32; 3]>)) -> Result<(), GpuError> {
        for (span, passes) in &self.spans {
            attempt::submit(&self.room, passes)?;
            if let Span::Shade(layers) = span {
                show(*layers, attempt::picture(&self.room)?);
            }
        }
        Ok(())
    }

    /// Runs every part once, and gives the seconds of each.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(self.spans.len()).expect("a few");
        let gpu = self.room.rasterizer.gpu;
        timer.time(gpu, 0..count, |span, encoder, queries| {
            let passes = &self.spans[span as usize].1;
            for (at, pass) in passes.iter().enumerate() {
                let writes = queries.and_then(|q| q.writes(span, at, passes.len()));
                pass.record(encoder, writes);
            }
        })
    }
}
