//! A band drawn over and over, each part timed.

use triptych_spec::tiles::BIN_SORTED;

use super::attempt::BINNED_MAX;
use super::pool::Pool;
use super::room::Room;
use super::{Options, Region, attempt};
use crate::error::GpuError;
use crate::frame::Band;
use crate::raster::Rasterizer;
use crate::ready::Ready;
use crate::timer::Queries;

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Span {
    /// Triangles into bins.
    Bin,
    /// Lists counted and placed.
    Place,
    /// Lists filled.
    Fill,
    /// Lists that no network sorts, sorted. Bins that are not put in order may leave some in any frame.
    Sort,
    /// The picture of so many nearest layers; short lists are sorted for it.
    Shade(u32),
    /// The picture of so many nearest layers of the tiles that need no lists in memory.
    Local(u32),
}

/// A band that is set up.
pub(super) struct Timed<'r, 'g> {
    pub(super) room: Room<'r, 'g>,
    spans: Vec<(Span, Vec<Ready>)>,
    /// Triangles in bins.
    pub(super) binned: u32,
    /// Fragments in lists.
    pub(super) fragments: u32,
    /// Tiles that [`Self::local`] left to lists; lists that [`Self::linked`] has to sort.
    pub(super) left: u32,
    /// Whether there is a second array, into which parts of lists are merged.
    pub(super) merges: bool,
}

impl<'r, 'g> Timed<'r, 'g> {
    /// Sets up a band, and pictures of these numbers of layers.
    ///
    /// # Errors
    /// Limits by name, WGSL errors, and whatever the device reports.
    pub(super) fn new(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        layers: &[u32],
        at: (Band, Pool),
    ) -> Result<Self, GpuError> {
        let (mut timed, drawn) = Self::bins(rasterizer, options, at)?;
        timed.lists(drawn, layers)?;
        Ok(timed)
    }

    /// The same with lists in memory for those tiles alone that need them.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn local(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        layers: &[u32],
        at: (Band, Pool),
    ) -> Result<Self, GpuError> {
        let (mut timed, drawn) = Self::bins(rasterizer, options, at)?;
        timed.room.with_digests()?;
        let mut locals = Vec::new();
        for n in layers {
            let pass = timed.room.local(drawn.1, *n)?;
            locals.push((Span::Local(*n), vec![pass]));
        }
        if let Some((_, passes)) = locals.first() {
            attempt::submit(&timed.room, passes)?;
        }
        timed.left = rasterizer.gpu.word(timed.room.buffers.get("digests"), 0)?;
        if timed.left == 0 {
            timed.spans.extend(locals);
            return Ok(timed);
        }
        timed.lists(drawn, layers)?;
        // A picture of some layers is that of all tiles.
        let shades = timed.spans.len() - layers.len();
        let shades = timed.spans.split_off(shades);
        let lists = timed.spans.split_off(1);
        let mut lists = lists.into_iter();
        for (local, shade) in locals.into_iter().zip(shades) {
            timed.spans.push(local);
            timed.spans.extend(lists.by_ref());
            timed.spans.push(shade);
        }
        Ok(timed)
    }

    /// The same with linked lists, in regions that hold just what is drawn.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn linked(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        layers: &[u32],
        at: (Band, Pool),
    ) -> Result<Self, GpuError> {
        let (mut timed, drawn) = Self::bins(rasterizer, options, at)?;
        let room = &mut timed.room;
        let (regions, passes) = room.link_exactly(drawn)?;
        timed.fragments = regions.iter().map(|r| r.attempts).sum();
        timed.spans.push((Span::Fill, passes));
        timed.left = regions.iter().map(Region::unordered).sum();
        // A list is no longer than its region.
        let longest = regions.iter().map(|r| r.attempts).max().unwrap_or(0);
        if timed.left > 0 || drawn.0 > BIN_SORTED {
            timed
                .spans
                .push((Span::Sort, room.sort_linked_whole(longest)?));
        }
        for n in layers {
            timed
                .spans
                .push((Span::Shade(*n), room.blend_linked(longest, *n)?));
        }
        Ok(timed)
    }

    /// A band with triangles in bins; the longest bin, and how many of it a dispatch draws.
    fn bins(
        rasterizer: &'r Rasterizer<'g>,
        options: &Options<'_>,
        at: (Band, Pool),
    ) -> Result<(Self, (u32, u32)), GpuError> {
        let mut room = attempt::room_in(rasterizer, options, at)?;
        let (bins, _) = attempt::count_bins(&room)?;
        let binned = bins.last().copied().unwrap_or(0);
        if binned > BINNED_MAX {
            return Err(GpuError::Limit {
                adapter: rasterizer.gpu.name.clone(),
                what: "triangles in tiles",
                needed: binned.into(),
                limit: BINNED_MAX.into(),
            });
        }
        attempt::fill_bins(&mut room, binned)?;
        let mut bin = room.count_bins()?;
        bin.extend(room.fill_bins(binned)?);
        let drawn = (
            attempt::longest(&bins),
            attempt::at_once(options, rasterizer),
        );
        let timed = Self {
            room,
            spans: vec![(Span::Bin, bin)],
            binned,
            fragments: 0,
            left: 0,
            merges: false,
        };
        Ok((timed, drawn))
    }

    /// Lists, and pictures of them.
    fn lists(&mut self, drawn: (u32, u32), layers: &[u32]) -> Result<(), GpuError> {
        let room = &mut self.room;
        let gpu = room.rasterizer.gpu;
        let place = room.place_lists(drawn)?;
        attempt::submit(room, &place)?;
        let fragments = gpu.word(room.buffers.get("counter"), 0)?;
        let bytes = 8 * u64::from(fragments);
        let listed = room.pool.storage(gpu, "entries of lists", bytes)?;
        room.buffers.set("listed", listed);
        let fill = room.drawn("jagged_fill", fragments, drawn)?;
        attempt::submit(room, &fill)?;
        let mut longest = room.longest(fragments)?;
        if drawn.0 > BIN_SORTED {
            longest = longest.in_any_order();
        }
        let spans = &mut self.spans;
        spans.extend([(Span::Place, place), (Span::Fill, fill)]);
        self.merges = longest.is_merged();
        if self.merges {
            let merged = room.pool.storage(gpu, "entries that are merged", bytes)?;
            room.buffers.set("merged", merged);
        }
        if longest.has_unsorted() {
            spans.push((Span::Sort, room.sort_lists(longest)?));
        }
        for n in layers {
            spans.push((Span::Shade(*n), room.shade(longest, *n, false)?));
        }
        self.fragments = fragments;
        Ok(())
    }

    /// The parts, in the order in which they run.
    pub(super) fn spans(&self) -> impl Iterator<Item = Span> {
        self.spans.iter().map(|(span, _)| *span)
    }

    /// Runs every part once, one after another, and shows each picture.
    ///
    /// # Errors
    /// Whatever the device reports.
    pub(super) fn pictures(
        &self,
        mut show: impl FnMut(u32, Vec<[f32; 3]>),
    ) -> Result<(), GpuError> {
        for (span, passes) in &self.spans {
            attempt::submit(&self.room, passes)?;
            match span {
                Span::Local(layers) if self.left == 0 => {
                    show(*layers, attempt::picture(&self.room)?)
                }
                Span::Shade(layers) => show(*layers, attempt::picture(&self.room)?),
                _ => {}
            }
        }
        Ok(())
    }

    /// Records a part, which has this number among a timer's.
    pub(super) fn record(
        &self,
        part: usize,
        number: u32,
        encoder: &mut wgpu::CommandEncoder,
        queries: Option<&Queries>,
    ) {
        let passes = &self.spans[part].1;
        for (at, pass) in passes.iter().enumerate() {
            let writes = queries.and_then(|q| q.writes(number, at, passes.len()));
            pass.record(encoder, writes);
        }
    }
}
