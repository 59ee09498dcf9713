//! A band drawn over and over, each part timed.

use super::room::Room;
use super::{Options, attempt};
use crate::dispatch::Ready;
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::Rasterizer;
use crate::timer::Timer;

/// What is timed, in the order of all results here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Triangles into bins.
    Bin,
    /// Lists counted.
    Count,
    /// Lists filled.
    Fill,
    /// Lists sorted.
    Sort,
    /// Lists blended.
    Shade,
}

/// A band that is set up.
pub struct Timed<'r, 'g> {
    room: Room<'r, 'g>,
    spans: Vec<(Span, Vec<Ready>)>,
    /// Fragments in lists.
    pub fragments: u32,
}

impl<'r, 'g> Timed<'r, 'g> {
    /// Sets up a whole target.
    ///
    /// # Errors
    /// Limits by name, WGSL errors, and whatever the device reports.
    pub fn new(rasterizer: &'r Rasterizer<'g>, options: &Options<'_>) -> Result<Self, GpuError> {
        let gpu = rasterizer.gpu;
        let mut room = attempt::room(rasterizer, options, Band::whole(rasterizer.size))?;
        let (bins, _) = attempt::bins(&mut room, false)?;
        let drawn = (attempt::longest(&bins), options.drawn);
        attempt::submit(&room, &room.place_lists(drawn)?)?;
        let fragments = gpu.word(room.get("counter"), 0)?;
        let [longest, longs]: [u32; 2] = gpu.read(room.get("longest"), 1)?[0];
        for name in ["listed", "merged"] {
            room.set(
                name,
                gpu.storage("entries of lists", 8 * u64::from(fragments))?,
            );
        }
        let binned = u32::try_from(room.get("binned").size() / 4).expect("a binding");
        let mut bin = room.count_bins(false)?;
        bin.extend(room.fill_bins(false, binned)?);
        let spans = vec![
            (Span::Bin, bin),
            (Span::Count, room.place_lists(drawn)?),
            (Span::Fill, room.drawn("jagged_fill", fragments, drawn)?),
            (Span::Sort, room.sort_lists(longest, longs)?),
            (Span::Shade, room.shade(longest, false)?),
        ];
        let spans = spans
            .into_iter()
            .filter(|(_, passes)| !passes.is_empty())
            .collect();
        Ok(Self {
            room,
            spans,
            fragments,
        })
    }

    /// Bytes of all buffers.
    pub fn bytes(&self) -> u64 {
        self.room.bytes()
    }

    /// The parts, in the order in which they run.
    pub fn spans(&self) -> impl Iterator<Item = Span> {
        self.spans.iter().map(|(span, _)| *span)
    }

    /// Runs every part once, and gives the seconds of each.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub fn time(&self, timer: &Timer) -> Result<Vec<f64>, GpuError> {
        let count = u32::try_from(self.spans.len()).expect("a few");
        timer.time(
            self.room.rasterizer.gpu,
            0..count,
            |span, encoder, queries| {
                let passes = &self.spans[span as usize].1;
                for (at, pass) in passes.iter().enumerate() {
                    let writes = queries.and_then(|q| q.writes(span, at, passes.len()));
                    pass.record(encoder, writes);
                }
            },
        )
    }
}
